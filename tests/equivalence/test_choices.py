"""The words of choices stand once, in railpatch.h: what else names them agrees."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any, Literal, get_args, get_origin

import pytest
from case_samples import PATCH
from pydantic import BaseModel
from railpatch import Contact, _core, result
from railpatch.case.asked import Damage, Subsurface
from railpatch.case.load import KINDS
from railpatch.case.types import BODIES
from railpatch.case.wheel import ProfileFile
from railpatch.log import channels

# key of a case table -> choice of the core, and words of one of the two alone
KEYS: dict[str, tuple[str, set[str]]] = {
    "Friction.law": ("friction_law", set()),
    # Polach's law is an exponential one with numbers of its own
    "Friction.shape": ("slip_law", {"polach"}),
    # the table is left out for none
    "Fluid.model": ("fluid_model", {"none"}),
    "Fluid.share": ("fluid_share", set()),
    # said by the keys of the viscosity
    "Fluid.liquid": ("liquid", {"given", "table"}),
    "Layer.plastic_rule": ("plastic_rule", set()),
    "Method.normal": ("normal_method", set()),
    "Method.tangential": ("tangential_method", set()),
    "Method.spin_offset": ("spin_offset", set()),
    "Method.reference_surface": ("reference_surface", set()),
    # the key is left out for it
    "Method.traction_bound": ("traction_bound", {"automatic"}),
    "Method.flexibility_blending": ("flexibility_blending", set()),
    "Method.patch_rule": ("patch_rule", set()),
    "Method.contact_frame": ("contact_frame", set()),
    "Motion.regime": ("regime", set()),
    # wheels do not shift, and without a tangential problem they have no motion
    "WheelMotion.regime": ("regime", {"none", "shift"}),
    "Track.kind": ("track", set()),
    "Track.section_blend": ("section_blend", set()),
    "Wheel.side": ("side", set()),
    "PatchCase.kind": ("kind", {"wheel_rail", "wheelset"}),
    "WheelRailCase.kind": ("kind", {"patch", "wheelset"}),
    "WheelsetCase.kind": ("kind", {"patch", "wheel_rail"}),
}


def literals(annotation: Any) -> set[str]:
    """Words of an annotation of choices; none where it may be a number or a table too."""
    if get_origin(annotation) is Literal:
        return {word for word in get_args(annotation) if isinstance(word, str)}
    parts = [part for part in get_args(annotation) if part is not type(None)]
    return literals(parts[0]) if len(parts) == 1 and get_origin(annotation) is not list else set()


def tables(model: type[BaseModel]) -> Iterator[type[BaseModel]]:
    """A table of a case and all in it."""
    yield model
    for field in model.model_fields.values():
        for part in (field.annotation, *get_args(field.annotation)):
            if isinstance(part, type) and issubclass(part, BaseModel):
                yield from tables(part)


def test_the_words_of_case_tables() -> None:
    found = {}
    for table in {table for kind in KINDS.values() for table in tables(kind)}:
        for name, field in table.model_fields.items():
            # how files are read, and laws of damage, are no matter of the core
            if table not in (ProfileFile, Damage, Subsurface) and (
                words := literals(field.annotation)
            ):
                found[f"{table.__name__}.{name}"] = words
    assert set(found) == set(KEYS)
    for key, (choice, apart) in KEYS.items():
        assert found[key] ^ set(_core.CHOICES[choice]) == apart, key


def test_the_words_of_bodies() -> None:
    """Of [subsurface], whose bodies the core takes by number (RP_BODIES)."""
    assert get_args(Subsurface.model_fields["body"].annotation) == BODIES


def test_the_words_of_results_and_logs() -> None:
    assert result.DIVISION == channels.ELEMENT_STATES == _core.CHOICES["element"]
    assert tuple(_core.STATUSES.values()) == channels.STATUSES == _core.CHOICES["status"]
    assert set(result.FIELDS) <= set(_core.CHOICES["field"])


def test_the_words_of_stages() -> None:
    assert tuple(stage["name"] for stage in Contact(PATCH).stages()) == _core.CHOICES["stage"]


@pytest.mark.parametrize(
    "field", [f for f in _core.CONFIG_FIELDS.values() if f["role"] == "choice"]
)
def test_a_choice_starts_with_a_word_of_its_own(field: dict[str, Any]) -> None:
    assert field["start"] in _core.CHOICES[field["type"].removeprefix("rp_")]
