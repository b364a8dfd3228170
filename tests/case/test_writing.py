"""Files are written whole or not at all; what is no file is written through."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path
from threading import Thread

import pytest
from case_samples import PATCH
from click.testing import CliRunner
from railpatch.case import load_scene
from railpatch.command.cli import cli
from railpatch.fmu import pack_fmu
from railpatch.writing import write_whole

FULL = Path("/dev/full")  # every write to it fails as on a full disk


def test_a_pipe_is_written_through_and_stays(tmp_path: Path) -> None:
    pipe, read = tmp_path / "pipe", []
    os.mkfifo(pipe)
    reader = Thread(target=lambda: read.append(pipe.read_bytes()))
    reader.start()
    write_whole(pipe, b"content")
    reader.join()
    assert read == [b"content"]
    assert pipe.is_fifo()


def test_links_are_followed_and_rights_kept(tmp_path: Path) -> None:
    target, link = tmp_path / "target", tmp_path / "link"
    target.write_bytes(b"before")
    target.chmod(0o640)
    link.symlink_to(target)
    write_whole(link, b"after")
    assert link.is_symlink()
    assert target.read_bytes() == b"after"
    assert target.stat().st_mode & 0o777 == 0o640
    assert sorted(tmp_path.iterdir()) == [link, target]


def test_what_fails_leaves_the_file_as_it_was(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    file = tmp_path / "file"
    file.write_bytes(b"before")

    def full(_path: Path, _content: bytes) -> int:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(Path, "write_bytes", full)
    with pytest.raises(OSError, match="No space left"):
        write_whole(file, b"after")
    assert file.read_bytes() == b"before"
    assert list(tmp_path.iterdir()) == [file]


def test_an_fmu_goes_through_a_pipe(tmp_path: Path) -> None:
    pipe, read = tmp_path / "pipe", []
    os.mkfifo(pipe)
    reader = Thread(target=lambda: read.append(pipe.read_bytes()))
    reader.start()
    pack_fmu(load_scene(PATCH), pipe)
    reader.join()
    assert read[0].startswith(b"PK")
    assert pipe.is_fifo()


@pytest.mark.parametrize("command", ["report run.mcap", "profile S1002"])
def test_a_page_is_written_under_a_page_s_name_only(tmp_path: Path, command: str) -> None:
    for name in ("x.docx", "x.png"):
        done = CliRunner().invoke(cli, [*command.split(), "-o", str(tmp_path / name)])
        assert done.exit_code == 2
        assert "allowed a name that ends in .html or .htm" in done.output


def test_a_full_disk_behind_standard_output_is_told() -> None:
    with FULL.open("wb") as out:
        done = subprocess.run(
            [sys.executable, "-m", "railpatch.command.cli", "schema"],
            stdout=out,
            stderr=subprocess.PIPE,
            text=True,
            check=False,
        )
    assert done.returncode == 2
    assert "output: cannot be written: No space left on device" in done.stderr
    assert "Traceback" not in done.stderr
