"""solve() and step() give the same numbers; a restored state steps to the same bits."""

from __future__ import annotations

import json
import math
import struct
import threading
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import railpatch
from case_samples import PATCH, WHEELSET, with_values
from railpatch.case import load_scene

# N, force of the whole wheelset: 10 kN a wheel as in the Manchester benchmark
LOADED = with_values(WHEELSET, wheelset__z=None, wheelset__vertical_force=2e4)
ROLLING = with_values(WHEELSET, wheelset__z=2.2e-4)
# results that depend on time or on the start of the iteration
VARYING = ("wall_time", "iterations", "residual")


def numbers(value: Any, path: str = "") -> dict[str, float]:
    """Every number of a result by its path."""
    if isinstance(value, dict):
        parts = [(f"{path}.{key}", value[key]) for key in value if key not in VARYING]
    elif isinstance(value, list):
        parts = [(f"{path}[{i}]", item) for i, item in enumerate(value)]
    else:
        is_number = isinstance(value, int | float) and not isinstance(value, bool)
        return {path: value} if is_number else {}
    return {key: number for name, part in parts for key, number in numbers(part, name).items()}


def assert_same(one: railpatch.Result, two: railpatch.Result, scale: float, rel: float) -> None:
    """Equal forces within rel of scale, N."""
    first, second = numbers(one.to_dict()), numbers(two.to_dict())
    assert first.keys() == second.keys()
    assert one.status == two.status == "converged"
    forces = [key for key in first if "force" in key]
    assert forces
    for key in forces:
        assert first[key] == pytest.approx(second[key], abs=rel * scale), key


@pytest.mark.parametrize("geometry", [{"semi_axes": [6e-3, 6e-3]}, {"curvatures": [0.5, 1.0]}])
@pytest.mark.parametrize("tangential", ["none", *railpatch._core.THEORIES, "full"])
def test_step_equals_solve_of_the_changed_case(geometry: dict[str, Any], tangential: str) -> None:
    case = with_values(PATCH, geometry=geometry, method__tangential=tangential)
    if tangential == "none":
        case = with_values(case, friction=None)
    if tangential == "linear":  # it holds below saturation only
        case = with_values(case, friction__coefficient=10.0)
    contact = railpatch.Contact(case)
    contact.step()
    stepped = contact.step(creepage=[2e-3, -5e-4], spin_creepage=0.4, normal_force=6e4)
    changed = with_values(
        case,
        motion__creepage=[2e-3, -5e-4],
        motion__spin_creepage=0.4,
        load__normal_force=6e4,
    )
    # tolerance 1e-5 of the solvers, warm against cold
    assert_same(stepped, railpatch.solve(changed), 6e4, 1e-4)


def test_step_with_approach() -> None:
    case = with_values(PATCH, geometry={"curvatures": [1.0, 1.0]}, load={"approach": 5e-5})
    contact = railpatch.Contact(case)
    contact.step()
    stepped = contact.step(approach=8e-5)
    solved = railpatch.solve(with_values(case, load={"approach": 8e-5}))
    assert_same(stepped, solved, solved["normal_force"], 1e-4)


@pytest.mark.parametrize("case", [LOADED, ROLLING])
def test_step_of_a_wheelset_equals_solve(case: dict[str, Any]) -> None:
    contact = railpatch.Contact(case)
    contact.step()
    stepped = contact.step(y=1e-3, yaw=1e-3, left={"offset": [0, 0, 2e-5]})
    changed = with_values(
        case, wheelset__y=1e-3, wheelset__yaw=1e-3, wheelset__left={"offset": [0, 0, 2e-5]}
    )
    assert_same(stepped, railpatch.solve(changed), 2e4, 1e-4)


