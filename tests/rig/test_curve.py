"""The steady position in a curve: balance checked by other code, mirror image, what is refused."""

from __future__ import annotations

import json
import math
from dataclasses import replace

import numpy as np
import pytest
from click.testing import CliRunner
from railpatch import CaseError, Contact

from rig_model.command import curve as command
from rig_model.curve import DEFAULT, load_curve_scene, steady_curves

LOAD = 120e3
STIFFNESS = 5e6
SPEED, NOMINAL_RADIUS, PITCH_INERTIA = 12.0, 0.46, 110.0


@pytest.fixture(scope="module")
def found():
    return {method: steady_curves(load_curve_scene(), method) for method in ("newton", "broyden")}


def test_newton_takes_few_evaluations(found):
    """Of the full theory: it starts from a balance with FASTSIM."""
    for item in found["newton"]:
        assert item.converged
        # at 175 m the contact lies on the flange root, where elements of 0.5 mm that come into
        # contact change the stiffness by a fifth within a micrometre: no quadratic convergence
        assert item.evaluations <= 6, item.radius
    for newton, broyden in zip(found["newton"], found["broyden"], strict=True):
        assert broyden.converged
        assert newton.evaluations < broyden.evaluations


def test_both_methods_find_the_same(found):
    for newton, broyden in zip(found["newton"], found["broyden"], strict=True):
        # 6 N over the stiffness of a contact, some 1 kN/um, and of a flange, 1 kN/20 um
        close = [5e-6, 2e-7, 5e-7, 2e-5, 5e-3]
        assert (np.abs(newton.unknowns - broyden.unknowns) <= close).all()


def test_balance():
    """Solved again from a cold start, and summed patch by patch: by the rule that has pressure
    along the patches' normals."""
    scene = load_curve_scene()
    method = scene.case.method.model_copy(update={"patch_rule": "contact"})
    scene = replace(scene, case=scene.case.model_copy(update={"method": method}))
    for item in steady_curves(scene, "newton"):
        assert item.converged
        contact = Contact(scene.at_height(item.radius))
        y, z, roll, yaw, pitch_rate = map(float, item.unknowns)
        result = contact.step(y=y, z=z, roll=roll, yaw=yaw, pitch_rate=pitch_rate)
        lateral = vertical = yaw_moment = axle = rolling = 0.0
        for side in ("left", "right"):
            for patch in result[side]["patches"]:
                c, s = math.cos(patch["contact_angle"]), math.sin(patch["contact_angle"])
                fx, fs = (patch["share"] * value for value in patch["creep_force"])
                normal = patch["share"] * patch["normal_force"]
                lateral += c * fs + s * normal
                vertical += s * fs - c * normal
                px, py, pz = patch["position"]
                # about the centre, one nominal radius above the wheelset's z
                rolling += (py - y) * (s * fs - c * normal)
                rolling -= (pz - z + NOMINAL_RADIUS) * (c * fs + s * normal)
                yaw_moment += px * (c * fs + s * normal) - (py - y) * fx
                axle += fx * math.cos(yaw) * result[side]["rolling_radius"]
        tolerance = 1.2 * 5e-5 * LOAD
        assert lateral == pytest.approx(0, abs=tolerance)
        assert vertical == pytest.approx(-LOAD, abs=tolerance)
        # the patches' own moments, up to 30 N m each, and lateral forces beside the axle
        assert yaw_moment == pytest.approx(STIFFNESS * yaw, abs=100)
        assert axle == pytest.approx(0, abs=100)
        # of a body that turns by V/R: V/R z x I_y pitch rate y, along -x
        gyroscopic = -PITCH_INERTIA * pitch_rate * SPEED / item.radius
        assert gyroscopic == pytest.approx(PITCH_INERTIA * SPEED**2 / 0.46 / item.radius, rel=0.01)
        assert rolling == pytest.approx(gyroscopic, abs=tolerance + 2 * 30)
        assert result["moment"][0] == pytest.approx(gyroscopic, abs=tolerance)


