"""The profiles of a case with wheels: read as [profiles] says, and checked in their places."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import lru_cache
from itertools import pairwise
from pathlib import Path
from typing import Any, Literal, TypeVar

from railpatch.case.rails import SectionProfile
from railpatch.case.types import SIDES
from railpatch.case.wheel import WheelRailCase, WheelsetCase
from railpatch.profiles import Profile, Reading, load_profile
from railpatch.profiles.builtin import builtin_profile
from railpatch.profiles.orientation import check_gauge_side, check_placed
from railpatch.profiles.placement import Flange, flange_of, gauge_note

Body = Literal["wheel", "rail"]
WheelCase = WheelRailCase | WheelsetCase
Case = TypeVar("Case", WheelRailCase, WheelsetCase)
BODIES: tuple[Body, ...] = ("wheel", "rail")
# m, between the tops of slices along a rail: more is hardly meant to be left out
HEIGHTS = 0.5e-3
# m: neighbours among slices are hardly further apart; a case that is this much beside all of them,
# and by more than they reach, was hardly meant to be
SLICES, BESIDE = 100.0, 10.0


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
    smoothing = profiles.smoothing
    try:
        told = None if built_in else (folder / name).stat()
    except OSError:
        told = None
    if told is None:
        return load_profile(name, body, folder=folder, smoothing=smoothing, reading=reading)
    state = told.st_dev, told.st_ino, told.st_mtime_ns, told.st_size
    return file_profile(folder / name, state, body, smoothing, reading)


@lru_cache(maxsize=32)
def file_profile(
    path: Path,
    _state: tuple[int, ...],
    body: Body,
    smoothing: float | None,
    reading: Reading | None,
) -> Profile:
    """A file's profile, kept for the next contact as long as the file stays. Raises
    ProfileError."""
    return load_profile(str(path), body, folder=Path(), smoothing=smoothing, reading=reading)


def sections_of(case: WheelCase, side: str) -> Iterator[tuple[Body, SectionProfile]]:
    """Body and section: the profiles along the track and round the wheel of a side."""
    for body, table in zip(BODIES, (case.wheelset, case.track), strict=True):
        for section in getattr(table, side).sections or ():
            yield body, section


def find_sections(case: Case, find: Callable[[str], Path | None]) -> tuple[Case, dict[str, Path]]:
    """The case with the files of its sections in place of their names, and those files by key.

    find: the file of a name; None where there is none: the name stays.
    """
    files: dict[str, Path] = {}
    tables: dict[str, Any] = {}
    for name in ("wheelset", "track"):
        table, sides = getattr(case, name), {}
        for side in SIDES:
            deviation, found = getattr(table, side), []
            for index, section in enumerate(deviation.sections or ()):
                file = find(section.profile)
                if file is not None:
                    files[f"{name}.{side}.sections[{index}]"] = file
                    section = section.model_copy(update={"profile": str(file)})
                found.append(section)
            if found:
                sides[side] = deviation.model_copy(update={"sections": found})
        if sides:
            tables[name] = table.model_copy(update=sides)
    return (case.model_copy(update=tables) if files else case), files


class Shelf:
    """The profiles of a case by body and name, each read once."""

    def __init__(self, case: WheelCase, folder: Path) -> None:
        self.case, self.folder = case, folder
        self.found: dict[tuple[Body, str], Profile] = {}

    def profile(self, body: Body, name: str) -> Profile:
        """One by its name in the case. Raises ProfileError."""
        key = body, name
        if key not in self.found:
            self.found[key] = named_profile(self.case, body, name, self.folder)
        return self.found[key]

    def fill(self) -> None:
        """Reads all that the case names. Raises ProfileError."""
        placed_profiles(self.case, self)
        for side in self.case.sides:
            for body, section in sections_of(self.case, side):
                self.profile(body, section.profile)

    def noisy(self) -> dict[tuple[Body, str], Profile]:
        """Those of files in whose points noise was found."""
        return {key: found for key, found in self.found.items() if found.scatter is not None}

    def with_profiles(self, profiles: dict[tuple[Body, str], Profile]) -> Shelf:
        """A shelf with these in place of those of the files."""
        other = Shelf(self.case, self.folder)
        other.found = {**self.found, **profiles}
        return other


def placed_profiles(case: WheelCase, shelf: Shelf) -> list[Placed]:
    """Of each wheel and each rail of one profile. Raises ProfileError."""
    found = []
    for body in BODIES:
        for side in case.sides:
            if body == "rail" and getattr(case.track, side).sections is not None:
                continue
            _, name = case.profiles.of(body, side)
            assert name is not None
            found.append(Placed(side, body, shelf.profile(body, name)))
    return found


def scene_profiles(case: WheelCase, shelf: Shelf) -> list[Placed]:
    """The same, checked in their places. Raises ProfileError."""
    found = placed_profiles(case, shelf)
    for placed in found:
        _, name = case.profiles.of(placed.body, placed.side)
        assert name is not None
        profile = placed.profile
        if placed.body == "wheel":
            check_wheel(case, placed.side, name, profile)
        elif builtin_profile(name, placed.body) is None:
            check_gauge_side(name, profile.y, profile.z, case.track.gauge_height)
    return found


def check_wheel(case: WheelCase, side: str, name: str, profile: Profile) -> None:
    """Refuses a wheel whose profile's origin is elsewhere than its wheelset says."""
    moved = in_wheelset(case, side, profile)
    check_placed(name, moved.y, moved.z, case.wheelset.flange_back_position)


