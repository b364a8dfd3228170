"""Own profile files in a scene and on the page: read as is said, with what was assumed told."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from click.testing import CliRunner, Result
from profile_files import columns
from railpatch import CaseError, Contact, solve
from railpatch.command.cli import cli
from railpatch.profiles import ProfileError, builtin_profile


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """A wheel and a rail in mm, 0.2 mm apart: S1002 and UIC60@1:40."""
    for name, source, role in (("w.csv", "S1002", "wheel"), ("r.csv", "UIC60@1:40", "rail")):
        profile = builtin_profile(source, role)
        y, z = profile.evaluate(np.arange(profile.arc_length[0], profile.arc_length[-1], 2e-4))
        (tmp_path / name).write_text(columns(1e3 * y, 1e3 * z))
    return tmp_path


def case(wheel: str = "w.csv", rail: str = "r.csv", **profiles: Any) -> dict[str, Any]:
    return {
        "kind": "wheel_rail",
        "grid": {"elements": [16, 16]},
        "friction": {"coefficient": 0.3},
        "wheelset": {
            "vertical_force": 8e4,
            "speed": 20.0,
            "pitch_rate": -43.478,
            "nominal_radius": 0.46,
            "flange_back_distance": 1.36,
            "flange_back_position": -0.07,
        },
        "track": {"gauge": 1.435, "gauge_height": 0.014},
        "profiles": {"wheel": wheel, "rail": rail, **profiles},
    }


def turned(folder: Path, name: str, **axes: float) -> str:
    """A copy with its axes multiplied."""
    y, z = np.loadtxt(folder / name, unpack=True)
    other = f"turned_{name}"
    (folder / other).write_text(columns(axes.get("y", 1.0) * y, axes.get("z", 1.0) * z))
    return other


def test_files_give_what_the_formulas_give(folder: Path) -> None:
    own = solve(case(), folder=folder)
    built_in = solve(case("S1002", "UIC60@1:40"))
    # cubics between points 0.2 mm apart, over steps of the curvature
    np.testing.assert_allclose(
        own["patches"][0]["max_pressure"], built_in["patches"][0]["max_pressure"], rtol=1e-2
    )
    assert list(own["profiles"]) == ["w.csv", "r.csv"]
    assert own["profiles"]["r.csv"] == [
        "unit of length taken as mm",
        "the gauge side is taken to lie at -y",
        "placed by its top, at y = -0.1 mm, and its gauge side, at y = -43.0 mm, whatever its "
        "origin",
    ]
    assert "profiles" not in built_in.to_dict()


def test_a_mirrored_rail_is_asked_for_and_read_as_said(folder: Path) -> None:
    expected = solve(case(), folder=folder)["patches"]
    rail = turned(folder, "r.csv", y=-1.0)
    with pytest.raises(ProfileError, match=r"leans by 1:40 away from the track"):
        solve(case(rail=rail), folder=folder)
    found = solve(case(rail=rail, rail_file={"mirror": "y"}), folder=folder)
    assert found["patches"][0]["max_pressure"] == pytest.approx(
        expected[0]["max_pressure"], rel=1e-6
    )
    assert "y mirrored as asked: the gauge side lay at +y" in found["profiles"][rail]


def test_a_wheel_with_another_origin_is_asked_for(folder: Path) -> None:
    y, z = np.loadtxt(folder / "w.csv", unpack=True)
    (folder / "far.csv").write_text(columns(y + 100.0, z))
    with pytest.raises(ProfileError, match=r"flange's tip .* from the flange back"):
        Contact(case("far.csv"), folder=folder)
    found = solve(case("far.csv", wheel_file={"origin": [0.1, 0.0]}), folder=folder)
    expected = solve(case(), folder=folder)
    assert found["patches"][0]["max_pressure"] == pytest.approx(
        expected["patches"][0]["max_pressure"], rel=1e-6
    )


def test_what_is_said_of_files_needs_files() -> None:
    with pytest.raises(
        CaseError, match=r"profiles\.wheel_file: value is a table, allowed with a file as wheel"
    ):
        solve(case("S1002", "UIC60", wheel_file={"unit": "mm"}))


def run(*arguments: object) -> Result:
    return CliRunner().invoke(cli, [str(word) for word in arguments])


def test_the_command_prints_notes(folder: Path) -> None:
    scene = folder / "case.toml"
    lines = []
    for name, table in case().items():
        if isinstance(table, dict):
            lines += [f"[{name}]", *(f"{key} = {json.dumps(v)}" for key, v in table.items())]
        else:
            lines.append(f"{name} = {json.dumps(table)}")
    scene.write_text("\n".join(lines))
    done = run("solve", scene)
    assert done.exit_code == 0, done.output
    assert "r.csv: unit of length taken as mm; the gauge side is taken to lie at -y" in (
        done.output.replace("\n", " ")
    )
    assert list(json.loads(run("solve", scene, "--json").output)["profiles"]) == ["w.csv", "r.csv"]


def test_the_page_reads_as_the_options_say(folder: Path) -> None:
    y, z = np.loadtxt(folder / "w.csv", unpack=True)
    (folder / "zy.csv").write_text(columns(z / 25.4, y / 25.4))
    page = folder / "page.html"
    asked = run("profile", folder / "zy.csv", "-o", page, "--role", "wheel", "--unit", "in")
    assert asked.exit_code == 2
    assert "say swap = true or swap = false" in asked.output
    assert not page.exists()
    options = ("--role", "wheel", "--unit", "in", "--swap", "--mirror", "none")
    done = run("profile", folder / "zy.csv", "-o", page, *options)
    assert done.exit_code == 0, done.output
    text = page.read_text(encoding="utf-8")
    assert "columns taken as z, y" in text
    assert "unit of length in as asked" in text
    wrong = run("profile", folder / "w.csv", "-o", page, "--role", "rail", "--rail", "UIC60")
    assert wrong.exit_code == 2
    assert "--role: value is 'rail', allowed 'wheel'" in wrong.output
