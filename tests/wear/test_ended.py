"""A signal ends ``railpatch wear`` with a line that says how to go on."""

from __future__ import annotations

import os
import signal
from pathlib import Path
from typing import Any

import pytest
from click.testing import CliRunner
from railpatch.command.cli import cli


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_ended(number: signal.Signals, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def ended(*_: Any, **__: Any) -> None:
        os.kill(os.getpid(), number)

    monkeypatch.setattr("railpatch.wear.plan.load_wear", lambda _: None)
    monkeypatch.setattr("railpatch.wear.evolve.wear_profiles", ended)
    before = [signal.getsignal(n) for n in (signal.SIGINT, signal.SIGTERM)]
    ran = CliRunner().invoke(cli, ["wear", "a.toml", "-o", str(tmp_path / "out")])
    assert ran.exit_code == 128 + number
    assert f"ended by {number.name}: steps that are done are in" in ran.stderr
    assert "the same command goes on there" in ran.stderr
    assert "Traceback" not in ran.stderr
    assert [signal.getsignal(n) for n in (signal.SIGINT, signal.SIGTERM)] == before
