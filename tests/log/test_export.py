"""Tables of a log: all values as they were logged, units in the head, every format alike."""

from __future__ import annotations

import csv
import sys
from pathlib import Path

import numpy as np
import pytest
import synthetic
import synthetic_vehicle
from click.testing import CliRunner, Result
from railpatch.command.cli import cli
from railpatch.errors import CaseError
from railpatch.export import write_table
from railpatch.export.formats import FORMATS, matlab_names
from railpatch.log import Run, read_run

FORCE = "/left/contact.force.y"


@pytest.fixture(scope="module")
def rig_file(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return synthetic.write_rig_run(tmp_path_factory.mktemp("export") / "rig.mcap")


@pytest.fixture(scope="module")
def rig(rig_file: Path) -> Run:
    return read_run(rig_file)


def invoke(*arguments: object) -> Result:
    return CliRunner().invoke(cli, ["export", *map(str, arguments)])


def lateral() -> np.ndarray:
    """What was logged, N."""
    return np.array([synthetic.side("left", i)["force"][1] for i in range(synthetic.POSITIONS)])


def read_csv(path: Path) -> dict[str, list[str]]:
    rows = list(csv.reader(path.read_text(encoding="utf-8").splitlines()))
    return dict(zip(rows[0], zip(*rows[1:], strict=True), strict=True))


def read_xlsx(path: Path) -> dict[str, list]:
    from openpyxl import load_workbook

    rows = list(load_workbook(path)["run"].iter_rows(values_only=True))
    return dict(zip(rows[0], zip(*rows[1:], strict=True), strict=True))


def test_every_format_has_the_logged_numbers(rig_file: Path, tmp_path: Path):
    for ending in FORMATS:
        done = invoke(rig_file, "-o", tmp_path / f"x{ending}", "--channel", "/left/contact")
        assert done.exit_code == 0, done.output
        assert f"{synthetic.POSITIONS} rows" in done.output
    texts = read_csv(tmp_path / "x.csv")
    assert [float(text) for text in texts[f"{FORCE} [N]"]] == lateral().tolist()
    assert set(texts["/left/contact.status"]) == {"converged"}
    assert next(iter(texts)) == "time [s]"
    # one patch or two: what is absent is empty, never zero
    second = texts["/left/contact.patches[1].normal_force [N]"]
    absent = [synthetic.yaw_at(i) >= -0.005 for i in range(synthetic.POSITIONS)]
    assert [text == "" for text in second] == absent
    cells = read_xlsx(tmp_path / "x.xlsx")
    assert list(cells) == list(texts)
    # to 16 digits
    assert cells[f"{FORCE} [N]"] == pytest.approx(lateral(), rel=1e-15)
    assert [v is None for v in cells["/left/contact.patches[1].normal_force [N]"]] == absent


def test_matlab_and_parquet_tell_units(rig: Run, tmp_path: Path):
    from pyarrow import parquet
    from scipy.io import loadmat

    table = rig.table()
    found = loadmat(write_table(table, tmp_path / "x.mat"), simplify_cells=True)
    assert found["data"]["left_contact_force_y"].tolist() == lateral().tolist()
    assert found["unit"]["left_contact_force_y"] == "N"
    assert found["name"]["left_contact_force_y"] == FORCE
    assert found["data"]["time"].tolist() == list(range(synthetic.POSITIONS))
    read = parquet.read_table(write_table(table, tmp_path / "x.parquet"))
    assert read[FORCE].to_pylist() == lateral().tolist()
    assert read.schema.field(FORCE).metadata[b"unit"] == b"N"
    assert read["/left/contact.patches[1].normal_force"].null_count > 0


def test_data_frame(rig: Run):
    frame = rig.to_pandas()
    assert frame.index.name == "time"
    assert frame[FORCE].tolist() == lateral().tolist()
    assert frame.attrs["units"][FORCE] == "N"
    assert "track axes" in frame.attrs["meanings"][FORCE]
    # each residual has a unit of its own
    units = [frame.attrs["units"][f"/rig/balance.residuals[{i}]"] for i in range(3)]
    assert units == ["N m", "N", "N m"]
    assert frame["/rig/balance.evaluations"].dtype == np.int64
    assert list(rig.to_pandas(signals=["yaw"]).columns) == ["/wheelset/state.yaw"]


def test_signals_and_channels_choose(rig: Run):
    def names(**chosen: list[str]) -> list[str]:
        return [column.name for column in rig.table(**chosen).columns[1:]]

    forces = [f"/{side}/contact.force.{axis}" for side in ("left", "right") for axis in "xyz"]
    assert names(signals=["force"]) == names(signals=["force.?"]) == forces
    assert names(channels=["/l*/contact"], signals=["force.y"]) == [FORCE]
    assert names(signals=["/left/contact.patches[0].approach"]) == [
        "/left/contact.patches[0].approach"
    ]
    assert all(name.startswith("/rig/balance.") for name in names(channels=["/rig/balance"]))


def test_maps_only_where_they_are_named(rig: Run):
    assert not any("/fields" in column.name for column in rig.table().columns)
    assert not any("/fields" in c.name for c in rig.table(channels=["/left/*"]).columns)
    table = rig.table(channels=["/left/fields"], signals=["*.pressure"])
    snapshots = list(range(0, synthetic.POSITIONS, 9))
    assert table.time.tolist() == snapshots
    pressure = synthetic.side("left", 0, fields=True)["patches"][0]["pressure"]
    flat = np.ravel(pressure)
    middle = int(flat.argmax())
    column = table[f"/left/fields.patches[0].pressure[{middle}]"]
    assert column.values[0] == flat[middle]
    assert column.unit == "Pa"


def test_vehicle(tmp_path: Path):
    run = read_run(synthetic_vehicle.write_run(tmp_path / "vehicle.mcap"))
    table = run.table(signals=["/wheelset/2/right/contact.force.z", "bodies[0].position.x", "name"])
    series = run["/wheelset/2/right/contact"]
    assert table["/wheelset/2/right/contact.force.z"].values.tolist() == [
        force[2] for force in series["force"]
    ]
    assert table["/vehicle/bodies.bodies[0].name"].is_text


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["-o", "x.txt"], ["--output", "'x.txt'", ".csv, .xlsx, .mat or .parquet"]),
        (["-o", "x.csv", "--signal", "forse.y"], ["--signal", "'forse.y'", "'force.y'"]),
        (["-o", "x.csv", "--channel", "/left/contct"], ["--channel", "'/left/contact'"]),
        (["-o", "x.csv", "--signal", "curvature"], ["'curvature'", "no value"]),
        ([], ["--output", "missing", "--list"]),
    ],
)
def test_wrong_calls(rig_file: Path, tmp_path: Path, monkeypatch, arguments, words):
    monkeypatch.chdir(tmp_path)
    done = invoke(rig_file, *arguments)
    assert done.exit_code == 2
    for word in words:
        assert word in done.output
    assert not list(tmp_path.iterdir())


