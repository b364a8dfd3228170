"""Directional derivatives and output derivatives, against central differences of whole solves."""

from __future__ import annotations

import math
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from case_samples import PATCH, with_values
from fmu_scenes import LOADED, RAIL, ROLLER, STEP, Packer
from fmu_scenes import SCENES as HEATED
from slave import DISCARD, ERROR, OK, Fmu, Real, Reference, Size, Slave

TOLERANCE = 1e-11
BOUND = 1e-5  # relative, as the derivatives have to be
EXACT = {"method__tolerance": TOLERANCE, "method__max_iterations": 1000}
SCENES: dict[str, dict[str, Any]] = {
    "patch": with_values(PATCH, motion__spin_creepage=0.2, **EXACT),
    "normal": with_values(PATCH, motion=None, friction=None, **EXACT),
    "rail": with_values(RAIL, wheelset__y=5e-4, wheelset__yaw=1e-3, **EXACT),
    "loaded": with_values(LOADED, wheelset__vertical_force=8e4, wheelset__y=5e-4, **EXACT),
    "roller": with_values(ROLLER, wheelset__y=5e-4, wheelset__yaw=1e-3, **EXACT),
}
# what changes an input by a good part of what matters, by the end of its name; of a speed of 2 m/s
# 0.04 are a creepage of 2 %
USUAL = {
    "force": 1e4,
    "creepage[1]": 1e-3,
    "creepage[2]": 1e-3,
    "spin_creepage": 0.1,
    "rolling_speed": 1.0,
    "wheelset.y": 1e-3,
    "wheelset.z": 1e-4,
    "offset[1]": 1e-3,
    "offset[2]": 1e-3,
    "offset[3]": 1e-4,
    "roll": 1e-4,
    "yaw": 1e-3,
    "rotation[1]": 1e-3,
    "rotation[3]": 1e-3,
    "pitch_rate": 0.04,
    "wheelset.speed": 0.04,
    "angular_velocity[2]": 0.04,
    "velocity[1]": 0.04,
    "friction.coefficient": 0.05,
}
RATE = 0.01  # of all others
DIFFERENCE = 1e-4  # of the usual change
COUNTS = ("elements", "patch_count", "status")


@pytest.fixture(scope="module")
def exact(tmp_path_factory: pytest.TempPathFactory) -> Callable[..., Fmu]:
    """FMUs of the scenes above."""
    return Packer(tmp_path_factory.mktemp("derivatives"), SCENES)


def usual(name: str) -> float:
    """The change of an input that matters."""
    return next((size for end, size in USUAL.items() if name.endswith(end)), RATE)


def solved(slave: Slave, values: dict[str, float]) -> dict[str, float]:
    """Outputs in initialization mode, after a reset."""
    assert slave.call("Reset") == OK
    assert slave.setup() == OK
    assert slave.set(values) == OK, slave.log
    assert slave.call("EnterInitializationMode") == OK
    return slave.outputs()


def numbers(outputs: dict[str, float]) -> list[float]:
    """What must not change between the ends of a difference."""
    return [v for k, v in outputs.items() if any(word in k for word in COUNTS)]


@pytest.mark.parametrize("name", SCENES)
def test_equal_central_differences(name: str, exact: Callable[..., Fmu]) -> None:
    """Rows scaled by their greatest entry for usual changes; differences over events left out."""
    fmu = exact(name)
    assert fmu.root.find("CoSimulation").attrib["providesDirectionalDerivative"] == "true"
    # without lateral creepage the wear number has a kink, where differences err by the step
    kinks = name in ("patch", "loaded")
    without = ("residual", "max_traction")
    left_out = (*without, "wear_number") if kinks else without
    outputs = [n for n in fmu.names("output", "Real") if not n.endswith(left_out)]
    inputs = fmu.names("input", "Real")
    inputs += [n for n in fmu.names("parameter") if n == "friction.coefficient"]
    start = {n: float(fmu.variables[n][0].attrib["start"]) for n in inputs}
    matrix, differences, kept = [], [], []
    with Slave(fmu).initialize() as slave, Slave(fmu) as other:
        base = numbers(solved(other, {}))
        for known in inputs:
            status, column = slave.derivative(outputs, {known: usual(known)})
            assert status == OK, slave.log
            matrix.append(column)
            ends = []
            for sign in (1, -1):
                moved = start[known] + sign * DIFFERENCE * usual(known)
                ends.append(solved(other, {known: moved}))
            kept.append(all(numbers(end) == base for end in ends))
            over = [(ends[0][n] - ends[1][n]) / (2 * DIFFERENCE) for n in outputs]
            differences.append(over)
    found, wanted = np.array(matrix), np.array(differences)
    assert sum(kept) > len(kept) / 2
    scale = np.abs(found).max(axis=0)
    for column, known in enumerate(inputs):
        if kept[column]:
            error = np.abs(found[column] - wanted[column])
            worst = int(np.argmax(error - BOUND * scale))
            assert error[worst] <= BOUND * scale[worst], (known, outputs[worst], error[worst])


