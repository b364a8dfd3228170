"""The log of a vehicle: topics of every wheelset, bodies, frames, and what it refuses."""

from __future__ import annotations

import copy
import math

import numpy as np
import pytest
import synthetic
import synthetic_vehicle as vehicle
from mcap.reader import make_reader
from mcap_protobuf.decoder import DecoderFactory
from railpatch.case.types import SIDES
from railpatch.log import VehicleGeometry, read_run
from railpatch.log.channels import WELL_KNOWN, channel, vehicle_channels


@pytest.fixture(scope="module")
def path(tmp_path_factory):
    return vehicle.write_run(tmp_path_factory.mktemp("log") / "vehicle.mcap")


@pytest.fixture(scope="module")
def run(path):
    return read_run(path)


def _messages(path, topic):
    with open(path, "rb") as stream:
        reader = make_reader(stream, decoder_factories=[DecoderFactory()])
        return [m.decoded_message for m in reader.iter_decoded_messages(topics=[topic])]


def test_every_wheelset_has_topics_of_its_own(run):
    assert not run.truncated
    assert run.metadata["railpatch"]["wheelsets"] == "4"
    for number in range(1, 5):
        above = f"/wheelset/{number}"
        distance = run[f"{above}/state"]["x"]
        ahead = vehicle.AHEAD[number - 1]
        assert distance == pytest.approx(ahead + vehicle.SPEED * 0.01 * np.arange(101))
        for side in SIDES:
            force = run[f"{above}/{side}/contact"]["force"]
            assert list(force[-1]) == vehicle.wheel(side, distance[-1])["force"]
    assert run.counts["/wheelset/1/left/fields"] == 11
    assert "/wheelset/2/left/fields" not in run.counts
    # 3D: 30 times a second of simulation time, of 100 steps
    assert run.counts["/tf"] == run.counts["/scene/contact"] == 31
    assert run.counts["/scene/bodies"] == 1


def test_bodies(run):
    bodies = run["/vehicle/bodies"]
    names = [body["name"] for body in bodies.messages[0]["bodies"]]
    assert names == [
        "car_body",
        "bogie_1",
        "bogie_2",
        "wheelset_1",
        "wheelset_2",
        "wheelset_3",
        "wheelset_4",
    ]
    given = vehicle.step(100)["bodies"][0]
    assert list(bodies["bodies[0].position"][100]) == given["position"]
    assert list(bodies["bodies[0].acceleration"][100]) == given["acceleration"]


def test_table_has_every_topic(run):
    table = {entry.topic: entry for entry in vehicle_channels(4)}
    assert set(run.counts) <= set(table) | set(WELL_KNOWN)
    assert len(table) == 6 + 4 * 8
    for topic, entry in table.items():
        assert channel(topic).message is entry.message
        assert "N" not in topic
    with pytest.raises(KeyError):
        channel("/wheelset/0/state")


def _matrix(q):
    x, y, z, w = q
    return np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
            [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
            [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
        ]
    )


def _poses(message):
    """Of every frame in the world."""
    links = {t.child_frame_id: t for t in message.transforms}

    def pose(name):
        if name not in links:
            return np.eye(3), np.zeros(3)
        link = links[name]
        turn, at = pose(link.parent_frame_id)
        q, p = link.rotation, link.translation
        own = _matrix((q.x, q.y, q.z, q.w))
        return turn @ own, at + turn @ np.array([p.x, p.y, p.z])

    return {name: pose(name) for name in links}


def test_frames_hang_together(path):
    """Every frame that bodies and patches use is there; wheels stand on the track's frames."""
    used = {e.frame_id for m in _messages(path, "/scene/bodies") for e in m.entities}
    used |= {e.frame_id for m in _messages(path, "/scene/contact") for e in m.entities}
    for message in _messages(path, "/tf"):
        poses = _poses(message)
        assert used <= set(poses)
        for number in range(1, 5):
            turn, at = poses[f"track_{number}"]
            wheel_turn, centre = poses[f"wheels_{number}"]
            # seen in the track's axes the centre is one radius above, beside by y
            inside = turn.T @ (centre - at)
            assert inside[0] == pytest.approx(0, abs=1e-9)
            assert inside[2] == pytest.approx(-0.3556)
            # the axle does not turn with the wheels
            assert turn.T @ wheel_turn @ [0, 1, 0] == pytest.approx([0, 1, 0], abs=1e-9)
    # the viewers' world has z up: the car body is above, and right is to the right
    turn, at = poses["car_body"]
    assert at[2] == pytest.approx(1.8)
    assert at[1] < 0


