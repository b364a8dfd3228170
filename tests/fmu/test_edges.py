"""The FMU at its edges: no load, failed calls, the default step, discrete outputs, warnings."""

from __future__ import annotations

import ctypes as ct
import math
import re
import zipfile
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
import railpatch
from case_samples import PATCH, with_values
from click.testing import CliRunner
from fmu_scenes import LOADED, RAIL, SCENES, STEP, Packer
from railpatch.case import load_scene
from railpatch.fmu import pack_fmu
from railpatch.fmu.command import fmu as command
from slave import DISCARD, ERROR, OK, Fmu, Size, Slave

SPRINGS = {"stiffness": [2e7, 5e7], "damping": [1e4, 5e4]}
FORCED: dict[str, dict[str, Any]] = {
    "patch": SCENES["patch"],
    "line": SCENES["line"],
    "gap": SCENES["gap"],
    "fast": SCENES["fast"],
    "table": SCENES["table"],
    "hot": SCENES["hot"],
    "transient_patch": SCENES["transient_patch"],
    "loaded": LOADED,
    "one": {**LOADED, "kind": "wheel_rail"},
    "supported": with_values(LOADED, track__rail_support=SPRINGS, wheelset__time_step=STEP),
}
NO_CONTACT = 1
RAILS = ["UIC60@1:20", "60E1@1:40"]
WHEEL = ("normal_force", "approach", "contact_angle")


@pytest.fixture(scope="module")
def forced(tmp_path_factory: pytest.TempPathFactory) -> Callable[..., Fmu]:
    """FMUs of the scenes above."""
    return Packer(tmp_path_factory.mktemp("forced"), FORCED)


@pytest.mark.parametrize("name", FORCED)
def test_without_load_there_is_no_contact(name: str, forced: Callable[..., Fmu]) -> None:
    """At the start, in a step, and on the way back; forces are 0 then, and the load's after."""
    fmu = forced(name)
    load = "normal_force" if "normal_force" in fmu.names("input") else "wheelset.vertical_force"
    start = float(fmu.variables[load][0].attrib["start"])
    apart = re.compile(r"force\[|moment|power|energy|pressure|area|normal_force$")
    with Slave(fmu) as slave:
        assert slave.set({load: 0.0}) == OK, slave.log
        slave.initialize()
        for step, given in enumerate((0.0, start, 0.0, start)):
            assert slave.set({load: given}) == OK
            assert slave.step(step * STEP, STEP) == OK, slave.log
            found = slave.outputs()
            assert (found["status"] == NO_CONTACT) == (given == 0)
            if given == 0:
                assert {v for k, v in found.items() if apart.search(k)} == {0.0}
            elif name != "supported":  # whose dampers take a part of the load's rise
                vertical = found.get("normal_force", -found.get("force[3]", -start))
                assert vertical == pytest.approx(start, rel=1e-4)


def test_height_goes_on_to_that_without_load(forced: Callable[..., Fmu]) -> None:
    """z(F) - z(0) grows with F^(2/3), as Hertz's approach does."""
    with Slave(forced("one")).initialize() as slave:
        heights = []
        for step, load in enumerate((0.0, 100.0, 800.0)):
            assert slave.set({"wheelset.vertical_force": load}) == OK
            assert slave.step(step * STEP, STEP) == OK, slave.log
            heights += slave.get("z")
        none, light, heavy = heights
        assert light > none
        assert (heavy - none) / (light - none) == pytest.approx(4.0, rel=0.05)


def test_rails_on_springs_go_back_without_load() -> None:
    """Implicit Euler of k u + c du/dt = 0, each step."""
    contact = railpatch.Contact(FORCED["supported"])
    before = contact.step()["left"]["rail_deflection"]
    assert before[1] > 1e-5
    for _ in range(3):
        result = contact.step(vertical_force=0.0)
        assert result.status == "no_contact"
        found = result["left"]["rail_deflection"]
        for k in range(2):
            carried = SPRINGS["damping"][k] / STEP
            wanted = carried / (carried + SPRINGS["stiffness"][k]) * before[k]
            assert found[k] == pytest.approx(wanted, rel=1e-9, abs=1e-15)
        before = found


