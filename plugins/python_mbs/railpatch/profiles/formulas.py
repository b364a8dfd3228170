"""S1002 wheel and UIC60 rail as formulas. Millimetres in here, z down, right-hand orientation.

S1002: EN 13715 / UIC 510-2, y from the flange back (-70) to the field side (+60), z = 0 at the
tread circle (y = 0). UIC60: head of the Manchester benchmark, uncanted, z = 0 at the crown. 60E1,
54E1: heads of EN 13674-1 by the radii and widths of its drawings.
"""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
from numpy.typing import ArrayLike, NDArray

from railpatch.profiles.elementary import asin, atan, cos, sin

Array = NDArray[np.float64]
# a piece of a profile: first and last parameter, point(t) -> y, z and rate(t) -> dy/dt, dz/dt
Pair = tuple[Array, Array]
Piece = tuple[float, float, Callable[[Array], Pair], Callable[[Array], Pair]]

# S1002: joints from the field side to the flange back
S1002_JOINTS = (
    60.0,
    32.15796,
    -26.0,
    -35.0,
    -38.426669071,
    -39.764473993,
    -49.662510381,
    -62.764705882,
    -70.0,
)
# polynomials, lowest power first
S1002_A = (1.364323640, -0.066666667)
S1002_B = (
    0.0,
    -3.358537058e-2,
    1.565681624e-3,
    -2.810427944e-5,
    5.844240864e-8,
    -1.562379023e-8,
    5.309217349e-15,
    -5.957839843e-12,
    2.646656573e-13,
)
S1002_C = (
    -4.320221063e3,
    -1.038384026e3,
    -1.065501873e2,
    -6.051367875,
    -2.054332446e-1,
    -4.169739389e-3,
    -4.687195829e-5,
    -2.252755540e-7,
)
S1002_E = (-93.576667419, -2.747477419)
# arcs: centre y, centre z, radius, sign of the root
S1002_D = (-26.210665, 16.446, 13.0, -1.0)
S1002_F = (-58.558326413, 8.834924130, 20.0, 1.0)
S1002_G = (-55.0, 16.0, 12.0, 1.0)
S1002_H = (-49.5, 9.519259302, 20.5, 1.0)
S1002_ZONES = (S1002_A, S1002_B, S1002_C, S1002_D, S1002_E, S1002_F, S1002_G, S1002_H)
S1002_ARCS = (S1002_D, S1002_F, S1002_G, S1002_H)

# UIC60: arcs from the crown outwards as centre |y|, centre z, radius, outer |y|
UIC60_ARCS = (
    (0.0, 300.0, 300.0, 10.5),
    (7.7, 80.134791, 80.0, 25.988035),
    (23.016220, 14.908970, 13.0, 36.0),
)
# side: |y| = UIC60_SIDE[0] + UIC60_SIDE[1] z, down to UIC60_DEPTH
UIC60_SIDE = (35.287010, 0.05)
UIC60_DEPTH = 37.5

# EN 13674-1: radius and full width where each arc ends, from the crown outwards; arcs touch each
# other, the last one the side of HEAD_SIDE, at the full width of the head but for 1e-3 mm
HEADS = {
    "60E1": ((300.0, 20.456), (80.0, 52.053), (13.0, 72.0)),
    "54E1": ((300.0, 20.024), (80.0, 49.727), (13.0, 70.0)),
}
HEAD_SIDE = 1 / 20


def arc_depth(arc: tuple[float, ...], y: Array) -> Array:
    """z of an arc (centre y, centre z, radius, sign)."""
    # rounding of the joints may leave the circle by 1e-9 mm
    return arc[1] + arc[3] * np.sqrt(np.maximum(arc[2] ** 2 - (y - arc[0]) ** 2, 0.0))


def zone_depth(zone: tuple[float, ...], y: Array) -> Array:
    """z of one zone of S1002; Horner's scheme, as zone C cancels."""
    if zone in S1002_ARCS:
        return arc_depth(zone, y)
    return np.polynomial.polynomial.polyval(y, zone)


def s1002_depth(y: ArrayLike) -> Array:
    """z in mm of the S1002 profile at y in mm, -70 ... 60; NaN outside."""
    y = np.asarray(y, dtype=float)
    z = np.full(y.shape, np.nan)
    for zone, high, low in zip(S1002_ZONES, S1002_JOINTS[:-1], S1002_JOINTS[1:], strict=True):
        inside = (y <= high) & (y >= low)
        z[inside] = zone_depth(zone, y[inside])
    return z


def uic60_depth(y: ArrayLike) -> Array:
    """z in mm of the uncanted UIC60 head at y in mm, |y| <= 36, above the sides; NaN outside."""
    a = np.abs(np.asarray(y, dtype=float))
    z = np.full(a.shape, np.nan)
    inner = 0.0
    for centre_y, centre_z, radius, outer in UIC60_ARCS:
        inside = (a >= inner) & (a <= outer)
        z[inside] = arc_depth((centre_y, centre_z, radius, -1.0), a[inside])
        inner = outer
    return z


def polynomial_piece(first: float, last: float, coefficients: tuple[float, ...]) -> Piece:
    """z = polynomial in y, parameter y."""
    polynomial = np.polynomial.polynomial
    slope = polynomial.polyder(coefficients)
    return (
        first,
        last,
        lambda t: (t, polynomial.polyval(t, coefficients)),
        lambda t: (np.ones_like(t), polynomial.polyval(t, slope) * np.ones_like(t)),
    )


