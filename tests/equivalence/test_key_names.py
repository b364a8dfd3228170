"""Refusals name the case's key: no number of a case comes as far as the core's own check, whose
text has the name of a field in C.

Generated from the schema: every key with numbers gets numbers far outside, in the first base case
in which it may change. A field of the core's configuration that no key reaches stands in DERIVED.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import Any

import numpy as np
import pytest
import railpatch
from bits.combinations import OF_WHEELS
from case.key_cases import base_of, features, keys_of, listed_value
from case_samples import with_values
from railpatch import _core
from railpatch.case import load_scene
from railpatch.case.load import KINDS
from railpatch.case.to_core import config_of

Case = dict[str, Any]
NUMBERS = (1e30, -1e30)
WHOLE = (10**9, -1)
# fields with a range whose numbers the package makes itself, from words, counts and files
DERIVED = {
    *("distance_shape", "force_prescribed", "finer_grids", "temperature", "slip_by_element"),
    "own_influence",
    *("regime_changes", "roll_balanced", "axle_free", "longitudinal_prescribed", "side"),
    *("friction_points", "friction_along_points", "hardening_points", "fluid_viscosity_points"),
    *("fluid_knots", "section_count", "wheel_section_count", "derivatives", "heat_exchange"),
    *("runout_count", "rail_height_count"),
}
KEY = re.compile(r"^[a-z_]+[a-z_0-9.\[\]]*: ")


def own_features(kind: str) -> dict[str, Case]:
    """Those of the tests of keys, and what they have no base case for."""
    found = {"": {}, **features(kind)}
    if kind == "patch":
        found["approach"] = {"geometry": {"curvatures": [0.8, 1.4]}, "load": {"approach": 1e-5}}
        found["accuracy"] = {
            "geometry": {"curvatures": [0.8, 1.4]},
            "grid": None,
            "method__accuracy": 0.03,
        }
        found["viscosities"] = {
            "fluid": {
                **{"model": "film", "roughness": 1e-6, "boundary_friction": 0.2},
                "viscosity_table": [[0.0, 0.3], [50.0, 0.05]],
            }
        }
        found["film of water"] = {
            "fluid": {**found["water"]["fluid"], "oxide": {"solid_content": 0.3}}
        }
    else:
        found["elements"] = OF_WHEELS["elements"]
        found["dries"] = {
            "fluid": {
                **found["water"]["fluid"],
                "oxide": {"solid_content": 0.3, "drying": {"time": 20.0, "work": 4e3}},
            },
            "wheelset__time_step": 1e-2,
        }
    return found


def leaves(value: Any, far: bool) -> Iterator[Any]:
    """The value with another number in the first or the last place of a list, in a table, or in its
    own place: far outside, or a little greater."""
    if isinstance(value, list):
        for k in sorted({0, len(value) - 1}) if value else ():
            for changed in leaves(value[k], far):
                yield [*value[:k], changed, *value[k + 1 :]]
    elif isinstance(value, dict):
        for key, part in value.items():
            for changed in leaves(part, far):
                yield {**value, key: changed}
    elif isinstance(value, float):
        yield from NUMBERS if far else (1.07 * value if value else 1e-4,)
    elif isinstance(value, int) and not isinstance(value, bool):
        yield from WHOLE if far else (value + 1,)


def changes(kind: str) -> Iterator[tuple[str, Case, list[Case], list[Case]]]:
    """Path, case, and cases with other numbers: a little greater, and far outside; each key of the
    first case in which it may change."""
    seen: set[str] = set()
    for feature in own_features(kind).values():
        case = with_values(base_of(kind), **feature)
        tables = {key.split("__")[0] for key in feature}
        for path, _, value in keys_of(KINDS[kind], case):
            value = listed_value(path) if value is None else value
            if path in seen or (feature and path.split(".")[0] not in tables):
                continue
            put = [
                [with_values(case, **{path.replace(".", "__"): v}) for v in leaves(value, far)]
                for far in (False, True)
            ]
            near = [one for one in put[0] if accepted(one)]
            if near:
                seen.add(path)
                yield path, case, near, put[1]


def accepted(case: Case) -> bool:
    """Whether a case may be."""
    try:
        load_scene(case)
    except railpatch.CaseError:
        return False
    return True


def reached(config: dict[str, Any], other: dict[str, Any]) -> Iterator[str]:
    """Fields whose numbers differ."""
    for name, value in other.items():
        if isinstance(value, int | float | list) and name in _core.CONFIG_FIELDS:
            before = config.get(name)
            if before is None or not np.array_equal(
                np.asarray(before, dtype=object), np.asarray(value, dtype=object)
            ):
                yield name


def ranged() -> set[str]:
    """Fields of the configuration with a range."""
    return {
        name
        for name, field in _core.CONFIG_FIELDS.items()
        if field["bounds"] and field["type"] in ("double", "int32_t")
    }


@pytest.fixture(scope="module")
def found() -> tuple[list[str], set[str]]:
    """Refusals in the core's words, and the fields that the keys reach."""
    wrong, fields = [], set()
    for kind in ("patch", "wheelset"):
        plain: tuple[Any, Case] = (None, {})
        for path, case, near, far in changes(kind):
            if plain[0] is not case:
                plain = case, config_of(load_scene(case))
            for changed in near:
                fields.update(reached(plain[1], config_of(load_scene(changed))))
            for changed in far:
                try:
                    _core.Contact(config_of(load_scene(changed)))
                except (railpatch.CaseError, railpatch.ProfileError) as error:
                    text = str(error)
                    named = path.rpartition(".")[2] in text if by_file(error) else KEY.match(text)
                    if not named or "allowed is" in text:
                        wrong.append(f"{kind} {path}: {text[:120]}")
    return wrong, fields


def by_file(error: Exception) -> bool:
    """Whether the message is on a profile."""
    return isinstance(error, railpatch.ProfileError)


def test_no_refusal_is_in_the_words_of_c(found: tuple[list[str], set[str]]) -> None:
    assert found[0] == []


def test_every_field_with_a_range_has_a_key(found: tuple[list[str], set[str]]) -> None:
    assert ranged() - found[1] - DERIVED == set()
