"""Profiles along the track with features: a blade and a crossing's nose by formula
(railpatch.profiles.turnout), wheels round which the profile changes, and what is refused."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from case_samples import with_values
from railpatch import CaseError, Contact, ProfileError, solve
from railpatch.evidence.continuity.sweep import LIMIT, Measure, jumps_of
from railpatch.evidence.continuity.sweep import Path as Sweep
from railpatch.profiles import load_profile
from railpatch.profiles.curve import Profile
from railpatch.profiles.sections import (
    MISSING,
    STEEPEST,
    edges_of,
    matching_features,
    seen_from_above,
)
from railpatch.profiles.spline import slopes
from railpatch.profiles.turnout import (
    CROWN,
    blade,
    blade_slice,
    case_of,
    case_text,
    crossing,
    crossing_slice,
    head,
    write_slices,
)

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib

Case = dict[str, Any]


def through(points: list[tuple[float, float]], spacing: float = 1e-4) -> Profile:
    """A profile of straight lines."""
    corners = np.array(points)
    way = np.append(0.0, np.cumsum(np.hypot(*np.diff(corners, axis=0).T)))
    s = np.linspace(0.0, way[-1], round(way[-1] / spacing) + 1)
    y, z = (np.interp(s, way, corners[:, k]) for k in (0, 1))
    return Profile("lines", s, y, z, slopes(s, y, "natural"), slopes(s, z, "natural"))


# --- the formulas ---------------------------------------------------------------------------------


def test_a_head_is_a_crown_between_its_faces() -> None:
    points = head(0.02, 1e-3)
    y, z = points.T
    assert (np.diff(y) > 0).all()
    # all of it right of the first face, its top in the middle, the crown's curvature there
    assert z.min() == pytest.approx(1e-3, abs=1e-7)
    assert y[z.argmin()] == pytest.approx(0.02 + 0.035, abs=3e-4)
    near = np.abs(y - 0.055) < 0.01
    fit = np.polyfit(y[near] - 0.055, z[near], 2)
    assert 2 * fit[0] == pytest.approx(1 / CROWN, rel=1e-3)


def test_slices_are_what_the_wheel_sees_from_above() -> None:
    for part in (*blade(), *crossing()):
        y = part.points[:, 0]
        assert (np.diff(y) > 0).all()
        chords = np.hypot(*np.diff(part.points, axis=0).T)
        assert list(part.features) == sorted(part.features)
        assert 0 <= part.features[-1] < chords.sum()
    # the blade hides the stock rail up to where that lies higher
    part = blade_slice(1.5)
    stock, own = head(0.028, 0.0), head(0.0, np.interp(0.028, [0.025, 0.05], [0.003, 0.0]))
    y, z = part.points.T
    inside = (y > 0.002) & (y < 0.09)
    both = np.minimum(np.interp(y, *stock.T, left=1.0), np.interp(y, *own.T, right=1.0))
    assert z[inside] == pytest.approx(both[inside], abs=2e-6)


# --- features -------------------------------------------------------------------------------------


def test_knots_go_with_features() -> None:
    a = through([(0.0, 0.0), (0.03, 0.0), (0.06, 0.01)])
    b = through([(0.0, 0.0), (0.02, 0.0), (0.07, 0.01)])
    one, two = matching_features([a, b], [(0.03,), (0.02,)])
    assert one.arc_length.size == two.arc_length.size
    k = int(np.argmin(np.abs(one.arc_length - 0.03)))
    assert one.y[k] == pytest.approx(0.03, abs=1e-5)
    assert two.y[k] == pytest.approx(0.02, abs=1e-5)
    # the parts on either side each over equal spacings
    for profile in (one, two):
        for part in (np.diff(profile.arc_length)[:k], np.diff(profile.arc_length)[k:]):
            assert part.max() - part.min() < 1e-12


def test_a_missing_part_has_knots_at_one_place() -> None:
    a = through([(0.0, 0.0), (0.06, 0.0)])
    b = through([(0.0, 0.0), (0.09, 0.0)])
    one, two = matching_features([a, b], [(0.02, 0.02), (0.02, 0.05)])
    missing = np.flatnonzero(np.diff(one.arc_length) < 1e-7)
    assert one.y[missing[-1] + 1] - one.y[missing[0]] == pytest.approx(MISSING, rel=1e-6)
    assert two.y[missing[-1] + 1] - two.y[missing[0]] == pytest.approx(0.03, rel=1e-6)
    assert one.y[missing[0]] == pytest.approx(0.02, abs=1e-9)


@pytest.mark.parametrize(
    "features", [(0.0, 0.0), (0.05, 0.05), (0.0, 0.05), (0.02, 0.02), (0.049999999, 0.05)]
)
def test_edges_lie_apart(features: tuple[float, ...]) -> None:
    profile = through([(0.0, 0.0), (0.05, 0.0)])
    edges = edges_of(profile, features)
    assert edges[0] == 0.0
    assert edges[-1] == pytest.approx(0.05, abs=1e-15)
    assert np.diff(edges).min() > 0.999 * MISSING
    assert np.abs(edges[1:-1] - features).max() < 2.001 * MISSING


@pytest.mark.parametrize("features", [(0.03, 0.02), (0.06,)])
def test_features_lie_along_the_profile(features: tuple[float, ...]) -> None:
    with pytest.raises(ProfileError, match="has a feature at"):
        edges_of(through([(0.0, 0.0), (0.05, 0.0)]), features)


def test_flanks_inside_are_laid_back() -> None:
    upright = [(0.0, 0.0), (0.02, 0.0), (0.02, 0.02), (0.05, 0.02), (0.05, 0.0), (0.08, 0.0)]
    found = seen_from_above(through(upright))
    dy, dz = np.diff(found.y), np.diff(found.z)
    assert (dy / np.hypot(dy, dz)).min() > 0.9 * STEEPEST
    # what can be touched stays
    for low, high in ((0.0, 0.0199), (0.0501, 0.08)):
        at = np.linspace(low, high, 50)
        assert np.interp(at, found.y, found.z) == pytest.approx(0.0, abs=2e-5)
    assert any("laid back" in note for note in found.notes)


def test_flanks_at_the_ends_stay() -> None:
    """Those of a rail's web are no surfaces of a gap."""
    rail = through([(0.001, 0.03), (0.0, 0.0), (0.06, 0.0), (0.059, 0.03)])
    assert seen_from_above(rail) is rail


