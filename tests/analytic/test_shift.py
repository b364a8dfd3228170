"""Shift of a sphere on a plane under tangential force: Cattaneo's closed form.

Cattaneo 1938; Mindlin 1949; Johnson 1985, section 7.2: a tangential force Q < mu F_n leaves a stick
circle of radius c = a (1 - Q/(mu F_n))^(1/3) and shifts the bodies by
(3 mu F_n/(16 a)) ((2 - nu_1)/G_1 + (2 - nu_2)/G_2) (1 - (c/a)^2), in units here for two equal
bodies. The case: a sphere of 50 mm with a = 1 mm, Q = 7/8 mu F_n, so c = a/2 and 0.00817 mm. The
closed form leaves out that slip has a small component across Q.
"""

from __future__ import annotations

import numpy as np
import pytest
import railpatch
from patch_cases import Line, check, modulus, solve

MATERIAL = {"shear_modulus": 200e6, "poisson_ratio": 0.42}
A, RADIUS, FRICTION = 1e-3, 0.05, 0.4
FORCE = 4 * modulus(MATERIAL) * A**3 / (3 * RADIUS)
LOAD = 7 / 8 * FRICTION * FORCE
SHIFT = 3 * FRICTION * FORCE / (8 * A) * (2 - 0.42) / 200e6 * 0.75


def case(elements: int = 41, **motion) -> dict:
    return {
        "kind": "patch",
        "material": dict(MATERIAL),
        "geometry": {"semi_axes": [A, A]},
        "load": {"normal_force": FORCE},
        "grid": {"elements": [elements, elements]},
        "motion": {"regime": "shift", **motion},
        "friction": {"coefficient": FRICTION},
        "method": {"tolerance": 1e-6},
    }


def test_shift_and_stick_radius() -> None:
    elements = 41
    forced = case(elements, tangential_force=[-LOAD, "creepage"])
    result = solve(forced, fields=True)
    x, y = np.meshgrid(result["x"], result["y"])
    radius, division = np.hypot(x, y), result["element_division"]
    element = 2 * A / elements
    check(
        [
            Line("normal force (N), reference 9.1954", FORCE, 9.1954, 1e-4),
            Line("shift (m)", result["creepage"][0], SHIFT, 0.005 * SHIFT),
            Line("reference 0.00817 mm (m)", SHIFT, 8.17e-6, 5e-9),
            Line("outermost stick (m)", radius[division == 1].max(), A / 2, element),
            Line("innermost slip (m)", radius[division == 2].min(), A / 2, element),
        ]
    )


def test_force_from_shift() -> None:
    result = solve(case(creepage=[SHIFT, 0.0]))
    check([Line("force (N)", result["creep_force"][0], -LOAD, 0.003 * LOAD)])


def test_many_steps_are_one() -> None:
    """Under growing load stick only shrinks: but for slip across, the path does not matter."""
    once = solve(case(creepage=[SHIFT, 0.0]))
    steps = solve(case(creepage=[SHIFT / 7, 0.0], steps=7))
    assert len(steps["steps"]) == 7
    assert steps["creep_force"][0] == pytest.approx(once["creep_force"][0], rel=1e-3)


def test_work_is_dissipated_or_stored() -> None:
    """Back and forth: work supplied, less the elastic energy gained, is friction's work. That is
    also what its elements take, each by the traction that it slides against: its own, of those
    that slid on the same way before the mean of both ends. The work of the force by the mean of
    both ends of each step is the same but for what is of second order in the steps."""
    contact = railpatch.Contact(case())
    first = contact.step(fields=True)
    at_rest, traction = first["elastic_energy"], np.array(first["traction"])
    area = np.diff(first["x"][:2])[0] * np.diff(first["y"][:2])[0]
    work = lost = rubbed = force = supplied = 0.0
    count = 24
    move = 0.75 * SHIFT / count
    for step in (*[move] * count, *[-move] * 2 * count, *[move] * 2 * count):
        result = contact.step(creepage=[step, 0.0], fields=True)
        assert result.status == "converged"
        # to the tolerance of the tractions; after a turn nearly all sticks
        assert result["friction_power"] >= -1e-6 * FRICTION * FORCE * abs(step)
        now, after = result["creep_force"][0], np.array(result["traction"])
        work -= 0.5 * (force + now) * step
        slid = np.hypot(*traction) > (1 - 1e-6) * FRICTION * np.array(result["pressure"])
        slid &= (traction * after).sum(axis=0) > 0
        against = np.where(slid, 0.5 * (traction + after), after)
        rubbed -= (against * result["micro_slip"]).sum() * area
        force, traction = now, after
        lost += result["friction_power"]
        supplied += result["creep_power"]
    assert lost == pytest.approx(supplied - (result["elastic_energy"] - at_rest), rel=1e-9)
    assert supplied == pytest.approx(work, rel=1e-3)
    assert rubbed == pytest.approx(lost, rel=1e-5)
    assert lost > 0.3 * work


def test_rotation_alone_has_no_force() -> None:
    result = solve(case(spin_creepage=2e-3))
    assert np.abs(result["creep_force"]).max() < 1e-6 * FRICTION * FORCE
    assert result["spin_moment"] < 0


def test_no_contact_forgets_tractions() -> None:
    moved = case(creepage=[SHIFT, 0.0])
    moved["geometry"] = {"curvatures": [10.0, 10.0]}
    moved["load"] = {"approach": A**2 / RADIUS}
    moved["grid"] = {"element_size": [1e-4, 1e-4], "max_elements": [24, 24]}
    contact = railpatch.Contact(moved)
    first = contact.step()
    again = contact.step()
    assert abs(again["creep_force"][0]) > abs(first["creep_force"][0])
    apart = contact.step(approach=-1e-6)
    assert apart.status == "no_contact"
    assert apart["creep_force"] == [0.0, 0.0]
    back = contact.step(approach=A**2 / RADIUS)
    np.testing.assert_allclose(back["creep_force"], first["creep_force"], rtol=1e-5, atol=1e-6)


def test_state_goes_on() -> None:
    contact = railpatch.Contact(case(creepage=[SHIFT / 2, 0.0]))
    contact.step()
    state = contact.save()
    first = contact.step()
    other = railpatch.Contact(case(creepage=[SHIFT / 2, 0.0]))
    other.restore(state)
    assert other.step()["creep_force"] == first["creep_force"]
    contact.reset()
    assert abs(contact.step()["creep_force"][0]) < abs(first["creep_force"][0])
