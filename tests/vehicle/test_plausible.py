"""Numbers of a vehicle in another unit: refused, or warned of by field, value and range."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
from click.testing import CliRunner
from railpatch.case.load import check_table
from railpatch.command.cli import cli
from railpatch.errors import CaseError
from railpatch.report.vehicle import assessed

from wheelset_demo.scene import scene_file
from wheelset_demo.vehicle.alignment import AlignmentTable
from wheelset_demo.vehicle.assessment import LEAST_RATE, LEAST_WAY, SLIDING
from wheelset_demo.vehicle.bodies import VehicleTable
from wheelset_demo.vehicle.deviations import DipTable
from wheelset_demo.vehicle.plausible import (
    LONGEST_WAY,
    doubtful_bodies,
    doubtful_elements,
    doubtful_support,
    doubts_of,
    too_fast,
    unmet_dips,
)
from wheelset_demo.vehicle.scene import load_vehicle_scene
from wheelset_demo.vehicle.sections import SectionTable
from wheelset_demo.vehicle.support import SupportTable

SCENES = ("vehicle_curve", "vehicle_straight", "freight_wagon", "locomotive")
SUPPORT = {
    "rail_mass": 60.0,
    "pad_stiffness": [20e6, 100e6],
    "sleeper_mass": 250.0,
    "sleeper_inertia": 80.0,
    "ballast_stiffness": [20e6, 60e6],
}


def table() -> dict[str, Any]:
    return load_vehicle_scene().vehicle.model_dump(exclude_none=True)


def checked(changed: dict[str, Any]) -> VehicleTable:
    return check_table(VehicleTable, changed, "vehicle")


@pytest.mark.parametrize("name", SCENES)
def test_packaged_vehicles_have_no_warning(name: str) -> None:
    scene = load_vehicle_scene(scene_file(f"{name}.toml"))
    assert doubtful_bodies(scene.vehicle) == []
    assert doubtful_elements(scene.vehicle) == []
    assert doubtful_support(scene.support) == []


def test_cant_of_the_inner_rail() -> None:
    for cant, warned in ((0.1, False), (-0.1, True)):
        scene = load_vehicle_scene(None, {})
        curve = AlignmentTable(radius=4000.0, cant=cant)
        told = doubts_of(replace(scene, alignment=curve))
        assert any("inner rail" in text for text in told) == warned


@pytest.mark.parametrize(
    ("speed", "told"),
    [
        # V^2/R - g cant/1.5 m: 22.3 m/s^2 of 144 m/s for 144 km/h, 1.06 m/s^2
        (144.0, "22.3 m/s^2"),
        (40.0, ""),
    ],
)
def test_a_speed_in_km_an_hour_in_a_curve(speed: float, told: str) -> None:
    for curve in (
        AlignmentTable(radius=900.0, cant=0.11),
        AlignmentTable(
            section=[
                SectionTable(kind="straight", length=100.0),
                SectionTable(kind="transition", length=50.0),
                SectionTable(kind="arc", length=100.0, radius=-900.0, cant=0.11),
            ]
        ),
    ):
        said = list(too_fast(speed, curve))
        assert len(said) == (1 if told else 0)
        assert told in "".join(said)


def test_steps_that_pass_what_excites_a_vehicle() -> None:
    speed = load_vehicle_scene().speed
    for share, warned in ((0.9, False), (1.1, True)):
        scene = load_vehicle_scene(None, {"step": share * LONGEST_WAY / speed})
        told = [text for text in doubts_of(scene) if text.startswith("run.step")]
        assert bool(told) == warned
        assert not warned or "0.275 m" in told[0]


@pytest.mark.parametrize(("unit", "factor"), [("kN/mm", 1e-6), ("kN/m", 1e-3)])
def test_springs_in_another_unit(unit: str, factor: float) -> None:
    """kN/mm by the number itself, kN/m by how far the body sinks into them."""
    changed = table()
    for element in changed["element"]:
        if max(element["stiffness"]) > 0:
            element["stiffness"] = [factor * k for k in element["stiffness"]]
            element.pop("bump_stop", None)
    found = doubtful_elements(checked(changed))
    wanted = "stiffness, z, is" if unit == "kN/mm" else "stiffness is in N/m"
    assert any(wanted in text and "N/m" in text for text in found)


@pytest.mark.parametrize(
    ("key", "value", "words"),
    [
        ("friction_coefficient", [0.0, 6.0, 0.0], "coefficient, y, is 6, outside 0.001 to 1"),
        ("bump_stop", {"z": [[0.0, 0.0], [25.0, 1e5]]}, "stop.z is 25 m, outside 0.0001 to 1 m"),
        ("damping", [0.0, 0.0, 0.02], "damping, z, is 0.02 N s/m, outside 1 to 1e+08 N s/m"),
    ],
)  # fmt: skip
def test_elements(key: str, value: Any, words: str) -> None:
    changed = table()
    element = changed["element"][0]
    element[key] = value
    if key == "friction_coefficient":
        element["friction_stiffness"] = [0.0, 1e6, 0.0]
    element["series_stiffness"] = [0.0, 0.0, 0.0]
    assert any(words in text for text in doubtful_elements(checked(changed)))


def test_inertias() -> None:
    """No principal one above the sum of the others; a radius of gyration that a body can have."""
    changed = table()
    changed["body"][0]["inertia"] = [1e3, 1e3, 2.1e3]
    with pytest.raises(CaseError, match="none is above the sum of the two others"):
        checked(changed)
    changed["body"][0]["inertia"] = [5e7, 1.9e9, 1.9e9]  # kg mm^2 in thousands
    mass = changed["body"][0]["mass"]
    [_, about_y, _] = doubtful_bodies(checked(changed))
    assert f"a radius of gyration of {(1.9e9 / mass) ** 0.5:.3g} m, outside 0.02 to 15 m" in about_y


@pytest.mark.parametrize("where", ["positions", "position", "at", "lateral"])
def test_places_in_millimetres(where: str) -> None:
    changed = table()
    if where == "positions":
        for wheelset in changed["wheelset"]:
            wheelset["positions"] = [1e3 * x for x in wheelset["positions"]]
    elif where == "position":
        body = changed["body"][0]
        body["position"] = [1e3 * x for x in body["position"]]
    elif where == "at":
        place = changed["element"][0]["places"][0]
        place["at"] = [1e3 * x for x in place["at"]]
    else:
        changed["wheelset"][0].setdefault("axle_box", {"mass": 100.0, "inertia": [2.0, 4.0, 4.0]})
        changed["wheelset"][0]["axle_box"]["lateral"] = 1e3
    with pytest.raises(CaseError) as caught:
        checked(changed)
    allowed = str(caught.value).split(f"{where}: value is")[1]
    assert ("<= 10" if where == "lateral" else "in m") in allowed


def test_track_below_the_rails() -> None:
    whole = check_table(SupportTable, SUPPORT, "support")
    assert doubtful_support(whole) == []
    changed = check_table(SupportTable, {**SUPPORT, "pad_stiffness": [20.0, 100.0]}, "support")
    lateral, vertical = doubtful_support(changed)
    assert lateral == "support.pad_stiffness, lateral, is 20 N/m, outside 1e+06 to 1e+10 N/m"
    assert vertical == "support.pad_stiffness, vertical, is 100 N/m, outside 1e+06 to 1e+10 N/m"


def test_joints_beyond_the_run() -> None:
    near, far = (DipTable(position=x, angle=0.02) for x in (100.0, 900.0))
    [text] = unmet_dips((near, far), 320.0)
    assert text.startswith("dip[1].position is 900 m, and the first wheelset ends at 320 m")


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ("damping =", "dampening =", "friction_stiffness, friction_force"),
        ("damping =", "dampening =", "did you mean 'damping'?"),
        ("[run]", "[suport]\n[run]", "comfort, run, dip, wet; did you mean 'support'?"),
        ("[run]", "[comfort]\n[run]", "comfort.point: value is missing, allowed at least one [["),
        ("[run]", "[[dip]]\nposition = 60.0\n[run]", "dip[0].angle: value is missing, allowed rad"),
        ("[run]", "[[dip]]\nlengt = 1.0\n[run]", "rails; did you mean 'length'?"),
        ("[run]", "[dip]\nangle = 0.02\n[run]", "[[dip]] tables, with the keys position, angle"),
        ("[run]", "[[comfort]]\n[run]", "allowed a table [comfort], with the keys point, start"),
        ("[run]", "[comfort]\npoint = 1\n[run]", "[[comfort.point]] tables, with the keys name"),
        ("[vehicle]", "[vehicle]\ndrive = 3", "[[vehicle.drive]] tables, with the keys wheelsets"),
        (
            "[vehicle]",
            "[vehicle]\nmass = 3.0",
            "'mass' is a key of [[vehicle.body]], [[vehicle.whee",
        ),
        ("[run]", "[run]\npatch_rule = 'contact'", "'patch_rule' is a key of [method]"),
        ("[wheelset]", "[wheelset]\npatch_rule = 'contact'", "'patch_rule' is a key of [method]"),
        ("[method]", "[method]\nspeed_control = 1.0", "'speed_control' is a key of [run]"),
        ("[run]", "[run]\npad_stifness = 1.0", "did you mean 'pad_stiffness' of [support]?"),
        ("[run]", "[support]\nangle = 1.0\n[run]", "'angle' is a key of [[dip]]"),
    ],
)
def test_unknown_and_missing_keys(tmp_path: Path, old: str, new: str, words: str) -> None:
    """What is allowed stands there, also of tables in lists and of tables beside the case's; a key
    of another table is answered by that table's name."""
    text = scene_file("vehicle_straight.toml").read_text(encoding="utf-8")
    path = tmp_path / "own.toml"
    path.write_text(text.replace(old, new, 1), encoding="utf-8")
    with pytest.raises(CaseError) as caught:
        load_vehicle_scene(path)
    assert words in str(caught.value)


