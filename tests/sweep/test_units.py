"""Units on the page of a sweep: of keys by the scene's schema, of outputs by the lists of results,
channels and summaries."""

from __future__ import annotations

from dataclasses import fields
from pathlib import Path

import numpy as np
import pytest
from railpatch import solve
from railpatch.case.kinds import kind_of, kinds
from railpatch.sweep.outputs import default_names
from railpatch.sweep.page import glance
from railpatch.sweep.units import unit_of_output, unit_of_varied

from wheelset_demo.kinds import TIMES, VEHICLE_UNITS, WHEELSET_UNITS
from wheelset_demo.summary import Summary
from wheelset_demo.vehicle.trace import VehicleSummary


@pytest.mark.parametrize(
    ("kind", "name", "unit"),
    [
        ("wheel_rail", "force[1]", "N"),
        ("wheel_rail", "max(patches.max_pressure)", "Pa"),
        ("wheelset", "left.patches[0].contact_area", "m^2"),
        ("wheelset", "conicity", ""),
        ("wheelset", "left.wear_number", "N"),
        ("patch", "error_estimate.max_pressure", "Pa"),
        ("patch", "damage.wear_rate", "kg/m"),
        ("patch", "elements.stick", ""),
        ("curve", "curves[0].yaw", "rad"),
        ("curve", "absmax(curves.left_force)", "N"),
        ("rig", "absmax(/right/contact.force[1])", "N"),
        ("rig", "max(/right/contact.patches[0].max_pressure)", "Pa"),
        ("rig", "last(/rig/balance.residuals[0])", "N m"),
        ("rig", "last(/rig/balance.residuals[1])", "N"),
        ("rig", "evaluations", ""),
        ("wheelset_run", "energies.friction", "J"),
        ("wheelset_run", "waves.length", "m"),
        ("wheelset_run", "waves.count", ""),
        ("vehicle", "load_range[0]", "N"),
        ("vehicle", "comfort[1]", "m/s^2"),
        ("vehicle", "max(/no/such.thing)", ""),
    ],
)
def test_of_outputs(kind: str, name: str, unit: str) -> None:
    assert unit_of_output(kind, name) == unit


@pytest.mark.parametrize(
    ("kind", "key", "unit"),
    [
        ("patch", "motion.creepage[0]", ""),
        ("patch", "load.normal_force", "N"),
        ("wheel_rail", "wheelset.yaw", "rad"),
        ("wheel_rail", "profiles.wheel", ""),
        ("wheel_rail", "material.shear_modulus", "Pa"),
        ("rig", "track.roller_radius", "m"),
    ],
)
def test_of_keys(kind: str, key: str, unit: str) -> None:
    assert unit_of_varied(kind, key) == unit


@pytest.mark.parametrize(
    ("summary", "units"), [(Summary, WHEELSET_UNITS), (VehicleSummary, VEHICLE_UNITS)]
)
def test_every_number_of_a_run_has_a_line(summary: type, units: dict[str, str]) -> None:
    names = {field.name for field in fields(summary)} - TIMES - {"good", "message", "warnings"}
    assert names == {name.partition(".")[0] for name in units}


def test_quantities_that_have_units_show_them() -> None:
    """Of an example's result all numbers, by the units that the terminal has."""
    scene = kind_of("wheel_rail").scene
    result = solve(Path(scene)).to_dict()
    names = default_names(result)
    assert len(names) > 10
    without = {n.partition("[")[0] for n in names if not unit_of_output("wheel_rail", n)}
    assert without <= {"residual", "derailment_quotient"}


def test_every_kind_with_a_run_has_units() -> None:
    assert [n for n in kinds() if kind_of(n).run and not kind_of(n).units] == []


@pytest.mark.parametrize(
    ("values", "unit", "text"),
    [
        ([7.62e8, 7.98e8], "Pa", "762 to 798\u00a0MPa"),
        ([-31473.0, 27522.0], "N", "\u221231.5 to 27.5\u00a0kN"),
        ([0.01, 0.01], "rad", "0.01\u00a0rad"),
        ([12000.0], "", "12\u202f000"),
        ([2e-10, 4.82e-8], "m", "0.2 to 48.2\u00a0nm"),
        ([0.3], "m", "0.3\u00a0m"),
        ([12000.0], "m", "12\u202f000\u00a0m"),
    ],
)
def test_numbers_at_a_glance(values: list[float], unit: str, text: str) -> None:
    assert glance(np.array(values), unit) == text
