"""Bad input: clear errors, no file, and nothing half-written."""

from __future__ import annotations

import copy
import math

import numpy as np
import pytest
import synthetic
from railpatch.log import RunFileError, SceneGeometry, read_run


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"case_name": ""}, "case_name"),
        ({"case_text": 3}, "case_text"),
        ({"profiles": {"a.prr": "text"}}, "a.prr"),
        ({"profiles": {"rig.toml": b""}}, "rig.toml"),
        ({"geometry": "roller"}, "geometry"),
    ],
)
def test_bad_arguments_make_no_file(tmp_path, change, message):
    path = tmp_path / "run.mcap"
    with pytest.raises(ValueError, match=message):
        synthetic.open_log(path, **change)
    assert not path.exists()


def test_bad_arguments_leave_an_older_file_alone(tmp_path):
    path = tmp_path / "run.mcap"
    path.write_bytes(b"older")
    with pytest.raises(ValueError, match="case_name"):
        synthetic.open_log(path, case_name="")
    assert path.read_bytes() == b"older"
    synthetic.open_log(path).close()
    assert read_run(path).counts == {"/scene/bodies": 1}


@pytest.mark.parametrize(
    ("part", "path", "value", "message"),
    [
        ("state", ["y"], math.nan, r"/wheelset/state: y is nan; it must be a finite number \[m\]"),
        ("state", ["y"], None, "/wheelset/state: y is missing"),
        ("state", ["yaww"], 0.0, "/wheelset/state: yaww is not a field; the fields are .*yaw"),
        ("state", ["z"], "0", "z is '0'"),
        ("state", ["z"], True, "z is True"),
        ("left", ["force"], [1.0, 2.0], "/left/contact: force has 2 values .* must have 3"),
        ("left", ["force"], np.array([1.0, np.inf, 0]), r"force\[1\] is inf"),
        ("left", ["force"], np.zeros((1, 3)), r"force has shape \(1, 3\)"),
        ("left", ["pressure"], [[1.0]], "pressure is not a field"),
        ("right", ["status"], "fine", "status is 'fine'; it must be one of converged, no_contact"),
        (
            "right",
            ["patches", 0, "creepage"],
            [0.0, math.nan],
            r"patches\[0\]\.creepage\[1\] is nan",
        ),
        ("right", ["patches", 0, "iterations"], 2.5, r"iterations is 2\.5; .* whole number"),
        ("right", ["patches", 0, "elements", "slip"], -1, r"elements\.slip is -1"),
        ("right", ["patches"], {}, "patches is {}; it must be a list"),
        ("balance", ["residuals"], 3.0, "residuals is 3.0; it must be a list"),
        ("stats", ["wall_time"], None, "/solver/stats: wall_time is missing"),
    ],
)
def test_bad_values_name_their_place(tmp_path, part, path, value, message):
    step = copy.deepcopy(
        {
            "state": synthetic.state(0),
            "left": synthetic.side("left", 0),
            "right": synthetic.side("right", 0),
            "balance": synthetic.balance(0),
            "stats": synthetic.stats(0),
        }
    )
    target = step[part]
    for key in path[:-1]:
        target = target[key]
    target[path[-1]] = value
    with synthetic.open_log(tmp_path / "run.mcap") as log, pytest.raises(ValueError, match=message):
        log.write(0.0, **step)
    # the step is refused as a whole
    assert read_run(tmp_path / "run.mcap").counts == {"/scene/bodies": 1}


@pytest.mark.parametrize(
    ("name", "value", "message"),
    [
        ("pressure", [1.0, 2.0], r"pressure has shape \(2,\)"),
        ("pressure", [[1.0, 2.0], [3.0]], "every row of one length"),
        ("traction", [[1.0]], r"traction has shape \(1, 1\); .* must be \(2, 20, 24\)"),
        ("element_division", np.full((20, 24), 7), "element_division holds 7"),
        ("x", None, "x is missing"),
    ],
)
def test_bad_fields_name_their_place(tmp_path, name, value, message):
    left = synthetic.side("left", 0, fields=True)
    left["patches"][0][name] = value
    fields = {"left": left["patches"]}
    with synthetic.open_log(tmp_path / "run.mcap") as log, pytest.raises(ValueError, match=message):
        log.write(0.0, state=synthetic.state(0), left=left, right=left, fields=fields)


@pytest.mark.parametrize("time_s", [math.nan, -1.0, 1e300, "0", 0.5, 1.0, True])
def test_bad_time(tmp_path, time_s):
    with synthetic.open_log(tmp_path / "run.mcap") as log:
        synthetic.write_position(log, 1)
        with pytest.raises(ValueError, match="time_s"):
            log.write(
                time_s,
                state=synthetic.state(0),
                left=synthetic.side("left", 0),
                right=synthetic.side("right", 0),
            )


def test_write_after_close(tmp_path):
    log = synthetic.open_log(tmp_path / "run.mcap")
    log.close()
    log.close()
    with pytest.raises(ValueError, match="closed"):
        synthetic.write_position(log, 0)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"kind": "road"}, "kind is 'road'"),
        ({"roller_radius": None}, "roller_radius is None"),
        ({"nominal_radius": -1.0}, "nominal_radius is -1.0"),
        ({"wheels": {"left": np.zeros((3, 2))}}, "wheels"),
        ({"rails": {"left": np.zeros(3), "right": np.zeros((3, 2))}}, "rails"),
    ],
)
def test_bad_geometry(change, message):
    good = synthetic.geometry()
    values = {
        name: getattr(good, name)
        for name in ("kind", "nominal_radius", "wheels", "rails", "roller_radius")
    }
    with pytest.raises(ValueError, match=message):
        SceneGeometry(**(values | change))


def test_files_that_are_no_run_log(tmp_path):
    text = tmp_path / "a.mcap"
    text.write_bytes(b"")
    with pytest.raises(RunFileError, match="not an MCAP file"):
        read_run(text)
    with pytest.raises(FileNotFoundError):
        read_run(tmp_path / "none.mcap")
