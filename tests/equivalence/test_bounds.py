"""The case's ranges are those of the core: what the schema refuses, the core refuses too."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any

import pytest
from case_samples import PATCH, WHEELSET, with_values
from railpatch import CaseError, _core
from railpatch.case import load_scene
from railpatch.case.load import KINDS
from railpatch.case.messages import table_at
from railpatch.case.to_core import config_of, input_of

ROLLER = with_values(WHEELSET, track={"kind": "roller", "roller_radius": 0.8})
LINE = with_values(
    PATCH, geometry={"line_contact_radius": 0.5, "width": 0.01}, grid={"elements": [16, 1]}
)
CURVED = with_values(PATCH, geometry={"curvatures": [1.0, 1.0]}, load={"approach": 1e-5})
SIZED = with_values(CURVED, grid={"element_size": [1e-4, 1e-4]})
METHODS = {name: with_values(PATCH, method__tangential=name) for name in ("polach", "fastsim")}
LAYERED = with_values(PATCH, layer={"shear_modulus": 8e9, "thickness": 1e-5})

# case, key of the case, field of the core's structs
CONFIG_KEYS = [
    (PATCH, "geometry.semi_axes", "semi_axes"),
    (CURVED, "geometry.curvatures", "curvatures"),
    (LINE, "geometry.line_contact_radius", "line_contact_radius"),
    (LINE, "geometry.width", "width"),
    (SIZED, "grid.element_size", "element_size"),
    (PATCH, "friction.coefficient", "friction_coefficient"),
    (LAYERED, "layer.shear_modulus", "layer_shear_modulus"),
    (LAYERED, "layer.thickness", "layer_thickness"),
    (PATCH, "method.tolerance", "tolerance"),
    (PATCH, "method.max_iterations", "max_iterations"),
    (METHODS["polach"], "method.percent_kalker", "percent_kalker"),
    (METHODS["polach"], "method.polach_k_a", "polach_k_a"),
    (METHODS["polach"], "method.polach_k_s", "polach_k_s"),
    (METHODS["fastsim"], "method.fastsim_k0", "fastsim_k0"),
    (METHODS["fastsim"], "method.fastsim_alpha", "fastsim_alpha"),
    (METHODS["fastsim"], "method.fastsim_beta", "fastsim_beta"),
    (PATCH, "material.shear_modulus", "shear_modulus"),
    (PATCH, "material.poisson_ratio", "poisson_ratio"),
    (WHEELSET, "wheelset.nominal_radius", "nominal_radius"),
    (WHEELSET, "wheelset.flange_back_distance", "flange_back_distance"),
    (WHEELSET, "wheelset.flange_back_position", "flange_back_position"),
    (WHEELSET, "wheelset.max_patches", "max_patches"),
    (WHEELSET, "method.standstill_speed", "standstill_speed"),
    (WHEELSET, "track.gauge", "gauge"),
    (WHEELSET, "track.gauge_height", "gauge_height"),
    (WHEELSET, "track.cant", "cant"),
    (WHEELSET, "track.curvature", "curvature"),
    (ROLLER, "track.roller_radius", "roller_radius"),
]
INPUT_KEYS = [
    (PATCH, "load.normal_force", "normal_force"),
    (PATCH, "motion.rolling_speed", "rolling_speed"),
    (WHEELSET, "wheelset.y", "y"),
    (WHEELSET, "wheelset.z", "z"),
    (WHEELSET, "wheelset.roll", "roll"),
    (WHEELSET, "wheelset.yaw", "yaw"),
]


def bounds(schema: dict[str, Any]) -> tuple[float, float, bool]:
    """Lowest and highest value of a number or of the numbers in a list; True: the lowest is out."""
    for part in (schema, schema.get("items"), *schema.get("anyOf", ())):
        if part and part.get("type") == "array":
            part = part["items"]
        if part and part.get("type") in ("number", "integer"):
            low = part.get("minimum", part.get("exclusiveMinimum", -math.inf))
            return low, part.get("maximum", math.inf), "exclusiveMinimum" in part
    raise AssertionError(schema)


def outside(case: dict[str, Any], key: str) -> Iterator[float]:
    """Values just beyond the key's range."""
    table, name = key.split(".")
    model = table_at(KINDS[case["kind"]], [table])
    low, high, low_is_out = bounds(model.model_json_schema()["properties"][name])
    assert math.isfinite(low) or math.isfinite(high), f"{key} has no range"
    whole = isinstance(low, int) and isinstance(high, int) and "max_" in name
    if math.isfinite(low):
        yield low if low_is_out else low - 1 if whole else low - 1e-9 * max(abs(low), 1e-9)
    if math.isfinite(high):
        yield high + 1 if whole else high * (1 + 1e-9)


def like(value: Any, number: float) -> Any:
    """A list of the same length as the present value, or the number."""
    return [number] * len(value) if isinstance(value, list) else number


@pytest.mark.parametrize(("case", "key", "field"), CONFIG_KEYS)
def test_configuration(case: dict[str, Any], key: str, field: str) -> None:
    config = config_of(load_scene(case))
    _core.Contact(config)
    for number in outside(case, key):
        value = like(config.get(field), number)
        with pytest.raises(CaseError, match=field):
            _core.Contact({**config, field: value})
        with pytest.raises(CaseError) as caught:
            load_scene(with_values(case, **{key.replace(".", "__"): value}))
        assert caught.value.problems[0].startswith(key)


@pytest.mark.parametrize(("case", "key", "field"), INPUT_KEYS)
def test_input(case: dict[str, Any], key: str, field: str) -> None:
    scene = load_scene(case)
    contact = _core.Contact(config_of(scene))
    values = input_of(scene.case)
    contact.step(values)
    for number in outside(case, key):
        with pytest.raises(CaseError, match=field):
            contact.step({**values, field: number})
        with pytest.raises(CaseError) as caught:
            load_scene(with_values(case, **{key.replace(".", "__"): number}))
        assert caught.value.problems[0].startswith(key)


def test_unknown_fields_are_refused() -> None:
    scene = load_scene(PATCH)
    with pytest.raises(KeyError, match="no field"):
        _core.Contact({**config_of(scene), "elemnts": [8, 8]})
    with pytest.raises(ValueError, match="no such choice"):
        _core.Contact({**config_of(scene), "normal": "stripes"})
    with pytest.raises(KeyError, match="no field"):
        _core.Contact(config_of(scene)).step({"creepages": [0.0, 0.0]})
