"""What is chosen when an FMU is packed: outputs, friction as an input, number of patches."""

from __future__ import annotations

import zipfile
from pathlib import Path
from typing import Any

import pytest
from case_samples import PATCH, with_values
from fmpy.validation import validate_fmu
from fmu_scenes import OWN, RAIL, SCENES, STEP
from railpatch.case import load_scene
from railpatch.errors import CaseError
from railpatch.fmu import pack_fmu
from slave import ERROR, OK, Fmu, Slave
from slave3 import Fmu3, Slave3


def packed(folder: Path, case: dict[str, Any], **options: Any) -> Fmu | Fmu3:
    """The FMU of a case, valid, unpacked and loaded."""
    folder.mkdir(exist_ok=True)
    path = folder / "chosen.fmu"
    pack_fmu(load_scene(case), path, backend=OWN, **options)
    assert validate_fmu(str(path)) == []
    zipfile.ZipFile(path).extractall(path.with_suffix(""))
    return (Fmu3 if options.get("fmi") == 3 else Fmu)(path.with_suffix(""))


def test_outputs_by_names_groups_and_patterns(tmp_path: Path) -> None:
    asked = ["force[3]", "left.patch[1].creep_force", "power"]
    fmu = packed(tmp_path, RAIL, outputs=asked)
    names = fmu.names("output")
    assert {"status", "force[3]", "left.patch[1].creep_force[2]", "left.friction_power"} <= set(
        names
    )
    assert not {"force[1]", "left.patch[2].creep_force[1]", "left.moment[1]"} & set(names)
    with Slave(fmu).initialize() as slave:
        assert slave.step(0.0, STEP) == OK
        assert slave.get("force[3]")[0] < 0
        assert slave.derivative(["force[3]"], {"wheelset.y": 1.0})[0] == OK


def test_a_mean_brings_what_it_is_the_mean_of(tmp_path: Path) -> None:
    fmu = packed(tmp_path, RAIL, outputs=["mean_force"], averages=True)
    assert {"mean_force[3]", "force[3]"} <= set(fmu.names("output"))
    with Slave(fmu).initialize() as slave:
        assert slave.step(0.0, STEP) == OK
        assert slave.get("mean_force[3]") == slave.get("force[3]")


def test_patches_are_as_many_as_asked(tmp_path: Path) -> None:
    fmu = packed(tmp_path, SCENES["patches"], patches=2)
    patches = {n.split(".")[0] for n in fmu.names("output") if n.startswith("patch[")}
    assert patches == {"patch[1]", "patch[2]"}


@pytest.mark.parametrize("fmi", [2, 3])
def test_friction_as_an_input_gives_the_numbers_of_the_parameter(fmi: int, tmp_path: Path) -> None:
    fmu = packed(tmp_path, PATCH, inputs=["friction"], fmi=fmi)
    assert "friction.coefficient" in fmu.names("input")
    assert "friction.coefficient" not in fmu.names("parameter")
    (tmp_path / "plain").mkdir()
    plain = packed(tmp_path / "plain", with_values(PATCH, friction__coefficient=0.17))
    with Slave(plain).initialize() as other:
        wanted = other.outputs()
    if fmi == 3:
        with Slave3(fmu, exchange=True).initialize() as model:
            assert model.call("EnterContinuousTimeMode") == OK
            assert model.set("friction.coefficient", 0.17) == OK
            found = model.outputs()
    else:
        with Slave(fmu, exchange=True).initialize() as model:
            assert model.call("EnterContinuousTimeMode") == OK
            assert model.set({"friction.coefficient": 0.17}) == OK
            found = model.outputs()
        with Slave(fmu).initialize() as slave:
            # it moves in a step as any input
            assert slave.set_derivatives({"friction.coefficient": 10.0}) == OK
            assert slave.step(0.0, STEP) == OK
            assert slave.get("friction.coefficient") == [pytest.approx(0.31)]
            assert slave.set({"friction.coefficient": 11.0}) == ERROR
    assert found["creep_force[1]"] == pytest.approx(wanted["creep_force[1]"], rel=1e-4)


@pytest.mark.parametrize(
    ("options", "why"),
    [
        ({"outputs": ["colour"]}, "'colour', which no output of this scene is"),
        ({"inputs": ["load"]}, "--inputs: value is 'load', allowed friction"),
        ({"patches": 0}, "--patches: value is 0, allowed 1 ... 6"),
    ],
)
def test_what_cannot_be_chosen_is_refused(options: Any, why: str, tmp_path: Path) -> None:
    with pytest.raises(CaseError) as caught:
        pack_fmu(load_scene(RAIL), tmp_path / "a.fmu", backend=OWN, **options)
    assert why in str(caught.value)
    assert not list(tmp_path.iterdir())


