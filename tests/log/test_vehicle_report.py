"""The report of a vehicle's log: what it shows, from a made-up run."""

from __future__ import annotations

import re
import time

import numpy as np
import pytest
import synthetic_vehicle as vehicle
from railpatch.log import read_run
from railpatch.log.stream import FLUSH_INTERVAL
from railpatch.report import write_report
from railpatch.report.vehicle.data import snapshot, vehicle_run
from railpatch.report.vehicle.figures import friction, positions, ratios


@pytest.fixture(scope="module")
def path(tmp_path_factory):
    return vehicle.write_run(tmp_path_factory.mktemp("log") / "vehicle.mcap")


@pytest.fixture(scope="module")
def data(path):
    return vehicle_run(read_run(path))


def _text(page) -> str:
    text = re.sub(r"<(script|style).*?</\1>", "", page.read_text(encoding="utf-8"), flags=re.S)
    return re.sub(r"<[^>]+>", " ", text)


def test_page_needs_no_network_and_has_every_part(path, tmp_path):
    page = write_report(path, tmp_path / "report.html").read_text(encoding="utf-8")
    assert not re.search(r"<(script|link|img|iframe)[^>]*(src|href)=", page)
    for name in ("track", "loads", "ratios", "positions", "accelerations", "friction"):
        assert page.count(f'id="{name}"') == 1, name
    for name in ("energy", "work", "patch-1"):
        assert page.count(f'id="{name}"') == 1, name
    text = _text(tmp_path / "report.html")
    assert "101 logged, of which 101 converged" in text
    assert "/wheelset/4/right/contact" in text
    assert "did not converge" not in text
    assert "% of the wall time" in text


def test_guiding_forces_are_outward_and_on_the_rail(data):
    """On the wheels the lateral force is to the right, so on the rails to the left."""
    for number in range(1, 5):
        assert (data.guiding[number, "left"] > 0).all()
        assert (data.guiding[number, "right"] < 0).all()
        for side, sign in (("left", 1.0), ("right", -1.0)):
            # a tenth of the load, on straight track and in the circle
            assert data.ratio((number, side)) == pytest.approx(np.full(101, 0.1 * sign))


def test_loads_move_to_the_outside(data):
    start, end = data.loads[1, "left"][0], data.loads[1, "left"][-1]
    assert (start, end) == (vehicle.LOAD, vehicle.LOAD + 8e3)
    assert data.loads[1, "right"][-1] == vehicle.LOAD - 8e3
    # steps are 0.4 m apart
    assert data.width == 5
    assert "averaged over 2 m of way (5 logged steps)" in data.averaging


def test_steps_far_apart_are_not_averaged(tmp_path):
    path = tmp_path / "run.mcap"
    with vehicle.open_log(path) as log:
        for index in range(0, 20, 4):  # 1.6 m
            log.write(0.01 * index, **vehicle.step(index))
    data = vehicle_run(read_run(path))
    assert data.width == 1
    wheel = 1, "left"
    assert list(data.mean_loads[wheel]) == list(data.loads[wheel])
    write_report(path, tmp_path / "page.html")
    assert "too far apart to average" in _text(tmp_path / "page.html")


def test_figures_show_every_wheelset_over_the_distance(data):
    for figure in (ratios(data), friction(data)):
        assert [trace.name for trace in figure.data] == [f"wheelset {n}" for n in (1, 2, 3, 4)] * 2
    lines = positions(data).data
    third = lines[2]
    assert third.x == pytest.approx(0.4 * np.arange(101))
    expected = [1e3 * vehicle.lateral(0.4 * i + vehicle.AHEAD[2], 3) for i in range(101)]
    assert third.y == pytest.approx(expected)


def test_snapshots(data):
    assert snapshot(data, 2, None) is None
    assert snapshot(data, 1, 12.1)["index"] == 30
    # by default where the guiding force is greatest: in the circle
    assert data.wheelsets[1]["curvature"][snapshot(data, 1, None)["index"]] > 0


def test_steps_that_did_not_converge_are_marked(tmp_path):
    path = tmp_path / "run.mcap"
    with vehicle.open_log(path) as log:
        for index in range(5):
            step = vehicle.step(index)
            if index == 3:
                step["wheelsets"][2]["right"]["status"] = "not_converged"
            log.write(0.01 * index, **step)
        log.close("contact failed")
    data = vehicle_run(read_run(path))
    assert list(data.solved) == [True, True, True, False, True]
    marks = [t for t in ratios(data).data if t.name == "not converged"]
    assert marks
    assert all(list(t.text) == ["position 3"] for t in marks)
    write_report(path, tmp_path / "page.html")
    text = _text(tmp_path / "page.html")
    assert "1 of 5 steps did not converge" in text
    assert "stopped before its end" in text


def test_cut_off_log(tmp_path):
    path = tmp_path / "run.mcap"
    with vehicle.open_log(path) as log:
        for index in range(20):
            log.write(0.01 * index, **vehicle.step(index))
            if index == 10:
                # longer than the log waits before it flushes
                time.sleep(2 * FLUSH_INTERVAL)
    content = path.read_bytes()
    path.write_bytes(content[: content.rindex(b"zstd") + 200])
    run = read_run(path)
    assert run.truncated
    assert vehicle_run(run).count >= 11
    write_report(path, tmp_path / "page.html")
    assert "This log is cut off:" in _text(tmp_path / "page.html")


def test_without_bodies_energies_and_times(tmp_path):
    path = tmp_path / "run.mcap"
    with vehicle.open_log(path, geometry=None) as log:
        for index in range(3):
            step = vehicle.step(index)
            for name in ("energy", "stats"):
                del step[name]
            step["bodies"] = []
            log.write(0.01 * index, **step)
    page = write_report(path, tmp_path / "page.html").read_text(encoding="utf-8")
    for name in ("energy", "work", "accelerations"):
        assert f'id="{name}"' not in page
    assert 'id="ratios"' in page
