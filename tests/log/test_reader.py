"""read_run gives back what was written, as arrays."""

from __future__ import annotations

import numpy as np
import pytest
import synthetic
from railpatch.log import read_run


@pytest.fixture(scope="module")
def run(tmp_path_factory):
    return read_run(synthetic.write_rig_run(tmp_path_factory.mktemp("log") / "rig.mcap", bad=8))


def test_numbers(run):
    state = run["/wheelset/state"]
    assert len(state) == 37
    assert not run.truncated
    assert run.stopped_by == ""
    assert state.time == pytest.approx(np.arange(37.0))
    assert list(state["yaw"]) == [synthetic.yaw_at(i) for i in range(37)]
    assert np.isnan(state["roll_rate"]).all()


def test_vectors_texts_and_patches(run):
    left = run["/left/contact"]
    assert left["force"].shape == (37, 3)
    assert list(left["force"][5]) == synthetic.side("left", 5)["force"]
    second = left["patches[1].normal_force"]
    expected = [synthetic.side("left", i)["patches"] for i in range(37)]
    assert second == pytest.approx(
        [p[1]["normal_force"] if len(p) > 1 else np.nan for p in expected], nan_ok=True
    )
    assert left["patches[0].elements.stick"][3] == 200
    assert run["/rig/balance"]["status"][8] == "not_converged"


def test_absent_vectors_are_rows_of_nan(tmp_path):
    left = synthetic.side("left", 0)
    path = tmp_path / "run.mcap"
    with synthetic.open_log(path) as log:
        for time_s, force in enumerate((left["force"], None, [None] * 3)):
            log.write(
                time_s,
                state=synthetic.state(0),
                left=left | {"force": force},
                right=synthetic.side("right", 0),
            )
    force = read_run(path)["/left/contact"]["force"]
    assert list(force[0]) == left["force"]
    assert np.isnan(force[1:]).all()


def test_unknown_names(run):
    with pytest.raises(KeyError, match=r"no channel '/no/such'; this log has .*/wheelset/state"):
        run["/no/such"]
    assert len(run["/vehicle/state"]) == 0
    with pytest.raises(KeyError, match="no field 'yaww'"):
        run["/wheelset/state"]["yaww"]


def test_a_run_shows_itself_in_a_line(run):
    messages = sum(len(series) for series in run.channels.values())
    shown = f"Run({str(run.path)!r}: {len(run.channels)} channels, {messages} messages)"
    assert repr(run) == shown


def test_no_contact_is_a_result(tmp_path):
    path = tmp_path / "run.mcap"
    nothing = {
        "status": "no_contact",
        "force": [0.0, 0.0, 0.0],
        "moment": [0.0, 0.0, 0.0],
        "patches": [],
    }
    with synthetic.open_log(path, geometry=None) as log:
        log.write(
            0.0,
            state=synthetic.state(0),
            left=nothing,
            right=nothing,
            fields={"left": [], "right": []},
        )
    run = read_run(path)
    assert run["/left/contact"].messages[0]["patches"] == []
    assert run.counts == {
        "/wheelset/state": 1,
        "/left/contact": 1,
        "/right/contact": 1,
        "/tf": 1,
        "/scene/contact": 1,
    }
