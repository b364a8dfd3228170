"""What can hardly be meant is solved with a warning, and what is not solved says why."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
import railpatch
import tomli_w
from bits.combinations import sample
from case_samples import PATCH, WHEELSET, with_values
from click.testing import CliRunner
from numpy.typing import NDArray
from railpatch.case.kinds import kinds, write_example
from railpatch.command.cli import cli
from railpatch.evidence.continuity.worn import (
    CLOSE,
    LIMIT,
    LOAD,
    SPAN,
    Found,
    Walk,
    worn_case,
)

from wheelset_demo.vehicle.plausible import doubtful_bodies
from wheelset_demo.vehicle.scene import load_vehicle_scene

LOADED = with_values(WHEELSET, wheelset__z=None, wheelset__vertical_force=1.2e5)
STILL = {"grid__element_size": [1e-3, 1e-3]}
YIELD, CELSIUS = "layer: a yield stress", "-60 to 250 degrees C"
FILM = {"model": "film", "roughness": 1e-6}
WATER = {**FILM, "liquid": "water"}


def yielding(**keys: Any) -> dict[str, Any]:
    """The patch with a plastic layer."""
    return with_values(PATCH, layer={"shear_modulus": 8.2e9, "thickness": 2e-5, **keys})


def oil(**keys: Any) -> dict[str, Any]:
    """The patch with oil."""
    return with_values(PATCH, fluid={**FILM, "liquid": "oil", "viscosity": 0.1, **keys})


def falling(**keys: Any) -> dict[str, Any]:
    """The patch with friction that falls with the speed of slip."""
    law = {"law": "slip_velocity", "kinetic": 0.1, "amplitude": 0.2, "halving_speed": 1.0}
    return with_values(PATCH, friction={**law, **keys})


def stored(air: float) -> dict[str, Any]:
    """A wheelset whose wheels are warmed, in air of so many degrees C."""
    bulk = {"mass": [0.5, 2.0], "air_conductance": [3.0, 1.0], "air_temperature": air}
    heat = {"wheel": 20.0, "rail": 20.0, "bulk": bulk}
    return with_values(LOADED, temperature=heat, wheelset__time_step=1e-3, **STILL)


def sphere(unit: float) -> NDArray[np.float64]:
    """Undeformed distance of a wheel of 0.46 m, 16 x 16 elements of 1 mm. unit: in a metre."""
    x = 1e-3 * (np.arange(16) - 7.5)
    return unit * (x**2 + x[:, None] ** 2) / (2 * 0.46)


# what was meant -> the case, and words of what is said
MISTAKES: dict[str, tuple[dict[str, Any], str]] = {
    "GPa as Pa": (with_values(PATCH, material={"shear_modulus": 82.0}), "shear_modulus"),
    "MPa as Pa": (with_values(PATCH, material={"shear_modulus": 82e3}), "shear_modulus"),
    "kN as N": (with_values(LOADED, wheelset__vertical_force=120.0), "normal force"),
    "t as N": (with_values(PATCH, load={"normal_force": 10.0}), "normal force"),
    "vehicle's load on one wheel": (with_values(PATCH, load={"normal_force": 6e5}), "500 kN"),
    "a wheel on a needle": (
        with_values(PATCH, geometry={"semi_axes": [1e-3, 1e-3]}, load={"normal_force": 3e4}),
        "5 GPa",
    ),
    "a soft cushion": (
        with_values(PATCH, geometry={"semi_axes": [2e-2, 2e-2]}, load={"normal_force": 2e3}),
        "10 MPa",
    ),
    "a line contact wider than its body": (
        # Hertz: half-width sqrt(4 F' R/(pi E*)) with E* = G/(1 - nu), 0.77 m on a radius of 0.16 m
        with_values(
            PATCH,
            geometry={"line_contact_radius": 0.16, "width": 0.1},
            material={"shear_modulus": 2.47e5},
            grid={"elements": [24, 1]},
        ),
        "wider than a circle of 60 mm",
    ),
    "a line contact's width in mm": (
        with_values(
            PATCH,
            geometry={"line_contact_radius": 0.46, "width": 10.0},
            load={"normal_force": 1e7},
            grid={"elements": [24, 1]},
        ),
        "geometry.width is 10 m",
    ),
    "undeformed distances in mm": (
        with_values(
            PATCH,
            geometry={"undeformed_distance": sphere(1e3).tolist()},
            grid={"element_size": [1e-3, 1e-3]},
        ),
        "distances are in m",
    ),
    "creepage in per cent": (with_values(PATCH, motion__creepage=[0.3, 0.0]), "creepage"),
    "creepage in per mille": (with_values(PATCH, motion__creepage=[0.0, 2.0]), "creepage"),
    "pitch rate of the other sign": (with_values(LOADED, wheelset__pitch_rate=4.35), "pitch_rate"),
    "pitch rate left at 0": (with_values(LOADED, wheelset__pitch_rate=0.0), "pitch_rate"),
    "rolling backwards": (with_values(LOADED, wheelset__speed=-2.0), "pitch_rate"),
    "y without roll": (with_values(LOADED, wheelset__y=3e-3, **STILL), "one wheel"),
    "y in cm": (with_values(LOADED, wheelset__y=0.05, **STILL), "25 mm"),
    "radius in dm": (with_values(LOADED, wheelset__nominal_radius=4.6), "radius"),
    "radius of a toy": (with_values(LOADED, wheelset__nominal_radius=0.046), "radius"),
    "friction in per cent": (with_values(PATCH, friction__coefficient=3.0), "friction"),
    "layer in mm": (
        with_values(PATCH, layer={"shear_modulus": 6e9, "thickness": 0.02}),
        "layer",
    ),
    "a shift in mm": (
        with_values(PATCH, motion={"regime": "shift", "creepage": [0.02, 0.0]}),
        "above 1 mm",
    ),
    "a step in mm": (
        with_values(
            PATCH,
            motion={
                "regime": "transient_rolling",
                "distance": 0.5,
                "creepage": [1e-3, 0.0],
                "rolling_speed": 20.0,
            },
        ),
        "longer than 100 mm",
    ),
    "a wheel's time step in ms": (
        with_values(
            LOADED,
            motion={"regime": "transient_rolling"},
            wheelset__time_step=1.0,
            wheelset__speed=20.0,
            wheelset__pitch_rate=-20.0 / 0.46,
        ),
        "longer than 100 mm",
    ),
    "speed in mm/s": (
        with_values(LOADED, wheelset__speed=2e4, wheelset__pitch_rate=-2e4 / 0.46),
        "200 m/s",
    ),
    "radii in place of curvatures": (
        with_values(PATCH, geometry={"curvatures": [0.02, 0.03]}),
        "2 mm to 20 m",
    ),
    "radii in mm": (
        with_values(PATCH, geometry={"curvatures": [600.0, 600.0]}, load__normal_force=500.0),
        "2 mm to 20 m",
    ),
    "a grid of 6 x 6": (with_values(PATCH, grid={"elements": [6, 6]}), "8 elements"),
    "a layer's yield stress in MPa": (yielding(yield_stress=50.0), YIELD),
    "a layer's hardening in N/mm^3": (yielding(yield_stress=5e7, hardening=1e3), YIELD),
    "a layer's softening in N/mm^3": (yielding(yield_stress=5e7, hardening=-2.0), YIELD),
    "a hardening table in MPa": (yielding(hardening_table=[[0.0, 50.0], [1e-5, 60.0]]), YIELD),
    "a hardening table in mm": (yielding(hardening_table=[[0.0, 5e7], [0.2, 6e7]]), YIELD),
    "wheel in K": (with_values(PATCH, temperature={"wheel": 293.0, "rail": 20.0}), CELSIUS),
    "rail in K": (with_values(PATCH, temperature={"wheel": 20.0, "rail": 293.0}), CELSIUS),
    "air in K": (stored(290.0), CELSIUS),
    "an oil's reference in K": (oil(reference_temperature=313.0), CELSIUS),
    "a table of viscosities in K": (
        with_values(
            PATCH,
            fluid={
                **FILM,
                "boundary_friction": 0.2,
                "viscosity_table": [[293.0, 0.3], [333.0, 0.05]],
            },
        ),
        CELSIUS,
    ),
    "a supply in l/s": (with_values(PATCH, fluid={**WATER, "water_rate": 0.025}), "water_rate"),
    "a viscosity in mPa s, little": (
        with_values(PATCH, fluid={**FILM, "viscosity": 1.0, "boundary_friction": 0.15}),
        "effective_friction",
    ),
    "a roughness of a thousandth": (
        with_values(PATCH, fluid={**WATER, "roughness": 1e-9}),
        "effective_friction",
    ),
    "an oil's film in mm": (oil(oil_film=1e-3), "oil_film"),
    "a roughness in mm": (oil(roughness=5e-4), "roughness is above"),
    "a viscosity in mPa s": (oil(viscosity=200.0), "100 Pa s"),
    "a kinematic viscosity": (oil(viscosity=1e-5), "100 Pa s"),
    "a table of viscosities in m^2/s": (
        with_values(
            PATCH,
            fluid={
                **FILM,
                "boundary_friction": 0.2,
                "viscosity_table": [[20.0, 3e-4], [60.0, 5e-5]],
            },
        ),
        "100 Pa s",
    ),
    "a boundary friction in per cent": (oil(boundary_friction=0.9), "boundary_friction above"),
    "an oil's shear stress in MPa": (oil(eyring_stress=5.0), "eyring_stress"),
    "the bodies' hardness in kPa": (
        oil(share="load_sharing", hardness=2.8e6, mean_pressure="contact"),
        "hardness",
    ),
    "a mean pressure in kPa": (oil(share="load_sharing", mean_pressure=6e5), "mean_pressure"),
    "a halving speed in mm/s": (falling(halving_speed=400.0), "halving_speed"),
    "the second halving speed in mm/s": (
        falling(amplitude=[0.1, 0.1], halving_speed=[0.4, 400.0]),
        "halving_speed",
    ),
    "a memory in mm": (falling(memory_distance=0.1), "memory_distance"),
    "a depth in mm": (with_values(PATCH, subsurface={"depths": [1e-3, 1.0]}), "in m"),
    "a point's depth in mm": (
        with_values(PATCH, subsurface={"depths": [1e-3], "points": [[0.0, 0.0, 0.5]]}),
        "subsurface.points",
    ),
}
# what lies just within the ranges, and published numbers: none is doubted
WITHIN: dict[str, dict[str, Any]] = {
    "undeformed distances": with_values(
        PATCH,
        geometry={"undeformed_distance": sphere(1.0).tolist()},
        grid={"element_size": [1e-3, 1e-3]},
    ),
    "a soft layer": yielding(yield_stress=1e4, hardening=-1e7),
    "a steel's layer": yielding(yield_stress=1e10, hardening=1.23e14),
    "a table": yielding(hardening_table=[[0.0, 1e8], [1e-6, 1.5e8], [1e-3, 2e8]]),
    "a brake's heat": with_values(PATCH, temperature={"wheel": 250.0, "rail": -60.0}),
    "frost": stored(-60.0),
    "oil": oil(reference_temperature=100.0, temperature=-20.0),
    "rain": with_values(PATCH, fluid={**WATER, "water_rate": 1e-3}),
    "a thick film": oil(oil_film=5e-4),
    "a rough paste": oil(roughness=5e-5, viscosity=100.0, eyring_stress=1e5),
    "a liquid without shear": oil(viscosity=1e-4, eyring_stress=0.0),
    "water at 360 km/h": with_values(
        PATCH, fluid={**WATER, "roughness": 0.5765e-6}, motion__rolling_speed=100.0
    ),
    "Polach's law": with_values(
        PATCH,
        friction={
            "law": "slip_velocity",
            "shape": "polach",
            "coefficient": 0.55,
            "polach_a": 0.4,
            "polach_b": 0.6,
        },
    ),
    "a memory": falling(halving_speed=1e-5, memory_distance=0.02),
    "below": with_values(PATCH, subsurface={"depths": [0.0, 0.05]}),
}
# the condition -> the case, its status and a word of the reason
UNSOLVED: dict[str, tuple[dict[str, Any], str, str]] = {
    "normal": (
        with_values(PATCH, geometry={"curvatures": [1.0, 1.5]}, method={"max_iterations": 1}),
        "not_converged",
        "normal problem",
    ),
    "tractions": (
        with_values(PATCH, method={"normal": "hertz", "max_iterations": 1}),
        "not_converged",
        "tractions",
    ),
    "border": (
        with_values(PATCH, geometry={"curvatures": [1.0, 1.5]}, grid={"element_size": [5e-4, 5e-4],
                    "max_elements": [8, 8]}),
        "out_of_range",
        "grid",
    ),
    "linear": (
        with_values(PATCH, method={"tangential": "linear"}, motion__creepage=[0.01, 0.0]),
        "out_of_range",
        "linear",
    ),
    "side by side": (with_values(LOADED, wheelset__y=0.3), "out_of_range", "track.gauge"),
    "too deep": (
        with_values(LOADED, wheelset__vertical_force=1e9, **STILL), "out_of_range", "within reach"
    ),
    "accuracy": (
        with_values(
            PATCH,
            grid=None,
            method={"normal": "hertz", "tangential": "fastsim", "accuracy": 0.09},
            geometry={"semi_axes": [9e-3, 1.2e-3]},
            load={"normal_force": 5e4},
            friction={"coefficient": 0.58},
            motion__creepage=[1e-3, 1e-3],
            motion__spin_creepage=2.0,
        ),
        "accuracy_not_met",
        "estimate",
    ),
}  # fmt: skip


@pytest.mark.parametrize("name", MISTAKES)
def test_a_mistake_is_warned_of(name: str) -> None:
    case, words = MISTAKES[name]
    result = railpatch.solve(case)
    assert any(words in text for text in result.warnings), result.warnings
    assert result.to_dict()["warnings"] == result.warnings
    with pytest.raises(railpatch.CaseError, match=words):
        railpatch.solve(case, strict=True)


@pytest.mark.parametrize("name", ["a line contact's width in mm", "undeformed distances in mm"])
def test_a_contact_and_explain_tell_doubts_of_the_case(name: str, tmp_path: Path) -> None:
    """Which no step's result has, so that a step pays nothing for them."""
    case, words = MISTAKES[name]
    contact = railpatch.Contact(case)
    (doubt,) = contact.doubts()
    assert words in doubt
    assert doubt not in contact.step().warnings
    file = tmp_path / "case.toml"
    file.write_text(tomli_w.dumps(case))
    ran = CliRunner().invoke(cli, ["explain", str(file)])
    assert ran.exit_code == 0
    assert f"warning: {doubt}" in ran.stderr
    assert CliRunner().invoke(cli, ["explain", "--quiet", str(file)]).stderr == ""
    strict = CliRunner().invoke(cli, ["explain", "--strict", str(file)])
    assert strict.exit_code == 2
    assert words in strict.stderr
    assert railpatch.Contact(PATCH).doubts() == []


