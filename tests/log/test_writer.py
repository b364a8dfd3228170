"""What the writer puts into the file, read back with the mcap library alone."""

from __future__ import annotations

from collections.abc import MutableSequence

import numpy as np
import pytest
import synthetic
from google.protobuf.descriptor_pb2 import FileDescriptorSet
from mcap.reader import make_reader
from mcap_protobuf.decoder import DecoderFactory
from railpatch.case.types import SIDES
from railpatch.log.channels import (
    CHANNELS,
    LEFT_OUT,
    PATCH,
    WELL_KNOWN,
    WHEEL_CONTACT,
    flat_fields,
    markdown,
)
from railpatch.log.schema import file_descriptor, message_class
from railpatch.result import PATCH_UNITS, PLACE_UNITS, WHEEL_UNITS


@pytest.fixture(scope="module")
def rig_file(tmp_path_factory):
    return synthetic.write_rig_run(tmp_path_factory.mktemp("log") / "rig.mcap")


def _reader(stream):
    return make_reader(stream, validate_crcs=True, decoder_factories=[DecoderFactory()])


def _messages(path, topic):
    with open(path, "rb") as stream:
        return [
            (message.log_time, decoded)
            for _, _, message, decoded in _reader(stream).iter_decoded_messages(topics=[topic])
        ]


def test_every_channel_is_decoded_by_the_mcap_library(rig_file):
    counts = {}
    with open(rig_file, "rb") as stream:
        for schema, channel, _, decoded in _reader(stream).iter_decoded_messages():
            counts[channel.topic] = counts.get(channel.topic, 0) + 1
            assert decoded.DESCRIPTOR.full_name == schema.name
    expected = dict.fromkeys([c.topic for c in CHANNELS] + list(WELL_KNOWN), 37)
    expected |= {"/left/fields": 5, "/right/fields": 5, "/scene/bodies": 1}
    # a rig has no balance of energies and momenta, and this one no record, frame or conditioning
    for topic in ("/wheelset/energy", "/wheelset/momentum", "/rig/measured", "/rig/frame"):
        del expected[topic]
    for side in ("left", "right"):
        del expected[f"/{side}/conditioning"]
        # one at a run's end, of scenes with [damage]: tests/vehicle/test_wear_run.py
        del expected[f"/{side}/wear"]
    assert counts == expected


def test_values_times_and_absence(rig_file):
    time_ns, contact = _messages(rig_file, "/left/contact")[27]
    assert time_ns == 27_000_000_000
    given = synthetic.side("left", 27)
    assert list(contact.force) == given["force"]
    assert [p.approach for p in contact.patches] == [p["approach"] for p in given["patches"]]
    assert contact.patches[1].elements.slip == 250
    # a count of zero is present, what the scene left out is not
    assert contact.patches[0].elements.HasField("plastic")
    assert not contact.patches[0].HasField("max_temperature")
    assert not contact.HasField("z")


def test_fields_run_over_x_first(rig_file):
    _, snapshot = _messages(rig_file, "/right/fields")[1]
    patch, given = snapshot.patches[0], synthetic.side("right", 9, fields=True)["patches"][0]
    assert (patch.rows, patch.columns) == (20, 24)
    assert patch.pressure[3 * 24 + 5] == given["pressure"][3][5]
    assert patch.x[3 * 24 + 5] == given["x"][5]
    assert patch.y[3 * 24 + 5] == given["y"][3]
    assert patch.traction[20 * 24 + 3 * 24 + 5] == given["traction"][1][3][5]
    assert patch.element_division[10 * 24 + 12] == given["element_division"][10][12]


def test_attachments_keep_their_bytes_and_come_first(rig_file):
    with open(rig_file, "rb") as stream:
        found = {a.name: (a.media_type, a.data) for a in _reader(stream).iter_attachments()}
    assert found["rig.toml"] == ("application/toml", synthetic.CASE.encode())
    assert {name: found[name][1] for name in synthetic.PROFILES} == synthetic.PROFILES
    data = rig_file.read_bytes()
    assert data.index(synthetic.PROFILES["wheel.whl"]) < data.index(b"zstd")


def test_metadata_has_units_and_signs(rig_file):
    with open(rig_file, "rb") as stream:
        reader = _reader(stream)
        records = {record.name: record.metadata for record in reader.iter_metadata()}
        channels = {c.topic: c.metadata for c in reader.get_summary().channels.values()}
    assert records["railpatch"]["scene"] == "rig.toml"
    assert "on the wheel" in records["railpatch"]["forces"]
    assert "/left/contact.patches[].approach" in records["railpatch.channels"]
    contact = channels["/left/contact"]
    assert contact["force.unit"] == "N"
    assert contact["force.frame"] == "track"
    assert contact["patches[].max_pressure.unit"] == "Pa"


def test_schema_carries_the_table_as_comments(rig_file):
    with open(rig_file, "rb") as stream:
        schemas = _reader(stream).get_summary().schemas.values()
    data = next(s.data for s in schemas if s.name == "railpatch.WheelContact")
    [file] = FileDescriptorSet.FromString(data).file
    comments = {tuple(loc.path): loc.leading_comments for loc in file.source_code_info.location}
    patch = next(m for m in file.message_type[0].nested_type if m.name == "Patch")
    index = [f.name for f in patch.field].index("approach")
    assert comments[4, 0, 3, 0, 2, index] == " m; contact axes: approach of the bodies\n"


