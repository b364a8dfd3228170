"""Derivatives of wheels on real profiles, against central differences of steps.

Left out are differences with an event between their ends: a patch or an element that changes its
state, or the greatest depth passing from one element to the next. The C++ tests look at methods,
invariances, state and memory.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np
import pytest
from published_data import MANCHESTER, NRC
from railpatch import Contact
from railpatch.case.to_core import FORCE_AND_MOMENT, POSE_AND_VELOCITY
from railpatch.errors import CaseError

TOLERANCE = 1e-11
BOUND = 1e-5  # relative to the greatest entry of the row
# by column: what changes an input by a good part of what matters, and the step of the differences
USUAL = dict(
    zip(POSE_AND_VELOCITY, (1e-3, 1e-3, 1e-4, 1e-4, 1e-3, 1e-3, 1, *[0.01] * 4, 1), strict=True)
)
STEP = {"x": 1e-7, "y": 1e-8, "z": 1e-9, "roll": 1e-8, "yaw": 4e-7, "pitch": 1e-7}
OF_SPEED = 1e-6  # of the velocities, by the rolling speed
SIDES = ("left", "right")
ELEMENT = 5e-4  # m

RAIL: dict[str, Any] = {
    "kind": "wheelset",
    "wheelset": {
        "vertical_force": 1e5,
        "nominal_radius": 0.46,
        "flange_back_distance": 1.36,
        "flange_back_position": -0.07,
    },
    "track": {"kind": "rail", "gauge": 1.435, "gauge_height": 0.014},
    "grid": {"element_size": [ELEMENT, ELEMENT]},
    "friction": {"coefficient": 0.3},
}
# the rig of the published scene: rig_model/scenes
ROLLER: dict[str, Any] = {
    "kind": "wheelset",
    "wheelset": {
        "vertical_force": 133.95e3,
        "nominal_radius": 0.3556,
        "flange_back_distance": 1.347,
        "left": {"offset": [0, 0, 1.29663e-3], "rotation": [1 / 60, 0, 0]},
        "right": {"offset": [0, 0, 1.29663e-3], "rotation": [-1 / 60, 0, 0]},
    },
    "track": {
        "kind": "roller",
        "gauge": 1.435,
        "gauge_height": 0.014,
        "roller_radius": 0.8001,
        "roller_pitch_rate": 5.587302,
    },
    "grid": {"element_size": [ELEMENT, ELEMENT]},
    "friction": {"coefficient": 0.52},
    "layer": {"thickness": 5e-5, "shear_modulus": 8.2e9},
}
BUILT_IN = {"wheel": "S1002", "rail": "UIC60@1:40"}


def rail_case(profiles: dict[str, str]) -> dict[str, Any]:
    return {**RAIL, "profiles": profiles}


def contacts(case: dict[str, Any]) -> tuple[Contact, Contact]:
    """One that finds the height for a load, one at a height with derivatives."""
    wheelset = {key: v for key, v in case["wheelset"].items() if key != "vertical_force"}
    fixed = {
        **case,
        "wheelset": {**wheelset, "z": 0.0},
        "method": {"tolerance": TOLERANCE, "max_iterations": 1000, "derivatives": True},
    }
    return Contact(case), Contact(fixed)


def choices(contact: Contact, result: Any) -> list[Any]:
    """What the derivatives keep: see the head."""
    found: list[Any] = []
    for side in SIDES:
        found.append(len(result[side]["patches"]))
        solved = result[side]["patches"] + result[side]["alternatives"]
        for index, patch in enumerate(solved):
            division = np.asarray(patch["element_division"])
            # lattice indices in half elements: a grid may begin elsewhere
            along, across = (
                np.round(2 * np.asarray(patch[axis]) / ELEMENT).astype(int) for axis in "xy"
            )
            rows, columns = np.nonzero(division)
            found += [along[columns].tolist(), across[rows].tolist()]
            found.append(division[rows, columns].tolist())
            distance = contact._core.field(SIDES.index(side), index, "undeformed_distance")
            row, column = np.unravel_index(np.argmin(distance), division.shape)
            found.append([int(along[column]), int(across[row])])
    return found


def rows_of(result: Any, side: str) -> np.ndarray:
    return np.array([*result[side]["force"], *result[side]["moment"]])


def differences(
    contact: Contact, state: dict[str, float], speed: float
) -> Iterator[tuple[int, dict[str, np.ndarray] | None]]:
    """By column: of each side, None where an event lies between."""
    here = choices(contact, contact.step(**state, fields=True))
    for column, name in enumerate(POSE_AND_VELOCITY):
        step = STEP.get(name, OF_SPEED * speed)
        ends = []
        for change in (step, -step):
            end = contact.step(**{**state, name: state[name] + change}, fields=True)
            same = end["status"] == "converged" and choices(contact, end) == here
            ends.append(end if same else None)
        if None in ends:
            yield column, None
            continue
        yield (
            column,
            {
                side: (rows_of(ends[0], side) - rows_of(ends[1], side)) / (2 * step)
                for side in SIDES
            },
        )


def compare(contact: Contact, state: dict[str, float], speed: float) -> tuple[int, int]:
    """Columns compared, and left out."""
    contact.step(**state)
    found = contact.jacobian()
    assert found["kind"] == "exact"
    assert found["status"] == "converged"
    usual = np.array(list(USUAL.values()))
    compared = left_out = 0
    for column, expected in differences(contact, state, speed):
        if expected is None:
            left_out += 1
            continue
        compared += 1
        for side in SIDES:
            scale = np.abs(found[side] * usual).max(axis=1)
            missed = np.abs(found[side][:, column] - expected[side]) * usual[column]
            name = POSE_AND_VELOCITY[column]
            assert (missed <= BOUND * scale).all(), (
                state,
                side,
                name,
                dict(zip(FORCE_AND_MOMENT, missed / scale, strict=True)),
            )
    return compared, left_out


def random_rail_state(rng: np.random.Generator, find: Contact) -> dict[str, float] | None:
    speed = rng.uniform(2.0, 40.0)
    state = dict.fromkeys(POSE_AND_VELOCITY, 0.0)
    y = rng.uniform(-6e-3, 6e-3)
    state.update(
        y=y,
        roll=-0.03 * y + rng.uniform(-1e-4, 1e-4),
        yaw=rng.uniform(-0.018, 0.018),
        speed=speed,
        vy=rng.uniform(-0.05, 0.05),
        vz=rng.uniform(-0.01, 0.01),
        roll_rate=rng.uniform(-0.02, 0.02),
        yaw_rate=rng.uniform(-0.05, 0.05),
        pitch_rate=-speed / 0.46 * (1 + rng.uniform(-2e-3, 2e-3)),
    )
    moving = {name: v for name, v in state.items() if name != "z"}
    result = find.step(**moving, vertical_force=rng.uniform(4e4, 2e5))
    return {**state, "z": result["z"]} if result["status"] == "converged" else None


def check_rail(profiles: dict[str, str], count: int) -> None:
    rng = np.random.default_rng(20261121)
    find, contact = contacts(rail_case(profiles))
    totals = np.zeros(2, dtype=int)
    for _ in range(count):
        state = random_rail_state(rng, find)
        if state is not None:
            totals += compare(contact, state, state["speed"])
    assert totals[0] > 6 * count
    assert totals[1] < totals[0] / 4


def test_built_in_profiles():
    check_rail(BUILT_IN, 50)


def test_profiles_of_points():
    check_rail(MANCHESTER, 50)


def test_tread_and_flange_at_once():
    """At a great yaw angle they touch apart: two patches, and where the solutions of one and two
    are blended, three."""
    find, contact = contacts(rail_case(BUILT_IN))
    speed = 20.0
    motion = {"yaw": 0.03, "speed": speed, "pitch_rate": -speed / 0.46, "vy": 0.01}
    totals, counts = np.zeros(2, dtype=int), set()
    # at 6.2 mm the wheel touches where its profile's curvature jumps, which choices() does not see
    places = np.append(np.arange(6.11e-3, 6.34e-3, 2e-5), np.arange(4.6e-3, 4.63e-3, 5e-6))
    for y in places:
        roll = -0.03 * float(y) if y > 6e-3 else 0.0
        result = find.step(y=float(y), roll=roll, **motion)
        patches = result["right"]["patches"] + result["right"]["alternatives"]
        if result["status"] != "converged" or len(patches) < 2:
            continue
        counts.add(len(patches))
        assert sum(patch["share"] for patch in patches) <= 2 + 1e-12
        state = {**dict.fromkeys(POSE_AND_VELOCITY, 0.0), **motion}
        state.update(y=float(y), roll=roll, z=result["z"])
        totals += compare(contact, state, speed)
    assert counts == {2, 3}
    assert totals[0] > 60
    assert totals[1] < totals[0] / 2


def test_rollers():
    """The roller rig's measured profiles, over its range of positions."""
    rng = np.random.default_rng(7)
    find, contact = contacts({**ROLLER, "profiles": NRC})
    totals = np.zeros(2, dtype=int)
    for _ in range(40):
        state = dict.fromkeys(POSE_AND_VELOCITY, 0.0)
        state.update(
            y=rng.uniform(-6.6e-3, 2.3e-3),
            roll=rng.uniform(-1e-4, 1e-4),
            yaw=rng.uniform(-0.018, 0.018),
            vy=rng.uniform(-0.02, 0.02),
            yaw_rate=rng.uniform(-0.02, 0.02),
            pitch_rate=-12.56 * (1 + rng.uniform(-2e-3, 2e-3)),
        )
        result = find.step(**{name: v for name, v in state.items() if name != "z"})
        if result["status"] == "converged":
            totals += compare(contact, {**state, "z": result["z"]}, 4.47)
    assert totals[0] > 240
    assert totals[1] < totals[0] / 4


