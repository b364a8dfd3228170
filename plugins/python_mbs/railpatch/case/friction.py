"""The table [friction]: the friction laws."""

from __future__ import annotations

import itertools
import math
from collections.abc import Sequence
from typing import Annotated

from pydantic import Field, model_validator

from railpatch import _core
from railpatch.case.types import (
    LEFT_OUT,
    Celsius,
    Points,
    Positive,
    Problems,
    Table,
    between,
    key,
    likely,
    more_than,
    one_of,
    refuse,
    relation,
    within,
)

Coefficient = Annotated[float, between(0, 10)]
NotNegative = Annotated[float, between(0, 100)]
Scale = Annotated[list[NotNegative], Field(min_length=2, max_length=2)]
# key of a step and the key of the table that it moves
MOVED_FRICTION = {"friction_scale": "scale"}
Amplitude = Annotated[float, within("friction_amplitude")]
Terms = Annotated[list[Amplitude], Field(min_length=1, max_length=2)]
Speeds = Annotated[list[Positive], Field(min_length=1, max_length=2)]
# keys of each law, needed and optional
KEYS: dict[str, tuple[tuple[str, ...], tuple[str, ...]]] = {
    "coulomb": (("coefficient",), ()),
    "slip_velocity": ((), ("memory_distance", "memory_speed")),
    "temperature": (
        ("reference", "change", "reference_temperature", "temperature_range"),
        (),
    ),
}
SHAPES: dict[str, tuple[str, ...]] = {
    **dict.fromkeys(_core.CHOICES["slip_law"], ("kinetic", "amplitude", "halving_speed")),
    "polach": ("coefficient", "polach_a", "polach_b"),
}