def test_other_heights_are_warned_of() -> None:
    # a worn flange whose two contacts become one: more depth carries less
    case = worn_case(41, "hertz")
    free = with_values(case, wheelset__vertical_force=None, wheelset__z=0.0)
    above, below = railpatch.Contact(case), railpatch.Contact(free)
    for y, several in ((10.1022e-3, True), (0.0, False)):
        found = above.step(y=y)
        depths = [below.step(y=y, z=found["z"] + 1e-5 * i)["force"][2] for i in range(1, 16)]
        assert (max(depths) > -LOAD) == several  # z down: less than the load
        assert any("other heights" in text for text in found.warnings) == several


def test_a_step_across_a_jump_is_warned_of() -> None:
    walk, found = Walk(worn_case(47, "hertz")), Found("hertz")
    steps = [y for y in np.linspace(*SPAN, 500).tolist() if 9.2e-3 < y < 9.5e-3]
    ((before, after),) = walk.jumps(steps, found)
    assert walk.change(before, after) > LIMIT
    assert after.y - before.y < CLOSE
    assert before.warned or after.warned
    # beside it steps are none
    for y in (before.y - 1e-6, after.y + 1e-6):
        assert walk.change(walk.sample(y), walk.sample(y + CLOSE)) < LIMIT


def test_no_step_over_a_short_fall_goes_unsaid() -> None:
    """From a second contact's first touch on the force all but falls over some 15 nm: heights go
    over it evenly, or the step that crosses it says so (tests/cpp/test_force_samples.cpp)."""
    walk, found = Walk(worn_case(227, "kik_piotrowski_corrected")), Found("")
    steps = [y for y in np.linspace(*SPAN, 500).tolist() if 10.1e-3 < y < 10.4e-3]
    for before, after in walk.jumps(steps, found):
        assert before.warned or after.warned, (before, after)
    assert found.positions == len(steps)
    assert found.unsolved == 0
    # steps before it have none
    assert not any(walk.sample(y).warned for y in steps[:3])


