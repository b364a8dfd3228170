"""What masters use: inputs that move in a step, sub-steps, means over a step, power and sums."""

from __future__ import annotations

import math
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import railpatch
from case_samples import with_values
from fmpy.validation import validate_fmu
from fmu_scenes import RAIL, SCENES, STEP, Packer
from railpatch.errors import CaseError
from scipy.integrate import trapezoid
from slave import DISCARD, ERROR, OK, Fmu, Slave

Unpack = Callable[..., Fmu]
POWER_MOTION = {
    "wheelset.y": 2e-4,
    "wheelset.roll": 2e-5,
    "wheelset.yaw": 2e-3,
    "wheelset.vy": 0.02,
    "wheelset.vz": 0.01,
    "wheelset.roll_rate": 0.02,
    "wheelset.yaw_rate": 0.03,
}


@pytest.fixture(scope="module")
def averaged(tmp_path_factory: pytest.TempPathFactory) -> Callable[[str], Fmu]:
    """FMUs that also give means over a step."""
    scenes = {name: SCENES[name] for name in ("rail", "transient")}
    asked = {name: {"averages": True} for name in scenes}
    return Packer(tmp_path_factory.mktemp("averaged"), scenes, **asked)


def test_inputs_move_by_their_derivatives(unpacked: Unpack) -> None:
    """Outputs at the end of a step are those of the inputs there, held from then on."""
    fmu = unpacked("rail")
    first, second, third = 0.05, 30.0, 4e3
    end = first * STEP + second * STEP**2 / 2 + third * STEP**3 / 6
    with Slave(fmu).initialize() as slave, Slave(fmu).initialize() as held:
        for order, value in enumerate((first, second, third), 1):
            assert slave.set_derivatives({"wheelset.y": value}, order) == OK
        assert held.set({"wheelset.y": end}) == OK
        for k in range(2):
            assert slave.step(k * STEP, STEP) == OK, slave.log
            assert held.step(k * STEP, STEP) == OK
            assert slave.get("wheelset.y")[0] == pytest.approx(end, rel=1e-14)
            wanted = held.outputs()
            for name, value in slave.outputs().items():
                if "iterations" not in name and "residual" not in name:
                    assert value == pytest.approx(wanted[name], rel=1e-6, abs=1e-9), name


def test_derivatives_are_part_of_the_state(unpacked: Unpack) -> None:
    with Slave(unpacked("rail")).initialize() as slave:
        assert slave.set_derivatives({"wheelset.y": 0.1}) == OK
        state = slave.save()
        assert slave.step(0, STEP) == OK
        moved = slave.outputs()
        assert slave.restore(state) == OK
        assert slave.step(0, STEP) == OK
        assert slave.outputs() == moved


def test_wrong_derivatives_of_inputs_are_refused(unpacked: Unpack) -> None:
    with Slave(unpacked("rail")).initialize() as slave:
        assert slave.set_derivatives({"wheelset.y": 1.0}, order=0) == ERROR
        assert slave.set_derivatives({"wheelset.y": 1.0}, order=4) == ERROR
        assert slave.set_derivatives({"wheelset.y": math.nan}) == ERROR
        assert slave.set_derivatives({"force[1]": 1.0}) == ERROR
        assert slave.set_derivatives({"friction.coefficient": 1.0}) == ERROR
        assert len(slave.log) == 5
        slave.log.clear()
        assert slave.set_derivatives({"wheelset.y": 1e4}) == OK
        assert slave.step(0, STEP) == DISCARD
        [(_, _, text)] = slave.log
        assert "wheelset.y" in text
        assert "smaller step" in text


@pytest.mark.parametrize("name", ["transient", "supported"])
def test_sub_steps_are_steps_of_the_contact(name: str, unpacked: Unpack) -> None:
    """One step of four sub-steps is four steps of a quarter each, with the same inputs."""
    fmu, rate, count = unpacked(name), 0.1, 4
    with Slave(fmu).initialize() as slave, Slave(fmu).initialize() as single:
        assert slave.set({"substeps": count}) == OK
        assert slave.set_derivatives({"wheelset.y": rate}) == OK
        assert slave.step(0, STEP) == OK, slave.log
        for k in range(count):
            assert single.set({"wheelset.y": rate * STEP * (k + 1) / count}) == OK
            assert single.step(k * STEP / count, STEP / count) == OK
        wanted = single.outputs()
        for key, value in slave.outputs().items():
            if "iterations" not in key and "residual" not in key:
                assert value == pytest.approx(wanted[key], rel=1e-9, abs=1e-12), key
    with Slave(fmu).initialize() as slave:
        assert slave.set({"wheelset.y": 1e-4}) == OK
        assert slave.step(0, STEP) == OK
        assert slave.outputs() != wanted
        assert slave.set({"substeps": 0}) == ERROR


