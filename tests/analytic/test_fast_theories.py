"""Fast theories: slopes at small creepage, saturation, symmetries, factors, limits."""

from __future__ import annotations

from typing import Any, get_args

import numpy as np
import pytest
import railpatch
from case_samples import WHEELSET, with_values
from patch_cases import STEEL, Line, check, patch_case, solve
from railpatch.case.common import Method
from railpatch.case.theories import FAST, READERS, has_tractions
from railpatch.evidence.kalker_table import coefficients

FORCE, FRICTION, SPEED = 82e3, 0.3, 10.0
BOUND = FRICTION * FORCE
A, B = 6e-3, 4e-3
LENGTH = np.sqrt(A * B)
THEORIES = get_args(Method.model_fields["tangential"].annotation)
TRACTIONS = ("fastsim", "fastrip")
RESULTANTS = ("linear", "polach")
LOADED = with_values(WHEELSET, wheelset__z=None, wheelset__vertical_force=1e5)


def ellipse(
    tangential: str,
    creepage: Any = (0.0, 0.0),
    spin: float = 0.0,
    axes: tuple[float, float] = (A, B),
    **options: Any,
) -> railpatch.Result:
    options = {"elements": 30, "normal": "hertz", **options}
    case = patch_case(
        {"semi_axes": list(axes)},
        force=FORCE,
        creepage=[float(v) for v in creepage],
        spin=float(spin),
        speed=SPEED,
        friction=FRICTION,
        tangential=tangential,
        **options,
    )
    return solve(case)


def test_theories_are_the_rows_of_the_core() -> None:
    assert {*FAST, "none", "full"} == set(THEORIES)
    assert {name for name in FAST if has_tractions(name)} == set(TRACTIONS)
    for key, names in READERS.items():
        assert key in Method.model_fields
        assert set(names) <= set(FAST)


def wrench(result: railpatch.Result) -> np.ndarray:
    """Creep force over the bound, moment over bound and length."""
    return np.array([*result["creep_force"], result["spin_moment"] / LENGTH]) / BOUND


# --- coefficients ----------------------------------------------------------------------------


def linear_coefficients(ratio: float, nu: float) -> dict[str, float]:
    """C11, ..., C33 out of the linear theory's results, c^2 = a b."""
    length = 5e-3
    axes = (length * np.sqrt(ratio), length / np.sqrt(ratio))
    material = {"shear_modulus": 82e9, "poisson_ratio": nu}
    small = 1e-7
    unit = 82e9 * length**2 * small

    def force(*args: Any) -> np.ndarray:
        r = ellipse("linear", *args, axes=axes, material=material)
        return np.array([*r["creep_force"], r["spin_moment"] / length]) / unit

    forward, sideways, spin = force((small, 0)), force((0, small)), force((0, 0), small / length)
    assert forward[1] == forward[2] == sideways[0] == spin[0] == 0
    return {
        "C11": -forward[0],
        "C22": -sideways[1],
        "C23": -spin[1],
        "C32": sideways[2],
        "C33": -spin[2],
    }


# other than the nodes of the table, and other grids than those that made it
@pytest.mark.parametrize(("ratio", "bound"), [(0.13, 1e-3), (0.55, 5e-4), (1.1, 5e-4), (3.1, 1e-3)])
def test_the_table_is_that_of_the_generator(ratio: float, bound: float) -> None:
    ratios = np.array([0.0, 0.1, 0.28, 0.5])
    lines = []
    for nu, row in zip(ratios, coefficients(ratio, ratios, elements=7), strict=True):
        found = linear_coefficients(ratio, float(nu))
        targets = dict(zip(("C11", "C22", "C23", "C33"), row, strict=True))
        targets["C32"] = targets["C23"]
        lines += [
            Line(f"a/b {ratio} nu {nu:.2f} {name}", found[name], target, bound * target)
            for name, target in targets.items()
        ]
    check(lines)


