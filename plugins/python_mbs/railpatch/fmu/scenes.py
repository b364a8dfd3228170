"""Scenes for an FMU: from a file, one of those that come with the package, or the default."""

from __future__ import annotations

from importlib import resources
from pathlib import Path
from typing import Any

from railpatch.case.load import Scene, check_case, load_scene, read_toml
from railpatch.contact import Contact
from railpatch.errors import CaseError

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
    """Name and scene. A file may be a case, or the scene of a rig or of a wheelset's run.

    Raises CaseError, ProfileError.
    """
    tables = read_toml(path) if path is not None else {}
    if path is not None and "run" in tables:
        from wheelset_demo.scene import load_wheelset_scene

        return path.stem, Scene(load_wheelset_scene(path).case, path.parent)
    if path is not None and "rig" not in tables:
        return path.stem, load_scene(path)
    try:
        from rig_model.scene import load_rig_scene
    except ImportError:
        if path is not None:
            raise CaseError(f"{path}: has a table [rig], but rig_model is not installed") from None
        return "S1002_on_UIC60", load_scene(TRACK)
    rig = load_rig_scene(path)
    return Path(rig.name).stem, at_first_position(rig)


def at_first_position(rig: Any) -> Scene:
    """The rig's machine with z prescribed, where its run begins; the wheels roll without slip."""
    first = rig.positions()[0]
    wheelset, track = rig.case.wheelset, rig.case.track
    rolling = -track.roller_pitch_rate * track.roller_radius / wheelset.nominal_radius
    start = {"y": first.y, "yaw": first.yaw, "pitch_rate": rolling}
    content = rig.case.model_dump() | {"wheelset": wheelset.model_dump() | start}
    z = Contact(Scene(check_case(content), Path())).step()["z"]
    content["wheelset"] |= {"vertical_force": None, "z": z}
    return Scene(check_case(content), Path())