def test_two_new_ends_of_a_row_move_no_force() -> None:
    """Where a row of contact parts in two its integrals take other rules, which all but agree."""
    walk, found = Walk(worn_case(11, "kik_piotrowski")), Found("")
    steps = [y for y in np.linspace(*SPAN, 500).tolist() if 9.9e-3 < y < 10.2e-3]
    assert list(walk.jumps(steps, found)) == []
    assert found.positions == len(steps)
    assert found.unsolved == 0


def test_a_fall_while_two_contacts_join_is_warned_of() -> None:
    """70 nm above the height found another one carries the load, where a contact is about to appear
    whose joint patch with the first one carries less."""
    case = worn_case(12, "kik_piotrowski_corrected")
    free = with_values(case, wheelset__vertical_force=None, wheelset__z=0.0)
    above, below = railpatch.Contact(case), railpatch.Contact(free)
    for y, several in ((3.20604e-3, True), (3.0e-3, False)):
        found = above.step(y=y)
        depths = [below.step(y=y, z=found["z"] - 5e-9 * i)["force"][2] for i in range(1, 16)]
        assert (min(depths) < -LOAD) == several
        assert any("other heights" in text for text in found.warnings) == several


@pytest.mark.parametrize("name", WITHIN)
def test_what_may_be_meant_has_none(name: str) -> None:
    result = railpatch.solve(WITHIN[name])
    words = (YIELD, CELSIUS, "water_rate", "halving_speed", "subsurface")
    assert [text for text in result.warnings if any(word in text for word in words)] == []


