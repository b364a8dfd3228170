"""Wheelsets in balance: roll = "balanced", pitch_rate = "free"."""

from __future__ import annotations

import json
import math
import re
import zipfile
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from case_samples import WHEELSET, with_values
from click.testing import CliRunner
from railpatch import CaseError, Contact, Result, solve
from railpatch.case import load_scene
from railpatch.command.cli import cli
from railpatch.fmu import pack_fmu
from railpatch.pinocchio.element import check_case

from rig_model.balance import Balancer
from rig_model.scene import NOMINAL, load_rig_scene, scenes

SIDES = ("left", "right")
LOAD, HALF_GAUGE, RADIUS = 1.2e5, 0.7175, 0.46
CASE = with_values(
    WHEELSET,
    wheelset__y=3e-3,
    wheelset__z=None,
    wheelset__vertical_force=LOAD,
    wheelset__speed=20.0,
    wheelset__roll="balanced",
    wheelset__pitch_rate="free",
    grid={"element_size": [1.6e-3, 1.6e-3]},
)
FAST = {"method": {"normal": "hertz", "tangential": "fastsim"}}
ROLLER = {
    "track__kind": "roller",
    "track__roller_radius": 0.8,
    "track__roller_pitch_rate": 25.0,
    "wheelset__speed": None,
}
FEATURES: dict[str, dict[str, Any]] = {
    "full theory, exact slopes": {},
    "fastsim": FAST,
    "yaw and curve": {**FAST, "wheelset__yaw": 4e-3, "track__curvature": 1 / 600},
    "roller": {**ROLLER, "method": {"tangential": "polach"}},
    "roller, inclined": {**ROLLER, "wheelset__yaw": 4e-3, "method__contact_frame": "inclined"},
    "flange": {"profiles__rail": "UIC60@1:20", "wheelset__y": 5.8e-3},
    "rails on springs": {
        **FAST,
        "track__rail_support": {"stiffness": [2e7, 5e7], "damping": [1e4, 1e4]},
        "wheelset__time_step": 1e-3,
    },
    "steps that follow each other": {
        "motion": {"regime": "transient_rolling"},
        "wheelset__time_step": 5e-5,
    },
    "bodies that store heat": {
        "temperature": {
            "wheel": 40.0,
            "rail": 20.0,
            "bulk": {"mass": [300.0, 0.0], "air_conductance": [10.0, 0.0]},
        },
        "wheelset__time_step": 10.0,
    },
}


def moments(result: Result, yaw: float) -> tuple[float, float]:
    """Roll moment over load and half the gauge, axle's torque over load and radius."""
    c, s, d, t = math.cos(result["roll"]), math.sin(result["roll"]), math.cos(yaw), math.sin(yaw)
    turned = np.array([[1, 0, 0], [0, c, -s], [0, s, c]]) @ [[d, -t, 0], [t, d, 0], [0, 0, 1]]
    moment = np.array(result["left"]["moment"]) + result["right"]["moment"]
    torque = moment @ turned @ [0, 1, 0]
    assert result["axle_torque"] == pytest.approx(torque, abs=1e-9 * LOAD)
    return moment[0] / LOAD / HALF_GAUGE, torque / LOAD / RADIUS


@pytest.mark.parametrize("name", FEATURES)
def test_nothing_turns_the_wheelset(name: str) -> None:
    """Of each step, also where the next one depends on it; the same state given has its forces."""
    case = with_values(CASE, **FEATURES[name])
    given = with_values(case, wheelset__roll=0.0, wheelset__pitch_rate=0.0)
    balanced, prescribed = Contact(case), Contact(given)
    for y in (case["wheelset"]["y"], case["wheelset"]["y"] - 4e-4):
        result = balanced.step(y=y)
        assert result.status == "converged"
        assert np.abs(moments(result, case["wheelset"].get("yaw", 0.0))).max() < 1e-6
        found = {key: result[key] for key in ("roll", "pitch_rate")}
        same = prescribed.step(y=y, **found)
        for side in ("left", "right"):
            # the searches for z differ by the tolerance, 1e-5 of the load
            np.testing.assert_allclose(same[side]["force"], result[side]["force"], atol=3e-5 * LOAD)


