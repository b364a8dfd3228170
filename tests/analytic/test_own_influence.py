"""Influence coefficients of the user's own in place of the half-space's.

The half-space's own ones given as a file are the half-space; a mattress of springs (Winkler) has
closed forms, in rolling those of Kalker's FASTSIM (1982), swept here; a layer given in the
coefficients is `[layer]`.
"""

from __future__ import annotations

import re
import zipfile
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import railpatch
from case_samples import WHEELSET, with_values
from numpy.typing import NDArray
from railpatch import CaseError, Contact, Subsurface
from railpatch.case.load import load_scene
from railpatch.case.own_influence import check_positive, extremes, surely_positive
from railpatch.fmu.pack import check_regime

Array = NDArray[np.float64]

NX, NY, DX, DY = 18, 14, 6e-4, 8e-4
SHEAR, POISSON = 82e9, 0.28
X, Y = DX * (np.arange(NX) - 8.7), DY * (np.arange(NY) - 6.6)
GAP = 0.9 * X**2 + 0.7 * Y[:, None] ** 2
NAMES = ("zz", "xx", "yy", "xy")


def half_space(nx: int, ny: int, layer: float = 0.0) -> dict[str, Array]:
    """m/Pa at all offsets of a grid (Kalker 1990, appendix C), with a layer's m/Pa."""
    x, y = DX * np.arange(-nx, nx + 1), DY * np.arange(1 - ny, ny)[:, None]
    one, two, three = np.zeros((3, 2 * ny - 1, 2 * nx + 1))
    for u, a in ((x + DX / 2, 1), (x - DX / 2, -1)):
        for v, b in ((y + DY / 2, 1), (y - DY / 2, -1)):
            one = one + a * b * v * np.arcsinh(u / np.abs(v))
            two = two + a * b * u * np.arcsinh(v / np.abs(u))
            three = three - a * b * np.hypot(u, v)
    c = 1 / (np.pi * SHEAR)
    near = 1 - POISSON
    found = {
        "zz": c * near * (one + two),
        "xx": c * (one + near * two),
        "yy": c * (two + near * one),
        "xy": c * POISSON * three,
    }
    for name in ("xx", "yy"):
        found[name][ny - 1, nx] += layer
    return found


def springs(nx: int, ny: int, down: float, along: float) -> dict[str, Array]:
    """Of a mattress: m/Pa of pressure and of traction; no xy, which stands for 0."""
    found = {name: np.zeros((2 * ny - 1, 2 * nx + 1)) for name in ("zz", "xx", "yy")}
    for name, value in (("zz", down), ("xx", along), ("yy", along)):
        found[name][ny - 1, nx] = value
    return found


def written(folder: Path, arrays: dict[str, Array]) -> str:
    path = folder / "own.npz"
    np.savez(path, **arrays)
    return str(path)


def patch(file: str | None = None, *, gap: Array = GAP, **changes: Any) -> dict[str, Any]:
    case: dict[str, Any] = {
        "kind": "patch",
        "geometry": {"undeformed_distance": gap.tolist()},
        "load": {"normal_force": 2e4},
        "grid": {"element_size": [DX, DY]},
        "motion": {"creepage": [6e-4, -3e-4], "spin_creepage": 0.3, "rolling_speed": 20.0},
        "friction": {"coefficient": 0.3},
        "method": {"normal": "half_space", "tolerance": 1e-11},
    }
    material = {"influence_file": file} if file else {"shear_modulus": SHEAR}
    if not file:
        material["poisson_ratio"] = POISSON
    return with_values({**case, "material": material}, **changes)


def expect_same(case: dict[str, Any], other: dict[str, Any]) -> None:
    """To what the solver's tolerance leaves."""
    found, wanted = (railpatch.solve(one, fields=True) for one in (case, other))
    assert found.good, found.reason
    assert not found.warnings
    for name in ("pressure", "traction"):
        scale = np.abs(wanted[name]).max()
        np.testing.assert_allclose(found[name], wanted[name], rtol=0, atol=1e-8 * scale)
    for name in ("normal_force", "approach", "creep_force", "friction_power", "elastic_energy"):
        np.testing.assert_allclose(found[name], wanted[name], rtol=1e-8, err_msg=name)
    assert found["elements"] == wanted["elements"]


