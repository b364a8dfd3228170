"""What is said of the greatest pressure between noisy profiles, against the clean ones."""

from __future__ import annotations

from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
import railpatch
import tomli_w
from case.correct import accepted, combined
from click.testing import CliRunner
from railpatch.case.kinds import kinds
from railpatch.case.load import load_scene
from railpatch.command.cli import cli
from railpatch.evidence.measured_files import (
    FILES,
    NAMES,
    SUFFIX,
    File,
    counted,
    text_of,
    tried,
)
from railpatch.fmu import pack_fmu
from railpatch.log.effective import effective
from railpatch.pressure_error import LIMIT
from railpatch.profiles import load_profile
from railpatch.profiles.raw import Role
from railpatch.report.warnings import warnings
from railpatch.sweep import run_sweep

NOISY = File(5e-6, 2e-4, "blanks", "none")
QUIET = File(3e-7, 5e-5, "semicolons", "none")


def made(folder: Path, file: File) -> dict[str, str]:
    """Both files in a folder, by role."""
    names: dict[str, str] = {}
    roles: tuple[Role, ...] = ("wheel", "rail")
    for role in roles:
        names[role] = f"{role}{SUFFIX[file.form, role]}"
        text = text_of(file, role, load_profile(NAMES[role], role))
        (folder / names[role]).write_text(text, encoding="utf-8")
    return names


def case(profiles: dict[str, str], kind: str = "wheel_rail", **wheelset: Any) -> dict[str, Any]:
    return {
        "kind": kind,
        "grid": {"elements": [12, 16]},
        "method": {"tangential": "none"},
        "wheelset": {
            "vertical_force": 8e4,
            "nominal_radius": 0.46,
            "flange_back_distance": 1.36,
            "flange_back_position": -0.07,
            **wheelset,
        },
        "track": {"gauge": 1.435, "gauge_height": 0.014},
        "profiles": profiles,
    }


def test_errors_are_told() -> None:
    """Of some files of `python -m railpatch.evidence.measured_files`."""
    errors, said = [], []
    for number in (0, 13, 15):
        found = tried(FILES[number], positions=(-3e-3, 0.0, 3e-3, 6e-3))
        assert not found.refused
        assert (found.asked != "") == (FILES[number].change == "swapped")
        assert found.warned[np.abs(found.pressure) > 2 * LIMIT].all()
        assert found.warned[found.force > 0.01].all()
        errors.extend(np.abs(found.pressure))
        said.extend(found.said)
    # 95 % of 12: nine or less by a chance of 0.2 %
    assert np.sum(np.array(errors) <= said) >= 10
    assert (np.array(errors) <= 2 * np.array(said)).all()
    assert "um of noise" in tried(FILES[17], positions=(0.0,)).refused


@pytest.mark.long
def test_errors_of_all_files_are_told() -> None:
    result = counted([tried(file) for file in FILES])
    assert result["positions"] == 8 * 18
    # 18 pairs of files whose positions go together, 16 draws that know 18 %
    assert result["below"] >= 0.9
    assert result["silent"] <= 0.05 * result["positions"]
    assert result["force"] == 0


def test_a_solve_tells_it(tmp_path: Path) -> None:
    noisy = made(tmp_path, NOISY)
    result = railpatch.solve(case(noisy), folder=tmp_path)
    [line] = result.warnings
    error = result["max_pressure_error"]
    assert error > LIMIT
    assert f"max_pressure is known to within {100 * error:.2g} %" in line
    assert "wheel.dat and rail.dat" in line
    assert "profiles.smoothing" in line
    assert result.to_dict()["max_pressure_error"] == error
    with pytest.raises(railpatch.CaseError, match="max_pressure is known to within"):
        railpatch.solve(case(noisy), folder=tmp_path, strict=True)
    # of both wheels, once where they are alike
    both = railpatch.solve(case(noisy, "wheelset", vertical_force=1.6e5), folder=tmp_path)
    assert [both[side]["max_pressure_error"] for side in ("left", "right")] == [error] * 2
    assert both.warnings == [line]
    clean = railpatch.solve(case(dict(NAMES)), folder=tmp_path)
    assert "max_pressure_error" not in clean.data


def test_what_is_small_is_a_note(tmp_path: Path) -> None:
    result = railpatch.solve(case(made(tmp_path, QUIET), y=3e-3), folder=tmp_path)
    assert result.warnings == []
    assert 0.0 < result["max_pressure_error"] <= LIMIT
    assert any("max_pressure is known to within" in line for line in result["notes"])


def test_steps_tell_it_when_asked(tmp_path: Path) -> None:
    contact = railpatch.Contact(case(made(tmp_path, NOISY)), folder=tmp_path)
    with pytest.raises(railpatch.CaseError, match="there is no step"):
        contact.pressure_error()
    contact.step(y=1e-3)
    first = contact.pressure_error()
    contact.step(y=-2e-3)
    other = contact.pressure_error()
    contact.step(y=1e-3)
    assert contact.pressure_error() == first != other
    contact.step(y=0.2)  # beyond the rail
    assert contact.pressure_error() == {}


def with_features(names: tuple[str, ...], folder: Path) -> dict[str, Any]:
    """A wheelset in balance, with noisy profiles, and features of other tests' combinations."""
    found = next(one for name, one in combined() if name == f"wheelset: {' + '.join(names)}")
    return {**found, "profiles": made(folder, NOISY)}


