"""Contact.step(): numbers that change in the core alone, results read as they are asked for."""

from __future__ import annotations

import inspect
import math
import pickle
import threading
from typing import Any

import numpy as np
import pytest
import railpatch
from case_samples import PATCH, WHEELSET, with_values
from patch_cases import patch_case
from railpatch import CaseError, Contact
from railpatch.case.keys_of_step import Moving
from railpatch.case.load import check_case
from railpatch.case.moving import moving_keys
from railpatch.case.to_core import plain_moves

FAST = {"method__normal": "hertz", "method__tangential": "fastsim"}
LOADED = with_values(WHEELSET, **FAST, wheelset__z=None, wheelset__vertical_force=1.6e5)
ON_RAIL = with_values(LOADED, kind="wheel_rail", wheelset__vertical_force=8e4)
ON_ROLLER = with_values(
    LOADED,
    track={"kind": "roller", "gauge": 1.435, "gauge_height": 0.014, "roller_radius": 0.5},
)
CASES = {
    "patch": with_values(PATCH, **FAST),
    "approach": with_values(PATCH, **FAST, load={"approach": 5e-5}),
    "normal alone": with_values(PATCH, motion=None, friction=None),
    "force": with_values(
        PATCH, motion={"tangential_force": [-1e4, "creepage"], "rolling_speed": 10.0}
    ),
    "slip by element": with_values(
        PATCH,
        geometry={
            "undeformed_distance": [[2e-5, 1e-5, 2e-5], [1e-5, 0.0, 1e-5], [2e-5, 1e-5, 2e-5]]
        },
        grid={"element_size": [1e-3, 1e-3]},
        motion={"slip_field": [[[1e-4] * 3] * 3, [[0.0] * 3] * 3], "rolling_speed": 10.0},
    ),
    "shift": with_values(PATCH, motion={"regime": "shift", "creepage": [1e-5, 0.0]}),
    "wheel": ON_RAIL,
    "liquid": with_values(
        PATCH,
        **FAST,
        fluid={"model": "film", "roughness": 1e-6, "liquid": "water", "water_rate": 1e-7},
    ),
    "regimes": with_values(
        PATCH,
        friction=None,
        method={"normal": "hertz", "tangential": "polach"},
        fluid={"model": "regimes", "water_rate": 1e-7, "recovery": {"coefficient": 1e-3}},
    ),
    "oil on wheels": with_values(
        ON_RAIL,
        fluid={"model": "film", "roughness": 1e-6, "liquid": "oil", "viscosity": 0.1},
    ),
    "wheelset": LOADED,
    "height": with_values(WHEELSET, **FAST, wheelset__z=3e-4),
    "rollers": ON_ROLLER,
}
# beside numbers that mean something: what the tables refuse or take in another form
ODD = [
    *(math.nan, math.inf, -1e300, 10**400, -1.0, 0.0, 0, 3, True, "1", None, [], {}),
    *([1e-3], [1e-3, "0"], [1e-3, math.nan], [1e-3, True], [[1e-3, 0.0]], (1e-3, 0), "ab"),
    *(np.float64(1e-3), np.float32(1e-3), np.int64(2), np.array([1e-3, 2e-3]), np.array(1e-3)),
    *(np.array([1, 2]), np.array([[1e-3, 0.0]]), {"creepage": 1.0}, 2.0, 1e4, -3e-3),
]


def outcome(contact: Contact, **changes: Any) -> Any:
    """What a step says: all numbers but its time, and the case after it; or the error."""
    try:
        data = contact.step(**changes).to_dict()
    except CaseError as error:
        return str(error)
    data.pop("wall_time")
    return data, contact.case


@pytest.mark.parametrize("name", CASES)
def test_the_same_as_by_the_tables(name: str) -> None:
    """Each key with plain and odd values: the same result, case and error as when the whole table
    is checked, as the first step does it; a refused change changes nothing."""
    short, checked = Contact(CASES[name]), Contact(CASES[name])
    first = outcome(short), outcome(checked)
    assert first[0] == first[1]
    assert not isinstance(first[0], str)
    refused = 0
    for key in moving_keys(short.case):
        for value in ODD:
            checked._goes_on = False
            found, wanted = outcome(short, **{key: value}), outcome(checked, **{key: value})
            assert repr(found) == repr(wanted), (key, value)
            refused += isinstance(found, str)
    assert refused > 10


def test_which_steps_are_short() -> None:
    """Numbers of their own are; words, tables and what counts with others are not."""
    moves = {name: set(plain_moves(check_case(case))) for name, case in CASES.items()}
    assert moves["patch"] == {
        *("normal_force", "creepage", "spin_creepage", "rolling_speed", "friction_scale"),
    }
    assert "approach" in moves["approach"]
    assert moves["force"] == {"normal_force"}
    assert {"y", "vertical_force", "pitch_rate"} <= moves["wheel"]
    assert not {"left", "right", "track"} & moves["wheel"]
    assert "roller_pitch_rate" in moves["rollers"]
    free = check_case(with_values(WHEELSET, wheelset__pitch_rate="free"))
    assert "pitch_rate" not in plain_moves(free)