def test_a_gap_that_narrows_downwards_is_refused() -> None:
    tight = [(0.0, 0.0), (0.02, 0.0), (0.02, 0.02), (0.021, 0.02), (0.021, 0.0), (0.05, 0.0)]
    with pytest.raises(ProfileError, match="turns back"):
        seen_from_above(through(tight))


# --- along the track ------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("kind", "start", "stop", "step", "carried"),
    [("crossing", 0.222, 0.262, 1e-4, (0.02, 0.06)), ("blade", 1.98, 2.09, 4e-4, (0.02, 0.04))],
)
def test_forces_are_continuous_through_the_transfer(
    kind: str, start: float, stop: float, step: float, carried: tuple[float, float], tmp_path: Path
) -> None:
    """The rule of docs/continuity.md: between samples 0.1 mm apart along the track (0.4 mm on the
    blade, which rises less), some 2 um of the parts' heights, no jump above 0.2 % of the wheel load
    that the slopes do not explain."""
    case = case_of(kind, tmp_path)
    path = Sweep("x", lambda x: {"x": x}, start, stop, 1e-4, 1e-4)
    measure = Measure(case, path, case["wheelset"]["vertical_force"])
    samples = measure.samples(start, stop, step)
    assert {sample.status for sample in samples} == {"converged"}
    assert jumps_of(samples).max() < LIMIT
    # from one part of the rail to the other: patches at both, and the load on one at either end
    assert max(len(shares) for sample in samples for shares in sample.shares) > 1
    places = []
    for x in (start, stop):
        (patch,) = measure.contact.step(x=x)["patches"]
        places.append(patch["position"][1] - 0.7175)
    assert min(places) < carried[0] < carried[1] < max(places)


@pytest.mark.parametrize("kind", ["blade", "crossing"])
def test_forces_are_continuous_where_the_tip_begins(kind: str, tmp_path: Path, measured) -> None:
    """The slopes of the knots turn there, but those under the wheel go on evenly: the rule of
    docs/continuity.md, in steps of 50 um through the millimetre in which blade and nose appear."""
    start, stop, step = -2.5e-3, 2.5e-3, 5e-5
    path = Sweep("x", lambda x: {"x": x}, start, stop, step, step)
    case = case_of(kind, tmp_path)
    samples = Measure(case, path, case["wheelset"]["vertical_force"]).samples(start, stop, step)
    assert {sample.status for sample in samples} == {"converged"}
    jump = jumps_of(samples).max()
    measured(f"{kind}: {jump:.4f} % of the load at the tip")
    assert jump < LIMIT


