"""The table of docs/units.md on where the quantities stand that engineers read."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import pytest
import tomllib
from railpatch import _core, solve
from railpatch.log import channels
from railpatch.report import quantities
from railpatch.sweep.outputs import value_of

ROOT = Path(__file__).resolve().parents[2]
LEVELS = {"patch": "patch", "patch of a wheel": "patch", "wheel": "side", "wheelset": "result"}
MESSAGES = {
    "patch": channels.PATCH,
    "side": channels.WHEEL_CONTACT,
    "result": channels.WHEELSET_STATE,
}


def rows() -> dict[str, list[str]]:
    text = (ROOT / "docs" / "units.md").read_text(encoding="utf-8")
    text = text[text.index("What engineers read, and where it stands") :].split("\n\n")[1]
    cells = [re.split(r" *\| *", line.strip("| ")) for line in text.splitlines()[2:]]
    return {name.strip("`"): rest for name, *rest in cells}


def test_all_are_listed() -> None:
    """Members that the results have had since the wear number, in the order of the lists, but for
    those of viscoelastic bodies, which are in no run of wheels."""
    of_patches = {"viscous_power", "rolling_resistance_moment"}
    for level, first in (("patch", "wear_number"), ("side", "wear_number"), ("result", "conicity")):
        names = list(_core.QUANTITIES[level])
        assert set(names[names.index(first) :]) - of_patches <= set(rows())


@pytest.mark.parametrize("name", rows())
def test_where_it_stands(name: str, wheelset: dict[str, Any]) -> None:
    levels, _, _, sweeps, wheelset_page, vehicle_page, fmu = rows()[name]
    for level in (LEVELS[one] for one in levels.split(", ")):
        assert name in _core.QUANTITIES[level]
        assert name in {field.name for field in MESSAGES[level].fields}
        inside = {"patch": "left.patches[0].", "side": "left.", "result": ""}[level]
        index = "[0]" if _core.QUANTITIES[level][name]["shape"] else ""
        found = value_of(f"{inside}{name}{index}", wheelset, None)
        assert (sweeps == "yes") is isinstance(found, float)
    of_patch = {part[0] for part in quantities.OF_PATCH}
    drawn = {*quantities.OF_WHEEL, *of_patch, *quantities.OF_WHEELSET}
    assert wheelset_page.startswith("figure") is (name in drawn)
    assert (fmu == "yes") is (name in variables())
    assert vehicle_page in ("figure", "figure, where wet", "table", "figure, table", "no")


def variables() -> set[str]:
    """Outputs of the FMU."""
    table = tomllib.loads((ROOT / "plugins/fmu/variables.toml").read_text(encoding="utf-8"))
    return {v["name"] for g in table["group"] if g["causality"] == "output" for v in g["variables"]}


@pytest.fixture(scope="module")
def wheelset() -> dict[str, Any]:
    """A result off the middle, so that it has a conicity."""
    case = {
        "kind": "wheelset",
        "material": {"shear_modulus": 82e9, "poisson_ratio": 0.28},
        "grid": {"elements": [8, 8]},
        "friction": {"coefficient": 0.3},
        "method": {"normal": "hertz", "tangential": "fastsim"},
        # with a liquid that has a friction of its own
        "fluid": {"model": "film", "roughness": 1e-6, "viscosity": 0.1, "eyring_stress": 5e6},
        "wheelset": {
            **{"y": 1e-3, "vertical_force": 1.2e5, "speed": 20.0, "pitch_rate": -20.0 / 0.46},
            **{"nominal_radius": 0.46, "flange_back_distance": 1.36},
            "flange_back_position": -0.07,
        },
        "track": {"kind": "rail", "gauge": 1.435, "gauge_height": 0.014},
        "profiles": {"wheel": "S1002", "rail": "UIC60@1:40"},
    }
    return solve(case).to_dict()
