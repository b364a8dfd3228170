"""A paste of oxide that dries on its wheel (docs/fluids.md): of its water w = exp(-X) is left,
X = t/T + W/W_d; its solids are c/(c + (1 - c) w) of the volume until they are packed, 0.64; then it
covers w/w_p of the surfaces, and friction is w/w_p mu(that paste) + (1 - w/w_p) mu_dry.
What a paste of any content gives is solved as one that stays.
"""

from __future__ import annotations

import math
import re
from typing import Any

import pytest
import railpatch
from case_samples import WHEELSET, with_values
from railpatch.case import CaseError

CONTENT, PACKED, DRY, STEP = 0.2, 0.64, 0.5, 0.25
# of the water, where solids are packed: that of a volume of 0.64 solids over that of 0.2
LEFT = (0.2 * 0.36 / 0.64) / 0.8
FILM = {"model": "film", "roughness": 2e-6, "boundary_friction": 0.15, "liquid": "water"}
FILM |= {"temperature": 20.0}
SIDES = ("left", "right")


def scene(content: float = CONTENT, drying: dict[str, float] | None = None, **values: Any) -> Any:
    oxide: dict[str, Any] = {"solid_content": content}
    if drying is not None:
        oxide["drying"] = drying
    usual: dict[str, Any] = {
        "friction": {"coefficient": DRY},
        "fluid": {**FILM, "oxide": oxide},
        "method": {"normal": "hertz", "tangential": "fastsim"},
        "wheelset__z": 0.000241,  # of some 60 kN a wheel
        "wheelset__speed": 10.0,
        "wheelset__pitch_rate": -22.4,
    }
    return with_values(WHEELSET, **{**usual, **values})


def stays(water: float, **values: Any) -> Any:
    """The wheels with a paste that has dried so far and dries no further."""
    content = min(CONTENT / (CONTENT + (1 - CONTENT) * water), PACKED)
    return railpatch.Contact(scene(content, **values)).step()


def friction(result: Any, side: str = "right") -> float:
    return float(result[side]["patches"][0]["effective_friction"])


def test_by_time() -> None:
    """Thicker first, then dry."""
    time = 0.5
    of = railpatch.Contact(scene(drying={"time": time}))
    found, passed = [], 0.0
    for step in (0.0, 0.1, 0.5, 1.0, 2.0):
        result = of.step(time_step=step)
        passed += step
        water = math.exp(-passed / time)
        paste = stays(water)
        for side in SIDES:
            assert result[side]["oxide_water"] == pytest.approx(water, rel=1e-12)
            part = min(water / LEFT, 1.0)
            expected = part * friction(paste, side) + (1 - part) * DRY
            assert friction(result, side) == pytest.approx(expected, rel=1e-9), (passed, side)
        found.append(friction(result))
    assert found[0] > found[1] > found[2]
    assert found[2] < found[3] < found[4]
    assert found[4] > 0.95 * DRY


def test_by_work() -> None:
    """Each metre of the circumference takes the friction's work once a turn."""
    work = 4e3
    of = railpatch.Contact(scene(drying={"time": 9.0, "work": work}, wheelset__time_step=STEP))
    dryness = dict.fromkeys(SIDES, 0.0)
    rate = dict.fromkeys(SIDES, 0.0)
    saved = None
    for step in range(8):
        result = of.step()
        for side in SIDES:
            dryness[side] += (1 / 9.0 + rate[side]) * STEP
            wheel = result[side]
            water = math.exp(-dryness[side])
            assert wheel["oxide_water"] == pytest.approx(water, rel=1e-9), (step, side)
            around = 2 * math.pi * wheel["rolling_radius"]
            rate[side] = wheel["friction_power"] / around / work
        if step == 4:
            saved = of.save()
    assert max(rate.values()) > 0.05
    last = result.to_dict()
    of.restore(saved)
    for _ in range(3):
        again = of.step().to_dict()
    for key in ("force", "friction_power"):
        assert again[key] == last[key]
    of.reset()
    assert of.step()["right"]["oxide_water"] == pytest.approx(math.exp(-STEP / 9.0), rel=1e-12)


def test_without_time_the_same_bits() -> None:
    still = railpatch.Contact(scene()).step().to_dict()
    dries = railpatch.Contact(scene(drying={"time": 1.0, "work": 1e3})).step().to_dict()
    assert dries["force"] == still["force"]
    for side in SIDES:
        assert dries[side]["patches"] == still[side]["patches"]
        assert dries[side]["oxide_water"] == 1.0
        assert still[side]["oxide_water"] is None


def test_dried_out_is_dry() -> None:
    values = {"wheelset__time_step": 100.0}
    found = railpatch.Contact(scene(drying={"time": 1.0}, **values)).step()
    dry = railpatch.Contact(scene(fluid=None)).step()
    for side in SIDES:
        assert found[side]["force"] == pytest.approx(dry[side]["force"], rel=1e-12)


def test_of_the_full_theory() -> None:
    """The balance of power holds with what is left."""
    method = {"normal": "half_space", "tangential": "full"}
    values = {"method": method, "wheelset__time_step": 3.0}
    result = railpatch.Contact(scene(drying={"time": 1.0}, **values)).step()
    water = math.exp(-3.0)
    paste, part = friction(stays(water, method=method)), water / LEFT
    assert friction(result) == pytest.approx(part * paste + (1 - part) * DRY, rel=1e-9)
    for side in SIDES:
        power = result[side]
        assert power["friction_power"] == pytest.approx(power["creep_power"], rel=1e-5)


@pytest.mark.parametrize(
    ("changes", "named"),
    [
        ({"drying": {}}, "fluid.oxide.drying.time: value is missing"),
        ({"content": PACKED, "drying": {"time": 1.0}}, "fluid.oxide.solid_content"),
        ({"drying": {"time": 0.0}}, "fluid.oxide.drying.time"),
        ({"drying": {"work": -1.0}}, "fluid.oxide.drying.work"),
        ({"drying": {"time": 1.0}, "friction": None}, "friction"),
        (
            {
                "drying": {"time": 1.0},
                "fluid": {
                    **{key: value for key, value in FILM.items() if key != "model"},
                    **{"model": "strip", "oxide": {"solid_content": 0.3, "drying": {"time": 1.0}}},
                },
            },
            "fluid.oxide.drying: value is given, allowed none: it must be left out with model",
        ),
    ],
)
def test_refusals(changes: dict[str, Any], named: str) -> None:
    with pytest.raises(CaseError, match=re.escape(named)):
        railpatch.Contact(scene(**changes))


def test_patches_do_not_dry() -> None:
    case = {
        "kind": "patch",
        "geometry": {"semi_axes": [6e-3, 6e-3]},
        "load": {"normal_force": 1e5},
        "friction": {"coefficient": DRY},
        "motion": {"creepage": [1e-3, 0.0], "rolling_speed": 5.0},
        "method": {"normal": "hertz", "tangential": "fastsim"},
        "grid": {"elements": [12, 12]},
        "fluid": {**FILM, "oxide": {"solid_content": 0.3, "drying": {"time": 1.0}}},
    }
    with pytest.raises(CaseError, match=r"fluid\.oxide\.drying: value is given"):
        railpatch.Contact(case)