def test_substeps_and_means_are_only_where_they_matter(unpacked: Unpack) -> None:
    assert "substeps" not in unpacked("rail").variables
    assert "mean_force[1]" not in unpacked("rail").variables
    assert "substeps" in unpacked("transient").variables


def test_means_over_a_step(averaged: Callable[[str], Fmu]) -> None:
    """The trapezoidal rule over points solved one by one."""
    fmu, count, rate = averaged("rail"), 5, {"wheelset.y": 0.2, "wheelset.z": 0.02}
    names = ["force[2]", "force[3]", "left.force[3]", "right.moment[3]"]
    means = ["mean_force[2]", "mean_force[3]", "left.mean_force[3]", "right.mean_moment[3]"]
    start = {n: float(fmu.variables[n][0].attrib["start"]) for n in rate}
    contact = railpatch.Contact(SCENES["rail"])
    rows = []
    for k in range(count + 1):
        moved = {n: start[n] + rate[n] * STEP * k / count for n in rate}
        result = contact.step(y=moved["wheelset.y"], z=moved["wheelset.z"])
        rows.append(
            [
                result["force"][1],
                result["force"][2],
                result["left"]["force"][2],
                result["right"]["moment"][2],
            ]
        )
    wanted = trapezoid(rows, axis=0)
    with Slave(fmu).initialize() as slave:
        assert slave.get(*means) == slave.get(*names)
        assert slave.set({"substeps": count}) == OK
        assert slave.set_derivatives(rate) == OK
        assert slave.step(0, STEP) == OK
        assert slave.get(*means) == pytest.approx(wanted / count, rel=1e-4, abs=1e-2)
        # held: that of the end, at once
        assert slave.step(STEP, STEP) == OK
        assert slave.get(*means) == slave.get(*names)
        assert slave.derivative(["mean_force[2]"], {"wheelset.y": 1.0})[0] == ERROR


def test_means_of_held_inputs_in_a_scene_with_history(averaged: Callable[[str], Fmu]) -> None:
    fmu, count = averaged("transient"), 4
    with Slave(fmu).initialize() as slave, Slave(fmu).initialize() as single:
        assert slave.set({"substeps": count, "wheelset.vy": 0.01}) == OK
        assert single.set({"wheelset.vy": 0.01}) == OK
        assert slave.step(0, STEP) == OK
        forces = []
        for k in range(count):
            assert single.step(k * STEP / count, STEP / count) == OK
            forces += single.get("force[2]")
        assert len(set(forces)) == count  # it does change within the step
        assert slave.get("mean_force[2]") == pytest.approx([np.mean(forces)], rel=1e-9)


def test_power_is_that_of_force_and_moment(unpacked: Unpack) -> None:
    """Angular velocity by differences of the attitude: roll, then yaw, then pitch."""
    with Slave(unpacked("rail")).initialize() as slave:
        assert slave.set(POWER_MOTION) == OK
        assert slave.step(0, STEP) == OK
        v = dict(zip(INPUTS, slave.get(*(f"wheelset.{n}" for n in INPUTS)), strict=True))
        spin = angular_velocity(v)
        for side in ("", "left.", "right."):
            force = slave.get(*(f"{side}force[{k}]" for k in (1, 2, 3)))
            moment = slave.get(*(f"{side}moment[{k}]" for k in (1, 2, 3)))
            wanted = np.dot(force, [v["speed"], v["vy"], v["vz"]]) + np.dot(moment, spin)
            size = np.linalg.norm(force) * v["speed"]
            assert slave.get(f"{side}power")[0] == pytest.approx(wanted, abs=1e-8 * size)


def test_friction_takes_what_the_contact_gives(tmp_path: Path) -> None:
    """On a rigid track in steady motion, power into the wheelset is that lost in friction."""
    case = with_values(
        RAIL,
        wheelset__vy=0.02,
        wheelset__yaw=1e-3,
        wheelset__pitch_rate=-2.002 / 0.46,
        method__tolerance=1e-9,
    )
    with Slave(Packer(tmp_path, {"rail": case})("rail")).initialize() as slave:
        lost, power = slave.get("creep_power", "power")
        assert lost > 0
        # beside it stands what the pressure does at the approach, on the tilted contact frame
        assert power == pytest.approx(-lost, rel=0.05)


