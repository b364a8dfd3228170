"""Wheels whose profiles wear over a mix of cases."""

from railpatch.wear.evolve import wear_profiles

__all__ = ["wear_profiles"]
