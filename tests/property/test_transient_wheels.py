"""Transient rolling of wheels: against a patch and steady rolling, and over flats and joints."""

from __future__ import annotations

import copy
from typing import Any

import numpy as np
import pytest
import railpatch
from case_samples import WHEELSET, with_values
from railpatch import _core
from railpatch.case.load import load_scene
from railpatch.case.to_core import config_of, input_of

RADIUS = 0.46
SIZE = 5e-4  # m, of the elements
UNSPRUNG, STATIC = 700.0, 5e4  # kg and N of one wheel
DAMPING = 3e5  # N s/m, of the track below the wheel
ROLLING = {"motion": {"regime": "transient_rolling"}}


def one_wheel(speed: float = 10.0, **values: Any) -> dict[str, Any]:
    case = with_values(copy.deepcopy(WHEELSET), grid__element_size=[SIZE, SIZE], **values)
    case["wheelset"].update(speed=speed, pitch_rate=-1.001 * speed / RADIUS)
    case["kind"] = "wheel_rail"
    return case


def rolling(time_step: float, **values: Any) -> dict[str, Any]:
    return {**one_wheel(wheelset__time_step=time_step, **values), **ROLLING}


def patch_of(result: Any) -> dict[str, Any]:
    (patch,) = result["patches"]
    return patch


def creep_force(result: Any) -> np.ndarray:
    return np.array(patch_of(result)["creep_force"])


def test_near_standstill_material_comes_from_where_it_was() -> None:
    """What creepages supply is by force and moment at both ends of the step, about one point. Below
    the standstill speed creepages refer to a greater speed than that of the way."""
    slow = {"wheelset__z": 1.6e-4, "wheelset__y": 1e-3, "wheelset__yaw": 1e-3}
    contact = railpatch.Contact(rolling(0.01, method__standstill_speed=1.0, **slow))
    before = np.zeros(3)
    for vy in (1e-3, 2e-3, -1e-3, 0.0):
        changes = {"speed": 0.5, "pitch_rate": -0.5 / RADIUS, "vy": vy}
        patch = patch_of(contact.step(**changes))
        now = np.array([*patch["creep_force"], patch["spin_moment"]])
        slip = np.array([*patch["creepage"], patch["spin_creepage"]]) * patch["rolling_speed"]
        supplied = -0.5 * (now + before) @ slip
        assert patch["creep_power"] == pytest.approx(supplied, rel=1e-9)
        before = now


POSE = {"wheelset__z": 1.5e-4, "wheelset__y": 1e-3, "wheelset__yaw": 1e-3}


def test_equals_the_patch_that_rolls_alike() -> None:
    """The same undeformed distance, creepages and distance rolled as kind = patch, every step."""
    scene = load_scene(rolling(0.7 * SIZE / 10.0, **POSE))
    wheel, values = _core.Contact(config_of(scene), False), input_of(scene.case)
    (patch,) = wheel.step(values)["right"]["patches"]
    nx, ny = patch["grid"]
    # the patch's reference is the middle of its grid: the rigid slip there
    x, y = (patch["grid_origin"][k] + 0.5 * (patch["grid"][k] - 1) * SIZE for k in range(2))
    spin, (xi, eta) = patch["spin_creepage"], patch["creepage"]
    alike = railpatch.Contact(
        {
            "kind": "patch",
            "geometry": {
                "undeformed_distance": wheel.field(1, 0, "undeformed_distance").reshape(ny, nx)
            },
            "load": {"approach": 0.0},
            "grid": {"element_size": [SIZE, SIZE]},
            "motion": {
                "regime": "transient_rolling",
                "creepage": [xi - spin * y, eta + spin * x],
                "spin_creepage": spin,
                "rolling_speed": patch["rolling_speed"],
                "distance": 0.7 * SIZE / 10.0 * patch["rolling_speed"],
            },
            "friction": {"coefficient": 0.3},
        }
    )
    for _ in range(12):
        force = alike.step()["creep_force"]
        # both solved to 1e-5
        assert force == pytest.approx(patch["creep_force"], rel=2e-5)
        (patch,) = wheel.step(values)["right"]["patches"]


@pytest.mark.parametrize("elements", [0.5, 1.0, 2.3])
def test_tends_to_steady_rolling(elements: float) -> None:
    """A step of one element is the step of steady rolling, so their limits are equal; others
    differ by their discretisation, about 1 % of the greatest force."""
    steady = railpatch.solve(one_wheel(**POSE))
    speed = patch_of(steady)["rolling_speed"]
    contact = railpatch.Contact(rolling(elements * SIZE / speed, **POSE))
    for _ in range(int(60 / elements)):
        result = contact.step()
    error = np.abs(creep_force(result) - creep_force(steady)).max()
    bound = 0.3 * patch_of(steady)["normal_force"]
    assert error < (1e-4 if elements == 1.0 else 1e-2) * bound


def test_the_reference_drifts_without_a_force() -> None:
    """Where steady rolling has no creep force but for spin, a wheelset moved sideways over the rail
    at 1 mm per metre sees what it sees at rest there, within what 0.1 mm of rolling changes."""
    case = rolling(0.5 * SIZE / 10.0, **POSE)
    moving = railpatch.Contact(case)
    y, differences = 1e-3, []
    for step in range(160):
        result = moving.step(y=y)
        y += 1e-3 * 0.5 * SIZE
        if step > 100:
            steady = railpatch.solve(one_wheel(**{**POSE, "wheelset__y": y}))
            differences.append(np.abs(creep_force(result) - creep_force(steady)).max())
    assert max(differences) < 1e-2 * 0.3 * patch_of(steady)["normal_force"]


