"""Stresses below the surface of a case, as a table and as a page."""
