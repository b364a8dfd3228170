"""A rig's scene as the case of one contact, for commands that take one."""

from __future__ import annotations

from pathlib import Path

from railpatch import Contact
from railpatch.case.load import Scene, check_case

from rig_model.scene import RigScene, load_rig_scene


def contact_scene(path: Path | None) -> tuple[str, Scene]:
    """Name and case; without a path those of the default scene. Raises CaseError, ProfileError."""
    rig = load_rig_scene(path)
    return Path(rig.name).stem, at_first_position(rig)


def at_first_position(rig: RigScene) -> Scene:
    """The rig's machine with z prescribed, where its run begins; the wheels roll without slip."""
    first = rig.positions()[0]
    wheelset, track = rig.case.wheelset, rig.case.track
    rolling = -track.roller_pitch_rate * track.roller_radius / wheelset.nominal_radius
    start = {"y": first.y, "yaw": first.yaw, "pitch_rate": rolling}
    content = rig.case.model_dump() | {"wheelset": wheelset.model_dump() | start}
    z = Contact(Scene(check_case(content), Path())).step()["z"]
    content["wheelset"] |= {"vertical_force": None, "z": z}
    return Scene(check_case(content), Path())
