"""Contact frames that follow a roller's surface along x: bodies of revolution without friction have
no moment about their axes, and what friction turns into heat is what the bodies supply."""

from __future__ import annotations

from math import cos, sin

import numpy as np
import pytest
import railpatch

RADIUS, ROLLER = 0.3556, 0.8001
LOAD = 67e3


def case(frame: str, **method: object) -> dict:
    """One wheel on a roller of the rig's size, yawed."""
    return {
        "kind": "wheel_rail",
        "wheelset": {
            "vertical_force": LOAD,
            "yaw": 0.018,
            "y": 0.002,
            "pitch_rate": -12.562,
            "nominal_radius": RADIUS,
            "flange_back_distance": 1.575,
        },
        "track": {"kind": "roller", "roller_radius": ROLLER, "roller_pitch_rate": 5.587302},
        "profiles": {"wheel": "cone@1:20", "rail": "arc@0.3"},
        "grid": {"element_size": [4e-4, 4e-4]},
        **({} if method.get("tangential") == "none" else {"friction": {"coefficient": 0.5}}),
        "method": {"contact_frame": frame, "tolerance": 1e-8, **method},
    }


def moment_about(result: railpatch.Result, point: list[float], axis: list[float]) -> float:
    """N m, of the force on the wheel about a line; moments are about the wheelset's centre."""
    centre = np.array([0.0, 0.002, result["z"] - RADIUS])
    force, moment = np.array(result["force"]), np.array(result["moment"])
    return float((moment + np.cross(centre - point, force)) @ axis)


def test_pressure_turns_neither_roller_nor_wheel() -> None:
    left_out = railpatch.solve(case("track", tangential="none", patch_rule="contact"))
    along = railpatch.solve(case("track", tangential="none"))
    whole = railpatch.solve(case("inclined", tangential="none"))
    # some 0.018 rad * 0.7 m * R/(R + r) ahead of the top: the lever that the track's frame leaves
    lever = abs(whole["patches"][0]["position"][0])
    assert lever > 0.008
    roller = [0.0, 0.0, ROLLER], [0.0, 1.0, 0.0]
    assert abs(moment_about(left_out, *roller)) > 0.9 * LOAD * lever
    # to the patch's own breadth and the rounding of element sums
    for result in (whole, along):
        assert abs(moment_about(result, *roller)) < 1e-3 * LOAD * lever
    axle = [0.0, 0.002, whole["z"] - RADIUS], [-sin(0.018), cos(0.018), 0.0]
    assert abs(moment_about(whole, *axle)) < 1e-3 * LOAD * lever
    # pressure acts along the roller's normals in either frame
    np.testing.assert_allclose(along["force"], whole["force"], atol=1e-4 * LOAD)
    assert whole["force"][0] == pytest.approx(
        LOAD * whole["patches"][0]["position"][0] / ROLLER, rel=0.03
    )


@pytest.mark.parametrize("frame", ["track", "inclined"])
def test_friction_takes_what_the_bodies_supply(frame: str) -> None:
    """In either frame, since the levers on both bodies are in the ratio of their rates; what is
    left is the load by what the contact reference is off the centre of pressure."""
    result = railpatch.solve(case(frame))
    (patch,) = result["patches"]
    axle = [0.0, 0.002, result["z"] - RADIUS], [-sin(0.018), cos(0.018), 0.0]
    roller = [0.0, 0.0, ROLLER], [0.0, 1.0, 0.0]
    # the contact acts on the roller with the opposite sign
    supplied = 12.562 * moment_about(result, *axle) + 5.587302 * moment_about(result, *roller)
    assert supplied == pytest.approx(patch["friction_power"], rel=5e-3)


def test_on_the_top_both_frames_are_one() -> None:
    straight = [case(frame) for frame in ("track", "inclined")]
    for item in straight:
        item["wheelset"]["yaw"] = 0.0
    track, inclined = (railpatch.solve(item) for item in straight)
    np.testing.assert_allclose(inclined["force"], track["force"], rtol=1e-12, atol=1e-6)


def test_mirror_image() -> None:
    right = railpatch.solve(case("inclined"))
    mirrored = case("inclined")
    mirrored["wheel"] = {"side": "left"}
    mirrored["wheelset"] |= {"yaw": -0.018, "y": -0.002}
    left = railpatch.solve(mirrored)
    np.testing.assert_allclose(left["force"], np.array(right["force"]) * [1, -1, 1], rtol=1e-12)
    np.testing.assert_allclose(left["moment"], np.array(right["moment"]) * [-1, 1, -1], rtol=1e-12)


def test_refused_on_rails() -> None:
    wrong = case("inclined")
    wrong["track"] = {"kind": "rail"}
    with pytest.raises(railpatch.CaseError, match="contact_frame"):
        railpatch.solve(wrong)
