"""The viewers' layout: every topic and field in it is in a log."""

from __future__ import annotations

import json
import re

import numpy as np
import pytest
import synthetic
import synthetic_vehicle
from click.testing import CliRunner
from railpatch.command.cli import cli
from railpatch.layout import KINDS, Curve, layout, tabs_of, topics_of
from railpatch.log import read_run
from railpatch.log.channels import WELL_KNOWN, channel, vehicle_channels
from railpatch.log.scene import turning


def invoke(*arguments: object):
    return CliRunner().invoke(cli, ["layout", *map(str, arguments)])


@pytest.fixture(scope="module")
def logs(tmp_path_factory):
    folder = tmp_path_factory.mktemp("logs")
    return {
        "roller": synthetic.write_rig_run(folder / "rig.mcap"),
        "vehicle": synthetic_vehicle.write_run(folder / "vehicle.mcap", 31),
    }


def _curves(found):
    return [
        path["value"]
        for name, config in found["configById"].items()
        if name.startswith("Plot!")
        for path in config["paths"]
    ]


@pytest.mark.parametrize("kind", ["roller", "vehicle"])
def test_every_curve_is_in_a_log(logs, kind, tmp_path):
    """Topics and fields as viewers write them, read from a log that holds all of it."""
    made = invoke(logs[kind], "-o", tmp_path / "layout.json")
    assert made.exit_code == 0, made.output
    found = json.loads((tmp_path / "layout.json").read_text())
    run = read_run(logs[kind])
    assert topics_of(found) <= set(run.counts)
    curves = _curves(found)
    assert len(curves) > 10
    filled = 0
    for curve in curves:
        topic, field = curve.split(".", 1)
        # the last index, of a list of numbers, is numpy's
        path, _, component = re.fullmatch(r"(.*?)(\[(\d)\])?", field).groups()
        values = run[topic][path]
        if component is not None and values.ndim == 2:
            values = values[:, int(component)]
        assert values.ndim == 1, curve
        filled += bool(np.isfinite(values).any())
    # what the made-up runs leave out is little
    assert filled > 0.7 * len(curves)


@pytest.mark.parametrize("kind", KINDS)
def test_every_topic_is_in_the_table(kind):
    found = layout(kind, wheelsets=4)
    for topic in topics_of(found):
        if topic not in WELL_KNOWN:
            assert channel(topic)
    if kind == "vehicle":
        table = {entry.topic for entry in vehicle_channels(4)}
        assert topics_of(found) <= table | set(WELL_KNOWN)
        for number in range(1, 5):
            assert f"/wheelset/{number}/left/contact" in topics_of(found)


@pytest.mark.parametrize("kind", KINDS)
def test_panels_and_tree_agree(kind):
    """Every panel of the tree is configured, every configured panel has its place."""
    found = layout(kind)

    def leaves(node):
        if isinstance(node, str):
            return [node]
        assert set(node) == {"first", "second", "direction", "splitPercentage"}
        return leaves(node["first"]) + leaves(node["second"])

    placed = leaves(found["layout"])
    for tab in found["configById"]["Tab!tabs"]["tabs"]:
        placed += leaves(tab["layout"])
    assert sorted(placed) == sorted(found["configById"])


def test_the_scene_follows_frames_of_the_log(logs):
    for kind, path in logs.items():
        follow = layout(kind)["configById"]["3D!scene"]["followTf"]
        assert follow in _frames(path)


def _frames(path):
    from mcap.reader import make_reader
    from mcap_protobuf.decoder import DecoderFactory

    with open(path, "rb") as stream:
        reader = make_reader(stream, decoder_factories=[DecoderFactory()])
        [first, *_] = reader.iter_decoded_messages(topics=["/tf"])
        transforms = first.decoded_message.transforms
    return {t.child_frame_id for t in transforms} | {t.parent_frame_id for t in transforms}


def test_labels_have_the_tables_units():
    assert Curve("/left/contact", "patches[0].max_pressure", "p").label == "p [Pa]"
    assert Curve("/left/contact", "patches[0].creepage[1]", "y").label == "y"
    assert Curve("/rig/balance", "evaluations", "n").label == "n"
    # of a list whose numbers have units of their own
    assert Curve("/rig/balance", "residuals[0]", "m").label == "m [N m]"
    assert Curve("/rig/balance", "residuals[1]", "f").label == "f [N]"


@pytest.mark.parametrize("kind", KINDS)
def test_one_axis_has_one_unit(kind):
    for curves in (plot for tab in tabs_of(kind, 2) for plot in tab.plots.values()):
        [shown] = {curve.unit for curve in curves}
        assert "," not in shown


def test_marks_lie_on_both_faces_of_a_disc():
    """Not beside it, where a profile is wide; nor in it, where they would not be seen."""
    curve = np.array([[-0.07, 0.49], [-0.03, 0.47], [0.0, 0.46], [0.06, 0.455]])
    [marks] = turning("wheel", "wheel", curve, dict.fromkeys("rgba", 1.0))["lines"]
    places = np.array([[point[axis] for axis in "xyz"] for point in marks["points"]])
    assert set(places[:, 1]) == {-marks["thickness"], marks["thickness"]}
    assert np.hypot(places[:, 0], places[:, 2]) == pytest.approx(0.46)


@pytest.mark.parametrize(
    ("topic", "field"),
    [
        ("/left/contact", "patches[0].pressure"),
        ("/left/contact", "patches.approach"),
        ("/wheelset/state", "w"),
        ("/wheel/state", "y"),
    ],
)
def test_what_is_not_in_the_table_is_an_error(topic, field):
    with pytest.raises(KeyError):
        Curve(topic, field, "name")


def test_what_a_log_leaves_out_is_left_out(tmp_path):
    run = synthetic.write_wheelset_run(tmp_path / "run.mcap", scene_rate=0)
    made = invoke(run, "-o", tmp_path / "layout.json", "--quiet")
    assert (made.exit_code, made.output) == (0, "")
    found = json.loads((tmp_path / "layout.json").read_text())
    assert "3D!scene" not in found["configById"]
    titles = [tab["title"] for tab in found["configById"]["Tab!tabs"]["tabs"]]
    assert titles == ["Motion", "Forces", "Contact"]


def test_without_a_log(tmp_path):
    output = tmp_path / "layout.json"
    made = invoke("-o", output, "--kind", "vehicle", "--wheelsets", 2)
    assert made.output.strip() == str(output)
    found = json.loads(output.read_text())
    assert found == layout("vehicle", 2)
    assert "/wheelset/3/state" not in topics_of(found)


def test_wrong_calls(tmp_path):
    text = tmp_path / "run.mcap"
    text.write_text("no log")
    for run in (text, tmp_path / "none.mcap"):
        done = invoke(run, "-o", tmp_path / "layout.json")
        assert done.exit_code == 2
        assert run.name in done.output
    assert not (tmp_path / "layout.json").exists()
    for bad in (("car", 4), ("vehicle", 0)):
        with pytest.raises(ValueError, match="must be"):
            layout(*bad)