@pytest.mark.parametrize(
    "name",
    [
        "temperature law",
        "spin offset",
        "rail support",
        "flat",
        "roller",
        "curved reference",
        "regimes of water",
    ],
)
def test_it_goes_with_every_feature(name: str, tmp_path: Path) -> None:
    result = railpatch.solve(with_features((name,), tmp_path), folder=tmp_path)
    for side in ("left", "right"):
        assert 0.0 < result[side]["max_pressure_error"] < 1.0


def test_it_goes_with_all_that_only_tractions_read(tmp_path: Path) -> None:
    """The same errors, whatever friction, liquid and heat there are beside the pressure."""
    bare = case(made(tmp_path, NOISY), "wheelset", vertical_force=1.6e5)
    rolls = {**bare, "method": {"tangential": "polach"}, "friction": {"coefficient": 0.3}}
    liquid = {"model": "film", "roughness": 1e-6, "liquid": "water", "temperature": 20.0}
    regimes = {"model": "regimes", "water_rate": 1e-8, "rail_work": [300.0, 200.0]}
    found = [
        railpatch.solve({**rolls, **tables}, folder=tmp_path)["left"]["max_pressure_error"]
        for tables in (
            {"method": {"tangential": "none"}, "friction": None},
            {"friction": {"coefficient": 0.3, "scale": [0.8, 0.9]}},
            {"fluid": {**liquid, "water_rate": 1e-8}},
            {"fluid": {**liquid, "oil_film": 1e-6}},
            {"fluid": {**regimes, "recovery": {"coefficient": 1e-3}}, "friction": None},
            {"temperature": {"wheel": 80.0, "rail": 20.0}, "method": {"tangential": "full"}},
        )
    ]
    assert len(set(found)) == 1
    assert 0.0 < found[0] < 1.0


def test_it_goes_with_profiles_along_the_track(tmp_path: Path) -> None:
    names = made(tmp_path, NOISY)
    sections = [{"position": -1.0, "profile": names["rail"]}, {"position": 1.0, "profile": "UIC60"}]
    own = case({"wheel": names["wheel"]})
    own["track"]["right"] = {"sections": sections}
    result = railpatch.solve(own, folder=tmp_path)
    assert 0.0 < result["max_pressure_error"] < 1.0
    assert set(result["profiles"]) == {"wheel.dat", "rail.dat"}


@pytest.mark.long
def test_it_goes_with_all_pairs_of_features(tmp_path: Path) -> None:
    profiles = made(tmp_path, NOISY)
    for name, one in combined():
        if one["kind"] != "patch" and accepted(one):
            result = railpatch.solve({**one, "profiles": profiles}, folder=tmp_path)
            for wheel in (result.data[s] for s in ("left", "right") if s in result.data):
                assert 0.0 < wheel["max_pressure_error"] < 1.0, name


def scene_of(kind: str, folder: Path) -> Path:
    """The packaged scene of a kind with noisy profiles."""
    made(folder, NOISY)
    text = kinds()[kind].scene.read_text(encoding="utf-8")
    for role, name in NAMES.items():
        text = text.replace(f'"{name}"', f'"{role}.dat"')
    path = folder / "scene.toml"
    path.write_text(text, encoding="utf-8")
    return path


def test_runs_tell_it(tmp_path: Path) -> None:
    scene = scene_of("curve", tmp_path)
    ran = CliRunner().invoke(cli, ["curve", str(scene), "--radius", "600", "--strict"])
    assert ran.exit_code == 2
    assert "max_pressure is known to within" in ran.stderr


def test_logs_and_reports_tell_it(tmp_path: Path) -> None:
    loaded = load_scene(scene_of("wheelset", tmp_path)).case
    files = {role: str(tmp_path / name) for role, name in made(tmp_path, NOISY).items()}
    case = loaded.model_copy(update={"profiles": loaded.profiles.model_copy(update=files)})
    text = (tmp_path / "scene.toml").read_bytes()
    about = effective(text, case, {}, step=1e-3, duration=1.0, names={}).about
    assert about["doubts"].startswith("at y = ")
    assert " | " not in about["doubts"]  # both sides are alike
    run = SimpleNamespace(metadata={"railpatch": about}, channels={}, truncated=False)
    run.stopped_by = ""
    assert "max_pressure is known to within" in "".join(warnings(run, "", 0, 1, ""))


def test_fmus_tell_it(tmp_path: Path) -> None:
    scene = load_scene(scene_of("wheelset", tmp_path))
    written = pack_fmu(scene, tmp_path / "a.fmu", name="a")
    assert any("max_pressure is known to within" in line for line in written.warnings)


def test_many_states_and_sweeps_say_it_too(tmp_path: Path) -> None:
    """Once for all states; in the row of each case."""
    noisy = made(tmp_path, NOISY)
    states = railpatch.solve_many(case(noisy), {"y": [0.0, 1e-3]}, folder=tmp_path)
    (doubt,) = states.doubts
    assert "max_pressure is known to within" in doubt
    assert (
        railpatch.solve_many(case({"wheel": "S1002", "rail": "UIC60"}), {"y": [0.0]}).doubts == []
    )
    (tmp_path / "scene.toml").write_text(tomli_w.dumps(case(noisy)), encoding="utf-8")
    sweep = tmp_path / "sweep.toml"
    text = '[sweep]\nscene = "scene.toml"\n[[vary]]\nkey = "wheelset.y"\nvalues = [0.0, 1e-3]\n'
    sweep.write_text(text, encoding="utf-8")
    rows = run_sweep(sweep, tmp_path / "out", page=False).rows
    assert [row.warnings for row in rows] == [(doubt,)] * 2
