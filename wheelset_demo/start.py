"""The state in which the wheelset is released: off-centre, with its fast motions at rest."""

from __future__ import annotations

import numpy as np
from railpatch import CaseError, Contact

from wheelset_demo.scene import SIDES, WheelsetScene
from wheelset_demo.steppers import differences
from wheelset_demo.system import BAD, COUNT, WORKS, State, System, Vector

# unknowns, as indices of the motion: z, roll, and the rates of y, yaw and pitch
UNKNOWN = [2, 3, 7, 10, 11]
# whose accelerations vanish: y, z, roll, yaw, pitch
FREE = [7, 8, 9, 10, 11]
MOST_STEPS = 30
# m/s^2 and rad/s^2
TOLERANCE = 1e-4


def released(scene: WheelsetScene, system: System) -> State:
    """The scene's y, yaw and speed with all else found.

    Vertical position, roll angle and the rates of y, yaw and pitch are those at which all
    accelerations but that along the track vanish: the quasi-static motion, which any other start
    would reach within centimetres, after a bounce. Raises CaseError where there is no such state,
    ContactFailure.
    """
    wheelset = scene.case.wheelset
    motion = estimate(scene)
    rates = system.rates(0.0, motion)
    for _ in range(MOST_STEPS):
        residual = rates.motion[FREE]
        if np.abs(residual).max() < TOLERANCE:
            return State(0.0, motion, np.zeros(len(WORKS)))
        change = -np.linalg.solve(jacobian(system, motion, rates.motion), residual)
        # a step keeps within a tenth of the approach and of the creepages
        limit = np.array([2e-5, 2e-5, *np.array([1e-3, 1e-3, 1e-3]) * scene.speed])
        motion = motion.copy()
        motion[UNKNOWN] += change / max(1.0, float(np.abs(change / limit).max()))
        rates = system.rates(0.0, motion)
    raise CaseError(
        f"wheelset.y: value is {wheelset.y}, allowed one where the wheelset can be released: "
        "no quasi-static motion was found here"
    )


def jacobian(system: System, motion: Vector, rates: Vector) -> Vector:
    """[5, 5], of the accelerations with respect to the unknowns."""
    sizes = differences(float(motion[COUNT]))
    columns = []
    for column in UNKNOWN:
        moved = motion.copy()
        moved[column] += sizes[column]
        columns.append((system.rates(0.0, moved).motion - rates)[FREE] / sizes[column])
    return np.array(columns).T


def estimate(scene: WheelsetScene) -> Vector:
    """[12], both wheels each with half the load, rolling without creepage on the mean radius."""
    wheelset = scene.case.wheelset
    content = scene.case.model_dump()
    half = content["wheelset"] | {"vertical_force": 0.5 * wheelset.vertical_force}
    sides = {}
    for side in SIDES:
        single = {**content, "kind": "wheel_rail", "wheel": {"side": side}, "wheelset": half}
        single["method"] = content["method"] | {"tangential": "none"}
        result = Contact(single).step()
        if result.status in BAD or not result["patches"]:
            raise CaseError(
                f"wheelset.y: value is {wheelset.y}, allowed one where both wheels can carry "
                f"the load: {side} wheel {result.status}"
            )
        sides[side] = result
    at = {side: np.array(sides[side]["patches"][0]["position"]) for side in SIDES}
    width = at["right"][1] - at["left"][1]
    roll = (sides["right"]["z"] - sides["left"]["z"]) / width
    z = sides["left"]["z"] - roll * (at["left"][1] - wheelset.y)
    radii = {side: sides[side]["rolling_radius"] for side in SIDES}
    mean = 0.5 * (radii["left"] + radii["right"])
    motion = np.zeros(2 * COUNT)
    motion[[1, 2, 3, 4]] = [wheelset.y, z, roll, wheelset.yaw]
    motion[COUNT] = scene.speed
    motion[COUNT + 1] = scene.speed * wheelset.yaw
    motion[COUNT + 4] = scene.speed * (radii["left"] - radii["right"]) / (mean * width)
    motion[COUNT + 5] = -scene.speed / mean
    return motion
