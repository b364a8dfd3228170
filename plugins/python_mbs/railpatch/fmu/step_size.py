"""The communication step that masters take unless told otherwise: DefaultExperiment's stepSize.

It is what held forces bear (docs/cosimulation.md): the lesser of

- 0.1 sqrt(m/k), where z or roll moves a wheel's height: the lag then takes 2.5 % of critical
  damping from its bounce. k is the contact's stiffness at the start values, the sum of
  3/2 N/delta cos^2 of the contact angle over a wheel's patches (Hertz: N ~ delta^(3/2)), of the
  stiffer wheel; m half a wheelset's mass.
- 1/c, c = f/V (1/m + r^2/I), where it rolls: creep forces do not overshoot. f is Kalker's linear
  one, C11 G a b, with C11 = 4.5 (a = b, Poisson's ratio near 0.28; Kalker 1967) and a b the contact
  area over pi; r the wheel's radius and I half a wheelset's inertia about its axle.

and of 1 ms, but not below 1 us, rounded down to 1, 2 or 5 times a power of ten.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import Any

from railpatch.case.load import Case
from railpatch.case.patch import PatchCase
from railpatch.case.types import SIDES
from railpatch.fmu.table import Kind, Table

SHORTEST, LONGEST = 1e-6, 1e-3  # s
CREEP_COEFFICIENT = 4.5  # C11
STIFFNESS = 1e9  # N/m, of a contact that is not there at the start
RADIUS = 0.46  # m, of the wheel that a patch belongs to


@dataclass(frozen=True)
class StepSize:
    """The step and where it comes from."""

    seconds: float
    mass: float  # kg, of a wheel
    inertia: float  # kg m^2, of a wheel about the axle
    stiffness: float | None  # N/m; None: the height is found
    creep: float | None  # 1/s; None: nothing rolls
    touching: bool  # at the start

    def sentence(self) -> str:
        """What the page says of it."""
        parts = []
        if self.stiffness is not None:
            which = (
                "the start's contact" if self.touching else "a typical contact, as none is there,"
            )
            parts.append(
                f"0.1 sqrt(m/k) = {0.1 * math.sqrt(self.mass / self.stiffness):.2g} s, with the "
                f"stiffness of {which} k = {self.stiffness:.2g} N/m"
            )
        if self.creep is not None:
            parts.append(
                f"1/c = {1 / self.creep:.2g} s, above which creep forces overshoot, with "
                f"c = f/V (1/m + r<sup>2</sup>/I) and I = {self.inertia:g} kg m<sup>2</sup>"
            )
        parts.append(f"{LONGEST:g} s")
        least = ", of ".join(parts)
        return (
            f"DefaultExperiment's stepSize, {self.seconds:g} s, is what forces that are held bear "
            f"with m = {self.mass:g} kg on a wheel: the least of {least}, rounded down. "
            "Steps of 1 ms let a wheel of such a mass bounce off its rail where z is an input."
        )


def step_size_of(case: Case, kind: Kind, table: Table, start: dict[str, Any]) -> StepSize:
    """start: data of the result at the start values."""
    mass, inertia = typical_wheel(table, kind)
    wheels = [list(patches_of(wheel)) for wheel in wheels_of(start)]
    stiffness = creep = None
    # the load of both wheels leaves their roll to the master
    if "position" in kind.conditions or len(kind.sides) > 1:
        stiffness = max((stiffness_of(patches) for patches in wheels), default=0.0) or STIFFNESS
    if case.has_tangential:
        alone = isinstance(case, PatchCase)
        radius = RADIUS if alone else case.wheelset.nominal_radius
        given = case.motion.rolling_speed if alone else None
        modulus = 2 / sum(1 / g for g in both(case.material.shear_modulus))
        rate = max((creep_of(patches, modulus, given) for patches in wheels), default=0.0)
        creep = rate * (1 / mass + radius**2 / inertia) or None
    bounds = [LONGEST]
    bounds += [0.1 * math.sqrt(mass / stiffness)] if stiffness is not None else []
    bounds += [1 / creep] if creep is not None else []
    touching = any(wheels)
    seconds = rounded_down(max(min(bounds), SHORTEST))
    return StepSize(seconds, mass, inertia, stiffness, creep, touching)


def typical_wheel(table: Table, kind: Kind) -> tuple[float, float]:
    """Half of the mass and of the inertia about the axle that largest_step starts with."""
    listed = replace(kind, conditions=kind.conditions | {"largest step"})
    start = {v.name: v.start for v in table.variables(listed)}
    mass, inertia = start["wheelset.mass"], start["wheelset.inertia[2]"]
    assert mass is not None
    assert inertia is not None
    return mass / 2, inertia / 2


def both(value: Any) -> list[float]:
    """Of wheel and rail."""
    return list(value) if isinstance(value, (list, tuple)) else [value, value]


def wheels_of(start: dict[str, Any]) -> list[dict[str, Any]]:
    """Results of the wheels, or of the patch."""
    found = [start[side] for side in SIDES if start.get(side) is not None]
    return found or [start]


def patches_of(wheel: dict[str, Any]) -> Iterator[dict[str, Any]]:
    """Those that carry something."""
    for patch in wheel.get("patches", [wheel]):
        if (patch.get("normal_force") or 0) > 0:
            yield patch


def stiffness_of(patches: list[dict[str, Any]]) -> float:
    """N/m, vertical, of one wheel."""
    total = 0.0
    for patch in patches:
        approach = patch.get("approach")
        if approach is not None and approach > 0:
            upright = math.cos(patch.get("contact_angle") or 0.0) ** 2
            share = patch.get("share")
            total += (
                1.5 * patch["normal_force"] / approach * upright * (1 if share is None else share)
            )
    return total


def creep_of(patches: list[dict[str, Any]], modulus: float, given: float | None) -> float:
    """f/V in N s/m, of one wheel. given: the rolling speed that is an input."""
    total = 0.0
    for patch in patches:
        speed, area = patch.get("rolling_speed", given), patch.get("contact_area")
        if speed is not None and speed > 0 and area is not None and area > 0:
            total += CREEP_COEFFICIENT * modulus * area / math.pi / speed
    return total


def rounded_down(value: float) -> float:
    """To 1, 2 or 5 times a power of ten."""
    power = math.floor(math.log10(value))
    first = max(digit for digit in (1, 2, 5) if digit * 10.0**power <= value * (1 + 1e-12))
    return float(f"{first}e{power}")
