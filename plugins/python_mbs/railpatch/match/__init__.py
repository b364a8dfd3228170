"""Parameters of a scene from measured points: ``railpatch match``, ``run_match``."""

from __future__ import annotations

from railpatch.match.plan import Plan, load_match
from railpatch.match.run import Match, run_match

__all__ = ["Match", "Plan", "load_match", "run_match"]