def test_coefficients_have_no_corners() -> None:
    """Value and slope are continuous: the second difference shrinks with the square of the step."""
    at = np.log(20.0) / 12 * 3  # a node of the table

    def value(log_ratio: float) -> float:
        return linear_coefficients(float(np.exp(log_ratio)), 0.28)["C22"]

    bends = [abs(value(at + h) - 2 * value(at) + value(at - h)) for h in (2e-2, 1e-2, 5e-3)]
    print("\nsecond differences across a node:", bends)
    assert bends[1] < 0.3 * bends[0]
    assert bends[2] < 0.3 * bends[1]


@pytest.mark.parametrize("tangential", ["linear", "polach", "fastsim", "fastrip"])
def test_beyond_the_table_is_out_of_range(tangential: str) -> None:
    case = patch_case(
        {"semi_axes": [21e-3, 1e-3]},
        force=FORCE,
        elements=20,
        creepage=[1e-6, 0.0],
        normal="hertz",
        tangential=tangential,
    )
    result = railpatch.solve(case)
    assert result.status == "out_of_range"
    assert result["creep_force"][0] < 0


# --- small creepage --------------------------------------------------------------------------

SMALL = 1e-6
MODES = {
    "longitudinal": ((SMALL, 0.0), 0.0),
    "lateral": ((0.0, SMALL), 0.0),
    "spin": ((0.0, 0.0), SMALL / LENGTH),
}


@pytest.mark.parametrize("direction", [1, -1])
@pytest.mark.parametrize("axes", [(A, B), (3e-3, 8e-3), (8e-3, 3e-3)])
@pytest.mark.parametrize("tangential", ["polach", "fastsim", "fastrip"])
def test_slopes_are_those_of_the_linear_theory(
    tangential: str, axes: tuple[float, float], direction: int
) -> None:
    """FASTSIM sums a traction that grows linearly along rows of chords: first order in 1/n with a
    small factor; FaStrip's strips are integrated exactly along x."""
    lines = []
    for name, (creepage, spin) in MODES.items():
        target, found = (
            ellipse(theory, creepage, spin, axes=axes, elements=60, direction=direction)
            for theory in ("linear", tangential)
        )
        for k, axis in enumerate("xy"):
            wanted = target["creep_force"][k]
            scale = np.linalg.norm(target["creep_force"])
            lines.append(Line(f"{name} F_{axis}", found["creep_force"][k], wanted, 5e-3 * scale))
    check(lines)


def test_polach_has_no_moment_and_the_others_gain_no_power() -> None:
    random = np.random.default_rng(7)
    for _ in range(40):
        creepage = random.uniform(-3e-3, 3e-3, 2)
        spin = random.uniform(-1, 1)
        direction = int(random.choice([-1, 1]))
        for theory in ("polach", "fastsim", "fastrip"):
            result = ellipse(theory, creepage, spin, direction=direction, elements=12)
            assert result["friction_power"] >= 0, (theory, creepage, spin, direction)
            if theory == "polach":
                assert result["spin_moment"] == 0


def test_linear_power_is_what_the_motion_supplies() -> None:
    creepage, spin = np.array([2e-4, -3e-4]), 0.05
    for direction in (1, -1):
        result = ellipse("linear", creepage, spin, direction=direction)
        work = result["creep_force"] @ creepage + result["spin_moment"] * spin
        assert result["friction_power"] == pytest.approx(-SPEED * work, rel=1e-12)


@pytest.mark.parametrize("offset", ["none", "automatic", "sixth"])
@pytest.mark.parametrize("direction", [1, -1])
def test_fastrip_takes_what_the_motion_supplies(direction: int, offset: str) -> None:
    """Wherever the spin is read: friction was 0.7 % off by an offset of a sixth."""
    result = ellipse(
        "fastrip", (1.2e-3, -4e-4), 0.25, direction=direction, elements=12, spin_offset=offset
    )
    assert result["friction_power"] == pytest.approx(result["creep_power"], rel=1e-12)


# --- saturation ------------------------------------------------------------------------------


def test_linear_theory_has_no_bound() -> None:
    """Proportional at any creepage; beyond the bound the status says so."""
    small = ellipse("linear", (1e-5, 2e-5))
    case = patch_case(
        {"semi_axes": [A, B]},
        force=FORCE,
        elements=20,
        creepage=[1e-2, 2e-2],
        friction=FRICTION,
        normal="hertz",
        tangential="linear",
    )
    large = railpatch.solve(case)
    assert large.status == "out_of_range"
    np.testing.assert_allclose(
        large["creep_force"], 1e3 * np.array(small["creep_force"]), rtol=1e-9
    )