def test_what_lies_above_a_hidden_face_stays_where_it_is() -> None:
    """Features of the stock rail where the blade begins: the same place of it on both sides."""
    before, after = (next(part for part in blade() if part.position == x) for x in (-1e-3, 0.0))
    for feature in (1, 2):
        places = []
        for part in (before, after):
            way = np.append(0.0, np.cumsum(np.hypot(*np.diff(part.points, axis=0).T)))
            at = part.features[feature]
            places.append([np.interp(at, way, part.points[:, k]) for k in (0, 1)])
        # the rail's face leaves the gauge line by 1 : 60
        assert places[1] == pytest.approx([places[0][0] + 1e-3 / 60, places[0][1]], abs=2e-5)


def test_a_slice_is_its_own_rail(tmp_path: Path) -> None:
    """At a slice the forces are those of a rail with that profile alone, but for what the pressure
    has along the track as the rail rises and falls: test_section_power.py."""
    case = case_of("crossing", tmp_path)
    sections = case["track"]["right"]["sections"]
    alone = with_values(case, track__section_blend=None)
    contact = Contact(case)
    for index in (0, 4, -3):
        section = sections[index]
        alone["track"]["right"]["sections"] = [section]
        found = contact.step(x=section["position"])
        expected = solve(with_values(alone, wheelset__x=section["position"]))
        scale = case["wheelset"]["vertical_force"]
        assert found["force"][1:] == pytest.approx(expected["force"][1:], rel=0, abs=1e-3 * scale)
        for patch, other in zip(found["patches"], expected["patches"], strict=True):
            creep = pytest.approx(other["creep_force"], rel=0, abs=1e-3 * scale)
            assert patch["creep_force"] == creep
        assert found["z"] == pytest.approx(expected["z"], rel=0, abs=1e-7)


def test_between_slices_is_nearly_the_formula(tmp_path: Path) -> None:
    """Half-way between slices 75 mm apart against a slice drawn there, on the nose."""
    case = case_of("crossing", tmp_path)
    contact = Contact(case)
    for x in (0.4125, 0.6375):
        (tmp_path / f"at {x}").mkdir()
        text = case_text(write_slices("crossing", [crossing_slice(x)], tmp_path / f"at {x}"))
        drawn = tomllib.loads(text)
        (section,) = drawn["track"]["right"]["sections"]
        section["profile"] = str(tmp_path / f"at {x}" / section["profile"])
        del drawn["track"]["section_blend"]
        expected = solve(drawn)
        found = contact.step(x=x)
        # of a top that changes its slope once, at 0.35 m, cubics lie off by tens of micrometres
        assert found["z"] == pytest.approx(expected["z"], rel=0, abs=1e-4)
        assert found["force"] == pytest.approx(expected["force"], rel=0, abs=0.01 * 8e4)


def test_left_is_the_mirror_image(tmp_path: Path) -> None:
    case = case_of("blade", tmp_path)
    right = Contact(case)
    track = {**case["track"], "left": {**case["track"]["right"], "origin": [-0.7175, 0.0]}}
    del track["right"]
    left = Contact(with_values(case, track=track, wheel__side="left"))
    for x in (0.4, 2.02, 2.4):
        a, b = right.step(x=x), left.step(x=x)
        assert b["force"] == [a["force"][0], -a["force"][1], a["force"][2]]


def test_the_other_rail_is_not_read(tmp_path: Path) -> None:
    """As runs of a wheelset ask for one wheel alone: sections of the other side, and what is said
    of them, are left."""
    case = case_of("blade", tmp_path)
    other = with_values(case, wheel__side="left", profiles__rail_left="UIC60@1:40")
    plain = with_values(other, track={"gauge": 1.435}, profiles__rail_file=None)
    assert solve(other)["force"] == solve(plain)["force"]


# --- round the wheel ------------------------------------------------------------------------------


