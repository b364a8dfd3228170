"""Completion in shells: what bash offers after TAB, and the scripts for the shells that
docs/install.md names."""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
from click.shell_completion import ShellComplete, get_completion_class
from railpatch.case.kinds import kinds
from railpatch.command.cli import cli
from railpatch.fmu import scenes

ROOT = Path(__file__).resolve().parents[2]
VARIABLE = "_RAILPATCH_COMPLETE"
# the words typed so far as bash hands them over, the last one begun
ASK = 'COMP_WORDS=("$@"); COMP_CWORD=$(($# - 1)); _railpatch_completion railpatch; '
SHOW = 'printf "%s\\n" "${COMPREPLY[@]}"'


def offered(*words: str) -> set[str]:
    """What is offered for the last word."""
    shell = ShellComplete(cli, {}, "railpatch", VARIABLE)
    return {item.value for item in shell.get_completions(list(words[:-1]), words[-1])}


def kind_of(*words: str) -> set[str]:
    """Whether it is files that the shell offers."""
    shell = ShellComplete(cli, {}, "railpatch", VARIABLE)
    return {item.type for item in shell.get_completions(list(words[:-1]), words[-1])}


def test_bash_offers_commands():
    bash = shutil.which("bash")
    assert bash is not None
    # the command of this environment, not one that is installed elsewhere
    places = [str(Path(sys.executable).parent), os.environ["PATH"]]
    environment = os.environ | {"PATH": os.pathsep.join(places)}
    script = f'eval "$({VARIABLE}=bash_source railpatch)"; {ASK}{SHOW}'
    done = subprocess.run(
        [bash, "-c", script, "bash", "railpatch", "so"],
        capture_output=True,
        text=True,
        check=True,
        env=environment,
    )
    assert done.stdout.split() == ["solve"], done.stderr


def test_commands_options_and_values():
    assert offered("wh") == {"wheelset"}
    assert {"--json", "--fields", "--strict"} <= offered("solve", "--")
    assert offered("init", "") == set(kinds())
    assert offered("schema", "--kind", "wheel") == {n for n in kinds() if n.startswith("wheel")}
    assert offered("fmu", "--scene", "") == set(scenes.kinds())
    assert offered("rig", "--method", "") == {"newton", "broyden"}


def test_files_are_left_to_the_shell():
    assert kind_of("solve", "ca") == {"file"}
    assert kind_of("wheelset", "") == {"file"}
    assert kind_of("profile", "mine.") == {"file"}
    assert kind_of("profile", "S1002", "--rail", "") == {"file"}
    assert kind_of("sweep", "plan.toml", "-o", "") == {"dir"}


@pytest.mark.parametrize("name", ["bash", "zsh", "fish"])
def test_documented_shells(name: str):
    text = (ROOT / "docs/install.md").read_text(encoding="utf-8")
    assert f"{VARIABLE}={name}_source railpatch" in text
    shell = get_completion_class(name)
    assert shell is not None
    # bash's own source() asks for its version
    script = shell.source_template % shell(cli, {}, "railpatch", VARIABLE).source_vars()
    assert re.search(rf"{VARIABLE}={name}_complete", script)
