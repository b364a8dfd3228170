"""The published schema says what the checks do; the interface's example is accepted."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import railpatch
from case_samples import PATCH, WHEELSET, with_values
from railpatch import _core
from railpatch.case import CaseError, json_schema, load_scene
from railpatch.case.moving import changed_case, moving_keys

# "m, ..." of a value, "... (m, rad)" of a table, "... (no unit)" of a choice
UNITS = (
    "-|%|m|s|N/m|N s/m|1/m|rad|rad/s|rad/m|m/s|s/m|N|Pa|Pa/m|K|degrees C|W/K|W/.m K.|J/.kg K.|"
    "kg/m.3|kg/J|kg|Pa s|1/Pa|m.3/s|1/N|J/m|N m"
)
UNIT = re.compile(
    rf"^({UNITS})( and .*)?( or .*)?, |\((no unit|file|Pa|m|N|1/N|-|rad|degrees C)[^()]*"
)


def properties() -> Iterator[tuple[str, dict[str, Any]]]:
    for table, content in json_schema()["$defs"].items():
        assert content["additionalProperties"] is False, table
        for key, value in content["properties"].items():
            yield f"{table}.{key}", value


def test_every_key_has_a_description_with_its_unit() -> None:
    found = dict(properties())
    assert len(found) > 60
    for key, value in found.items():
        assert UNIT.search(value.get("description", "")), (key, value.get("description"))


def test_kinds_and_choices() -> None:
    schema = json_schema()
    assert set(schema["discriminator"]["mapping"]) == {"patch", "wheel_rail", "wheelset"}
    method = schema["$defs"]["Method"]["properties"]
    by_rows = ["kik_piotrowski", "kik_piotrowski_corrected", "analyn"]
    assert method["normal"]["enum"] == ["hertz", *by_rows, "half_space"]
    assert method["tangential"]["enum"] == ["none", *_core.THEORIES, "full"]


def test_the_first_case_is_accepted(tmp_path: Path) -> None:
    page = (Path(__file__).parents[2] / "docs/command_line.md").read_text(encoding="utf-8")
    text = re.search(r"^```toml\n(.*?)^```", page, re.DOTALL | re.MULTILINE)
    assert text
    (tmp_path / "case.toml").write_text(text[1])
    assert load_scene(tmp_path / "case.toml").case.kind == "patch"


def test_one_number_stands_for_both_bodies() -> None:
    ratios = with_values(PATCH, material__poisson_ratio=[0.31, 0.28], motion=None, friction=None)
    case = load_scene(ratios).case
    assert case.material.shear_modulus == [82e9, 82e9]
    assert case.material.poisson_ratio == [0.31, 0.28]


def test_numpy_and_tuples_are_accepted() -> None:
    case = with_values(
        PATCH, motion__creepage=np.array([1e-3, 0.0]), grid__elements=(np.int64(8), 8)
    )
    checked = load_scene(case).case
    assert checked.motion.creepage == [1e-3, 0.0]
    assert checked.grid.elements == [8, 8]


def test_normal_problem_alone_needs_no_friction() -> None:
    for change in ({"motion": None}, {"method": {"tangential": "none"}}):
        case = load_scene(with_values(PATCH, friction=None, **change)).case
        assert not case.has_tangential


def test_one_wheel_needs_only_its_own_profiles() -> None:
    profiles = {"wheel_left": "S1002", "rail_left": "UIC60"}
    case = with_values(WHEELSET, kind="wheel_rail", wheel={"side": "left"}, profiles=profiles)
    assert load_scene(case).case.sides == ("left",)


def test_changes_give_a_checked_case_and_leave_the_first() -> None:
    first = load_scene(PATCH).case
    second = changed_case(first, {"creepage": np.array([2e-3, 1e-3]), "normal_force": 5e4})
    expected = with_values(PATCH, motion__creepage=[2e-3, 1e-3], load__normal_force=5e4)
    assert second == load_scene(expected).case
    assert first == load_scene(PATCH).case


def test_changes_of_a_wheelset_may_be_partial() -> None:
    case = with_values(WHEELSET, wheelset__left={"rotation": [0.01, 0, 0]})
    changes = {
        "y": 1e-3,
        "left": {"offset": [0, 0, 1e-4]},
        "track": {"right": {"offset": [0, 1e-5, 0]}},
    }
    expected = with_values(
        case,
        wheelset__y=1e-3,
        wheelset__left={"rotation": [0.01, 0, 0], "offset": [0, 0, 1e-4]},
        track__right={"offset": [0, 1e-5, 0]},
    )
    assert changed_case(load_scene(case).case, changes) == load_scene(expected).case


@pytest.mark.parametrize(
    ("case", "changes", "problem"),
    [
        (PATCH, {"approach": 1e-5}, "approach: value is 1e-05, but this is no moving input"),
        (PATCH, {"coefficient": 0.2}, "coefficient: value is 0.2, but this is no moving input"),
        (PATCH, {"creepage": [0.0]}, "motion.creepage: value is [0.0], allowed 2 values"),
        (PATCH, {"normal_force": -1.0}, "load.normal_force: value is -1.0, allowed >= 0"),
        (WHEELSET, {"nominal_radius": 0.5}, "nominal_radius: value is 0.5, but this is no moving"),
        (WHEELSET, {"vertical_force": 1e4}, "vertical_force: value is 10000.0, but this is no"),
        (WHEELSET, {"roller_pitch_rate": 1.0}, "roller_pitch_rate: value is 1.0, but this is no"),
        (WHEELSET, {"left": {"ofset": [0, 0, 0]}}, "wheelset.left.ofset: value is [0, 0, 0], but"),
        (WHEELSET, {"track": {"gauge": 1.0}}, "track.gauge: value is 1.0, but this is no moving"),
        (WHEELSET, {"track": 1.0}, "track: value is 1.0, allowed a table"),
        (WHEELSET, {"y": float("nan")}, "wheelset.y: value is nan, allowed a finite number"),
    ],
)
def test_wrong_changes(case: dict[str, Any], changes: dict[str, Any], problem: str) -> None:
    with pytest.raises(CaseError) as caught:
        changed_case(load_scene(case).case, changes)
    assert str(caught.value).startswith(problem)


def test_moving_keys_follow_what_is_prescribed() -> None:
    assert "normal_force" in moving_keys(load_scene(PATCH).case)
    case = with_values(PATCH, load={"approach": 1e-5})
    assert next(iter(moving_keys(load_scene(case).case))) == "approach"
    force = with_values(WHEELSET, wheelset__z=None, wheelset__vertical_force=2e4)
    keys = moving_keys(load_scene(force).case)
    assert "vertical_force" in keys
    assert "z" not in keys


def test_plausible_ranges_stand_in_the_schema() -> None:
    """Those that warnings tell: one step outside of each end is warned of, the ends are not."""
    patch = json_schema()["$defs"]
    found = {
        name: field["plausible"]
        for model in patch.values()
        for name, field in model.get("properties", {}).items()
        if "plausible" in field
    }
    assert found["normal_force"] == [100.0, 5e5]
    assert found["shear_modulus"] in ([1e8, 1e12], [1e6, 1e12])  # of bodies, or of the layer
    assert {
        "normal_force",
        "shear_modulus",
        "coefficient",
        "creepage",
        "spin_creepage",
        "y",
    } <= set(found)
    for load, warned in ((100.0, False), (99.0, True), (5e5, False), (5.01e5, True)):
        result = railpatch.solve(
            {
                "kind": "patch",
                "geometry": {"curvatures": [1.0, 1.5]},
                "load": {"normal_force": load},
                "grid": {"elements": [8, 8]},
                "friction": {"coefficient": 0.3},
                "motion": {"creepage": [1e-3, 0.0]},
            }
        )
        assert any("normal force" in text for text in result.warnings) == warned
