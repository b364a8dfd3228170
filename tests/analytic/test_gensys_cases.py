"""Contact points, rolling radii and creepages by hand: the seven cases of GENSYS's contact tests.

Source of the list: FRA report DOT/FRA/ORD-24/18, Table 6, after Persson (2019): cylindric and
conical wheels on a circular rail head, with fully prescribed motion. The report gives no
dimensions; those here are the test's own. Bounds: 1e-9 m and rad in geometry, 1e-6 in creepages
(spin: 1e-6 rad/m).

By hand, for a right wheel of radius r = r0 - t u over its axis (t: cone's slope, u: outwards from
the marker), yaw p, no roll, on a crown of radius R. Point and outward normal on the wheel are
(r sin q, u, r cos q) and (sin q, t, cos q) in the wheelset's axes. A straight rail's normal has no
x component: cos p sin q = t sin p. So

    sin q = t tan p,   tan a = -t / (cos p cos q),   n = (0, -sin a, cos a),

a the contact angle; the crown has that inclination at R sin a from its top, R (1 - cos a) below.
The wheel's point lies the approach further along n, its lateral position gives u, its height z.
The axle turns at w < 0 about (-sin p, cos p, 0), so the wheel's point moves by

    (V + w r cos p cos q, w r sin p cos q, -w r sin q)   for a wheelset with forward speed V,

and the spin is w cos p n_y. A yaw rate adds (-y, x) times itself, from the wheelset's centre to the
point, to the slip, and itself times cos a to the spin.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import atan, cos, hypot, sin, sqrt, tan
from typing import Any

import pytest
from railpatch import Contact, solve

CROWN, RADIUS, SPEED = 0.3, 0.46, 10.0  # m, m, m/s
CONE = 1 / 20
GAUGE, BACK_DISTANCE, BACK_POSITION = 1.435, 1.36, -0.07  # m
MARKER = 0.5 * BACK_DISTANCE - BACK_POSITION
# the built-in crown ends 70 mm from its top, above 14 mm depth: there the gauge is measured
TOP = 0.5 * GAUGE + 0.07
# m, so little that the wheel touches in a point: the means over the patch differ by less than 1e-9
APPROACH = 1e-8
GEOMETRY, CREEPAGE = 1e-9, 1e-6


@dataclass(frozen=True)
class Place:
    """Where a right wheel touches, by hand."""

    slope: float  # -, t
    yaw: float  # rad
    angle: float  # rad, contact angle
    radius: float  # m, rolling radius
    sin_q: float  # -
    cos_q: float  # -
    position: tuple[float, float, float]  # m, on the rail
    wheel_y: float  # m, of the wheel's point
    z: float  # m, of the wheelset

    def free_pitch_rate(self, forward: float) -> float:
        """rad/s, without longitudinal slip where the wheel's point is carried forward so fast."""
        return -forward / (self.radius * cos(self.yaw) * self.cos_q)

    def creepages(self, speed: float, pitch_rate: float, yaw_rate: float) -> tuple[float, ...]:
        """Longitudinal, lateral and spin creepage (-, -, rad/m)."""
        w, r, p, a = pitch_rate, self.radius, self.yaw, self.angle
        carried = speed - yaw_rate * self.wheel_y
        turned = w * r * cos(p) * self.cos_q
        slip_y = w * r * sin(p) * self.cos_q + yaw_rate * self.position[0]
        slip_z = -w * r * self.sin_q
        mean = 0.5 * (abs(carried) + abs(turned))
        spin = -w * cos(p) * sin(a) + yaw_rate * cos(a)
        lateral = cos(a) * slip_y + sin(a) * slip_z
        return (carried + turned) / mean, lateral / mean, spin / mean


def place_of(slope: float, yaw: float) -> Place:
    """The formulas at the head of this file."""
    sin_q = slope * tan(yaw)
    cos_q = sqrt(1 - sin_q**2)
    angle = -atan(slope / (cos(yaw) * cos_q))
    y, z = TOP + CROWN * sin(angle), CROWN * (1 - cos(angle))
    wheel_y, wheel_z = y - APPROACH * sin(angle), z + APPROACH * cos(angle)
    # wheel_y = cos p (marker + u) + sin p sin q (r0 - t u)
    rest = wheel_y - cos(yaw) * MARKER - sin(yaw) * sin_q * RADIUS
    u = rest / (cos(yaw) - sin(yaw) * sin_q * slope)
    radius = RADIUS - slope * u
    x = radius * cos(yaw) * sin_q - sin(yaw) * (MARKER + u)
    height = wheel_z + RADIUS - radius * cos_q
    return Place(slope, yaw, angle, radius, sin_q, cos_q, (x, y, z), wheel_y, height)


def case(place: Place, side: str = "right") -> dict[str, Any]:
    """The wheel in this place."""
    return {
        "kind": "wheel_rail",
        "wheel": {"side": side},
        "grid": {"elements": [9, 9]},
        "friction": {"coefficient": 0.3},
        "method": {"normal": "hertz", "tangential": "fastsim"},
        "wheelset": {
            "z": place.z,
            "yaw": place.yaw,
            "speed": SPEED,
            "pitch_rate": place.free_pitch_rate(SPEED),
            "nominal_radius": RADIUS,
            "flange_back_distance": BACK_DISTANCE,
            "flange_back_position": BACK_POSITION,
        },
        "track": {"gauge": GAUGE},
        "profiles": {"wheel": f"cone@1:{1 / CONE:.0f}" if place.slope else "cylinder",
                     "rail": f"arc@{CROWN}"},
    }  # fmt: skip


