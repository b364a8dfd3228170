"""Friction laws on wheels: what the same patch gives alone, and what they do in a run of steps.

The patch takes the wheel's own undeformed distance, creepages and rolling speed. Its reference is
the middle of its grid: creepages are those of the rigid slip there.
"""

from __future__ import annotations

import copy
from collections.abc import Iterator
from typing import Any, get_args

import numpy as np
import pytest
import railpatch
from case_samples import WHEELSET, with_values
from law_samples import FALLING, LAWS
from railpatch import _core
from railpatch.case.common import Layer, Temperature
from railpatch.case.friction import Friction
from railpatch.case.load import load_scene
from railpatch.case.to_core import config_of, input_of

# over the wheel's place on the track, by wheel, and over time: a patch has none
NO_LAW = {"along_track", "scale", "bulk"}
RADIUS, SPEED = 0.46, 10.0
SIZE = 6e-4  # m, of the elements
TIME_STEP = 0.7 * SIZE / SPEED
STEPS = 8

POSES: dict[str, dict[str, Any]] = {
    "rail": {"wheelset": {"y": 1e-3, "yaw": 1e-3}},
    "backwards": {"wheelset": {"y": 1e-3, "yaw": 1e-3, "speed": -SPEED}},
    "near standstill": {"wheelset": {"y": 1e-3, "vy": 2e-7, "speed": 4e-4}},
    "roller": {
        "wheelset": {"y": 1e-3, "yaw": 1e-3, "speed": 0.0},
        "track": {"kind": "roller", "roller_radius": 1.0, "roller_pitch_rate": SPEED},
    },
}


def wheel_case(law: str, pose: str, **values: Any) -> dict[str, Any]:
    """One wheel, some of its patch in slip."""
    case = {**copy.deepcopy(WHEELSET), "kind": "wheel_rail", "grid": {"element_size": [SIZE] * 2}}
    case |= copy.deepcopy(LAWS[law])
    case["wheelset"] |= {"z": 1.6e-4, **POSES[pose]["wheelset"]}
    case["track"] |= POSES[pose].get("track", {})
    rolling = case["wheelset"]["speed"] or SPEED
    case["wheelset"]["pitch_rate"] = -1.002 * rolling / RADIUS
    case["method"] = {"tolerance": 1e-9}
    return with_values(case, **values)


def patch_of(result: dict[str, Any]) -> dict[str, Any]:
    (patch,) = result["right"]["patches"]
    return patch


def alike(case: dict[str, Any], wheel: Any, patch: dict[str, Any]) -> railpatch.Contact:
    """The wheel's patch as a case of its own."""
    nx, ny = patch["grid"]
    x, y = (patch["grid_origin"][k] + 0.5 * (patch["grid"][k] - 1) * SIZE for k in range(2))
    spin, (xi, eta) = patch["spin_creepage"], patch["creepage"]
    motion = {
        "creepage": [xi - spin * y, eta + spin * x],
        "spin_creepage": spin,
        "rolling_speed": patch["rolling_speed"],
        "direction": patch["direction"],
    }
    if "motion" in case:
        step = case["wheelset"]["time_step"]
        motion |= {"regime": "transient_rolling", "distance": step * patch["rolling_speed"]}
    gap = wheel.field(1, 0, "undeformed_distance").reshape(ny, nx)
    own = {
        name: case[name]
        for name in ("friction", "layer", "temperature", "material", "method")
        if name in case
    }
    return railpatch.Contact(
        {
            "kind": "patch",
            "geometry": {"undeformed_distance": gap},
            "load": {"approach": 0.0},
            "grid": {"element_size": [SIZE, SIZE]},
            "motion": motion,
            **own,
        }
    )


def pairs(case: dict[str, Any], steps: int) -> Iterator[tuple[dict[str, Any], Any]]:
    """Results of the wheel's patch and of the patch alone, step by step."""
    scene = load_scene(case)
    wheel, values = _core.Contact(config_of(scene), False), input_of(scene.case)
    patch = patch_of(wheel.step(values))
    alone = alike(case, wheel, patch)
    for _ in range(steps):
        yield patch, alone.step()
        patch = patch_of(wheel.step(values))


