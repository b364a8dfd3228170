"""The plan of a sweep: its points, its cases, what it refuses."""

from __future__ import annotations

import itertools
import math
from pathlib import Path

import numpy as np
import pytest
from railpatch import CaseError
from railpatch.sweep.plan import load_plan, put

PATCH = """kind = "patch"
[geometry]
curvatures = [2.0, 1.5]
[load]
normal_force = 1e4
[method]
tangential = "polach"
[friction]
coefficient = 0.3
[motion]
creepage = [1e-3, 0.0]
rolling_speed = 10.0
"""


def sweep_file(folder: Path, text: str, scene: str = PATCH) -> Path:
    """A sweep beside its scene."""
    (folder / "scene.toml").write_text(scene, encoding="utf-8")
    path = folder / "sweep.toml"
    path.write_text(text, encoding="utf-8")
    return path


def design(name: str, more: str = "") -> str:
    """Two keys over ranges."""
    return f"""[sweep]
scene = "scene.toml"
design = "{name}"
{more}
[[vary]]
key = "friction.coefficient"
low = 0.1
high = 0.5
[[vary]]
key = "load.normal_force"
low = 1e3
high = 1e5
logarithmic = true
"""


def test_grid_is_every_combination(tmp_path: Path) -> None:
    """With values and ranges, the last key the fastest; range ends are exact."""
    text = """[sweep]
scene = "scene.toml"
[[vary]]
key = "motion.creepage[1]"
values = [0.0, 2e-3]
[[vary]]
key = "load.normal_force"
low = 1e3
high = 1e5
count = 3
logarithmic = true
"""
    plan = load_plan(sweep_file(tmp_path, text))
    wanted = itertools.product([0.0, 2e-3], [1e3, 1e4, 1e5])
    assert [p[0] for p in plan.points] == [w for w, _ in itertools.product([0.0, 2e-3], range(3))]
    for point, (creepage, force) in zip(plan.points, wanted, strict=True):
        assert point[0] == creepage
        assert point[1] == pytest.approx(force, rel=1e-14)
    assert plan.points[-1][1] == 1e5
    case = plan.case(plan.points[-1])
    assert case["motion"]["creepage"] == [1e-3, 2e-3]
    assert case["load"]["normal_force"] == 1e5
    assert plan.content["motion"]["creepage"] == [1e-3, 0.0]


@pytest.mark.parametrize(
    ("low", "high", "count"), [(-3e-3, 1e-3, 5), (-0.1, 0.2, 4), (-7.0, 3.0, 11)]
)
def test_a_range_through_zero_has_zero(tmp_path: Path, low: float, high: float, count: int) -> None:
    """And not what rounding leaves of it: -4e-19, 1e-17."""
    text = f"""[sweep]
scene = "scene.toml"
[[vary]]
key = "motion.creepage[1]"
low = {low}
high = {high}
count = {count}
"""
    found = [point[0] for point in load_plan(sweep_file(tmp_path, text)).points]
    assert found.count(0.0) == 1
    assert found == pytest.approx(np.linspace(low, high, count).tolist(), abs=1e-15)


@pytest.mark.parametrize(("name", "cases"), [("latin_hypercube", 64), ("sobol", 64)])
def test_points_fill_the_space(tmp_path: Path, name: str, cases: int) -> None:
    """Of each key one value in each of 64 parts of its range (Latin hypercube; Sobol's points are
    one too, Sobol 1967); another seed gives others, the same seed the same."""
    plan = load_plan(sweep_file(tmp_path, design(name, "samples = 64\nseed = 3")))
    assert len(plan.points) == cases
    friction = np.array([point[0] for point in plan.points])
    force = np.log([point[1] for point in plan.points])
    for values, low, high in ((friction, 0.1, 0.5), (force, math.log(1e3), math.log(1e5))):
        parts = np.floor((values - low) / (high - low) * 64)
        assert sorted(parts) == list(range(64))
    assert load_plan(sweep_file(tmp_path, design(name, "samples = 64\nseed = 3"))) == plan
    other = load_plan(sweep_file(tmp_path, design(name, "samples = 64\nseed = 4")))
    assert other.points != plan.points