def test_a_wheel_of_sections_has_the_radius_that_is_lowest(tmp_path: Path) -> None:
    """A tread of two radii 0.2 mm apart half a turn from each other, linear in between."""
    points = np.loadtxt(tmp_path / wheel_file(tmp_path, "round.txt", 0.0))
    assert points.shape[1] == 2
    sections = [
        {"angle": 0.0, "profile": str(tmp_path / "round.txt")},
        {"angle": 2.0, "profile": str(tmp_path / wheel_file(tmp_path, "more.txt", 0.2))},
    ]
    base = {
        "kind": "wheel_rail",
        "wheelset": {
            "vertical_force": 6e4,
            "speed": 20.0,
            "pitch_rate": -43.5,
            "nominal_radius": 0.46,
            "flange_back_distance": 1.36,
            "flange_back_position": -0.07,
            "right": {"sections": sections},
        },
        "track": {"gauge": 1.435},
        "profiles": {
            "wheel": "S1002",
            "rail": "UIC60@1:40",
            "smoothing": 0.0,
            "wheel_file": {"unit": "mm", "swap": False, "mirror": "none"},
        },
        "friction": {"coefficient": 0.3},
        "method": {"normal": "hertz", "tangential": "fastsim"},
    }
    contact = Contact(base)
    at = {angle: contact.step(pitch=angle) for angle in (0.0, 0.5, 1.0, 2.0, 2.0 * np.pi)}
    for angle, share in ((0.5, 0.25), (1.0, 0.5), (2.0, 1.0), (2.0 * np.pi, 0.0)):
        rise = at[angle]["rolling_radius"] - at[0.0]["rolling_radius"]
        assert rise == pytest.approx(2e-4 * share, abs=1e-8)
        assert at[angle]["z"] - at[0.0]["z"] == pytest.approx(-2e-4 * share, abs=1e-7)


def wheel_file(folder: Path, name: str, radius: float) -> str:
    """S1002 with another radius, mm."""
    wheel = load_profile("S1002", "wheel")
    rows = np.column_stack([1e3 * wheel.y, 1e3 * wheel.z + radius])
    np.savetxt(folder / name, rows, fmt="%.9f")
    return name


# --- what is refused ------------------------------------------------------------------------------

UIC = [{"position": x, "profile": "UIC60"} for x in (0.0, 1.0)]


def sections(*changes: Case, **more: Any) -> Case:
    """Changes of a case: the right rail's sections."""
    parts = [{**part, **change} for part, change in zip(UIC, changes, strict=True)]
    return {"track": {"right": {"sections": parts, **more.pop("right", {})}, **more}}


@pytest.mark.parametrize(
    ("values", "message"),
    [
        (sections({"features": [0.02]}, {}), r"sections: value is 0 features, allowed as many"),
        (sections({"features": [0.02]}, {"features": [0.02, 0.03]}), "value is 2 features"),
        (sections({"features": [0.02]}, {"features": [9.0]}), r"features\[0\]: value is 9"),
        (sections({"features": [0.02]}, {"features": [1.0]}), "has a feature at 1 m, allowed"),
        (sections({"features": [0.03, 0.02]}, {"features": [0.02, 0.03]}), "has a feature at"),
        (sections({"kink": True}, {}), r"sections\[0\]\.kink: value is true"),
        (sections({}, {}, section_blend="quintic"), "section_blend"),
        ({"track": {"section_blend": "cubic"}}, "section_blend: value is 'cubic', allowed with"),
        ({"track": {"right": {"origin": [0.75]}}}, "track.right.origin"),
        ({"track": {"right": {"origin": [11.0, 0.0]}}}, "rail_origin_y|origin"),
        (
            {"track": {"kind": "roller", "roller_radius": 1.0, "right": {"origin": [0.7, 0.0]}}},
            r"right\.origin: value is \[0\.7, 0\.0\], allowed none with kind = 'roller'",
        ),
        (
            {"wheelset__right": {"sections": [{"angle": 6.3, "profile": "S1002"}]}},
            r"sections\[0\]\.angle: value is 6\.3",
        ),
        (
            {"wheelset__right": {"sections": [{"angle": 1.0, "profile": "S1002"}] * 2}},
            "angles that increase, more than 1 rad",
        ),
        ({"wheelset__right": {"sections": [{"angle": 0.0, "profile": "?"}]}}, r"\?"),
    ],
)  # fmt: skip
def test_what_is_refused(values: Case, message: str) -> None:
    base = {
        "kind": "wheel_rail",
        "wheelset": {
            "vertical_force": 6e4,
            "speed": 20.0,
            "pitch_rate": -43.5,
            "nominal_radius": 0.46,
            "flange_back_distance": 1.36,
            "flange_back_position": -0.07,
        },
        "track": {"gauge": 1.435},
        "profiles": {"wheel": "S1002"},
        "friction": {"coefficient": 0.3},
    }
    if "sections" not in str(values.get("track")):
        base["profiles"]["rail"] = "UIC60"
    with pytest.raises((CaseError, ProfileError), match=message):
        Contact(with_values(base, **values))