def test_by_the_rule_of_contact_the_forces_along_the_axle_count() -> None:
    method = {**FAST["method"], "patch_rule": "contact"}
    case = with_values(CASE, **ROLLER, method=method, wheelset__yaw=4e-3)
    result = solve(case)
    torque = sum(
        (math.cos(4e-3) * side["force"][0] + math.sin(4e-3) * side["force"][1])
        * side["rolling_radius"]
        for side in (result["left"], result["right"])
    )
    assert result["axle_torque"] == pytest.approx(torque, abs=1e-9 * LOAD)
    assert abs(torque) < 1e-6 * LOAD * RADIUS


def test_both_wheels_carry_where_one_did() -> None:
    """3 mm beside the middle; without friction and beside the inclined contacts half the load."""
    case = with_values(CASE, friction=None, method={"tangential": "none"})
    case["wheelset"]["pitch_rate"] = 0.0
    alone, balanced = (
        [-solve(with_values(case, wheelset__roll=roll))[side]["force"][2] / LOAD for side in SIDES]
        for roll in (0.0, "balanced")
    )
    assert max(alone) > 0.99
    assert balanced == pytest.approx([0.5, 0.5], abs=0.03)


def test_a_wheelset_in_the_middle_does_not_roll() -> None:
    result = solve(with_values(CASE, wheelset__y=0.0))
    assert result["roll"] == 0.0
    assert result["left"]["force"][2] == result["right"]["force"][2]


def test_z_may_be_given() -> None:
    result = solve(with_values(CASE, wheelset__vertical_force=None, wheelset__z=2.5e-4, **FAST))
    assert result["z"] == 2.5e-4
    carried = -result["force"][2]
    assert abs(result["moment"][0]) < 1e-6 * carried * HALF_GAUGE
    assert abs(result["axle_torque"]) < 1e-6 * carried * RADIUS
    above = solve(with_values(CASE, wheelset__vertical_force=None, wheelset__z=-0.02, **FAST))
    assert above.status == "no_contact"


def test_is_the_balance_of_the_rig() -> None:
    """Found by another search, over z, roll and pitch rate at once."""
    tolerance = {"method": "newton", "tolerance": 2e-5, "axle_torque": "wheelset"}
    changes = {f"balance.{key}": value for key, value in tolerance.items()}
    scene = load_rig_scene(scenes() / NOMINAL, {**changes, "positions": 3})
    position = scene.positions()[1]
    rig = Balancer(scene).solve(position)
    assert rig.converged
    found = {"y": position.y, "yaw": position.yaw, "roll": "balanced", "pitch_rate": "free"}
    content = scene.case.model_dump(exclude_none=True)
    result = solve({**content, "wheelset": {**content["wheelset"], **found}})
    assert result.status == "converged"
    # 2e-5 of the load over the rig's stiffness: 1.5/(0.1 mm/0.75 m) of it by roll, 35 by creepage
    assert result["roll"] == pytest.approx(rig.roll, abs=1e-8)
    assert result["pitch_rate"] == pytest.approx(rig.pitch_rate, abs=2e-5)
    assert result["z"] == pytest.approx(rig.z, abs=1e-8)


@pytest.mark.parametrize("method", [{"normal": "hertz"}, {"normal": "hertz", **FAST["method"]}])
def test_derivatives_follow_the_balance(method: dict[str, Any]) -> None:
    """Total ones: roll and pitch rate move with what is given, and moments stay zero."""
    case = with_values(CASE, method={**method, "derivatives": True}, grid={"elements": [12, 12]})
    contact = Contact(case)
    contact.step()
    fine = with_values(case, method={**method, "tolerance": 1e-9})
    for name, at, length in (("y", 3e-3, 1e-6), ("vertical_force", LOAD, 10.0)):
        rates = contact.differentiate(**{name: 1.0})
        assert rates["kind"] == ("differences" if "tangential" in method else "exact")
        ends = [Contact(fine).step(**{name: at + end * length}) for end in (-1, 1)]
        for key in ("roll", "pitch_rate", "z"):
            expected = (ends[1][key] - ends[0][key]) / (2 * length)
            assert rates[key] == pytest.approx(expected, rel=5e-3), (name, key)
        forces = [np.array(end["left"]["force"]) for end in ends]
        expected = (forces[1] - forces[0]) / (2 * length)
        np.testing.assert_allclose(
            rates["left"]["force"], expected, atol=5e-3 * np.abs(expected).max()
        )
        # of what moves by the load within a step of a micrometre or of ten newtons
        small = 1e-6 * LOAD / length if rates["kind"] == "differences" else 1e-6
        assert abs(rates["moment"][0]) < small
        assert abs(rates["axle_torque"]) < small


