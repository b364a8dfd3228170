"""Irregularities of the rails: a record's spline, and what the contact makes of it."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from case_samples import WHEELSET, with_values
from railpatch import CaseError, Contact
from railpatch.case.track import Irregularity, read_irregularity

SPEED, RADIUS = 20.0, 0.46
SAME = 1e-12


def wheelset(**values: Any) -> dict[str, Any]:
    """Wheels of a cylinder's and rails of a crown's profile, fast theories."""
    case = {
        **WHEELSET,
        "grid": {"elements": [12, 12]},
        "method": {"normal": "hertz", "tangential": "fastsim"},
        "profiles": {"wheel": "cylinder", "rail": "arc@0.3"},
    }
    start = {"wheelset__speed": SPEED, "wheelset__pitch_rate": -SPEED / RADIUS}
    return with_values(case, **{**start, "wheelset__z": 1e-4, **values})


def wave(x: np.ndarray) -> np.ndarray:
    """m, [n, 4]: 1 mm lateral and 0.05 mm vertical over 4 m."""
    turn = 2 * np.pi * x / 4
    lateral, vertical = 1e-3 * np.cos(turn), 5e-5 * np.cos(turn)
    return np.column_stack([lateral, vertical, lateral, -vertical])


def test_spline_meets_a_wave_with_the_fourth_power_of_the_spacing() -> None:
    fine = np.linspace(0, 4, 1001)
    errors = []
    for count in (21, 41, 81):
        x = np.linspace(0, 4, count)
        record = Irregularity(x, wave(x))
        found = np.array([record.at(at).ravel() for at in fine])
        errors.append(np.abs(found - wave(fine)).max())
        np.testing.assert_allclose(record.at(x[7]).ravel(), wave(x[7:8])[0], atol=1e-18)
    assert np.diff(np.log2(errors)) == pytest.approx([-4, -4], abs=0.3)


def test_beyond_the_record_it_is_constant() -> None:
    record = Irregularity([0.0, 1.0, 3.0], np.arange(12.0).reshape(3, 4) * 1e-4)
    assert record.at(-5).ravel().tolist() == pytest.approx([0, 1e-4, 2e-4, 3e-4])
    assert record.at(9).ravel().tolist() == pytest.approx([8e-4, 9e-4, 10e-4, 11e-4])
    assert not record.slope(-5).any()
    assert not record.slope(9).any()


def test_a_record_is_an_offset_of_the_rails(tmp_path: Path) -> None:
    x = np.linspace(0, 4, 41)
    table = np.column_stack([x, wave(x)])
    np.savetxt(tmp_path / "track.csv", table, delimiter=",", header="x, ...", fmt="%.17g")
    contact = Contact(wheelset(track__irregularity="track.csv"), folder=tmp_path)
    plain = Contact(wheelset())
    record = read_irregularity(tmp_path / "track.csv")
    for at in (-1.0, 0.31, 2.0, 3.77, 8.0):
        left, right = record.at(at)
        rates = SPEED * record.slope(at)[:, 1]
        moved = {
            "left": {"offset": [0, *left], "velocity": [0, 0, rates[0]]},
            "right": {"offset": [0, *right], "velocity": [0, 0, rates[1]]},
        }
        found, expected = contact.step(x=at), plain.step(track=moved)
        assert found["force"] == pytest.approx(expected["force"], rel=SAME, abs=1e-7)


def test_a_wheelset_that_follows_the_rails_does_not_slip() -> None:
    """Rails that swing sideways stand still: a wheelset moving along them, turned into their
    direction, rolls on cylinders without lateral creepage. Its yaw turns the material's velocity
    of rolling, V, into the lateral one of its own motion."""
    x = np.linspace(0, 4, 81)
    record = Irregularity(x, wave(x))
    contact = Contact(wheelset())
    for at in (0.4, 1.0, 2.3):
        lateral, slope = record.at(at)[0, 0], record.slope(at)[0, 0]
        rails = {"offset": [0, lateral, 0]}
        found = contact.step(
            y=lateral, yaw=np.arctan(slope), vy=SPEED * slope, track={"left": rails, "right": rails}
        )
        straight = contact.step(y=lateral, yaw=0.0, vy=SPEED * slope)
        for side in ("left", "right"):
            (patch,) = found[side]["patches"]
            (other,) = straight[side]["patches"]
            assert abs(patch["creepage"][1]) < 1e-6
            assert abs(other["creepage"][1]) > 3e-4


def test_a_wheelset_that_climbs_does_not_slip(tmp_path: Path) -> None:
    """On a gradient of both rails, with the vertical speed that it asks for: the forces are those
    of level track, though the contacts lean."""
    slope = 2e-3
    table = np.array([[x, 0.0, slope * x, 0.0, slope * x] for x in np.linspace(0.0, 40.0, 41)])
    np.savetxt(tmp_path / "track.csv", table)
    lean = {"wheelset__y": 3e-3, "profiles__wheel": "S1002", "profiles__rail": "UIC60@1:40"}
    lean |= {"wheelset__z": 2e-4}
    level = Contact(wheelset(**lean)).step()
    climbing = Contact(wheelset(**lean, track__irregularity="track.csv"), folder=tmp_path)
    # in the middle, where the record's ends without slope are far away
    at = {"x": 20.0, "z": 2e-4 + 20.0 * slope}
    follows, rests = climbing.step(**at, vz=SPEED * slope), climbing.step(**at, vz=0.0)
    (wanted,), (found,), (slipping,) = (one["right"]["patches"] for one in (level, follows, rests))
    false = slope * np.sin(wanted["contact_angle"])
    assert abs(false) > 5e-5
    assert found["creepage"][1] == pytest.approx(wanted["creepage"][1], abs=1e-3 * abs(false))
    assert abs(slipping["creepage"][1] - wanted["creepage"][1]) == pytest.approx(
        abs(false), rel=0.01
    )


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "0 rows"),
        ("0 0 0 0 0\n", "1 rows"),
        ("0 0 0 0 0\n1 0 0 0\n", ":2: 4 values"),
        ("0 0 0 0 0\n1 0 0 x 0\n", ":2: value is 'x'"),
        ("1 0 0 0 0\n0 0 0 0 0\n", "x is 0 after a greater one"),
        ("0 0 0 0 0\n1 0 nan 0 0\n", "'nan'"),
    ],
)
def test_bad_records_are_refused(tmp_path: Path, text: str, message: str) -> None:
    (tmp_path / "track.csv").write_text(text)
    with pytest.raises(CaseError, match=message) as error:
        Contact(wheelset(track__irregularity="track.csv"), folder=tmp_path)
    assert "track.irregularity" in str(error.value)


def test_a_missing_record_is_named(tmp_path: Path) -> None:
    with pytest.raises(CaseError, match=r"track\.irregularity.*cannot be read"):
        Contact(wheelset(track__irregularity="none.csv"), folder=tmp_path)