@pytest.mark.parametrize("angle", [0, 40, 90, 135, 180, 250])
def test_polach_saturates_against_the_creepage(angle: float) -> None:
    way = np.array([np.cos(np.radians(angle)), np.sin(np.radians(angle))])
    sizes = []
    for creepage in (1e-3, 1e-2, 1e-1, 1.0, 10.0):
        force = np.array(ellipse("polach", creepage * way)["creep_force"])
        assert force @ [-way[1], way[0]] == pytest.approx(0, abs=1e-9 * BOUND)
        sizes.append(float(-force @ way) / BOUND)
    assert np.all(np.diff(sizes) > 0)
    assert sizes[-1] < 1
    # the rest falls with the cube of the creepage: 1 - 4/(3 pi e^3)
    assert sizes[-1] == pytest.approx(1, abs=1e-9)


def test_polach_formula_without_spin() -> None:
    """F = (2 mu Q/pi) (k_A e/(1 + (k_A e)^2) + atan(k_S e)), e = G pi a b c_11 xi/(4 mu Q)."""
    k_a, k_s, percent = 0.9, 0.35, 80.0
    c11 = linear_coefficients(A / B, STEEL["poisson_ratio"])["C11"]
    lines = []
    for xi in (1e-5, 3e-4, 1e-3, 1e-2):
        e = 0.01 * percent * STEEL["shear_modulus"] * np.pi * A * B * c11 * xi / (4 * BOUND)
        target = -2 * BOUND / np.pi * (k_a * e / (1 + (k_a * e) ** 2) + np.arctan(k_s * e))
        found = ellipse("polach", (xi, 0), polach_k_a=k_a, polach_k_s=k_s, percent_kalker=percent)
        lines.append(Line(f"xi {xi:.0e}", found["creep_force"][0], target, 1e-9 * BOUND))
    check(lines)


# --- symmetries ------------------------------------------------------------------------------

MOTIONS = [((6e-4, 3e-4), 0.3), ((-2e-4, 8e-4), -0.5), ((4e-3, -1e-3), 0.8), ((0.0, 0.0), 0.6)]


def skew_gap(rows: int, columns: int, size: float) -> np.ndarray:
    """Undeformed distance of a contact area without any symmetry: strips shift and change."""
    x = (np.arange(columns) - (columns - 1) / 2) * size
    y = ((np.arange(rows) - (rows - 1) / 2) * size)[:, None]
    return 0.9 * (x - 0.4 * y - 60 * y**2) ** 2 + 1.6 * y**2 + 90 * y**3


def skew(gap: np.ndarray, tangential: str, creepage: Any, spin: float, **options: Any):
    case = patch_case(
        {"undeformed_distance": gap.tolist()},
        force=4e4,
        element_size=[4e-4, 4e-4],
        creepage=[float(v) for v in creepage],
        spin=float(spin),
        friction=FRICTION,
        tangential=tangential,
        tolerance=1e-9,
        **options,
    )
    result = railpatch.solve(case, fields=True)
    assert result.status in ("converged", "out_of_range")
    return result


@pytest.mark.parametrize("motion", MOTIONS)
@pytest.mark.parametrize("tangential", [*RESULTANTS, *TRACTIONS])
def test_mirror_images(tangential: str, motion: Any) -> None:
    """Reflections at y = 0 and, with the direction of rolling, at x = 0, of a skew contact area."""
    (xi, eta), spin = motion
    gap = skew_gap(33, 37, 4e-4)
    one = skew(gap, tangential, (xi, eta), spin)
    assert one["elements"]["exterior"] < gap.size - 100
    across = skew(gap[::-1], tangential, (xi, -eta), -spin)
    along = skew(gap[:, ::-1], tangential, (-xi, eta), -spin, direction=-1)
    for other, signs in ((across, (1, -1, -1)), (along, (-1, 1, -1))):
        np.testing.assert_allclose(wrench(other) * signs, wrench(one), atol=1e-9)
        assert other["friction_power"] == pytest.approx(one["friction_power"], rel=1e-9)
        assert other["elements"] == one["elements"]
    if tangential in TRACTIONS:
        scale = np.max(np.abs(one["traction"]))
        flipped = along["traction"][:, :, ::-1] * np.array([-1, 1])[:, None, None]
        np.testing.assert_allclose(flipped, one["traction"], atol=1e-7 * scale)