def test_saved_states_give_the_same_bits() -> None:
    case = with_values(CASE, **FAST)
    first, other = Contact(case), Contact(case)
    first.step()
    other.restore(first.save())
    a, b = (contact.step(y=2e-3).to_dict() for contact in (first, other))
    assert {**a, "wall_time": 0} == {**b, "wall_time": 0}


def test_no_balance_is_said(tmp_path: Path) -> None:
    """On the flange no roll angle takes the moment of the flange's force from the wheelset."""
    case = with_values(CASE, **FAST, wheelset__y=8.5e-3)
    path = tmp_path / "case.toml"
    path.write_text(toml(case))
    ended = CliRunner().invoke(cli, ["solve", str(path), "--json"])
    assert ended.exit_code == 3
    assert json.loads(ended.stdout)["status"] in ("not_converged", "out_of_range")
    with pytest.raises(CaseError, match="scene: the balance of the wheelset is not found"):
        pack_fmu(load_scene(case), tmp_path / "x.fmu")


def toml(case: dict[str, Any]) -> str:
    """Of a case of tables with numbers, texts and lists."""
    tops = [f"{key} = {json.dumps(v)}" for key, v in case.items() if not isinstance(v, dict)]
    for name, table in case.items():
        if isinstance(table, dict):
            tops += [f"[{name}]", *(f"{key} = {json.dumps(v)}" for key, v in table.items())]
    return "\n".join(tops)


def test_command_shows_what_was_found(tmp_path: Path) -> None:
    path = tmp_path / "case.toml"
    path.write_text(toml(with_values(CASE, **FAST)))
    ended = CliRunner().invoke(cli, ["solve", str(path)])
    assert ended.exit_code == 0
    rows = {line.split()[0] for line in ended.stdout.splitlines() if line.strip()}
    assert {"z", "roll", "pitch_rate", "axle_torque"} <= rows


def test_fmu_starts_in_balance(tmp_path: Path) -> None:
    case = with_values(CASE, **FAST)
    path = pack_fmu(load_scene(case), tmp_path / "x.fmu")
    with zipfile.ZipFile(path) as archive:
        text = archive.read("modelDescription.xml").decode()
    found = solve(case)
    for key in ("roll", "pitch_rate"):
        variable = re.search(rf'name="wheelset.{key}".*?start="([^"]*)"', text, re.DOTALL)
        assert variable is not None
        assert float(variable[1]) == found[key]


REFUSED: list[tuple[Callable[[], Any], str]] = [
    (lambda: Contact(with_values(CASE, wheelset__roll="free")), r"roll: .*a number or 'balanced'"),
    (lambda: Contact(with_values(CASE, kind="wheel_rail")), "'wheel_rail'"),
    (
        lambda: Contact(with_values(CASE, friction=None, method={"tangential": "none"})),
        r"wheelset.pitch_rate: value is 'free', allowed a number with method.tangential",
    ),
    (lambda: Contact(CASE).step(roll=1e-4), "roll: .* is no moving input"),
    (lambda: Contact(CASE).differentiate(pitch_rate=1.0), "derivatives"),
    (
        lambda: Contact(with_values(CASE, wheelset__roll=0.0)).step(roll="balanced"),
        r"wheelset.roll: value is 'balanced', allowed a number: whether it is found",
    ),
    (
        lambda: Contact(with_values(CASE, method={"derivatives": True})).jacobian(),
        r"wheelset.roll: value is 'balanced', allowed a number for jacobian",
    ),
    (
        lambda: check_case(load_scene(CASE).case),
        r"wheelset.roll: value is 'balanced', allowed a number: the model gives",
    ),
]


@pytest.mark.parametrize(("call", "text"), REFUSED)
def test_what_does_not_go_is_named(call: Callable[[], Any], text: str) -> None:
    with pytest.raises(CaseError, match=text):
        call()