def check_alike(case: dict[str, Any], steps: int) -> None:
    for patch, alone in pairs(case, steps):
        assert patch["status"] == alone.status == "converged"
        force = np.array(patch["creep_force"])
        # forces far below what friction carries are known to the tolerance only, 1e-9 of that
        size = max(np.abs(force).max(), 1e-3 * patch["normal_force"])
        assert np.abs(np.array(alone["creep_force"]) - force).max() <= 1e-6 * size
        for name in ("normal_force", "friction_power", "elastic_energy"):
            assert alone[name] == pytest.approx(patch[name], rel=1e-6), name
    if patch["rolling_speed"] > 0.1:
        assert alone["elements"]["slip"] + alone["elements"].get("plastic", 0) > 20


@pytest.mark.parametrize("pose", POSES)
@pytest.mark.parametrize("law", LAWS)
def test_steady(law: str, pose: str) -> None:
    check_alike(wheel_case(law, pose), 2)


@pytest.mark.parametrize("pose", POSES)
@pytest.mark.parametrize("law", LAWS)
def test_transient(law: str, pose: str) -> None:
    case = wheel_case(law, pose, wheelset__time_step=TIME_STEP)
    case["motion"] = {"regime": "transient_rolling"}
    cannot = refused_in_transient_rolling(LAWS[law])
    if cannot:
        with pytest.raises(railpatch.CaseError) as caught:
            railpatch.Contact(case)
        assert [text.partition(":")[0] for text in caught.value.problems] == cannot
        return
    check_alike(case, STEPS)


def refused_in_transient_rolling(law: dict[str, Any]) -> list[str]:
    """Keys of what a wheel's material would have to carry along, heat and plastic displacement, and
    of bodies that couple both problems."""
    layer = law.get("layer", {})
    yields = [key for key in ("hardening_table", "yield_stress") if key in layer]
    return [
        *(["friction.law"] if law["friction"].get("law") == "temperature" else []),
        *(f"layer.{key}" for key in yields),
        *(["temperature"] if "temperature" in law else []),
        *(["material"] if "material" in law else []),
    ]


def words(model: Any, key: str) -> set[str]:
    return set(get_args(model.model_fields[key].annotation))


def test_no_law_is_missing() -> None:
    """Every law and shape of the schema, and every key of friction, layer and temperature."""
    given = {"friction": Friction, "layer": Layer, "temperature": Temperature}
    for table, model in given.items():
        found = [law[table] for law in LAWS.values() if table in law]
        assert {key for one in found for key in one} >= set(model.model_fields) - NO_LAW, table
    friction = [law["friction"] for law in LAWS.values()]
    assert {one.get("law", "coulomb") for one in friction} == words(Friction, "law")
    falling = [one for one in friction if one.get("law") == "slip_velocity"]
    assert {one.get("shape", "exponential") for one in falling} == words(Friction, "shape")
    rules = {law["layer"].get("plastic_rule", "path") for law in LAWS.values() if "layer" in law}
    assert rules == words(Layer, "plastic_rule")


@pytest.mark.parametrize("pose", POSES)
@pytest.mark.parametrize("theory", ["fastsim", "fastrip", "polach"])
def test_fast_theories(theory: str, pose: str) -> None:
    case = wheel_case("exponential", pose, method__tangential=theory)
    for patch, alone in pairs(case, 2):
        assert patch["status"] == alone.status == "converged"
        force = np.array(patch["creep_force"])
        size = max(np.abs(force).max(), 1e-3 * patch["normal_force"])
        assert np.abs(np.array(alone["creep_force"]) - force).max() <= 1e-6 * size
        assert alone["friction_power"] == pytest.approx(patch["friction_power"], rel=1e-6)


@pytest.mark.parametrize(
    "normal", ["hertz", "kik_piotrowski", "kik_piotrowski_corrected", "analyn"]
)
def test_approximate_pressures_fall_too(normal: str) -> None:
    """With Coulomb friction between the law's coefficients at rest and at high speed."""
    forces = []
    for friction in ({"coefficient": 0.35}, FALLING, {"coefficient": 0.12}):
        case = wheel_case("coulomb", "rail", method__normal=normal, friction=friction)
        forces.append(np.linalg.norm(railpatch.solve(case)["patches"][0]["creep_force"]))
    assert 0.97 * forces[0] > forces[1] > 1.03 * forces[2]


