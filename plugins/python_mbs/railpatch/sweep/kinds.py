"""The kind of file that a sweep is."""

from __future__ import annotations

from importlib import resources
from pathlib import Path

from railpatch.case.kinds import SceneKind
from railpatch.sweep.plan import SweepFile


def sweep() -> SceneKind:
    """A sweep of a wheel on a rail."""
    example = Path(str(resources.files("railpatch.sweep"))) / "example.toml"
    command = "railpatch sweep SCENE -o result"
    return SceneKind("sweep", SweepFile, example, command, base="wheel_rail")
