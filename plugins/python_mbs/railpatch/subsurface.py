"""Stresses and displacements below the surface."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Protocol

import numpy as np
from numpy.typing import ArrayLike, NDArray

from railpatch import _core
from railpatch.case.arrays import plain_numbers
from railpatch.case.asked import depth_doubts
from railpatch.case.theories import has_tractions
from railpatch.case.types import BODIES, SIDES
from railpatch.errors import CaseError

# components of stress and of displacement along x, s, n of the contact frame, n into the rail
STRESSES = ("xx", "ss", "nn", "xs", "sn", "nx")
DIRECTIONS = ("x", "s", "n")
DEEPEST = 1.0  # m
DANG_VAN = 1 / 3


class Stepped(Protocol):
    """A railpatch.Contact."""

    _core: Any
    _case: Any


class Subsurface:
    """Stresses below the patches of a contact's last step, in wheel or rail as half-spaces under
    the patch's pressure and tractions.

    Each element is a uniformly loaded rectangle (Love 1929; Johnson 1985, chapter 3), all of them
    at once by FFT: docs/subsurface.md. Memory is taken once; later calls take none in the core.

    >>> contact = Contact("patch.toml")
    >>> contact.step(creepage=[1e-3, 0.0])
    >>> below = Subsurface(contact, depth=[1e-3, 2e-3, 3e-3])
    >>> below.solve(body="rail")["von_mises"].max()
    """

    def __init__(
        self,
        contact: Stepped,
        depth: ArrayLike,
        *,
        displacements: bool = False,
        dang_van: float = DANG_VAN,
    ) -> None:
        """depth: m, [depths], 0 ... 1, below the body's own surface. displacements: beside the
        stresses, not of a line contact. dang_van: weight of the hydrostatic stress in Dang Van's
        criterion, 0 ... 3. Raises CaseError.
        """
        self._depth = numbers("depth", depth)
        if self._depth.ndim != 1 or not 1 <= len(self._depth) <= 1000:
            raise CaseError(
                f"depth: value has shape {self._depth.shape}, allowed 1 to 1000 numbers"
            )
        inside("depth", self._depth, 0.0, DEEPEST)
        inside("dang_van", numbers("dang_van", dang_van), 0.0, 3.0)
        if contact.case.material.influence_file is not None:
            raise CaseError(
                "material.influence_file: given, allowed below the surface: left out, it has the "
                "surface alone"
            )
        self._core = contact._core.below(self._depth.tolist(), displacements, float(dang_van))
        self._displacements = displacements
        self._contact = contact
        self._deepest = {"depth": float(self._depth.max())}

    @property
    def warnings(self) -> list[str]:
        """Depths that can hardly be meant, of all and of the points of the last at(): see
        Result.warnings."""
        return depth_doubts(self._deepest)

    def solve(self, *, side: str = "right", patch: int = 0, body: str = "rail") -> dict[str, Any]:
        """Below one patch of the last step, at the depths and under each element.

        depth [depths], x [nx], y [ny]: m. stress [6, depths, ny, nx]: Pa, components STRESSES,
        tension > 0; principal_stress [3, depths, ny, nx], from the greatest; von_mises,
        greatest_shear [depths, ny, nx]; dang_van [depths, ny]: greatest over the passage of the
        material along x; with displacements displacement [3, depths, ny, nx], m, against the body
        far away. Of a line contact ny is 1. Raises CaseError, LookupError where the last step has
        no such patch or its theories give no pressure or no tractions element by element.
        """
        case = self._contact._case
        if case.has_tangential and not has_tractions(case.method.tangential):
            raise LookupError(
                f"method.tangential = {case.method.tangential!r} gives no pressure with tractions "
                "element by element"
            )
        self._core.solve(*place(side, patch, body))
        x, y = self._core.field("x"), self._core.field("y")
        grid = (len(self._depth), len(y), len(x))
        found: dict[str, Any] = {"depth": self._depth.copy(), "x": x, "y": y}
        for name in _core.SUBSURFACE_FIELDS:
            if name in found or (name == "displacement" and not self._displacements):
                continue
            values = self._core.field(name)
            found[name] = values.reshape(
                grid[:2] if name == "dang_van" else (*parts(len(values), grid), *grid)
            )
        return found

    def at(
        self, points: ArrayLike, *, side: str = "right", patch: int = 0, body: str = "rail"
    ) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Stress [n, 6] (Pa) and displacement [n, 3] (m) at points [n, 3]: m, x and y of the
        patch's frame and the depth. Costs as much as points times elements; not of a line
        contact. Raises CaseError, LookupError.
        """
        given = numbers("points", points)
        if given.ndim != 2 or given.shape[1] != 3:
            raise CaseError(f"points: value has shape {given.shape}, allowed (n, 3)")
        inside("points[:, 2]", given[:, 2], 0.0, DEEPEST)
        self._deepest["points"] = float(given[:, 2].max(initial=0.0))
        found = self._core.at(*place(side, patch, body), given).reshape(-1, 9)
        return found[:, :6], found[:, 6:]


def numbers(name: str, value: ArrayLike) -> NDArray[np.float64]:
    """Finite ones. Raises CaseError."""
    found = np.ascontiguousarray(plain_numbers(name, value))
    if not np.isfinite(found).all():
        raise CaseError(f"{name}: value is not finite, allowed finite numbers")
    return found


def inside(name: str, values: NDArray[np.float64], low: float, high: float) -> None:
    """Raises CaseError for the first one outside."""
    wrong = np.atleast_1d(values)[(values < low) | (values > high)] if np.size(values) else []
    if len(wrong):
        raise CaseError(f"{name}: value is {wrong[0]:g}, allowed {low:g} to {high:g}")


def place(side: str, patch: int, body: str) -> tuple[int, int, int]:
    """Their numbers. Raises CaseError."""
    words: tuple[tuple[str, str, Sequence[str]], ...] = (
        ("side", side, SIDES), ("body", body, BODIES),
    )  # fmt: skip
    for name, value, allowed in words:
        if value not in allowed:
            shown = " or ".join(repr(word) for word in allowed)
            raise CaseError(f"{name}: value is {value!r}, allowed {shown}")
    if isinstance(patch, bool) or not isinstance(patch, int) or patch < 0:
        raise CaseError(f"patch: value is {patch!r}, allowed 0 or more")
    return SIDES.index(side), patch, BODIES.index(body)


def parts(count: int, grid: tuple[int, ...]) -> tuple[int, ...]:
    """Number of components before a grid, none for one."""
    found = count // int(np.prod(grid))
    return () if found == 1 else (found,)
