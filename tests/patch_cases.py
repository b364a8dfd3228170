"""Patch cases and closed forms that several test folders share."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import railpatch

STEEL = {"shear_modulus": 82e9, "poisson_ratio": 0.28}


def modulus(material: dict[str, float] = STEEL) -> float:
    """Pa, contact modulus of two equal bodies, E* = G / (1 - nu)."""
    return material["shear_modulus"] / (1 - material["poisson_ratio"])


def patch_case(
    geometry: dict[str, Any],
    *,
    force: float | None = None,
    approach: float | None = None,
    elements: int | Sequence[int] | None = None,
    element_size: Sequence[float] | None = None,
    fitted: Sequence[int] | None = None,
    creepage: Sequence[float] | None = None,
    spin: float = 0.0,
    direction: int = 1,
    speed: float = 10.0,
    friction: float = 0.3,
    material: dict[str, float] = STEEL,
    layer: dict[str, float] | None = None,
    **method: Any,
) -> dict[str, Any]:
    """A case of one patch; without creepage the normal problem alone."""
    grid: dict[str, Any] = {}
    if elements is not None:
        grid["elements"] = [elements, elements] if isinstance(elements, int) else list(elements)
    if element_size is not None:
        grid["element_size"] = list(element_size)
    if fitted is not None:
        grid["fitted"] = list(fitted)
    case: dict[str, Any] = {
        "kind": "patch",
        "material": dict(material),
        "geometry": geometry,
        "load": {"normal_force": force} if approach is None else {"approach": approach},
        "grid": grid,
        "method": method,
    }
    if creepage is not None:
        case["motion"] = {
            "creepage": list(creepage),
            "spin_creepage": spin,
            "direction": direction,
            "rolling_speed": speed,
        }
        case["friction"] = {"law": "coulomb", "coefficient": friction}
    if layer is not None:
        case["layer"] = layer
    return case


def solve(case: dict[str, Any], fields: bool = False) -> railpatch.Result:
    """The converged result; a failure shows the case."""
    result = railpatch.solve(case, fields=fields)
    assert result.status == "converged", f"{result.status} residual {result['residual']}: {case}"
    return result


@dataclass(frozen=True)
class Line:
    """A row of a printed table: what was found, what was wanted, how far apart they may be."""

    scene: str
    value: float
    target: float
    bound: float

    @property
    def error(self) -> float:
        return self.value - self.target

    @property
    def good(self) -> bool:
        return abs(self.error) <= self.bound

    def __str__(self) -> str:
        return (
            f"{self.scene:<44} {self.value: .6e}  target {self.target: .6e}  "
            f"error {self.error: .1e}  bound {self.bound:.1e}{'' if self.good else '  <-- FAILED'}"
        )


def check(lines: Sequence[Line]) -> None:
    """Prints the table (pytest -s, or with a failure) and asserts every row."""
    table = "\n".join(str(line) for line in lines)
    print(f"\n{table}")
    assert all(line.good for line in lines), f"\n{table}"
