"""Scenes of the rig: what is refused, with which words, and which profiles are found."""

from __future__ import annotations

import numpy as np
import pytest
from railpatch import CaseError
from railpatch.case.load import read_toml
from railpatch.report import reference

from rig_model import nominal
from rig_model.scene import MEASURED, load_rig_scene

YAW = "yaw = [[0.0, 0.0], [0.25, 0.018], [0.5, 0.0], [0.75, -0.018], [1.0, 0.0]]"

# what is replaced, by what, and what the message must hold
WRONG = {
    # it was "method.tangential: value is 'none'", of the balance's own first estimate
    "rolling on": (
        "[track]",
        "time_step = 1e-3\n[motion]\nregime = 'transient_rolling'\n[track]",
        ("motion.regime", "'transient_rolling'", "'steady_rolling'", "solved several times"),
    ),
    "regimes that change": (
        "[track]",
        "time_step = 1e-3\n[motion]\nregime_changes = true\n[track]",
        ("motion.regime_changes", "True", "False"),
    ),
    "unknown key": ("positions = 37", "positions = 37\nspeed = 3", ("rig.speed", "3", "unknown")),
    "unknown balance key": ("[rig]", "[rig.balance]\nmethod = 'x'\n[rig]", ("rig.balance.method",)),
    "nearly a key": ("duration = 360.0", "duratoin = 360.0", ("did you mean 'duration'",)),
    "too few": ("positions = 37", "positions = 1", ("rig.positions", "1", ">= 2")),
    "no whole number": ("positions = 37", "positions = 3.5", ("rig.positions", "3.5")),
    "no number": ("positions = 37", "positions = '37'", ("rig.positions", "'37'")),
    "both": (
        "positions = 37",
        "positions = 37\nrate = 2.0",
        ("'positions', 'rate'", "given with 'rate'"),
    ),
    "neither": ("positions = 37", "", ("'positions', 'rate'", "missing")),
    "rate": ("positions = 37", "rate = 1e9", ("rig.rate", "1e7")),
    "duration": ("duration = 360.0", "duration = 0.0", ("rig.duration", "0.0", "> 0")),
    "yaw too large": (YAW, "yaw = [[0, 0.0], [1, 0.5]]", ("rig.yaw", "0.5", "0.1 rad")),
    "progress": (YAW, "yaw = [[0, 0.0], [0.5, 0.0]]", ("rig.yaw", "from 0 to 1")),
    "order": (YAW, "yaw = [[0, 0.0], [0.5, 0.0], [0.5, 1e-3], [1, 0.0]]", ("rig.yaw", "rising")),
    "row": (YAW, "yaw = [[0, 0.0, 1.0], [1, 0.0]]", ("rig.yaw[0]", "2 values")),
    "one row": (YAW, "yaw = [[0, 0.0]]", ("rig.yaw", "2 or more rows")),
    "nan": (YAW, "yaw = [[0, nan], [1, 0.0]]", ("rig.yaw[0][1]", "nan", "finite")),
    "torque": (
        "[rig]",
        "[rig.balance]\naxle_torque = 'x'\n[rig]",
        ("axle_torque", "'x'", "'track'"),
    ),
    "tolerance": ("[rig]", "[rig.balance]\ntolerance = 1e-6\n[rig]", ("1e-06", "method.tolerance")),
    "start in part": ("[rig]", "[rig.start]\nz = 0.0\n[rig]", ("rig.start.roll", "missing")),
    "snapshots": (
        "positions = 37",
        "positions = 37\nsnapshot_every = -1",
        ("snapshot_every", "-1"),
    ),
    "kind": ('"wheelset"', '"wheel_rail"', ("kind", "'wheel_rail'", "'wheelset'")),
    "rails": (
        'kind = "roller"\ngauge = 1.435                        # m\n'
        "gauge_height = 0.014                 # m\n"
        "roller_radius = 0.8001               # m\n"
        "roller_pitch_rate = 5.587302         # rad/s, 10 mph\n",
        'kind = "rail"\n',
        ("track.kind", "'rail'", "'roller'"),
    ),
    "standstill": ("= 5.587302", "= 0.0", ("track.roller_pitch_rate", "0.0", "not 0")),
    "height": ("vertical_force = 133.95e3", "z = 0.0", ("wheelset.z", "vertical_force")),
    "balanced roll": (
        "[wheelset]",
        '[wheelset]\nroll = "balanced"',
        ("wheelset.roll", "'balanced'", "start"),
    ),
    "found roll": ("[wheelset]", "[wheelset]\nroll = 0.1", ("wheelset.roll", "0.1", "start")),
    "found yaw": ("[wheelset]", "[wheelset]\nyaw = 0.1", ("wheelset.yaw", "0.1", "[rig] as yaw")),
    "found y": ("[wheelset]", "[wheelset]\ny = 0.1", ("wheelset.y", "lateral_position")),
    "no creep": ("[rig]", "[method]\ntangential = 'none'\n[rig]", ("method.tangential", "'none'")),
    "case": ("coefficient = 0.52", "coefficient = -0.5", ("friction.coefficient", "-0.5", ">= 0")),
}


