"""A wheel in conformal contact, and dense sums in three dimensions over its elements.

Nothing here is shared with the solver but the undeformed distance and the rows' positions and
angles: every element's traction is a vector in space, its displacement the mean of two half-spaces,
one along the source's and one along the observer's surface (Boussinesq and Cerruti integrated over
rectangles, Love 1929; Kalker 1990, appendix C).
"""

from __future__ import annotations

from typing import Any

import numpy as np
import railpatch
from numpy.typing import NDArray

Array = NDArray[np.float64]

TOLERANCE = 1e-6
SHEAR_MODULUS, POISSON_RATIO = 82e9, 0.28
RADIUS, SPEED, PITCH_RATE = 0.46, 20.0, -20.0 / 0.459
FRICTION = 0.3
PLACES = (5.0e-3, 6.5e-3)  # m: two parts in a patch of 13 degrees, one of 24 degrees


def wheel_case(
    y: float, tangential: str, surface: str = "curved", **options: Any
) -> dict[str, Any]:
    case: dict[str, Any] = {
        "kind": "wheel_rail",
        "wheelset": {
            "y": y,
            "yaw": 2e-3,
            "vertical_force": 6e4,
            "speed": SPEED,
            "pitch_rate": PITCH_RATE,
            "nominal_radius": RADIUS,
            "flange_back_distance": 1.36,
            "flange_back_position": -0.07,
        },
        "track": {"cant": 0.025},
        "profiles": {"wheel": "S1002", "rail": "UIC60"},
        "grid": {"elements": [14, 20]},
        "method": {"tangential": tangential, "reference_surface": surface, "tolerance": TOLERANCE},
    }
    if tangential != "none":
        case["friction"] = {"coefficient": FRICTION}
    case["method"].update(options)
    return case


class Solved:
    """A solved patch and its elements in space."""

    def __init__(self, y: float, tangential: str, **options: Any) -> None:
        contact = railpatch.Contact(wheel_case(y, tangential, **options))
        self.y = y
        self.result = contact.step(fields=True)
        assert self.result.status == "converged"
        (self.patch,) = self.result["patches"]
        self.h = contact._core.field(1, 0, "undeformed_distance")
        self.p = self.patch["pressure"].ravel()
        self.angle = self.patch["row_angle"]
        self.nx, self.ny = len(self.patch["x"]), len(self.patch["y"])
        self.dx, self.dy = np.diff(self.patch["x"][:2])[0], np.diff(self.patch["y"][:2])[0]

    @property
    def traction(self) -> Array:
        """[element, x s n] on the wheel, in the row's axes; pressure pushes along -n."""
        px, ps = self.patch["traction"].reshape(2, -1)
        return np.stack([px, ps, -self.p], axis=-1)

    def axes(self) -> Array:
        """[row, which of x s n, track axis]"""
        c, s, zero = np.cos(self.angle), np.sin(self.angle), 0 * self.angle
        x = np.stack([zero + 1, zero, zero], axis=-1)
        return np.stack([x, np.stack([zero, c, s], -1), np.stack([zero, -s, c], -1)], axis=1)

    def influence(self, ahead: int = 0) -> Array:
        """[observer row, observer x, source row, source x, 3, 3], in the rows' own axes; the
        observer lies that many elements further along x."""
        i, j = np.arange(self.nx), np.arange(self.ny)
        dx = (i[None, :, None, None] - i[None, None, None, :] + ahead) * self.dx
        dy = (j[:, None, None, None] - j[None, None, :, None]) * self.dy
        flat = half_space(dx + 0 * dy, dy + 0 * dx, self.dx, self.dy)
        axes = self.axes()
        # components of the source's axes in the observer's
        turn = np.einsum("iax,jbx->ijab", axes, axes)[:, None, :, None]
        return 0.5 * (turn @ flat + flat @ turn)

    def displacement(self, ahead: int = 0) -> Array:
        traction = self.traction.reshape(self.ny, self.nx, 3)
        return np.einsum("jiklab,klb->jia", self.influence(ahead), traction)

    def rigid_slip(self) -> Array:
        """[row, x of elements, x s]: velocity of the wheel's material over the rolling speed, as
        deep below the reference surface as the wheel's undeformed surface is at the reference."""
        patch, axes = self.patch, self.axes()
        position, arc = patch["row_position"], patch["y"]
        near = np.argsort(np.abs(arc))[:4]
        middle = np.array([np.polyval(np.polyfit(arc[near], r[near], 3), 0) for r in position])
        angle = patch["contact_angle"]
        normal = np.array([-np.sin(angle), np.cos(angle)])
        depth = patch["approach"] - normal @ (middle - np.array(patch["position"][1:]))
        yaw = 2e-3
        axle = np.array([-np.sin(yaw), np.cos(yaw), 0.0])
        centre = np.array([0, self.y, self.result["z"] - RADIUS])
        slip = np.empty((self.ny, self.nx, 2))
        for row in range(self.ny):
            for column in range(self.nx):
                # a quarter of an element upstream, as the rest of the step's slip is
                x = patch["position"][0] + patch["x"][column] + 0.25 * self.dx
                at = np.array([x, *position[:, row]]) + depth * axes[row, 2]
                turned = np.cross(PITCH_RATE * axle, at - centre)
                slip[row, column] = axes[row, :2] @ (np.array([SPEED, 0, 0]) + turned)
        return slip / patch["rolling_speed"]


def half_space(x: Array, y: Array, dx: float, dy: float) -> Array:
    """[..., 3, 3] displacement (x, y, z) from unit traction on a rectangle, wheel minus rail."""
    total = np.zeros((*x.shape, 3, 3))
    for k in (0.5, -0.5):
        for m in (0.5, -0.5):
            u, v = x + k * dx, y + m * dy
            r = np.hypot(u, v)
            by_u, by_v = v * np.log(u + r), u * np.log(v + r)
            sign = 1 if k == m else -1
            nu = POISSON_RATIO
            total[..., 0, 0] += sign * (by_u + (1 - nu) * by_v)
            total[..., 1, 1] += sign * (by_v + (1 - nu) * by_u)
            total[..., 2, 2] += sign * (1 - nu) * (by_u + by_v)
            total[..., 0, 1] -= sign * nu * r
            total[..., 1, 0] -= sign * nu * r
    return total / (np.pi * SHEAR_MODULUS)
