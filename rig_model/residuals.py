"""Residuals of the force balance, rig_model/balance.py, and their rates."""

from __future__ import annotations

import math

import numpy as np
from railpatch import Result
from railpatch.case.types import SIDES

from rig_model.scene import RigScene
from rig_model.search import Vector


def residuals(scene: RigScene, result: Result, load: float) -> Vector:
    """f1, f2, f3 in N m, N, N m, [3], under a load (N); see rig_model/balance.py."""
    if scene.rig.balance.axle_torque == "wheelset":
        torque = result["axle_torque"]
    else:
        torque = math.fsum(
            track_force(scene, result[side]) * result[side]["rolling_radius"] for side in SIDES
        )
    return np.array([torque, -result["force"][2] - load, result["moment"][0]])


def residual_rates(scene: RigScene, result: Result, rates: Result) -> Vector:
    """Rates of f1, f2, f3, [3], where those of the result are known."""
    if scene.rig.balance.axle_torque == "wheelset":
        axle = rates["axle_torque"]
    else:
        axle = 0.0
        for side in SIDES:
            wheel, rate = result[side], rates[side]
            axle += track_force_rate(scene, wheel, rate) * wheel["rolling_radius"]
            axle += track_force(scene, wheel) * rate["rolling_radius"]
    return np.array([axle, -rates["force"][2], rates["moment"][0]])


def track_force(scene: RigScene, wheel: dict) -> float:
    """N, longitudinal force in track axes, the normal force's part included.

    By the rule of the program CONTACT the contact's own axes leave that part out: their x axis is
    the track's. On a roller of radius R the normal through a point at x, z of the track is inclined
    by x/(R - z) along x.
    """
    if scene.is_whole:
        return wheel["force"][0]
    return wheel["force"][0] + math.fsum(
        patch["share"]
        * patch["normal_force"]
        * math.cos(patch["contact_angle"])
        * inclination(scene, patch)
        for patch in solutions(wheel)
    )


def track_force_rate(scene: RigScene, wheel: dict, rate: dict) -> float:
    """Of the same."""
    total = rate["force"][0]
    if scene.is_whole:
        return total
    for patch, change in zip(solutions(wheel), solutions(rate), strict=True):
        height = scene.case.track.roller_radius - patch["position"][2]
        angle = patch["contact_angle"]
        force = patch["share"] * patch["normal_force"]
        force_rate = change["share"] * patch["normal_force"]
        force_rate += patch["share"] * change["normal_force"]
        inclined = inclination(scene, patch)
        inclined_rate = (change["position"][0] + inclined * change["position"][2]) / height
        total += force_rate * math.cos(angle) * inclined
        total -= force * math.sin(angle) * change["contact_angle"] * inclined
        total += force * math.cos(angle) * inclined_rate
    return total


def solutions(wheel: dict) -> list[dict]:
    """The patches, and others that count with their share in the wheel's force."""
    return wheel["patches"] + wheel["alternatives"]


def inclination(scene: RigScene, patch: dict) -> float:
    """-, of the roller's surface along x."""
    x, _, z = patch["position"]
    return x / (scene.case.track.roller_radius - z)