def test_friction_of_each_wheel_is_that_of_a_scene_with_it(tmp_path: Path) -> None:
    """As an input, of a wheelset: the same bits as a scene with one coefficient, mirrored."""
    fmu = packed(tmp_path, RAIL, inputs=["friction"])
    assert not {"friction.coefficient"} & fmu.references.keys()
    low = packed(tmp_path / "low", with_values(RAIL, friction__coefficient=0.17))
    usual = packed(tmp_path / "usual", RAIL)
    names = [n for n in usual.names("output", "Real") if n.startswith(("left.", "right."))]
    with Slave(fmu) as slave, Slave(usual) as of_usual:
        slave.initialize()
        of_usual.initialize()
        start = slave.get("friction.left.coefficient", "friction.right.coefficient")
        assert start == of_usual.get("friction.coefficient") * 2
        assert slave.get(*names) == of_usual.get(*names)
    with Slave(fmu) as slave, Slave(low) as of_low, Slave(usual) as of_usual:
        assert slave.set({"friction.left.coefficient": 0.17}) == OK
        for one in (slave, of_low, of_usual):
            one.initialize()
        for name in names:
            same = of_low if name.startswith("left.") else of_usual
            assert slave.get(name) == same.get(name), name
        assert slave.step(0.0, 1e-3) == OK
        # of the wheel whose friction it is, and of no other
        forces = ["left.force[1]", "left.force[2]", "right.force[1]", "right.force[2]"]
        status, rates = slave.derivative(forces, {"friction.left.coefficient": 1.0})
        assert status == OK
        state, ends = slave.save(), []
        for value in (0.169, 0.171):
            assert slave.restore(state) == OK
            assert slave.set({"friction.left.coefficient": value}) == OK
            assert slave.step(1e-3, 1e-3) == OK
            ends.append(slave.get(*forces))
        differences = [(b - a) / 2e-3 for a, b in zip(*ends, strict=True)]
        assert rates == pytest.approx(differences, rel=2e-2, abs=1e-6 * max(map(abs, rates)))
        assert max(map(abs, rates[:2])) > 0
        assert rates[2:] == [0.0, 0.0]


def test_friction_of_another_law_is_a_factor(tmp_path: Path) -> None:
    """In a scene with temperature: 1 is the law as it is, 0.5 what a law of half does."""
    case = load_scene(SCENES["hot"]).case
    fmu = packed(tmp_path, SCENES["hot"], inputs=["friction"])
    halves = {key: 0.5 * getattr(case.friction, key) for key in ("reference", "change")}
    half = packed(
        tmp_path / "half",
        with_values(SCENES["hot"], **{f"friction__{k}": v for k, v in halves.items()}),
    )
    usual = packed(tmp_path / "usual", SCENES["hot"])
    assert "friction.scale" in fmu.names("input")
    outputs = usual.names("output", "Real")
    with Slave(fmu) as slave, Slave(usual) as of_usual, Slave(half) as of_half:
        of_usual.initialize()
        slave.initialize()
        assert slave.get(*outputs) == of_usual.get(*outputs)
    with Slave(fmu) as slave, Slave(half) as of_half:
        assert slave.set({"friction.scale": 0.5}) == OK
        slave.initialize()
        of_half.initialize()
        assert slave.get(*outputs) == pytest.approx(of_half.get(*outputs), rel=1e-6)
        assert slave.set({"friction.scale": 101.0}) == ERROR


def test_a_factor_of_the_scene_is_in_the_fmu(tmp_path: Path) -> None:
    """Where friction is no input, too."""
    case = with_values(RAIL, friction__scale=[0.5, 1.0])
    low = packed(tmp_path / "low", with_values(RAIL, friction__coefficient=0.15))
    fmu = packed(tmp_path, case)
    with Slave(fmu) as slave, Slave(low) as of_low:
        slave.initialize()
        of_low.initialize()
        assert slave.get("left.force[1]") == pytest.approx(of_low.get("left.force[1]"), rel=1e-9)
        assert slave.get("right.force[1]") != of_low.get("right.force[1]")


def test_friction_without_a_tangential_problem_is_no_input(tmp_path: Path) -> None:
    scene = load_scene(SCENES["frictionless"])
    with pytest.raises(CaseError, match="--inputs: value is 'friction'"):
        pack_fmu(scene, tmp_path / "a.fmu", backend=OWN, inputs=["friction"])