def test_with_vertical_force_the_height_follows():
    """dz by what moves and by the force; columns are those of the force that is returned."""
    case = rail_case(BUILT_IN)
    method = {"tolerance": TOLERANCE, "max_iterations": 1000, "derivatives": True}
    contact = Contact({**case, "method": method})
    state = {"y": 1e-3, "roll": -3e-5, "yaw": 2e-3, "speed": 20.0, "pitch_rate": -20.0 / 0.46}
    result = contact.step(**state)
    found = contact.jacobian()
    total = found["left"][2] + found["right"][2]
    others = [k for k, name in enumerate(POSE_AND_VELOCITY) if name != "z"]
    assert np.abs(total[others] * np.array(list(USUAL.values()))[others]).max() < 1e-3
    stiffness = -total[POSE_AND_VELOCITY.index("z")]
    assert found["z_force"] == pytest.approx(1 / stiffness, rel=1e-12)
    step = 1.0  # N
    ends = [contact.step(**state, vertical_force=1e5 + s)["z"] for s in (step, -step)]
    assert found["z_force"] == pytest.approx((ends[0] - ends[1]) / (2 * step), rel=1e-4)
    contact.step(**state, vertical_force=1e5)
    rates = contact.differentiate(vertical_force=1.0)
    assert rates["kind"] == "exact"
    assert rates["z"] == pytest.approx(found["z_force"], rel=1e-6)
    assert result["status"] == "converged"