MESSAGES = dict.fromkeys(channel.message for channel in CHANNELS)


@pytest.mark.parametrize("message", MESSAGES, ids=lambda m: m.name)
def test_classes_match_the_table(message):
    descriptor = message_class(message).DESCRIPTOR
    assert [f.name for f in descriptor.fields] == [f.name for f in message.fields]
    assert [f.number for f in descriptor.fields] == list(range(1, len(message.fields) + 1))
    for field, proto in zip(message.fields, descriptor.fields, strict=True):
        value = getattr(message_class(message)(), field.name)
        assert isinstance(value, MutableSequence) == (field.size != 1)
        assert proto.has_presence == (field.size == 1)
    assert file_descriptor(message).syntax == "proto3"


def test_table_has_all_of_a_result():
    """The contact channels carry what a solve gives, in the same units."""
    units = {"": "-", "degrees C": "degC"}
    for message, result in ((PATCH, PATCH_UNITS | PLACE_UNITS), (WHEEL_CONTACT, WHEEL_UNITS)):
        # of basic contacts alone, which have no log
        alone = {"viscous_power", "rolling_resistance_moment"} & LEFT_OUT[message.name].keys()
        for name in result.keys() - alone:
            field, unit = message.field(name), result[name]
            if field.unit:
                assert field.unit == units.get(unit, unit), name


def test_every_field_of_the_table_has_unit_and_meaning():
    for entry in CHANNELS:
        for path, field in flat_fields(entry.message):
            assert field.text, path
            assert bool(field.unit) == (field.kind in ("double", "uint32")), path


def test_documentation_lists_every_field():
    text = markdown()
    for entry in CHANNELS:
        assert f"| {entry.topic} | railpatch.{entry.message.name} |" in text
        for path, field in flat_fields(entry.message):
            assert f"| {path} | {field.unit} |" in text


def _frame(message, child):
    return next(t for t in message.transforms if t.child_frame_id == child)


def test_frames_follow_the_wheelset(rig_file):
    _, message = _messages(rig_file, "/tf")[9]
    given = synthetic.state(9)
    wheelset = _frame(message, "wheelset")
    assert wheelset.parent_frame_id == "track"
    assert wheelset.translation.y == given["y"]
    assert wheelset.translation.z == pytest.approx(given["z"] - 0.3556, abs=1e-15)
    # small angles: half of roll and yaw
    assert wheelset.rotation.x == pytest.approx(given["roll"] / 2, rel=1e-3)
    assert wheelset.rotation.z == pytest.approx(given["yaw"] / 2, rel=1e-3)
    assert _frame(message, "roller_left").translation.z == 0.8001
    # the world has z up: half a turn about x
    assert _frame(message, "track").rotation.x == 1.0


def _turned(rotation, vector):
    axis = np.array([rotation.x, rotation.y, rotation.z])
    cross = np.cross(axis, vector)
    return vector + 2 * (rotation.w * cross + np.cross(axis, cross))


def test_arrows_point_along_the_forces_on_the_wheel(rig_file):
    index = 12
    _, update = _messages(rig_file, "/scene/contact")[index]
    for name in SIDES:
        [patch] = synthetic.side(name, index)["patches"]
        entity = next(e for e in update.entities if e.id == f"{name}_patch_0")
        normal, creep = entity.arrows
        up = _turned(normal.pose.orientation, np.array([1.0, 0, 0]))
        # up in axes with z down, and leaning as the contact angle says
        angle = patch["contact_angle"]
        assert up == pytest.approx([0, np.sin(angle), -np.cos(angle)], abs=1e-12)
        assert normal.shaft_length + normal.head_length == pytest.approx(
            5e-6 * patch["normal_force"]
        )
        sideways = _turned(creep.pose.orientation, np.array([1.0, 0, 0]))
        assert np.sign(sideways[1]) == np.sign(patch["creep_force"][1])


def test_wheel_and_roller_touch_near_the_top(rig_file):
    [(_, update)] = _messages(rig_file, "/scene/bodies")
    meshes = {
        e.id: np.array([[p.x, p.y, p.z] for p in e.triangles[0].points]) for e in update.entities
    }
    assert set(meshes) == {f"{body}_{side}" for body in ("wheel", "roller") for side in SIDES}
    for side, sign in (("left", -1), ("right", 1)):
        wheel, roller = meshes[f"wheel_{side}"], meshes[f"roller_{side}"]
        assert (sign * wheel[:, 1] > 0.65).all()
        assert (sign * roller[:, 1] > 0.7).all()
        assert wheel[:, 2].max() == pytest.approx(0.3556, abs=3e-3)
        assert np.hypot(roller[:, 0], roller[:, 2]).max() == pytest.approx(0.8001, abs=1e-5)


def test_rails_are_drawn_at_the_gauge():
    shape = synthetic.geometry("rail")
    assert shape.rails["right"][:, 0].min() == pytest.approx(1.435 / 2)
    assert shape.rails["left"][:, 0].max() == pytest.approx(-1.435 / 2)
    assert shape.rails["right"][:, 1].min() == pytest.approx(0, abs=1e-12)
