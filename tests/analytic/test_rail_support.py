"""Rails on springs and dampers without mass.

Imposed: what the equations say holds to the solver's tolerance (TOLERANCE times the force).
Discretisation: the implicit step against exact solutions, with its order.
"""

from __future__ import annotations

import itertools
from typing import Any

import numpy as np
import pytest
from case_samples import WHEELSET, with_values
from railpatch import CaseError, Contact, solve
from scipy.optimize import brentq

TOLERANCE = 1e-5
SPEED, RADIUS, CROWN = 20.0, 0.46, 0.3
SIDES = ("left", "right")


def support(stiffness: list[float], damping: list[float]) -> dict[str, Any]:
    """The table [track.rail_support]."""
    return {"stiffness": stiffness, "damping": damping}


def crossed(**values: Any) -> dict[str, Any]:
    """A cylinder above a crown: quadratic surfaces, vertical force, no friction."""
    case = {
        "kind": "wheel_rail",
        "grid": {"elements": [24, 24]},
        "method": {"normal": "hertz", "tangential": "none"},
        "wheelset": {
            "vertical_force": 1e5,
            "nominal_radius": RADIUS,
            "flange_back_distance": 1.36,
            "flange_back_position": -0.07,
        },
        "track": {"gauge": 1.435},
        "profiles": {"wheel": "cylinder", "rail": f"arc@{CROWN}"},
    }
    if "wheelset__z" in values:
        values["wheelset__vertical_force"] = None
    return with_values(case, **values)


def wheelset(**values: Any) -> dict[str, Any]:
    """S1002 on UIC60 at 20 m/s, with simple theories."""
    simple = {
        "grid": {"element_size": [1e-3, 1e-3]},
        "method": {"normal": "hertz", "tangential": "fastsim", "tolerance": TOLERANCE},
    }
    case = with_values({**WHEELSET, **simple}, wheelset__z=None, wheelset__vertical_force=1.2e5)
    values = {"wheelset__speed": SPEED, "wheelset__pitch_rate": -SPEED / RADIUS, **values}
    if "wheelset__z" in values:
        values["wheelset__vertical_force"] = None
    return with_values(case, **values)


def hertz_approach(force: float) -> float:
    """m, closed form, of the cylinder on the crown."""
    patch = {
        "kind": "patch",
        "geometry": {"curvatures": [0.5 / RADIUS, 0.5 / CROWN]},
        "load": {"normal_force": force},
        "motion": {"regime": "none"},
        "method": {"normal": "hertz", "tangential": "none"},
    }
    return float(solve(patch)["approach"])


def residuals(result: Any, stiffness: float, damping: float, k: int, dt: float, old: Any) -> list:
    """Of k u + c (u - u_before)/dt = force on the rail, over the force, side by side."""
    found = []
    for side in SIDES if "left" in result.data else (None,):
        wheel = result[side] if side else result
        u = wheel["rail_deflection"][k]
        before = old[side][k] if old else 0.0
        rate = (u - before) / dt if dt > 0 else 0.0
        assert wheel["rail_deflection_rate"][k] == pytest.approx(rate, rel=1e-9, abs=1e-300)
        force = -wheel["force"][k + 1]
        gap = abs(stiffness * u + damping * rate - force)
        # what is left without a force is the rounding of its terms
        rounding = 1e-10 * (stiffness * abs(u) + damping * abs(rate))
        found.append(max(gap - rounding, 0.0) / max(np.hypot(*wheel["force"][1:]), 1e-3))
    return found


