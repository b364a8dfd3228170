"""What rails that are not level do to contacts that are prismatic along the track.

The surface of a rail whose place (y, z) changes along the track by slopes (y', z') holds the
direction (1, y', z'). A contact force (Fy, Fz), all but the longitudinal creep force, stands square
on it and has, to the first order,

    Fx = -(Fy y' + Fz z')

along the track: what a wheelset that climbs loses in speed. On a vertical slope contact and forces
turn about the axle's line: none about the axle, and Mz = Mx z', with Mx the contact force's moment
about the wheelset's centre. By a lateral slope Mz = -y_c Fx with the contact at y_c; normals of a
wheel meet its axle there as well, but the lateral creep force's share Ty = Fy - Ny acts at the
tread, r below, and turns the wheelset about its axle by -r Ty y'.

The material of the rail stands still, and its lateral slope is a real angle of attack. A vertical
slope is none: a contact that knows no slope takes a wheel that climbs with it for one that slips
along an inclined surface. The rail is given the vertical rate that the wheel sees. Left out is y'
tan(angle) sin(angle) of lateral creepage, of a lateral slope in a contact at an angle: of the first
order of the slope in flange contact, a thousandth of it on the tread.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from railpatch import _core

Vector = NDArray[np.float64]


def slope_wrenches(
    wheels: Vector, normals: Vector, slopes: Vector, radii: Vector, arm: float
) -> Vector:
    """[n, 2, 3], of left and right wheel: Fx (N), My, Mz (N m) about the wheelset's centre.

    wheels: [n, 2, 8], normals: N, [n, 2], as ForceElement.wheels, .lateral_normals. slopes: -, [n,
    2, 2], of left and right rail, lateral and vertical. radii: m, [n], of the wheels; arm: m, half
    the distance of the contacts, near enough for the lateral force's share.
    """
    found = np.empty((*wheels.shape[:2], 3))
    _core.slope_wrenches(wheels, normals, slopes, radii, arm, found)
    return found