def test_ids_are_of_contents(tmp_path: Path) -> None:
    """Sweeps share the ids of cases that they have in common, whatever the order of keys; another
    scene, or other content of a file that it names, has none in common."""

    def ids(text: str, scene: str = PATCH) -> set[str]:
        return set(load_plan(sweep_file(tmp_path, text, scene)).ids())

    one = '[[vary]]\nkey = "friction.coefficient"\nvalues = [{}]\n'
    two = '[[vary]]\nkey = "load.normal_force"\nvalues = [1e3, 1e4]\n'
    head = '[sweep]\nscene = "scene.toml"\n'
    small, large = head + one.format("0.2, 0.3") + two, head + two + one.format("0.1, 0.2, 0.3")
    assert len(ids(small)) == 4
    assert ids(small) < ids(large)
    assert not ids(small) & ids(small, PATCH.replace("2.0, 1.5", "2.0, 1.6"))
    gap = PATCH.replace("curvatures = [2.0, 1.5]", 'undeformed_distance = "gap.csv"')
    (tmp_path / "gap.csv").write_text("1\n", encoding="utf-8")
    before = ids(small, gap)
    assert before == ids(small, gap)
    (tmp_path / "gap.csv").write_text("2\n", encoding="utf-8")
    assert not before & ids(small, gap)


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("[sweep]\n", "sweep.scene: value is missing"),
        ('[sweep]\nscene = "scene.toml"\n', "vary: value is None, allowed [[vary]] tables"),
        ("[swep]\n", "swep: is no table of a sweep"),
        (design("sobol"), "sweep.samples: value is None, allowed with the designs"),
        (design("sobol", "samples = 100"), "allowed a power of 2 with the design sobol"),
        (design("grid", "samples = 8"), "sweep.samples: value is 8, allowed with the designs"),
        (design("grid"), "vary.count: value is missing of friction.coefficient"),
        (design("radnom"), "sweep.design: value is 'radnom', allowed"),
        (
            design("morris", "samples = 4").replace("low = 0.1", "low = 0.1\ncount = 3"),
            "vary.count: value is 3 of friction.coefficient, allowed to be left out",
        ),
        (
            design("sobol", "samples = 4").replace("low = 1e3", "low = 0.0"),
            "low: value is 0.0, allowed > 0 where the range is logarithmic",
        ),
        (
            design("sobol", "samples = 4").replace("load.normal_force", "friction.coefficient"),
            "vary.key: value is 'friction.coefficient' twice",
        ),
        (
            design("sobol", "samples = 4").replace("load.normal_force", "load.normal_force[2]"),
            "the scene has no list with a number 2",
        ),
        (
            design("sobol", "samples = 4").replace("load.normal_force", "load..force"),
            "vary.key: value is 'load..force', allowed names with dots",
        ),
    ],
)
def test_wrong_sweeps_are_refused(tmp_path: Path, text: str, told: str) -> None:
    """With key, value and what is allowed."""
    with pytest.raises(CaseError) as error:
        load_plan(sweep_file(tmp_path, text))
    assert told in str(error.value)


@pytest.mark.parametrize(
    ("text", "kind"),
    [
        (PATCH, "a contact case, without [sweep]"),
        ("[vehicle]\n[run]\n", "a scene of railpatch vehicle"),
    ],
)
def test_a_scene_is_no_sweep(tmp_path: Path, text: str, kind: str) -> None:
    """Said in one line, in place of all its tables."""
    path = tmp_path / "wheel.toml"
    path.write_text(text, encoding="utf-8")
    with pytest.raises(CaseError) as error:
        load_plan(path)
    hint = 'a sweep names its scene: [sweep] scene = "wheel.toml", and [[vary]] its keys'
    assert str(error.value) == f"{path}: this is {kind}, allowed one of railpatch sweep; {hint}"


def test_values_go_where_the_key_says() -> None:
    """Through tables and lists; tables that are absent are made, lists are not."""
    content = {"a": {"b": [1, [2, 3]]}, "c": 1}
    put(content, "a.b[1][0]", 9)
    put(content, "d.e", "x")
    assert content == {"a": {"b": [1, [9, 3]]}, "c": 1, "d": {"e": "x"}}
    for key in ("c.x", "a.z[0]", "a.b[2]"):
        with pytest.raises(CaseError, match=r"vary\.key"):
            put(content, key, 0)
