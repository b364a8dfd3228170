"""Sweeps of whole runs: a curve, a rig, a wheelset, a vehicle, against the commands themselves."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
import tomli_w
from railpatch.case.kinds import kind_of, write_example
from railpatch.case.load import read_toml
from railpatch.log import read_run
from railpatch.sweep import run_sweep

from rig_model.curve import load_curve_scene, steady_curves
from rig_model.run import replay
from rig_model.scene import load_rig_scene


def change(scene: Path, **tables: dict[str, Any]) -> Path:
    """Writes a scene anew with other values in some tables, None: without the key."""
    content = read_toml(scene)
    for name, values in tables.items():
        table = {**content.get(name, {}), **values}
        content[name] = {key: value for key, value in table.items() if value is not None}
    scene.write_text(tomli_w.dumps(content), encoding="utf-8")
    return scene


def swept(folder: Path, kind: str, text: str, **tables: dict[str, Any]) -> Path:
    """A sweep of the kind's example, with other values in some tables."""
    write_example(kind_of(kind), folder)
    change(folder / f"{kind}.toml", **tables)
    path = folder / "sweep.toml"
    path.write_text(f'[sweep]\nscene = "{kind}.toml"\n{text}', encoding="utf-8")
    return path


def test_curves(tmp_path: Path) -> None:
    """The same numbers as of the command."""
    path = swept(
        tmp_path,
        "curve",
        'outputs = ["curves[0].y", "curves[0].yaw"]\n[[vary]]\nkey = "curve.radius[0]"\n'
        "values = [500.0, 900.0]\n",
        method={"tangential": "fastsim"},
    )
    sweep = run_sweep(path, tmp_path / "out")
    for row, radius in zip(sweep.rows, (500.0, 900.0), strict=True):
        assert row.status == "converged", row.reason
        scene = load_curve_scene(tmp_path / "curve.toml", radius=[radius])
        alone = steady_curves(scene)[0].to_dict()
        assert row.outputs == (alone["y"], alone["yaw"])


def test_rig(tmp_path: Path) -> None:
    """Statistics of a log's channel, and the logs where they are kept."""
    path = swept(
        tmp_path,
        "rig",
        'keep_logs = true\noutputs = ["balanced", "max(/right/contact.force[1])"]\n'
        '[[vary]]\nkey = "friction.coefficient"\nvalues = [0.3, 0.4]\n',
        rig={"positions": 2, "rate": None},
        grid={"element_size": [1e-3, 1e-3]},
    )
    sweep = run_sweep(path, tmp_path / "out")
    assert [row.status for row in sweep.rows] == ["converged"] * 2, sweep.rows
    for row, friction in zip(sweep.rows, (0.3, 0.4), strict=True):
        kept = read_run(tmp_path / "out" / "logs" / f"{row.id}.mcap")
        scene = change(tmp_path / "rig.toml", friction={"coefficient": friction})
        replay(load_rig_scene(scene), tmp_path / "alone.mcap")
        force = read_run(tmp_path / "alone.mcap")["/right/contact"]["force[1]"]
        assert list(kept["/right/contact"]["force[1]"]) == list(force)
        assert row.outputs == (2, force.max())


@pytest.mark.parametrize("kind", ["wheelset_run", "vehicle"])
def test_runs_in_time(tmp_path: Path, kind: str) -> None:
    """Their summaries' numbers without being named; no times among them."""
    length = ("run.distance", 0.5) if kind == "wheelset_run" else ("run.duration", 0.004)
    path = swept(
        tmp_path,
        kind,
        f'[[vary]]\nkey = "{length[0]}"\nvalues = [{length[1]}]\n',
        method={"tangential": "polach"},
    )
    sweep = run_sweep(path, tmp_path / "out")
    assert [row.status for row in sweep.rows] == ["converged"], sweep.rows
    found = dict(zip(sweep.outputs, sweep.rows[0].outputs, strict=True))
    assert found["steps"] > 0
    assert "wall_time" not in found
    again = run_sweep(path, tmp_path / "again")
    assert again.rows[0].outputs == sweep.rows[0].outputs
