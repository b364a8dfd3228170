"""The track in plan: closed forms."""

from __future__ import annotations

import math

import numpy as np
import pytest
from railpatch import CaseError
from railpatch.case.load import check_table

from wheelset_demo.vehicle.alignment import CANT_BASE, Alignment, AlignmentTable

RADIUS, STRAIGHT, TRANSITION, ARC, CANT = 800.0, 40.0, 90.0, 300.0, 0.12
LENGTH = STRAIGHT + 2 * TRANSITION + ARC


@pytest.fixture(scope="module", params=[1.0, -1.0], ids=["right", "left"])
def track(request) -> tuple[float, Alignment]:
    table = AlignmentTable(
        straight=STRAIGHT, transition=TRANSITION, arc=ARC, radius=request.param * RADIUS, cant=CANT
    )
    return request.param, Alignment(table, LENGTH + 200.0)


def test_straight_is_straight():
    frames, origins = Alignment(AlignmentTable(), 100.0).frames(np.array([0.0, 33.3, 99.0]))
    assert np.array_equal(frames, np.tile(np.eye(3), (3, 1, 1)))
    np.testing.assert_allclose(origins, [[0, 0, 0], [33.3, 0, 0], [99, 0, 0]], atol=1e-12)


def test_heading_of_curve(track):
    """A transition turns by half of what an arc of its length does."""
    hand, alignment = track
    after = alignment.heading(LENGTH + 50.0)
    assert after == pytest.approx(hand * (ARC + TRANSITION) / RADIUS, rel=1e-14)
    in_arc = STRAIGHT + TRANSITION + 0.5 * ARC
    assert alignment.curvature(in_arc) == pytest.approx(hand / RADIUS, rel=1e-14)
    s = np.linspace(1.0, LENGTH + 100.0, 400)
    by_differences = (alignment.heading(s + 1e-3) - alignment.heading(s - 1e-3)) / 2e-3
    np.testing.assert_allclose(alignment.curvature(s), by_differences, atol=1e-9)


def test_arc_is_a_circle(track):
    """Points of the arc have one distance from its centre; along it the way is the arc length."""
    hand, alignment = track
    s = STRAIGHT + TRANSITION + np.linspace(0.0, ARC, 41)
    _, origins = alignment.frames(s)
    heading = alignment.heading(s)
    normal = hand * np.stack([-np.sin(heading), np.cos(heading), np.zeros_like(s)], axis=1)
    centres = origins + RADIUS * normal
    # the spline's error is some 1e-9 m
    np.testing.assert_allclose(centres, np.tile(centres[0], (41, 1)), atol=1e-7)
    chord = np.linalg.norm(origins[-1] - origins[0])
    assert chord == pytest.approx(2 * RADIUS * math.sin(0.5 * ARC / RADIUS), abs=1e-7)


def test_cant_raises_the_outer_rail(track):
    hand, alignment = track
    rotations, origins = alignment.frames(np.array([STRAIGHT + TRANSITION + 10.0]))
    outer = origins[0] + rotations[0] @ [0.0, -hand * 0.5 * CANT_BASE, 0.0]
    inner = origins[0] + rotations[0] @ [0.0, hand * 0.5 * CANT_BASE, 0.0]
    # z down
    assert inner[2] - outer[2] == pytest.approx(CANT, rel=1e-12)
    assert np.linalg.det(rotations[0]) == pytest.approx(1.0, abs=1e-14)
    np.testing.assert_allclose(rotations[0].T @ rotations[0], np.eye(3), atol=1e-14)


def test_foot_is_where_x_vanishes(track):
    _, alignment = track
    rng = np.random.default_rng(5)
    s = rng.uniform(5.0, LENGTH + 50.0, 200)
    rotations, origins = alignment.frames(s)
    away = np.zeros((200, 3))
    away[:, 1:] = rng.uniform(-0.5, 0.5, (200, 2))
    places = origins + (rotations @ away[:, :, None])[:, :, 0]
    found = alignment.foot(places, s + rng.uniform(-0.2, 0.2, 200))
    np.testing.assert_allclose(found, s, atol=1e-8)


def test_bends_are_derivatives(track):
    """Of heading and cant, but for where the second derivative jumps."""
    _, alignment = track
    h = 0.05
    corners = STRAIGHT + np.array([0.0, TRANSITION, TRANSITION + ARC, LENGTH - STRAIGHT])
    s = np.linspace(5.0, LENGTH + 50.0, 300)
    s = s[np.abs(s[:, None] - corners).min(axis=1) > 6.0]
    *_, bends = alignment.frames_and_bends(s)
    angle = alignment.cant_angle
    second = (angle(s + h) - 2 * angle(s) + angle(s - h)) / h**2
    np.testing.assert_allclose(bends[:, 0], angle(s), atol=1e-9)
    np.testing.assert_allclose(bends[:, 1], alignment.curvature(s), atol=1e-9)
    first = (angle(s + h) - angle(s - h)) / (2 * h)
    np.testing.assert_allclose(bends[:, 2], first, atol=1e-5 * np.abs(first).max())
    np.testing.assert_allclose(bends[:, 3], second, atol=1e-3 * np.abs(second).max())


@pytest.mark.parametrize(
    ("table", "message"),
    [
        ({"radius": 50.0}, r"alignment.radius: value is 50.0, allowed at least 100 m"),
        ({"cant": 0.1}, r"alignment.cant: value is 0.1, allowed 0 without a radius"),
        ({"radius": 500.0, "transition": 0.0}, r"alignment.transition"),
        ({"bend": 1.0}, r"alignment.bend"),
    ],
)
def test_bad_tables(table, message):
    with pytest.raises(CaseError, match=message):
        check_table(AlignmentTable, table, "alignment")