@pytest.mark.parametrize("case", [PATCH, LOADED])
@pytest.mark.parametrize("derivatives", [True, False])
def test_the_last_result_once_more(case: dict[str, Any], derivatives: bool) -> None:
    """With fields, without a solve, also after derivatives were asked for."""
    contact = railpatch.Contact(with_values(case, method={"derivatives": derivatives}))
    with pytest.raises(railpatch.CaseError, match=r"last: there is no step, allowed after step"):
        contact.last()
    stepped = contact.step(fields=True).to_dict()
    if derivatives:
        contact.differentiate()
    assert contact.last(fields=True).to_dict() == stepped
    assert contact.last().to_dict() == contact.last().to_dict()
    contact.restore(contact.save())
    with pytest.raises(railpatch.CaseError, match="last"):
        contact.last()


def test_one_wheel_equals_its_half_of_the_wheelset() -> None:
    both = railpatch.solve(ROLLING).to_dict()
    for side in ("left", "right"):
        one = railpatch.solve({**ROLLING, "kind": "wheel_rail", "wheel": {"side": side}}).to_dict()
        for key in ("force", "moment", "patches", "z", "status"):
            assert one[key] == both[side][key], key
    total = np.array(both["left"]["force"]) + both["right"]["force"]
    np.testing.assert_allclose(both["force"], total, rtol=1e-12)


def test_left_is_the_mirror_image_of_right() -> None:
    """physics.md, section 1: mirrored position, mirrored result, to the last bit."""
    one = railpatch.solve(with_values(ROLLING, wheelset__y=5e-4, wheelset__yaw=1e-3))
    two = railpatch.solve(with_values(ROLLING, wheelset__y=-5e-4, wheelset__yaw=-1e-3))
    for side, other in (("left", "right"), ("right", "left")):
        x, y, z = one[side]["force"]
        assert [x, -y, z] == two[other]["force"]
        mx, my, mz = one[side]["moment"]
        assert [-mx, my, -mz] == two[other]["moment"]
        assert one[side]["patches"][0]["elements"] == two[other]["patches"][0]["elements"]


@pytest.mark.parametrize(
    ("case", "before", "after"),
    [
        (PATCH, {"creepage": [2e-3, 0.0]}, {"creepage": [2e-3, 1e-3]}),
        (LOADED, {"y": 1e-3}, {"yaw": 1e-3}),
    ],
)
def test_a_restored_state_steps_to_the_same_bits(
    case: dict[str, Any], before: dict[str, Any], after: dict[str, Any]
) -> None:
    contact = railpatch.Contact(case)
    contact.step(**before)
    state = contact.save()
    expected = contact.step(**after, fields=True).to_dict()
    contact.restore(state)
    again = contact.step(**after, fields=True).to_dict()
    other = railpatch.Contact(case)
    other.restore(state)
    fresh = other.step(**after, fields=True).to_dict()
    for result in (expected, again, fresh):
        result.pop("wall_time")
    assert again == expected
    assert fresh == expected


def test_reset_is_a_cold_start() -> None:
    contact = railpatch.Contact(PATCH)
    first = contact.step().to_dict()
    contact.step(creepage=[3e-3, 0.0])
    contact.reset()
    again = contact.step(creepage=[1e-3, 0.0]).to_dict()
    assert {**again, "wall_time": 0} == {**first, "wall_time": 0}


def test_wrong_states_are_refused_and_change_nothing() -> None:
    contact = railpatch.Contact(PATCH)
    contact.step()
    state = contact.save()
    wheel = railpatch.Contact(ROLLING).save()
    damaged = state[:-9] + bytes([state[-9] ^ 1]) + state[-8:]
    expected = contact.step(creepage=[2e-3, 0.0]).to_dict()
    contact.restore(state)
    # every byte of head and tables counts: 10 of the mark, 8 of the head
    (size,) = struct.unpack("<I", state[10:14])
    turned = [state[:i] + bytes([state[i] ^ 1]) + state[i + 1 :] for i in range(18 + size)]
    for wrong in (b"", b"railpatch2", state[:-1], state[:40], damaged, wheel, None, 5, *turned):
        with pytest.raises(railpatch.CaseError):
            contact.restore(wrong)
    again = contact.step(creepage=[2e-3, 0.0]).to_dict()
    assert {**again, "wall_time": 0} == {**expected, "wall_time": 0}


