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


def test_friction_of_another_law_is_no_input(tmp_path: Path) -> None:
    with pytest.raises(CaseError, match="Coulomb's"):
        pack_fmu(load_scene(SCENES["hot"]), tmp_path / "a.fmu", backend=OWN, inputs=["friction"])
    with pytest.raises(CaseError, match="with wheels only"):
        pack_fmu(load_scene(PATCH), tmp_path / "a.fmu", backend=OWN, patches=1)
