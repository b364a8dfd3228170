"""Curves, cant, gauge, rates of deviations, friction and profiles along the track, by hand.

Bounds: 1e-12 where two ways of saying the same thing are compared or a formula takes the results'
own contact point, 1e-9 m in positions (APPROACH is so little that wheels touch in a point).
"""

from __future__ import annotations

from math import asin, atan, cos, sin, sqrt
from typing import Any

import numpy as np
import pytest
from case_samples import WHEELSET, with_values
from railpatch import CaseError, Contact, solve
from scipy.optimize import brentq

SAME = 1e-12  # relative to the greatest value compared
GEOMETRY = 1e-9  # m
SPEED, RADIUS = 20.0, 0.46
APPROACH = 1e-8
GAUGE, BACK_DISTANCE, BACK_POSITION = 1.435, 1.36, -0.07
MARKER = 0.5 * BACK_DISTANCE - BACK_POSITION
CONE = 1 / 20
# m, half width of a built-in crown: it ends above 14 mm depth, there the gauge is measured
CROWN_END = 0.07
FAST = {"method": {"normal": "hertz", "tangential": "fastsim"}}


def wheelset(**values: Any) -> dict[str, Any]:
    """S1002 on UIC60 at 20 m/s, with simple theories."""
    case = {**WHEELSET, **FAST, "grid": {"element_size": [1e-3, 1e-3]}}
    values = {"wheelset__speed": SPEED, "wheelset__pitch_rate": -SPEED / RADIUS, **values}
    return with_values(case, **values)


def wheel(rail: str = "arc@0.3", **values: Any) -> dict[str, Any]:
    """A right wheel with a conical tread."""
    case = {
        "kind": "wheel_rail",
        "friction": {"coefficient": 0.3},
        "grid": {"elements": [9, 9]},
        **FAST,
        "wheelset": {
            "vertical_force": 6e4,
            "speed": SPEED,
            "pitch_rate": -SPEED / RADIUS,
            "nominal_radius": RADIUS,
            "flange_back_distance": BACK_DISTANCE,
            "flange_back_position": BACK_POSITION,
        },
        "track": {"gauge": GAUGE},
        "profiles": {"wheel": "cone@1:20", "rail": rail},
    }
    if "wheelset__z" in values:
        values["wheelset__vertical_force"] = None
    return with_values(case, **values)


def slips(result: Any) -> np.ndarray:
    """m/s and rad/s: creepages times rolling speed of every patch."""
    sides = [result[s] for s in ("left", "right")] if "left" in result.data else [result]
    found = [
        np.multiply([*p["creepage"], p["spin_creepage"]], p["rolling_speed"])
        for side in sides
        for p in side["patches"]
    ]
    assert result.status == "converged"
    assert len(found) >= len(sides)
    return np.array(found)


def same(found: Any, expected: Any, tolerance: float = SAME) -> None:
    """Equal but for a share of the greatest."""
    size = np.abs(np.asarray(expected)).max()
    np.testing.assert_allclose(found, expected, rtol=0, atol=tolerance * size)


# --- rates of deviations ---------------------------------------------------------------------

RATES = {"vy": 0.11, "vz": -0.07, "roll_rate": 0.3, "yaw_rate": -0.2}


def wheel_rates(yaw: float, roll: float, side: int) -> dict[str, list[float]]:
    """Of a wheel that moves as the wheelset with RATES would, wheelset axes.

    The wheelset turns by w and moves by v: a point q of it by v + w x q. The rates of a deviation
    are about the profile's origin (x) and the axis below it (y, z).
    """
    c, s, d, t = cos(roll), sin(roll), cos(yaw), sin(yaw)
    axes = np.array([[d, -t, 0], [c * t, c * d, -s], [s * t, s * d, c]])
    turning = axes.T @ (RATES["roll_rate"] * np.array([1, 0, 0.0]))
    turning += axes.T @ (RATES["yaw_rate"] * np.array([0, -s, c]))
    moving = axes.T @ [0, RATES["vy"], RATES["vz"]]
    origin, axis = np.array([0, side * MARKER, RADIUS]), np.array([0, side * MARKER, 0])
    moving += np.cross(turning * [1, 0, 0], origin) + np.cross(turning * [0, 1, 1], axis)
    return {"velocity": moving.tolist(), "angular_velocity": turning.tolist()}


@pytest.mark.parametrize("yaw", [0.0, 0.02])
def test_rates_of_both_wheels_as_those_of_the_wheelset(yaw: float) -> None:
    place = {"y": 0.002, "yaw": yaw, "roll": 1e-4, "z": 3e-4}
    contact = Contact(wheelset(**{f"wheelset__{k}": v for k, v in place.items()}))
    still = slips(contact.step())
    expected = slips(contact.step(**RATES))
    wheels = {s: wheel_rates(yaw, 1e-4, i) for s, i in (("left", -1), ("right", 1))}
    found = slips(contact.step(**dict.fromkeys(RATES, 0.0), **wheels))
    assert np.abs(expected - still).max() > 0.05
    same(found, expected)


