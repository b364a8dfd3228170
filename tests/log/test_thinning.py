"""What is logged how often, and that the quick way to encode gives what the close one gives."""

from __future__ import annotations

import random

import numpy as np
import pytest
import synthetic
from railpatch.log import read_run
from railpatch.log.channels import (
    ALL_CHANNELS,
    PATCH,
    WHEEL_CONTACT,
    WHEELSET_STATE,
    Message,
)
from railpatch.log.encode import encode, encode_closely
from railpatch.log.quick import quick
from railpatch.log.stream import Pace


@pytest.mark.parametrize(
    ("rate", "step", "count", "expected"),
    [
        (30.0, 1e-3, 1001, 31),
        (60.0, 1e-3, 1001, 61),
        (100.0, 1e-2, 101, 101),  # every step, whichever way its time was rounded
        (30.0, 0.25, 9, 9),  # no more than there are
        (0.0, 1e-3, 100, 0),
    ],
)
def test_scenes_go_by_simulation_time(rate, step, count, expected):
    pace = Pace(rate)
    shown = [index for index in range(count) if pace.due(index * step)]
    assert len(shown) == expected
    if rate and expected > 1:
        gaps = np.diff(shown) * step
        assert gaps.max() < max(1 / rate, step) + step


@pytest.mark.parametrize("rate", [-1.0, float("nan"), float("inf"), "30", True])
def test_bad_rate(tmp_path, rate):
    with pytest.raises(ValueError, match="scene_rate is"):
        synthetic.open_log(tmp_path / "run.mcap", scene_rate=rate)
    assert not (tmp_path / "run.mcap").exists()


def test_scenes_of_a_log(tmp_path):
    counts = {}
    for rate in (0, 10, 30, 1000):
        path = tmp_path / f"{rate}.mcap"
        synthetic.write_wheelset_run(path, steps=101, scene_rate=rate)
        run = read_run(path)
        assert len(run["/wheelset/state"]) == len(run["/left/contact"]) == 101
        counts[rate] = run.counts.get("/tf", 0)
        assert run.counts.get("/scene/contact", 0) == counts[rate]
    # steps are 10 ms apart
    assert counts == {0: 0, 10: 11, 30: 31, 1000: 101}


def test_the_log_tells_what_it_took(tmp_path):
    with synthetic.open_log(tmp_path / "run.mcap") as log:
        synthetic.write_position(log, 0)
        assert 0 < log.share < 1
    end = read_run(tmp_path / "run.mcap").metadata["railpatch.end"]
    assert 0 < float(end["logging_time"]) <= float(end["wall_time"])


def _values(message: Message, rng: random.Random, present: float) -> dict:
    """A dict of a message with random values, some of them None or left out."""
    values = {}
    for field in message.fields:
        if not field.required and rng.random() > present:
            if rng.random() < 0.5:
                values[field.name] = None
            continue
        values[field.name] = _value(field, rng, present)
    return values


def _value(field, rng, present):
    size = rng.randint(0, 3) if field.size == 0 else field.size
    if isinstance(field.kind, Message):
        items = [_values(field.kind, rng, present) for _ in range(size)]
    elif field.kind == "string":
        items = [rng.choice(field.choices or ("text",))]
    elif field.kind == "uint32":
        items = [rng.randrange(2**32) for _ in range(size)]
    else:
        items = [rng.choice((rng.uniform(-1e9, 1e9), 0.0, -0.0, 7, 1e300)) for _ in range(size)]
    return items[0] if field.size == 1 else items


@pytest.mark.parametrize("present", [0.2, 0.7, 1.0])
def test_quick_and_close_encoding_are_equal(present):
    rng = random.Random(7)
    quickly = 0
    messages = list(dict.fromkeys(entry.message for entry in ALL_CHANNELS))
    for _ in range(40):
        for message in messages:
            values = _values(message, rng, present)
            one, two = encode(message, values, "t"), encode_closely(message, values, "t")
            assert one == two, (message.name, values)
            assert one.SerializeToString() == two.SerializeToString()
            quickly += quick(message, values) is not None
    # the comparison would be one of the close way with itself
    assert quickly > 30 * len(messages)


@pytest.mark.parametrize(
    ("message", "change"),
    [
        (WHEELSET_STATE, {"y": float("nan")}),
        (WHEELSET_STATE, {"y": float("inf")}),
        (WHEELSET_STATE, {"y": True}),
        (WHEELSET_STATE, {"y": "1"}),
        (WHEELSET_STATE, {"y": [1.0]}),
        (WHEELSET_STATE, {"y": None}),
        (WHEELSET_STATE, {"other": None}),
        (WHEELSET_STATE, {"force": [1.0, 2.0]}),
        (WHEELSET_STATE, {"force": [1.0, 2.0, float("-inf")]}),
        (WHEELSET_STATE, {"force": "abc"}),
        (WHEEL_CONTACT, {"status": "fine"}),
        (WHEEL_CONTACT, {"status": 1}),
        (WHEEL_CONTACT, {"patches": [1]}),
        (WHEEL_CONTACT, {"patches": [{"status": "converged", "iterations": -1}]}),
        (WHEEL_CONTACT, {"patches": [{"status": "converged", "iterations": 2**32}]}),
        (WHEEL_CONTACT, {"patches": [{"status": "converged", "iterations": True}]}),
        (WHEEL_CONTACT, {"patches": [{"status": "converged", "elements": {"slip": 0.5}}]}),
        (WHEEL_CONTACT, {"patches": [{}]}),
        (PATCH, {"creepage": [True, 0.0]}),
    ],
)
def test_what_is_wrong_is_left_to_the_close_way(message, change):
    good = {"status": "converged"} if message is not WHEELSET_STATE else synthetic.state(0)
    assert quick(message, good) is not None
    assert quick(message, good | change) is None
    with pytest.raises(ValueError, match="t: "):
        encode(message, good | change, "t")
