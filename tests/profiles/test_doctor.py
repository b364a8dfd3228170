"""What `railpatch profile` says of a file: what it was taken for, how far its points lie off the
curve, and tables of the pair."""

from __future__ import annotations

import csv
import json
import sys
from pathlib import Path

import numpy as np
import pytest
import railpatch
from click.testing import CliRunner, Result
from railpatch.command.cli import cli
from railpatch.profiles import load_profile, read_profile
from railpatch.profiles.builtin import builtin_profile
from railpatch.profiles.pairing.contact_points import Dimensions, contact_points, pair_case
from railpatch.profiles.pairing.doctor import residuals, tables_of
from railpatch.profiles.raw import Reading

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib

NOISE = 4e-6  # m


@pytest.fixture(scope="module")
def file(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """S1002 upside down, columns z, y, in mm, with noise across."""
    profile = builtin_profile("S1002", "wheel")
    assert profile is not None
    y, z = np.array(profile.y), np.array(profile.z)
    off = NOISE * np.random.default_rng(5).standard_normal(y.size)
    y, z = y - off * profile.dz, z + off * profile.dy
    path = tmp_path_factory.mktemp("own") / "own.csv"
    np.savetxt(path, 1e3 * np.column_stack([-z, y]), fmt="%.6f", delimiter=";")
    return path


@pytest.fixture(scope="module")
def ran(file: Path) -> Result:
    page = file.with_name("page.html")
    return CliRunner().invoke(
        cli, ["profile", str(file), "--role", "wheel", "--swap", "-o", str(page)]
    )


def test_notes_reach_the_terminal_and_the_page(file: Path, ran: Result) -> None:
    assert ran.exit_code == 0, ran.output
    page = file.with_name("page.html").read_text(encoding="utf-8")
    for words in ("columns taken as z, y", "z mirrored", "noise of", "smoothed"):
        assert f"note: own.csv: {words}" in ran.stderr
        assert words in page
    assert all(str(path) in ran.stdout for path in tables_of(file.with_name("page.html")))


def test_lines_of_a_scene_read_the_file_alike(file: Path, ran: Result) -> None:
    assert ran.exit_code == 0
    said = json.loads(tables_of(file.with_name("page.html"))[1].read_text(encoding="utf-8"))
    table = tomllib.loads("\n".join(said["toml"]))["profiles"]
    assert table["wheel_file"] == {"unit": "mm", "swap": True, "mirror": "z"}
    again = read_profile(file, "wheel", Reading(**table["wheel_file"]))
    first = read_profile(file, "wheel", Reading(swap=True))
    assert np.array_equal(again.y, first.y)
    assert np.array_equal(again.z, first.z)


def test_residuals_are_the_noise(file: Path) -> None:
    reading = Reading(swap=True)
    raw, profile = read_profile(file, "wheel", reading), load_profile(
        file, "wheel", reading=reading
    )  # fmt: skip
    found = residuals(raw, profile)
    inner = np.abs(raw.y) < 0.03
    # 300 points tell a standard deviation within 4 %; the curve takes up some of it
    assert np.std(found[inner]) == pytest.approx(NOISE, rel=0.15)
    assert np.abs(found).max() < 12 * NOISE


def test_tables_are_the_contact_points(file: Path, ran: Result) -> None:
    assert ran.exit_code == 0
    path, other = tables_of(file.with_name("page.html"))
    rows = list(csv.reader(path.read_text(encoding="utf-8").splitlines()))
    points = contact_points(
        file, "UIC60@1:40", np.array([-2e-3, 0.0, 2e-3]), readings={"wheel": Reading(swap=True)}
    )
    at = {round(1e6 * float(row[0])): row for row in rows[1:]}
    for i, y in enumerate((-2000, 0, 2000)):
        row = dict(zip(rows[0], at[y], strict=True))
        assert float(row["position [m]"]) == pytest.approx(points.position[i], abs=1e-9)
        assert float(row["contact_angle [rad]"]) == pytest.approx(points.contact_angle[i], abs=1e-7)
        assert float(row["rolling_radius_difference [m]"]) == pytest.approx(
            points.rolling_radius_difference[i], abs=1e-10
        )
    values = json.loads(other.read_text(encoding="utf-8"))["contact_points"]
    assert values["position"]["unit"] == "m"
    assert len(values["conicity"]["values"]) == len(rows) - 1


def test_the_error_of_the_pressure_is_told(file: Path, ran: Result) -> None:
    """Of the page, the table, its JSON and the terminal: that of a solve."""
    page = file.with_name("page.html")
    [line] = [one for one in ran.stderr.splitlines() if "max_pressure" in one]
    assert line.startswith("note: max_pressure under 80 kN is known to within")
    assert "for the noise of own.csv" in line
    assert "ax_pressure under 80 kN is known to within" in page.read_text(encoding="utf-8")
    path, other = tables_of(page)
    rows = list(csv.DictReader(path.read_text(encoding="utf-8").splitlines()))
    given = [row for row in rows if row["max_pressure [Pa]"]]
    assert [round(1e6 * float(row["y [m]"])) for row in given] == list(range(-10000, 10001, 500))
    sizes = Dimensions()
    case = pair_case(file, "UIC60@1:40", sizes, None, {"wheel": Reading(swap=True)})
    case["wheelset"] |= {"vertical_force": 80e3, "y": 1e-3}
    case |= {"method": {"tangential": "none"}, "grid": {"elements": [24, 24]}}
    result = railpatch.solve(case)
    row = next(row for row in given if float(row["y [m]"]) == 1e-3)
    assert float(row["max_pressure_error [-]"]) == pytest.approx(result["max_pressure_error"])
    pressure = result["patches"][0]["max_pressure"]
    assert float(row["max_pressure [Pa]"]) == pytest.approx(pressure, rel=1e-6)
    said = json.loads(other.read_text(encoding="utf-8"))
    assert said["load"] == 80e3
    assert said["contact_points"]["max_pressure_error"]["unit"] == "-"


def test_a_table_never_takes_the_place_of_a_profile(file: Path) -> None:
    source = file.with_name("page2.contact.csv")
    source.write_bytes(file.read_bytes())
    ran = CliRunner().invoke(
        cli, ["profile", str(source), "--role", "wheel", "-o", str(file.with_name("page2.html"))]
    )
    assert ran.exit_code == 2
    assert source.read_bytes() == file.read_bytes()