@pytest.mark.parametrize(
    ("case", "values", "words"),
    [
        (
            with_values(PATCH, temperature={"wheel": 20.0, "rail": 20.0}),
            {"temperature": {"wheel": 293.0, "rail": 293.0}},
            CELSIUS,
        ),
        (oil(temperature=20.0), {"water_temperature": 293.0}, CELSIUS),
        (with_values(PATCH, fluid={**WATER, "water_rate": 1e-7}), {"water_rate": 0.025}, "1 l/s"),
        (oil(oil_film=1e-6), {"oil_film": 1e-3}, "oil_film"),
    ],
)
def test_a_step_in_another_unit(case: dict[str, Any], values: dict[str, Any], words: str) -> None:
    """Of what moves, the step is doubted that has it, and no other."""
    contact = railpatch.Contact(case)
    assert contact.step().warnings == []
    assert any(words in text for text in contact.step(**values).warnings)


@pytest.mark.parametrize(
    ("damage", "key"),
    [
        ({"shear_yield": 300.0}, "damage.shear_yield: value is 300.0, allowed >= 1000000"),
        (
            {"wear": "archard", "hardness": 300.0},
            "damage.hardness: value is 300.0, allowed >= 1000000",
        ),
    ],
)
def test_stresses_of_no_metal_are_refused(damage: dict[str, Any], key: str) -> None:
    """MPa, and numbers of Brinell's scale."""
    with pytest.raises(railpatch.CaseError) as caught:
        railpatch.solve(with_values(PATCH, damage=damage))
    assert str(caught.value).startswith(key)


