"""From the case to the core: which key each field comes from, and that none is forgotten."""

from __future__ import annotations

from typing import Any, get_args

import pytest
from case_samples import PATCH, WHEELSET, with_values
from pydantic import BaseModel
from railpatch import _core
from railpatch.case import load_scene
from railpatch.case.load import KINDS
from railpatch.case.moving import BY_TABLE, moving_keys
from railpatch.case.patch import STEPWISE
from railpatch.case.to_core import config_of, field_of, input_of, passed
from railpatch.case.types import SIDES

# fields that are made of keys in another form, and of which
MADE = {
    "kind": "kind",
    "geometry": "which key of [geometry] is given",
    "load": "normal_force or approach, z or vertical_force",
    "force_prescribed": "motion.tangential_force",
    "slip_law": "friction.shape",
    "temperature": "whether there is a table [temperature]",
    "bulk_temperature": "temperature.wheel, rail",
    "friction_points": "friction.factor",
    "friction_position": "friction.factor",
    "friction_along_points": "friction.along_track",
    "friction_along_position": "friction.along_track",
    "friction_along_factor": "friction.along_track",
    "finer_grids": "method.accuracy",
    "hardening_points": "layer.hardening_table",
    "hardening_displacement": "layer.hardening_table",
    "hardening_stress": "layer.hardening_table",
    "distance_shape": "geometry.undeformed_distance",
    "slip_by_element": "motion.slip_field",
    "own_influence": "material.influence_file",
    "roll_balanced": "wheelset.roll = 'balanced'",
    "axle_free": "wheelset.pitch_rate = 'free'",
    "longitudinal_prescribed": "wheelset.longitudinal_force",
    "fluid_viscosity_points": "fluid.viscosity_table",
    "fluid_viscosity_temperature": "fluid.viscosity_table",
    "fluid_viscosity_value": "fluid.viscosity_table",
    "fluid_inlet_conductivity": "fluid.inlet_heating, liquid_conductivity",
    **{
        f"fluid_knot_{name}": "fluid.knots"
        for name in ("rate", "k_a", "k_s", "coefficient", "a", "b")
    },
    "fluid_oxide_content": "fluid.oxide.solid_content",
    "fluid_oxide_exponent": "fluid.oxide.exponent",
    "fluid_drying_time": "fluid.oxide.drying.time",
    "fluid_drying_work": "fluid.oxide.drying.work",
    "section_count": "track.left.sections",
    "section_match": "track.left.sections features",
    "wheel_section_count": "wheelset.left.sections",
    "rail_origin_y": "track.left.origin",
    "rail_origin_z": "track.left.origin",
    "runout_count": "wheelset.left.runout, flat",
    "rail_height_count": "track.left.running_surface, joint",
    "rail_height_start": "track.left.running_surface, joint",
    "rail_height_spacing": "track.left.running_surface, joint",
}


def tables(model: type[BaseModel], name: str = "") -> dict[str, type[BaseModel]]:
    """Name -> model of each table of a case."""
    found = {name: model} if name else {}
    for key, field in model.model_fields.items():
        for option in (field.annotation, *get_args(field.annotation)):
            if isinstance(option, type) and issubclass(option, BaseModel):
                found |= tables(option, key)
    return found


def reached(fields: dict[str, Any]) -> dict[str, set[str]]:
    """Field -> the keys that pass to it."""
    found: dict[str, set[str]] = {}
    for kind in KINDS.values():
        for name, model in tables(kind).items():
            # deviations go by table and side
            for key in model.model_fields if name not in SIDES else ():
                field = field_of(name, key, fields)
                if field is not None:
                    found.setdefault(field, set()).add(f"{name}.{key}")
    return found


def test_every_field_of_a_config_has_its_key() -> None:
    """A new field of the core needs a key of its name, or a line above that tells what makes it."""
    found = reached(_core.CONFIG_FIELDS)
    assert set(_core.CONFIG_FIELDS) - set(found) == set(MADE)


def test_no_field_has_two_keys() -> None:
    for fields in (_core.CONFIG_FIELDS, _core.INPUT_FIELDS):
        for field, keys in reached(fields).items():
            assert len(keys) == 1, (field, keys)


@pytest.mark.parametrize("case", [PATCH, WHEELSET])
def test_moving_keys_are_fields_of_an_input(case: dict[str, Any]) -> None:
    """By their own name, but for tables and what counts steps."""
    scene = load_scene(with_values(case, temperature={"wheel": 20.0}, method__tangential="full"))
    keys = set(moving_keys(scene.case)) - {*SIDES, *BY_TABLE, "steps"}
    assert keys <= set(_core.INPUT_FIELDS)
    given = input_of(scene.case)
    assert keys <= set(given)
    assert set(given) <= set(_core.INPUT_FIELDS)


def test_stepwise_keys_move() -> None:
    motion = {"regime": "transient_rolling", "distance": 1e-3, "steps": 4}
    scene = load_scene(with_values(PATCH, motion=motion))
    assert set(STEPWISE) <= set(moving_keys(scene.case))
    # a step rolls its part of the way
    assert input_of(scene.case)["distance"] == 2.5e-4


def test_an_accuracy_is_resolved_for_all_of_a_config() -> None:
    """Grid and methods are those that it chooses; nothing of the case as it was is mixed in."""
    case = with_values(PATCH, method={"accuracy": 0.02})
    case.pop("grid", None)
    scene = load_scene(case)
    config = config_of(scene)
    assert scene.case.grid is None
    assert config["normal"] == "hertz"
    assert config["fitted"] != [0, 0] or config["tangential"] == "table"


def test_what_is_left_out_keeps_the_default() -> None:
    scene = load_scene(PATCH)
    assert passed("layer", scene.case.layer, _core.CONFIG_FIELDS) == {}
    assert not {"max_iterations", "traction_bound", "standstill_speed"} & set(config_of(scene))