def in_wheelset(case: WheelCase, side: str, profile: Profile) -> Profile:
    """A wheel's profile with its deviation, in the axes of a right wheel."""
    deviation = getattr(case.wheelset, side)
    mirror = -1.0 if side == "left" else 1.0
    _, y, z = deviation.offset
    return profile.moved(mirror * y, z, mirror * deviation.rotation[0])


def flange_in(case: WheelCase, placed: Placed) -> Flange | None:
    """Of a wheel where its wheelset has it; None of a rail, and where there is none."""
    if placed.body != "wheel":
        return None
    moved = in_wheelset(case, placed.side, placed.profile)
    return flange_of(moved.y, moved.z, case.wheelset.flange_back_position)


def placement_doubts(case: WheelCase, shelf: Shelf) -> list[str]:
    """Warnings of wheels whose flange says that they lie elsewhere than the scene has them, and of
    rails along the track whose heights are not read or whose slices lie far apart."""
    found: dict[str, None] = {}
    for placed in placed_profiles(case, shelf):
        flange = flange_in(case, placed)
        for text in flange.doubts(case.wheelset.flange_back_position) if flange else ():
            found[f"{Path(placed.profile.name).name}: {text}"] = None
    return [*found, *dropped_heights(case, shelf), *far_apart(case), *other_sides(case)]


def other_sides(case: WheelCase) -> list[str]:
    """Warnings of rails whose origin lies beyond the middle of the track."""
    found = []
    for side, sign in (("left", -1), ("right", 1)):
        origin = getattr(case.track, side).origin if side in case.sides else None
        if origin is not None and sign * origin[0] < 0:
            found.append(
                f"track.{side}.origin[0] is {origin[0]:g} m, on the other side of the track: y is "
                "to the right, > 0 of the right rail"
            )
    return found


def far_apart(case: WheelCase) -> list[str]:
    """Warnings of slices along the track at positions in mm."""
    found = []
    for side in case.sides:
        places = [section.position for section in getattr(case.track, side).sections or ()]
        widest = max((b - a for a, b in pairwise(places)), default=0.0)
        if widest > SLICES:
            found.append(
                f"track.{side}.sections: two neighbours lie {widest:g} m apart: positions are in m"
            )
    return found


def beside_sections(case: object) -> list[str]:
    """Warnings of a case that stands far from the slices of its rails: it does not feel them."""
    found: list[str] = []
    if not isinstance(case, WheelCase):
        return found
    for side in case.sides:
        places = [section.position for section in getattr(case.track, side).sections or ()]
        if len(places) < 2:
            continue
        off = max(places[0] - case.wheelset.x, case.wheelset.x - places[-1])
        if off > max(BESIDE, places[-1] - places[0]):
            found.append(
                f"wheelset.x is {case.wheelset.x:g} m, {off:g} m off track.{side}.sections at "
                f"{places[0]:g} to {places[-1]:g} m: the rail is that of their end there"
            )
    return found


def dropped_heights(case: WheelCase, shelf: Shelf) -> list[str]:
    """Warnings of slices along the track whose own heights differ and are not read, as no origin
    says that they count."""
    found = []
    for side in case.sides:
        rail = getattr(case.track, side)
        if rail.origin is not None:
            continue
        tops = [float(shelf.profile("rail", s.profile).z.min()) for s in rail.sections or ()]
        if tops and max(tops) - min(tops) > HEIGHTS:
            found.append(
                f"track.{side}.sections: the highest points of the profiles lie at z = "
                f"{1e3 * min(tops):.2f} to {1e3 * max(tops):.2f} mm of their files, and each is "
                f"put at z = 0 of the track: track.{side}.origin = [y, z] lets heights count as "
                "they are"
            )
    return found


def placement_note(case: WheelCase, placed: Placed) -> str:
    """What is taken for its origin, of a profile from a file; empty where nothing is."""
    wheelset, profile = case.wheelset, placed.profile
    if placed.body == "rail":
        return gauge_note(profile.y, profile.z, case.track.gauge_height)
    flange = flange_in(case, placed)
    if flange is None:
        return ""
    return flange.note(wheelset.flange_back_position, wheelset.flange_back_distance)


def profile_notes(case: WheelCase, shelf: Shelf) -> dict[str, list[str]]:
    """What was assumed of each profile file and done to it, by file as the case names it."""
    notes: dict[str, list[str]] = {}
    every = placed_profiles(case, shelf)
    profiles = [placed.profile for placed in every]
    for side in case.sides:
        for body, section in sections_of(case, side):
            profiles.append(shelf.profile(body, section.profile))
    for profile in profiles:
        if profile.notes:
            notes[Path(profile.name).name] = list(profile.notes)
    for placed in every:
        name = Path(placed.profile.name).name
        note = placement_note(case, placed)
        if name in notes and note and note not in notes[name]:
            notes[name].append(note)
    return notes


def note_lines(notes: dict[str, list[str]]) -> list[str]:
    """One line for each file."""
    return [f"{name}: {'; '.join(texts)}" for name, texts in notes.items()]
