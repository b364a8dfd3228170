"""Summaries of short runs: what they are too short for in words, small works with digits."""

from __future__ import annotations

import math

import pytest
from railpatch.log.waves import Waves

from wheelset_demo.summary import waves_in_words
from wheelset_demo.vehicle.trace import works

NAN = math.nan


def test_waves() -> None:
    whole = Waves(18.25, 3, 3e-3, 2.9e-3, 0.0251, 0.46, 0.75, 23.31)
    assert waves_in_words(whole, 60.0) == [
        ("wave length", "18.250 m, mean of 3 half waves"),
        ("Klingel", "23.310 m with conicity 0.02510 found in the run"),
        ("amplitude", "3.000 mm at first, 2.900 mm at last"),
    ]
    short = Waves(NAN, 0, 3e-3, NAN, 0.0251, 0.46, 0.75, 23.31)
    (length, klingel, amplitude) = (text for _, text in waves_in_words(short, 2.0))
    assert length == "none in 2.00 m: y crosses the middle less than twice"
    assert klingel == "23.310 m with conicity 0.02510 found in the run"
    assert amplitude == "3.000 mm at first, no half wave after that"
    backwards = Waves(NAN, 0, 3e-3, NAN, -0.01, 0.46, 0.75, NAN)
    assert waves_in_words(backwards, 2.0)[1][1] == "none with conicity -0.01000 found in the run"
    nothing = Waves(NAN, 0, NAN, NAN, NAN, NAN, NAN, NAN)
    assert not any("nan" in text for _, text in waves_in_words(nothing, 0.0))


@pytest.mark.parametrize(
    ("values", "text"),
    [
        ((0.456, 0.1), "0.456 0.100 J"),
        ((3.21, -0.001), "3.21 0.00 J"),
        ((4321.0, 12.3), "4.32 0.01 kJ"),
        ((1.2345e6, 4e5), "1234 400 kJ"),
        ((0.0, 0.0), "0 0 J"),
    ],
)
def test_works(values: tuple[float, ...], text: str) -> None:
    assert works(values) == text