def test_a_force_without_load_is_beyond_friction(tmp_path: Path) -> None:
    fmu = Packer(tmp_path, SCENES)("prescribed_force")
    with Slave(fmu).initialize() as slave:
        state = slave.save()
        assert slave.set({"normal_force": 0.0}) == OK
        assert slave.step(0, STEP) == DISCARD
        assert "tangential_force" in slave.log[-1][2]
        assert slave.restore(state) == OK
        assert slave.set({"normal_force": 0.0, "tangential_force[1]": 0.0}) == OK
        assert slave.step(0, STEP) == OK, slave.log


@pytest.mark.parametrize("off", [None, b"logStatusDiscard", b"logAll"])
def test_why_a_step_failed_is_said_whatever_logging_is(
    off: bytes | None, unpacked: Callable[..., Fmu]
) -> None:
    with Slave(unpacked("frictionless"), logging=False).initialize() as slave:
        names = None if off is None else (ct.c_char_p * 1)(off)
        assert slave.call("SetDebugLogging", 0, Size(0 if off is None else 1), names) == OK
        assert slave.set({"wheelset.z": 0.02}) == OK
        assert slave.step(0, STEP) == DISCARD
        assert slave.step(0, STEP) == ERROR
        assert [line[:2] for line in slave.log] == [
            (DISCARD, "logStatusDiscard"),
            (ERROR, "logStatusError"),
        ]
    with Slave(unpacked("frictionless"), logging=False, guid="{other}") as slave:
        assert slave.component is None
        assert len(slave.log) == 1


def test_discrete_outputs_have_derivatives_of_0(unpacked: Callable[..., Fmu]) -> None:
    """So that a linearisation over all outputs is one call."""
    fmu = unpacked("rail")
    names, reals = fmu.names("output"), fmu.names("output", "Real")
    assert len(names) > len(reals)
    seeds = {"wheelset.y": 1e-4, "wheelset.vy": 1e-2}
    with Slave(fmu).initialize() as slave:
        status, found = slave.derivative(names, seeds)
        assert status == OK, slave.log
        of = dict(zip(names, found, strict=True))
        assert [of[n] for n in reals] == slave.derivative(reals, seeds)[1]
        assert {of[n] for n in names if n not in reals} == {0.0}


def test_the_largest_step_after_a_failed_one_is_that_before(tmp_path: Path) -> None:
    """Whether it was read before or not, and also where an earlier one was."""
    case = with_values(RAIL, method={"tolerance": 1e-9})
    fmu = Packer(tmp_path, {"a": case}, a={"largest_step": True})("a")
    found = []
    for read in (True, False):
        with Slave(fmu).initialize() as slave:
            assert slave.get("largest_step")[0] > 0
            assert slave.set({"wheelset.speed": 8.0, "wheelset.pitch_rate": -8.0 / 0.46}) == OK
            assert slave.step(0, STEP) == OK, slave.log
            if read:
                found.append(slave.get("largest_step")[0])
            outputs = fmu.names("output")
            outputs.remove("largest_step")
            before = slave.get(*outputs)
            assert slave.set({"wheelset.z": 0.02}) == OK
            assert slave.step(STEP, STEP) == DISCARD
            found.append(slave.get("largest_step")[0])
            assert slave.get(*outputs) == before
            assert slave.derivative(["force[3]"], {"wheelset.y": 1.0})[0] == DISCARD
    assert found == pytest.approx([found[0]] * 3, rel=1e-5)


def bounces(fmu: Fmu, step: float, mass: float) -> float:
    """Share of the steps without contact: a mass under its weight of 100 kN, 10 um too high."""
    lost, weight = 0, 1e5
    count = round(0.02 / step)
    with Slave(fmu).initialize() as slave:
        rest = slave.get("normal_force")[0]
        approach = float(fmu.variables["approach"][0].attrib["start"])
        assert rest == pytest.approx(weight, rel=0.01)
        place, speed = approach - 1e-5, 0.0
        for k in range(count):
            assert slave.set({"approach": place}) == OK
            assert slave.step(k * step, step) == OK, slave.log
            force, status = slave.get("normal_force", "status")
            lost += status == NO_CONTACT
            # exact under the force that is held
            acceleration = (weight - force) / mass
            place += speed * step + 0.5 * acceleration * step**2
            speed += acceleration * step
    return lost / count


