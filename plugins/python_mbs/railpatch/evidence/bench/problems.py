"""Problems of the benchmark: batches of steps that one contact takes, and their scales."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from railpatch.evidence.bench.shapes import (
    POISSON_RATIO,
    SHEAR_MODULUS,
    Floats,
    Shape,
    hertz_pressure,
)

FRICTION = 0.3


@dataclass(frozen=True)
class Scales:
    """What errors are divided by, each [n].

    force: N, friction coefficient times normal force. length: m, c = sqrt(a b). pressure: Pa,
    Hertz's greatest pressure in the ellipse. slip: -, root mean square of the rigid slip weighted
    with Hertz's pressure, whose second moments are a^2/5 and b^2/5. power: W, force times rolling
    speed times slip.
    """

    force: Floats
    length: Floats
    pressure: Floats
    slip: Floats
    power: Floats


@dataclass(frozen=True, eq=False)
class Batch:
    """Steps of one patch.

    name: unique in its set. normal_force: N, [n]. creepage: -, [n, 2]. spin: rad/m, [n].
    speed: m/s. direction: rolling towards +x (1) or -x (-1). layer: shear modulus (Pa) and
    thickness (m) of a third-body layer, or None. ordered: the steps follow each other in time.
    """

    name: str
    shape: Shape
    normal_force: Floats
    creepage: Floats
    spin: Floats
    speed: float = 10.0
    direction: int = 1
    friction: float = FRICTION
    layer: tuple[float, float] | None = None
    ordered: bool = False

    def __len__(self) -> int:
        return len(self.spin)

    def case(self, overrides: Mapping[str, Any], elements: int) -> dict[str, Any]:
        """The case of the first step by a method's overrides, with so many elements across."""
        case = {
            "kind": "patch",
            "material": {"shear_modulus": SHEAR_MODULUS, "poisson_ratio": POISSON_RATIO},
            **self.shape.tables(elements),
            "load": {"normal_force": float(self.normal_force[0])},
            "motion": {
                "creepage": self.creepage[0].tolist(),
                "spin_creepage": float(self.spin[0]),
                "rolling_speed": self.speed,
                "direction": self.direction,
            },
            "friction": {"coefficient": self.friction},
        }
        if self.layer is not None:
            case["layer"] = dict(zip(("shear_modulus", "thickness"), self.layer, strict=True))
        return merged(case, overrides)

    def inputs(self, factor: float = 1.0) -> list[dict[str, Any]]:
        """Fields of rp_input for each step, creepages and spin times the factor."""
        return [
            {
                "normal_force": float(force),
                "creepage": (factor * creepage).tolist(),
                "spin_creepage": float(factor * spin),
                "rolling_speed": self.speed,
                "direction": self.direction,
            }
            for force, creepage, spin in zip(
                self.normal_force, self.creepage, self.spin, strict=True
            )
        ]

    @property
    def axis_ratio(self) -> float:
        """a/b of the contact, or of the box that bounds it."""
        along, across = self.shape.semi_axes(self.normal_force[:1])[0]
        return float(along / across)

    @property
    def exact_pressure(self) -> bool:
        """Whether the greatest pressure is that of a closed form."""
        return self.shape.exact_pressure

    def scales(self) -> Scales:
        """The scales of each step."""
        axes = self.shape.semi_axes(self.normal_force)
        force = self.friction * self.normal_force
        spin_part = self.spin**2 * (axes**2).sum(axis=1) / 5
        slip = np.sqrt((self.creepage**2).sum(axis=1) + spin_part)
        return Scales(
            force=force,
            length=np.sqrt(axes.prod(axis=1)),
            pressure=hertz_pressure(axes, self.normal_force),
            slip=slip,
            power=force * self.speed * slip,
        )

    def true_power(self, force: Floats, moment: Floats) -> Floats:
        """-, power that the creepages supply, -(xi Fx + eta Fy + phi Mz) V, over its scale.

        force, moment: over their scales.
        """
        unit = self.scales()
        work = -(self.creepage * force).sum(axis=1) - self.spin * unit.length * moment
        return np.divide(work, unit.slip, out=np.zeros_like(work), where=unit.slip > 0)

    def checksum(self) -> float:
        """A number that tells these steps from others."""
        total = self.creepage.sum() + 1e-2 * self.spin.sum() + 1e-6 * self.normal_force.sum()
        return float(total)

    def take(self, chosen: NDArray[np.int64]) -> Batch:
        """The steps with these indices."""
        return replace(
            self,
            normal_force=self.normal_force[chosen],
            creepage=self.creepage[chosen],
            spin=self.spin[chosen],
        )


def merged(case: Mapping[str, Any], overrides: Mapping[str, Any]) -> dict[str, Any]:
    """The case with keys of its tables replaced; an override None takes a table or key away."""
    result = dict(case)
    for key, value in overrides.items():
        if value is None:
            result.pop(key, None)
        elif isinstance(value, Mapping):
            result[key] = merged(result.get(key, {}), value)
        else:
            result[key] = value
    return result
