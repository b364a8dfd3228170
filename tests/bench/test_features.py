"""The table of what each piece of physics costs: complete and consistent. No time is asserted."""

from __future__ import annotations

import math

from railpatch.evidence.bench.features import FEATURES, feature_costs


def test_every_scene_is_solved_and_compared_with_the_plain_one() -> None:
    found = feature_costs(quick=True)
    assert [cost.name for cost in found] == [name for name, _ in FEATURES]
    plain, *others = found
    assert plain.cold_ratio == plain.warm_ratio == 1.0
    for cost in found:
        assert cost.good, cost.name
        assert cost.cold > 0
        assert cost.warm > 0
        assert math.isfinite(cost.cold_ratio * cost.warm_ratio)
    # what a scene has more than the plain one it also holds
    by_name = {cost.name: cost.bytes for cost in others}
    assert by_name["temperature"] > plain.bytes
    assert by_name["friction over temperature"] > by_name["temperature"]
    assert by_name["the same, temperature"] > by_name["the same, layer that yields"]
    assert by_name["frictionless"] < plain.bytes
