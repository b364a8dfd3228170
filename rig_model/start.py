"""Estimates of balances without friction: half the load on each wheel, free rolling."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import scipy
from numpy.typing import NDArray
from railpatch import Contact, Result
from railpatch.case.types import SIDES

from rig_model.programme import Position
from rig_model.scene import RigScene

Vector = NDArray[np.float64]

# where a wheel meets no roller, or is not solved: a steel wheel's approach under some 70 kN
USUAL_APPROACH = 1e-4
# m, lateral distance of the knots between which the estimate is interpolated, and their most
KNOT_DISTANCE = 1e-3
MOST_KNOTS = 40


@dataclass(frozen=True)
class Estimate:
    """unknowns: [3], z (m), roll (rad), pitch rate (rad/s). approach: m, mean of both wheels.

    width: m, lateral distance of the contacts. found: whether both wheels touch their roller; if
    not, the values are guesses.
    """

    unknowns: Vector
    approach: float
    width: float
    found: bool = True


class Frictionless:
    """Both wheels, each put alone on its roller with half the load (report, section 6.2)."""

    def __init__(self, scene: RigScene) -> None:
        """Raises CaseError, ProfileError."""
        self._scene = scene
        self._wheels = {side: Contact(scene.frictionless(side)) for side in SIDES}

    def estimate(self, y: float, yaw: float) -> Estimate:
        """At a lateral position (m) and yaw angle (rad).

        The heights of the wheels give z and the roll angle, the radii at the contacts the pitch
        rate with equal surface speeds.
        """
        wheels = {side: wheel.step(y=y, yaw=yaw) for side, wheel in self._wheels.items()}
        track, wheelset = self._scene.case.track, self._scene.case.wheelset
        if not all(wheel.solved and wheel["patches"] for wheel in wheels.values()):
            rate = -track.roller_pitch_rate * track.roller_radius / wheelset.nominal_radius
            return Estimate(np.array([0.0, 0.0, rate]), USUAL_APPROACH, track.gauge, False)
        left, right = (reference(wheels[side]) for side in SIDES)
        width = right[1] - left[1]
        roll = (wheels["right"]["z"] - wheels["left"]["z"]) / width
        z = wheels["left"]["z"] - roll * (left[1] - y)
        ratios = [
            (track.roller_radius - at[2]) / wheels[side]["rolling_radius"]
            for side, at in zip(SIDES, (left, right), strict=True)
        ]
        pitch_rate = -track.roller_pitch_rate * math.fsum(ratios) / len(ratios)
        approach = np.mean([deepest(wheels[side]) for side in SIDES])
        return Estimate(np.array([z, roll, pitch_rate]), float(approach), float(width))


class Baseline:
    """The estimate interpolated over the lateral positions of a run.

    A yaw angle psi moves the contacts, half a width w from the centre, by psi w/2 along x relative
    to the axle; between circles of radii r and R the wheelset then sinks by (psi w/2)^2 / (2(r+R)).
    """

    def __init__(self, scene: RigScene, frictionless: Frictionless, lateral: Sequence[float]):
        """lateral: m, the positions' y."""
        low, high = min(lateral), max(lateral)
        count = min(MOST_KNOTS, math.ceil((high - low) / KNOT_DISTANCE) + 1)
        knots = np.linspace(low, high, count)
        found = [(y, e) for y in knots for e in [frictionless.estimate(float(y), 0.0)] if e.found]
        radii = scene.case.track.roller_radius + scene.case.wheelset.nominal_radius
        width = float(np.mean([e.width for _, e in found])) if found else 0.0
        self._sinking = width**2 / (8 * radii)
        self._rate = scene.case.track.roller_pitch_rate
        self._low, self._high = (found[0][0], found[-1][0]) if found else (0.0, 0.0)
        self._values = np.array([e.unknowns for _, e in found]) if found else np.zeros((1, 3))
        at = [y for y, _ in found]
        self._over_y = (
            scipy.interpolate.PchipInterpolator(at, self._values) if len(found) > 1 else None
        )

    def __call__(self, position: Position) -> Vector:
        """z (m), roll (rad), pitch rate (rad/s), [3]; beyond the knots that of the last one."""
        y = min(max(position.y, self._low), self._high)
        values = self._values[0].copy() if self._over_y is None else self._over_y(y)
        values[0] += self._sinking * position.yaw**2
        if position.roller_pitch_rate is not None:
            values[2] *= position.roller_pitch_rate / self._rate
        return values


def reference(wheel: Result) -> Vector:
    """m, [3], mean contact reference weighted with the load, track axes."""
    forces = [patch["normal_force"] for patch in wheel["patches"]]
    return np.average([patch["position"] for patch in wheel["patches"]], axis=0, weights=forces)


def deepest(wheel: Result) -> float:
    """m, largest approach of the patches."""
    return max(patch["approach"] for patch in wheel["patches"])