def test_state_outputs_and_later_steps_stay(exact: Callable[..., Fmu]) -> None:
    fmu = exact("rail")
    runs = []
    for asked in (False, True):
        with Slave(fmu).initialize() as slave:
            contents = []
            for k in range(3):
                assert slave.set({"wheelset.y": 1e-4 * k}) == OK
                assert slave.step(k * STEP, STEP) == OK, slave.log
                if asked:
                    status, _ = slave.derivative(["force[2]"], {"wheelset.vy": 1.0})
                    assert status == OK
                contents.append((slave.serialize(slave.save()), slave.outputs()))
            runs.append(contents)
    assert runs[0] == runs[1]


def test_after_a_restored_state(exact: Callable[..., Fmu]) -> None:
    """The same to the solver's tolerance, though inputs were set since; the next step has the
    same bits."""
    fmu = exact("rail")
    names, seeds = ["force[1]", "force[3]", "power"], {"wheelset.z": 1e-4, "wheelset.vy": 0.01}
    with Slave(fmu).initialize() as slave:
        assert slave.set({"wheelset.y": 1e-4}) == OK
        assert slave.step(0, STEP) == OK
        assert slave.set({"wheelset.y": 3e-4}) == OK
        status, before = slave.derivative(names, seeds)
        assert status == OK
        state = slave.save()
        content = slave.serialize(state)
        assert slave.step(STEP, STEP) == OK
        after = slave.outputs()
        for _ in range(2):
            assert slave.restore(state) == OK
            status, found = slave.derivative(names, seeds)
            assert status == OK, slave.log
            assert found == pytest.approx(before, rel=1e-6)
            assert slave.serialize(slave.save()) == content
            assert slave.step(STEP, STEP) == OK
            assert slave.outputs() == after


def test_linear_in_the_seed_and_sums_of_wheels(exact: Callable[..., Fmu]) -> None:
    with Slave(exact("rail")).initialize() as slave:
        names = ["creep_power", "left.creep_power", "right.creep_power"]
        _, one = slave.derivative(names, {"wheelset.vy": 0.01})
        _, two = slave.derivative(names, {"wheelset.yaw": 1e-3})
        _, both = slave.derivative(names, {"wheelset.vy": 0.02, "wheelset.yaw": -1e-3})
        assert both == pytest.approx([2 * a - b for a, b in zip(one, two, strict=True)], rel=1e-6)
        assert one[0] == pytest.approx(one[1] + one[2], rel=1e-12)
        _, [passed] = slave.derivative(["z"], {"wheelset.z": 2.5})
        assert passed == 2.5
        assert slave.derivative(["residual", "z"], {"wheelset.y": 1.0}) == (OK, [0.0, 0.0])
        assert slave.derivative(["z"], {}) == (OK, [0.0])


def test_wrong_calls(exact: Callable[..., Fmu]) -> None:
    fmu = exact("patch")
    one = Size(1)
    with Slave(fmu).initialize() as slave:
        creep, force = fmu.references["creep_force[1]"], fmu.references["normal_force"]
        state = slave.serialize(slave.save())
        for unknown, known in (
            (99, force),
            (creep, 99),
            (force, force),
            (creep, creep),
            (creep, fmu.references["direction"]),
        ):
            slave.log.clear()
            arrays = ((Reference * 1)(unknown), one, (Reference * 1)(known), one)
            status = slave.call(
                "GetDirectionalDerivative", *arrays, (Real * 1)(1.0), (Real * 1)(0.0)
            )
            assert status == ERROR
            assert len(slave.log) == 1
        for seed in (math.nan, math.inf):
            assert slave.derivative(["creep_force[1]"], {"normal_force": seed})[0] == ERROR
        good: list[Any] = [(Reference * 1)(creep), one, (Reference * 1)(force), one]
        good += [(Real * 1)(1.0), (Real * 1)(0.0)]
        for missing in (0, 2, 4, 5):
            changed = [None if i == missing else value for i, value in enumerate(good)]
            assert slave.call("GetDirectionalDerivative", *changed) == ERROR
        assert slave.output_derivatives(["creep_force[1]"], order=2)[0] == ERROR
        assert slave.output_derivatives(["normal_force"])[0] == ERROR
        assert slave.serialize(slave.save()) == state


def test_after_a_failed_step(exact: Callable[..., Fmu]) -> None:
    with Slave(exact("rail")).initialize() as slave:
        state = slave.save()
        assert slave.set({"wheelset.z": 0.02}) == OK
        assert slave.step(0, STEP) == DISCARD
        assert slave.derivative(["force[3]"], {"wheelset.y": 1.0})[0] == DISCARD
        assert slave.restore(state) == OK
        assert slave.derivative(["force[3]"], {"wheelset.y": 1.0})[0] == OK