def test_a_refused_change_leaves_the_inputs() -> None:
    contact = railpatch.Contact(PATCH)
    before = contact.case
    with pytest.raises(railpatch.CaseError, match=r"motion\.creepage\[0\]: value is nan"):
        contact.step(normal_force=5e4, creepage=[math.nan, 0.0])
    assert contact.case == before
    contact.step(normal_force=5e4)
    assert contact.case == load_scene(with_values(PATCH, load__normal_force=5e4)).case


WATER = {"model": "film", "roughness": 1e-6, "liquid": "water", "temperature": 20.0}
GAP = [[1e-9 * (i - 5) ** 2 + 1e-9 * (j - 5) ** 2 for i in range(11)] for j in range(11)]
NOTHING: dict[str, dict[str, Any]] = {
    "creepage": PATCH,
    "water_rate": with_values(PATCH, fluid={**WATER, "water_rate": 1e-9}),
    "oil_film": with_values(PATCH, fluid={**WATER, "oil_film": 1e-7}),
    "water_temperature": with_values(PATCH, fluid=WATER),
    "slip_field": with_values(
        PATCH,
        geometry={"undeformed_distance": GAP},
        grid={"element_size": [1e-5, 1e-5]},
        load={"normal_force": 1e-2},
        motion__slip_field=[[[0.0] * 11] * 11] * 2,
    ),
    "y": LOADED,
    "axle_torque": with_values(LOADED, wheelset__pitch_rate="free", wheelset__axle_torque=10.0),
    "roller_pitch_rate": with_values(
        LOADED,
        track={"kind": "roller", "roller_radius": 1.0, "roller_pitch_rate": 2.0},
        wheelset__speed=0.0,
    ),
}


@pytest.mark.parametrize("key", NOTHING)
def test_a_step_leaves_nothing_out(key: str) -> None:
    """Before the first step and in steps that go on; what was there stays."""
    contact = railpatch.Contact(NOTHING[key])
    for _ in range(2):
        with pytest.raises(railpatch.CaseError, match=f"{key}.*value is None"):
            contact.step(**{key: None})
        contact.step()
    assert contact.case == load_scene(NOTHING[key]).case


def test_fields_add_up_to_the_resultants() -> None:
    result = railpatch.solve(with_values(PATCH, motion__spin_creepage=0.3), fields=True)
    x, y, p, t = (result[key] for key in ("x", "y", "pressure", "traction"))
    assert p.shape == (y.size, x.size)
    assert t.shape == (2, y.size, x.size)
    area = (x[1] - x[0]) * (y[1] - y[0])
    assert p.sum() * area == pytest.approx(1e5, rel=1e-12)
    np.testing.assert_allclose(t.sum(axis=(1, 2)) * area, result["creep_force"], atol=1e-7)
    moment = (x * t[1]).sum() - (y[:, None] * t[0]).sum()
    assert moment * area == pytest.approx(result["spin_moment"], abs=1e-9)
    division = result["element_division"]
    counts = [int((division == state).sum()) for state in range(4)]
    assert counts == list(result["elements"].values())
    bound = 0.3 * p
    assert (np.hypot(*t) <= bound * (1 + 1e-12)).all()


def test_hertz_pressure_and_full_sliding() -> None:
    """Peak 3 F / (2 pi a b) of Hertz; Coulomb's force at full sliding."""
    case = with_values(PATCH, method__normal="hertz", motion__creepage=[0.2, 0.0])
    result = railpatch.solve(case)
    peak = 1.5 * 1e5 / (math.pi * 0.006**2)
    assert result["max_pressure"] == pytest.approx(peak, rel=1e-9)
    assert result["creep_force"][0] == pytest.approx(-0.3e5, rel=1e-3)
    assert result["elements"]["stick"] == 0
    # power = force times slip speed; creepage 0.2 at 10 m/s
    assert result["friction_power"] == pytest.approx(0.3e5 * 2.0, rel=1e-2)