SCENES: dict[str, dict[str, Any]] = {
    "rolling": {},
    "backwards": {"motion__direction": -1},
    "approach": {"load": {"approach": 3e-5}},
    "force": {"motion__creepage": None, "motion__tangential_force": [-2e3, 1e3]},
    "shift": {"motion": {"regime": "shift", "creepage": [8e-6, -4e-6], "spin_creepage": 2e-4}},
    "falling friction": {
        "friction": {
            "law": "slip_velocity",
            "shape": "exponential",
            "kinetic": 0.2,
            "amplitude": 0.15,
            "halving_speed": 0.01,
        }
    },
    "temperature": {"temperature": {"wheel": 20.0, "rail": 20.0}},
    "slip field": {"motion__slip_field": [[[1e-4] * NX] * NY, [[-2e-4] * NX] * NY]},
}


@pytest.mark.parametrize("name", SCENES)
def test_the_half_space_given_is_the_half_space(name: str, tmp_path: Path) -> None:
    file = written(tmp_path, half_space(NX, NY))
    expect_same(patch(file, **SCENES[name]), patch(**SCENES[name]))


@pytest.mark.parametrize("rows", [1, 2])
def test_of_strips_too(rows: int, tmp_path: Path) -> None:
    file = written(tmp_path, half_space(NX, rows))
    changes = {"gap": GAP[6 : 6 + rows], "load__normal_force": 1500.0}
    changes["motion__spin_creepage"] = 0.0
    expect_same(patch(file, **changes), patch(**changes))


def test_a_layer_in_the_coefficients_is_the_layer(tmp_path: Path) -> None:
    thickness, modulus = 2e-4, 8e9
    file = written(tmp_path, half_space(NX, NY, thickness / modulus))
    layer = {"thickness": thickness, "shear_modulus": modulus}
    plain = {"method__spin_offset": "none"}
    expect_same(patch(file, **plain), patch(layer=layer, **plain))


def test_greater_files_and_tables_are_the_same(tmp_path: Path) -> None:
    """A file for greater grids, and rows of offsets of one quadrant."""
    small = railpatch.solve(patch(written(tmp_path, half_space(NX, NY)))).data
    great = half_space(NX + 3, NY + 2)
    (tmp_path / "great").mkdir()
    table = tmp_path / "own.csv"
    lines = [
        " ".join(map(repr, (i, j, *(float(great[n][NY + 1 + j, NX + 3 + i]) for n in NAMES))))
        for j in range(NY + 2)
        for i in range(NX + 4)
    ]
    table.write_text("# along across zz xx yy xy\n" + "\n".join(lines), encoding="utf-8")
    for file in (written(tmp_path / "great", great), str(table)):
        found = railpatch.solve(patch(file)).data
        # as texts: NaN is no number equal to itself
        assert str({**found, "wall_time": 0}) == str({**small, "wall_time": 0})


