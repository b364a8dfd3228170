"""Timed steps of the binding: the same numbers as single steps, and honest refusals."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from railpatch import CaseError, Contact, _core
from railpatch.case.load import load_scene
from railpatch.case.to_core import config_of

CASE: dict[str, Any] = {
    "kind": "patch",
    "geometry": {"semi_axes": [0.006, 0.006]},
    "load": {"normal_force": 1.0e5},
    "grid": {"elements": [12, 12]},
    "motion": {"creepage": [1e-3, 0.0], "rolling_speed": 10.0},
    "friction": {"coefficient": 0.3},
}
CREEPAGES = ([1e-3, 0.0], [1.01e-3, 2e-4], [2e-3, -1e-3])


def inputs() -> list[dict[str, Any]]:
    return [{"normal_force": 1e5, "creepage": c, "rolling_speed": 10.0} for c in CREEPAGES]


def timed_contact() -> Any:
    return _core.Contact(config_of(load_scene(CASE)), False)


@pytest.mark.parametrize("cold", [False, True])
def test_same_bits_as_single_steps(cold: bool) -> None:
    contact = Contact(CASE)
    wanted = []
    for creepage in CREEPAGES:
        if cold:
            contact.reset()
        wanted.append(contact.step(creepage=creepage)["creep_force"])
    seconds, results = timed_contact().time_steps(inputs(), [cold] * 3, 1)
    found = [result["right"]["patches"][0]["creep_force"] for result in results]
    assert found == wanted
    assert seconds.shape == (1, 3)
    assert (seconds > 0).all()


def test_repeated_passes_start_alike() -> None:
    once = timed_contact().time_steps(inputs(), [True, False, False], 1)
    often = timed_contact().time_steps(inputs(), [True, False, False], 4)
    assert often[0].shape == (4, 3)
    assert str(once[1]) == str(often[1])  # as texts: nan is not equal to itself


def test_wrong_calls() -> None:
    contact = timed_contact()
    with pytest.raises(ValueError, match="reset"):
        contact.time_steps(inputs(), [True], 1)
    with pytest.raises(ValueError, match="repeat"):
        contact.time_steps(inputs(), [True] * 3, 0)
    with pytest.raises(KeyError):
        contact.time_steps([{"creepag": [0.0, 0.0]}], [True], 1)
    with pytest.raises(CaseError, match="normal_force"):
        contact.time_steps([{"normal_force": -1.0}], [True], 1)


def test_time_of_the_transform() -> None:
    seconds = _core.time_fft(64, 200)
    assert seconds.shape == (200,)
    assert (seconds > 0).all()
    # ten times the numbers cannot take less than twice the time
    assert np.median(_core.time_fft(200, 50)) > 2 * np.median(seconds)
    with pytest.raises(ValueError, match="size"):
        _core.time_fft(1, 10)
    with pytest.raises(ValueError, match="repeat"):
        _core.time_fft(64, 0)
