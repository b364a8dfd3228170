"""Without Pinocchio, or with another package of that name, the message says what to install."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest

ADVICE = "pip install 'railpatch[pinocchio]'"


@pytest.mark.parametrize("content", ["raise ImportError('absent')", "VERSION = 1"])
def test_advice(content: str, tmp_path: Path):
    (tmp_path / "pinocchio.py").write_text(content)
    environment = os.environ | {"PYTHONPATH": str(tmp_path)}

    def run(*arguments: str) -> subprocess.CompletedProcess[str]:
        command = [sys.executable, *arguments]
        return subprocess.run(command, capture_output=True, text=True, env=environment)

    imported = run("-c", "import railpatch.pinocchio")
    assert imported.returncode == 1
    assert ADVICE in imported.stderr
    log = tmp_path / "run.mcap"
    called = run("-m", "railpatch.command.cli", "wheelset", "-o", str(log))
    assert called.returncode == 2
    assert ADVICE in called.stderr
    assert not log.exists()


# calls in one process without Pinocchio: their exit codes and what they print
CALLS = """
import json, sys
from click.testing import CliRunner
from railpatch.command.cli import cli
for call in json.loads(sys.argv[1]):
    done = CliRunner().invoke(cli, call)
    unexpected = done.exception is not None and not isinstance(done.exception, SystemExit)
    print(json.dumps([repr(done.exception) if unexpected else done.exit_code, done.output]))
"""


def calls_without(tmp_path: Path, calls: list[list[str]]) -> list[tuple[int | str, str]]:
    """Exit code and output of each."""
    (tmp_path / "pinocchio.py").write_text("raise ImportError('absent')")
    done = subprocess.run(
        [sys.executable, "-c", CALLS, json.dumps(calls)],
        capture_output=True,
        text=True,
        check=True,
        env=os.environ | {"PYTHONPATH": str(tmp_path)},
    )
    return [tuple(json.loads(line)) for line in done.stdout.splitlines()]


def test_commands_say_it_before_they_read_options(tmp_path: Path):
    sweep = tmp_path / "sweep.toml"
    sweep.write_text(
        '[sweep]\nscene = "wheelset_run.toml"\noutputs = ["distance"]\n'
        '[[vary]]\nkey = "run.step"\nvalues = [1e-3, 2e-3]\n'
    )
    # these need nothing, and the last one writes what is swept
    telling = [
        ["vehicle", "--help"],
        ["hunting", "--show-scene"],
        ["schema", "--kind", "vehicle"],
        ["init", "wheelset_run", str(tmp_path)],
    ]
    # options that there are not, and no output: each would be refused if it were read first
    names = ["wheelset", "hunting", "vehicle", "cosimulation"]
    needing = [[name, "--wrong", "absent.toml"] for name in names]
    needing.append(["sweep", str(sweep), "-o", str(tmp_path / "out")])
    found = calls_without(tmp_path, telling + needing)
    told, refused = found[: len(telling)], found[len(telling) :]
    assert [code for code, _ in told] == [0, 0, 0, 0], told
    assert "Usage: " in told[0][1]
    assert "[run]" in told[1][1]
    assert json.loads(told[2][1])["title"] == "Railpatch scene: vehicle"
    assert (tmp_path / "wheelset_run.toml").is_file()
    for call, (code, text) in zip(needing, refused, strict=True):
        assert code == 2, (call, text)
        assert ADVICE in text, (call, text)
        assert "--wrong" not in text, (call, text)
