"""What the core gives reaches JSON, terminal, log and FMU, or stands in a list with the reason."""

from __future__ import annotations

import re
import sys
from pathlib import Path
from typing import Any

import pytest
from case_samples import PATCH, WHEELSET, with_values
from railpatch import Result, _core, solve
from railpatch.command.tables import IN_WORDS, print_result
from railpatch.log import channels
from railpatch.result import LEFT_OUT, PATCH_UNITS, PLACE_UNITS, WHEEL_UNITS
from rich.console import Console

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib

LOADED = with_values(WHEELSET, wheelset__z=None, wheelset__vertical_force=2e4)
VARIABLES = Path(__file__).parents[2] / "plugins/fmu/variables.toml"
# units as FMI spells them
FMI_UNITS = {"-": "1", "m^2": "m2", "N m": "N.m", "degrees C": "degC", "m^3/s": "m3/s"}
# field numbers of logs that are out there
PATCH_FIELDS = (
    *("status", "position", "contact_angle", "creepage", "spin_creepage", "rolling_speed"),
    *("normal_force", "approach", "creep_force", "spin_moment", "max_pressure", "contact_area"),
    *("elements", "max_temperature", "friction_power", "elastic_energy", "iterations", "residual"),
    *("wall_time", "error_estimate", "plastic_power", "outer_iterations", "ambiguous_elements"),
    "share",
)


# of stages that the scenes have not
NOT_THERE = {"max_temperature", "plastic_power", "wheel_heat", "rail_heat"}
NOT_THERE |= {"wheel_temperature", "rail_temperature"}
NOT_THERE |= {
    "central_film_thickness",
    "mean_asperity_share",
    "fluid_temperature",
    "effective_friction",
    "fluid_power",
    "oxide_water",
    "viscous_power",
    "rolling_resistance_moment",
}


def shown(result: Result) -> str:
    """What the terminal shows."""
    console = Console(record=True, width=400)
    print_result(result, console)
    return console.export_text()


def test_json_has_every_quantity() -> None:
    units = {"patch": PATCH_UNITS | PLACE_UNITS, "side": WHEEL_UNITS}
    for struct, left_out in LEFT_OUT.items():
        assert set(left_out) < set(_core.QUANTITIES[struct])
        assert not set(left_out) & set(units[struct])
        assert set(_core.QUANTITIES[struct]) <= set(left_out) | set(units[struct])


def test_the_terminal_shows_every_quantity_of_a_patch() -> None:
    result = solve(PATCH)
    rows = {line.split()[0] for line in shown(result).splitlines() if line}
    assert set(PATCH_UNITS) - NOT_THERE - set(IN_WORDS) <= rows


def test_the_terminal_shows_every_quantity_of_a_wheel() -> None:
    data: dict[str, Any] = solve(LOADED).data
    wheel = data["right"]
    wheel.update(rail_deflection=[1e-4, 2e-4], rail_deflection_rate=[0.0, 0.0])
    wheel["alternatives"] = [{**wheel["patches"][0], "share": 0.25}]
    text = shown(Result(data))
    rows = {line.split()[0] for line in text.splitlines() if line}
    assert set(WHEEL_UNITS) - NOT_THERE - set(IN_WORDS) <= rows
    assert set(PLACE_UNITS) <= rows
    assert "right alternative 1" in text
    assert "0.25" in text


@pytest.mark.parametrize("case", [PATCH, LOADED], ids=["patch", "wheelset"])
def test_the_terminal_shows_what_tables_of_a_case_ask_for(case: dict[str, Any]) -> None:
    asked = {"subsurface": {"depths": [1e-3, 2e-3]}, "damage": {"wear": "usfd"}}
    result = solve({**case, **asked})
    data = result.data if case is PATCH else result.data["right"]
    found = {
        f"{name}.{key}": value
        for name in asked
        for key, value in data[name].items()
        if value is not None and value == value  # not NaN: a patch has no wheel to spread wear on
    }
    lines = {line.split()[0]: line for line in shown(result).splitlines() if line}
    assert set(found) <= set(lines)
    assert "Pa" in lines["subsurface.von_mises"]
    assert all(f"{depth:g}" in lines["subsurface.depth"] for depth in (1e-3, 2e-3))


def test_the_log_keeps_its_field_numbers() -> None:
    names = tuple(field.name for field in channels.PATCH.fields)
    assert names[: len(PATCH_FIELDS)] == PATCH_FIELDS


def fmu_variables() -> list[tuple[str, str, str]]:
    """Name of a variable, unit of its type, and the field that it is."""
    table = tomllib.loads(VARIABLES.read_text())
    units = {name: kind.get("unit") for name, kind in table["type"].items()}
    return [
        (variable["name"], units[variable["type"]], variable["field"])
        for group in table["group"]
        if group["causality"] in ("input", "output")
        for variable in group["variables"]
        if variable.get("field") and units[variable["type"]]
    ]


@pytest.mark.parametrize(("name", "unit", "field"), fmu_variables())
def test_variables_of_the_fmu_have_the_units_of_their_fields(
    name: str, unit: str, field: str
) -> None:
    path = re.sub(r"\[.*?\]", "", field).removeprefix("result.").split(".")
    structs = {("side", "patch"): "patch", ("side",): "side", (): "result"}
    if path[0] == "sums" or path[0] == "rest_temperature":
        return
    quantities = _core.QUANTITIES[structs[tuple(path[:-1])]]
    known = quantities.get(path[-1]) or _core.INPUT_FIELDS[path[-1]]
    assert unit == FMI_UNITS.get(known["unit"], known["unit"]), name
