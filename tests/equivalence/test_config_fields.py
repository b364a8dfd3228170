"""What the core's lists of fields say to Python, against the structs and what reads them."""

from __future__ import annotations

import math
from typing import Any

import pytest
from railpatch import _core


@pytest.mark.parametrize("listed", [_core.CONFIG_FIELDS, _core.INPUT_FIELDS])
def test_defaults_lie_in_their_ranges(listed: dict[str, dict[str, Any]]) -> None:
    assert len(listed) > 30
    for name, field in listed.items():
        # 0 stands for what is left out
        if not field["bounds"] or math.isnan(field["start"]) or field["start"] == 0:
            continue
        assert field["low"] <= field["start"] <= field["high"], name


def test_the_default_config_is_the_listed_one() -> None:
    numbers = _core.config_numbers({})
    assert list(numbers) == list(_core.CONFIG_FIELDS)
    for name, field in _core.CONFIG_FIELDS.items():
        start = field["start"]
        if field["role"] == "choice":
            start = _core.CHOICES[field["type"].removeprefix("rp_")].index(start)
        # as texts: NaN, what is left out, is no number equal to itself
        assert str(numbers[name]) == str([start] * math.prod(field["shape"])), name


@pytest.mark.parametrize(
    "fields", [_core.CONFIG_FIELDS, _core.INPUT_FIELDS, *_core.QUANTITIES.values()]
)
def test_every_number_has_a_unit_and_a_text(fields: dict[str, dict[str, Any]]) -> None:
    for name, field in fields.items():
        assert field["text"], name
        assert (field["unit"] == "") == (field["role"] in ("choice", "side", "status")), name