def test_the_memory_moves_with_the_material() -> None:
    """A contact that drifts over the rail: whole elements give the bits of one that stays."""
    law = {**FALLING, "memory_distance": 3e-3}
    found = {}
    for drift in (0.0, 0.5, 1.0):
        case = wheel_case("coulomb", "rail", friction=law, wheelset__time_step=TIME_STEP)
        case["motion"] = {"regime": "transient_rolling"}
        case["wheelset"]["pitch_rate"] *= 1.01
        case["track"] |= {"right": {"offset": [0.0, 0.0, 0.0]}}
        contact = railpatch.Contact(case)
        forces = []
        for step in range(12):
            # wheel and rail move together: nothing of the contact changes but its place
            y = drift * SIZE * step
            result = contact.step(y=1e-3 + y, track={"right": {"offset": [0.0, y, 0.0]}})
            assert result.status == "converged"
            forces.append(result["patches"][0]["creep_force"])
        found[drift] = np.array(forces)
    for drift in (0.5, 1.0):
        assert found[drift] == pytest.approx(found[0.0], rel=1e-7)
    # the memory counts: without it friction falls at once
    case["friction"] = FALLING
    plain = railpatch.Contact(case)
    last = [plain.step() for _ in range(12)][-1]["patches"][0]["creep_force"]
    assert np.abs(last - found[0.0][-1]).max() > 0.02 * np.abs(last).max()


@pytest.mark.parametrize("regime", ["steady_rolling", "transient_rolling"])
@pytest.mark.parametrize("track", ["rail", "roller"])
@pytest.mark.parametrize("load", ["z", "vertical_force"])
def test_rates_are_those_of_the_law(load: str, track: str, regime: str) -> None:
    """Against central differences of contacts of their own, finely solved."""
    law = {**FALLING, "halving_speed": 0.3, "memory_distance": 1e-3}
    case = wheel_case("coulomb", track, friction=law, wheelset__y=6e-4)
    case["motion"] = {"regime": regime}
    if regime == "transient_rolling":
        case["wheelset"]["time_step"] = TIME_STEP
    case["method"] = {"derivatives": True}
    if load == "vertical_force":
        case = with_values(case, wheelset__z=None, wheelset__vertical_force=7e4)
    fine = with_values(case, method={"tolerance": 1e-10})
    base = case["wheelset"]
    contact = railpatch.Contact(case)
    for _ in range(3):
        contact.step()
    steps = {"pitch_rate": 2e-5, "yaw": 2e-6, "vy": 1e-5, "vz": 1e-4}
    if track == "rail":
        steps["speed"] = 1e-5
    for key, length in steps.items():
        rate = np.array(contact.differentiate(**{key: 1.0})["force"])
        ends = []
        for sign in (-1, 1):
            other = railpatch.Contact(fine)
            for _ in range(2):
                other.step()
            moved = other.step(**{key: base.get(key, 0.0) + sign * length})
            ends.append(np.array(moved["force"]))
        wanted = (ends[1] - ends[0]) / (2 * length)
        # one of some hundred elements that begins to slip between the ends changes both a little
        assert np.abs(rate - wanted).max() <= 5e-4 * np.abs(wanted).max(), key


def test_no_speed_no_fall() -> None:
    """At rest friction keeps its value there, and what the rails' speed adds falls as on a wheel
    that rolls."""
    law = {**FALLING, "memory_distance": 8e-4}
    slow = [wheel_case("coulomb", "rail", friction=law, wheelset__speed=v) for v in (1e-9, 1e-3)]
    for case in slow:
        case["wheelset"]["pitch_rate"] = -1.002 * case["wheelset"]["speed"] / RADIUS
    still = wheel_case("coulomb", "rail", friction={"coefficient": 0.35})
    still["wheelset"] |= {"speed": 1e-9, "pitch_rate": -1.002e-9 / RADIUS}
    forces = [
        np.array(railpatch.solve(case)["patches"][0]["creep_force"]) for case in (slow[0], still)
    ]
    assert forces[0] == pytest.approx(forces[1], rel=1e-6)
