"""A disk that is full at any write ends a command with a line that names the file; what stood there
before stays, and nothing half is left beside it."""

from __future__ import annotations

import resource
import shutil
import signal
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest
from click.testing import CliRunner, Result
from railpatch.command.cli import cli
from railpatch.log.reader import RunFileError, read_run

# name of what is written, and the command
WHOLE = {
    "page.html": "profile S1002",
    "case.fmu": "fmu --scene patch",
    "report.html": "report run.mcap",
    "layout.json": "layout run.mcap",
}
LOGS = {
    "rig.mcap": "rig --positions 2 --quiet",
    "wheelset.mcap": "wheelset --distance 0.02 --quiet",
}
# bytes that a file may have: none, a part of its head, and so on in threes
SIZES = [0, *(4 * 3**k for k in range(1, 13))]


@contextmanager
def disk_of(size: int) -> Iterator[None]:
    """Files can be no longer than that."""
    soft, hard = resource.getrlimit(resource.RLIMIT_FSIZE)
    handler = signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
    resource.setrlimit(resource.RLIMIT_FSIZE, (size, hard))
    try:
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, (soft, hard))
        signal.signal(signal.SIGXFSZ, handler)


def run(command: str, output: str) -> Result:
    return CliRunner().invoke(cli, [*command.split(), "-o", output])


@pytest.fixture(scope="module")
def log(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("log") / "run.mcap"
    assert run("rig --positions 2 --quiet", str(path)).exit_code == 0
    return path


@pytest.mark.parametrize("output", WHOLE)
def test_what_was_there_stays(
    output: str, log: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    shutil.copy(log, "run.mcap")
    Path(output).write_bytes(b"before")
    refused = 0
    for size in SIZES[::5]:
        with disk_of(size):
            ran = run(WHOLE[output], output)
        if ran.exit_code == 0:
            break
        refused += 1
        assert isinstance(ran.exception, SystemExit)
        assert ran.exit_code == 2
        assert output in ran.stderr
        assert "File too large" in ran.stderr
        assert Path(output).read_bytes() == b"before"
        assert {path.name for path in tmp_path.iterdir()} == {output, "run.mcap"}
    assert refused > 1


@pytest.mark.parametrize("output", LOGS)
def test_a_log_keeps_what_was_written(
    output: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    refused = 0
    for size in SIZES[::2]:
        with disk_of(size):
            ran = run(LOGS[output], output)
        if ran.exit_code == 0:
            break
        refused += 1
        assert isinstance(ran.exception, SystemExit)
        assert ran.exit_code == 2
        assert f"{output}: File too large" in ran.stderr
        assert Path(output).stat().st_size <= size
        try:
            assert read_run(output).truncated
        except RunFileError as error:
            assert size < 60_000, error  # noqa: PT017 - cut off before it says what it is
    assert refused > 3
    assert ran.exit_code == 0
