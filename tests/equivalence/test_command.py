"""The railpatch command: output, exit codes, and the same numbers as solve()."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path
from typing import Any

import click
import pytest
import railpatch
from case_samples import PATCH, WHEELSET, with_values
from click.testing import CliRunner, Result
from railpatch.command.cli import cli
from railpatch.command.group import Commands
from railpatch.result import PATCH_UNITS

# keys of the interface's JSON result that its readers count on
PATCH_KEYS = [
    "status",
    "normal_force",
    "approach",
    "creep_force",
    "spin_moment",
    "max_pressure",
    "contact_area",
    "elements",
    "max_temperature",
    "creep_power",
    "friction_power",
    "plastic_power",
    "elastic_energy",
    "pressure_energy",
    "iterations",
    "outer_iterations",
    "ambiguous_elements",
    "residual",
    "wall_time",
    "error_estimate",
    "stages",
]
WHEEL_KEYS = ("force", "moment", "z", "status", "wall_time", "patches")
PLACE_KEYS = (
    "share",
    "position",
    "contact_angle",
    "creepage",
    "spin_creepage",
    "rolling_speed",
)


def toml(case: dict[str, Any]) -> str:
    """A case as TOML."""
    lines = [f"{key} = {json.dumps(value)}" for key, value in case.items() if key == "kind"]
    for name, table in case.items():
        if isinstance(table, dict):
            lines += [f"[{name}]", *(f"{key} = {inline(table[key])}" for key in table)]
    return "\n".join(lines) + "\n"


def inline(value: Any) -> str:
    """A value as TOML in a line."""
    if isinstance(value, dict):
        return "{ " + ", ".join(f"{key} = {inline(item)}" for key, item in value.items()) + " }"
    return json.dumps(value)


def run(tmp_path: Path, case: dict[str, Any] | str, *arguments: str) -> Result:
    """railpatch ARGUMENTS CASE.toml."""
    path = tmp_path / "case.toml"
    path.write_text(case if isinstance(case, str) else toml(case))
    return CliRunner().invoke(cli, [*arguments, str(path)])


def test_json_of_a_patch_is_that_of_solve(tmp_path: Path) -> None:
    ran = run(tmp_path, PATCH, "solve", "--json")
    assert ran.exit_code == 0
    printed = json.loads(ran.stdout)
    assert set(printed) == {*PATCH_UNITS, "warnings", "wall_time", "stages"} >= set(PATCH_KEYS)
    solved = railpatch.solve(PATCH).to_dict()
    assert {**printed, "wall_time": 0} == {**solved, "wall_time": 0}
    assert 0 < printed["wall_time"] < 5
    assert set(printed["error_estimate"]) == {"creep_force", "spin_moment", "max_pressure"}
    assert all(value > 0 for value in printed["error_estimate"].values())


def test_json_of_wheels(tmp_path: Path) -> None:
    case = with_values(WHEELSET, wheelset__z=2.2e-4)
    both = json.loads(run(tmp_path, case, "solve", "--json").stdout)
    assert {"left", "right", "force", "moment", "z", "status"} <= set(both)
    one = with_values(case, kind="wheel_rail", wheel={"side": "right"})
    wheel = json.loads(run(tmp_path, one, "solve", "--json", "--fields").stdout)
    assert set(WHEEL_KEYS) <= set(wheel)
    patch = wheel["patches"][0]
    assert {*PLACE_KEYS, *PATCH_KEYS} - {"wall_time", "stages"} <= set(patch)
    assert {"x", "y", "pressure", "traction", "micro_slip", "element_division"} <= set(patch)
    assert len(patch["pressure"]) == len(patch["y"])
    assert wheel["force"] == both["right"]["force"]


def test_table_shows_the_numbers(tmp_path: Path) -> None:
    ran = run(tmp_path, PATCH, "solve")
    force = railpatch.solve(PATCH)["creep_force"][0]
    assert ran.exit_code == 0
    assert f"{force:.6g}" in ran.stdout
    assert "max_temperature" not in ran.stdout
    wheels = run(tmp_path, with_values(WHEELSET, wheelset__z=2.2e-4), "solve")
    assert "left 1" in wheels.stdout
    assert "wheelset" in wheels.stdout


def test_errors_go_to_stderr_with_exit_code_2(tmp_path: Path) -> None:
    bad = with_values(PATCH, load__normal_force=-1.0, friction__coeficient=0.3)
    ran = run(tmp_path, bad, "solve", "--json")
    assert ran.exit_code == 2
    assert ran.stdout == ""
    assert "load.normal_force: value is -1.0, allowed >= 0" in ran.stderr
    assert "did you mean 'coefficient'?" in ran.stderr
    profiles = {"wheel": "absent.whl", "rail": "UIC60"}
    ran = run(tmp_path, with_values(WHEELSET, profiles=profiles), "solve")
    assert ran.exit_code == 2
    assert "absent.whl: file not found" in ran.stderr
    assert run(tmp_path, "kind = 1 2", "explain").exit_code == 2
    assert CliRunner().invoke(cli, ["solve", str(tmp_path / "absent.toml")]).exit_code == 2
    assert CliRunner().invoke(cli, ["solve"]).exit_code == 2
    assert CliRunner().invoke(cli, ["bogus"]).exit_code == 2


def test_profiles_are_found_beside_the_case(tmp_path: Path) -> None:
    rows = [f"{y} {-0.05 * y}" for y in range(-70, 71)]
    (tmp_path / "cone.txt").write_text("\n".join(rows))
    case = with_values(
        WHEELSET, wheelset__z=None, wheelset__vertical_force=2e4, profiles__wheel="cone.txt"
    )
    case["profiles"]["wheel_file"] = {"mirror": "none"}
    from_file = json.loads(run(tmp_path, case, "solve", "--json").stdout)
    case["profiles"] = {"wheel": "cone@1:20", "rail": case["profiles"]["rail"]}
    built_in = railpatch.solve(case)
    assert from_file["z"] == pytest.approx(built_in["z"], abs=1e-9)


def test_not_converged_is_exit_code_3(tmp_path: Path) -> None:
    case = with_values(PATCH, method={"max_iterations": 1, "tolerance": 1e-10})
    ran = run(tmp_path, case, "solve", "--json")
    assert ran.exit_code == 3
    assert json.loads(ran.stdout)["status"] == "not_converged"


def test_no_contact_is_exit_code_0(tmp_path: Path) -> None:
    ran = run(tmp_path, with_values(WHEELSET, wheelset__z=-1e-3), "solve", "--json")
    assert ran.exit_code == 0
    assert json.loads(ran.stdout)["status"] == "no_contact"


def test_explain_tells_what_is_left_out(tmp_path: Path) -> None:
    ran = run(tmp_path, with_values(PATCH, method__tangential="none", friction=None), "explain")
    assert ran.exit_code == 0
    rows = {line.split()[0]: line.split()[1:] for line in ran.stdout.splitlines() if line.strip()}
    assert rows["tangential"][0] == "no"
    assert rows["normal"][0] == "yes"
    assert rows["normal"][2] in ("B", "kB", "MB")
    assert rows["normal"][4] == "%"


def test_schema_is_json() -> None:
    ran = CliRunner().invoke(cli, ["schema"])
    assert ran.exit_code == 0
    assert json.loads(ran.stdout)["$defs"]["Load"]["properties"]["normal_force"]


@pytest.mark.parametrize("name", ["solve", "explain", "schema", "report"])
def test_version_and_quiet_work_everywhere(name: str) -> None:
    for arguments in ([name, "--version"], ["--version"], ["--quiet", name, "--version"]):
        ran = CliRunner().invoke(cli, arguments)
        assert ran.exit_code == 0, ran.output
        assert ran.stdout == f"railpatch {railpatch.__version__}\n"
    assert "--quiet" in CliRunner().invoke(cli, [name, "--help"]).stdout


def test_quiet_prints_no_table(tmp_path: Path) -> None:
    for arguments in (["--quiet", "solve"], ["solve", "--quiet"], ["--quiet", "explain"]):
        ran = run(tmp_path, PATCH, *arguments)
        assert (ran.exit_code, ran.stdout) == (0, "")
    assert json.loads(run(tmp_path, PATCH, "--quiet", "solve", "--json").stdout)


def test_other_packages_add_commands(monkeypatch: pytest.MonkeyPatch) -> None:
    @click.command()
    def extra() -> None:
        """Does nothing."""
        click.echo("extra")

    class Entry:
        name, value = "extra", "some.package:extra"

        def load(self) -> click.Command:
            return extra

    class Broken(Entry):
        name = "broken"

        def load(self) -> click.Command:
            raise ImportError("no such package")

    entries = {"extra": Entry(), "broken": Broken()}
    monkeypatch.setattr(Commands, "_outside", staticmethod(lambda: entries))
    assert CliRunner().invoke(cli, ["extra"]).stdout == "extra\n"
    assert "railpatch" in CliRunner().invoke(cli, ["extra", "--version"]).stdout
    assert "extra" in CliRunner().invoke(cli, ["--help"]).stdout
    ran = CliRunner().invoke(cli, ["broken"])
    assert ran.exit_code == 1
    assert "no such package" in ran.stderr


def test_the_installed_command(tmp_path: Path) -> None:
    path = tmp_path / "case.toml"
    path.write_text(toml(with_values(PATCH, load__normal_force=-1.0)))
    command = Path(sys.executable).with_name("railpatch")
    ran = subprocess.run([command, "solve", path], capture_output=True, text=True, check=False)
    assert ran.returncode == 2
    assert ran.stdout == ""
    assert "load.normal_force: value is -1.0, allowed >= 0.0" in ran.stderr
    assert "Traceback" not in ran.stderr
    assert sorted(tmp_path.iterdir()) == [path]
