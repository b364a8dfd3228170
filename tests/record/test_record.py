"""Records of measured runs: any columns and units, gaps, wrong units, the filter."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from railpatch.errors import CaseError, RecordError
from railpatch.record import MeasuredColumn, low_passed, read_record, resampled
from railpatch.record.columns import load_columns
from railpatch.record.doubts import force_doubts, sign_doubts
from railpatch.record.quantities import QUANTITIES
from railpatch.record.units import UNITS

from wheelset_demo.vehicle import measured_track

YAW = {"yaw": MeasuredColumn(name="AoA")}


def written(tmp_path: Path, text: str | bytes) -> Path:
    path = tmp_path / "run.csv"
    path.write_bytes(text if isinstance(text, bytes) else text.encode())
    return path


# the same three rows as machines of several makes write them
TABLE = "time [s],AoA [mrad],y [mm]\n0,1.5,-2\n0.5,2.5,\n1,3.5,-4.25\n"
FORMS = {
    "comma": TABLE,
    "tab": TABLE.replace(",", "\t"),
    "semicolon, decimal comma": TABLE.replace(",", ";").replace(".", ","),
    "byte order mark, end of line of DOS": "\ufeff" + TABLE.replace("\n", "\r\n"),
    "utf-16": TABLE.encode("utf-16"),
    "a line of units": TABLE.replace(" [s]", "")
    .replace(" [mm]", "")
    .replace("\n0,", "\ns,,(mm)\n0,", 1),
    "units in round brackets": TABLE.replace("[", "(").replace("]", ")"),
    "comments, the last one with the names": "# rig 7\n# " + TABLE,
    "NaN and dashes": TABLE.replace("2.5,", "2.5,---").replace("\n1", "\n\n1"),
    "quoted": '"time [s]","AoA [mrad]","y [mm]"' + TABLE[TABLE.index("\n") :],
    "too many separators": TABLE.replace("\n", ",,\n"),
}


@pytest.mark.parametrize("form", FORMS)
def test_the_same_numbers_in_any_form(tmp_path: Path, form: str):
    columns = {
        "time": MeasuredColumn(name="time"),
        "yaw": MeasuredColumn(name="aoa"),
        "lateral_position": MeasuredColumn(name="y"),
    }
    record = read_record(written(tmp_path, FORMS[form]), columns)
    assert record.kind == "time"
    assert record.at.tolist() == [0.0, 0.5, 1.0]
    np.testing.assert_allclose(record.signals["yaw"], [1.5e-3, 2.5e-3, 3.5e-3], rtol=1e-15)
    np.testing.assert_allclose(
        record.signals["lateral_position"], [-2e-3, np.nan, -4.25e-3], rtol=1e-15
    )
    assert record.units == {"time": "s", "yaw": "mrad", "lateral_position": "mm"}
    assert not record.warnings


def test_without_names_columns_have_numbers(tmp_path: Path):
    path = written(tmp_path, "0 1\n1 2\n2 3\n")
    record = read_record(path, {"yaw": MeasuredColumn(name="2", unit="mrad")})
    assert record.signals["yaw"].tolist() == [1e-3, 2e-3, 3e-3]
    # numbered rows: evenly over the run
    assert (record.kind, record.at.tolist()) == ("", [0.0, 0.5, 1.0])


def test_columns_that_are_called_as_quantities(tmp_path: Path):
    """No table of columns is needed."""
    path = written(tmp_path, "Time [ms];Yaw [deg];Left lateral [kN];mood\n0;1;2;x\n10;2;3;y\n")
    record = read_record(path)
    assert record.at.tolist() == [0.0, 0.01]
    np.testing.assert_allclose(record.signals["yaw"], np.radians([1, 2]), rtol=1e-15)
    assert record.signals["left_lateral"].tolist() == [2000.0, 3000.0]
    assert len(record.signals) == 2


def test_sign_factor_and_offset(tmp_path: Path):
    """sign * (factor * number + offset), in the column's unit."""
    path = written(tmp_path, "U\n1\n3\n")
    column = MeasuredColumn(name="U", unit="kN", sign=-1, factor=2.0, offset=0.5)
    record = read_record(path, {"left_lateral": column})
    assert record.signals["left_lateral"].tolist() == [-2500.0, -6500.0]


