"""Friction that falls with slip velocity in all that has wheels: force element, rig, curve, runs.

Each takes the law with the full theory, and with FASTSIM without memory; its contact is that of the
case alone, and what it finds is not what Coulomb's law with the coefficient at rest gives.
"""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import mbs_samples as samples
import numpy as np
import pinocchio as pin
import pytest
import railpatch
import vehicle_scenes
import wheelset_scenes
from railpatch.pinocchio import ForceElement

from rig_model.balance import Balancer
from rig_model.curve import DEFAULT as CURVE
from rig_model.curve import load_curve_scene, steady_curves
from rig_model.scene import NOMINAL, load_rig_scene, scenes
from wheelset_demo.scene import load_wheelset_scene
from wheelset_demo.simulation import simulate

KINETIC, AMPLITUDE = 0.15, 0.15
LAW: dict[str, Any] = {
    **{"law": "slip_velocity", "kinetic": KINETIC, "amplitude": AMPLITUDE},
    **{"halving_speed": 0.003, "memory_distance": 5e-4},
}
LAWS = {
    "full": LAW,
    "fastsim": {key: value for key, value in LAW.items() if key != "memory_distance"},
}
BY_THEORY = pytest.mark.parametrize("theory", LAWS)


def with_law(text: str, theory: str) -> str:
    """The scene of another law and theory, without a layer."""
    law = "".join(f"{key} = {value!r}\n".replace("'", '"') for key, value in LAWS[theory].items())
    changed, count = re.subn(r"(?m)^coefficient = .*\n", law, text)
    assert count == 1
    return changed if theory == "full" else with_theory(changed, theory)


def with_theory(text: str, theory: str) -> str:
    text = re.sub(r"(?m)^\[layer\]\n(?:.+\n)*", "", text)
    chosen = f'[method]\ntangential = "{theory}"\n'
    return text.replace("[method]\n", chosen) if "[method]\n" in text else f"{text}\n{chosen}"


@BY_THEORY
def test_force_element(theory: str) -> None:
    """The forces of Contact.step()."""
    grid = {"elements": None, "element_size": [1.2e-3, 1.2e-3]}
    method = {"tangential": theory}
    case = samples.case(grid=grid, friction={"coefficient": None, **LAWS[theory]}, method=method)
    model = samples.model()
    data = model.createData()
    element, alone = ForceElement(model, "wheelset", case), railpatch.Contact(case)
    coulomb = railpatch.Contact({**case, "friction": {"coefficient": KINETIC + AMPLITUDE}})
    largest = 0.0
    for q, v in samples.random_motions(5, 12):
        pin.forwardKinematics(model, data, q, v)
        fext = samples.no_forces(model)
        status = element.step(data, fext)
        moving = {key: x for key, x in element.state().items() if key in samples.MOVING}
        result = alone.step(**moving)
        assert status == result.status
        expected = np.array(result["force"] + result["moment"])
        scale = max(1.0, np.abs(expected).max())
        np.testing.assert_allclose(element.contact_wrench[0], expected, atol=1e-12 * scale, rtol=0)
        other = coulomb.step(**moving)
        if status == "converged":
            largest = max(largest, np.abs(np.array(other["force"]) - expected[:3]).max() / scale)
    assert largest > 1e-2


@BY_THEORY
def test_rig(tmp_path: Path, theory: str) -> None:
    """Balances, with other friction work than by Coulomb's law."""
    source = scenes() / NOMINAL
    for profile in source.parent.glob("*.csv"):
        (tmp_path / profile.name).write_bytes(profile.read_bytes())
    texts = {"coulomb": source.read_text(), "falling": with_law(source.read_text(), theory)}
    if theory != "full":
        texts["coulomb"] = with_theory(texts["coulomb"], theory)
    found = {}
    for name, text in texts.items():
        file = tmp_path / f"{name}.toml"
        file.write_text(text)
        scene = load_rig_scene(file, {"positions": 3})
        balancer = Balancer(scene)
        balances = [balancer.solve(position) for position in scene.positions()]
        assert [balance.status for balance in balances] == ["converged"] * 3
        found[name] = np.array([balance.result["friction_power"] for balance in balances])
    assert np.abs(found["falling"] / found["coulomb"] - 1).max() > 0.01


@BY_THEORY
def test_curve(tmp_path: Path, theory: str) -> None:
    text = CURVE.read_text()
    plain = text if theory == "full" else with_theory(text, theory)
    found = {}
    for name, each in (("coulomb", plain), ("falling", with_law(text, theory))):
        path = tmp_path / f"{name}.toml"
        path.write_text(each)
        curves = steady_curves(load_curve_scene(path))
        assert all(curve.converged for curve in curves), name
        found[name] = np.array([curve.unknowns for curve in curves])
    assert np.abs(found["falling"] - found["coulomb"]).max() > 1e-6


@BY_THEORY
def test_wheelset_run(tmp_path: Path, theory: str) -> None:
    """A metre of a released wheelset; the bodies' energy balance stays closed."""
    file = tmp_path / "scene.toml"
    text = wheelset_scenes.text_of("s1002.toml", distance=1.0)
    file.write_text(with_law(text, theory))
    trace = simulate(load_wheelset_scene(file))
    file.write_text(text if theory == "full" else with_theory(text, theory))
    plain = simulate(load_wheelset_scene(file))
    assert trace.work("friction")[-1] > 0
    assert trace.work("friction")[-1] != plain.work("friction")[-1]
    lost = trace.work("friction")[-1] + trace.work("damping")[-1]
    # as much as the energy tests of wheelsets allow
    assert np.abs(trace.mechanical_residual()).max() < 0.005 * lost


@BY_THEORY
def test_vehicle_run(theory: str) -> None:
    given = vehicle_scenes.scene(method={"tangential": theory}, duration=0.02)
    friction = type(given.case.friction)(**LAWS[theory])
    falling = vehicle_scenes.replace(
        given, case=given.case.model_copy(update={"friction": friction})
    )
    powers = []
    for each in (given, falling):
        simulation = vehicle_scenes.finished(each)
        powers.append(simulation.system.element.wheels[:, :, :3].copy())
    assert np.isfinite(powers[1]).all()
    assert not np.array_equal(*powers)