def arc_piece(first: float, last: float, arc: tuple[float, ...]) -> Piece:
    """Arc from y = first to y = last, parameter the angle from the vertical through its centre."""
    centre_y, centre_z, radius, sign = arc

    def angle(y: float) -> float:
        return float(asin(max(-1.0, min(1.0, (y - centre_y) / radius))))

    return (
        angle(first),
        angle(last),
        lambda t: (centre_y + radius * sin(t), centre_z + sign * radius * cos(t)),
        lambda t: (radius * cos(t), -sign * radius * sin(t)),
    )


def straight_piece(first: tuple[float, float], last: tuple[float, float]) -> Piece:
    """Straight line between two points (y, z), parameter 0 ... 1."""
    dy, dz = last[0] - first[0], last[1] - first[1]
    return (
        0.0,
        1.0,
        lambda t: (first[0] + dy * t, first[1] + dz * t),
        lambda t: (np.full_like(t, dy), np.full_like(t, dz)),
    )


def s1002_pieces() -> list[Piece]:
    """S1002 from the flange back to the field side.

    The published coefficients of zone C miss its neighbours by 4e-5 and 1.2e-4 mm and 6e-6 in
    slope; a cubic of that size is added to it, so that position and slope are continuous.
    """
    zones = list(zip(S1002_ZONES, S1002_JOINTS[:-1], S1002_JOINTS[1:], strict=True))
    pieces = []
    for zone, high, low in reversed(zones):
        if zone in S1002_ARCS:
            pieces.append(arc_piece(low, high, zone))
        elif zone is S1002_C:
            pieces.append(fitted_zone_c(low, high))
        else:
            pieces.append(polynomial_piece(low, high, zone))
    return pieces


def fitted_zone_c(low: float, high: float) -> Piece:
    """Zone C plus the cubic that takes up its misfit to zones D (low) and B (high)."""
    polynomial = np.polynomial.polynomial
    centre_y, _, radius, _ = S1002_D
    slope_d = (low - centre_y) / math.sqrt(radius**2 - (low - centre_y) ** 2)
    slope_b = polynomial.polyval(high, polynomial.polyder(S1002_B))
    slope_c = polynomial.polyder(S1002_C)
    h = high - low
    gap = (
        float(zone_depth(S1002_D, np.array(low)) - zone_depth(S1002_C, np.array(low))),
        float(zone_depth(S1002_B, np.array(high)) - zone_depth(S1002_C, np.array(high))),
    )
    kink = (slope_d - polynomial.polyval(low, slope_c), slope_b - polynomial.polyval(high, slope_c))
    # cubic Hermite in u = y - low
    cubic = (
        gap[0],
        kink[0],
        (3 * (gap[1] - gap[0]) / h - 2 * kink[0] - kink[1]) / h,
        (2 * (gap[0] - gap[1]) / h + kink[0] + kink[1]) / h**2,
    )
    d_cubic = polynomial.polyder(cubic)
    return (
        low,
        high,
        lambda t: (t, polynomial.polyval(t, S1002_C) + polynomial.polyval(t - low, cubic)),
        lambda t: (
            np.ones_like(t),
            polynomial.polyval(t, slope_c) + polynomial.polyval(t - low, d_cubic),
        ),
    )


def uic60_pieces() -> list[Piece]:
    """UIC60 from the lower end of the gauge side to the lower end of the field side, uncanted.

    The published centres leave a step of 4e-5 mm between R80 and R13; the outer arc and the side
    are moved by it, so that the position is continuous (slopes are within 1e-6).
    """
    arcs = []
    inner = depth = 0.0
    for centre_y, _, radius, outer in UIC60_ARCS:
        drop = math.sqrt(radius**2 - (inner - centre_y) ** 2)
        centre_z = depth + drop
        arcs.append((inner, outer, (centre_y, centre_z, radius, -1.0)))
        inner, depth = outer, centre_z - math.sqrt(radius**2 - (outer - centre_y) ** 2)
    return head(arcs, depth, UIC60_SIDE[1])


def head_pieces(name: str) -> list[Piece]:
    """A head of HEADS from one side's lower end to the other's, uncanted."""
    arcs = []
    inner = centre_y = centre_z = radius = 0.0
    drawn = HEADS[name]
    for number, (next_radius, width) in enumerate(drawn):
        # centres lie on the normal at the joint, the first one below the crown
        sine = (inner - centre_y) / radius if radius else 0.0
        centre_y += (radius - next_radius) * sine
        centre_z -= (radius - next_radius) * math.sqrt(1 - sine**2)
        radius = next_radius
        if number + 1 < len(drawn):
            outer = 0.5 * width
        else:
            outer = centre_y + radius * float(cos(atan(HEAD_SIDE)))
        arcs.append((inner, outer, (centre_y, centre_z, radius, -1.0)))
        inner = outer
    depth = centre_z - math.sqrt(radius**2 - (inner - centre_y) ** 2)
    return head(arcs, depth, HEAD_SIDE)


def head(
    arcs: list[tuple[float, float, tuple[float, ...]]], depth: float, side: float
) -> list[Piece]:
    """Both halves of a rail's head down to UIC60_DEPTH.

    arcs: of one half, from the crown outwards: inner and outer |y|, arc. depth: z where they end.
    side: inclination of the straight sides to the vertical.
    """
    inner = arcs[-1][1]
    foot = (inner + side * (UIC60_DEPTH - depth), UIC60_DEPTH)
    left = [straight_piece((-foot[0], foot[1]), (-inner, depth))]
    right = [straight_piece((inner, depth), foot)]
    for inner, outer, (centre_y, *rest) in reversed(arcs[1:]):
        left.append(arc_piece(-outer, -inner, (-centre_y, *rest)))
        right.insert(0, arc_piece(inner, outer, (centre_y, *rest)))
    _, outer, crown = arcs[0]
    return [*left, arc_piece(-outer, outer, crown), *right]
