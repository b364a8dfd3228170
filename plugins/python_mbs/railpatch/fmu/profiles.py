"""Further profiles in an FMU, beside the case's own, which a fixed parameter chooses from."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import product
from pathlib import Path
from typing import Any, Literal

from railpatch.case.load import Scene
from railpatch.case.patch import PatchCase
from railpatch.case.to_core import config_of
from railpatch.case.wheel import WheelRailCase, WheelsetCase
from railpatch.contact import Contact
from railpatch.errors import CaseError, ProfileError
from railpatch.fmu.table import MOST_ITEMS
from railpatch.result import SOLVED

Body = Literal["wheel", "rail"]
BODIES: tuple[Body, ...] = ("wheel", "rail")
# declared types of the parameters
TYPES = {"wheel": "WheelProfile", "rail": "RailProfile"}


@dataclass(frozen=True)
class Choices:
    """The case's own profile and the further ones, of each body that has any."""

    scene: Scene
    sources: dict[Body, list[str]]

    def items(self, body: Body) -> list[str]:
        """What they are called: built-in names, names of files."""
        return [Path(source).name for source in self.sources[body]]

    def conditions(self) -> set[str]:
        """What the variables depend on."""
        return {f"{body} profiles" for body in self.sources}

    def scenes(self) -> Iterator[tuple[str, Scene]]:
        """Every combination but the case's own, and what it is called."""
        for chosen in product(*self.sources.values()):
            named = dict(zip(self.sources, chosen, strict=True))
            scene = self.scene
            for body, source in named.items():
                scene = with_profile(scene, body, source)
            if any(source != self.sources[body][0] for body, source in named.items()):
                label = ", ".join(f"profiles.{body} = {s!r}" for body, s in named.items())
                yield label, scene

    def arrays(self) -> Iterator[tuple[Body, int, dict[str, Any]]]:
        """Body, number from 2 on, and arrays of every further profile."""
        for body, sources in self.sources.items():
            for number, source in enumerate(sources[1:], 2):
                yield body, number, arrays_of(with_profile(self.scene, body, source), body)


def choices_of(scene: Scene, further: dict[Body, Sequence[str]]) -> Choices:
    """The profiles to choose from. Raises CaseError where a case of this kind has no choice."""
    sources: dict[Body, list[str]] = {}
    for body in BODIES:
        if further.get(body):
            sources[body] = [own_source(scene, body), *map(str, further[body])]
    choices = Choices(scene, sources)
    for body in sources:
        items = choices.items(body)
        double = [item for item in items if items.count(item) > 1]
        if double:
            raise CaseError(f"--{body}-profile: {double[0]!r} is there twice, allowed once")
        if len(items) > MOST_ITEMS:
            raise CaseError(
                f"--{body}-profile: given {len(items) - 1} times, allowed up to {MOST_ITEMS - 1}"
            )
    return choices


def own_source(scene: Scene, body: Body) -> str:
    """The case's own profile, where both sides have the same one. Raises CaseError."""
    case = scene.case
    if isinstance(case, PatchCase):
        raise CaseError(f"--{body}-profile: given, allowed with wheels only")
    if body == "rail" and any(getattr(case.track, side).sections for side in case.sides):
        raise CaseError(
            "--rail-profile: given, allowed where the track's rail has no 'sections': profiles "
            "along the track are no choice"
        )
    if body == "wheel" and round_wheels(case):
        raise CaseError(
            "--wheel-profile: given, allowed where the wheels have no 'sections': profiles round "
            "a wheel are no choice"
        )
    own = {case.profiles.of(body, side)[1] for side in case.sides}
    if len(own) > 1:
        found = " and ".join(repr(case.profiles.of(body, side)[1]) for side in case.sides)
        raise CaseError(
            f"--{body}-profile: given, allowed where left and right {body} have the same profile, "
            f"here {found}"
        )
    return str(own.pop())


def round_wheels(case: WheelRailCase | WheelsetCase) -> bool:
    """Whether a wheel's profile changes round it."""
    return any(case.section_lists("wheelset").values())


def file_conditions(scene: Scene) -> set[str]:
    """What the variables depend on where profiles are read at run time. Raises CaseError."""
    case = scene.case
    if isinstance(case, PatchCase):
        raise CaseError("--profile-files: given, allowed with wheels only")
    if round_wheels(case):
        raise CaseError(
            "--profile-files: given, allowed where the wheels have no 'sections', which count then"
        )
    along = any(getattr(case.track, side).sections for side in case.sides)
    # a rail that changes along the track is not one profile
    return {"wheel files"} if along else {"wheel files", "rail files"}


def with_profile(scene: Scene, body: Body, source: str) -> Scene:
    """The scene with another profile of that body, on both sides."""
    case = scene.case
    assert not isinstance(case, PatchCase)
    update = {body: source, f"{body}_left": None, f"{body}_right": None}
    profiles = case.profiles.model_copy(update=update)
    return replace(scene, case=case.model_copy(update={"profiles": profiles}))


def arrays_of(scene: Scene, body: Body) -> dict[str, Any]:
    """The arrays of the scene's profile."""
    return next(arrays for arrays in config_of(scene)[body] if arrays is not None)


def check_starts(choices: Choices, name: str) -> list[str]:
    """Solves the start values with each combination; gives a warning for each that touches nothing.

    name: of the case. Raises CaseError.
    """
    warnings = []
    for label, scene in choices.scenes():
        try:
            status = Contact(scene).step().status
        except (CaseError, ProfileError) as error:
            raise CaseError(f"{name} with {label}: {error}") from None
        if status not in SOLVED:
            raise CaseError(f"{name} with {label}: the start values cannot be solved: {status}")
        if status == "no_contact":
            warnings.append(f"{name} with {label}: no contact at the start values")
    return warnings
