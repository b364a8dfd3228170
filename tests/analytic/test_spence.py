"""A ball pressed on a rigid plane with friction.

Spence 1968, Proc. R. Soc. Lond. A 305; 1975, J. Elast. 5: the surface of the ball would move
inwards and is held back by friction, in a disc whose radius is the same share of the contact's at
every load. With friction 0.2986 and nu = 0 it is a half, and the central pressure 1.31 times
Hertz's.
"""

from __future__ import annotations

from functools import cache

import numpy as np
import railpatch
from patch_cases import Line, check, patch_case

SHEAR_MODULUS, RADIUS, FRICTION = 0.5e6, 0.1215, 0.2986  # Pa, m, -
A = 1e-3  # m, Hertz's radius at the last load
ELEMENTS, STEPS = 48, 60
# the plane is so stiff that it counts as rigid; the combined moduli are twice the ball's
FORCE = 4 * (2 * SHEAR_MODULUS) * A**3 / (3 * RADIUS)
HERTZ = 1.5 * FORCE / (np.pi * A**2)
STICK, SLIP = 1, 2


@cache
def pressed(elements: int = ELEMENTS, steps: int = STEPS) -> railpatch.Result:
    """The radius of contact grows by equal steps."""
    size = 2 * A / elements
    case = patch_case(
        {"curvatures": [0.5 / RADIUS, 0.5 / RADIUS]},
        force=FORCE,
        element_size=[size, size],
        creepage=[0.0, 0.0],
        friction=FRICTION,
        material={"shear_modulus": [SHEAR_MODULUS, 1e15], "poisson_ratio": [0.0, 0.3]},
    )
    case["grid"]["max_elements"] = [elements + 2, elements + 2]
    case["motion"] = {"regime": "shift"}
    contact = railpatch.Contact(case)
    for k in range(1, steps + 1):
        force = FORCE * (k / steps) ** 3
        result = contact.step(normal_force=force, fields=k == steps)
        assert result.status == "converged", f"step {k}: {result.status} {result['residual']}"
        assert result["friction_power"] >= 0
        assert np.hypot(*result["creep_force"]) <= 1e-5 * FRICTION * force
    return result


def test_stick_and_pressure() -> None:
    result = pressed()
    count = result["elements"]
    size = 2 * A / ELEMENTS
    # radii of the discs of equal area
    stick = size * np.sqrt(count["stick"] / np.pi)
    contact = size * np.sqrt((count["stick"] + count["slip"]) / np.pi)
    middle = len(result["x"]) // 2
    central = float(result["pressure"][middle - 1 : middle + 1, middle - 1 : middle + 1].mean())
    check(
        [
            Line("stick radius / m", stick, contact / 2, size),
            Line("central pressure / Hertz's", central / HERTZ, 1.31, 0.0131),
        ]
    )


def test_stick_is_a_disc_in_the_middle_and_friction_points_outwards() -> None:
    """What friction does to the ball, whose surface would move towards the middle."""
    result = pressed()
    y, x = np.meshgrid(result["y"], result["x"], indexing="ij")
    distance, division = np.hypot(x, y), result["element_division"]
    size = 2 * A / ELEMENTS
    assert distance[division == STICK].max() <= distance[division == SLIP].min() + 2 * size
    px, py = result["traction"]
    touching = (division != 0) & (distance > 3 * size)
    radial, around = (px * x + py * y) / distance, (px * y - py * x) / distance
    assert np.all(radial[touching] > 0)
    assert np.abs(around).max() <= 0.02 * radial.max()