@pytest.mark.parametrize("stiffness", [1e6, 5e7, 1e9, 1e12])
def test_hertz_in_series_with_a_spring(stiffness: float) -> None:
    """z = approach(F) + F/k, by force and by position. The wheel's Hertz ellipse is that of the
    overlap's depth, length and width: here this takes 0.25 % of the approach."""
    force = 1e5
    on_spring = {"track__rail_support": support([0.0, stiffness], [0.0, 0.0])}
    found = solve(crossed(**on_spring))
    assert found.status == "converged"
    assert found["rail_deflection"] == pytest.approx([0.0, force / stiffness], rel=TOLERANCE)
    rigid = solve(crossed())
    assert found["z"] == pytest.approx(rigid["z"] + force / stiffness, rel=TOLERANCE)
    expected = hertz_approach(force) + force / stiffness
    assert found["z"] == pytest.approx(expected, rel=3e-3)
    found = solve(crossed(wheelset__z=expected, **on_spring))
    hand = brentq(lambda f: hertz_approach(f) + f / stiffness - expected, 1e4, 1e6)
    assert hand == pytest.approx(force, rel=1e-9)
    # the force goes with the approach to the power 1.5
    assert -found["force"][2] == pytest.approx(hand, rel=4.5e-3)
    assert max(residuals(found, stiffness, 0.0, 1, 0.0, None)) <= TOLERANCE


@pytest.mark.parametrize("load", [{"vertical_force": 1.2e5}, {"z": 2.5e-4}])
@pytest.mark.parametrize("stiffness", [[1e6, 1e6], [2e7, 5e7], [1e9, 1e9], [2e7, 0.0], [0.0, 5e7]])
def test_rails_stand_where_their_forces_hold_them(
    load: dict[str, float], stiffness: list[float]
) -> None:
    """Steps of a wheelset that swings: each converges, obeys the equations, and is what rigid rails
    at the same place with the same velocity give."""
    damping = [2e4 * (stiffness[0] > 0), 5e4 * (stiffness[1] > 0)]
    start = {f"wheelset__{key}": value for key, value in load.items()}
    for dt in (1e-5, 1e-4, 1e-3, 1e-2):
        case = wheelset(**start, track__rail_support=support(stiffness, damping))
        contact = Contact(with_values(case, wheelset__time_step=dt))
        rigid = Contact(wheelset(wheelset__z=0.0, method__tolerance=TOLERANCE))
        old: Any = None
        for step in range(5):
            swing = {"y": 2e-3 * np.sin(step / 3), "yaw": 1e-3 * np.sin(step / 2)}
            found = contact.step(**swing, vy=0.02 * np.cos(step / 3))
            assert found.status == "converged", (dt, step)
            for k in (0, 1):
                if stiffness[k] == 0:
                    assert all(found[side]["rail_deflection"][k] == 0 for side in SIDES)
                    continue
                worst = max(residuals(found, stiffness[k], damping[k], k, dt, old))
                assert worst <= 1.01 * TOLERANCE, (dt, step, k)
            old = {side: found[side]["rail_deflection"] for side in SIDES}
            moved = {
                side: {
                    "offset": [0.0, *found[side]["rail_deflection"]],
                    "velocity": [0.0, *found[side]["rail_deflection_rate"]],
                }
                for side in SIDES
            }
            same = rigid.step(**swing, vy=0.02 * np.cos(step / 3), z=found["z"], track=moved)
            for side in SIDES:
                size = np.abs(found[side]["force"]).max()
                close = np.abs(np.subtract(found[side]["force"], same[side]["force"])).max()
                assert close <= 5 * TOLERANCE * size, (dt, step, side)
            if "vertical_force" in load:
                assert found["force"][2] == pytest.approx(-1.2e5, rel=1.01 * TOLERANCE)


def test_very_stiff_rails_are_rigid() -> None:
    stiff = wheelset(track__rail_support=support([1e14, 1e14], [0.0, 0.0]))
    found, rigid = solve(stiff), solve(wheelset())
    for side in SIDES:
        size = np.abs(rigid[side]["force"]).max()
        assert np.abs(np.subtract(found[side]["force"], rigid[side]["force"])).max() < 1e-4 * size