def test_a_list_given_may_change_afterwards() -> None:
    """The case keeps the numbers of the step."""
    contact, pair = Contact(CASES["patch"]), np.array([1e-3, 0.0])
    contact.step()
    contact.step(creepage=pair)
    pair[0] = 5.0
    assert contact.case.motion.creepage == [1e-3, 0.0]


@pytest.mark.parametrize("name", CASES)
def test_one_quantity_is_that_of_all(name: str) -> None:
    """Read alone, and among all others; also after the next step, pickled, and no others."""
    contact = Contact(CASES[name])
    contact.step()
    alone, whole = contact.last(), contact.last().data
    contact.step()
    for key, value in whole.items():
        assert repr(alone[key]) == repr(value), key
    assert alone.status == whole["status"]
    assert alone.warnings == whole["warnings"]
    kept = pickle.loads(pickle.dumps(contact.last()))
    assert repr(kept.data) == repr(contact.last().data)
    for result in (contact.last(), kept):
        with pytest.raises(KeyError, match="creep"):
            result["creep"]
    assert "status" in alone
    assert alone.keys() == list(whole)


def test_a_result_is_a_mapping() -> None:
    result = Contact(CASES["patch"]).step()
    assert list(result) == result.keys() == list(dict(result))
    assert len(result) == len(result.data)
    assert result.get("approach") == result["approach"]
    assert result.get("no such quantity") is None
    assert dict(result.items()) == result.data
    other = pickle.loads(pickle.dumps(result))
    assert result != other
    assert len({result, other}) == 2


def test_every_moving_key_has_a_type() -> None:
    """Those of all kinds stand in the signature that editors and notebooks complete from."""
    moving = {key for case in CASES.values() for key in moving_keys(check_case(case))}
    moving |= {"tangential_force", "distance", "steps", "temperature", "regime"}
    moving |= {"axle_torque", "longitudinal_force"}
    assert moving == set(Moving.__annotations__)
    keys = set(inspect.signature(Contact.step).parameters)
    assert keys == {"self", "fields", *moving}


def test_a_contact_that_steps_may_be_asked() -> None:
    """Another thread waits for its turn, without the lock that the step asks signals with."""
    case = patch_case({"semi_axes": [6e-3, 6e-3]}, force=1e5, elements=220, creepage=(2e-3, 1e-3))
    contact = Contact(case)
    steps = threading.Thread(target=contact.step, daemon=True)
    steps.start()
    while steps.is_alive():
        contact.stages()
        contact.save()
    steps.join(timeout=60)
    assert contact.last().good


def test_results_plot_themselves() -> None:
    """Each patch in contact is a column; without fields it says what to ask for."""
    wheels = railpatch.solve(CASES["wheelset"] | {"method": {}}, fields=True)
    figure = wheels.plot()
    titles = {note.text for note in figure.layout.annotations}
    assert {"left patch 1: pressure", "right patch 1: division"} <= titles
    patch = railpatch.solve(PATCH, fields=True)
    shown = patch.plot()
    heat = next(trace for trace in shown.data if trace.type == "heatmap")
    np.testing.assert_allclose(np.nanmax(heat.z), 1e-6 * patch["pressure"].max())
    with pytest.raises(CaseError, match="fields=True"):
        railpatch.solve(PATCH).plot()
    apart = with_values(PATCH, load={"approach": -1e-5})
    apart["geometry"] = {"curvatures": [2.0, 2.0]}
    with pytest.raises(CaseError, match="no contact"):
        railpatch.solve(apart, fields=True).plot()


def test_states_plot_themselves() -> None:
    """A quantity's numbers over the states, another quantity or an array."""
    force = np.array([1e4, 2e4, 4e4])
    states = railpatch.solve_many(CASES["patch"], {"normal_force": force})
    figure = states.plot("creep_force", over=force)
    assert [trace.name for trace in figure.data] == ["creep_force[0]", "creep_force[1]"]
    np.testing.assert_array_equal(figure.data[0].x, force)
    np.testing.assert_array_equal(figure.data[0].y, states["creep_force"][:, 0])
    assert figure.layout.yaxis.title.text == "creep_force [N]"
    np.testing.assert_array_equal(states.plot("approach").data[0].x, [0, 1, 2])
    assert states.plot("approach", over="max_pressure").layout.xaxis.title.text == "max_pressure"
    for name, over in (("status", None), ("approach", force[:2])):
        with pytest.raises(ValueError, match="plot: "):
            states.plot(name, over)
