"""Parameters of a scene from measured points: ``railpatch match``, ``run_match``."""

from __future__ import annotations

from railpatch.match.found import Match
from railpatch.match.plan import Plan, load_match
from railpatch.match.run import run_match, write_match

__all__ = ["Match", "Plan", "load_match", "run_match", "write_match"]