def test_a_wheels_rate_about_its_axle_is_a_pitch_rate() -> None:
    contact = Contact(wheelset(wheelset__z=3e-4, wheelset__yaw=0.01))
    expected = slips(contact.step(pitch_rate=-SPEED / RADIUS - 0.5))
    turned = {"angular_velocity": [0, -0.5, 0]}
    found = slips(contact.step(pitch_rate=-SPEED / RADIUS, left=turned, right=turned))
    same(found, expected)


@pytest.mark.parametrize("rule", ["blended", "contact"])
@pytest.mark.parametrize("kind", ["rail", "roller"])
def test_wheel_and_rail_moving_together_do_not_slip(kind: str, rule: str) -> None:
    """A rigid motion of both about the wheelset's centre leaves the slip as it was; by the rule of
    the program CONTACT but for the approach."""
    roller = {"kind": "roller", "roller_radius": 0.5, "roller_pitch_rate": SPEED / 0.5}
    track = {"gauge": GAUGE, **(roller if kind == "roller" else {})}
    speed = 0.0 if kind == "roller" else SPEED
    values = {"track": track, "wheelset__speed": speed, "method__patch_rule": rule}
    z = solve(wheel(**values))["z"]
    contact = Contact(wheel(**values, wheelset__z=z))
    first = contact.step()
    still = slips(first)
    moving = slips(contact.step(**RATES, speed=speed + 0.3))
    assert np.abs(moving - still).max() > 0.1
    turning = np.array([RATES["roll_rate"], 0, RATES["yaw_rate"]])
    # the crown's top is its profile's origin; the centre lies a radius above the tops at z = 0
    arm = np.array([0, 0.5 * GAUGE + CROWN_END, RADIUS - z])
    velocity = np.array([0.3, RATES["vy"], RATES["vz"]]) + np.cross(turning, arm)
    rail = {"velocity": velocity.tolist(), "angular_velocity": turning.tolist()}
    found = contact.step(track={"right": rail})
    # the wheel's undeformed point lies the approach further along the normal than the rail's
    a, approach = first["patches"][0]["contact_angle"], first["patches"][0]["approach"]
    apart = approach if rule == "contact" else 0.0
    ahead = np.cross(turning, apart * np.array([0, -sin(a), cos(a)]))
    slip = [ahead[0], ahead[1] * cos(a) + ahead[2] * sin(a), 0.0]
    same(slips(found), still + slip)


def test_a_rollers_rate_about_its_axle_is_its_pitch_rate() -> None:
    track = {"gauge": GAUGE, "kind": "roller", "roller_radius": 0.5}
    contact = Contact(wheel(track=track, wheelset__speed=0.0))
    expected = slips(contact.step(roller_pitch_rate=40.0))
    turned = {"right": {"angular_velocity": [0, 1.5, 0]}}
    same(slips(contact.step(roller_pitch_rate=38.5, track=turned)), expected)


# --- curve, cant, gauge ----------------------------------------------------------------------


@pytest.mark.parametrize("curvature", [1 / 175, -1 / 600])
@pytest.mark.parametrize("y", [0.0, 0.004])
def test_creepages_in_a_curve(curvature: float, y: float) -> None:
    """The wheel's point at y is carried by V (1 - y/R), V/R x across (x = 0 without yaw); the
    track's frame turns by V/R about z, and the axle by w about y. n = (0, -sin a, cos a)."""
    rate = -SPEED / RADIUS
    case = wheelset(wheelset__y=y, wheelset__z=3e-4, track__curvature=curvature)
    result = solve(case)
    for side in ("left", "right"):
        (patch,) = result[side]["patches"]
        a, approach = patch["contact_angle"], patch["approach"]
        at = patch["position"][1] - approach * sin(a)
        # the height of the point below the axle, which is level, is the rolling radius
        r = result[side]["rolling_radius"]
        carried, turned = SPEED * (1 - curvature * at), rate * r
        mean = 0.5 * (abs(carried) + abs(turned))
        expected = [(carried + turned) / mean, 0.0, 0.0]
        expected[2] = (SPEED * curvature * cos(a) - rate * sin(a)) / mean
        same([*patch["creepage"], patch["spin_creepage"]], expected)
        assert patch["rolling_speed"] == pytest.approx(mean, rel=SAME)


