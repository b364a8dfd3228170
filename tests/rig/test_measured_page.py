"""docs/measured_runs.md: its files run as printed, its tables name what there is."""

from __future__ import annotations

import re
import shlex
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner
from railpatch.command.cli import cli
from railpatch.log import read_run
from railpatch.record.columns import Columns, load_columns
from railpatch.record.forces import COUNTED
from railpatch.record.quantities import QUANTITIES
from railpatch.record.units import UNITS

PAGE = (Path(__file__).resolve().parents[2] / "docs/measured_runs.md").read_text(encoding="utf-8")


def blocks(language: str) -> list[str]:
    return re.findall(rf"^```{language}\n(.*?)^```", PAGE, re.DOTALL | re.MULTILINE)


@pytest.fixture
def folder(tmp_path: Path, nominal_file: Path) -> Path:
    """The page's scene and record, with the nominal profiles under its names."""
    for name in ("wheel", "roller"):
        profile = nominal_file.with_name(f"nominal_{name}.csv")
        (tmp_path / f"{name}.csv").write_bytes(profile.read_bytes())
    (tmp_path / "run.csv").write_text(blocks("text")[0], encoding="utf-8")
    (tmp_path / "scene.toml").write_text(blocks("toml")[0], encoding="utf-8")
    return tmp_path


def call(*arguments: object) -> str:
    done = CliRunner().invoke(cli, [str(argument) for argument in arguments])
    assert done.exit_code == 0, done.output
    return done.output


def test_the_pages_files_run(folder: Path):
    """Replay, report and table, with the load that was measured."""
    log = folder / "run.mcap"
    text = call("rig", folder / "scene.toml", "-o", log)
    assert "drives        yaw, lateral_position, vertical_load" in text
    assert "1 of 5 rows have no value" in text
    run = read_run(log)
    load = run["/wheelset/state"]["vertical_force"]
    assert np.abs(load - 118.5e3).max() < 400
    carried = -run["/left/contact"]["force"][:, 2] - run["/right/contact"]["force"][:, 2]
    np.testing.assert_allclose(carried, load, rtol=1e-4)
    call("report", log, "-o", folder / "a.html")
    printed = re.search(r"export run.mcap -o run.csv (.*)", PAGE)
    assert printed is not None
    call("export", log, "-o", folder / "x.csv", *shlex.split(printed[1]))
    head = (folder / "x.csv").read_text().splitlines()[0]
    assert head.startswith("time [s],")
    assert "/left/contact.force.y [N]" in head
    assert "/rig/measured.right_lateral [N]" in head


def test_the_error_of_the_page(folder: Path):
    scene = folder / "scene.toml"
    given = '{ name = "Winkel" }'
    assert scene.read_text().count(given) == 1
    scene.write_text(scene.read_text().replace(given, '{ name = "Winkel", unit = "rad" }'))
    done = CliRunner().invoke(cli, ["rig", str(scene), "-o", str(folder / "run.mcap")])
    assert done.exit_code == 2
    said = re.search(r"^    Error: run\.csv(: .*)$", PAGE, re.MULTILINE)
    assert said is not None
    assert done.output.strip().endswith(said[1])


def test_the_table_names_all_keys_and_units():
    names = {quantity.name for quantity in QUANTITIES}
    counted = {field.alias for field in Columns.model_fields.values() if field.alias}
    assert names | counted == {f.alias or name for name, f in Columns.model_fields.items()}
    assert counted == set(COUNTED)
    assert '`"left.force[0]"`, `[1]`, `[2]`, and of `right`' in PAGE
    named = set(re.findall(r"`(\w+)`", PAGE))
    # those of the right are said by "and of `right`"
    assert {name for name in names if not name.startswith("right")} <= named
    table = PAGE[PAGE.index("| key | what | units |") : PAGE.index("The first five rows")]
    units = set(re.findall(r"[\w/%-]+", table))
    for dimension in {quantity.dimension for quantity in QUANTITIES}:
        assert set(UNITS[dimension]) <= units, dimension


def test_the_columns_of_another_file(tmp_path: Path):
    path = tmp_path / "columns.toml"
    (table,) = [block for block in blocks("toml") if block.startswith("[columns]")]
    path.write_text(table)
    assert set(load_columns(path)) == {"distance", "/wheelset/1/left/contact.force.y"}