def test_units_against_their_definitions():
    """NIST SP 811 (2008), appendix B.8: lbf, kip, kgf, in, mph, degF."""

    def si(dimension: str, unit: str, value: float) -> float:
        known = UNITS[dimension][unit]
        return known.factor * value + known.offset

    assert si("force", "lbf", 1) == pytest.approx(4.448222, rel=1e-6)
    assert si("force", "kip", 1) == pytest.approx(4.448222e3, rel=1e-6)
    assert si("force", "kgf", 1) == 9.80665
    assert si("length", "in", 1) == 0.0254
    assert si("speed", "mph", 10) == pytest.approx(4.4704)
    assert si("temperature", "degF", 212) == pytest.approx(100)
    assert si("temperature", "K", 273.15) == 0
    assert si("turning", "rpm", 60) == pytest.approx(2 * np.pi)
    assert si("angle", "deg", 180) == np.pi
    # of runs and of records of the track
    assert {q.dimension for q in (*QUANTITIES, *measured_track.QUANTITIES)} == set(UNITS)


@pytest.mark.parametrize(
    ("key", "unit", "rows", "words"),
    [
        ("yaw", "rad", "-18 18", ["'AoA'", "-18 to 18 rad", "-0.1 to 0.1 rad", "'mrad'"]),
        ("yaw", "mrad", "-180 180", ["-0.1 to 0.1 rad"]),
        ("yaw", "deg", "-18 18", ["-18 to 18 deg", "is its unit 'mrad'"]),
        ("lateral_position", "m", "-6.6 2.3", ["-6.6 to 2.3 m", "'mm'"]),
        ("vertical_load", "N", "133 134", ["133 to 134 N", "'kN'"]),
        ("vertical_load", "kN", "133000 134000", ["allowed 500 to 2e+06 N", "'N'"]),
        ("left_vertical", "kN", "65000 66000", ["'N'"]),
        ("speed", "m/s", "-4 4", ["-4 to 4 m/s"]),
        ("progress", None, "0 100", ["0 to 1", "'%'"]),
    ],
)
def test_numbers_beyond_their_range(tmp_path: Path, key, unit, rows, words):
    path = written(tmp_path, "AoA\n" + "\n".join(rows.split()))
    with pytest.raises(RecordError) as caught:
        read_record(path, {key: MeasuredColumn(name="AoA", unit=unit)})
    for word in [f"columns.{key}", *words]:
        assert word in str(caught.value)


@pytest.mark.parametrize(
    ("key", "unit", "rows", "word"),
    [
        ("yaw", "mrad", "-0.018 0.018", "'rad'"),
        ("lateral_position", "mm", "-0.0066 0.0023", "'m'"),
        ("left_lateral", "N", "2 9", "'kN'"),
        ("left_ratio", "%", "-0.05 0.4", "'-'"),
    ],
)
def test_numbers_that_are_hardly_meant(tmp_path: Path, key, unit, rows, word):
    path = written(tmp_path, "a\n" + "\n".join(rows.split()))
    (warning,) = read_record(path, {key: MeasuredColumn(name="a", unit=unit)}).warnings
    assert "hardly meant" in warning
    assert word in warning


def test_forces_that_do_not_fit_the_load(tmp_path: Path):
    """30,113 lbf, which are 133.95 kN, taken as N; L in kN taken as N beside V in kN."""
    path = written(tmp_path, "load,V,L\n30113,65,2\n30115,66,-3\n30110,67,4\n30114,68,5\n")
    columns = {
        "vertical_load": MeasuredColumn(name="load", unit="N"),
        "left_vertical": MeasuredColumn(name="V", unit="kN"),
        "left_lateral": MeasuredColumn(name="L", unit="N"),
    }
    record = read_record(path, columns)
    doubts = force_doubts(record, 133.95e3)
    assert "wheelset.vertical_force" in doubts[0]
    assert "'lbf'" in doubts[0]
    assert any("left_lateral: is up to" in text for text in doubts)
    right = dict(columns, vertical_load=MeasuredColumn(name="load", unit="lbf"))
    right["left_lateral"] = MeasuredColumn(name="L", unit="kN")
    assert force_doubts(read_record(path, right), 133.95e3) == []


