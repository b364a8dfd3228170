"""The report page: what it shows, and what it says of logs that lack something."""

from __future__ import annotations

import csv
import re

import numpy as np
import pytest
import synthetic
from click.testing import CliRunner
from railpatch.log import RunFileError, read_run
from railpatch.page.patch_figure import most_loaded, patch_figure, regular
from railpatch.report import ReportError, figures, reference, write_report
from railpatch.report.command import report
from railpatch.report.data import positions, snapshot


@pytest.fixture(scope="module")
def rig_file(tmp_path_factory):
    return synthetic.write_rig_run(tmp_path_factory.mktemp("report") / "rig.mcap")


@pytest.fixture
def rig(rig_file):
    return positions(read_run(rig_file))


def _text(path) -> str:
    """The page without scripts and tags."""
    page = re.sub(r"<(script|style).*?</\1>", "", path.read_text(encoding="utf-8"), flags=re.S)
    return re.sub(r"<[^>]+>", " ", page)


def _page(run, tmp_path, **more) -> str:
    return _text(write_report(run, tmp_path / "report.html", **more))


def _write_reference(folder, indices, offset=(10.0, -20.0, 30.0)):
    """A reference whose forces differ from the run's by ``offset``, in N on the roller."""
    folder.mkdir(exist_ok=True)
    head = [
        "side",
        "y_ws_mm",
        "z_ws_mm",
        "roll_rad",
        "yaw_rad",
        "pitch_rate_rad_s",
        "fx_on_roller_N",
        "fy_on_roller_N",
        "fz_on_roller_N",
        "patches",
    ]
    with open(folder / reference.FILE, "w", newline="") as stream:
        writer = csv.writer(stream)
        writer.writerow(head)
        for index in indices:
            state = synthetic.state(index)
            for letter, name in (("L", "left"), ("R", "right")):
                side = synthetic.side(name, index)
                force = [-f + d for f, d in zip(side["force"], offset, strict=True)]
                writer.writerow(
                    [
                        letter,
                        1e3 * state["y"],
                        1e3 * state["z"],
                        state["roll"],
                        state["yaw"],
                        state["pitch_rate"],
                        *force,
                        len(side["patches"]),
                    ]
                )
    return folder


def test_page_needs_no_network_and_has_every_part(rig_file, tmp_path):
    page = write_report(rig_file, tmp_path / "report.html").read_text(encoding="utf-8")
    assert not re.search(r"<(script|link|img|iframe)[^>]*(src|href)=", page)
    for name in (
        "traction",
        "forces",
        "position",
        "patches",
        "patch",
        "contact-work",
        "balance-work",
    ):
        assert page.count(f'id="{name}"') == 1
    text = _text(tmp_path / "report.html")
    assert "37, of which 37 converged" in text
    assert "Forces on the roller" in text
    assert "cut off" not in text
    assert "did not converge" not in text


def test_same_log_same_page(rig_file, tmp_path):
    first = write_report(rig_file, tmp_path / "a.html").read_bytes()
    assert write_report(rig_file, tmp_path / "b.html").read_bytes() == first


def test_traction_curve_is_lateral_over_vertical_force(rig):
    figure = figures.traction_curves(rig, [])
    left = next(t for t in figure.data if t.name == "left")
    assert left.x == pytest.approx([1e3 * synthetic.yaw_at(i) for i in range(37)])
    forces = np.array([synthetic.side("left", i)["force"] for i in range(37)])
    assert left.y == pytest.approx(forces[:, 1] / forces[:, 2])


def test_forces_are_shown_on_the_roller(rig):
    figure = figures.forces(rig, [])
    vertical = [t for t in figure.data if t.name == "right" and t.yaxis == "y5"]
    assert vertical[0].y == pytest.approx(
        [-1e-3 * synthetic.side("right", i)["force"][2] for i in range(37)]
    )
    assert (np.array(vertical[0].y) > 0).all()


def test_positions_that_did_not_converge_are_marked(tmp_path):
    run = synthetic.write_rig_run(tmp_path / "rig.mcap", bad=8)
    text = _page(run, tmp_path)
    assert "1 of 37 positions did not converge" in text
    assert "36 converged and 1 did not" in text
    data = positions(read_run(run))
    for figure in (figures.traction_curves(data, []), figures.forces(data, [])):
        marks = [t for t in figure.data if t.name == "not converged"]
        assert marks
        assert all(list(mark.text) == ["position 8"] for mark in marks)
        assert sum(bool(mark.showlegend) for mark in marks) == 1


def test_reference_is_matched_and_compared(rig, rig_file, tmp_path):
    folder = _write_reference(tmp_path / "reference", [3, 9, 21])
    matches = reference.match(reference.load(folder / reference.FILE), rig)
    # position 3 and 15 are the same on both branches, 9 and 21 come once
    assert sorted({m.index for m in matches}) == [3, 9, 15, 21]
    found = reference.differences(matches, rig)
    # forces on the roller: run minus reference
    for name, expected in (("x", -10.0), ("y", 20.0), ("z", -30.0)):
        assert found[name] == pytest.approx([expected] * 8)
    assert (found["patches"] == 0).all()
    assert found["roll"] == pytest.approx(0, abs=1e-12)
    text = _page(rig_file, tmp_path, reference_dir=folder)
    assert "found for 4 of 37 positions" in text
    assert "Differences from the reference" in text