def test_what_is_left_out_is_null() -> None:
    result = railpatch.solve(with_values(PATCH, motion=None, friction=None), fields=True)
    content = result.to_dict()
    for key in ("creep_force", "spin_moment", "friction_power", "max_temperature"):
        assert content[key] is None, key
    assert content["traction"] is None
    assert content["temperature"] is None
    assert content["elements"]["stick"] is None
    assert "tangential" not in content["stages"]
    assert json.loads(json.dumps(content, allow_nan=False)) == content


def test_cant_turns_the_uncanted_rail() -> None:
    """[track] cant on "UIC60" is the built-in "UIC60@1:40"."""
    built_in = railpatch.solve(with_values(LOADED, wheelset__y=2e-3))
    canted = railpatch.solve(
        with_values(LOADED, wheelset__y=2e-3, profiles__rail="UIC60", track__cant=math.atan(1 / 40))
    )
    assert canted["z"] == pytest.approx(built_in["z"], abs=1e-10)
    assert_same(canted, built_in, 2e4, 1e-6)


def test_no_contact_is_a_result() -> None:
    case = with_values(PATCH, geometry={"curvatures": [1.0, 1.0]}, load={"approach": -1e-5})
    result = railpatch.solve(case, fields=True)
    assert result.status == "no_contact"
    assert result.good
    assert result["normal_force"] == 0.0
    assert result["contact_area"] == 0.0
    lifted = railpatch.solve(with_values(ROLLING, wheelset__z=-1e-3))
    assert lifted.status == "no_contact"
    assert lifted["force"] == [0.0, 0.0, 0.0]
    assert lifted["left"]["patches"] == []


@pytest.mark.parametrize("approach", [5e-324, 1e-162])
def test_an_approach_of_no_size_is_no_contact(approach: float) -> None:
    case = with_values(PATCH, geometry={"curvatures": [1.0, 1.0]}, load={"approach": approach})
    assert railpatch.solve(case).status == "no_contact"


def test_undeformed_distance_equals_curvatures(tmp_path: Path) -> None:
    """The same paraboloid as formula and as file."""
    size, count = 5e-4, 40
    axis = (np.arange(count) - (count - 1) / 2) * size
    gap = axis[None, :] ** 2 + 2 * axis[:, None] ** 2
    np.savetxt(tmp_path / "gap.csv", gap, delimiter=",", fmt="%.17g")
    grid = {"element_size": [size, size]}
    file = with_values(PATCH, geometry={"undeformed_distance": "gap.csv"}, grid=grid)
    formula = with_values(PATCH, geometry={"curvatures": [1.0, 2.0]}, grid=grid)
    one = railpatch.solve(file, folder=tmp_path)
    two = railpatch.solve(formula)
    for key in ("approach", "max_pressure"):
        assert one[key] == pytest.approx(two[key], rel=1e-2), key
    assert one["creep_force"][0] == pytest.approx(two["creep_force"][0], rel=2e-2)


def test_threads_with_handles_of_their_own() -> None:
    """The interpreter's lock is released in a step; results do not depend on it."""
    expected = railpatch.Contact(PATCH).step(creepage=[2e-3, 0.0])["creep_force"]
    found: list[Any] = []

    def run() -> None:
        contact = railpatch.Contact(PATCH)
        for _ in range(3):
            contact.reset()
            found.append(contact.step(creepage=[2e-3, 0.0])["creep_force"])

    threads = [threading.Thread(target=run) for _ in range(3)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert found == [expected] * 9


def test_stages_tell_reason_memory_and_time() -> None:
    contact = railpatch.Contact(
        with_values(PATCH, method__tangential="none", friction=None), timing=True
    )
    contact.step()
    stages = {stage["name"]: stage for stage in contact.stages()}
    assert list(stages) == [
        "geometry",
        "influence",
        "normal",
        "tangential",
        "temperature",
        "forces",
        "coupling",
        "history",
        "plasticity",
        "derivatives",
        "rail_support",
        "fluid",
    ]
    assert stages["normal"]["seconds"] > 0
    assert stages["normal"]["bytes"] > 0
    assert not stages["tangential"]["present"]
    assert stages["tangential"]["bytes"] == 0
    assert stages["tangential"]["seconds"] == 0
    assert all(stage["reason"] for stage in stages.values())