def test_doubts_are_said_first_and_on_the_page(tmp_path: Path) -> None:
    """Before a run that may fail by them, by hunting too, and in the head of its report, which says
    of a short run that it is not assessed."""
    text = scene_file("vehicle_straight.toml").read_text(encoding="utf-8")
    before = (
        text[: text.index("[run]")].replace("half_space", "hertz").replace('"full"', '"polach"')
    )
    path = tmp_path / "own.toml"
    path.write_text(
        before.replace("mass = 32000.0", "mass = 320.0")
        + "[[dip]]\nposition = 900.0\nangle = 0.02\n[run]\nduration = 0.02\n",
        encoding="utf-8",
    )
    log, page = tmp_path / "a.mcap", tmp_path / "a.html"
    wanted = "vehicle.car_body.mass is 320 kg", "dip[0].position is 900 m"
    for call in (["vehicle", str(path), "-o", str(log)], ["report", str(log), "-o", str(page)]):
        ran = CliRunner().invoke(cli, call)
        assert ran.exit_code == 0, ran.output
        if call[0] == "vehicle":
            for words in wanted:
                assert ran.stderr.count(words) == 1
    shown = page.read_text(encoding="utf-8")
    for words in wanted:
        assert words.removeprefix("v").removeprefix("d") in shown
    assert "No percentiles as EN 14363 counts them" in shown
    assert "No assessment by EN 14363: " in shown
    assert "m of way are too short for what it counts (52 m)" in shown
    assert "stays within its limits" not in shown
    assert assessed.LEAST_WAY == LEAST_WAY + SLIDING
    assert assessed.LEAST_RATE == LEAST_RATE
    ran = CliRunner().invoke(
        cli, ["vehicle", str(path), "--strict", "-o", str(tmp_path / "b.mcap")]
    )
    assert ran.exit_code == 2
    assert not (tmp_path / "b.mcap").exists()
    ran = CliRunner().invoke(cli, ["hunting", str(path), "--lowest", "20", "--highest", "21"])
    assert wanted[0] in ran.stderr
