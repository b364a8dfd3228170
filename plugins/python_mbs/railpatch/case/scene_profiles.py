"""The profiles of a case with wheels: read as [profiles] says, and checked in their places."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Literal

from railpatch.case.wheel import WheelRailCase, WheelsetCase
from railpatch.profiles import Profile, load_profile
from railpatch.profiles.builtin import builtin_profile
from railpatch.profiles.orientation import check_gauge_side, check_placed

Body = Literal["wheel", "rail"]
WheelCase = WheelRailCase | WheelsetCase
BODIES: tuple[Body, ...] = ("wheel", "rail")


@dataclass(frozen=True)
class Placed:
    """A profile and whose it is."""

    side: str
    body: Body
    profile: Profile


def named_profile(case: WheelCase, body: Body, name: str, folder: Path) -> Profile:
    """A profile by its name in the case. Raises ProfileError."""
    profiles = case.profiles
    # a built-in one says all of itself
    built_in = builtin_profile(name, body) is not None
    reading = None if built_in else profiles.reading(body)
    return load_profile(name, body, folder=folder, smoothing=profiles.smoothing, reading=reading)


def scene_profiles(case: WheelCase, folder: Path) -> list[Placed]:
    """Of each wheel and each rail of one profile. Raises ProfileError."""
    found = []
    for body in BODIES:
        for side in case.sides:
            if body == "rail" and getattr(case.track, side).sections is not None:
                continue
            _, name = case.profiles.of(body, side)
            assert name is not None
            profile = named_profile(case, body, name, folder)
            if body == "wheel":
                check_wheel(case, side, name, profile)
            elif builtin_profile(name, body) is None:
                check_gauge_side(name, profile.y, profile.z, case.track.gauge_height)
            found.append(Placed(side, body, profile))
    return found


def check_wheel(case: WheelCase, side: str, name: str, profile: Profile) -> None:
    """Refuses a wheel whose profile's origin is elsewhere than its wheelset says."""
    deviation = getattr(case.wheelset, side)
    mirror = -1.0 if side == "left" else 1.0
    _, y, z = deviation.offset
    moved = profile.moved(mirror * y, z, mirror * deviation.rotation[0])
    check_placed(name, moved.y, moved.z, case.wheelset.flange_back_position)


def profile_notes(case: WheelCase, folder: Path) -> dict[str, list[str]]:
    """What was assumed of each profile file and done to it, by file as the case names it."""
    notes: dict[str, list[str]] = {}
    for placed in scene_profiles(case, folder):
        if placed.profile.notes:
            notes[Path(placed.profile.name).name] = list(placed.profile.notes)
    return notes


def note_lines(notes: dict[str, list[str]]) -> list[str]:
    """One line for each file."""
    return [f"{name}: {'; '.join(texts)}" for name, texts in notes.items()]