def test_curves_tell_what_they_are_looked_at_for(found):
    """Y and Q are the force on the rail, so minus that on the wheel, towards the field side."""
    for item in found["newton"]:
        data = item.to_dict()
        assert set(item.UNITS) | {"radius"} == set(data)
        for side, outwards in (("left", -1), ("right", 1)):
            force = data[f"{side}_force"]
            guiding, load = -outwards * force[1], -force[2]
            assert data[f"{side}_guiding_force"] == pytest.approx(guiding, rel=1e-12)
            assert data[f"{side}_wheel_load"] == pytest.approx(load, rel=1e-12)
            assert data[f"{side}_derailment_quotient"] == pytest.approx(guiding / load, rel=1e-12)
            patches = item.result[side]["patches"]
            assert data[f"{side}_max_pressure"] == max(p["max_pressure"] for p in patches)


def test_spin_loads_the_outer_wheel(found):
    """By its moment over the distance of the contacts, some 1.5 m; Y forces, and so the load's own
    transfer, stay. The vehicle's tests balance the same moment with those of its weights."""
    without = steady_curves(load_curve_scene(pitch_inertia=0.0), "newton")
    for item, other in zip(found["newton"], without, strict=True):
        # right-hand curves: the left wheel is the outer one
        more = other.result["left"]["force"][2] - item.result["left"]["force"][2]
        moment = PITCH_INERTIA * SPEED**2 / NOMINAL_RADIUS / item.radius
        assert more == pytest.approx(moment / 1.5, rel=0.15)
        assert item.result["moment"][0] - other.result["moment"][0] == pytest.approx(moment, abs=12)


def test_a_tighter_curve_takes_the_flange(found):
    wide, tight = found["newton"]
    assert tight.unknowns[0] < wide.unknowns[0] < 0
    angles = [max(abs(a) for a in c.to_dict()["left_contact_angle"]) for c in (wide, tight)]
    assert angles[1] > 2 * angles[0]


def test_left_curve_is_the_mirror_image(found):
    scene = load_curve_scene(radius=[-600.0])
    (left,) = steady_curves(scene, "newton")
    right = found["newton"][0]
    mirror = np.array([-1, 1, -1, -1, 1])
    # brentq ends within a micrometre on either side
    assert (np.abs(left.unknowns - mirror * right.unknowns) <= [2e-6, 1e-7, 2e-7, 1e-5, 2e-3]).all()


def test_wide_curve_is_nearly_straight():
    (straight,) = steady_curves(load_curve_scene(radius=[1e6]), "newton")
    assert abs(straight.unknowns[0]) < 2e-5
    assert abs(straight.unknowns[3]) < 1e-5


@pytest.mark.parametrize(
    ("old", "new", "key"),
    [
        ('kind = "rail"', 'kind = "rail"\ncurvature = 0.001', "track.curvature"),
        ("speed = 12.0", "speed = 0.0", "wheelset.speed"),
        ("radius = [600.0, 175.0]", "radius = [5.0]", "curve.radius"),
        ("pitch_inertia = 110.0", "pitch_inertia = -1.0", "curve.pitch_inertia"),
        ("yaw_stiffness = 5e6", "yaw_stifness = 5e6", "curve.yaw_stifness"),
        ("vertical_force = 120e3", "z = 0.0", "wheelset.z"),
        (
            "[track]",
            "time_step = 1e-3\n[motion]\nregime = 'transient_rolling'\n[track]",
            "motion.regime: value is 'transient_rolling', allowed 'steady_rolling'",
        ),
        ("[track]", "left.flat = { depth = 3e-4, angle = 0.0 }\n[track]", "wheelset.left.flat"),
        (
            "coefficient = 0.3",
            "coefficient = 0.3\nalong_track = [[-1, 0.5], [1, 1]]",
            "friction.along_track: given, allowed to be left out: a steady curve has one place",
        ),
    ],
)
def test_bad_scenes_are_refused(tmp_path, old, new, key):
    text = DEFAULT.read_text()
    assert text.count(old) == 1
    path = tmp_path / "curve.toml"
    path.write_text(text.replace(old, new))
    with pytest.raises(CaseError) as error:
        load_curve_scene(path)
    assert key in str(error.value)


def test_command():
    run = CliRunner().invoke(command, ["--radius", "600", "--json"])
    assert run.exit_code == 0
    rows = json.loads(run.output)
    assert rows["newton"][0]["radius"] == 600
    assert rows["newton"][0]["evaluations"] < rows["broyden"][0]["evaluations"]
    table = CliRunner().invoke(command, ["--radius", "600"])
    assert "newton 600 m" in table.output