def test_missing_library_is_told_first(monkeypatch, tmp_path: Path):
    """Also where the log is not there."""
    monkeypatch.setitem(sys.modules, "openpyxl", None)
    done = invoke(tmp_path / "absent.mcap", "-o", tmp_path / "x.xlsx")
    assert done.exit_code == 2
    assert "openpyxl" in done.output
    assert "railpatch[export]" in done.output


def test_list(rig_file: Path):
    done = invoke(rig_file, "--list", "--signal", "yaw")
    assert done.exit_code == 0
    assert "/wheelset/state.yaw [rad]  yaw angle" in done.output


def test_sheet_that_is_too_small(rig: Run, tmp_path: Path, monkeypatch):
    monkeypatch.setattr("railpatch.export.formats.MOST_COLUMNS", 10)
    with pytest.raises(CaseError, match=r"columns, allowed .* and 10 in an \.xlsx file"):
        write_table(rig.table(), tmp_path / "x.xlsx")
    assert not list(tmp_path.iterdir())


def test_matlab_names_are_unique_and_short():
    long = "/left/contact." + "a" * 80
    names = matlab_names(["/a.b", "/a/b", long + "1", long + "2"])
    assert names[:2] == ["a_b", "a_b_2"]
    assert len(set(names)) == 4
    assert max(map(len, names)) <= 63
