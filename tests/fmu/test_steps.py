"""Steps that fail, in whole or in the middle, and steps at standstill."""

from __future__ import annotations

import ctypes as ct
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
import railpatch
from case_samples import PATCH, with_values
from fmu_scenes import SCENES, STEP, Packer
from slave import DISCARD, ERROR, OK, Fmu, Real, Slave

Unpack = Callable[..., Fmu]


def last_successful_time(slave: Slave) -> float:
    """fmi2LastSuccessfulTime."""
    value = Real()
    assert slave.call("GetRealStatus", 2, ct.byref(value)) == OK
    return value.value


def test_a_step_discarded_in_the_middle_is_as_never_made(unpacked: Unpack) -> None:
    """Some sub-steps succeed; time, inputs and outputs stay those of the step's start, and from the
    saved state a smaller step gives the bits of one that was made at once."""
    fmu, rate = unpacked("transient"), 0.1
    with Slave(fmu).initialize() as slave, Slave(fmu).initialize() as other:
        for one in (slave, other):
            assert one.set({"substeps": 20, "wheelset.y": 1e-4}) == OK
            assert one.step(0, STEP) == OK
        before, inputs = slave.outputs(), slave.get("wheelset.y", "wheelset.z")
        state = slave.save()
        assert slave.set_derivatives({"wheelset.z": rate}) == OK
        # the approach grows by 2 mm: too large a patch on the way
        assert slave.step(STEP, 20 * STEP) == DISCARD
        [(status, category, text)] = [line for line in slave.log if "Warning" not in line[1]]
        assert (status, category) == (DISCARD, "logStatusDiscard")
        assert "smaller step" in text
        failed_at = float(text.split("at time ")[1].split()[0].rstrip(":"))
        assert 2 * STEP < failed_at < 21 * STEP  # not in the first sub-step
        assert last_successful_time(slave) == STEP
        assert slave.outputs() == before
        assert slave.get("wheelset.y", "wheelset.z") == inputs
        # nothing goes on from here
        assert slave.step(STEP, STEP) == ERROR
        assert slave.restore(state) == OK
        for one in (slave, other):
            assert one.step(STEP, STEP / 2) == OK
        assert slave.outputs() == other.outputs()


def test_an_input_that_leaves_its_range_in_the_middle(unpacked: Unpack) -> None:
    with Slave(unpacked("transient_patch")).initialize() as slave:
        assert slave.set({"substeps": 10}) == OK
        state, before = slave.save(), slave.outputs()
        assert slave.set_derivatives({"normal_force": -1.5e8}) == OK
        assert slave.step(0, STEP) == DISCARD
        [(_, _, text)] = slave.log
        assert "normal_force" in text
        assert "smaller step" in text
        assert last_successful_time(slave) == 0
        assert slave.outputs() == before
        assert slave.restore(state) == OK
        assert slave.step(0, STEP) == OK


def test_not_converged_says_what_to_change(tmp_path: Path) -> None:
    """Few iterations are enough for the start, not for another state."""
    case = with_values(
        PATCH,
        method={"normal": "hertz", "tolerance": 1e-9, "max_iterations": 3},
        motion__creepage=[0.0, 0.0],
    )
    with Slave(Packer(tmp_path, {"few": case})("few")).initialize() as slave:
        state = slave.save()
        assert slave.set({"creepage[1]": 2e-3, "creepage[2]": 1e-3, "spin_creepage": 0.9}) == OK
        assert slave.step(0, STEP) == DISCARD
        [(_, category, text)] = slave.log
        assert category == "logStatusDiscard"
        for word in ("did not converge", "smaller step", "method.tolerance", "max_iterations"):
            assert word in text
        assert slave.restore(state) == OK
        assert slave.step(0, STEP) == OK


def test_out_of_range_of_a_patch_says_what_to_change(tmp_path: Path) -> None:
    case = with_values(
        PATCH,
        geometry={"curvatures": [1.0, 1.5]},
        grid={"element_size": [5e-4, 5e-4], "max_elements": [40, 40]},
    )
    with Slave(Packer(tmp_path, {"small": case})("small")).initialize() as slave:
        assert slave.set({"normal_force": 1e7}) == OK
        assert slave.step(0, STEP) == DISCARD
        [(_, _, text)] = slave.log
        assert "grid.max_elements" in text


@pytest.mark.parametrize("held", [True, False])
def test_transient_patch_at_standstill(held: bool, unpacked: Unpack) -> None:
    """Nothing rolls on: tractions stay, and follow a load that falls; then it rolls on again."""
    load: dict[str, Any] = {} if held else {"normal_force": 5e4}
    contact = railpatch.Contact(SCENES["transient_patch"])
    contact.step()
    with Slave(unpacked("transient_patch")).initialize() as slave:
        rolled = slave.outputs()
        found, wanted = [], []
        for k, values in enumerate(({"rolling_speed": 0.0, **load}, {"rolling_speed": 10.0})):
            assert slave.set(values) == OK
            assert slave.step(k * STEP, STEP) == OK, slave.log
            found.append(slave.get("creep_force[1]", "spin_moment"))
            distance = values["rolling_speed"] * STEP or 1e-2
            result = contact.step(**values, distance=distance)
            wanted.append([result["creep_force"][0], result["spin_moment"]])
        assert slave.log == []
    assert found == wanted
    if held:
        assert found[0][0] == pytest.approx(rolled["creep_force[1]"], rel=1e-4)
    else:
        assert abs(found[0][0]) < abs(rolled["creep_force[1]"])
