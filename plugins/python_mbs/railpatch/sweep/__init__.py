"""Sweeps: one scene with keys that take many values, on one machine or on a cluster.

``run_sweep("sweep.toml", "folder")`` does what ``railpatch sweep`` does; ``read_sweep("folder")``
gives the table of a finished one.
"""

from railpatch.sweep.outcome import Sweep
from railpatch.sweep.run import run_sweep
from railpatch.sweep.store import read_sweep

__all__ = ["Sweep", "read_sweep", "run_sweep"]
