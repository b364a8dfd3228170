"""The report's part on the frame and on friction that conditions."""

from __future__ import annotations

import re

import numpy as np
import pytest
from railpatch.log import read_run
from railpatch.page.tables import number
from railpatch.report import write_report
from railpatch.report.data import positions
from railpatch.report.rig_page import conditioning_figure, frame_figure, of_positions, open_energy

from rig_model.run import replay
from rig_model.scene import load_rig_scene

END = """
[rig.frame]
stiffness = 20e6
gauge_stiffness = 20e6

[rig.conditioning]
plateau = 1.3
work = 2e6
"""


@pytest.fixture
def log(scene_with, tmp_path):
    path = tmp_path / "run.mcap"
    overrides = {"positions": 3, "yaw": [[0, 0.006], [1, 0.012]], "snapshot_every": 2}
    replay(load_rig_scene(scene_with(end=END), overrides), path)
    return path


def test_the_page_has_figures_and_numbers(log):
    page = write_report(log, log.with_suffix(".html")).read_text(encoding="utf-8")
    for name in ("Frame", "Friction that conditions"):
        assert f"<h2>{name}</h2>" in page
    run = read_run(log)
    text = re.sub(r"<[^>]+>", " ", page)
    work = run["/left/conditioning"]["work"][-1]
    assert number(work) in text
    opening = 1e3 * run["/rig/frame"]["gauge_opening"].max()
    assert f"{number(opening)} mm" in text
    # linear springs and their trapezoids
    assert open_energy(run["/rig/frame"]) < 1e-9 * run["/rig/frame"]["energy"].max()


def test_what_the_figures_show(log):
    run = read_run(log)
    data = positions(run)
    frame = of_positions(data, "/rig/frame")
    wheelset = next(t for t in frame_figure(data, frame).data if t.name == "wheelset")
    np.testing.assert_allclose(np.diff(wheelset.y) / np.diff(wheelset.x), 20.0, rtol=1e-9)
    bands = {side: run[f"/{side}/conditioning"] for side in ("left", "right")}
    traces = [t for t in conditioning_figure(data, bands).data if t.name == "left"]
    np.testing.assert_array_equal(traces[0].y, bands["left"]["factor"])
    assert max(traces[1].y) == max(bands["left"].messages[-1]["conditioned"])


def test_a_rigid_rig_has_neither(scene_with, tmp_path):
    path = tmp_path / "run.mcap"
    replay(load_rig_scene(scene_with(), {"positions": 2}), path)
    page = write_report(path, tmp_path / "page.html").read_text(encoding="utf-8")
    assert "<h2>Frame</h2>" not in page
    assert "conditions</h2>" not in page