def test_every_trial_height_starts_from_the_same_history() -> None:
    """With the force prescribed many heights are tried in a step; the same heights prescribed give
    the same forces."""
    case = rolling(0.8 * SIZE / 10.0, wheelset__z=None, wheelset__vertical_force=3e4)
    searched = railpatch.Contact(case)
    found = [searched.step(y=1e-5 * k) for k in range(12)]
    given = railpatch.Contact(rolling(0.8 * SIZE / 10.0))
    for k, result in enumerate(found):
        again = given.step(y=1e-5 * k, z=result["z"])
        # both solved to 1e-5
        assert again["force"] == pytest.approx(result["force"], abs=1e-4 * 3e4)


def test_a_saved_state_steps_to_the_same_bits() -> None:
    contact = railpatch.Contact(rolling(1e-4, wheelset__right={"flat": {"depth": 5e-4}}))
    for k in range(4):
        contact.step(pitch=-0.01 * k)
    state = contact.save()
    after = [contact.step(pitch=-0.01 * k)["force"] for k in range(4, 8)]
    contact.restore(state)
    assert [contact.step(pitch=-0.01 * k)["force"] for k in range(4, 8)] == after


def test_patches_that_join_and_part_keep_their_tractions() -> None:
    """From tread to flange, several solutions at a time: the creep forces of steps of half an
    element change no faster than those of steady rolling do, but for what is new to them."""
    force = {"wheelset__z": None, "wheelset__vertical_force": 6e4, "wheelset__yaw": 4e-3}
    coarse = {"grid__element_size": [1e-3, 1e-3]}
    contacts = {
        "steady": railpatch.Contact(with_values(one_wheel(**force), **coarse)),
        "transient": railpatch.Contact(with_values(rolling(5e-5, **force), **coarse)),
    }
    forces: dict[str, list[list[float]]] = {name: [] for name in contacts}
    patches = set()
    for step in range(470):
        y = 3e-3 + 1e-5 * max(step - 60, 0)
        for name, contact in contacts.items():
            result = contact.step(y=y)
            assert result["status"] == "converged", (name, y)
            forces[name].append(result["force"])
            patches.add(len(result["patches"] + result["alternatives"]))
    assert max(patches) > 1
    steady, transient = (np.array(forces[name])[60:] for name in ("steady", "transient"))
    change, reference = (np.abs(np.diff(f, axis=0)).max(axis=0) for f in (transient, steady))
    assert np.all(change[:2] < 1.2 * reference[:2]), (change, reference)
    assert np.abs(transient - steady).max() < 0.2 * np.abs(steady).max()


# --- through flats and joints ------------------------------------------------------------------

FLATS = {"30 mm": 2.5e-4, "60 mm": 1e-3}  # m, depth
SHAPES = {
    **{f"flat of {name}": {"wheelset__right": {"flat": {"depth": d}}} for name, d in FLATS.items()},
    "dipped joint": {"track__right": {"joint": {"position": 0.0, "depth": 2e-3, "length": 0.3}}},
    "step up and gap": {"track__right": {"joint": {"position": 0.0, "step": 5e-4, "gap": 8e-3}}},
}


def run_over(shape: dict[str, Any], speed: float) -> tuple[list[Any], Any]:
    """Results of every step of an unsprung mass that rolls over the shape, and steady rolling."""
    coarse = {"grid__element_size": [1e-3, 1e-3]}
    still = {"wheelset__z": None, "wheelset__vertical_force": STATIC}
    steady = railpatch.solve(with_values(one_wheel(speed, **still), **coarse))
    time_step = min(2e-3 / speed, 4e-4)
    length = 0.45 if speed < 5 else 1.8  # m, for it to settle
    contact = railpatch.Contact(with_values(rolling(time_step, **shape), **coarse))
    z, vz, x, results = steady["z"], 0.0, -0.2, []
    for _ in range(int(length / speed / time_step)):
        result = contact.step(
            z=z, vz=vz, x=x, pitch=-x / RADIUS, speed=speed, pitch_rate=-1.001 * speed / RADIUS
        )
        results.append(result)
        vz += time_step * (STATIC + result["force"][2] - DAMPING * vz) / UNSPRUNG
        z += time_step * vz
        x += time_step * speed
    return results, steady


@pytest.mark.parametrize("speed", [1.0, 30.0])
@pytest.mark.parametrize("shape", SHAPES)
def test_rolls_over_flats_and_joints_without_failure(shape: str, speed: float) -> None:
    """Every step converges or is a lift-off, and in the end all is as before."""
    results, steady = run_over(SHAPES[shape], speed)
    assert {r["status"] for r in results} <= {"converged", "no_contact"}
    forces = np.array([r["force"] for r in results])
    assert np.all(np.isfinite(forces))
    assert np.ptp(forces[:, 2]) > 0.2 * STATIC  # it was felt
    for result in (results[0], results[-1]):
        assert -result["force"][2] == pytest.approx(STATIC, rel=0.02)
    # 1 mm elements: discretisation of steps that are not one element
    error = np.abs(creep_force(results[-1]) - creep_force(steady)).max()
    assert error < 0.03 * 0.3 * STATIC


@pytest.mark.parametrize("shape", SHAPES)
def test_carries_a_given_force_over_flats_and_joints(shape: str) -> None:
    """The vertical force prescribed, all the way."""
    still = {"wheelset__z": None, "wheelset__vertical_force": STATIC}
    coarse = {"grid__element_size": [1e-3, 1e-3]}
    contact = railpatch.Contact(with_values(rolling(2e-4, **still, **SHAPES[shape]), **coarse))
    for x in np.linspace(-0.08, 0.08, 81):
        result = contact.step(x=float(x), pitch=float(-x / RADIUS))
        assert result["status"] == "converged"
        assert -result["force"][2] == pytest.approx(STATIC, rel=1e-4)
