"""A rig's scene as the case of one contact, for commands that take one."""

from __future__ import annotations

from pathlib import Path

from railpatch import CaseError, Contact, Result
from railpatch.case.load import Scene, check_case

from rig_model.scene import RigScene, load_rig_scene


def contact_scene(path: Path | None) -> tuple[str, Scene]:
    """Name and case; without a path those of the default scene. Raises CaseError, ProfileError."""
    rig = load_rig_scene(path)
    return Path(rig.name).stem, at_first_position(rig)


def at_first_position(rig: RigScene) -> Scene:
    """The rig's machine with z prescribed, where its run begins, in balance as in the run; where a
    scene has what balances refuse, with the roll angle of the case and wheels without slip."""
    first = rig.positions()[0]
    wheelset, track = rig.case.wheelset, rig.case.track
    rolling = -rig.speed_at(first) * track.roller_radius / wheelset.nominal_radius
    place = {"y": first.y, "yaw": first.yaw}
    content = rig.case.model_dump()
    content["wheelset"]["vertical_force"] = rig.load_at(first)
    content["track"]["roller_pitch_rate"] = rig.speed_at(first)
    wheelset = wheelset.model_copy(update={"vertical_force": rig.load_at(first)})

    def start(**values: object) -> Result:
        content["wheelset"] = wheelset.model_dump() | place | values
        return Contact(Scene(check_case(content), Path())).step()

    try:
        found = start(roll="balanced", pitch_rate="free")
        numbers = {key: found[key] for key in ("z", "roll", "pitch_rate")} if found.solved else None
    except CaseError:
        numbers = None
    if numbers is None:
        numbers = {"z": start(pitch_rate=rolling)["z"]}
    content["wheelset"] |= {"vertical_force": None, **numbers}
    return Scene(check_case(content), Path())