class Friction(Table):
    """Friction law."""

    law: one_of("friction_law") = Field(default="coulomb", description="friction law (no unit)")
    coefficient: Coefficient | None = Field(
        **likely(
            "friction_coefficient",
            default=None,
            description="-, coefficient of friction; with polach: at rest",
        )
    )
    shape: one_of("slip_law", besides=("polach",)) = Field(
        default="exponential",
        description="of slip_velocity (no unit): mu = kinetic + sum of amplitude f(s/halving_speed)"
        " with f(u) = 2^-u, 1/(1 + u) or max(0, 1 - u/2) over the speed s of micro-slip; polach: "
        "coefficient ((1 - polach_a) exp(-polach_b s) + polach_a)",
    )
    kinetic: Coefficient | None = Field(
        default=None, description="-, coefficient of friction at high micro-slip"
    )
    amplitude: Amplitude | Terms | None = Field(
        default=None, description="-, at rest above kinetic; one or two terms"
    )
    halving_speed: Positive | Speeds | None = Field(
        **likely(
            "friction_halving_speed",
            default=None,
            description="m/s, at which a term is half its amplitude; one for each term",
        )
    )
    polach_a: Annotated[float, between(0, 1)] | None = Field(
        default=None, description="-, A of Polach's law, friction at high micro-slip over at rest"
    )
    polach_b: Annotated[float, more_than(0, 1e6)] | None = Field(
        default=None, description="s/m, B of Polach's law"
    )
    memory_distance: float = key(of="friction_memory_distance")
    memory_speed: float = key(of="friction_memory_speed")
    reference: Coefficient | None = Field(
        default=None, description="-, of the temperature law up to reference_temperature"
    )
    change: Annotated[float, between(-10, 10)] | None = Field(
        default=None, description="-, from there to the end of temperature_range, linear"
    )
    reference_temperature: Celsius | None = Field(
        default=None, description="degrees C, where the temperature law begins"
    )
    temperature_range: Annotated[float, more_than(0, 1e5)] | None = Field(
        default=None, description="K, over which it changes"
    )
    factor: Points | None = Field(
        default=None,
        description="m or rad and -, [[place, factor], ...]: factor of the law over the lateral "
        "position in a patch (m) or over the angle of the rail's surface (rad, > 0 towards the "
        "gauge face on either side)",
    )

    along_track: Points | None = Field(
        default=None,
        description="m and -, [[x, factor], ...]: factor of the law over the position along the "
        "track, wheelset.x (wheel_rail, wheelset)",
    )

    scale: Scale = Field(
        default=[1.0, 1.0],
        description="-, factor of the law on the left and right wheel, beside the other factors; "
        "of a patch the second counts. Moves",
    )

    @model_validator(mode="after")
    def _by_law(self) -> Friction:
        refuse(self._keys_of_law())
        refuse(self._values())
        return self

    def _keys_of_law(self) -> Problems:
        needed, optional = KEYS[self.law]
        if self.law == "slip_velocity":
            needed = SHAPES[self.shape]
        allowed = {"law", "factor", "along_track", "scale", *needed, *optional}
        if self.law == "slip_velocity":
            allowed.add("shape")
        foreign = [
            name
            for name, field in type(self).model_fields.items()
            if name not in allowed and getattr(self, name) != field.default
        ]
        for name in needed:
            # of Coulomb's alone a liquid may have friction of its own: see missing()
            if getattr(self, name) is None and (foreign or self.law != "coulomb"):
                yield relation(name, "missing", f"a number with {self._named()}")
        for name in foreign:
            yield relation(name, repr(getattr(self, name)), f"{LEFT_OUT} with {self._named()}")
        if self.memory_distance == 0 and "memory_speed" in allowed:
            least = type(self).model_fields["memory_speed"].default
            if self.memory_speed != least:
                why = "only with memory_distance > 0: nothing is remembered without"
                yield relation("memory_speed", self.memory_speed, why)
        for name in ("factor", "along_track"):
            yield from increasing(name, getattr(self, name) or ())

    def missing(self) -> Problems:
        """Of Coulomb's law without a coefficient, where no liquid has one."""
        if self.law == "coulomb" and self.coefficient is None:
            yield relation("friction.coefficient", "missing", f"a number with {self._named()}")

    def _named(self) -> str:
        shape = f" and shape = '{self.shape}'" if self.law == "slip_velocity" else ""
        return f"law = '{self.law}'{shape}"

    def _values(self) -> Problems:
        if len(self.terms[0]) != len(self.terms[1]):
            shown = str(self.halving_speed)
            yield relation("halving_speed", shown, "as many numbers as amplitude")
        if self.law == "slip_velocity" and self.shape != "polach":
            assert self.kinetic is not None
            if self.kinetic + sum(min(a, 0.0) for a in self.terms[0]) < 0:
                shown = str(self.amplitude)
                yield relation("amplitude", shown, "a law that does not fall below 0")
        if self.law == "temperature":
            assert self.reference is not None
            assert self.change is not None
            if not 0 <= self.reference + self.change <= 10:
                yield relation("change", self.change, "reference + change within 0 ... 10")
        for name in ("factor", "along_track"):
            points = getattr(self, name)
            if (
                points is not None
                and not 0 <= min(v for _, v in points) <= max(v for _, v in points) <= 100
            ):
                yield relation(name, str(points), "factors within 0 ... 100")

    @property
    def moving(self) -> tuple[str, ...]:
        """The factor of each wheel, by the name of a step's key."""
        return tuple(MOVED_FRICTION)

    @property
    def terms(self) -> tuple[list[float], list[float]]:
        """Amplitudes (-) and halving speeds (m/s) of the slip-velocity law."""
        if self.law != "slip_velocity":
            return [], []
        if self.shape == "polach":
            assert self.coefficient is not None
            assert self.polach_a is not None
            assert self.polach_b is not None
            return [self.coefficient * (1 - self.polach_a)], [math.log(2) / self.polach_b]
        return as_list(self.amplitude), as_list(self.halving_speed)

    @property
    def kinetic_coefficient(self) -> float:
        """-, of the slip-velocity law at high micro-slip."""
        if self.shape == "polach":
            assert self.coefficient is not None
            assert self.polach_a is not None
            return self.coefficient * self.polach_a
        assert self.kinetic is not None
        return self.kinetic

    @property
    def greatest_anywhere(self) -> float:
        """-, greatest coefficient that the law may give at any place."""
        factor = 1.0 if self.factor is None else max(value for _, value in self.factor)
        return factor * max(self.scale) * self.greatest

    @property
    def greatest(self) -> float:
        """-, greatest coefficient that the law may give, without factor; infinite where a liquid's
        counts."""
        if self.law == "coulomb":
            return math.inf if self.coefficient is None else self.coefficient
        if self.law == "temperature":
            assert self.reference is not None
            assert self.change is not None
            return max(self.reference, self.reference + self.change)
        return self.kinetic_coefficient + sum(max(a, 0.0) for a in self.terms[0])


def as_list(value: float | list[float] | None) -> list[float]:
    """One number as a list."""
    return value if isinstance(value, list) else [] if value is None else [value]


def increasing(name: str, points: Sequence[Sequence[float]]) -> Problems:
    """Where the first numbers of the pairs do not increase."""
    places = [place for place, _ in points]
    if any(b <= a for a, b in itertools.pairwise(places)):
        yield relation(name, str(points), "pairs with increasing first numbers")