def test_the_largest_step_is_that_of_the_derivatives(tmp_path: Path) -> None:
    """From directional derivatives, and for one freedom what the definition promises."""
    option = {"largest_step": True}
    case = with_values(RAIL, wheelset__y=3e-4, method__tolerance=1e-9)
    fmu = Packer(tmp_path, {"rail": case}, rail=option)("rail")
    mass = np.array([1200.0] * 3 + [700.0, 650.0, 80.0])
    pose = [f"wheelset.{n}" for n in ("y", "z", "roll", "yaw")]
    rates = ("speed", "vy", "vz", "roll_rate", "yaw_rate", "pitch_rate")
    rows = [f"{n}[{k}]" for n in ("force", "moment") for k in (1, 2, 3)]
    order = [0, 1, 2, 3, 5, 4]  # of moments as pose: roll, yaw, pitch
    with Slave(fmu).initialize() as slave:
        inertia = dict(zip((1, 2, 3), (700.0, 80.0, 650.0), strict=True))
        values = {f"wheelset.inertia[{k}]": v for k, v in inertia.items()}
        assert slave.set({"wheelset.mass": 1200.0, **values}) == OK
        stiffness, damping = np.zeros((6, 6)), np.zeros((6, 6))
        for column, name in zip((1, 2, 3, 4), pose, strict=True):
            stiffness[:, column] = -np.array(slave.derivative(rows, {name: 1.0})[1])[order]
        for column, name in enumerate(rates):
            change = slave.derivative(rows, {f"wheelset.{name}": 1.0})[1]
            damping[:, column] = -np.array(change)[order]
        scale = 1 / np.sqrt(np.outer(mass, mass))
        w = math.sqrt(np.linalg.norm(scale * stiffness, 2))
        c = np.linalg.norm(scale * damping, 2)
        [found] = slave.get("largest_step")
        assert found == pytest.approx(min(0.1 / w, 1 / c), rel=1e-4)
        # a hundred times the inertia: ten times the step on the stiffness
        assert slave.set({"wheelset.mass": 1.2e5, **{k: 100 * v for k, v in values.items()}}) == OK
        assert slave.get("largest_step")[0] == pytest.approx(min(1 / w, 100 / c), rel=1e-4)
        assert slave.derivative(["largest_step"], {"wheelset.y": 1.0})[0] == ERROR
        assert slave.set({"wheelset.z": -1e-3}) == OK
        assert slave.step(0, STEP) == OK
        assert slave.get("largest_step") == [1.0]  # nothing touches


def test_all_options_together_are_valid(tmp_path: Path) -> None:
    """The description has no finding, and the page tells of every variable."""
    fmu = Packer(tmp_path, {"a": SCENES["loaded"]}, a={"averages": True, "largest_step": True})("a")
    assert validate_fmu(str(tmp_path / "a.fmu")) == []
    page = (fmu.folder / "documentation" / "index.html").read_text()
    for name, variable in fmu.variables.items():
        if variable.attrib["causality"] != "local":
            assert f"<code>{name}</code>" in page, name
    with Slave(fmu).initialize() as slave:
        assert 1e-6 < slave.get("largest_step")[0] < 0.1
        state = slave.save()
        expected = slave.outputs()
        assert slave.step(0, STEP) == OK
        assert slave.restore(state) == OK
        assert slave.outputs() == expected


@pytest.mark.parametrize(
    ("name", "option", "message"),
    [
        ("patch", {"averages": True}, "--averages: given, allowed with wheels only"),
        ("transient", {"derivatives": "always"}, "--derivatives: value is 'always', allowed"),
    ],
)
def test_options_without_effect_are_refused(
    name: str, option: dict[str, Any], message: str, tmp_path: Path
) -> None:
    with pytest.raises(CaseError, match=message):
        Packer(tmp_path, SCENES, **{name: option})(name)


@pytest.mark.parametrize("name", ["patch", "transient"])
def test_the_largest_step_needs_wheels_and_derivatives(name: str, tmp_path: Path) -> None:
    with pytest.raises(CaseError, match="--largest-step"):
        Packer(tmp_path, SCENES, **{name: {"largest_step": True}})(name)


INPUTS = ("roll", "yaw", "speed", "vy", "vz", "roll_rate", "yaw_rate", "pitch_rate")


def attitude(roll: float, yaw: float, pitch: float) -> np.ndarray:
    """Axes of the wheelset as columns, track axes."""
    c, s = math.cos(roll), math.sin(roll)
    about_x = np.array([[1, 0, 0], [0, c, -s], [0, s, c]])
    c, s = math.cos(yaw), math.sin(yaw)
    about_z = np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]])
    c, s = math.cos(pitch), math.sin(pitch)
    return about_x @ about_z @ np.array([[c, 0, s], [0, 1, 0], [-s, 0, c]])


def angular_velocity(v: dict[str, float]) -> np.ndarray:
    """rad/s, track axes, from R' R^T by central differences."""
    h = 1e-6
    at = [
        attitude(v["roll"] + t * v["roll_rate"], v["yaw"] + t * v["yaw_rate"], t * v["pitch_rate"])
        for t in (-h, 0.0, h)
    ]
    turned = (at[2] - at[0]) / (2 * h) @ at[1].T
    return np.array([turned[2, 1], turned[0, 2], turned[1, 0]])