@pytest.mark.parametrize("name", WRONG)
def test_wrong_scene_is_refused(scene_with, name):
    old, new, words = WRONG[name]
    with pytest.raises(CaseError) as caught:
        load_rig_scene(scene_with((old, new)))
    text = str(caught.value)
    for word in words:
        assert word in text, f"{word!r} is not in {text!r}"


def test_all_problems_are_told_at_once(scene_with):
    path = scene_with(
        ("coefficient = 0.52", "coefficient = -1"), ("positions = 37", "positions = 0")
    )
    with pytest.raises(CaseError) as caught:
        load_rig_scene(path)
    assert len(caught.value.problems) == 2


def test_scene_without_rig(scene_with, nominal_file):
    text = nominal_file.read_text()
    path = scene_with((text[text.index("[rig]") :], ""))
    with pytest.raises(
        CaseError, match=r"contact case, without \[rig\], allowed one of railpatch rig"
    ):
        load_rig_scene(path)


def test_missing_file(tmp_path):
    with pytest.raises(CaseError, match=r"none\.toml: cannot be read"):
        load_rig_scene(tmp_path / "none.toml")


def test_overrides_replace(nominal_file):
    scene = load_rig_scene(nominal_file, {"rate": 10.0, "positions": None, "duration": 2.0})
    assert scene.rig.positions is None
    assert scene.rig.count == 21
    assert scene.text == nominal_file.read_bytes()
    with pytest.raises(CaseError, match=r"rig\.positions: value is 1"):
        load_rig_scene(nominal_file, {"positions": 1})


def test_both_scenes_are_the_same_machine(nominal_file):
    """They may differ in profiles and in what goes with these: deviations, shifts, the torque
    that was balanced in the published run."""
    nominal_scene = read_toml(nominal_file)
    measured_scene = read_toml(nominal_file.with_name(MEASURED))
    for table in ("wheelset", "track"):
        for side in ("left", "right"):
            del measured_scene[table][side]
    assert measured_scene["rig"].pop("balance") == {"axle_torque": "track"}
    assert nominal_scene.pop("profiles") != measured_scene.pop("profiles")
    assert nominal_scene == measured_scene


def test_nominal_profiles_are_made_by_their_formula(nominal_file):
    for name, content in nominal.files().items():
        assert nominal_file.with_name(name).read_text() == content


def test_nominal_roller_is_smooth_with_a_facet():
    """Facet at 1:30, inclination without jumps, rising from the gauge side to the field side."""
    y, z = np.array(nominal.roller_points()).T
    angle = np.arctan2(np.diff(z), np.diff(y))
    flat = np.abs(0.5 * (y[1:] + y[:-1])) < 3.9
    np.testing.assert_allclose(np.tan(angle[flat]), -1 / 30, rtol=1e-9)
    assert (np.diff(y) > 0).all()
    assert (np.diff(angle) > -1e-9).all()
    assert np.diff(angle).max() < 0.06
    # the gauge is measured 14 mm below the highest point
    assert z.max() - z.min() > 20


def test_profiles_beside_the_scene_come_before_the_packages(measured_file, tmp_path):
    names = ["nrc_left_roller.csv", "nrc_left_wheel.csv"]
    (tmp_path / "scene.toml").write_bytes(measured_file.read_bytes())
    (tmp_path / names[1]).write_bytes(measured_file.with_name(names[1]).read_bytes())
    files = load_rig_scene(tmp_path / "scene.toml").files
    assert [files[name].parent for name in names] == [measured_file.parent, tmp_path]
    assert load_rig_scene().files.keys() == files.keys()


def test_every_published_position_is_one_of_the_run():
    places = np.array([(p.yaw, p.y) for p in load_rig_scene().positions()])
    rows = reference.load(reference.find())
    assert len(rows) == 26
    for row in rows:
        assert np.abs(places - (row.yaw, row.y)).max(axis=1).min() < 1e-6, row
