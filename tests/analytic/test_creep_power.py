"""Power of creepages and spin, and the sums of powers and energies over patches and wheels."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
import railpatch
from case_samples import PATCH, WHEELSET, with_values
from railpatch.case.theories import FAST
from railpatch.evidence.continuity.scenes import wheel_case
from railpatch.result import TOTAL_UNITS

THEORIES = (*FAST, "full")
BY_SHARE = ("creep_power", "friction_power", "plastic_power", "elastic_energy")
GREATEST = ("max_temperature", "residual")
CREEPAGE, SPIN, SPEED = [8e-4, -5e-4], 2.0, 25.0
LAYER = {"thickness": 20e-6, "shear_modulus": 8e9, "yield_stress": 2e8}
# both wheels roll askew, one towards the flange
ASKEW = with_values(
    WHEELSET,
    wheelset__y=1e-3,
    wheelset__roll=-5e-5,
    wheelset__yaw=3e-3,
    wheelset__vy=1e-2,
    wheelset__z=None,
    wheelset__vertical_force=1e5,
)


def supplied(patch: Any, speed: float) -> float:
    """W, of the creepages and the spin."""
    force, creepage = patch["creep_force"], patch["creepage"]
    turning = patch["spin_moment"] * patch["spin_creepage"]
    return float(-(np.dot(force, creepage) + turning) * speed)


def patch_with(theory: str, **values: Any) -> dict[str, Any]:
    """A patch that creeps and spins, mostly sliding."""
    grid = {} if theory in ("full", "fastsim", "fastrip") else {"method__normal": "hertz"}
    return with_values(
        PATCH,
        method__tangential=theory,
        motion__creepage=CREEPAGE,
        motion__spin_creepage=SPIN,
        motion__rolling_speed=SPEED,
        **{**grid, **values},
    )


@pytest.mark.parametrize("theory", THEORIES)
@pytest.mark.parametrize("direction", [1, -1])
def test_of_a_patch(theory: str, direction: int) -> None:
    result = railpatch.solve(patch_with(theory, motion__direction=direction))
    data = {**result.data, "creepage": CREEPAGE, "spin_creepage": SPIN}
    assert result["creep_power"] == pytest.approx(supplied(data, SPEED), rel=1e-12)
    # Polach's lateral force by spin, without a moment, may give power
    assert result["creep_power"] > 0 or theory == "polach"


@pytest.mark.parametrize("theory", THEORIES)
def test_of_wheels(theory: str) -> None:
    result = railpatch.solve(with_values(ASKEW, method__tangential=theory))
    patches = [p for side in ("left", "right") for p in result[side]["patches"]]
    assert len(patches) > 1
    for patch in patches:
        wanted = supplied(patch, patch["rolling_speed"])
        assert patch["creep_power"] == pytest.approx(wanted, rel=1e-12)
        assert wanted != 0


def test_what_friction_and_layer_take_of_it() -> None:
    """All of it in the full theory; where theories differ: FASTSIM, and Polach by the spin."""
    full = railpatch.solve(patch_with("full", method__tolerance=1e-8))
    assert full["friction_power"] == pytest.approx(full["creep_power"], rel=1e-6)
    yields = railpatch.solve(patch_with("full", layer=LAYER, method__tolerance=1e-8))
    taken = yields["friction_power"] + yields["plastic_power"]
    assert yields["plastic_power"] > 0.1 * taken
    assert taken == pytest.approx(yields["creep_power"], rel=1e-6)
    polach = railpatch.solve(patch_with("polach"))
    assert abs(polach["friction_power"] / polach["creep_power"] - 1) > 0.1
    fastsim = railpatch.solve(patch_with("fastsim"))
    assert abs(fastsim["friction_power"] / fastsim["creep_power"] - 1) > 0.01


def test_of_a_shift_it_is_work() -> None:
    case = with_values(
        PATCH,
        motion={"regime": "shift", "creepage": [1e-5, 2e-5], "spin_creepage": 1e-4},
    )
    result = railpatch.solve(case)
    data = {**result.data, "creepage": [1e-5, 2e-5], "spin_creepage": 1e-4}
    # what friction takes and tractions store; force and moment grow from nothing, ever less, to
    # what they are now
    stored = result["elastic_energy"] - result["pressure_energy"]
    assert result["creep_power"] == pytest.approx(result["friction_power"] + stored, rel=1e-12)
    assert 0.5 * supplied(data, 1.0) < result["creep_power"] < supplied(data, 1.0)


def test_nothing_at_standstill_and_where_nothing_rolls() -> None:
    assert railpatch.solve(with_values(PATCH, motion__rolling_speed=0.0))["creep_power"] == 0
    none = railpatch.solve(with_values(PATCH, method__tangential="none", friction=None))
    assert np.isnan(none["creep_power"])
    apart = railpatch.solve(with_values(WHEELSET, wheelset__z=-5e-3))
    assert apart.status == "no_contact"
    for whole in (apart.data, apart["left"], apart["right"]):
        assert whole["creep_power"] == whole["friction_power"] == whole["elastic_energy"] == 0
        assert whole["contact_power"] == 0
        assert np.isnan(whole["plastic_power"])
        assert np.isnan(whole["max_temperature"])


@pytest.mark.parametrize(
    "changes",
    [
        {"method__tangential": "fastsim"},
        {"method__tangential": "polach"},
        {"layer": LAYER, "method__normal": "half_space"},
        {"temperature": {"wheel": 20.0, "rail": 10.0}},
    ],
    ids=["fastsim", "polach", "yields", "warm"],
)
def test_sums_are_those_of_all_patches_by_share(changes: dict[str, Any]) -> None:
    # one wheel lies between one patch and two, the wheels of the other lift off in turn
    joining = with_values(wheel_case(1e4), **changes, wheelset__y=5.21e-3)
    check_sums(railpatch.solve(joining).data, patches=3)
    for y in (-4e-3, 0.0, 1e-3, 6e-3):
        result = railpatch.solve(with_values(ASKEW, **changes, wheelset__y=y))
        wheels = [result[side] for side in ("left", "right")]
        for wheel in wheels:
            check_sums(wheel)
        for name in TOTAL_UNITS.keys() - {"status", "reason", "warnings", "force", "moment", "z"}:
            of = max if name in GREATEST else sum
            wanted = of(wheel[name] for wheel in wheels)
            assert result[name] == pytest.approx(wanted, rel=1e-12, nan_ok=True), name


def check_sums(wheel: dict[str, Any], patches: int | None = None) -> None:
    """patches: how many there are with the alternatives."""
    found = wheel["patches"] + wheel["alternatives"]
    assert patches in (None, len(found))
    for name in BY_SHARE if found else ():
        wanted = sum(patch["share"] * patch[name] for patch in found)
        assert wheel[name] == pytest.approx(wanted, rel=1e-12, nan_ok=True), name
    for name in GREATEST if found else ():
        wanted = max(patch[name] for patch in found)
        assert wheel[name] == pytest.approx(wanted, rel=0, nan_ok=True), name


def test_contact_power_is_force_and_moment_times_velocities() -> None:
    """With roll, yaw and all rates: angular velocity by small turns of the attitude."""
    state = {"roll": 2e-3, "yaw": 3e-3, "roll_rate": 0.02, "yaw_rate": -0.03, "pitch_rate": -4.4}
    case = with_values(ASKEW, **{f"wheelset__{k}": v for k, v in state.items()}, wheelset__vz=0.01)
    result = railpatch.solve(case)

    def attitude(time: float) -> np.ndarray:
        roll, yaw, pitch = (
            state.get(name, 0.0) + time * state[f"{name}_rate"] for name in ("roll", "yaw", "pitch")
        )
        found = np.eye(3)
        for axis, turn in ((0, roll), (2, yaw), (1, pitch)):
            one, two = [k for k in range(3) if k != axis]
            matrix = np.eye(3)
            matrix[one, one] = matrix[two, two] = np.cos(turn)
            matrix[two, one], matrix[one, two] = np.sin(turn), -np.sin(turn)
            found = found @ (matrix.T if axis == 1 else matrix)
        return found

    step = 1e-6
    rate = (attitude(step) - attitude(-step)) / (2 * step) @ attitude(0.0).T
    spin = np.array([rate[2, 1], rate[0, 2], rate[1, 0]])
    velocity = [case["wheelset"]["speed"], case["wheelset"]["vy"], 0.01]
    for whole in (result.data, result["left"], result["right"]):
        wanted = np.dot(whole["force"], velocity) + np.dot(whole["moment"], spin)
        scale = np.linalg.norm(whole["force"]) * velocity[0]
        assert whole["contact_power"] == pytest.approx(wanted, abs=1e-8 * scale)


@pytest.mark.parametrize("name", ["creepage", "spin_creepage", "rolling_speed"])
def test_its_rate(name: str) -> None:
    case = patch_with("full", method__derivatives=True, method__tolerance=1e-10)
    contact = railpatch.Contact(case)
    contact.step()
    seed = [1e-3, 2e-3] if name == "creepage" else 1.0
    change = contact.differentiate(**{name: seed})
    step, ends = 1e-4 if name == "rolling_speed" else 1e-5, []
    for way in (-step, step):
        here = np.asarray(case["motion"][name]) + way * np.asarray(seed)
        moved = with_values(case, **{f"motion__{name}": here.tolist()})
        ends.append(railpatch.solve(moved)["creep_power"])
    wanted = (ends[1] - ends[0]) / (2 * step)
    assert change["creep_power"] == pytest.approx(wanted, rel=1e-4)
