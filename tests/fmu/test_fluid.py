"""A liquid in the FMU: supply and temperature are inputs, its numbers are Python's to the bit."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
import railpatch
from case_samples import PATCH, with_values
from fmu_scenes import OWN, RAIL, STEP, Packer
from slave import OK, Slave

FILM = {
    "model": "film",
    "roughness": 5e-7,
    "boundary_friction": 0.15,
    "liquid": "water",
    "temperature": 15.0,
}
OIL = {
    "model": "film",
    "share": "load_sharing",
    "roughness": 8e-7,
    "boundary_friction": 0.12,
    "liquid": "oil",
    "viscosity": 0.05,
    "oil_film": 2e-7,
    "temperature": 20.0,
}
STRIP = {**FILM, "model": "strip"}
DAMP = {"model": "regimes", "water_rate": 5e-9}
SCENES: dict[str, dict[str, Any]] = {
    "film": with_values(PATCH, fluid={**FILM, "water_rate": 2e-8}, motion__creepage=[5e-3, 0.0]),
    "oil": with_values(PATCH, fluid=OIL, motion__creepage=[5e-3, 1e-3]),
    "strip": with_values(PATCH, fluid=STRIP, motion__creepage=[5e-3, 0.0]),
    "regimes": with_values(
        PATCH,
        friction=None,
        fluid=DAMP,
        motion__creepage=[5e-3, 0.0],
        method={"normal": "hertz", "tangential": "polach"},
    ),
    "wheels": with_values(
        RAIL, fluid={**FILM, "water_rate": 2e-8}, wheelset__pitch_rate=-2.05 / 0.46
    ),
    "fast wheels": with_values(
        RAIL,
        fluid={**FILM, "oil_film": 3e-7},
        wheelset__pitch_rate=-2.05 / 0.46,
        method={"normal": "kik_piotrowski", "tangential": "fastsim"},
    ),
}
RATES = [{"water_rate": rate} for rate in (1e-9, 0.0, 4e-7)]
FILMS = [{"oil_film": 5e-8, "water_temperature": 35.0}, {"oil_film": 0.0}, {"oil_film": 1e-6}]
WARM = [{"water_temperature": 2.0}, {"water_temperature": 60.0}]
# by scene: what moves before each step
MOTIONS: dict[str, list[dict[str, float]]] = {
    "film": [*RATES, *WARM],
    "oil": FILMS,
    "strip": WARM,
    "regimes": RATES,
    "wheels": [*RATES, *WARM],
    "fast wheels": FILMS,
}
WHEEL = ("force", "moment")
PATCHED = ("creep_force", "spin_moment", "friction_power")


@pytest.fixture(scope="module")
def packer(tmp_path_factory: pytest.TempPathFactory) -> Packer:
    return Packer(tmp_path_factory.mktemp("fluid"), SCENES)


def numbers(result: railpatch.Result) -> dict[str, float]:
    """By the FMU's names."""
    if "right" not in result.to_dict():
        vectors = {key: result[key] for key in PATCHED}
    else:
        vectors = {
            f"{side}.{key}": result[side][key] for side in ("left", "right") for key in WHEEL
        }
    found: dict[str, float] = {}
    for name, value in vectors.items():
        if isinstance(value, list):
            found |= {f"{name}[{k + 1}]": v for k, v in enumerate(value)}
        else:
            found[name] = value
    return found


@pytest.mark.parametrize("name", SCENES)
def test_inputs_move_the_liquid_as_in_python(name: str, packer: Packer) -> None:
    fmu = packer(name)
    moved = sorted({key for values in MOTIONS[name] for key in values})
    assert set(moved) <= set(fmu.names("input"))
    contact, before = railpatch.Contact(SCENES[name]), None
    kept: dict[str, float] = {}
    with Slave(fmu).initialize() as slave:
        for k, values in enumerate([{}, *MOTIONS[name]]):
            kept |= values
            if k > 0:  # the first is that of the start
                assert slave.set(values) == OK, slave.log
                assert slave.step((k - 1) * STEP, STEP) == OK, slave.log
            wanted = numbers(contact.step(**kept))
            assert dict(zip(wanted, slave.get(*wanted), strict=True)) == wanted, (name, k)
            # what moves counts
            assert wanted != before, (name, k)
            before = wanted


@pytest.mark.parametrize("name", SCENES)
def test_inputs_are_those_that_the_scene_reads(name: str, packer: Packer) -> None:
    supply = {"water_rate", "oil_film"} & {*SCENES[name]["fluid"]}
    names = {"water_rate", "oil_film", "water_temperature"} & set(packer(name).names("input"))
    assert names == supply | ({"water_temperature"} if name != "regimes" else set())


def test_friction_of_a_liquid_is_moved_by_its_factor(tmp_path: Path) -> None:
    """Scenes without a coefficient of dry friction: none is in the FMU, a factor where asked."""
    scene = SCENES["regimes"]
    plain = Packer(tmp_path, {"plain": scene})("plain")
    assert not any(name.startswith("friction") for name in plain.names("parameter"))
    moved = Packer(tmp_path, {"moved": scene}, moved={"inputs": ["friction"]})("moved")
    with Slave(moved).initialize() as slave:
        slave.set({"friction.scale": 0.5})
        assert slave.step(0.0, STEP) == OK, slave.log
        found = slave.get("creep_force[1]")
    wanted = railpatch.solve({**scene, "friction": {"scale": [1.0, 0.5]}})["creep_force"][0]
    assert found == [wanted]


def test_what_is_no_liquid_is_told(packer: Packer) -> None:
    """Water of 120 degrees C: the step is no step, and one with what was before goes on."""
    with Slave(packer("film")).initialize() as slave:
        good = slave.outputs()
        slave.set({"water_temperature": 120.0})
        assert slave.step(0.0, STEP) != OK
        assert any("water_temperature" in str(line) for line in slave.log), slave.log
    with Slave(packer("film")).initialize() as other:
        assert other.outputs() == good


def test_dry_scenes_have_no_such_inputs(tmp_path: Path) -> None:
    names = set(Packer(tmp_path, {"dry": PATCH}, dry={"backend": OWN})("dry").names("input"))
    assert not {"water_rate", "oil_film", "water_temperature"} & names
