"""How far the noise of profile points leaves the greatest pressure open.

Each contact is solved again, without its tangential problem and on a coarse grid, with the fitted
profiles and with DRAWS others that noise of the size found might have left (``profiles.scatter``).
The relative changes by these say what noise does; that of the profiles smoothed once more says what
the smoothing takes from the shape, at the least: it is counted once more. Twice the root of the sum
of both mean squares is what some 95 % of the real errors stay below (docs/profiles.md).
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from math import isfinite, sqrt
from pathlib import Path
from typing import Any

from railpatch import _core
from railpatch.case.common import Grid
from railpatch.case.fluid import MOVED
from railpatch.case.friction import MOVED_FRICTION
from railpatch.case.load import Scene
from railpatch.case.resolve import resolved
from railpatch.case.scene_profiles import BODIES, Shelf, placed_profiles, placement_doubts
from railpatch.case.to_core import config_of, input_of, profiles_config
from railpatch.case.wheel import Wheel, WheelRailCase, WheelsetCase
from railpatch.profiles.scatter import drawn
from railpatch.result import CARRIES

# of which the root mean square is known to 18 %
DRAWS = 16
# times that: what 95 % of errors with a normal distribution stay below
BOUND = 2.0
# elements across a contact, [along rolling, lateral]: noise changes the shape across
ELEMENTS = [8, 20]
# inputs of heat, liquids and friction: without a tangential problem there is none of them
OF_TRACTIONS = {"bulk_temperature", *MOVED, *MOVED_FRICTION}
# m, lateral positions that stand for those of a run; N, of a wheel where the scene has no load
POSITIONS = (-6e-3, -4e-3, -2e-3, 0.0, 2e-3, 4e-3, 6e-3)
USUAL_LOAD = 80e3
# of the greatest pressure, beyond which a warning says so
LIMIT = 0.05
REMEDY = "measure closer or more quietly, average several measurements, or say profiles.smoothing"


WheelCase = WheelRailCase | WheelsetCase


@dataclass(frozen=True)
class Replica:
    """The contacts of a scene: with the profiles that were fitted, smoothed once more, drawn."""

    contacts: list[Any]
    sides: tuple[str, ...]

    def errors(self, values: dict[str, Any], solved: dict[str, Any]) -> dict[str, float]:
        """-, by side, what 95 % of the relative errors of the greatest pressure stay below at these
        inputs of the core, of wheels that carry something; NaN where half of the draws or more do
        not.

        solved: the core's result for them, with all of the scene's theories.
        """
        values = {name: value for name, value in values.items() if name not in OF_TRACTIONS}
        found: list[dict[str, float]] = []
        for contact in self.contacts:
            contact.reset()
            found.append(pressures(contact.step(values), self.sides))
        errors = {}
        for side in pressures(solved, self.sides):
            pressure = found[0].get(side, 0.0)
            changes = [one[side] / pressure - 1.0 for one in found[2:] if side in one and pressure]
            if 2 * len(changes) <= DRAWS:
                errors[side] = float("nan")
                continue
            square = sum(change * change for change in changes) / len(changes)
            shape = found[1].get(side, pressure) / pressure - 1.0
            errors[side] = BOUND * sqrt(square + shape * shape)
        return errors


def lines(errors: Mapping[str, float], files: Iterable[str]) -> list[str]:
    """One line on each wheel's error, or on both where they are alike. files: with noise."""
    of = f"for the noise of {' and '.join(dict.fromkeys(files))}"
    found = []
    for side, error in errors.items():
        size = f"{100 * error:.2g} %" if isfinite(error) else "an unknown share"
        whose = f"{side} wheel: " if len(errors) > 1 else ""
        found.append(f"{whose}max_pressure is known to within {size} (of 95 % of cases) {of}")
    # two wheels alike
    alike = len(found) > 1 and len(set(map(str, errors.values()))) == 1
    return [found[0].split(": ", 1)[1]] if alike else found


def doubts(errors: Mapping[str, float], files: Iterable[str]) -> list[str]:
    """Those of lines() that are warnings, with what to do."""
    great = {side: error for side, error in errors.items() if not error <= LIMIT}
    return [f"{line}: {REMEDY}" for line in lines(great, files)]