@pytest.mark.parametrize("direction", [1, -1])
@pytest.mark.parametrize("tangential", [*RESULTANTS, *TRACTIONS])
def test_the_place_of_the_origin_does_not_matter(tangential: str, direction: int) -> None:
    """The same contact area elsewhere, with creepages at the new origin for the same motion."""
    size, shift = 4e-4, (4, -3)
    small = skew_gap(33, 37, size)
    wide = np.full((49, 53), 1e-3)
    near, far = wide.copy(), wide.copy()
    near[8:41, 8:45] = small
    far[8 + shift[1] : 41 + shift[1], 8 + shift[0] : 45 + shift[0]] = small
    dx, dy = shift[0] * size, shift[1] * size
    (xi, eta), spin = (5e-4, 2e-4), 0.3
    here = skew(near, tangential, (xi, eta), spin, direction=direction)
    there = skew(far, tangential, (xi + spin * dy, eta - spin * dx), spin, direction=direction)
    np.testing.assert_allclose(there["creep_force"], here["creep_force"], atol=1e-7 * BOUND)
    fx, fy = here["creep_force"]
    moved = here["spin_moment"] + dx * fy - dy * fx
    assert there["spin_moment"] == pytest.approx(moved, abs=1e-7 * BOUND * LENGTH)


# --- factors ---------------------------------------------------------------------------------


@pytest.mark.parametrize("motion", MOTIONS[:3])
def test_modified_fastsim(motion: Any) -> None:
    """Stiffness k0 (alpha + (1 - alpha)/(1 + beta e)) of Kalker's: limits, and one in between."""
    creepage, spin = motion
    plain = wrench(ellipse("fastsim", creepage, spin))
    same = ellipse("fastsim", creepage, spin, fastsim_alpha=0.3, fastsim_beta=0.0)
    np.testing.assert_array_equal(wrench(same), plain)
    none = {"flexibility_blending": "none"}
    half = wrench(ellipse("fastsim", creepage, spin, fastsim_k0=0.5, **none))
    percent = wrench(ellipse("fastsim", creepage, spin, percent_kalker=50.0, **none))
    np.testing.assert_allclose(half, percent, atol=1e-12)
    # e of the resultant creepage with spin's lateral part
    c = linear_coefficients(A / B, STEEL["poisson_ratio"])
    turned = max((creepage[1], creepage[1] + spin * A), key=abs)
    weighted = np.hypot(c["C11"] * creepage[0], c["C22"] * turned)
    e = STEEL["shear_modulus"] * np.pi * A * B * weighted / (4 * BOUND)
    k0, alpha, beta = 0.8, 0.1, 0.6
    k = k0 * (alpha + (1 - alpha) / (1 + beta * e))
    found = ellipse(
        "fastsim", creepage, spin, fastsim_k0=k0, fastsim_alpha=alpha, fastsim_beta=beta, **none
    )
    target = ellipse("fastsim", creepage, spin, percent_kalker=100 * k, **none)
    np.testing.assert_allclose(wrench(found), wrench(target), atol=1e-9)


@pytest.mark.parametrize("tangential", [*RESULTANTS, *TRACTIONS])
def test_percent_kalker_scales_the_slope(tangential: str) -> None:
    for creepage, spin in MODES.values():
        one = ellipse(tangential, creepage, spin)
        part = ellipse(tangential, creepage, spin, percent_kalker=60.0)
        target = 0.6 * wrench(one)
        # what slips at the trailing edge grows with the slope
        np.testing.assert_allclose(wrench(part), target, atol=1e-3 * np.linalg.norm(target))


# --- against the full theory -----------------------------------------------------------------


