"""A choice that must be given and is not: the message lists its words."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from pydantic import BaseModel, ValidationError
from railpatch.case.homes import models_in
from railpatch.case.kinds import kind_of, kinds, write_example
from railpatch.case.load import read_toml
from railpatch.case.messages import problems, words_of
from railpatch.match.plan import MatchTable
from railpatch.sweep.plan import SweepFile


def choices_asked_for(model: type[BaseModel], seen: set[type[BaseModel]]) -> Iterator[Any]:
    """Tables, keys and words of choices that must be given, of all tables below a model."""
    if model in seen:
        return
    seen.add(model)
    for key, field in model.model_fields.items():
        words = words_of(field.annotation)
        if field.is_required() and words:
            yield model, key, words
        for table in models_in(field.annotation):
            yield from choices_asked_for(table, seen)


def test_a_missing_choice_names_its_words() -> None:
    """Of every table of every kind of scene, and of sweeps and matches."""
    seen: set[type[BaseModel]] = set()
    models = [*(kind.model for kind in kinds().values()), SweepFile, MatchTable]
    found = [one for model in models for one in choices_asked_for(model, seen)]
    assert ("kind", ["straight", "transition", "arc"]) in [(key, words) for _, key, words in found]
    for table, key, words in found:
        with pytest.raises(ValidationError) as error:
            table.model_validate({})
        (line,) = [line for line in problems(table, error.value) if line.startswith(f"{key}:")]
        *first, last = map(repr, words)
        listed = f"{', '.join(first)} or {last}" if first else last
        assert line.startswith(f"{key}: value is missing, allowed {listed}"), (table, line)


def test_a_section_without_a_kind(tmp_path: Path) -> None:
    """A section of a vehicle's track, by its place."""
    scene = write_example(kind_of("vehicle"), tmp_path)[0]
    values = read_toml(scene)
    values["alignment"] = {"section": [{"length": 50.0}]}
    with pytest.raises(ValidationError) as error:
        kind_of("vehicle").model.model_validate(values)
    assert (
        "alignment.section[0].kind: value is missing, allowed 'straight', 'transition' or 'arc': a "
        "transition (Bloss) joins what lies before and after it"
    ) in problems(kind_of("vehicle").model, error.value)
