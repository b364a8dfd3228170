"""Curves in sequence: closed forms, the single curve as one of them, what is refused."""

from __future__ import annotations

import math

import numpy as np
import pytest
import vehicle_scenes as scenes
from railpatch.case.load import check_table
from railpatch.errors import CaseError

from wheelset_demo.scene import scene_file
from wheelset_demo.vehicle import load_vehicle_scene
from wheelset_demo.vehicle.alignment import Alignment, AlignmentTable

CURVE = {"straight": 40.0, "transition": 60.0, "radius": -500.0, "arc": 90.0, "cant": 0.1}
SAME = [
    {"kind": "straight", "length": 40.0},
    {"kind": "transition", "length": 60.0},
    {"kind": "arc", "length": 90.0, "radius": -500.0, "cant": 0.1},
    {"kind": "transition", "length": 60.0},
    {"kind": "straight", "length": 50.0},
]
REVERSE = [
    {"kind": "straight", "length": 30.0},
    {"kind": "transition", "length": 50.0},
    {"kind": "arc", "length": 80.0, "radius": 400.0, "cant": 0.12},
    {"kind": "transition", "length": 70.0},
    {"kind": "arc", "length": 40.0, "radius": -600.0, "cant": 0.06},
]


def test_one_curve_as_sections():
    s = np.linspace(0.0, 320.0, 700)
    one = Alignment(AlignmentTable(**CURVE), 320.0)
    other = Alignment(AlignmentTable(section=SAME), 320.0)
    for name, size in (("curvature", 1e-16), ("cant_angle", 1e-15), ("heading", 1e-14)):
        found, wanted = getattr(other, name)(s), getattr(one, name)(s)
        np.testing.assert_allclose(found, wanted, rtol=0, atol=size)
    for a, b in zip(one.frames_and_bends(s), other.frames_and_bends(s), strict=True):
        np.testing.assert_allclose(a, b, rtol=0, atol=1e-11)


def test_reverse_curve():
    """From 1/400 to the right to 1/600 to the left without a straight: a transition's mean
    curvature is that of its ends, so the heading has a closed form; slopes are derivatives."""
    track = Alignment(AlignmentTable(section=REVERSE), 400.0)
    ends = np.cumsum([section["length"] for section in REVERSE])
    right, left = 1 / 400, -1 / 600
    turned = np.cumsum([0.0, 25 * right, 80 * right, 35 * (right + left), 40 * left])
    np.testing.assert_allclose(track.heading(ends), turned, atol=1e-14)
    bends = [0.0, right, right, left, left]
    np.testing.assert_allclose(track.curvature(ends), bends, atol=1e-17)
    leans = [0.0, *[math.asin(0.12 / 1.5)] * 2, *[-math.asin(0.06 / 1.5)] * 2]
    np.testing.assert_allclose(track.cant_angle(ends), leans, atol=1e-15)
    # the last one goes on
    assert track.heading(300.0) == pytest.approx(turned[-1] + 30 * left, abs=1e-14)
    s = np.linspace(1.0, 300.0, 977)
    step = 1e-4
    slope = (track.heading(s + step) - track.heading(s - step)) / (2 * step)
    np.testing.assert_allclose(slope, track.curvature(s), atol=1e-9)
    first, second = track._plan.cant_rates(s)
    rise = (track.cant_angle(s + step) - track.cant_angle(s - step)) / (2 * step)
    np.testing.assert_allclose(first, rise, atol=1e-8)
    away = np.min(np.abs(s[:, None] - np.array([30.0, 80.0, 160.0, 230.0])), axis=1)
    inside = away > 1e-3
    bend = (track._plan.cant_rates(s + step)[0] - track._plan.cant_rates(s - step)[0]) / (2 * step)
    np.testing.assert_allclose(second[inside], bend[inside], atol=1e-8)


def test_run_is_that_of_the_single_curve():
    """The vehicle on one curve, told either way."""
    run = {"speed": 40.0, "duration": 0.8, "step": 2e-3}
    ends = [
        scenes.finished(scenes.scene(alignment=alignment, **run)).state.q
        for alignment in (CURVE, {"section": SAME})
    ]
    assert abs(ends[0][1]) > 1e-4
    np.testing.assert_allclose(ends[0], ends[1], rtol=1e-12, atol=1e-8)


@pytest.mark.parametrize(
    ("sections", "message"),
    [
        (SAME[1:], "a straight or an arc at either end"),
        (SAME[:2], "a straight or an arc at either end"),
        (SAME[2:], "'straight': runs start on straight track"),
        ([*SAME[:2], *SAME[1:]], "one transition at a time"),
        ([SAME[0], SAME[2]], "a transition where curvature or cant change"),
        ([{"kind": "arc", "length": 5.0}], "at least 100 m to either side in an arc"),
        ([{"kind": "straight", "length": 5.0, "cant": 0.1}], "0 in a straight"),
        ([{"kind": "straight", "length": 5.0, "radius": 900.0}], "left out of a straight"),
    ],
)
def test_refused(sections, message):
    with pytest.raises(CaseError, match=message):
        check_table(AlignmentTable, {"section": sections}, "alignment")


def test_refused_beside_one_curve():
    with pytest.raises(CaseError, match="left out beside 'section'"):
        check_table(AlignmentTable, {"section": SAME, "radius": 500.0}, "alignment")


def test_from_a_file(tmp_path):
    """[[alignment.section]]; a first straight that is too short is refused by name."""
    text = scene_file("vehicle_straight.toml").read_text(encoding="utf-8")
    rows = "".join(
        "[[alignment.section]]\n" + "".join(f"{k} = {v!r}\n" for k, v in row.items())
        for row in REVERSE
    )
    file = tmp_path / "reverse.toml"
    file.write_text(text + "\n" + rows, encoding="utf-8")
    found = load_vehicle_scene(file).alignment.section
    assert found is not None
    assert [row.kind for row in found] == [row["kind"] for row in REVERSE]
    file.write_text(text + "\n" + rows.replace("length = 30.0", "length = 20.0"), encoding="utf-8")
    wanted = r"alignment\.section\[0\]\.length: value is 20\.0, allowed >= 21\.56"
    with pytest.raises(CaseError, match=wanted):
        load_vehicle_scene(file)
