"""Wrong cases: every error names the key, the value and what is allowed."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from case_samples import PATCH, WHEELSET, with_values
from railpatch import Contact, _core
from railpatch.case import CaseError, load_scene
from railpatch.case.homes import keys_in, models_in
from railpatch.case.kinds import kind_of
from railpatch.case.load import check_table
from railpatch.case.to_core import config_of

THEORIES = [f"'{word}'" for word in ("none", *_core.THEORIES)]
# theories that read Kalker's coefficients, in a message's words
WITH_COEFFICIENTS = [f"'{word}'" for word in _core.THEORY_READERS["percent_kalker"]]


def problems_of(case: Any, **options: Any) -> list[str]:
    with pytest.raises(CaseError) as caught:
        load_scene(case, **options)
    return caught.value.problems


@pytest.mark.parametrize(
    ("key", "value", "line"),
    [
        ("kind", "wheel", "kind: value is 'wheel', allowed 'patch', 'wheel_rail' or 'wheelset'"),
        ("kind", None, "kind: value is missing, allowed 'patch', 'wheel_rail' or 'wheelset'"),
        ("load__normal_force", -1.0, "load.normal_force: value is -1.0, allowed >= 0.0"),
        ("load__normal_force", "1e5", "load.normal_force: value is '1e5', allowed a number"),
        ("load__normal_force", True, "load.normal_force: value is True, allowed a number"),
        (
            "load__normal_force",
            math.inf,
            "load.normal_force: value is inf, allowed a finite number",
        ),
        ("load__approach", 1e-5, "load: value is normal_force and approach, allowed exactly one"),
        (
            "material__poisson_ratio",
            [0.3, 0.6],
            "material.poisson_ratio[1]: value is 0.6, allowed <=",
        ),
        ("material__shear_modulus", -1.0, "material.shear_modulus: value is -1.0, allowed >= 1"),
        ("geometry__semi_axes", [0.006], "geometry.semi_axes: value is [0.006], allowed 2 values"),
        ("geometry__semi_axes", None, "geometry: value is none of them, allowed exactly one of"),
        (
            "geometry__curvatures",
            [1.0, 1.0],
            "geometry: value is semi_axes and curvatures, allowed",
        ),
        ("geometry__width", 1.0, "geometry.line_contact_radius: value is missing, allowed"),
        ("grid__elements", [16, 0], "grid.elements[1]: value is 0, allowed >= 1"),
        ("grid__elements", [16.0, 16], "grid.elements[0]: value is 16.0, allowed a whole number"),
        ("grid__element_size", [1e-4, 1e-4], "grid: value is elements and element_size, allowed"),
        (
            "grid__max_elements",
            [24, 24],
            "grid.max_elements: value is [24, 24], allowed only with element_size",
        ),
        (
            "grid",
            {"fitted": [8, 8], "max_elements": [24, 24]},
            "grid.max_elements: value is [24, 24], allowed only with element_size",
        ),
        ("grid__fitted", [2, 8], "grid.fitted: value is [2, 8], allowed 3 to 64 nodes"),
        ("grid__fitted", [8, 1], "grid.fitted: value is [8, 1], allowed 3 to 64 rows"),
        ("grid__fitted", [65, 8], "grid.fitted[0]: value is 65, allowed <= 64"),
        ("grid__fitted", [8, 65], "grid.fitted[1]: value is 65, allowed <= 64"),
        ("grid__fitted", [8], "grid.fitted: value is [8], allowed 2 values"),
        ("grid__fitted", [8.5, 8], "grid.fitted[0]: value is 8.5, allowed a whole number"),
        ("grid__fitted", [64, 64], "grid.fitted: value is [64, 64], allowed 2304 nodes in all"),
        ("motion__direction", 0, "motion.direction: value is 0, allowed 1 or -1"),
        ("motion__regime", "slide", "motion.regime: value is 'slide', allowed 'none', 'shift', "),
        ("motion__regime", "transient_rolling", "motion.distance: value is missing, allowed a num"),
        ("motion__distance", 1e-3, "motion.distance: value is 0.001, allowed only with regime = "),
        ("motion__steps", 3, "motion.steps: value is 3, allowed only with regime = 'transient_rol"),
        (
            "motion__creepage",
            [[1e-3], 0.0],
            "motion.creepage[0]: value is [0.001], allowed 2 values",
        ),
        (
            "motion__tangential_force",
            [1.0, 0.0],
            "motion.creepage: value is [0.001, 0.0], allowed 0 where tangential_force gives",
        ),
        (
            "motion__tangential_force",
            ["creepage", "free"],
            "motion.tangential_force[1]: value is 'free', allowed a number or 'creepage'",
        ),
        (
            "motion__tangential_force",
            ["creepage", math.nan],
            "motion.tangential_force[1]: value is nan, allowed a finite number",
        ),
        (
            "motion__tangential_force",
            ["creepage", "creepage"],
            "motion.tangential_force: value is ['creepage', 'creepage'], allowed at least one",
        ),
        (
            "motion__tangential_force",
            ["creepage", 30001.0],
            "motion.tangential_force: value is ['creepage', 30001.0], allowed at most "
            "friction.coefficient * load.normal_force = 30000 N in magnitude",
        ),
        (
            "motion__rolling_speed",
            -1.0,
            "motion.rolling_speed: value is -1.0, allowed >= 0.0 m/s; motion.direction = -1 rolls "
            "towards -x",
        ),
        ("friction", None, "friction: value is missing, allowed the table [friction]"),
        ("friction__law", "viscous", "friction.law: value is 'viscous', allowed 'coulomb', 'slip"),
        ("friction__law", "temperature", "friction.reference: value is missing, allowed a number"),
        (
            "friction",
            {
                "law": "temperature",
                "reference": 0.3,
                "change": -0.1,
                "reference_temperature": 0.0,
                "temperature_range": 100.0,
                "memory_distance": 1e-5,
            },
            "friction.memory_distance: value is 1e-05, allowed none: it must be left out "
            "with law = ",
        ),
        (
            "friction__kinetic",
            0.2,
            "friction.kinetic: value is 0.2, allowed none: it must be left out with ",
        ),
        (
            "friction",
            {"law": "slip_velocity", "kinetic": 0.1, "amplitude": -0.2, "halving_speed": 1.0},
            "friction.amplitude: value is -0.2, allowed a law that does not fall below 0",
        ),
        (
            "friction",
            {"law": "slip_velocity", "kinetic": 0.1, "amplitude": [0.2, 0.1], "halving_speed": 1.0},
            "friction.halving_speed: value is 1.0, allowed as many numbers as amplitude",
        ),
        (
            "friction__factor",
            [[0.0, 1.0], [0.0, 0.5]],
            "friction.factor: value is [[0.0, 1.0], [0.0, 0.5]], allowed pairs with increasing",
        ),
        ("friction__coefficient", -0.1, "friction.coefficient: value is -0.1, allowed >= 0"),
        ("friction__coefficient", math.nan, "friction.coefficient: value is nan, allowed a finite"),
        ("layer", {"thickness": 1e-5}, "layer.shear_modulus: value is missing, allowed a num"),
        (
            "layer",
            {"thickness": 0, "hardening": 1e9},
            "layer.hardening: value is 1000000000.0, allowed only with yield_stress",
        ),
        (
            "layer",
            {"thickness": 0, "hardening_table": [[1e-6, 1e8], [2e-6, 2e8]]},
            "layer.hardening_table: value is [1e-06, 100000000.0], allowed a first displacement",
        ),
        ("temperature", {"wheel": -300.0}, "temperature.wheel: value is -300.0, allowed >= -273"),
        (
            "method__normal",
            "stripes",
            "method.normal: value is 'stripes', allowed 'hertz', 'kik_piotrowski', "
            "'kik_piotrowski_corrected', 'analyn' or 'half_space'",
        ),
        (
            "method__tangential",
            "carter",
            f"method.tangential: value is 'carter', allowed {', '.join(THEORIES)} or 'full'",
        ),
        ("method__percent_kalker", 0.0, "method.percent_kalker: value is 0.0, allowed > 0"),
        ("method__polach_k_a", 11.0, "method.polach_k_a: value is 11.0, allowed <= 10"),
        (
            "method__traction_bound",
            "flat",
            "method.traction_bound: value is 'flat', allowed 'parabolic' or 'elliptic'",
        ),
        ("method__tolerance", 0.0, "method.tolerance: value is 0.0, allowed >= 1e-12"),
        (
            "method__accuracy",
            0.01,
            "method.accuracy: value is 0.01 and grid is given, allowed exactly one of 'accuracy'",
        ),
        ("grid", 5, "grid: value is 5, allowed a table"),
    ],
)
def test_wrong_values_of_a_patch(key: str, value: Any, line: str) -> None:
    found = problems_of(with_values(PATCH, **{key: value}))
    assert len(set(found)) == len(found)
    assert found[0].startswith(line) or found[-1].startswith(line), found


@pytest.mark.parametrize(
    ("value", "told"),
    [
        (-1.0, [": value is -1.0, allowed >= 0.0 s"]),
        ("fast", [": value is 'fast', allowed a number"]),
        (math.nan, [": value is nan, allowed a finite number"]),
        ([-1.0, -1.0], [f"[{k}]: value is -1.0, allowed >= 0.0 s" for k in range(2)]),
        ([1.0], [": value is [1.0], allowed 2 values"]),
        ({"wheel": 1.0}, [": value is a table, allowed a number"]),
    ],
)
def test_one_number_for_both_bodies_is_told_once(value: Any, told: list[str]) -> None:
    found = problems_of(with_values(PATCH, material__relaxation_time=value))
    assert found == [f"material.relaxation_time{line}" for line in told]


@pytest.mark.parametrize(
    ("key", "value", "line"),
    [
        (
            "wheelset__vertical_force",
            1e4,
            "wheelset: value is z and vertical_force, allowed exactly",
        ),
        ("wheelset__z", None, "wheelset: value is none of them, allowed exactly one of 'z'"),
        ("wheelset__left", {"offset": [0, 0]}, "wheelset.left.offset: value is [0, 0], allowed 3"),
        ("wheelset__nominal_radius", None, "wheelset.nominal_radius: value is missing, allowed m,"),
        ("track__roller_radius", 0.8, "track.roller_radius: value is 0.8, allowed only with kind"),
        (
            "track",
            None,
            "track: value is missing, allowed a table [track]: rails or rollers (m, rad, rad/s); "
            "[track] with kind = 'rail' is enough",
        ),
        ("track__kind", "roller", "track.roller_radius: value is missing, allowed a radius > 0"),
        ("profiles__rail", None, "profiles.rail_left: value is missing, allowed 'rail_left', or"),
        ("profiles__rail_left", "UIC60", "profiles.rail: value is 'UIC60@1:40', allowed only with"),
        (
            "wheel",
            {"side": "left"},
            "wheel: value is a table, but the key is unknown, allowed material",
        ),
    ],
)
def test_wrong_values_of_a_wheelset(key: str, value: Any, line: str) -> None:
    found = problems_of(with_values(WHEELSET, **{key: value}))
    # one of each side
    assert len(found) == (2 if key == "profiles__rail" else 1)
    assert found[0].startswith(line), found


@pytest.mark.parametrize(
    ("creepage", "lines"),
    [
        ([1, 2, 3], ["motion.creepage: value is [1, 2, 3], allowed 2 values"]),
        ([[1e-3, 1.0, 2.0]], ["motion.creepage[0]: value is [0.001, 1.0, 2.0], allowed 2 values"]),
        ([["a", 1.0]], ["motion.creepage[0][0]: value is 'a', allowed a number"]),
        (5, ["motion.creepage: value is 5, allowed a list"]),
        (
            [1e-3, [1.0, 2.0]],
            [
                "motion.creepage[1]: value is [1.0, 2.0], allowed a number",
                "motion.creepage[0]: value is 0.001, allowed a list",
            ],
        ),
    ],
)
def test_one_pair_or_a_list_of_them_is_told_as_it_was_meant(
    creepage: Any, lines: list[str]
) -> None:
    motion = {"regime": "transient_rolling", "distance": 1e-3, "rolling_speed": 10.0}
    with pytest.raises(CaseError) as error:
        load_scene(with_values(PATCH, motion={**motion, "creepage": creepage}))
    assert error.value.problems == lines


def test_many_wrong_elements_of_a_list_are_told_by_the_first_ones() -> None:
    """Three one by one and how many more, of each kind of mistake; a fourth one by itself too."""
    gap = sphere_gap(5)
    gap[0][:] = [float("nan")] * 5
    gap[2][:4] = ["a"] * 4
    grid = {"element_size": [1e-3, 1e-3]}
    with pytest.raises(CaseError) as error:
        load_scene(with_values(PATCH, geometry={"undeformed_distance": gap}, grid=grid))
    key, number = "geometry.undeformed_distance", "a number"
    assert error.value.problems == [
        *(f"{key}[0][{i}]: value is nan, allowed a finite number" for i in range(3)),
        f"{key}: 2 more of its elements, allowed a finite number",
        *(f"{key}[2][{i}]: value is 'a', allowed {number}" for i in range(4)),
    ]


def sphere_gap(count: int) -> list[list[Any]]:
    """m, rows of the undeformed distance of a sphere of 0.5 m, elements of 1 mm."""
    x = [1e-3 * (i - (count - 1) / 2) for i in range(count)]
    return [[u * u + v * v for u in x] for v in x]


def test_a_roller_has_no_cant() -> None:
    roller = {"kind": "roller", "roller_radius": 0.8, "cant": 0.025}
    assert problems_of(with_values(WHEELSET, track=roller)) == [
        "track.cant: value is 0.025, allowed 0 with kind = 'roller'"
    ]


def test_every_problem_is_told_at_once_with_a_hint() -> None:
    case = with_values(
        PATCH, friction__coeficient=0.3, load__normal_force=-1.0, method__tolerance="small"
    )
    assert problems_of(case) == [
        "load.normal_force: value is -1.0, allowed >= 0.0 N",
        "friction.coeficient: value is 0.3, but the key is unknown, allowed law, coefficient, "
        "shape, kinetic, amplitude, halving_speed, polach_a, polach_b, memory_distance, "
        "memory_speed, reference, change, reference_temperature, temperature_range, factor, "
        "along_track, scale; did you mean 'coefficient'?",
        "method.tolerance: value is 'small', allowed a number",
    ]


@pytest.mark.parametrize(
    ("case", "key", "value", "line"),
    [
        (WHEELSET, "wheelset__nominal_radius", 460.0, "allowed <= 10.0 m"),
        (WHEELSET, "track__gauge", 1435.0, "allowed <= 10.0 m"),
        (PATCH, "material__shear_modulus", [82e9, -1.0], "allowed >= 1.0 Pa"),
        (PATCH, "fluid", {"model": "film", "roughness": 0.5}, "allowed <= 0.001 m"),
        (PATCH, "fluid", {"model": "film", "water_rate": 25.0}, "allowed <= 1.0 m^3/s"),
        (PATCH, "friction__coefficient", 35.0, "allowed <= 10.0"),
        (PATCH, "grid__elements", [16, 0], "allowed >= 1"),
    ],
)
def test_limits_have_their_unit(case: Any, key: str, value: Any, line: str) -> None:
    """Who writes mm, MPa or l/s is told the unit with the limit."""
    assert problems_of(with_values(case, **{key: value}))[0].endswith(line)


@pytest.mark.parametrize("kind", ["patch", "wheelset", "vehicle", "rig", "curve", "wheelset_run"])
def test_every_key_in_another_table_is_led_to_its_own(kind: str) -> None:
    """Of every table of a file of this kind: its keys, in other ones that have none of that name, a
    fifth of them in each, are answered by the name of a table that has it."""
    fields = kind_of(kind).model.model_fields
    tables = {name: next(models_in(of.annotation), None) for name, of in fields.items()}
    keys: dict[str, set[str]] = {}
    for key, table in keys_in(fields):
        keys.setdefault(key, set()).add(table)
    assert len(keys) > 60
    asked: set[str] = set()
    held = [(name, model) for name, model in tables.items() if model is not None]
    for place, (name, model) in enumerate(held):
        others = (key for k, key in enumerate(keys) if (k + place) % 5 == 0)
        strange = {key: "?" for key in others if key not in model.model_fields}
        asked |= set(strange)
        with pytest.raises(CaseError) as caught:
            check_table(model, strange, name, among=(fields,))
        told = {line.split(":")[0]: line for line in caught.value.problems}
        for key in strange:
            said = told[f"{name}.{key}"].split(f"; {key!r} is a key of ")[1]
            wanted = {table or "the top of the file" for table in keys[key]}
            assert any(said.startswith(table) for table in wanted), (name, key, said)
    assert len(asked) > 0.9 * len(keys)


def test_a_key_of_another_kind_is_led_to_it() -> None:
    (problem,) = problems_of(with_values(PATCH, motion__nominal_radius=0.46))
    assert problem.endswith("; 'nominal_radius' is a key of [wheelset]")
    (problem,) = problems_of(with_values(PATCH, regime="shift"))
    assert problem.endswith("; 'regime' is a key of [motion]")
    (problem,) = problems_of(with_values(PATCH, grid__rolling_sped=10.0))
    assert problem.endswith("; did you mean 'rolling_speed' of [motion]?")
    # where a near key stands in its own table, that comes first
    (problem,) = problems_of(with_values(PATCH, friction__coeficient=0.3))
    assert problem.endswith("; did you mean 'coefficient'?")


def test_toml_errors_name_the_file(tmp_path: Path) -> None:
    path = tmp_path / "case.toml"
    path.write_text("kind = patch\n")
    (problem,) = problems_of(path)
    assert problem.startswith(f"{path}: is not TOML: ")
    assert "line 1" in problem
    table = tmp_path / "points.csv"
    table.write_text("y;force\n1;2\n")
    (problem,) = problems_of(table)
    assert "; scenes, sweeps and wear are TOML files, and a table of numbers (.csv)" in problem
    path.write_bytes(b"\xff\xfe")
    assert problems_of(path) == [f"{path}: is not a text file in UTF-8"]
    (problem,) = problems_of(tmp_path / "absent.toml")
    assert problem.endswith("absent.toml: cannot be read: No such file or directory")


GAP = {"geometry__semi_axes": None, "grid": {"element_size": [1e-4, 1e-4]}}


@pytest.mark.parametrize(
    ("text", "problem"),
    [
        ("0,1\n2\n", "line 2 holds 1 values, allowed 2 as in the first"),
        ("0,1\n\n2,x\n", "gap.csv:3: value is 'x', allowed a finite number"),
        ("0,nan\n", "gap.csv:1: value is 'nan', allowed a finite number"),
        (",".join(["0"] * 1001), "shape is (1, 1001), allowed 1 ... 1000 in each direction"),
        ("# nothing\n", "value is empty, allowed one row of numbers per grid row"),
    ],
)
def test_undeformed_distance_of_a_bad_file(tmp_path: Path, text: str, problem: str) -> None:
    (tmp_path / "gap.csv").write_text(text)
    case = with_values(PATCH, geometry__undeformed_distance="gap.csv", **GAP)
    with pytest.raises(CaseError) as caught:
        config_of(load_scene(case, folder=tmp_path))
    assert str(caught.value).startswith("geometry.undeformed_distance: ")
    assert str(caught.value).endswith(problem)


def test_undeformed_distance_needs_an_element_size() -> None:
    case = with_values(PATCH, geometry__semi_axes=None, geometry__undeformed_distance=[[0.0]])
    assert problems_of(case) == [
        "grid.element_size: value is missing, allowed [dx, dy] in m with "
        "geometry.undeformed_distance"
    ]


def test_undeformed_distance_from_file_and_array(tmp_path: Path) -> None:
    gap = np.arange(12.0).reshape(3, 4) * 1e-6
    np.savetxt(tmp_path / "gap.csv", gap, delimiter=",")
    for value in ("gap.csv", gap):
        case = with_values(PATCH, geometry__undeformed_distance=value, **GAP)
        config = config_of(load_scene(case, folder=tmp_path))
        np.testing.assert_array_equal(config["undeformed_distance"], gap)


LINE = {"geometry": {"line_contact_radius": 0.5, "width": 0.01}, "grid": {"elements": [16, 1]}}
LAYER = {"shear_modulus": 8.2e9, "thickness": 5e-5}
UNLIKE = {"material__poisson_ratio": [0.31, 0.28], "method__normal": "half_space"}


@pytest.mark.parametrize(
    ("change", "problem"),
    [
        (
            {**LINE, "load": {"approach": 1e-5}},
            "load.approach: value is 1e-05, allowed normal_force with a line contact",
        ),
        (
            {**LINE, "method__tangential": "fastsim"},
            "method.tangential: value is 'fastsim', allowed 'full' with a line contact",
        ),
        (
            {**LINE, "method__tangential": "polach"},
            "method.tangential: value is 'polach', allowed 'full' with a line contact",
        ),
        (
            {**LINE, "grid": {"elements": [16, 16]}},
            "grid.elements: value is [16, 16], allowed [n, 1] with a line contact",
        ),
        (
            {"layer": LAYER, "method__tangential": "fastsim"},
            "method.tangential: value is 'fastsim', allowed 'full' with a layer of thickness > 0",
        ),
        (
            {"layer": LAYER, "method__tangential": "linear"},
            "method.tangential: value is 'linear', allowed 'full' with a layer of thickness > 0",
        ),
        (
            {**UNLIKE, "method__tangential": "fastsim"},
            "method.tangential: value is 'fastsim', allowed 'full' with unlike (1 - 2 nu)/G of "
            "wheel and rail in 'material'",
        ),
        (
            {**UNLIKE, "method__normal": "hertz"},
            "method.normal: value is 'hertz', allowed 'half_space' with unlike (1 - 2 nu)/G of "
            "wheel and rail in 'material'",
        ),
        (
            {**UNLIKE, "grid": {"fitted": [8, 8]}},
            "grid.fitted: value is [8, 8], allowed none: it must be left out "
            "with unlike (1 - 2 nu)/G of "
            "wheel and rail in 'material'",
        ),
        (
            {**UNLIKE, "method__accuracy": 0.05, "grid": None},
            "method.accuracy: value is 0.05, allowed none: it must be left out "
            "with unlike (1 - 2 nu)/G of "
            "wheel and rail in 'material': give 'grid'",
        ),
    ],
)
def test_what_this_version_cannot_combine(change: dict[str, Any], problem: str) -> None:
    assert problems_of(with_values(PATCH, **change)) == [problem]
    # the normal problem alone has no such limits, but for those of the line contact itself
    if "tangential" in problem:
        alone = {"layer": None, "method__tangential": None, "friction": None, "motion": None}
        load_scene(with_values(PATCH, **{**change, **alone}))


@pytest.mark.parametrize(
    ("change", "problem"),
    [
        (
            {"grid__fitted": [8, 8], "method__tangential": "fastsim"},
            "grid.fitted: value is [8, 8], allowed tangential = 'full', or no fitted rows",
        ),
        (
            {"grid__fitted": [8, 8], "method__spin_offset": "sixth"},
            "method.spin_offset: value is 'sixth', allowed 'automatic', 'none' with grid.fitted: "
            "no steps from element to element read it",
        ),
        (
            {
                "geometry": {"line_contact_radius": 0.5, "width": 0.1},
                "grid": {"fitted": [8, 3]},
            },
            "grid.fitted: value is [8, 3], allowed [n, 1] with a line contact",
        ),
    ],
)
def test_fitted_rows_are_of_the_full_theory(change: dict[str, Any], problem: str) -> None:
    assert problems_of(with_values(PATCH, **change)) == [problem]


@pytest.mark.parametrize("case", [PATCH, WHEELSET])
def test_temperature_needs_a_tangential_problem(case: dict[str, Any]) -> None:
    heated = with_values(case, temperature={"wheel": 20.0, "rail": 20.0})
    load_scene(heated)
    why = "allowed none: it must be left out with method.tangential = 'none'"
    assert problems_of(with_values(heated, method__tangential="none")) == [
        f"friction: value is given, {why}",
        f"temperature: value is given, {why}",
    ]


@pytest.mark.parametrize("motion", [None, {"regime": "none"}])
def test_temperature_needs_rolling(motion: Any) -> None:
    heated = with_values(PATCH, temperature={"wheel": 20.0}, motion=motion)
    why = "allowed none: it must be left out with motion.regime = 'none'"
    assert problems_of(heated) == [
        f"friction: value is given, {why}",
        f"temperature: value is given, {why}",
    ]


def test_an_offset_spin_rolls() -> None:
    case = with_values(PATCH, motion={"regime": "shift"}, method__spin_offset="sixth")
    assert problems_of(case) == [
        "method.spin_offset: value is 'sixth', allowed 'automatic', 'none' with regime = 'shift': "
        "no steps from element to element read it"
    ]
    rolling = {"regime": "transient_rolling", "distance": 1e-3}
    load_scene(with_values(case, motion=rolling))


@pytest.mark.parametrize("case", [PATCH, WHEELSET])
@pytest.mark.parametrize("tangential", ["none", "linear", "polach", "table"])
def test_an_offset_spin_is_of_elements(case: dict[str, Any], tangential: str) -> None:
    """Theories that give no tractions, and none at all."""
    calm = {"friction": None} if tangential == "none" else {}
    method = {"tangential": tangential, "spin_offset": "sixth"}
    (problem,) = set(problems_of(with_values(case, **calm, method=method)))
    assert problem.startswith("method.spin_offset: value is 'sixth', allowed 'automatic', 'none' w")
    for offset in ("automatic", "none"):
        load_scene(with_values(case, **calm, method={**method, "spin_offset": offset}))


@pytest.mark.parametrize(
    ("case", "change", "why"),
    [
        (PATCH, {"method__tangential": "none"}, "method.tangential"),
        (WHEELSET, {"method__tangential": "none"}, "method.tangential"),
        (PATCH, {"motion": None}, "motion.regime"),
    ],
)
def test_what_belongs_to_the_tangential_problem_goes_with_it(
    case: dict[str, Any], change: dict[str, Any], why: str
) -> None:
    load_scene(with_values(case, **change, friction=None))
    scene = with_values(case, **change, layer=LAYER, temperature={"wheel": 20.0, "rail": 20.0})
    found = problems_of(with_values(scene, grid__fitted=[8, 8]))
    left_out = f"allowed none: it must be left out with {why} = 'none'"
    assert found == [
        *(f"{table}: value is given, {left_out}" for table in ("friction", "layer", "temperature")),
        f"grid.fitted: value is [8, 8], {left_out}: rows are those of the tangential problem",
    ]


def test_a_patch_that_does_not_move_has_no_creepage() -> None:
    motion = {"regime": "none", "creepage": [1e-3, 0.0], "rolling_speed": 12.0}
    why = "allowed none: it must be left out with regime = 'none'"
    assert problems_of(with_values(PATCH, friction=None, motion=motion)) == [
        f"motion.creepage: value is [0.001, 0.0], {why}",
        f"motion.rolling_speed: value is 12.0, {why}",
    ]
    contact = Contact(with_values(PATCH, friction=None, motion=None))
    contact.step(normal_force=5e4)
    with pytest.raises(CaseError, match=r"spin_creepage: value is 0\.1, but this is no moving"):
        contact.step(spin_creepage=0.1)


def test_a_speed_of_memory_needs_something_remembered() -> None:
    law = {"law": "slip_velocity", "kinetic": 0.1, "amplitude": 0.2, "halving_speed": 1.0}
    case = with_values(PATCH, friction={**law, "memory_speed": 0.1})
    assert problems_of(case) == [
        "friction.memory_speed: value is 0.1, allowed only with memory_distance > 0: nothing is "
        "remembered without"
    ]
    load_scene(with_values(case, friction__memory_distance=1e-4))


def test_steps_that_stand_alone_take_no_time() -> None:
    case = with_values(WHEELSET, wheelset__time_step=1e-3)
    assert problems_of(case) == [
        "wheelset.time_step: value is 0.001, allowed 0 but with motion.regime = "
        "'transient_rolling', track.rail_support, temperature.bulk, fluid.recovery or "
        "fluid.oxide.drying"
    ]
    load_scene(with_values(case, track__rail_support={"stiffness": [2e7, 8e7]}))
    load_scene(with_values(case, temperature={"bulk": {"mass": 300.0}}))
    load_scene(with_values(case, motion={"regime": "transient_rolling"}))


def test_an_undeformed_distance_is_its_own_grid() -> None:
    case = with_values(
        PATCH,
        geometry={"undeformed_distance": [[1e-5 * (i + j) for i in range(4)] for j in range(4)]},
        grid={"element_size": [1e-4, 1e-4], "max_elements": [8, 8]},
    )
    assert problems_of(case) == [
        "grid.max_elements: value is [8, 8], allowed none: it must be left out with "
        "geometry.undeformed_distance: its rows and columns are the grid"
    ]


def test_all_conflicts_of_a_scene_are_told_at_once() -> None:
    """Between tables and within them; the first line as it is alone."""
    law = {"law": "slip_velocity", "kinetic": 0.1, "amplitude": 0.2, "halving_speed": 1.0}
    case = with_values(PATCH, friction=law, layer=LAYER, grid={"fitted": [8, 8]}, temperature={})
    linear = with_values(case, method={"tangential": "linear"})
    found = problems_of(linear)
    assert (
        found[0] == problems_of(with_values(PATCH, layer=LAYER, **{"method": linear["method"]}))[0]
    )
    why = [line.rpartition("with ")[2] for line in found if line.startswith("method.tangential")]
    assert why == ["a layer of thickness > 0", "friction.law = 'slip_velocity'", "temperature"]
    assert sum(line.startswith("grid.fitted") for line in found) == 3
    assert [
        line.partition(":")[0]
        for line in problems_of(
            with_values(
                PATCH, friction__kinetic=0.1, friction__polach_a=0.5, friction__coefficient=None
            )
        )
    ] == ["friction.coefficient", "friction.kinetic", "friction.polach_a"]
    rolling = {"motion": {"regime": "transient_rolling"}, "grid": {"fitted": [8, 8]}}
    # rows are what stands in the way of rolling step by step, before a size that is missing
    assert problems_of(with_values(WHEELSET, **rolling, wheelset__time_step=1e-3)) == [
        "grid.fitted: value is [8, 8], allowed none: it must be left out with motion.regime = "
        "'transient_rolling'",
        "grid.element_size: value is missing, allowed [dx, dy] in m with motion.regime = "
        "'transient_rolling'",
    ]


@pytest.mark.parametrize(
    ("tangential", "key", "value", "allowed"),
    [
        ("full", "percent_kalker", 60.0, " or ".join(WITH_COEFFICIENTS)),
        ("fastsim", "polach_k_a", 0.5, "'polach'"),
        ("fastrip", "polach_k_s", 0.5, "'polach'"),
        ("polach", "fastsim_k0", 0.5, "'fastsim'"),
        ("linear", "fastsim_alpha", 0.5, "'fastsim'"),
        ("fastrip", "fastsim_beta", 0.5, "'fastsim'"),
        ("fastrip", "traction_bound", "elliptic", "'fastsim'"),
        ("polach", "flexibility_blending", "none", "'fastsim' or 'fastrip'"),
    ],
)
def test_keys_of_other_theories(tangential: str, key: str, value: Any, allowed: str) -> None:
    case = with_values(PATCH, method={"tangential": tangential, key: value})
    assert problems_of(case) == [
        f"method.{key}: value is {value!r}, allowed only with tangential = {allowed}"
    ]
    # nor is it read without a tangential problem
    calm = with_values(case, method__tangential="none", friction=None)
    assert problems_of(calm)[0].startswith(f"method.{key}: value is {value!r}, allowed only with")


def test_fastrip_has_no_compatible_blending() -> None:
    method = {"tangential": "fastrip", "flexibility_blending": "contact"}
    assert problems_of(with_values(PATCH, method=method)) == [
        "method.flexibility_blending: value is 'contact', allowed 'sliding' or 'none' with "
        "tangential = 'fastrip'"
    ]


@pytest.mark.parametrize(
    ("values", "line"),
    [
        ({"method__accuracy": 1e-4}, "method.accuracy: value is 0.0001, allowed >= 0.001"),
        ({"method__accuracy": 0.5}, "method.accuracy: value is 0.5, allowed <= 0.2"),
        (
            {"method": {"accuracy": 0.01, "tangential": "fastsim"}},
            "method.accuracy: value is 0.01, allowed >= 0.",
        ),
        (
            {"method": {"accuracy": 0.01, "normal": "kik_piotrowski"}},
            "method.accuracy: value is 0.01, allowed >= 0.",
        ),
        (
            {"method": {"accuracy": 0.01, "spin_offset": "sixth"}},
            "method.spin_offset: value is 'sixth', allowed 'automatic', 'none' with accuracy",
        ),
        (
            {"geometry": {"line_contact_radius": 0.3, "width": 0.01}, "method__accuracy": 0.01},
            "method.accuracy: value is 0.01, allowed none: it must be left out with a line contact",
        ),
        (
            {"geometry": {"undeformed_distance": "gap.csv"}, "method__accuracy": 0.01},
            "method.accuracy: value is 0.01, allowed none: it must be left out "
            "with geometry.undeformed",
        ),
    ],
)
def test_wrong_accuracies(values: dict[str, Any], line: str) -> None:
    found = problems_of(with_values(PATCH, grid=None, **values))
    assert any(text.startswith(line) for text in found), found


@pytest.mark.parametrize(
    ("values", "line"),
    [
        (
            {"method__normal": "hertz"},
            "method.normal: value is 'hertz', allowed 'half_space' with reference_surface = "
            "'curved'",
        ),
        (
            {"method__tangential": "fastsim"},
            "method.tangential: value is 'fastsim', allowed 'full' or 'none' with "
            "reference_surface = 'curved'",
        ),
        (
            {"grid": {"fitted": [8, 8]}},
            "grid.fitted: value is [8, 8], allowed none: it must be left out "
            "with reference_surface = "
            "'curved'",
        ),
        (
            {"grid": None, "method__accuracy": 0.05},
            "method.accuracy: value is 0.05, allowed none: it must be left out "
            "with reference_surface = "
            "'curved': give 'grid'",
        ),
        (
            {"material__shear_modulus": [82e9, 8e9]},
            "material: value is unlike bodies, allowed equal (1 - 2 nu)/G with reference_surface "
            "= 'curved'",
        ),
    ],
)
def test_curved_surfaces_stand_alone(values: dict[str, Any], line: str) -> None:
    case = with_values(WHEELSET, method__reference_surface="curved")
    load_scene(case)
    load_scene(with_values(case, method__derivatives=True))
    assert problems_of(with_values(case, **values)) == [line]


def test_patches_have_no_curved_surface() -> None:
    assert problems_of(with_values(PATCH, method__reference_surface="curved")) == [
        "method.reference_surface: value is 'curved', allowed 'plane' with kind = 'patch'"
    ]
