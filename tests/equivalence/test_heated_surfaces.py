"""[temperature] in all that has wheels: rig, curve, runs and their logs.

With Coulomb's law heat follows from friction and does not act back: what is found is that of the
run without it, to the bit where the way to it is the same, and surfaces in contact are warmer than
the bodies.
"""

from __future__ import annotations

from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
import railpatch
import vehicle_scenes
import wheelset_scenes
from bulk_samples import lumped
from click.testing import CliRunner
from railpatch.case.common import Temperature
from railpatch.command.cli import cli
from railpatch.log import read_run

from rig_model.balance import Balancer
from rig_model.curve import DEFAULT as CURVE
from rig_model.curve import load_curve_scene, steady_curves
from rig_model.scene import NOMINAL, load_rig_scene, scenes

BULK = 21.0  # degrees C
TEXT = f"\n[temperature]\nwheel = {BULK}\nrail = {BULK}\n"


def test_rig(tmp_path: Path) -> None:
    source = scenes() / NOMINAL
    for profile in source.parent.glob("*.csv"):
        (tmp_path / profile.name).write_bytes(profile.read_bytes())
    heated = tmp_path / "scene.toml"
    heated.write_text(source.read_text() + TEXT)
    found = []
    for file in (source, heated):
        scene = load_rig_scene(file, {"positions": 3})
        balancer = Balancer(scene)
        found.append([balancer.solve(position) for position in scene.positions()])
    for plain, warm in zip(*found, strict=True):
        assert warm.status == "converged"
        assert (warm.z, warm.roll, warm.pitch_rate) == (plain.z, plain.roll, plain.pitch_rate)
        assert warm.result["max_temperature"] > BULK + 0.1
        assert np.isnan(plain.result["max_temperature"])


def test_rig_stores_heat(tmp_path: Path) -> None:
    """Between positions bodies take the heat of friction that they had at the one before."""
    source = scenes() / NOMINAL
    for profile in source.parent.glob("*.csv"):
        (tmp_path / profile.name).write_bytes(profile.read_bytes())
    heated = tmp_path / "scene.toml"
    bulk = {"mass": [0.5, 2.0], "air_conductance": [3.0, 1.0], "air_temperature": 20.0}
    table = "\n".join(f"{key} = {value}" for key, value in bulk.items())
    text = TEXT.replace(f"rail = {BULK}", f"rail = {BULK + 2}")
    heated.write_text(f"{source.read_text()}{text}\n[temperature.bulk]\n{table}\n")
    scene = load_rig_scene(heated, {"positions": 3})
    balancer = Balancer(scene)
    positions = scene.positions()
    found = [balancer.solve(position) for position in positions]
    assert all(balance.status == "converged" for balance in found)
    for (at, balance), (later, after) in pairwise(zip(positions, found, strict=True)):
        time = later.time - at.time
        assert time > 0
        for side in ("left", "right"):
            wanted, _ = lumped(bulk, balance.result[side], time)
            now = [after.result[side][f"{body}_temperature"] for body in ("wheel", "rail")]
            np.testing.assert_allclose(now, wanted, rtol=1e-7)


def test_what_has_no_time_refuses_bodies_that_store_heat(tmp_path: Path) -> None:
    """Curves and FMUs, by name; and rails that a run finds always new."""
    bulk = "\n[temperature.bulk]\nmass = 100.0\n"
    curve, case, run = (tmp_path / f"{name}.toml" for name in ("curve", "case", "run"))
    curve.write_text(CURVE.read_text() + TEXT + bulk)
    with pytest.raises(railpatch.CaseError, match=r"temperature\.bulk"):
        load_curve_scene(curve)
    kinds = Path(railpatch.__file__).parent / "fmu" / "kinds"
    case.write_text((kinds / "wheelset_temperature.toml").read_text() + bulk)
    run.write_text(wheelset_scenes.text_of("s1002.toml", distance=0.5) + TEXT + bulk)
    for arguments in (["fmu", str(case), "-o", str(tmp_path / "a.fmu")],
                      ["wheelset", str(run), "-o", str(tmp_path / "a.mcap")]):  # fmt: skip
        result = CliRunner().invoke(cli, arguments)
        assert result.exit_code == 2, arguments
        assert "temperature.bulk" in result.output


def test_curve(tmp_path: Path) -> None:
    heated = tmp_path / "curve.toml"
    heated.write_text(CURVE.read_text() + TEXT)
    plain, warm = (steady_curves(load_curve_scene(path)) for path in (None, heated))
    for a, b in zip(plain, warm, strict=True):
        assert b.converged
        # searched without FASTSIM's start: 6 N over the stiffness of a contact, and of a flange
        assert (np.abs(a.unknowns - b.unknowns) <= [5e-6, 2e-7, 5e-7, 2e-5, 5e-3]).all()
        assert b.result["max_temperature"] > BULK + 0.1


def test_wheelset_run(tmp_path: Path) -> None:
    """The log has the temperature of each wheel and, in its snapshots, of both surfaces."""
    file, log = tmp_path / "scene.toml", tmp_path / "run.mcap"
    file.write_text(wheelset_scenes.text_of("s1002.toml", distance=0.5) + TEXT)
    result = CliRunner().invoke(cli, ["wheelset", str(file), "-o", str(log)])
    assert result.exit_code == 0, result.output
    run = read_run(log)
    greatest = run["/left/contact"]["max_temperature"]
    assert greatest.min() >= BULK
    assert greatest.max() > BULK + 1e-3
    snapshots = run["/left/fields"].messages
    assert snapshots
    for snapshot in snapshots:
        for patch in snapshot["patches"]:
            wheel, rail = np.reshape(patch["temperature"], (2, -1))
            assert len(wheel) == len(patch["pressure"])
            assert np.array_equal(wheel, rail)
            assert wheel.min() >= BULK


def test_vehicle_run() -> None:
    given = vehicle_scenes.scene(method={"tangential": "full"}, duration=0.02)
    heat = Temperature(wheel=BULK, rail=BULK)
    heated = vehicle_scenes.replace(given, case=given.case.model_copy(update={"temperature": heat}))
    forces = [vehicle_scenes.finished(each).system.element.wheels for each in (given, heated)]
    # derivatives of the steps are by differences with heat; N, N m, of wheel loads of 54 kN
    np.testing.assert_allclose(*forces, atol=1.0)
