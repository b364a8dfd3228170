"""The state in which the wheelset is released: off-centre, with its fast motions at rest."""

from __future__ import annotations

import numpy as np
from railpatch import CaseError, Contact
from railpatch.case.common import without_friction
from railpatch.case.types import SIDES

from wheelset_demo.scene import WheelsetScene
from wheelset_demo.steppers import differences
from wheelset_demo.system import BAD, COUNT, WORKS, ContactFailure, State, System, Vector

# unknowns and the accelerations that vanish, as indices of the motion: z, roll and the rates of y,
# yaw and pitch with the accelerations of y, z, roll, yaw, pitch; on a flange, which holds no
# wheelset at rest sideways, z and roll only
QUASI_STATIC = ([2, 3, 7, 10, 11], [7, 8, 9, 10, 11])
UPRIGHT = ([2, 3], [8, 9])
MOST_STEPS = 60
# m/s^2 and rad/s^2
TOLERANCE = 1e-4
# longest step: m, rad, of lengths and angles, a tenth of the approach; -, of rates over the speed
LENGTH_LIMIT = 2e-5
RATE_LIMIT = 1e-3
# -, rate of y but for rolling with the yaw angle, over the speed: creep forces are saturated there
SLIDING = 5e-3


def released(scene: WheelsetScene, system: System) -> State:
    """The scene's y, yaw and speed with all else found.

    Vertical position, roll angle and the rates of y, yaw and pitch are those at which all
    accelerations but that along the track vanish: the quasi-static motion, which any other start
    would reach within centimetres, after a bounce. Where there is none, near a flange or where
    friction is too small to hold the wheelset, it starts without the rates of y and yaw, and only
    its vertical and roll accelerations vanish.
    Raises CaseError where both wheels cannot carry the load.
    """
    start = estimate(scene)
    motion = balanced(system, start, *QUASI_STATIC)
    if motion is None or slides(motion):
        start[COUNT + 4] = 0.0
        motion = balanced(system, start, *UPRIGHT)
    if motion is None:
        y = scene.case.wheelset.y
        raise CaseError(
            f"wheelset.y: value is {y}, allowed one where both wheels can carry the load"
        )
    return State(0.0, motion, np.zeros(len(WORKS)))


def slides(motion: Vector) -> bool:
    """Whether it moves sideways faster than wheels roll: dampers balance what friction cannot."""
    rolls = motion[COUNT] * motion[4]
    return bool(abs(motion[COUNT + 1] - rolls) > SLIDING * motion[COUNT])


def balanced(system: System, start: Vector, unknown: list[int], free: list[int]) -> Vector | None:
    """[12], the motion near a start without the accelerations ``free``; Newton's method."""
    motion = start.copy()
    limit = np.array([LENGTH_LIMIT if k < COUNT else RATE_LIMIT * motion[COUNT] for k in unknown])
    try:
        for _ in range(MOST_STEPS):
            rates = system.rates(0.0, motion).motion
            residual = rates[free]
            if np.abs(residual).max() < TOLERANCE:
                return motion
            slope = jacobian(system, motion, rates, unknown, free)
            change = -np.linalg.solve(slope, residual)
            motion[unknown] += change / max(1.0, float(np.abs(change / limit).max()))
    except (ContactFailure, np.linalg.LinAlgError):
        # the search has left the range of the contact
        return None
    return None


def jacobian(
    system: System, motion: Vector, rates: Vector, unknown: list[int], free: list[int]
) -> Vector:
    """[k, k], of the accelerations with respect to the unknowns, by differences."""
    sizes = differences(float(motion[COUNT]))
    columns = []
    for column in unknown:
        moved = motion.copy()
        moved[column] += sizes[column]
        columns.append((system.rates(0.0, moved).motion - rates)[free] / sizes[column])
    return np.array(columns).T


def estimate(scene: WheelsetScene) -> Vector:
    """[12], both wheels each with half the load, rolling without creepage on the mean radius."""
    wheelset = scene.case.wheelset
    content = without_friction(scene.case.model_dump())
    half = content["wheelset"] | {"vertical_force": 0.5 * wheelset.vertical_force}
    sides = {}
    for side in SIDES:
        single = {**content, "kind": "wheel_rail", "wheel": {"side": side}, "wheelset": half}
        result = Contact(single).step()
        if result.status in BAD or not result["patches"]:
            raise CaseError(
                f"wheelset.y: value is {wheelset.y}, allowed one where both wheels can carry "
                f"the load: {side} wheel {result.status}: {result.reason}"
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
