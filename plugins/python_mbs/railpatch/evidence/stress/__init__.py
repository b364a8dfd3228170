"""Numerical stability on stiff and extreme cases, checked again by code of its own."""