@pytest.mark.parametrize("cant", [0.0, 0.025, 1 / 20])
def test_a_canted_crown_touches_where_its_circle_does(cant: float) -> None:
    """A crown of radius R turned about its top has the centre of its circle at (R sin c, R cos c)
    from there; it lies so that its highest point is at z = 0 and its turned inner end at half the
    gauge. The cone touches the circle where it has the cone's slope."""
    crown = 0.3
    end = np.array([-CROWN_END, crown - sqrt(crown**2 - CROWN_END**2)])
    inner = cos(cant) * end[0] + sin(cant) * end[1]
    centre = 0.5 * GAUGE - inner + crown * sin(cant)
    angle = -atan(CONE)
    y, z = centre + crown * sin(angle), crown * (1 - cos(angle))
    # the wheel's tread at that place, an approach deeper along the normal
    u = y - APPROACH * sin(angle) - MARKER
    height = z + APPROACH * cos(angle) + CONE * u
    result = solve(wheel(wheelset__z=height, track__cant=cant))
    (patch,) = result["patches"]
    assert patch["position"][1:] == pytest.approx([y, z], rel=0, abs=GEOMETRY)
    assert patch["contact_angle"] == pytest.approx(angle, rel=0, abs=GEOMETRY)


def test_gauge_widening_is_a_wider_gauge_and_rails_moved_out() -> None:
    widening = 0.012
    found = solve(wheelset(wheelset__z=3e-4, track__gauge_widening=widening))
    wider = solve(wheelset(wheelset__z=3e-4, track__gauge=1.435 + widening))
    out = {"left": {"offset": [0, -widening / 2, 0]}, "right": {"offset": [0, widening / 2, 0]}}
    moved = Contact(wheelset(wheelset__z=3e-4)).step(track=out)
    for side in ("left", "right"):
        same(found[side]["force"], wider[side]["force"])
        same(found[side]["force"], moved[side]["force"], 1e-9)
    narrow = solve(wheelset(wheelset__z=3e-4))
    assert abs(found["right"]["force"][2] / narrow["right"]["force"][2] - 1) > 0.01


# --- friction along the track ----------------------------------------------------------------

METHODS = {
    "full": {"method": {"normal": "half_space", "tangential": "full"}},
    "fitted": {"method": {"normal": "hertz", "tangential": "full"}, "grid": {"fitted": [9, 9]}},
    "fastsim": {},
    "fastrip": {"method": {"normal": "hertz", "tangential": "fastrip"}},
    "polach": {"method": {"normal": "hertz", "tangential": "polach"}},
    "table": {"method": {"normal": "hertz", "tangential": "table"}},
}
ALONG = [[10.0, 1.0], [20.0, 0.5], [40.0, 1.5]]


@pytest.mark.parametrize("method", METHODS)
def test_friction_along_the_track_is_another_coefficient(method: str) -> None:
    values = {"wheelset__yaw": 0.004, **METHODS[method]}
    contact = Contact(wheel(friction={"coefficient": 0.3, "along_track": ALONG}, **values))
    for x, factor in ((-5, 1.0), (10, 1.0), (15, 0.75), (20, 0.5), (30, 1.0), (1e4, 1.5)):
        contact.reset()
        found = contact.step(x=float(x))
        plain = solve(wheel(friction={"coefficient": 0.3 * factor}, **values))
        same(found["force"], plain["force"])
        for key in ("error_estimate", "creep_force", "friction_power"):
            assert found["patches"][0][key] == pytest.approx(plain["patches"][0][key], nan_ok=True)


def test_friction_along_the_track_times_a_law_of_slip() -> None:
    def friction(factor: float) -> dict[str, Any]:
        law = {"law": "slip_velocity", "kinetic": 0.2 * factor, "amplitude": 0.2 * factor}
        return {**law, "halving_speed": 0.5}

    full = {"method": {"tangential": "full"}, "wheelset__yaw": 0.01}
    along = friction(1.0) | {"along_track": ALONG}
    found = Contact(wheel(friction=along, **full)).step(x=20.0, fields=True)
    plain = solve(wheel(friction=friction(0.5), **full), fields=True)
    same(found["force"], plain["force"], 1e-6)
    same(found["patches"][0]["friction"], plain["patches"][0]["friction"], 1e-4)


# --- profiles along the track ----------------------------------------------------------------


def sections(*pairs: tuple[float, str]) -> dict[str, Any]:
    """Of the right rail."""
    listed = [{"position": x, "profile": name} for x, name in pairs]
    return {"track": {"gauge": GAUGE, "right": {"sections": listed}}, "profiles__rail": None}


def test_equal_sections_are_one_profile() -> None:
    contact = Contact(wheel(**sections((0.0, "UIC60@1:40"), (4.0, "UIC60@1:40"))))
    plain = solve(wheel("UIC60@1:40"))
    first = contact.step(x=-1.0)
    assert first.status == "converged"
    for x in (0.0, 0.7, 3.9, 4.0, 9.0):
        contact.reset()
        found = contact.step(x=x)
        assert found["force"] == first["force"]
    # other knots on the same curve: at kinks of its curvature within 1e-4 m
    same(found["force"], plain["force"], 1e-4)


