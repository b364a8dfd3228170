"""Without Pinocchio, or with another package of that name, the message says what to install."""

from __future__ import annotations

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