def test_fastrip_is_carter_in_a_wide_strip() -> None:
    """For a/b -> 0 each strip is Carter's: d = |xi| G/(2 (1 - nu) K0) at every y, so
    F_x/(mu F_n) = 1 - integral of (a(y) - d)^2 over that of a(y)^2, 4/3 a^2 b."""
    axes, nu = (1e-3, 20e-3), STEEL["poisson_ratio"]
    slope = linear_coefficients(axes[0] / axes[1], nu)["C11"] * 4 * (1 - nu) / np.pi**2
    k0 = 1.5 * BOUND / (np.pi * axes[0] ** 2 * axes[1])
    for share in (0.1, 0.4, 0.8):
        d = share * axes[0]
        xi = 2 * (1 - nu) * k0 * d / (STEEL["shear_modulus"] * slope)
        y = np.linspace(-1, 1, 200001)
        a = np.sqrt(1 - y**2)
        stick = np.trapezoid(np.maximum(0, a - share) ** 2, y) / (4 / 3)
        found = ellipse("fastrip", (xi, 0), axes=axes, elements=80)["creep_force"][0] / BOUND
        check([Line(f"d/a {share}", found, -(1 - stick), 2e-3)])


# --- what resultants leave out ---------------------------------------------------------------


@pytest.mark.parametrize("tangential", RESULTANTS)
def test_resultants_have_no_fields(tangential: str) -> None:
    creepage = [1e-4, 0.0]
    options = {"force": FORCE, "elements": 20, "creepage": creepage, "tangential": tangential}
    hertz = railpatch.Contact(patch_case({"semi_axes": [A, B]}, normal="hertz", **options))
    result = hertz.step(fields=True)
    assert result.status == "converged"
    assert all(result[name] is None for name in ("pressure", "traction", "element_division"))
    assert sum(stage["bytes"] for stage in hertz.stages()) < 4096
    # with a pressure on a grid there is that, but no traction
    elastic = railpatch.Contact(patch_case({"semi_axes": [A, B]}, **options)).step(fields=True)
    assert elastic["pressure"].max() > 1e9
    assert elastic["traction"] is None
    np.testing.assert_allclose(elastic["creep_force"], result["creep_force"], rtol=0.05)


@pytest.mark.parametrize("tangential", ["polach", *TRACTIONS])
def test_extreme_creepages_stay_within_the_bound(tangential: str) -> None:
    for size in (1e-300, 1e-30, 1e3, 1e30, 1e150):
        for creepage, spin in (((size, 0), 0), ((0, -size), 0), ((0, 0), size), ((size, size), 1)):
            result = ellipse(tangential, creepage, spin, elements=12)
            force = np.array(result["creep_force"])
            assert np.isfinite([*force, result["spin_moment"]]).all(), (size, creepage, spin)
            if spin == 0 and size >= 1e3:
                way = -np.array(creepage) / np.linalg.norm(creepage)
                np.testing.assert_allclose(force, BOUND * way, atol=1e-4 * BOUND)
            assert np.linalg.norm(force) <= 1.01 * BOUND, (size, creepage, spin, force)


@pytest.mark.parametrize("tangential", [*RESULTANTS, *TRACTIONS])
@pytest.mark.parametrize("normal", ["hertz", "half_space"])
def test_wheelset_under_a_load(tangential: str, normal: str) -> None:
    """The height under a vertical force is found with every theory, also where the creep forces lie
    beyond the range of theirs."""
    case = with_values(
        LOADED,
        wheelset__speed=20.0,
        wheelset__yaw=2e-4,
        wheelset__pitch_rate=-20.0 / LOADED["wheelset"]["nominal_radius"],
        method={"normal": normal, "tangential": tangential},
        friction={"coefficient": 0.3},
    )
    result = railpatch.solve(case)
    assert result.status == "converged"
    load = LOADED["wheelset"]["vertical_force"]
    assert result["force"][2] == pytest.approx(-load, rel=2e-5)
    assert abs(result["force"][1]) > 100
    slippery = railpatch.solve(with_values(case, friction={"coefficient": 1e-3}))
    assert slippery.status == ("out_of_range" if tangential == "linear" else "converged")
    assert slippery["force"][2] == pytest.approx(-load, rel=2e-5)