@pytest.mark.parametrize(
    ("left", "right", "said"),
    [
        ([0.02, 0.1, 0.3, 0.4, 0.2, -0.1], [-0.02, -0.1, -0.3, -0.4, -0.2, 0.1], True),
        ([0.02, 0.1, 0.3, 0.4, 0.2, -0.1], [0.1, 0.15, 0.35, 0.38, 0.28, 0.0], False),
        # outwards on either side, as without yaw
        ([-0.04, -0.05, -0.04, -0.05, -0.04, -0.05], [0.04, 0.05, 0.04, 0.05, 0.04, 0.05], False),
        ([0.02, 0.1, 0.3], [-0.02, -0.1, -0.3], False),
    ],
)
def test_wheels_with_different_signs(tmp_path: Path, left, right, said):
    """Given as L/V, or by forces under a load that varies."""
    pairs = list(zip(left, right, strict=True))
    path = written(tmp_path, "l,r\n" + "".join(f"{a},{b}\n" for a, b in pairs))
    columns = {f"{s}_ratio": MeasuredColumn(name=s[0], unit="-") for s in ("left", "right")}
    doubts = sign_doubts(read_record(path, columns))
    assert [text.split(":")[0] for text in doubts] == said * ["left_ratio and right_ratio"]
    lines = [f"{(60 + i) * a},{60 + i},{(60 + i) * b}\n" for i, (a, b) in enumerate(pairs)]
    path = written(tmp_path, "l,v,r\n" + "".join(lines))
    names = {"left_lateral": "l", "right_lateral": "r"}
    names |= {"left_vertical": "v", "right_vertical": "v"}
    columns = {key: MeasuredColumn(name=name, unit="kN") for key, name in names.items()}
    doubts = sign_doubts(read_record(path, columns))
    assert [text.split(":")[0] for text in doubts] == said * ["left_lateral and right_lateral"]


@pytest.mark.parametrize(
    ("text", "columns", "words"),
    [
        ("", YAW, ["is empty"]),
        ("AoA [mrad]\n", YAW, ["0 rows"]),
        ("AoA [mrad]\n1\n", YAW, ["1 rows"]),
        ("AoB [mrad]\n1\n2\n", YAW, ["'AoA'", "did you mean 'AoB'"]),
        ("AoA,AoA\n1,2\n2,3\n", YAW, ["2 columns are called"]),
        ("AoA\n1\n2\n", YAW, ["yaw.unit", "missing", "rad, mrad"]),
        ("AoA [kN]\n1\n2\n", YAW, ["yaw.unit", "'kN'", "rad, mrad"]),
        ("AoA [mrad]\n1\nx\n", YAW, [":3:", "'AoA'", "'x'", "a number or an empty cell"]),
        ("AoA [mrad]\n1\ninf\n", YAW, [":3:", "not finite"]),
        ("AoA [mrad],b\n1,2\n2,3,4\n", YAW, [":3:", "3 cells", "allowed 2"]),
        ("AoA [mrad],b\n,2\n,3\n", YAW, ["'AoA'", "no number"]),
        ("a,b\n1,2\n2,3\n", None, ["'a', 'b'", "[columns]", "yaw"]),
        (b"\0\1", YAW, ["not a text file"]),
        ('AoA [mrad];b\n1;"2\n2;3\n', YAW, ['allowed one whose " is closed']),
        ("AoA [mrad];b\n1;" + 200_000 * "x" + "\n2;3\n", YAW, ["cannot be split"]),
        ("AoA [mrad]\n12:00:01\n12:00:02\n", YAW, [":2:", "'12:00:01'"]),
    ],
)
def test_wrong_files(tmp_path: Path, text, columns, words):
    with pytest.raises(RecordError) as caught:
        read_record(written(tmp_path, text), columns)
    for word in ["run.csv", *words]:
        assert word in str(caught.value)
    assert isinstance(caught.value, CaseError)


def test_times(tmp_path: Path):
    columns = {"time": MeasuredColumn(name="t", unit="s"), **YAW}
    path = written(tmp_path, "t,AoA [mrad]\n0,1\n1,2\n1,7\n,8\n2,3\n")
    record = read_record(path, columns)
    assert record.signals["yaw"].tolist() == [1e-3, 2e-3, 3e-3]
    assert "1 rows have the time of the row before" in record.warnings[0]
    with pytest.raises(RecordError, match=r":4: time falls to 0\.5"):
        read_record(written(tmp_path, "t,AoA [mrad]\n0,1\n1,2\n0.5,3\n"), columns)