def test_the_page_writes_the_half_space(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    page = (Path(__file__).parents[2] / "docs/physics.md").read_text(encoding="utf-8")
    section = page.split("## Own influence coefficients")[1].split("\n## ")[0]
    text = re.search(r"^```python\n(.*?)^```", section, re.M | re.S)
    assert text is not None
    monkeypatch.chdir(tmp_path)
    names: dict[str, Any] = {}
    exec(text[1], names)
    with np.load("coefficients.npz") as found:
        assert set(found) == set(NAMES)
        for name, values in half_space(16, 12).items():
            np.testing.assert_allclose(found[name], values, rtol=1e-12, atol=1e-30)
    text = re.findall(r"^```python\n(.*?)^```", section, re.M | re.S)
    exec(text[1], names)
    result = names["result"]
    assert result.status == "converged"
    assert not result.warnings


def test_of_pressure_alone(tmp_path: Path) -> None:
    """Without tangential problem zz is read alone."""
    still = {"motion": {"regime": "none"}, "friction": None}
    whole = half_space(NX, NY)
    table = tmp_path / "own.csv"
    table.write_text(
        "\n".join(
            f"{i} {j} {float(whole['zz'][NY - 1 + j, NX + i])!r}"
            for j in range(NY)
            for i in range(NX + 1)
        ),
        encoding="utf-8",
    )
    wanted = railpatch.solve(patch(**still), fields=True)
    for file in (written(tmp_path, {"zz": whole["zz"]}), str(table)):
        found = railpatch.solve(patch(file, **still), fields=True)
        np.testing.assert_allclose(found["pressure"], wanted["pressure"], rtol=1e-9)


# --- a mattress ----------------------------------------------------------------------------------

DOWN, ALONG = 1e-13, 2.5e-13


def swept(pressure: Array, rigid: Array, direction: int) -> Array:
    """Tractions of a mattress in steady rolling: from the leading edge on each spring goes on from
    the one before, cut at the bound (Kalker 1982). [2][ny][nx]"""
    found = np.zeros((2, NY, NX))
    columns = range(NX - 1, -1, -1) if direction > 0 else range(NX)
    for j in range(NY):
        before = np.zeros(2)
        for i in columns:
            bound = 0.3 * pressure[j, i]
            trial = before - rigid[:, j, i] * DX / ALONG
            size = np.hypot(*trial)
            before = trial * (bound / size) if size > bound else trial
            found[:, j, i] = before
    return found


@pytest.mark.parametrize("direction", [1, -1])
def test_a_mattress_in_rolling(direction: int, tmp_path: Path) -> None:
    file = written(tmp_path, springs(NX, NY, DOWN, ALONG))
    depth = 1.4e-5
    motion = {"motion__direction": direction, "method__spin_offset": "none"}
    found = railpatch.solve(patch(file, load={"approach": depth}, **motion), fields=True)
    assert found.good, found.reason
    pressure = np.maximum(depth - GAP, 0.0) / DOWN
    np.testing.assert_allclose(found["pressure"].reshape(NY, NX), pressure, rtol=1e-9, atol=1.0)
    assert found["normal_force"] == pytest.approx(pressure.sum() * DX * DY, rel=1e-9)
    ones = np.ones((NY, NX))
    # spin turns about the middle of the grid
    x, y = DX * (np.arange(NX) - 8.5), DY * (np.arange(NY) - 6.5)[:, None]
    rigid = np.array([6e-4 - 0.3 * y * ones, -3e-4 + 0.3 * x * ones])
    traction = swept(pressure, rigid, direction)
    top = 0.3 * pressure.max()
    np.testing.assert_allclose(
        found["traction"].reshape(2, NY, NX), traction, rtol=0, atol=1e-8 * top
    )
    assert found["elements"]["stick"] > 20
    assert found["elements"]["slip"] > 20
    force = traction.sum(axis=(1, 2)) * DX * DY
    np.testing.assert_allclose(found["creep_force"], force, rtol=1e-8)
    supplied = -20.0 * (traction * rigid).sum() * DX * DY
    assert found["friction_power"] == pytest.approx(supplied, rel=1e-8)
    energy = (DOWN * pressure**2 + ALONG * (traction**2).sum(axis=0)).sum() / 2 * DX * DY
    assert found["elastic_energy"] == pytest.approx(energy, rel=1e-8)


def test_a_mattress_of_rubber_with_its_forces_given(tmp_path: Path) -> None:
    """Ten thousand times softer than steel: what a start takes of steel leads there too."""
    soft = 1e4
    file = written(tmp_path, springs(NX, NY, soft * DOWN, soft * ALONG))
    changes = {
        "load__normal_force": 3e3 / soft,
        "motion__creepage": None,
        "motion__spin_creepage": 0.0,
        "motion__tangential_force": [-500.0 / soft, 0.0],
    }
    found = railpatch.solve(patch(file, **changes), fields=True)
    assert found.good, found.reason
    np.testing.assert_allclose(found["creep_force"], [-500.0 / soft, 0.0], atol=1e-6 * 3e3 / soft)
    pressure = found["pressure"].reshape(NY, NX)
    inside = pressure > 0
    depth = found["approach"] - GAP
    np.testing.assert_allclose(soft * DOWN * pressure[inside], depth[inside], rtol=1e-8)
    assert (depth[~inside] <= 1e-12).all()


# --- of bodies that are neither ------------------------------------------------------------------


def decaying(nx: int, ny: int) -> dict[str, Array]:
    """Different in all directions, with coupling across: m/Pa."""
    x, y = np.arange(-nx, nx + 1.0), np.arange(1.0 - ny, ny)[:, None]

    def fall(along: float, across: float) -> Array:
        return np.exp(-np.abs(x) / along - np.abs(y) / across)

    return {
        "zz": 2e-14 * fall(2.0, 3.0),
        "xx": 3e-14 * fall(1.5, 2.0),
        "yy": 2.5e-14 * fall(2.5, 1.2),
        "xy": 2e-15 * x * y * fall(1.0, 1.0),
    }


def direct(coefficients: Array, loads: Array, ahead: int = 0) -> Array:
    """Displacement (m) by direct sums, [ny][nx], seen so many elements further along x."""
    found = np.zeros((NY, NX))
    for j in range(NY):
        for i in range(NX):
            rows = slice(NY - 1 - j, 2 * NY - 1 - j)
            columns = slice(NX - i + ahead, 2 * NX - i + ahead)
            found += loads[j, i] * coefficients[rows, columns]
    return found


@pytest.mark.parametrize("direction", [1, -1])
def test_conditions_and_power_by_direct_sums(direction: int, tmp_path: Path) -> None:
    """Contact, friction, power and energy by code that shares nothing with the solver."""
    own = decaying(NX, NY)
    motion = {"motion__direction": direction, "method__spin_offset": "none"}
    case = patch(written(tmp_path, own), load__normal_force=3e3, **motion)
    found = railpatch.solve(case, fields=True)
    assert found.good, found.reason
    pressure = found["pressure"].reshape(NY, NX)
    traction, slip = (found[name].reshape(2, NY, NX) for name in ("traction", "micro_slip"))
    inside = pressure > 0
    assert 40 < inside.sum() < NX * NY
    # contact
    gap = GAP + direct(own["zz"], pressure) - found["approach"]
    np.testing.assert_allclose(gap[inside], 0.0, atol=1e-9 * found["approach"])
    assert (gap[~inside] > -1e-9 * found["approach"]).all()
    # friction
    pairs = (("xx", "xy"), ("xy", "yy"))
    here, there = (
        np.array(
            [direct(own[a], traction[0], k) + direct(own[b], traction[1], k) for a, b in pairs]
        )
        for k in (0, direction)
    )
    x, y = DX * (np.arange(NX) - 8.5), DY * (np.arange(NY) - 6.5)[:, None]
    ones = np.ones((NY, NX))
    rigid = np.array([6e-4 - 0.3 * y * ones, -3e-4 + 0.3 * x * ones])
    wanted = rigid + (here - there) / DX
    np.testing.assert_allclose(slip[:, inside], wanted[:, inside], rtol=0, atol=1e-9)
    bound, size, speed = 0.3 * pressure, np.hypot(*traction), np.hypot(*wanted)
    assert (size <= bound * (1 + 1e-8)).all()
    slides = inside & (size > bound * (1 - 1e-8))
    assert slides.sum() > 20
    assert (inside & ~slides).sum() > 5
    np.testing.assert_allclose(speed[inside & ~slides], 0.0, atol=1e-10)
    against = -bound * wanted / np.maximum(speed, 1e-12)
    np.testing.assert_allclose(
        traction[:, slides], against[:, slides], rtol=0, atol=1e-5 * bound.max()
    )
    # power: what the creepages supply friction turns into heat, none is left to the bodies
    supplied = -20.0 * (traction * rigid).sum() * DX * DY
    assert found["creep_power"] == pytest.approx(supplied, rel=1e-8)
    assert found["friction_power"] == pytest.approx(supplied, rel=1e-8)
    energy = ((GAP - found["approach"]) * -pressure + (traction * here).sum(axis=0)).sum() / 2
    assert found["elastic_energy"] == pytest.approx(energy * DX * DY, rel=1e-8)


# --- what is refused and doubted -----------------------------------------------------------------


def spoiled(name: str, at: tuple[int, int], factor: float, both: bool = False) -> dict[str, Array]:
    found = half_space(NX, NY)
    for sign in (1, -1) if both else (1,):
        found[name][NY - 1 + sign * at[0], NX + sign * at[1]] *= factor
    return found


WRONG: dict[str, tuple[dict[str, Any], str]] = {
    "lacks xx": ({"zz": half_space(NX, NY)["zz"]}, "has no array 'xx', allowed zz, xx, yy, xy"),
    "too few rows": (half_space(NX, NY - 1), r"has the shape \(25, 37\), allowed at least \(27"),
    "too few columns": (half_space(NX - 1, NY), r"has the shape \(27, 35\), allowed at least"),
    "even": ({**half_space(NX, NY), "yy": np.ones((28, 40))}, "yy has the shape .*two odd"),
    "one row": ({**half_space(NX, NY), "yy": np.ones(37)}, "yy has the shape .*two odd numbers"),
    "nan": (spoiled("xx", (2, 3), np.nan), "xx has no finite number at 3 elements along"),
    "not even along": (spoiled("zz", (0, 3), 1.01), "zz is not even along rolling"),
    "not even across": (spoiled("yy", (3, 0), 1.01), "yy is not even across"),
    "not odd": (spoiled("xy", (3, 2), 1.01), "xy is not odd along rolling"),
    "gains energy": (
        {**half_space(NX, NY), "zz": -half_space(NX, NY)["zz"]},
        r"some pressures would store no energy \(least eigenvalue -",
    ),
    "couples too much": (
        {**half_space(NX, NY), "xy": 20 * half_space(NX, NY)["xy"]},
        "some tractions would store no energy",
    ),
    "pressure along": (
        {**half_space(NX, NY), "zx": np.zeros((27, 37))},
        "has an array 'zx', allowed zz, xx, yy, xy",
    ),
    "complex": (
        {**half_space(NX, NY), "xx": 1j * half_space(NX, NY)["xx"]},
        "no .npz file of arrays of numbers: others than real ones",
    ),
    "words": ({**half_space(NX, NY), "xx": np.array([["a"]])}, "no .npz file of arrays of numbers"),
}


@pytest.mark.parametrize("name", WRONG)
def test_files_that_are_refused(name: str, tmp_path: Path) -> None:
    arrays, words = WRONG[name]
    with pytest.raises(CaseError, match=words) as refused:
        railpatch.solve(patch(written(tmp_path, arrays)))
    assert str(refused.value).startswith("material.influence_file: ")


@pytest.mark.parametrize("n", [12, 30])
def test_least_energy_of_all_loads(n: int) -> None:
    """Of springs beneath waves cos(k x), which no period of twice the grid has: theirs alone. Grids
    whose eigenvalues are all found, and by Lanczos' method."""
    x, y = np.arange(n), np.arange(n)[:, None]
    part = (np.cos(2.3 * x / n) * np.cos(1.7 * y / n))[None]
    part[0, 0, 0] += 1e-3
    assert not surely_positive(part)
    check_positive("springs", part[:, :, [*range(n), n - 1]])
    least, most = extremes(part)
    assert least == pytest.approx(1e-3, rel=1e-3)
    # four waves with the sum of their squares over the grid
    assert n * n / 4 < most < n * n
    part[0, 0, 0] -= 2e-3
    with pytest.raises(CaseError, match=r"would store no energy \(least eigenvalue -0\.001 of"):
        check_positive("springs", part[:, :, [*range(n), n - 1]])


def test_half_spaces_store_energy_at_a_glance() -> None:
    for nx, ny in ((8, 8), (40, 30), (90, 60)):
        whole = half_space(nx, ny)
        parts = np.stack([whole[name][ny - 1 :, nx:] for name in NAMES])
        assert surely_positive(parts[:1, :, :-1])
        assert surely_positive(parts[1:])


def test_files_that_are_none(tmp_path: Path) -> None:
    with pytest.raises(CaseError, match=r"own\.npz cannot be read: No such file"):
        railpatch.solve(patch("own.npz"), folder=tmp_path)
    good = Path(written(tmp_path, half_space(NX, NY))).read_bytes()
    for content in (b"", b"zz", good[: len(good) // 2], good[:300] + b"0" * 200 + good[500:]):
        (tmp_path / "bad.npz").write_bytes(content)
        with pytest.raises(CaseError, match=r"bad\.npz is no \.npz file"):
            railpatch.solve(patch("bad.npz"), folder=tmp_path)
    with zipfile.ZipFile(tmp_path / "bad.npz", "w") as file:
        file.writestr("zz.npy", b"no array")
    with pytest.raises(CaseError, match=r"bad\.npz is no \.npz file"):
        railpatch.solve(patch("bad.npz"), folder=tmp_path)


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("", "has no rows of offsets that the grid has"),
        ("0 0 1e-14 1e-14 1e-14 0", "zz has no finite number at .* elements along"),
        ("0 0 1e-14", r"own\.csv:1: 3 values, allowed 6"),
        ("0 0.5 1e-14 1e-14 1e-14 0", r"own\.csv:1: offsets are 0, 0.5, allowed whole numbers"),
        ("0 0 1e-14 1e-14 1e-14 0\n0 0 1e-14 1e-14 1e-14 0", "csv:2: offset 0, 0 is given twice"),
        ("0 0 1e-14 1e-14 x 0", r"csv:1: value is 'x', allowed a finite number"),
    ],
)
def test_tables_that_are_refused(text: str, words: str, tmp_path: Path) -> None:
    (tmp_path / "own.csv").write_text(text, encoding="utf-8")
    with pytest.raises(CaseError, match=words):
        railpatch.solve(patch("own.csv"), folder=tmp_path)


REFUSED: list[tuple[dict[str, Any], str]] = [
    ({"material__shear_modulus": 82e9}, "material.shear_modulus"),
    ({"material__poisson_ratio": 0.3}, "material.poisson_ratio"),
    (
        {"material__viscoelastic_ratio": 1.0, "material__relaxation_time": 1e-3},
        "material.viscoelastic_ratio",
    ),
    (
        {"geometry": {"semi_axes": [5e-3, 5e-3]}, "grid": {"elements": [9, 9]}},
        "geometry.undeformed_distance",
    ),
    ({"motion__regime": "transient_rolling", "motion__distance": 1e-3}, "motion.regime"),
    ({"method__normal": "kik_piotrowski"}, "method.normal"),
    ({"method__tangential": "fastsim"}, "method.tangential"),
    ({"method__derivatives": True}, "method.derivatives"),
    ({"grid__fitted": [8, 8]}, "grid.fitted"),
    ({"layer": {"thickness": 1e-3, "shear_modulus": 1e8}}, "layer"),
    ({"subsurface": {"depths": [1e-3]}}, "subsurface"),
    ({"damage": {"wear": "usfd"}}, "damage"),
    ({"fluid": {"model": "film", "roughness": 1e-6, "viscosity": 1e-3}}, "fluid"),
]


@pytest.mark.parametrize(("change", "named"), REFUSED, ids=[named for _, named in REFUSED])
def test_what_goes_without_it(change: dict[str, Any], named: str) -> None:
    with pytest.raises(CaseError) as refused:
        railpatch.solve(patch("own.npz", **change))
    assert f"{named}: " in str(refused.value)
    assert "with material.influence_file" in str(refused.value)


def test_wheels_and_fmus_refuse_it(tmp_path: Path) -> None:
    with pytest.raises(CaseError, match=r"kind: value is 'wheelset', allowed 'patch' with mat"):
        railpatch.solve(with_values(WHEELSET, material__influence_file="own.npz"))
    file = written(tmp_path, half_space(NX, NY))
    with pytest.raises(CaseError, match=r"material\.influence_file: given, allowed in an FMU"):
        check_regime(load_scene(patch(file)))


def test_nothing_is_known_below_the_surface(tmp_path: Path) -> None:
    contact = Contact(patch(written(tmp_path, half_space(NX, NY))))
    contact.step()
    with pytest.raises(CaseError, match=r"material\.influence_file: given, allowed below the surf"):
        Subsurface(contact, depth=[1e-3])


def test_doubts(tmp_path: Path) -> None:
    """Of coefficients in mm/Pa, km/Pa and mm/(N/mm^2), of those of tractions alone in another
    unit, and of pressure that lifts what is beside it."""
    still = {"motion": {"regime": "none"}, "friction": None, "load": {"approach": 1e-5}}
    for factor in (1e3, 1e-3, 1e9):
        arrays = {name: factor * values for name, values in half_space(NX, NY).items()}
        found = railpatch.solve(patch(written(tmp_path, arrays), **still))
        assert any("coefficients in another unit than m/Pa?" in text for text in found.warnings)
    mixed = half_space(NX, NY)
    arrays = {name: values * (1.0 if name == "zz" else 1e3) for name, values in mixed.items()}
    found = railpatch.solve(patch(written(tmp_path, arrays)))
    states = railpatch.solve_many(patch(written(tmp_path, arrays)), {"creepage": np.zeros((2, 2))})
    assert states.doubts == [text for text in found.warnings if "of an element by itself" in text]
    for name in ("xx", "yy"):
        words = f"{name} of an element by itself is "
        assert any(words in text for text in found.warnings)
    mattress = springs(NX, NY, DOWN, ALONG)
    mattress["zz"][NY - 1, [NX - 1, NX + 1]] = -0.1 * DOWN
    found = railpatch.solve(patch(written(tmp_path, mattress), **still))
    assert any("pressure on an element lifts others" in text for text in found.warnings)


def test_states_are_of_the_coefficients(tmp_path: Path) -> None:
    (tmp_path / "other").mkdir()
    one = Contact(patch(written(tmp_path, half_space(NX, NY))))
    one.step()
    state = one.save()
    wanted = one.step(rolling_speed=25.0, creepage=[2e-4, 0.0]).data
    one.restore(state)
    again = one.step(rolling_speed=25.0, creepage=[2e-4, 0.0]).data
    assert str({**again, "wall_time": 0}) == str({**wanted, "wall_time": 0})
    other = Contact(patch(written(tmp_path / "other", springs(NX, NY, DOWN, ALONG))))
    with pytest.raises(CaseError):
        other.restore(state)
