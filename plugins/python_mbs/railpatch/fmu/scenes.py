"""Scenes for an FMU: from a file, one of those that come with the package, or the default."""

from __future__ import annotations

from importlib import resources
from importlib.metadata import entry_points
from pathlib import Path
from typing import Any

from railpatch.case.load import Scene, load_scene, read_toml
from railpatch.errors import CaseError

# entry points of packages that read scenes: a function from a path, or None for the default, to
# name and contact
SCENES = "railpatch.scenes"
# tables that other commands' scenes are known by, and the package that reads them
TABLES = {"run": "wheelset_demo", "rig": "rig_model"}
DEFAULT = "rig"
# a wheelset on track, where the rig model is not installed
TRACK: dict[str, Any] = {
    "kind": "wheelset",
    "grid": {"element_size": [5e-4, 5e-4]},
    "friction": {"coefficient": 0.3},
    "wheelset": {
        "z": 2e-4,
        "speed": 20.0,
        "pitch_rate": -20.0 / 0.46,
        "nominal_radius": 0.46,
        "flange_back_distance": 1.36,
        "flange_back_position": -0.070,
    },
    "track": {"kind": "rail", "gauge": 1.435, "gauge_height": 0.014},
    "profiles": {"wheel": "S1002", "rail": "UIC60@1:40"},
}


def kinds() -> list[str]:
    """Names of the scenes that come with the package, one for each kind of FMU."""
    found = (entry.name for entry in (resources.files("railpatch.fmu") / "kinds").iterdir())
    return sorted(name.removesuffix(".toml") for name in found if name.endswith(".toml"))


def kind_scene(name: str) -> tuple[str, Scene]:
    """Name and scene of one of these."""
    return name, load_scene(Path(str(resources.files("railpatch.fmu") / "kinds" / f"{name}.toml")))


def scene_of(path: Path | None) -> tuple[str, Scene]:
    """Name and scene. A file may be a case, or the scene of another command, known by a table that
    an entry point of the group "railpatch.scenes" is named after.

    Raises CaseError, ProfileError.
    """
    readers = {entry.name: entry for entry in entry_points(group=SCENES)}
    tables = read_toml(path) if path is not None else {DEFAULT: {}}
    table = next((name for name in TABLES if name in tables), None)
    if path is not None and table is None:
        return path.stem, load_scene(path)
    if table in readers:
        return readers[table].load()(path)
    if path is None:
        return "S1002_on_UIC60", load_scene(TRACK)
    raise CaseError(f"{path}: has a table [{table}], but {TABLES[table]} is not installed")
