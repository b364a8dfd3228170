"""Two-dimensional rolling: Carter's closed form.

Carter 1926, Proc. R. Soc. Lond. A 112; Johnson 1985, section 8.3: two equal cylinders of combined
radius R roll under creepage xi. With a' = a - |xi| R / mu the stick area of half-length a' lies at
the leading edge, |F| / (mu F_n) = 1 - (a'/a)^2, and the traction is the difference of two ellipses.
"""

from __future__ import annotations

import numpy as np
import pytest
import railpatch
from patch_cases import Line, check, modulus, patch_case, solve

RADIUS, WIDTH, FRICTION = 0.5, 1.0, 0.3
FORCE = 178.90e3  # N/m, which makes a = 1 mm
A = np.sqrt(4 * FORCE * RADIUS / (np.pi * modulus()))
FULL_SLIP = FRICTION * A / RADIUS
PEAK = 2 * FORCE / (np.pi * A)
SHAPE = {"line_contact_radius": RADIUS, "width": WIDTH}
CREEPAGE = -2.4e-4


def case(elements: int, creepage: float, **options):
    return patch_case(
        SHAPE,
        force=FORCE * WIDTH,
        elements=[elements, 1],
        creepage=[creepage, 0.0],
        friction=FRICTION,
        **options,
    )


def relative_force(elements: int, creepage: float, **options) -> float:
    return solve(case(elements, creepage, **options))["creep_force"][0] / (FRICTION * FORCE * WIDTH)


def carter(creepage: float) -> float:
    stick = max(0.0, 1 - abs(creepage) / FULL_SLIP)
    return -np.sign(creepage) * (1 - stick**2)


def test_half_length_is_one_millimetre() -> None:
    assert pytest.approx(1e-3, rel=1e-4) == A


def test_force_at_50_elements() -> None:
    check(
        [
            Line(f"direction {d}", relative_force(50, CREEPAGE, direction=d), 0.64, 0.02 * 0.64)
            for d in (1, -1)
        ]
    )


def test_convergence_is_of_first_order() -> None:
    """The steady-rolling difference of displacements is of first order in the element size."""
    counts = np.array([25, 50, 100, 200, 400])
    errors = np.array([relative_force(int(n), CREEPAGE) for n in counts]) / 0.64 - 1
    orders = -np.diff(np.log(np.abs(errors))) / np.diff(np.log(counts))
    table = "\n".join(f"{n:4d} elements: {e: .3e}" for n, e in zip(counts, errors, strict=True))
    print(f"\nerror of the force\n{table}\norders {orders}")
    assert np.all((orders > 0.8) & (orders < 1.2)), table
    # two coarse grids extrapolate to the closed form
    assert abs(2 * errors[1] - errors[0]) < 1e-3, table


@pytest.mark.parametrize("across", [40, 128, 129, 300])
def test_elements_of_a_size_are_as_many_as_the_contact_takes(across: int) -> None:
    """The same grid as by their number, without a word of its capacity: the same force."""
    counted = case(across, CREEPAGE)
    sized = {**counted, "grid": {"element_size": [2 * A / across, WIDTH]}}
    one, other = (solve(c, fields=True) for c in (counted, sized))
    assert one["status"] == other["status"] == "converged"
    assert len(one["x"]) == len(other["x"]) == across + 2
    lines = [Line("force", other["creep_force"][0], one["creep_force"][0], 1e-4 * FRICTION * FORCE)]
    # of first order, 0.02 at 50 elements
    force = other["creep_force"][0] / (FRICTION * FORCE * WIDTH)
    lines.append(Line("Carter", force, 0.64, 0.02 * 0.64 * 50 / across))
    check(lines)


@pytest.mark.parametrize(("across", "status"), [(1000, "converged"), (1010, "out_of_range")])
def test_finer_grids_than_any_are_out_of_range(across: int, status: str) -> None:
    sized = patch_case(SHAPE, force=FORCE * WIDTH, element_size=[2 * A / across, WIDTH])
    assert railpatch.Contact(sized).step()["status"] == status


def test_creep_curve() -> None:
    lines = []
    for share in (0.02, 0.1, 0.2, 0.4, 0.6, 0.8, 0.9, 1.0, 1.1, 3.0):
        for sign in (1, -1):
            creepage = sign * share * FULL_SLIP
            value = relative_force(100, creepage)
            # error of first order, greatest where nearly all sticks
            lines.append(Line(f"creepage {creepage: .2e}", value, carter(creepage), 0.01))
    check(lines)


@pytest.mark.parametrize("direction", [1, -1])
@pytest.mark.parametrize("stick", [0.3, 0.6, 0.85])
def test_traction_distribution(stick: float, direction: int) -> None:
    creepage = -(1 - stick) * FULL_SLIP
    elements = 200
    result = solve(case(elements, creepage, direction=direction), fields=True)
    x, traction = result["x"] / A, result["traction"][0, 0]

    def ellipse(u: np.ndarray) -> np.ndarray:
        return np.sqrt(np.maximum(0.0, 1 - u**2))

    middle = direction * (1 - stick)
    exact = FRICTION * PEAK * (ellipse(x) - stick * ellipse((x - middle) / stick))
    error = (traction - exact) / (FRICTION * PEAK)
    # the slope is infinite at the edges and where stick ends: in the mean, and not at a point
    lines = [
        Line("mean error / (mu p0)", float(np.mean(np.abs(error))), 0, 1.5 / elements),
        Line("greatest error / (mu p0)", float(np.max(np.abs(error))), 0, 2 / np.sqrt(elements)),
    ]
    sticking = result["elements"]["stick"] / elements
    lines.append(Line("stick area", sticking, stick, 2 / elements))
    check(lines)


def test_lateral_creepage_is_stiffer_by_one_minus_nu() -> None:
    """In plane strain u_y = u_x / (1 - nu): the same force at 1 / (1 - nu) times the creepage."""
    nu = 0.28
    longitudinal = solve(case(60, -0.1 * FULL_SLIP))["creep_force"][0]
    lateral_case = case(60, 0.0)
    lateral_case["motion"]["creepage"] = [0.0, -0.1 * FULL_SLIP / (1 - nu)]
    lateral = solve(lateral_case)["creep_force"][1]
    check([Line("F_y of the scaled creepage", lateral, longitudinal, 1e-4 * longitudinal)])
