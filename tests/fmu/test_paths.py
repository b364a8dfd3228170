"""What a step may depend on, and inputs that do not fit together."""

from __future__ import annotations

from collections.abc import Callable

import pytest
from fmu_scenes import MOTIONS, SCENES
from slave import DISCARD, OK, Fmu, Slave

Unpack = Callable[[str], Fmu]
STEPS = (1e-3, 2.5e-4)  # s


@pytest.mark.parametrize("name", SCENES)
def test_only_a_scene_with_a_history_depends_on_the_way(name: str, unpacked: Unpack) -> None:
    """The same inputs in the end, by another way and by steps of another length."""
    fmu = unpacked(name)
    names = [n for n in fmu.names("output", "Real") if not n.endswith("residual")]
    *way, last = MOTIONS[name]
    values = {key: value for motion in [*way, last] for key, value in motion.items()}
    found = []
    for steps, length in ((way, STEPS[0]), ([], STEPS[1])):
        with Slave(fmu).initialize() as slave:
            time = 0.0
            for motion in [*steps, values]:
                assert slave.set(motion) == OK
                assert slave.step(time, length) == OK, slave.log
                time += length
            found.append(dict(zip(names, slave.get(*names), strict=True)))
    history = fmu.root.find("ModelExchange") is None
    # to the solver's tolerance, and what is zero but for that
    greatest = max(abs(value) for value in found[0].values())
    alike = all(
        found[0][n] == pytest.approx(found[1][n], rel=1e-3, abs=1e-5 * greatest) for n in names
    )
    assert alike or history


def test_rails_on_springs_have_a_history(unpacked: Unpack) -> None:
    """How fast they move is creepage: rails follow at once in a long step, not in a short one."""
    fmu = unpacked("springs")
    assert fmu.root.find("ModelExchange") is None
    found = []
    for length in (1e-3, 10.0):
        with Slave(fmu).initialize() as slave:
            assert slave.set({"wheelset.y": 2e-4, "wheelset.z": 6e-4}) == OK
            assert slave.step(0, length) == OK
            found.append(slave.get("left.patch[1].creepage[2]")[0])
    # m/s, of a rail that gives way by micrometres in a millisecond; 2 m/s is the speed
    assert abs(found[0]) > 1e-6 / 1e-3 / 2.0 / 100
    assert abs(found[1]) < 0.05 * abs(found[0])


def test_a_creep_force_beyond_friction_is_a_step_to_take_back(unpacked: Unpack) -> None:
    """Inputs that are right each by itself: the step is discarded, and a smaller one is made."""
    with Slave(unpacked("prescribed_force")).initialize() as slave:
        load, mu, force = slave.get("normal_force", "friction.coefficient", "tangential_force[1]")
        state = slave.save()
        rate = {"normal_force": -load / 1e-3}
        assert slave.set_derivatives(rate) == OK
        assert slave.step(0, 0.99e-3) == DISCARD
        status, _, text = slave.log[-1]
        assert status == DISCARD
        assert "friction coefficient times normal_force" in text
        assert "take a smaller step or other inputs" in text
        assert slave.restore(state) == OK
        assert slave.set_derivatives(rate) == OK
        assert abs(force) < mu * 0.9 * load
        assert slave.step(0, 0.1e-3) == OK, slave.log
