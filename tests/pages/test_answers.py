"""What pages on runs answer first: numbers of made-up runs, beside their limits."""

from __future__ import annotations

import json
import math
import re
from pathlib import Path

import numpy as np
import pytest
import synthetic
import synthetic_vehicle as vehicle
from click.testing import CliRunner
from page_checks import check_page
from railpatch.command.cli import cli
from railpatch.log import read_run
from railpatch.log.effective import Effective
from railpatch.log.waves import half_waves, waves
from railpatch.report import write_report
from railpatch.report.vehicle import limits
from railpatch.report.vehicle.data import VehicleRun, vehicle_run
from railpatch.report.vehicle.figures import beside_limits
from railpatch.report.vehicle.page import course


def text_of(page: Path) -> str:
    text = re.sub(r"<(script|style).*?</\1>", "", page.read_text(encoding="utf-8"), flags=re.S)
    return re.sub(r"\s+", " ", re.sub(r"<[^>]+>", " ", text))


@pytest.fixture(scope="module")
def rig_file(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return synthetic.write_rig_run(tmp_path_factory.mktemp("pages") / "rig.mcap")


@pytest.fixture(scope="module")
def vehicle_file(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return vehicle.write_run(tmp_path_factory.mktemp("pages") / "vehicle.mcap")


def test_rig_page_opens_with_ratio_speed_and_reference(rig_file: Path, tmp_path: Path) -> None:
    page = write_report(rig_file, tmp_path / "page.html")
    shown = check_page(page, keys=(4, 6))
    text = text_of(page)
    # the contacts roll at 4.47 m/s, though the wheelset stands
    assert "4.47 m/s (16.1 km/h)" in text
    assert "10 mph" in text
    assert "speed 0 m/s" not in text
    ratios = {}
    for name in ("left", "right"):
        sides = [synthetic.side(name, i)["force"] for i in range(37)]
        ratios[name] = max(abs(f[1] / f[2]) for f in sides)
    for name, value in ratios.items():
        assert f"greatest L/V, {name} wheel {value:.3g}" in text
    assert "It is off the reference by" in text
    first = re.findall(r'<figure id="([\w-]+)"', page.read_text(encoding="utf-8"))[0]
    assert first == "traction"
    # all positions with fields are behind the slider, two patches where there were two
    patches = shown["patch"]["data"]
    assert len(patches["frames"]) == len(patches["text"]) > 3
    assert max(len(side) for frame in patches["frames"] for side in frame) == 2


def test_positions_that_did_not_converge_come_first(tmp_path: Path) -> None:
    run = synthetic.write_rig_run(tmp_path / "rig.mcap", bad=8)
    page = write_report(run, tmp_path / "page.html")
    verdict = re.search(r'<p class="verdict (\w+)">(.*?)</p>', page.read_text(encoding="utf-8"))
    assert verdict[1] == "bad"
    assert verdict[2].startswith("1 of 37 positions did not converge.")


def test_two_logs_over_each_other(rig_file: Path, tmp_path: Path) -> None:
    other = synthetic.write_rig_run(tmp_path / "other.mcap")
    page = write_report(rig_file, tmp_path / "page.html", beside=other)
    data = check_page(page)
    patches = data["patch"]["data"]
    assert patches["other"]["name"] == "other.mcap"
    assert patches["other"]["at"] == patches["at"]
    # the same run: no difference
    assert "off other.mcap by 0" in text_of(page)


def test_decaying_waves_of_known_length() -> None:
    length, rate = 16.0, 0.02
    x = np.linspace(0.0, 80.0, 4001)
    y = 4e-3 * np.exp(-rate * x) * np.cos(2 * math.pi * x / length)
    conicity, radius, half = 0.05, 0.46, 0.75
    dr = conicity * y
    radii = np.column_stack([radius - dr, radius + dr])
    contacts = np.column_stack([np.full_like(x, -half), np.full_like(x, half)])
    found = waves(x, y, np.zeros_like(x), radii, contacts, radius)
    assert found.length == pytest.approx(length, rel=1e-4)
    assert found.conicity == pytest.approx(conicity)
    assert found.klingel == pytest.approx(2 * math.pi * math.sqrt(radius * half / conicity))
    _, peaks = half_waves(x, y)
    # a wave has two peaks
    assert peaks[2] / peaks[0] == pytest.approx(math.exp(-rate * length), rel=1e-3)


def test_vehicle_page_holds_forces_against_their_limits(vehicle_file: Path, tmp_path: Path) -> None:
    page = write_report(vehicle_file, tmp_path / "page.html")
    check_page(page, keys=(4, 6))
    text = page.read_text(encoding="utf-8")
    assert text.index('id="limits"') < text.index('id="loads"')
    data = vehicle_run(read_run(vehicle_file))
    axle = 2 * vehicle.LOAD
    # load moves from wheel to wheel, the axle's stays
    assert limits.static_load(data, 1) == pytest.approx(axle)
    assert limits.sum_limit(data, 1) == pytest.approx(10e3 + axle / 3)
    # Y is a tenth of Q, outward on the left and inward on the right
    assert limits.sum_spread(data, 1).most == pytest.approx(0.1 * axle)
    for side, sign in (("left", 1), ("right", -1)):
        assert limits.ratio_spread(data, (1, side)).most == pytest.approx(sign * 0.1)
        assert math.copysign(1, limits.guiding_spread(data, (1, side)).most) == sign


def shown_dots(data: VehicleRun) -> list[str]:
    """Names of what the panels of limits draw."""
    return [trace.name for trace in beside_limits(data).data]


def test_run_without_percentiles_is_not_assessed(vehicle_file: Path) -> None:
    """Nothing is within a limit, no percentile is drawn or told; a value above one is."""
    data = vehicle_run(read_run(vehicle_file))
    data.assessment["acceleration_rms"] = [0.1, 0.1]
    keys = limits.key_numbers(data)
    assert len(keys) == 6
    assert {key.state for key in keys} == {"plain"}
    assert all(key.note.startswith("not assessed: limit ") for key in keys)
    said, state = limits.verdict(data, keys)
    assert "the greatest value on this way" in said
    assert state == "plain"
    assert keys[0].value == "0.1"
    assert set(shown_dots(data)) == {"greatest", "limit of EN 14363"}
    assert limits.head(data) == [
        *("wheel", "Y outward most [kN]", "Q most [kN]", "Y/Q outward most"),
        "|sum of Y| most [kN]",
    ]
    assert all(len(row) == 5 for row in limits.rows(data))

    data.assessment["most_derailment"] = [0.9] * 8
    keys = limits.key_numbers(data)
    assert keys[0].state == "bad"
    said, state = limits.verdict(data, keys)
    assert state == "bad"
    assert said.startswith("No assessment by EN 14363")
    assert said.endswith("Y/Q.")


def test_percentiles_are_those_of_the_run(vehicle_file: Path) -> None:
    """Beside greatest values of the same sign, in table, panels and key numbers."""
    data = vehicle_run(read_run(vehicle_file))
    wheels, sets = len(data.contact), len(data.wheelsets)
    told = {"derailment": 0.1, "outward_guiding_force": -2e3, "load": 6e4}
    data.assessment.update({"places": 100, "shift": [4e3] * sets, "most_shift": [5e3] * sets})
    data.assessment.update({name: [value] * wheels for name, value in told.items()})
    most = {"most_derailment": 0.2, "most_outward_guiding_force": -1e3, "most_load": 7e4}
    data.assessment.update({name: [value] * wheels for name, value in most.items()})
    assert shown_dots(data).count("99.85 %") == 4
    assert limits.head(data)[1:3] == ["Y outward 99.85 % [kN]", "Y outward most [kN]"]
    first = [str(cell).replace("\u2212", "-") for cell in limits.rows(data)[0]]
    assert first == ["1 left", "-2", "-1", "60", "70", "0.1", "0.2", "4", "5"]
    keys = limits.key_numbers(data)
    assert (keys[0].value, keys[0].note) == ("0.1", "within 0.8, wheelset 1 left")
    assert limits.verdict(data, keys)[1] in ("good", "bad")


@pytest.mark.parametrize(
    ("arc", "told"),
    [(-vehicle.RADIUS, "900 m"), (700.0, "900 m (the scene's arc of 700 m was not reached)")],
)
def test_least_radius_is_of_the_track_that_was_run_on(
    tmp_path: Path, arc: float, told: str
) -> None:
    """The first wheelset is in the circle, the vehicle's middle is not; the scene's arc, if the run
    did not come to it, is told as that."""
    scene = {"alignment": {"radius": None, "section": [{"radius": None}, {"radius": arc}]}}
    ran_with = Effective(json.dumps(scene).encode(), {})
    steps = 1 + math.floor(vehicle.CURVE_AT / vehicle.SPEED / 0.01)
    log = vehicle.write_run(tmp_path / "short.mcap", steps, ran_with=ran_with)
    data = vehicle_run(read_run(log))
    assert not data.state["curvature"].any()
    assert dict(course(data))["least radius run on"] == told


def test_greatest_leaves_out_what_is_not_known() -> None:
    assert limits.greatest(np.array([-3.0, 0.5, np.nan])) == 0.5
    assert math.isnan(limits.greatest(np.array([np.nan])))


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["traction"], "--output: value is missing"),
        (["-o", "a.png"], "NAME: value is missing"),
        (["traction", "-o", "a.gif"], "a name that ends in .png or .svg"),
    ],
)
def test_wrong_calls_of_figure(arguments: list[str], message: str, rig_file: Path) -> None:
    ran = CliRunner().invoke(cli, ["figure", str(rig_file), *arguments])
    assert ran.exit_code == 2
    assert message in ran.output


def test_names_of_figures_need_no_browser(
    rig_file: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("RAILPATCH_BROWSER", "no-such-browser")
    ran = CliRunner().invoke(cli, ["figure", str(rig_file)])
    assert ran.exit_code == 0
    assert ran.output.split()[:2] == ["traction", "patch"]
    for call in (["figure", str(rig_file), "traction"], ["report", str(rig_file)]):
        name = "a.png" if call[0] == "figure" else "a.pdf"
        ran = CliRunner().invoke(cli, [*call, "-o", str(tmp_path / name)])
        assert ran.exit_code == 2
        assert "no-such-browser" in ran.output
        assert not (tmp_path / name).exists()
