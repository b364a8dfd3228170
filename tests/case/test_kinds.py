"""Every kind of scene has a schema that its scenes keep, and an example that runs."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from click.testing import CliRunner
from railpatch.case import CaseError
from railpatch.case.kinds import SceneKind, kind_of, kinds, write_example
from railpatch.case.load import read_toml
from railpatch.command.cli import cli
from railpatch.sweep.plan import load_plan

from rig_model.curve import load_curve_scene
from rig_model.scene import load_rig_scene
from wheelset_demo.scene import load_wheelset_scene
from wheelset_demo.vehicle.scene import load_vehicle_scene

KINDS = ("patch", "wheel_rail", "wheelset", "curve", "rig", "sweep", "vehicle", "wheelset_run")
LOADERS = {
    "curve": load_curve_scene,
    "rig": load_rig_scene,
    "vehicle": load_vehicle_scene,
    "wheelset_run": load_wheelset_scene,
}


def test_the_kinds() -> None:
    assert tuple(kinds()) == KINDS
    with pytest.raises(CaseError, match="kind: value is 'rigg', allowed patch, wheel_rail"):
        kind_of("rigg")


@pytest.mark.parametrize("name", KINDS)
def test_an_example_is_written_with_its_files_and_runs(name: str, tmp_path: Path) -> None:
    folder = tmp_path / "new" / "folder"
    done = CliRunner().invoke(cli, ["init", name, str(folder)])
    assert done.exit_code == 0, done.output
    scene = folder / f"{name}.toml"
    text = scene.read_text()
    assert text.startswith(f"#:schema {name}.schema.json\n")
    assert (folder / f"{name}.schema.json").is_file()
    if name == "sweep":
        assert len(load_plan(scene).points) == 108
        assert (folder / "wheel_rail.schema.json").is_file()
    elif name in LOADERS:
        loaded = LOADERS[name](scene)
        # its own files, not those of the package
        assert all(path.parent == folder for path in getattr(loaded, "files", {}).values())
    else:
        solved = CliRunner().invoke(cli, ["solve", str(scene)])
        assert solved.exit_code == 0, solved.output
    again = CliRunner().invoke(cli, ["init", name, str(folder)])
    assert again.exit_code == 2
    others = "".join(f"{other.name}, " for other in kind_of(name).others)
    assert f"has {name}.toml, {others}{name}.schema.json" in again.output
    assert scene.read_text() == text


@pytest.mark.parametrize("name", KINDS)
def test_the_schema_names_the_tables_of_its_scenes(name: str) -> None:
    done = CliRunner().invoke(cli, ["schema", "--kind", name])
    schema = json.loads(done.output)
    assert schema["$id"].startswith("urn:railpatch:")
    assert schema["$id"].endswith(f":{name}")
    assert schema["additionalProperties"] is False
    content = read_toml(kind_of(name).scene)
    assert set(content) <= set(schema["properties"])
    assert set(schema.get("required", ())) <= set(content)


def test_what_is_there_is_never_replaced(tmp_path: Path) -> None:
    rig: SceneKind = kind_of("rig")
    profile = rig.files()[0].name
    (tmp_path / profile).write_text("mine")
    with pytest.raises(CaseError, match=f"has {profile}, allowed a folder without"):
        write_example(rig, tmp_path)
    assert [path.name for path in tmp_path.iterdir()] == [profile]
    assert len(rig.files()) == 4


@pytest.mark.parametrize("scene", kind_of("vehicle").others, ids=lambda path: path.stem)
def test_other_vehicles_are_written_and_run(scene: Path, tmp_path: Path) -> None:
    folder = tmp_path / "new"
    assert CliRunner().invoke(cli, ["init", "vehicle", str(folder)]).exit_code == 0
    written = folder / scene.name
    assert written.read_text().startswith("#:schema vehicle.schema.json\n")
    done = CliRunner().invoke(cli, ["vehicle", str(written), "--duration", "0.02", "--json"])
    assert done.exit_code == 0, done.output