def test_scenes_without_exact_ones_have_them_on_request(tmp_path: Path) -> None:
    fast = with_values(PATCH, method={"normal": "hertz", "tangential": "fastsim"})
    pack = Packer(tmp_path, {"fast": fast, "asked": fast}, asked={"derivatives": "always"})
    flags = [
        pack(name).root.find("CoSimulation").attrib["providesDirectionalDerivative"]
        for name in ("fast", "asked")
    ]
    assert flags == ["false", "true"]
    with Slave(pack("asked")).initialize() as slave:
        status, [slope] = slave.derivative(["creep_force[1]"], {"normal_force": 1e3})
        assert status == OK
        [middle] = slave.get("creep_force[1]")
        assert slave.set({"normal_force": 1.01e5}) == OK
        assert slave.step(0, STEP) == OK
        [moved] = slave.get("creep_force[1]")
        # a curved line: the chord of 1 % is near the tangent
        assert moved - middle == pytest.approx(slope, rel=0.02)
        status, [slope] = slave.derivative(["creep_force[1]"], {"friction.coefficient": 0.003})
        assert status == OK
        assert slave.set({"friction.coefficient": 0.303}) == OK
        assert slave.step(STEP, STEP) == OK
        assert slave.get("creep_force[1]")[0] - moved == pytest.approx(slope, rel=0.02)
    with Slave(pack("fast")).initialize() as slave:
        assert slave.derivative(["creep_force[1]"], {"normal_force": 1.0})[0] == ERROR
        assert slave.output_derivatives(["creep_force[1]"])[0] == ERROR


def test_temperatures_by_those_of_the_bodies(tmp_path: Path) -> None:
    """By differences; apart it is the warmer body's own."""
    case = with_values(HEATED["warm"], method__tolerance=1e-9)
    fmu = Packer(tmp_path, {"warm": case}, warm={"derivatives": "always"})("warm")
    names = ["max_temperature", "left.max_temperature", "right.patch[1].max_temperature"]
    for known, start, change in (
        ("temperature.rail", 20.0, 0.1),
        ("temperature.wheel", 30.0, 0.1),
        ("friction.coefficient", 0.3, 1e-3),
    ):
        with Slave(fmu) as slave:
            ends = [solved(slave, {known: start + sign * change}) for sign in (1, -1)]
        with Slave(fmu).initialize() as slave:
            status, found = slave.derivative(names, {known: 2 * change})
        assert status == OK
        assert found == pytest.approx([ends[0][n] - ends[1][n] for n in names], rel=1e-3)
        assert min(found) > 0
    with Slave(fmu).initialize() as slave:
        assert slave.set({"wheelset.z": -1e-3}) == OK
        assert slave.step(0, STEP) == OK
        status, found = slave.derivative(names, {"temperature.wheel": 2.0})
        assert (status, found) == (OK, pytest.approx([2.0] * 3, rel=1e-12))
        assert slave.derivative(names, {"temperature.rail": 2.0}) == (OK, [0.0] * 3)


def test_output_derivatives_follow_the_inputs(exact: Callable[..., Fmu]) -> None:
    """Against central differences in time, of the same motion."""
    names = ["force[1]", "force[3]", "moment[3]", "left.patch[1].max_pressure", "z"]
    motion = {"wheelset.y": 0.2, "wheelset.yaw": 0.3, "wheelset.z": 0.01, "wheelset.vy": 2.0}
    bend = {"wheelset.y": 100.0}
    fmu = exact("rail")

    def after(time: float) -> Slave:
        slave = Slave(fmu).initialize()
        assert slave.set_derivatives(motion) == OK
        assert slave.set_derivatives(bend, order=2) == OK
        assert slave.step(0, time) == OK, slave.log
        return slave

    with after(STEP) as slave:
        status, found = slave.output_derivatives(names)
        assert status == OK, slave.log
        # held from now on
        assert slave.step(STEP, STEP) == OK
        assert slave.output_derivatives(names) == (OK, [0.0] * len(names))
    difference = 3e-5 * STEP
    with after(STEP + difference) as late, after(STEP - difference) as early:
        assert numbers(late.outputs()) == numbers(early.outputs())  # no event in between
        pairs = zip(late.get(*names), early.get(*names), strict=True)
        wanted = [(a - b) / (2 * difference) for a, b in pairs]
    assert found == pytest.approx(wanted, rel=1e-5)


def test_entries_are_those_of_the_column(exact: Callable[..., Fmu]) -> None:
    """Entries asked one by one are those of the whole column, to the bit."""
    fmu = exact("rail")
    names = fmu.names("output", "Real")
    names = [n for n in names if "patch" not in n]
    with Slave(fmu).initialize() as slave:
        _, whole = slave.derivative(names, {"wheelset.y": 1.0})
        single = [slave.derivative([n], {"wheelset.y": 1.0})[1][0] for n in names]
        assert single == whole
