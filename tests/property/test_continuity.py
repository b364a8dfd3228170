"""Forces of a wheel follow its position and speed without jumps.

The bound is the one that the force law is made for: no component of force or moment (over the
nominal radius) changes within a micrometre by more than 0.2 % of the wheel load beyond what the
slope on either side explains. The places are the hardest ones of the sweeps of `railpatch
continuity`: where a second place of contact appears, and where two become one.
"""

from __future__ import annotations

import copy

import numpy as np
import pytest
import railpatch
from railpatch.evidence.continuity.scenes import MICRO, RADIUS, standstill, wheel_case
from railpatch.evidence.continuity.sweep import LIMIT, Path, measure

LOAD = 1e4  # N
# y, m, and yaw, rad
EVENTS = {
    "second contact vanishes": (5.190e-3, 5.225e-3, 0.0),
    "two contacts become one": (6.530e-3, 6.565e-3, 0.012),
}


def swept(rule, start, stop, yaw):
    case = wheel_case(LOAD)
    case["method"] = {"patch_rule": rule}
    path = Path("y", lambda y: {"y": y, "yaw": yaw}, start, stop, MICRO, MICRO)
    return measure(case, path)


@pytest.mark.parametrize("event", EVENTS)
def test_no_jumps(event):
    sweep = swept("blended", *EVENTS[event])
    print(event, sweep.worst, sweep.worst_at, sweep.most_patches)
    assert sweep.bad == 0
    assert sweep.most_patches == 3, "the event is not among these positions"
    # pressure on the flange counts with its own direction from its first newton on: a bend
    assert sweep.jump < LIMIT


def test_the_rule_of_contact_jumps():
    # there one patch with one reference becomes two; a jump does not shrink with the step
    sweep = swept("contact", *EVENTS["second contact vanishes"])
    assert sweep.most_patches == 2
    assert sweep.worst > LIMIT
    assert sweep.remaining > LIMIT


def test_through_standstill():
    case = wheel_case(LOAD)
    sweep = measure(case, standstill())
    assert sweep.bad == 0
    assert sweep.worst < LIMIT
    case["method"] = {"standstill_speed": 0.0}
    assert measure(case, standstill()).worst > LIMIT


def test_at_rest_only_slip_gives_force():
    contact = railpatch.Contact(wheel_case(LOAD))
    still = contact.step(speed=0.0, pitch_rate=0.0, y=0.004)
    assert still.status == "converged"
    assert still["patches"][0]["creep_force"] == [0.0, 0.0]
    # a locked wheel that slides: the whole of friction, against the motion
    slides = contact.step(speed=0.0, pitch_rate=0.0, vy=0.1, y=0.004)["patches"][0]
    assert slides["creep_force"][1] == pytest.approx(-0.3 * slides["normal_force"], rel=1e-3)
    # slip is creepage times the speed it refers to, half of 1 mm/s at rest
    assert slides["rolling_speed"] == pytest.approx(5e-4)
    slip = 0.1 * np.cos(slides["contact_angle"])
    assert slides["creepage"][1] * slides["rolling_speed"] == pytest.approx(slip)
    # power is force times slip
    power = -slides["creep_force"][1] * slip
    assert slides["friction_power"] == pytest.approx(power, rel=1e-3)


@pytest.mark.parametrize("speed", [0.9e-3, 0.999e-3, 1.001e-3, 2e-3])
def test_creepage_speed_joins_the_rolling_speed(speed):
    wheel = railpatch.Contact(wheel_case(LOAD)).step(
        speed=speed, pitch_rate=-speed / RADIUS, y=0.004
    )
    found, radius = wheel["patches"][0], wheel["rolling_radius"]
    # mean of the two surface speeds; the circumferential one has the rolling radius
    mean = 0.5 * (speed + speed / RADIUS * radius)
    wanted = mean if mean > 1e-3 else (mean**2 + 1e-6) / 2e-3
    assert found["rolling_speed"] == pytest.approx(wanted, rel=1e-9)


def test_force_is_the_sum_of_shares():
    # where two divisions into patches count, the wheel's force is that of both with their shares
    contact = railpatch.Contact(wheel_case(LOAD))
    wheel = contact.step(y=5.21e-3)
    # mostly one patch, else each alone
    assert len(wheel["patches"]) == 1
    patches = wheel["patches"] + wheel["alternatives"]
    shares = [patch["share"] for patch in patches]
    assert len(patches) == 3
    assert shares[1] == shares[2] == pytest.approx(1 - shares[0], rel=1e-12)
    total = np.zeros(3)
    for patch in patches:
        c, s = np.cos(patch["contact_angle"]), np.sin(patch["contact_angle"])
        x, lateral = patch["creep_force"]
        normal = -patch["normal_force"]
        total += patch["share"] * np.array([x, c * lateral - s * normal, s * lateral + c * normal])
    # pressures have parts beside the frames' normals, no more than the surface turns by over them
    assert total == pytest.approx(np.array(wheel["force"]), abs=1e-3 * LOAD)


def test_warm_start_survives_a_birth_beside():
    # a new patch to the left of one does not take its memory: few iterations, same result
    case = wheel_case(LOAD)
    warm = railpatch.Contact(copy.deepcopy(case))
    cold = railpatch.Contact(copy.deepcopy(case))
    z = cold.step(y=6.5379e-3, yaw=0.012)["z"]
    case["wheelset"].pop("vertical_force")
    case["wheelset"]["z"] = z
    warm, cold = railpatch.Contact(case), railpatch.Contact(case)
    assert len(warm.step(y=6.5375e-3, yaw=0.012)["patches"]) == 1
    after = warm.step(y=6.5385e-3, yaw=0.012)["patches"]
    afresh = cold.step(y=6.5385e-3, yaw=0.012)["patches"]
    assert len(after) == len(afresh) == 2
    heavy = max(range(2), key=lambda k: after[k]["normal_force"])
    assert heavy == 1, "the new patch is to come first"
    assert after[1]["iterations"] < afresh[1]["iterations"]
    assert after[1]["normal_force"] == pytest.approx(afresh[1]["normal_force"], rel=1e-4)