def relaxation(steps: int, time: float) -> tuple[float, float]:
    """Deflections after lifting off: at once, and after a time in so many steps."""
    stiffness, damping = 5e7, 1e5
    case = crossed(track__rail_support=support([0.0, stiffness], [0.0, damping]), wheelset__z=3e-3)
    contact = Contact(case)
    start = contact.step()["rail_deflection"][1]
    for _ in range(steps):
        found = contact.step(z=-0.01, time_step=time / steps)
        assert found.status == "no_contact"
        assert found["force"] == [0.0, 0.0, 0.0]
    return start, found["rail_deflection"][1]


def test_a_free_rail_comes_back_exponentially() -> None:
    """u = u0 exp(-t k/c); the implicit step is u0 (1 + h k/c)^-n, of first order."""
    time, constant = 3e-3, 1e5 / 5e7
    errors = []
    for steps in (10, 20, 40, 80):
        start, found = relaxation(steps, time)
        assert start > 1e-3
        implicit = (1 + time / steps / constant) ** -steps
        assert found / start == pytest.approx(implicit, rel=1e-12)
        errors.append(abs(found / start - np.exp(-time / constant)))
    rates = [np.log2(a / b) for a, b in itertools.pairwise(errors)]
    assert min(rates) > 0.9
    assert rates[-1] == pytest.approx(1.0, abs=0.05)


def test_dampers_take_what_the_contact_supplies() -> None:
    """Work on the rails = energy of the springs + loss in the dampers, with that of the implicit
    step, k (u - u_before)^2/2; over a swing of the wheelset."""
    stiffness, damping, dt = np.array([2e7, 5e7]), np.array([2e4, 5e4]), 1e-3
    case = wheelset(track__rail_support=support(stiffness.tolist(), damping.tolist()))
    contact = Contact(case)
    found = contact.step()
    old = {side: np.array(found[side]["rail_deflection"]) for side in SIDES}
    begin = {side: 0.5 * stiffness @ old[side] ** 2 for side in SIDES}
    work, lost, turned_over = 0.0, 0.0, 0.0
    for step in range(30):
        place = {"y": 3e-3 * np.sin(step / 5), "vy": 0.6 * np.cos(step / 5)}
        found = contact.step(**place, time_step=dt)
        assert found.status == "converged"
        for side in SIDES:
            u = np.array(found[side]["rail_deflection"])
            change = u - old[side]
            part = -np.array(found[side]["force"][1:]) @ change
            work += part
            turned_over += abs(part)
            lost += damping @ change**2 / dt + 0.5 * stiffness @ change**2
            old[side] = u
    stored = sum(0.5 * stiffness @ old[side] ** 2 - begin[side] for side in SIDES)
    assert lost > 0
    assert work - stored == pytest.approx(lost, abs=20 * TOLERANCE * turned_over)
    assert lost > 100 * 20 * TOLERANCE * turned_over


@pytest.mark.parametrize("load", [{}, {"wheelset__z": 2.5e-4}])
def test_a_restored_state_steps_to_the_same_bits(load: dict[str, float]) -> None:
    rails = support([2e7, 5e7], [2e4, 5e4])
    case = wheelset(**load, track__rail_support=rails, wheelset__time_step=1e-3)
    contact = Contact(case)
    first = contact.step(y=1e-3)
    contact.step(y=2e-3)
    state = contact.save()
    expected = contact.step(y=3e-3)
    contact.step(y=-4e-3)
    contact.restore(state)
    other = Contact(case)
    other.restore(state)
    for again in (contact, other):
        found = again.step(y=3e-3)
        for side in SIDES:
            assert found.to_dict()[side] == expected.to_dict()[side]
    contact.reset()
    assert contact.step(y=1e-3).to_dict()["left"] == first.to_dict()["left"]
    with pytest.raises(CaseError, match="state"):
        Contact(wheelset(**load, track__rail_support=support([2e7, 6e7], [2e4, 5e4]))).restore(
            state
        )