@pytest.mark.parametrize("share", [0.0, 0.25, 0.5, 1.0])
def test_between_two_crowns(share: float) -> None:
    """Crowns of radii R, from -70 to 70 mm, over the share p of their half arc length R t,
    t = asin(0.07/R): y = R sin(t p), z = R (1 - cos(t p)); both y and z mixed at equal p. The cone
    touches where dz/dy is its slope; the inner end stays at -70 mm."""
    crowns = ((1 - share, 0.3), (share, 0.2))

    def mixed(function: Any, p: float, power: int) -> float:
        return sum(
            w * r * asin(CROWN_END / r) ** power * function(asin(CROWN_END / r) * p)
            for w, r in crowns
        )

    p = brentq(lambda p: mixed(sin, p, 1) + CONE * mixed(cos, p, 1), -0.5, 0.5, xtol=1e-15)
    y = 0.5 * GAUGE + CROWN_END + mixed(sin, p, 0)
    z = mixed(lambda a: 1 - cos(a), p, 0)
    angle = -atan(CONE)
    u = y - APPROACH * sin(angle) - MARKER
    height = z + APPROACH * cos(angle) + CONE * u
    case = wheel(wheelset__z=height, **sections((1.0, "arc@0.3"), (3.0, "arc@0.2")))
    result = Contact(case).step(x=1 + 2 * share)
    (patch,) = result["patches"]
    assert patch["position"][1:] == pytest.approx([y, z], rel=0, abs=GEOMETRY)
    assert patch["contact_angle"] == pytest.approx(angle, rel=0, abs=1e-8)


def test_a_change_of_profile_passes_without_a_jump() -> None:
    """From one inclination of the rail to another over 2 m, at 1 cm steps; ends as the profiles."""
    load = {"wheelset__yaw": 1e-3}
    track = sections((0.0, "UIC60@1:40"), (2.0, "UIC60@1:20"))
    contact = Contact(wheel(**load, **track))
    path = [contact.step(x=float(x)) for x in np.arange(-0.05, 2.051, 0.01)]
    assert {r.status for r in path} == {"converged"}
    for found, name in ((path[0], "UIC60@1:40"), (path[-1], "UIC60@1:20")):
        same(found["force"], solve(wheel(name, **load))["force"], 2e-3)
    place = np.array([r["patches"][0]["position"][1] for r in path])
    assert abs(place[-1] - place[0]) > 1e-3
    assert np.abs(np.diff(place)).max() < 0.2 * abs(place[-1] - place[0])


def test_x_says_nothing_where_nothing_varies() -> None:
    contact = Contact(wheelset(wheelset__z=3e-4))
    first = contact.step(x=0.0, pitch=0.0)
    contact.reset()
    second = contact.step(x=123.4, pitch=2.0, time_step=1e-3)
    for side in ("left", "right"):
        assert first.to_dict()[side] == second.to_dict()[side]


@pytest.mark.parametrize(
    ("values", "message"),
    [
        ({"track__gauge_widening": 0.2}, "track.gauge_widening"),
        ({"friction__along_track": [[1.0, 1.0]]}, "friction.along_track"),
        ({"friction__along_track": [[1.0, 1.0], [1.0, 2.0]]}, "friction.along_track"),
        ({"friction__along_track": [[1.0, 1.0], [2.0, -2.0]]}, "friction.along_track"),
        ({"track__right": {"sections": []}}, "track.right.sections"),
        (sections((1.0, "UIC60"), (1.0, "UIC60")), "track.right.sections"),
        (sections((0.0, "no such profile")), "no such profile"),
        (
            {"track__right": {"sections": [{"position": 0.0, "profile": "UIC60"}]}},
            "profiles.rail: value is 'arc@0.3', allowed none: it must be left out",
        ),
        ({"wheelset__time_step": -1.0}, "wheelset.time_step"),
        ({"wheelset__right": {"velocity": [0.0, 0.0]}}, "wheelset.right.velocity"),
    ],
)  # fmt: skip
def test_what_is_refused(values: dict[str, Any], message: str) -> None:
    with pytest.raises(ValueError, match=message):
        Contact(wheel(**values))


def test_sections_do_not_move() -> None:
    contact = Contact(wheel(**sections((0.0, "UIC60"))))
    with pytest.raises(CaseError, match=r"track\.right\.sections"):
        contact.step(track={"right": {"sections": []}})
    moved = contact.step(track={"right": {"offset": [0.0, 0.0, 1e-6]}})
    assert moved.status in ("converged", "no_contact")