def test_other_branch_is_not_matched(rig, tmp_path):
    # yaw is -6 mrad at positions 21 and 33, but the lateral position differs
    folder = _write_reference(tmp_path / "reference", [33])
    matches = reference.match(reference.load(folder / reference.FILE), rig)
    assert {m.index for m in matches} == {33}


def test_the_packages_reference_is_shown(rig, rig_file, tmp_path):
    rows = reference.load(reference.find())
    assert len(rows) == 26
    places = len({m.index for m in reference.match(rows, rig)})
    assert f"found for {places} of 37" in _page(rig_file, tmp_path)


def test_absence_of_another_reference_is_said(rig_file, tmp_path):
    text = _page(rig_file, tmp_path, reference_dir=tmp_path)
    assert "is not in the folder that was named" in text
    assert "Differences" not in text
    folder = _write_reference(tmp_path / "reference", [0])
    # yaw and lateral position are the same at the start, in the middle and at the end
    assert "found for 3 of 37" in _page(rig_file, tmp_path, reference_dir=folder)


def test_reference_of_another_run(rig_file, tmp_path):
    folder = _write_reference(tmp_path / "reference", [])
    assert "No position of this run is in the reference" in _page(
        rig_file, tmp_path, reference_dir=folder
    )
    (folder / reference.FILE).write_text("side,y_ws_mm\nL,x\n")
    with pytest.raises(ValueError, match="line 2"):
        write_report(rig_file, tmp_path / "other.html", folder)
    assert not (tmp_path / "other.html").exists()


def test_wheelset_run_leaves_the_balance_out(tmp_path):
    run = synthetic.write_wheelset_run(tmp_path / "hunting.mcap")
    text = _page(run, tmp_path)
    assert "Forces on the rail" in text
    assert "time [s]" in text
    assert "This log holds no fields of patches" in text
    for absent in ("force balance  ", "The reference", "Work of the"):
        assert absent not in text


def test_cut_off_log(tmp_path):
    run = synthetic.write_rig_run(tmp_path / "rig.mcap")
    data = run.read_bytes()
    run.write_bytes(data[: data.rindex(b"zstd") - 4000])
    text = _page(run, tmp_path)
    assert "This log is cut off:" in text
    cut = tmp_path / "head.mcap"
    cut.write_bytes(data[: data.index(b"zstd") + 100])
    with pytest.raises(ReportError, match="no position"):
        write_report(cut, tmp_path / "head.html")
    assert not (tmp_path / "head.html").exists()


def test_text_from_the_log_is_escaped(tmp_path):
    run = tmp_path / "run.mcap"
    name = "<script>alert(1)</script>.toml"
    with synthetic.open_log(run, case_name=name, case_text="</pre><b>&") as log:
        synthetic.write_position(log, 0)
    page = write_report(run, tmp_path / "report.html").read_text(encoding="utf-8")
    assert "<script>alert" not in page
    assert "</pre><b>" not in page
    assert "&lt;/pre&gt;&lt;b&gt;&amp;" in page


def test_snapshot_is_the_nearest_or_the_one_at_the_largest_yaw(rig):
    assert snapshot(rig)["index"] == 9
    assert snapshot(rig, at=0.8)["index"] == 27
    chosen = snapshot(rig, at=0.75)
    # two patches on the left: the more loaded one is shown
    assert len(chosen["left"]) == 2
    figure = patch_figure(chosen)
    division = [t for t in figure.data if t.type == "heatmap" and t.zmax == 3.5]
    given = synthetic.side("left", 27, fields=True)["patches"][0]["element_division"]
    assert np.array_equal(division[0].z, given)
    assert set(np.unique(division[0].text)) == {"exterior", "stick", "slip"}


def test_rows_with_positions_of_their_own_are_interpolated():
    x = np.array([[-2e-3, 0.0, 2e-3], [-1e-3, 0.0, 1e-3]])
    grid = {
        "patch": 0,
        "x": x,
        "y": np.array([[0.0] * 3, [1e-3] * 3]),
        "pressure": np.full((2, 3), 1e9),
        "traction": np.full((2, 3, 2), 1e8),
        "element_division": np.array([[2, 2, 1], [2, 1, 1]]),
    }
    even = regular(most_loaded([grid]))
    assert even["pressure"].shape == (2, 6)
    outside = abs(even["x"]) > 1.0
    assert (even["pressure"][0] == 1000).all()
    assert (even["pressure"][1] == np.where(outside, 0, 1000)).all()
    assert (even["division"][1][outside] == 0).all()


def test_command(rig_file, tmp_path):
    output = tmp_path / "page.html"
    done = CliRunner().invoke(report, [str(rig_file), "-o", str(output), "--at", "0.5"])
    assert done.exit_code == 0
    assert done.output.strip() == str(output)
    assert "position 18" in _text(output)
    quiet = CliRunner().invoke(report, [str(rig_file), "-o", str(output), "--quiet"])
    assert quiet.output == ""


def test_command_refuses_what_is_no_log(tmp_path):
    text = tmp_path / "run.mcap"
    text.write_text("no log")
    for run in (text, tmp_path / "none.mcap"):
        done = CliRunner().invoke(report, [str(run), "-o", str(tmp_path / "page.html")])
        assert done.exit_code == 2
        assert run.name in done.output
    assert not (tmp_path / "page.html").exists()
    with pytest.raises(RunFileError):
        write_report(text, tmp_path / "page.html")