def test_left_and_right_are_mirror_images() -> None:
    rails = support([2e7, 5e7], [2e4, 5e4])
    one = Contact(wheelset(track__rail_support=rails)).step(y=2e-3, yaw=1e-3, time_step=1e-3)
    two = Contact(wheelset(track__rail_support=rails)).step(y=-2e-3, yaw=-1e-3, time_step=1e-3)
    u, v = one["left"]["rail_deflection"], two["right"]["rail_deflection"]
    assert u == pytest.approx([-v[0], v[1]], rel=1e-6)


def test_lift_off_and_return() -> None:
    """The wheel leaves faster than the rail follows, and meets it again."""
    rails = support([2e7, 5e7], [2e4, 2e5])
    contact = Contact(wheelset(wheelset__z=3e-4, track__rail_support=rails))
    contact.step()
    states = []
    for z in (3e-4, 1e-4, 5e-5, 0.0, -1e-4, 0.0, 1e-4, 2e-4, 3e-4):
        found = contact.step(z=z, time_step=1e-4)
        states.append(found.status)
        loads = [-found[side]["force"][2] for side in SIDES]
        assert min(loads) >= 0
    assert set(states) == {"converged", "no_contact"}
    assert states[-1] == "converged"


def test_a_solve_that_fails_says_so() -> None:
    rails = support([0.0, 1e12], [0.0, 0.0])
    deep = solve(wheelset(wheelset__z=0.02, track__rail_support=rails))
    assert deep.status in ("out_of_range", "not_converged")
    far = solve(wheelset(wheelset__y=0.3, track__rail_support=rails))
    assert far.status == "out_of_range"
    assert far["left"]["rail_deflection"] is None


def test_the_stage_is_there_where_rails_deflect() -> None:
    for values, present in (
        ({}, False),
        ({"track__rail_support": support([0.0, 5e7], [0, 0.0])}, True),
    ):
        contact = Contact(wheelset(**values))
        stage = next(s for s in contact.stages() if s["name"] == "rail_support")
        assert stage["present"] is present
        assert (stage["bytes"] > 0) is present
        found = contact.step()
        assert (found["left"]["rail_deflection"] is not None) is present


@pytest.mark.parametrize(
    ("rails", "key"),
    [
        (support([-1.0, 1e7], [0.0, 0.0]), r"track\.rail_support\.stiffness"),
        (support([0.5, 1e7], [0.0, 0.0]), r"track\.rail_support\.stiffness"),
        (support([0.0, 0.0], [0.0, 0.0]), r"track\.rail_support\.stiffness"),
        (support([0.0, 1e7], [1.0, 0.0]), r"track\.rail_support\.damping"),
        ({"damping": [0.0, 0.0]}, r"track\.rail_support\.stiffness"),
    ],
)
def test_what_is_refused(rails: dict[str, Any], key: str) -> None:
    with pytest.raises(CaseError, match=key):
        Contact(wheelset(track__rail_support=rails))


def test_transient_contact_on_springs() -> None:
    """Tractions of the last step and deflections of the rails go on together."""
    rails = support([2e7, 5e7], [2e4, 5e4])
    case = wheelset(
        track__rail_support=rails,
        grid={"element_size": [1.5e-3, 1.5e-3], "max_elements": [40, 40]},
        method={"normal": "half_space", "tangential": "full", "tolerance": TOLERANCE},
        motion={"regime": "transient_rolling"},
        wheelset__time_step=1e-4,
    )
    dt, old, results = 1e-4, None, []
    contact = Contact(case)
    for step in range(6):
        state = contact.save()
        found = contact.step(y=2e-5 * step, vy=0.2, time_step=dt)
        assert found.status == "converged"
        for k, (stiffness, damping) in enumerate(((2e7, 2e4), (5e7, 5e4))):
            assert max(residuals(found, stiffness, damping, k, dt, old)) <= 1.01 * TOLERANCE
        old = {side: found[side]["rail_deflection"] for side in SIDES}
        results.append(found)
    contact.restore(state)
    again = contact.step(y=1e-4, vy=0.2, time_step=dt)
    assert again.to_dict()["left"] == results[-1].to_dict()["left"]