def test_the_default_step_bears_what_a_millisecond_does_not(tmp_path: Path) -> None:
    """A wheel of 1300 kg on the height that is an input. Held forces take k h/4 of damping from its
    bounce, of which it has none here: it grows by exp(k h t/4m), little at the default step."""
    method = {"normal": "hertz", "tangential": "none"}
    curved = with_values(
        PATCH, geometry={"curvatures": [1.0, 1.5]}, motion=None, friction=None, method=method
    )
    approach = railpatch.Contact(curved).step()["approach"]
    case = with_values(curved, load={"approach": approach})
    fmu = Packer(tmp_path, {"drop": case})("drop")
    stiffness = 1.5 * 1e5 / approach
    wanted = 0.1 * math.sqrt(750.0 / stiffness)
    step = float(fmu.root.find("DefaultExperiment").attrib["stepSize"])
    assert 0.4 * wanted < step <= wanted
    assert f"{step:g} s" in (fmu.folder / "documentation" / "index.html").read_text()
    assert bounces(fmu, step, 1300.0) == 0
    assert bounces(fmu, 1e-3, 1300.0) > 0


@pytest.mark.parametrize(
    ("name", "speed"), [("patch", 10.0), ("left_wheel", 2.0), ("line", 10.0), ("patch_normal", 0.0)]
)
def test_the_default_step_is_of_the_scene(
    name: str, speed: float, unpacked: Callable[..., Fmu]
) -> None:
    """By the rule, from the FMU's own outputs; nothing is stiff where only a load comes in."""
    fmu = unpacked(name)
    step = float(fmu.root.find("DefaultExperiment").attrib["stepSize"])
    with Slave(fmu).initialize() as slave:
        at = "patch[1]." if name == "left_wheel" else ""
        [area] = slave.get(f"{at}contact_area")
        wanted = 1e-3
        if speed > 0:
            force = 4.5 * 82e9 * area / math.pi
            wanted = min(wanted, speed / force / (1 / 750.0 + 0.46**2 / 50.0))
        if at:
            load, approach, angle = slave.get(*(f"{at}{n}" for n in WHEEL))
            stiffness = 1.5 * load / approach * math.cos(angle) ** 2
            wanted = min(wanted, 0.1 * math.sqrt(750.0 / stiffness))
    assert 0.4 * wanted < step <= wanted


def test_profiles_that_touch_nothing_at_the_start_are_said(tmp_path: Path) -> None:
    """On the command line, in what packing gives, and on the FMU's page."""
    kind = Path(railpatch.__file__).parent / "fmu" / "kinds" / "wheel.toml"
    case = tmp_path / "case.toml"
    case.write_text(kind.read_text())
    further = ["--rail-profile", "UIC60@1:20", "--quiet"]
    ran = CliRunner().invoke(command, [str(case), "-o", str(tmp_path / "a.fmu"), *further])
    text = "case with profiles.rail = 'UIC60@1:20': no contact at the start values"
    assert (ran.exit_code, ran.stdout) == (0, "")
    assert ran.stderr == f"warning: {text}\n"
    packed = pack_fmu(load_scene(case), tmp_path / "b.fmu", name="case", rail_profiles=RAILS)
    assert packed.warnings == (text,)
    page = zipfile.ZipFile(packed).read("documentation/index.html").decode()
    assert "no contact at the start values" in page
    packed = pack_fmu(load_scene(LOADED), tmp_path / "c.fmu", rail_profiles=RAILS)
    assert packed.warnings == ()


@pytest.mark.parametrize("kind", ["wheel", "wheelset_rail"])
def test_a_start_that_touches_nothing_is_said(tmp_path: Path, kind: str) -> None:
    """10 mm above the rails, of the wheel and of both wheels."""
    file = Path(railpatch.__file__).parent / "fmu" / "kinds" / f"{kind}.toml"
    case = tmp_path / "case.toml"
    case.write_text(re.sub(r"(?m)^(z|vertical_force) = .*", "z = -0.01", file.read_text()))
    packed = pack_fmu(load_scene(case), tmp_path / "a.fmu", name="case")
    assert packed.warnings == ("case: no contact at the start values",)
