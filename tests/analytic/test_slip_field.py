"""Rigid slip of each element.

A field that is the same everywhere is a creepage, one that turns about the origin a spin: forces,
tractions and powers are those of creepage and spin, whatever else acts. What no creepages make is
balanced: friction takes what the whole rigid slip supplies, sum p . w dA, and in steps that go on
from each other less what the tractions' elastic energy grows by.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
import railpatch
from patch_cases import STEEL
from railpatch import CaseError, Contact

NX, NY = 14, 12
DX, DY = 5e-4, 6e-4
X = (np.arange(NX) - (NX - 1) / 2) * DX
Y = (np.arange(NY) - (NY - 1) / 2) * DY
GAP = [[1.2 * x * x + 1.0 * y * y for x in X] for y in Y]
XI, ETA, PHI = 1.1e-3, -4e-4, 0.3


def rotation(phi: float) -> np.ndarray:
    """-, [2, NY, NX], of a rigid motion with this spin."""
    grid = np.meshgrid(X, Y)
    return np.array([XI - phi * grid[1], ETA + phi * grid[0]])


ROTATION = rotation(PHI)
SPEED = 5.0
STEADY = {"regime": "steady_rolling"}
SHIFT = {"regime": "shift", "steps": 2}
ROLLING = {"regime": "transient_rolling", "distance": 1.3e-3, "steps": 3}
# by name: motion and tables besides
SCENES: dict[str, tuple[dict[str, Any], dict[str, Any]]] = {
    "steady": (STEADY, {}),
    "backwards": (STEADY | {"direction": -1}, {}),
    "shift": (SHIFT, {}),
    "transient": (ROLLING, {}),
    "unlike": (STEADY, {"material": {"shear_modulus": [82e9, 160e9], "poisson_ratio": 0.28}}),
    "unlike transient": (
        ROLLING,
        {"material": {"shear_modulus": [82e9, 160e9], "poisson_ratio": 0.28}},
    ),
    "falling": (
        STEADY,
        {
            "friction": {
                "law": "slip_velocity",
                "kinetic": 0.2,
                "amplitude": 0.15,
                "halving_speed": 0.01,
            }
        },
    ),
    "yielding": (
        ROLLING,
        {"layer": {"shear_modulus": 1e9, "thickness": 2e-5, "yield_stress": 1e8, "hardening": 0.0}},
    ),
    "warm": (STEADY, {"temperature": {}}),
}


def case(motion: dict[str, Any], more: dict[str, Any]) -> dict[str, Any]:
    found: dict[str, Any] = {
        "kind": "patch",
        "material": STEEL,
        "geometry": {"undeformed_distance": GAP},
        "load": {"normal_force": 9e3},
        "grid": {"element_size": [DX, DY]},
        "motion": {"rolling_speed": SPEED, **motion},
        "friction": {"coefficient": 0.3},
        "method": {"tolerance": 1e-10, "max_iterations": 200, "spin_offset": "automatic"},
    }
    found |= more
    # the spin is read where the elements are
    if motion["regime"] != "shift":
        found["method"]["spin_offset"] = "none"
    return found


@pytest.mark.parametrize("name", SCENES)
def test_a_rigid_motion_is_creepage_and_spin(name: str) -> None:
    """Forces within 1e-7 of friction times load, powers within 1e-6 of the greatest they can be.

    In transient rolling the power of spin is that of the moments at both ends, where elements were
    and are; that of a field takes the slip where they are: equal without spin.
    """
    motion, more = SCENES[name]
    unit = 1e-3 if name == "shift" else 1.0
    phi = 0.0 if "distance" in motion else PHI
    by_numbers = motion | {"creepage": [unit * XI, unit * ETA], "spin_creepage": unit * phi}
    wanted = railpatch.solve(case(by_numbers, more), fields=True)
    by_field = motion | {"slip_field": (unit * rotation(phi)).tolist()}
    found = railpatch.solve(case(by_field, more), fields=True)
    assert wanted.good, wanted.reason
    assert found.good, found.reason
    bound = 0.35 * 9e3
    np.testing.assert_allclose(found["creep_force"], wanted["creep_force"], atol=1e-7 * bound)
    np.testing.assert_allclose(found["traction"], wanted["traction"], atol=1e-6 * 1e9)
    power = bound * unit * 2e-3 * (1 if name == "shift" else SPEED)
    for key in ("creep_power", "friction_power", "plastic_power"):
        np.testing.assert_allclose(found[key], wanted[key], atol=1e-6 * power, err_msg=key)
    if name == "warm":
        rise = wanted["max_temperature"]
        np.testing.assert_allclose(found["max_temperature"], rise, rtol=1e-5)


def some_field(seed: int) -> np.ndarray:
    """-, no rigid motion."""
    return 1e-3 * np.random.default_rng(seed).normal(size=(2, NY, NX))


def test_friction_takes_what_the_slip_supplies() -> None:
    """Steady rolling: from the tractions, beside creepages."""
    slip = some_field(1)
    motion = STEADY | {"creepage": [5e-4, 2e-4], "slip_field": slip.tolist()}
    result = railpatch.solve(case(motion, {}), fields=True)
    assert result.good
    whole = slip + np.array([5e-4, 2e-4])[:, None, None]
    supplied = -SPEED * np.sum(result["traction"] * whole) * DX * DY
    assert result["creep_power"] == pytest.approx(supplied, rel=1e-9)
    assert result["friction_power"] == pytest.approx(supplied, rel=1e-6)
    assert np.isnan(list(result["error_estimate"].values())[:2]).all()


def test_energy_of_steps_is_balanced() -> None:
    """Transient rolling by whole elements: supplied is the mean of both ends' tractions, where the
    material is now; friction takes it but for what the elastic energy grows by."""
    motion = {"regime": "transient_rolling", "distance": DX, "slip_field": some_field(2).tolist()}
    contact = Contact(case(motion, {}))
    before = contact.step(fields=True)
    for seed in (3, 4, 5):
        slip = some_field(seed)
        now = contact.step(fields=True, slip_field=slip)
        assert now.good
        moved = np.zeros_like(slip)
        moved[:, :, :-1] = before["traction"][:, :, 1:]  # upstream is ahead
        supplied = -SPEED * 0.5 * np.sum((now["traction"] + moved) * slip) * DX * DY
        assert now["creep_power"] == pytest.approx(supplied, rel=1e-9)
        stored = [
            r["elastic_energy"] - r["pressure_energy"] for r in (before, now)
        ]  # of tractions alone: bodies alike
        grown = (stored[1] - stored[0]) * SPEED / DX
        assert now["friction_power"] == pytest.approx(supplied - grown, rel=1e-7)
        before = now


def test_with_a_prescribed_force_the_creepage_makes_up() -> None:
    """A field of the same everywhere is found again in the creepage, with the other sign."""
    motion = STEADY | {"tangential_force": [-1500.0, "creepage"]}
    plain = railpatch.solve(case(motion, {}))
    field = np.zeros((2, NY, NX))
    field[0] = 7e-4
    shifted = railpatch.solve(case(motion | {"slip_field": field.tolist()}, {}))
    assert shifted["creepage"][0] == pytest.approx(plain["creepage"][0] - 7e-4, abs=1e-9)


def test_a_saved_contact_knows_its_slip() -> None:
    """The next step of a restored one is the same to the bit; standstill has none."""
    contact = Contact(case(ROLLING | {"slip_field": some_field(2).tolist()}, {}))
    contact.step()
    contact.step(slip_field=some_field(6))
    state = contact.save()
    wanted = contact.step(normal_force=8e3)["creep_force"]
    contact.restore(state)
    assert contact.step(normal_force=8e3)["creep_force"] == wanted
    at_rest = Contact(case(STEADY | {"slip_field": some_field(2).tolist()}, {}))
    assert at_rest.step(rolling_speed=0.0)["creep_force"] == [0.0, 0.0]


REFUSED = [
    ({"geometry": {"semi_axes": [3e-3, 3e-3]}}, "motion.slip_field: value is given"),
    ({"method": {"tangential": "fastsim"}}, "value is 'fastsim', allowed 'full'"),
    ({"method": {"derivatives": True}}, "method.derivatives: value is True, allowed False"),
    ({"geometry": {"undeformed_distance": GAP[:-1]}}, "of another shape, allowed twice 11 rows"),
    (
        {"fluid": {"model": "film", "roughness": 1e-6, "liquid": "water", "water_rate": 1e-7}},
        "fluid: value is given",
    ),
]


@pytest.mark.parametrize(("more", "problem"), REFUSED)
def test_what_has_no_slip_by_element(more: dict[str, Any], problem: str) -> None:
    """Refused by name."""
    motion = STEADY | {"slip_field": ROTATION.tolist()}
    with pytest.raises(CaseError, match=r"(?s)" + problem.replace(".", r"\.")):
        railpatch.solve(case(motion, more))


def test_steps_refuse_another_shape() -> None:
    """Also where the grid is a file's; states at once and scenes without one have none."""
    contact = Contact(case(STEADY | {"slip_field": ROTATION.tolist()}, {}))
    contact.step()
    with pytest.raises(CaseError, match=r"motion\.slip_field"):
        contact.step(slip_field=ROTATION[:, :-1])
    with pytest.raises(CaseError, match=r"motion\.slip_field"):
        railpatch.solve_many(contact.case.model_dump(exclude_none=True), {"normal_force": [1e3]})
    without = Contact(case(STEADY, {}))
    with pytest.raises(CaseError, match="slip_field"):
        without.step(slip_field=ROTATION)
