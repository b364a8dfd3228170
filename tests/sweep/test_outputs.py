"""Names of outputs: numbers of results, statistics, and what is refused."""

from __future__ import annotations

import numpy as np
import pytest
from railpatch import CaseError
from railpatch.log import Run
from railpatch.log.reader import Series
from railpatch.sweep.outputs import default_names, value_of

RESULT = {
    "status": "converged",
    "force": [1.0, -2.0, 3.0],
    "energy": None,
    "left": {"z": 0.5, "patches": [{"p": 4.0, "angle": -7.0}, {"p": 9.0, "angle": 1.0}]},
    "wall_time": 3.0,
}


def run_log() -> Run:
    """A log of three messages."""
    times = np.array([0.0, 1.0, 2.0])
    rows = [{"z": z, "force": [1.0, z]} for z in (3.0, None, -4.0)]
    return Run(None, {"/wheel": Series(times, rows)}, {}, {}, {})  # type: ignore[arg-type]


@pytest.mark.parametrize(
    ("name", "value"),
    [
        ("force[1]", -2.0),
        ("energy", None),
        ("left.z", 0.5),
        ("left.patches[1].p", 9.0),
        ("left.patches[2].p", None),  # there are two
        ("max(left.patches.p)", 9.0),
        ("absmax(left.patches.angle)", 7.0),
        ("mean(force)", 2 / 3),
        ("rms(force)", np.sqrt(14 / 3)),
        ("status", "converged"),
    ],
)
def test_values_of_a_result(name: str, value: object) -> None:
    """By path, and by statistics of several."""
    found = value_of(name, RESULT, None)
    assert found == (pytest.approx(value) if isinstance(value, float) else value)


@pytest.mark.parametrize(
    ("name", "value"),
    [
        ("max(/wheel.z)", 3.0),
        ("last(/wheel.z)", -4.0),
        ("mean(/wheel.z)", -0.5),
        ("absmax(/wheel.force[1])", 4.0),
        ("sum(/wheel.force[0])", 3.0),
    ],
)
def test_values_of_a_run(name: str, value: float) -> None:
    """Statistics of a channel's field; what is absent at a time does not count."""
    assert value_of(name, {}, run_log()) == value


@pytest.mark.parametrize(
    ("name", "told"),
    [
        ("fores[1]", "'fores' is none of status, force"),
        ("fores[1]", "; did you mean 'force'?"),
        ("fores[1]", "; of its log as max(/wheel.FIELD): /wheel"),
        ("left.patches.angel", "'angel' is none of p, angle; did you mean 'angle'?"),
        ("max(/weel.z)", "; did you mean '/wheel'?"),
        ("max(/wheel.forse)", "; did you mean 'force'?"),
        ("force", "has 3 values, allowed one of them by [0] or one of min, max"),
        ("left", "allowed one of it: z, patches"),
        ("left.patches.q", "'q' is none of p, angle"),
        ("force[x]", "allowed [0], [1]"),
        ("max(status)", "allowed of numbers, not of texts"),
        ("/wheel.z", "allowed with one of min, max"),
        ("max(/wheel.y)", "no field 'y'"),
        ("max(/wheel)", "no field is named"),
        ("max(/weel.z)", "no channel '/weel'"),
        ("max(/wheel.force)", "has 2 values at a time"),
    ],
)
def test_wrong_names_are_refused(name: str, told: str) -> None:
    """With what there is."""
    with pytest.raises(CaseError) as error:
        value_of(name, RESULT, run_log())
    assert told in str(error.value)


def test_channels_are_of_runs_alone() -> None:
    """One contact has none."""
    with pytest.raises(CaseError, match="this scene is no run with channels"):
        value_of("max(/wheel.z)", RESULT, None)


def test_left_out_outputs_are_numbers_outside_patches() -> None:
    """Without times, texts and what is not a number."""
    assert default_names(RESULT) == ["force[0]", "force[1]", "force[2]", "left.z"]