def check(result: Any, place: Place, expected: tuple[float, ...], side: int = 1) -> None:
    """Geometry and creepages of a result; side: -1 for a left wheel, the mirror image."""
    assert result.status == "converged"
    (patch,) = result["patches"]
    x, y, z = place.position
    assert patch["position"] == pytest.approx([x, side * y, z], rel=0, abs=GEOMETRY)
    assert patch["contact_angle"] == pytest.approx(side * place.angle, rel=0, abs=GEOMETRY)
    assert result["rolling_radius"] == pytest.approx(place.radius, rel=0, abs=GEOMETRY)
    found = [*patch["creepage"], patch["spin_creepage"]]
    hand = [expected[0], side * expected[1], side * expected[2]]
    assert found == pytest.approx(hand, rel=0, abs=CREEPAGE)


STEPS = [0.0, 0.25, 0.5, 0.75, 1.0]


def test_axl_110_cylindric_pure_rolling() -> None:
    place = place_of(0.0, 0.0)
    result = solve(case(place))
    check(result, place, (0.0, 0.0, 0.0))
    # on the crown's top, at the nominal radius
    assert (place.position, place.angle, place.radius) == ((0.0, TOP, 0.0), 0.0, RADIUS)


def test_axl_111_cylindric_longitudinal() -> None:
    """Pitch rate increasing linearly, to 1 % more than rolling."""
    place = place_of(0.0, 0.0)
    contact = Contact(case(place))
    for share in STEPS:
        k = 0.01 * share
        result = contact.step(pitch_rate=-(1 + k) * SPEED / RADIUS)
        check(result, place, (-k / (1 + 0.5 * k), 0.0, 0.0))


def test_axl_112_cylindric_lateral() -> None:
    """Angle of attack increasing linearly, to 20 mrad, rolling without longitudinal slip."""
    for share in STEPS:
        place = place_of(0.0, 0.02 * share)
        check(solve(case(place)), place, (0.0, -tan(0.02 * share), 0.0))


def test_axl_113_cylindric_spin() -> None:
    """The wheelset rotates in yaw around the right wheel, which rolls on."""
    place = place_of(0.0, 0.0)
    contact = Contact(case(place))
    for share in STEPS:
        rate = 2.0 * share
        # the centre moves about the contact point: that itself is carried at SPEED
        result = contact.step(speed=SPEED + rate * TOP, yaw_rate=rate)
        check(result, place, (0.0, 0.0, rate / SPEED))
    # without rolling the point stands still: there is no creepage to speak of
    still = contact.step(speed=rate * TOP, yaw_rate=rate, pitch_rate=0.0)
    (patch,) = still["patches"]
    assert patch["creep_force"] == pytest.approx([0, 0], abs=1e-6)
    # of the speed that creepages refer to there is half the standstill speed of 1 mm/s left
    assert patch["rolling_speed"] == pytest.approx(5e-4, abs=1e-9)


def test_axl_120_conical_spin() -> None:
    """Pure rolling of a cone: its inclination to the axle is all the spin."""
    place = place_of(CONE, 0.0)
    sine = CONE / hypot(1, CONE)
    check(solve(case(place)), place, (0.0, 0.0, -sine / place.radius))
    assert place.position[1] == pytest.approx(TOP - CROWN * sine, rel=1e-15)


def test_axl_121_conical_longitudinal_and_spin() -> None:
    """Pitch rate increasing linearly, to 1 % more than rolling."""
    place = place_of(CONE, 0.0)
    contact = Contact(case(place))
    sine = CONE / hypot(1, CONE)
    for share in STEPS:
        k = 0.01 * share
        mean = 1 + 0.5 * k
        expected = (-k / mean, 0.0, -(1 + k) * sine / place.radius / mean)
        check(contact.step(pitch_rate=-(1 + k) * SPEED / place.radius), place, expected)


def test_axl_122_conical_lateral_and_spin() -> None:
    """Angle of attack increasing linearly, to 20 mrad, rolling without longitudinal slip."""
    for share in STEPS:
        place = place_of(CONE, 0.02 * share)
        rate = place.free_pitch_rate(SPEED)
        expected = place.creepages(SPEED, rate, 0.0)
        assert expected[0] == pytest.approx(0.0, abs=1e-15)
        check(solve(case(place)), place, expected)


@pytest.mark.parametrize("slope", [0.0, CONE])
def test_all_at_once_on_both_sides(slope: float) -> None:
    """Longitudinal, lateral and spin creepage of a yawed wheelset with a yaw rate."""
    place = place_of(slope, 0.015)
    rate, yaw_rate = 0.995 * place.free_pitch_rate(SPEED), 0.3
    expected = place.creepages(SPEED, rate, yaw_rate)
    motion = {"pitch_rate": rate, "yaw_rate": yaw_rate}
    check(Contact(case(place)).step(**motion), place, expected)
    mirrored = {"pitch_rate": rate, "yaw_rate": -yaw_rate, "yaw": -place.yaw}
    check(Contact(case(place, "left")).step(**mirrored), place, expected, side=-1)