def test_correct_patches_have_none() -> None:
    """Of every method, regime and law, on grids that are as fine as a user's."""
    solved = 0
    for name, case in sample(0):
        if case["kind"] != "patch":
            continue
        own = "elements" in case.get("grid", {})
        fine = with_values(case, grid__elements=[10, 10]) if own else case
        try:
            result = railpatch.solve(fine)
        except railpatch.CaseError:
            continue
        solved += result.solved
        assert not result.solved or result.warnings == [], name
    assert solved > 25


@pytest.mark.parametrize("y", [0.0, 1.5e-3, -3e-3, 4.5e-3])
def test_correct_wheelsets_have_none(y: float) -> None:
    free = {"wheelset__roll": "balanced", "wheelset__pitch_rate": "free"}
    result = railpatch.solve(with_values(LOADED, wheelset__y=y, **free))
    assert (result.status, result.warnings) == ("converged", [])


@pytest.mark.parametrize("kind", sorted(kinds()))
def test_packaged_scenes_have_none(kind: str, tmp_path: Path) -> None:
    quick = {
        "rig": ["--positions", "3", "-o", str(tmp_path / "a.mcap")],
        "wheelset_run": ["--distance", "0.2", "-o", str(tmp_path / "b.mcap")],
        "vehicle": ["--duration", "0.01", "--method", "fastsim"],
        "sweep": ["-o", str(tmp_path / "result")],
    }
    scene = kinds()[kind]
    command = scene.command.split()
    written = write_example(scene, tmp_path / "scene")
    arguments = [str(written[0]) if word == "SCENE" else word for word in command[1:]]
    ran = CliRunner().invoke(cli, [arguments[0], arguments[1], *quick.get(kind, []), "--strict"])
    assert ran.exit_code == 0, ran.output
    assert "warning" not in ran.stderr


