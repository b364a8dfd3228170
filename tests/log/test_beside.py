"""Reports with something laid over the run: a record of its own, a file, another log."""

from __future__ import annotations

import json
import re
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
import synthetic
import synthetic_vehicle
from click.testing import CliRunner, Result
from railpatch.command.cli import cli
from railpatch.errors import CaseError, RecordError
from railpatch.log import read_run
from railpatch.log.reader import Attachment
from railpatch.report import write_report
from railpatch.report.beside import Beside, Pair, beside_log, beside_measured, beside_record
from railpatch.report.beside_page import curves, differences, scenes, traction
from railpatch.report.scene import differences_of

COLUMNS = """
[columns]
time = { name = "t" }
left_lateral = { name = "L" }
"/right/contact.force.z" = { name = "V", sign = -1 }
left_ratio = { name = "q", unit = "%" }
"""


@pytest.fixture(scope="module")
def rig_file(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return synthetic.write_rig_run(tmp_path_factory.mktemp("beside") / "rig.mcap")


@pytest.fixture
def files(tmp_path: Path) -> tuple[Path, Path]:
    """A record every half second from 3 s on: 2 kN above the run's lateral force, half its V."""
    time = np.arange(3.0, 30.25, 0.5)
    sides = {n: [synthetic.side(n, i)["force"] for i in range(37)] for n in ("left", "right")}
    left, right = (np.array(sides[name]) for name in ("left", "right"))
    at = np.arange(37.0)
    lateral = 1e-3 * np.interp(time, at, -left[:, 1]) + 2.0
    vertical = 0.5e-3 * np.interp(time, at, -right[:, 2])
    ratio = 100 * np.interp(time, at, left[:, 1] / left[:, 2])
    rows = [f"{a};{b};{c};{d}" for a, b, c, d in zip(time, lateral, vertical, ratio, strict=True)]
    record, columns = tmp_path / "run.csv", tmp_path / "columns.toml"
    record.write_text("\n".join(["t [s];L [kN];V [kN];q", *rows]))
    columns.write_text(COLUMNS)
    return record, columns


def by_name(pairs: list[Pair]) -> dict[str, Pair]:
    return {pair.name: pair for pair in pairs}


def text_of(page: Path) -> str:
    text = re.sub(r"<(script|style).*?</\1>", "", page.read_text(encoding="utf-8"), flags=re.S)
    return re.sub(r"<[^>]+>", " ", text)


def invoke(*arguments: object) -> Result:
    return CliRunner().invoke(cli, ["report", *map(str, arguments)])


def test_a_file_is_laid_over_the_run(rig_file: Path, files: tuple[Path, Path]):
    """In the run's units and signs; differences where the file has values."""
    beside = beside_record(read_run(rig_file), *files)
    pairs = by_name(beside.pairs)
    assert list(pairs) == ["left lateral", "left ratio", "/right/contact.force.z"]
    inside = np.arange(37)
    inside = (inside >= 3) & (inside <= 30)
    lateral = pairs["left lateral"]
    assert lateral.label == "left lateral [kN]"
    np.testing.assert_allclose(lateral.difference[inside], -2.0, atol=1e-9)
    assert np.isnan(lateral.difference[~inside]).all()
    # a column of the log keeps the log's sign: the force on the wheel
    vertical = pairs["/right/contact.force.z"]
    np.testing.assert_allclose(vertical.difference, 0.5 * np.where(inside, vertical.own, np.nan))
    np.testing.assert_allclose(pairs["left ratio"].difference[inside], 0, atol=1e-12)


def test_the_page_shows_curves_and_differences(rig_file: Path, files, tmp_path: Path):
    record, columns = files
    page = tmp_path / "page.html"
    done = invoke(rig_file, "-o", page, "--reference", record, "--columns", columns)
    assert done.exit_code == 0, done.output
    assert 'id="beside-file"' in page.read_text(encoding="utf-8")
    text = text_of(page)
    assert "Beside run.csv" in text
    assert "The reference (" not in text
    row = re.search(r"left lateral \[kN\]\s+(\d+)\s+(\S+)\s+(\S+)\s+(\S+)", text)
    assert row is not None
    assert row.groups() == ("28", "\u22122", "2", "2")


def test_the_record_of_a_replay(tmp_path: Path):
    """What it lacks is absent; what drives the run is not compared."""
    path = tmp_path / "run.mcap"
    with synthetic.open_log(path) as log:
        for index in range(5):
            measured = {"yaw": 0.1, "left_lateral": 1e3 * index, "left_wheel_temperature": 20.0}
            if index == 2:
                del measured["left_lateral"]
            log.write(
                float(index),
                state=synthetic.state(index),
                left=synthetic.side("left", index),
                right=synthetic.side("right", index),
                measured=measured,
            )
    beside = beside_measured(read_run(path))
    assert beside is not None
    pairs = by_name(beside.pairs)
    assert list(pairs) == ["left lateral", "left wheel temperature"]
    own = np.array([-synthetic.side("left", i)["force"][1] for i in range(5)])
    expected = 1e-3 * (own - 1e3 * np.arange(5))
    expected[2] = np.nan
    np.testing.assert_allclose(pairs["left lateral"].difference, expected, atol=1e-12)
    # measured alone: the run has no bulk temperatures
    assert np.isnan(pairs["left wheel temperature"].own).all()
    assert "left wheel temperature [degC]" in differences(beside)
    assert len(curves(beside).data) == 4
    page = write_report(path, tmp_path / "page.html")
    assert 'id="measured-traction"' not in page.read_text(encoding="utf-8")
    text = text_of(page)
    assert "Measured and computed" in text
    assert "The reference (" not in text


def test_traction_curves_of_measured_forces(tmp_path: Path):
    """L/V of the two forces, a gap where the wheel bears none, over the run's yaw angle."""
    path = tmp_path / "run.mcap"
    with synthetic.open_log(path) as log:
        for index in range(5):
            measured = {"right_lateral": 1e3, "right_vertical": 0.0 if index == 3 else 4e3}
            log.write(
                float(index),
                state=synthetic.state(index),
                left=synthetic.side("left", index),
                right=synthetic.side("right", index),
                measured=measured,
            )
    beside = beside_measured(read_run(path))
    assert beside is not None
    (pair,) = beside.ratios().values()
    np.testing.assert_allclose(pair.other, [0.25, 0.25, 0.25, np.nan, 0.25])
    force = np.array([synthetic.side("right", i)["force"] for i in range(5)])
    np.testing.assert_allclose(pair.own, force[:, 1] / force[:, 2])
    measured, run = traction(beside).data
    assert (measured.name, run.name) == ("measured", "run")
    np.testing.assert_allclose(run.x, [1e3 * synthetic.yaw_at(i) for i in range(5)])


def test_a_run_without_a_record_has_no_such_section(rig_file: Path):
    assert beside_measured(read_run(rig_file)) is None


def test_another_log(rig_file: Path, tmp_path: Path):
    """A log beside itself leaves nothing; one of every second position the same where it is."""
    run = read_run(rig_file)
    for pair in beside_log(run, rig_file).pairs:
        known = np.isfinite(pair.own)
        assert np.abs(pair.difference[known]).max(initial=0.0) < 1e-9, pair.name
    other = tmp_path / "other.mcap"
    with synthetic.open_log(other) as log:
        for index in range(0, 37, 2):
            synthetic.write_position(log, index)
    pairs = by_name(beside_log(run, other).pairs)
    lateral = pairs["right lateral"]
    assert len(lateral.other) == 19
    np.testing.assert_allclose(lateral.difference[::2], 0, atol=1e-9)
    assert np.abs(lateral.difference[1::2]).max() > 0.01
    done = invoke(rig_file, "-o", tmp_path / "page.html", "--beside", other)
    assert done.exit_code == 0, done.output
    assert "Beside other.mcap" in text_of(tmp_path / "page.html")


def logged(content: dict | None, **files: bytes) -> SimpleNamespace:
    """What a log carries: the scene as it ran, and files beside it."""
    held = {name.replace("_", "."): Attachment(data, "text/csv") for name, data in files.items()}
    if content is not None:
        held["effective.json"] = Attachment(json.dumps(content).encode(), "application/json")
    return SimpleNamespace(attachments=held)


def test_what_the_scenes_of_two_logs_differ_in() -> None:
    """Keys of tables and of tables in lists, lists as wholes, files of one name."""
    scene = {
        "friction": {"coefficient": 0.35, "law": "coulomb"},
        "grid": {"elements": [10, 10]},
        "vehicle": {"body": [{"name": "a", "mass": 1.0}, {"name": "b", "mass": 2.0}]},
        "profiles": {"wheel": "wheel.csv", "smoothing": None},
    }
    other = json.loads(json.dumps(scene))
    other["friction"]["coefficient"] = 0.15
    other["grid"]["elements"] = [10, 12]
    other["vehicle"]["body"][1]["mass"] = 2.5
    other["profiles"]["smoothing"] = 4e-3
    run = logged(scene, wheel_csv=b"1 2", case_toml=b"x")
    assert differences_of(run, logged(other, wheel_csv=b"1 2 3", case_toml=b"y")) == [
        ("friction.coefficient", "0.35", "0.15"),
        ("grid.elements", "[10, 10]", "[10, 12]"),
        ("vehicle.body[1].mass", "2.0", "2.5"),
        ("profiles.smoothing", "-", "0.004"),
        ("content of wheel.csv", "3 bytes", "5 bytes"),
    ]
    assert differences_of(run, run) == []
    assert differences_of(run, logged(None)) == []
    beside = Beside("Beside b", "b", "time [s]", [], scenes=differences_of(run, logged(other)))
    text = "".join(scenes(beside))
    assert all(cell in text for cell in ("friction.coefficient", ">0.35<", ">0.15<"))
    assert "are the same" in "".join(scenes(replace(beside, scenes=[])))
    assert scenes(replace(beside, scenes=None)) == []


def test_vehicles(rig_file: Path, tmp_path: Path):
    """By their distance; a rig has nothing in common with one."""
    vehicle = synthetic_vehicle.write_run(tmp_path / "vehicle.mcap")
    run = read_run(vehicle)
    beside = beside_log(run, vehicle)
    assert beside.label == "distance [m]"
    assert "wheelset 4 right vertical" in by_name(beside.pairs)
    assert all(np.nanmax(np.abs(pair.difference)) < 1e-9 for pair in beside.pairs)
    with pytest.raises(CaseError, match="allowed a log of the same kind of run"):
        beside_log(run, rig_file)
    record = tmp_path / "y.csv"
    x = run["/vehicle/state"]["x"]
    record.write_text("s,y\n" + "\n".join(f"{a},{1e3 * 0.001}" for a in x))
    columns = tmp_path / "c.toml"
    columns.write_text(
        '[columns]\ndistance = { name = "s", unit = "m" }\n'
        '"/wheelset/2/state.y" = { name = "y", unit = "mm" }\n'
    )
    (pair,) = beside_record(run, record, columns).pairs
    np.testing.assert_allclose(
        pair.difference, 1e3 * run["/wheelset/2/state"]["y"] - 1.0, atol=1e-9
    )
    page = tmp_path / "page.html"
    done = invoke(vehicle, "-o", page, "--reference", record, "--columns", columns)
    assert done.exit_code == 0, done.output
    assert "Beside y.csv" in text_of(page)


@pytest.mark.parametrize(
    ("columns", "words"),
    [
        (COLUMNS.replace("time", "roll"), ["time, progress, distance are missing"]),
        (COLUMNS.replace('"t" }', '"t", offset = 100.0 }'), ["103 to", "0 to 36", "offset"]),
        (COLUMNS.replace("time", "distance"), ["distance", "'s'"]),
        (COLUMNS.replace("/right/", "/rihgt/"), ["'/rihgt/contact.force.z'", "no column"]),
        (COLUMNS.replace('"L"', '"L", low_pass = 5.0'), ["left_lateral", "0.9 Hz"]),
        (COLUMNS.replace("sign = -1", "unit = 'mm'"), ["'mm'", "N, kN"]),
    ],
)
def test_wrong_columns(rig_file: Path, files, tmp_path: Path, columns, words):
    if words[0].startswith("time"):
        columns = columns.replace('name = "t"', 'name = "t", unit = "mrad"')
    files[1].write_text(columns)
    with pytest.raises(RecordError) as caught:
        beside_record(read_run(rig_file), *files)
    for word in words:
        assert word in str(caught.value)


def test_an_exported_table_is_a_reference(rig_file: Path, tmp_path: Path):
    """Without a table of columns: they are called as those of the log."""
    table = tmp_path / "run.csv"
    chosen = ["--signal", "force.?", "--signal", "patches[0].max_pressure"]
    done = CliRunner().invoke(cli, ["export", str(rig_file), "-o", str(table), *chosen])
    assert done.exit_code == 0, done.output
    run = read_run(rig_file)
    pairs = beside_record(run, table, None).pairs
    assert {pair.name for pair in pairs} == {
        *(f"/{side}/contact.force.{axis}" for side in ("left", "right") for axis in "xyz"),
        *(f"/{side}/contact.patches[0].max_pressure" for side in ("left", "right")),
    }
    assert [pair.unit for pair in pairs if "max" in pair.name] == ["MPa", "MPa"]
    for pair in pairs:
        assert np.abs(pair.difference).max() < 1e-9, pair.name
    done = CliRunner().invoke(cli, ["export", str(rig_file), "-o", str(table)])
    with pytest.raises(RecordError, match="columns of the log, allowed at most 40"):
        beside_record(run, table, None)


def test_columns_without_a_file(rig_file: Path, files, tmp_path: Path):
    done = invoke(rig_file, "-o", tmp_path / "page.html", "--columns", files[1])
    assert done.exit_code == 2
    assert "--columns: value is given, allowed with a file as --reference" in done.output
    assert not (tmp_path / "page.html").exists()