def run_doubts(case: WheelCase, folder: Path, shelf: Shelf | None = None) -> list[str]:
    """Warnings for a run of a case: of flanges that are not where the scene has them, and of each
    pair of profiles the greatest error within 6 mm of the track's middle, where it is above LIMIT.
    Raises CaseError, ProfileError."""
    shelf = shelf or Shelf(case, folder)
    found: dict[str, None] = dict.fromkeys(placement_doubts(case, shelf))
    pairs: set[tuple[str, ...]] = set()
    for side in case.sides:
        names = tuple(str(case.profiles.of(body, side)[1]) for body in BODIES)
        if names in pairs and getattr(case.track, side).sections is None:
            continue
        pairs.add(names)
        replica = replica_of(Scene(wheel_alone(case, side), folder), shelf)
        errors = {} if replica is None else errors_of_run(replica, wheel_alone(case, side))
        if not errors:
            continue
        at = max(errors, key=lambda y: errors[y])
        for line in doubts({side: errors[at]}, files_of(case, side, shelf)):
            found[f"at y = {1e3 * at:g} mm {line}"] = None
    return list(found)


def errors_of_run(replica: Replica, case: WheelRailCase) -> dict[float, float]:
    """-, errors by lateral position, of those that have one."""
    values = input_of(case)
    errors = {}
    for y in POSITIONS:
        solved = replica.contacts[0].step({**values, "y": y})
        for error in replica.errors({**values, "y": y}, solved).values():
            errors[y] = error
    return {y: error for y, error in errors.items() if isfinite(error)}


def files_of(case: WheelCase, side: str, shelf: Shelf) -> list[str]:
    """Names of the files with noise on one side."""
    names = {("wheel", case.profiles.of("wheel", side)[1])}
    sections = getattr(case.track, side).sections
    rails = [s.profile for s in sections] if sections else [case.profiles.of("rail", side)[1]]
    names |= {("rail", name) for name in rails}
    return [Path(name).name for body, name in shelf.noisy() if (body, name) in names]


def wheel_alone(case: WheelCase, side: str) -> WheelRailCase:
    """One wheel of a case, upright at the middle of the track, under its load."""
    load = case.wheelset.vertical_force
    if load is not None:
        load = load / len(case.sides)
    still = {"y": 0.0, "roll": 0.0, "yaw": 0.0, "pitch_rate": 0.0, "z": None}
    wheelset = case.wheelset.model_copy(update={**still, "vertical_force": load or USUAL_LOAD})
    tables = {name: getattr(case, name) for name in WheelRailCase.model_fields if name != "wheel"}
    given = {**tables, "kind": "wheel_rail", "wheelset": wheelset, "wheel": Wheel(side=side)}
    return WheelRailCase.model_construct(**given)


def pressures(raw: dict[str, Any], sides: Iterable[str]) -> dict[str, float]:
    """Pa, the greatest one of each wheel that carries something."""
    found = {}
    for side in sides:
        values = [patch["max_pressure"] for patch in raw[side]["patches"]]
        if raw[side]["status"] in CARRIES and max(values, default=0.0) > 0.0:
            found[side] = float(max(values))
    return found


def replica_of(scene: Scene, shelf: Shelf) -> Replica | None:
    """For the errors of a scene; None where no profile has noise. Raises CaseError."""
    case = resolved(scene.case)
    assert isinstance(case, WheelRailCase | WheelsetCase)
    shelf.fill()
    noisy = shelf.noisy()
    if not noisy:
        return None
    method = case.method.model_copy(
        update={
            "tangential": "none",
            "derivatives": False,
            "max_work": None,
            "spin_offset": "automatic",
        }
    )
    bare = case.model_copy(update={"method": method, "grid": Grid(elements=ELEMENTS)})
    # what a step finds is given then
    config = {
        **config_of(Scene(bare, scene.folder), shelf),
        "roll_balanced": 0,
        "axle_free": 0,
    }
    draws = {key: drawn(one, DRAWS, (i,)) for i, (key, one) in enumerate(noisy.items())}
    shelves = [shelf.with_profiles({key: draws[key][k] for key in noisy}) for k in range(1 + DRAWS)]
    profiles = [profiles_config(bare, one, placed_profiles(bare, one)) for one in shelves]
    configs = [config, *({**config, **one} for one in profiles)]
    return Replica([_core.Contact(one, False) for one in configs], case.sides)