def test_a_command_warns_and_strict_refuses(tmp_path: Path) -> None:
    path = tmp_path / "case.toml"
    path.write_text(
        'kind = "patch"\n[geometry]\nsemi_axes = [0.006, 0.006]\n[load]\nnormal_force = 10.0\n'
        "[friction]\ncoefficient = 0.3\n[motion]\ncreepage = [0.001, 0.0]\n"
        "[grid]\nelements = [12, 12]\n"
    )
    ran = CliRunner().invoke(cli, ["solve", str(path)])
    assert ran.exit_code == 0
    assert "warning: a normal force is outside 100 N to 500 kN" in ran.stderr
    ran = CliRunner().invoke(cli, ["solve", str(path), "--strict"])
    assert ran.exit_code == 2
    assert "100 N to 500 kN" in ran.stderr


@pytest.mark.parametrize(
    ("x", "end", "words"),
    [
        (0.5, 1.0, ""),
        (-8.0, 1.0, ""),
        (500.0, 1.0, "wheelset.x is 500 m, 499 m off track.right.sections at 0 to 1 m"),
        (0.5, 1000.0, "track.right.sections: two neighbours lie 1000 m apart: positions are in m"),
    ],
)
def test_slices_along_a_rail(x: float, end: float, words: str) -> None:
    """Places in mm: between slices, or of the wheel beside them."""
    places = [{"position": at, "profile": "UIC60@1:40"} for at in (0.0, end)]
    case = with_values(LOADED, wheelset__x=x, track__right={"sections": places})
    found = railpatch.solve(case).warnings
    assert [text for text in found if "sections" in text] == ([] if not words else [found[-1]])
    assert words in "".join(found)


@pytest.mark.parametrize(("y", "told"), [(0.7175, False), (-0.7175, True)])
def test_a_rail_on_the_other_side(y: float, told: bool) -> None:
    case = with_values(LOADED, track__right={"origin": [y, 0.0]})
    said = [text for text in railpatch.Contact(case).doubts() if "origin" in text]
    assert bool(said) == told
    assert not told or said == [
        "track.right.origin[0] is -0.7175 m, on the other side of the track: y is to the right, "
        "> 0 of the right rail"
    ]


@pytest.mark.parametrize(("coefficient", "scale", "told"), [(0.6, 2.0, 1), (1.2, 0.5, 0)])
def test_friction_of_a_step(coefficient: float, scale: float, told: int) -> None:
    """By the coefficient with the step's own factor."""
    case = with_values(PATCH, friction__coefficient=coefficient)
    contact = railpatch.Contact(case)
    found = contact.step(friction_scale=[scale, scale]).warnings
    assert sum("friction is above 1" in text for text in found) == told


def test_bodies_of_a_vehicle() -> None:
    vehicle = load_vehicle_scene(None, {}).vehicle
    assert doubtful_bodies(vehicle) == []
    light = vehicle.body[0].model_copy(update={"mass": 32.0})
    changed = vehicle.model_copy(update={"body": [light, *vehicle.body[1:]]})
    text = doubtful_bodies(changed)[0]
    assert "vehicle.car_body.mass is 32 kg" in text


@pytest.mark.parametrize("name", UNSOLVED)
def test_what_is_not_solved_says_why(name: str) -> None:
    case, status, words = UNSOLVED[name]
    result = railpatch.solve(case)
    assert result.status == status
    assert result.reason is not None
    assert words in result.reason
    assert result.to_dict()["reason"] == result.reason


def test_what_is_solved_has_no_reason() -> None:
    result = railpatch.solve(LOADED)
    assert (result.status, result.reason) == ("converged", None)
    for side in ("left", "right"):
        assert result[side]["reason"] is None
        assert [patch["reason"] for patch in result[side]["patches"]] == [None]


def test_a_dry_contact_as_slippery_says_nothing_of_its_liquid() -> None:
    """Asperities that hardly rub are not a liquid that carries all."""
    fluid = {**FILM, "viscosity": 1e-3, "boundary_friction": 8e-4}
    case = with_values(PATCH, fluid=fluid, friction__coefficient=8e-4)
    found = railpatch.solve(case)
    assert 0 < found["effective_friction"] < 1e-3
    assert not [text for text in found["warnings"] if "effective_friction" in text]