def test_times_of_day_and_dates(tmp_path: Path):
    """As s; a comma is a decimal one where something else stands between columns."""
    columns = {"time": MeasuredColumn(name="t", unit="s"), **YAW}
    path = written(tmp_path, "t;AoA [mrad]\n23:59:58,5;1\n23:59:59;2\n")
    assert read_record(path, columns).at.tolist() == [86398.5, 86399.0]
    path = written(tmp_path, "t,AoA [mrad]\n1970-01-02 00:00:01.25,1\n1970-01-03T01:00:00Z,2\n")
    assert read_record(path, columns).at.tolist() == [86401.25, 2 * 86400.0 + 3600.0]


def test_the_head_is_contradicted(tmp_path: Path):
    record = read_record(
        written(tmp_path, "AoA [deg]\n1\n2\n"), {"yaw": MeasuredColumn(name="AoA", unit="mrad")}
    )
    assert "says 'deg'" in record.warnings[0]
    assert record.signals["yaw"].tolist() == [1e-3, 2e-3]


def test_low_pass_has_no_delay_and_halves_the_power_at_its_cutoff():
    """The gain of a Butterworth filter of order 2, forward and back, whose cut-off is that of both
    passes, by the bilinear transform: 1/(1 + (sqrt(2) - 1) (tan(pi f dt)/tan(pi fc dt))^4)."""
    step, cutoff = 0.005, 2.0
    time = np.arange(0, 20, step)
    middle = (time > 8) & (time < 12)
    for frequency in (0.1, 2.0, 20.0):
        wave = np.sin(2 * np.pi * frequency * time)
        warped = np.tan(np.pi * frequency * step) / np.tan(np.pi * cutoff * step)
        gain = 1 / (1 + (np.sqrt(2) - 1) * warped**4)
        found = low_passed(time, wave, cutoff)
        assert np.abs(found - gain * wave)[middle].max() < 1e-9, frequency
        assert frequency != cutoff or gain == pytest.approx(2**-0.5)
    assert low_passed(time, np.ones_like(time), 2.0) == pytest.approx(1.0, abs=1e-12)


def test_gaps_stay_gaps():
    time = np.arange(0, 10, 0.01)
    values = 3 * time
    values[200:300] = np.nan
    found = low_passed(time, values, 5.0)
    assert np.isnan(found[200:300]).all()
    assert found[300:900] == pytest.approx(3 * time[300:900], abs=1e-9)
    at = resampled(time, values, np.array([-1.0, 1.005, 1.99, 1.995, 2.5, 3.0, 11.0]))
    expected = [np.nan, 3.015, 5.97, np.nan, np.nan, 9.0, np.nan]
    np.testing.assert_allclose(at, expected, rtol=1e-12)


def test_a_cutoff_above_the_rate(tmp_path: Path):
    record = read_record(written(tmp_path, "AoA [mrad]\n1\n2\n3\n"), YAW, low_pass=6.0)
    with pytest.raises(RecordError, match=r"yaw: low_pass is 6 Hz, allowed at most 4\.5 Hz"):
        record.filtered(np.array([0.0, 0.1, 0.2]))


def test_a_filter_of_bursts(tmp_path: Path):
    """It would need a row each microsecond of an hour."""
    record = read_record(written(tmp_path, "AoA [mrad]\n1\n2\n3\n4\n"), YAW, low_pass=6.0)
    with pytest.raises(RecordError, match="allowed rows that are more even"):
        record.filtered(np.array([0.0, 1e-6, 2e-6, 3600.0]))


def test_a_file_of_columns(tmp_path: Path):
    path = tmp_path / "columns.toml"
    path.write_text(
        '[columns]\nyaw = { name = "AoA" }\n"/left/contact.force.y" = { name = "L", unit = "kN" }\n'
    )
    assert set(load_columns(path)) == {"yaw", "/left/contact.force.y"}
    path.write_text('[columns]\nyaww = { name = "AoA" }\n')
    with pytest.raises(CaseError, match="did you mean 'yaw'"):
        load_columns(path)
    path.write_text("[colums]\n")
    with pytest.raises(CaseError, match="missing, allowed a table"):
        load_columns(path)