def test_wheels_turn_with_the_pitch(path):
    message = _messages(path, "/tf")[-1]
    link = next(t for t in message.transforms if t.child_frame_id == "wheels_2")
    pitch = vehicle.step(100)["wheelsets"][1]["state"]["pitch"]
    assert link.rotation.y == pytest.approx(math.sin(pitch / 2))


def test_patches_lie_in_their_wheelsets_frame(path):
    entities = _messages(path, "/scene/contact")[-1].entities
    assert {(e.id, e.frame_id) for e in entities} == {
        (f"{number}_{side}_patch_0", f"track_{number}") for number in range(1, 5) for side in SIDES
    }


def test_without_geometry_and_tracks(tmp_path):
    step = vehicle.step(0)
    del step["tracks"]
    with vehicle.open_log(tmp_path / "run.mcap", geometry=None, scene_rate=0) as log:
        log.write(0.0, **step)
    run = read_run(tmp_path / "run.mcap")
    assert not {"/tf", "/scene/bodies", "/scene/contact"} & set(run.counts)
    assert len(run["/wheelset/4/state"]) == 1


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"wheelsets": 0}, "wheelsets is 0; it must be a whole number >= 1"),
        ({"geometry": synthetic.geometry("rail")}, "it must be a VehicleGeometry"),
        ({"case_name": ""}, "case_name"),
        ({"scene_rate": -1}, "scene_rate is -1"),
    ],
)
def test_bad_arguments_make_no_file(tmp_path, change, message):
    with pytest.raises(ValueError, match=message):
        vehicle.open_log(tmp_path / "run.mcap", **change)
    assert not (tmp_path / "run.mcap").exists()


@pytest.mark.parametrize(
    ("path", "value", "message"),
    [
        (["wheelsets", 2, "state", "y"], math.nan, "/wheelset/3/state: y is nan"),
        (["wheelsets", 3, "left", "status"], "bad", "/wheelset/4/left/contact: status is 'bad'"),
        (["bodies", 0, "position"], [1.0], r"bodies\[0\].position has 1 values"),
        (["bodies", 1, "name"], None, r"/vehicle/bodies: bodies\[1\].name is missing"),
        (["state", "x"], None, "/vehicle/state: x is missing"),
        (["wheelsets"], [], "wheelsets has 0 entries; it must have 4"),
        (["tracks"], [], "tracks has 0 entries; it must have 4"),
        (["energy", "potential"], 1.0, "/vehicle/energy: potential is not a field"),
    ],
)
def test_bad_values_name_their_place(tmp_path, path, value, message):
    step = copy.deepcopy(vehicle.step(0))
    target = step
    for key in path[:-1]:
        target = target[key]
    target[path[-1]] = value
    with (
        vehicle.open_log(tmp_path / "run.mcap") as log,
        pytest.raises(ValueError, match=message),
    ):
        log.write(0.0, **step)
    # the step is refused as a whole
    assert read_run(tmp_path / "run.mcap").counts == {"/scene/bodies": 1}


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"wheelset": synthetic.geometry("roller")}, "of kind 'rail'"),
        ({"boxes": {"car_body": [([0, 0], [1, 1, 1])]}}, "car_body"),
        ({"centre_line": np.zeros((3, 2))}, r"centre_line has shape \(3, 2\)"),
    ],
)
def test_bad_geometry(change, message):
    good = {"wheelset": synthetic.geometry("rail"), "boxes": {}}
    with pytest.raises(ValueError, match=message):
        VehicleGeometry(**(good | change))