def test_places_count_where_something_varies():
    """By differences: none by the place along a track that is the same everywhere and the pitch of
    a round wheel; friction that changes along the track changes the creep force with its slope."""
    law = {"coefficient": 0.3, "along_track": [[0.0, 1.0], [1.0, 0.5]]}
    state = {"x": 0.5, "y": 1e-3, "z": 3e-4, "speed": 20.0, "pitch_rate": -21.0 / 0.46}
    x, pitch = (POSE_AND_VELOCITY.index(name) for name in ("x", "pitch"))
    by_x = []
    for friction in ({"coefficient": 0.3}, law):
        case = {**rail_case(BUILT_IN), "friction": friction}
        case["wheelset"] = {**case["wheelset"], "vertical_force": None, "z": 3e-4}
        case["method"] = {"normal": "hertz", "tangential": "polach", "derivatives": True}
        contact = Contact(case)
        result = contact.step(**state)
        found = contact.jacobian()
        assert found["kind"] == "differences"
        matrix = np.array(found["left"])
        assert np.abs(matrix[:, pitch]).max() == 0
        assert np.abs(matrix).max() > 0
        by_x.append((matrix[0, x], result["left"]["force"][0]))
    assert by_x[0][0] == 0
    # wheels that slip: the force goes with the coefficient, 0.75 of 0.3, which falls by 0.5 a metre
    slope, force = by_x[1]
    assert slope == pytest.approx(-0.5 / 0.75 * force, rel=0.05)


def test_needs_derivatives_and_wheels():
    case = rail_case(BUILT_IN)
    contact = Contact(case)
    contact.step()
    with pytest.raises(CaseError, match="derivatives"):
        contact.jacobian()
    patch = Contact(
        {
            "kind": "patch",
            "geometry": {"semi_axes": [0.006, 0.006]},
            "load": {"normal_force": 1e5},
            "grid": {"elements": [8, 8]},
            "friction": {"coefficient": 0.3},
            "motion": {"creepage": [0, 0], "spin_creepage": 0, "rolling_speed": 1},
            "method": {"derivatives": True},
        }
    )
    patch.step()
    with pytest.raises(CaseError, match="wheel_rail"):
        patch.jacobian()
