"""Where the resources are: folder names and ways to write their place; what is wrong is said."""

from __future__ import annotations

import shutil
import zlib
from collections.abc import Callable
from pathlib import Path
from urllib.parse import quote

import pytest
from slave import ERROR, Fmu, Slave

Unpack = Callable[..., Fmu]
NAMES = ["plain", "with space", "100%", "%41bc", "a#b", "c++", "Prüfstand Ä", "q?x=1&y", "..dots"]
FORMS: dict[str, Callable[[str], str]] = {
    "encoded": lambda path: "file://" + quote(path),
    "raw": lambda path: "file://" + path,
    "one slash": lambda path: "file:" + quote(path),
    "four slashes": lambda path: "file://" + quote("//"[1:] + path),
    "trailing slash": lambda path: "file://" + quote(path) + "/",
    "localhost": lambda path: "file://localhost" + quote(path),
    "capitals": lambda path: "FILE://" + quote(path),
    "path": lambda path: path,
    "path with slash": lambda path: path + "/",
}


@pytest.mark.parametrize("name", NAMES)
def test_resources_are_found(name: str, unpacked: Unpack, tmp_path: Path) -> None:
    fmu = unpacked("patch_normal")
    folder = tmp_path / name / "resources"
    shutil.copytree(fmu.folder / "resources", folder)
    for form, spell in FORMS.items():
        with Slave(fmu, location=spell(str(folder))) as slave:
            assert slave.component, (form, spell(str(folder)), slave.log)
            assert slave.log == []


def test_missing_resources_are_an_error_that_names_the_path(
    unpacked: Unpack, tmp_path: Path
) -> None:
    with Slave(unpacked("patch"), location=f"file://{tmp_path}/not%20here") as slave:
        assert slave.component is None
        [(status, category, text)] = slave.log
        assert (status, category) == (ERROR, "logStatusError")
        assert f"{tmp_path}/not here/scene.txt" in text
        assert f"{tmp_path}/not%%20here/scene.txt" in text  # "%" is doubled for printf
    for location in ("", "file://", "nonsense"):
        with Slave(unpacked("patch"), location=location or " ") as slave:
            assert slave.component is None
            assert len(slave.log) == 1
    with Slave(unpacked("patch"), location=None) as slave:
        assert slave.component is None
        assert "fmuResourceLocation is NULL" in slave.log[0][2]


def test_a_damaged_scene_is_refused(unpacked: Unpack, tmp_path: Path) -> None:
    content = (unpacked("patch").folder / "resources" / "scene.txt").read_bytes()
    damaged = {
        "cut": content[: len(content) // 2],
        "changed": content.replace(b"set gauge 1.435", b"set gauge 1.436"),
        "unknown": signed(b"railpatch-fmu-scene 1\nset nothing 1\n"),
        "version": signed(b"railpatch-fmu-scene 2\n"),
        "binary": bytes(range(256)),
        "empty": b"",
        "count": signed(b"railpatch-fmu-scene 1\nprofile wheel 0 y 99999999999 1.0\n"),
        "bad": signed(content.split(b"end ")[0].replace(b"tolerance 1e-05", b"tolerance 7.0")),
        "other": (unpacked("rail").folder / "resources" / "scene.txt").read_bytes(),
    }
    for name, altered in damaged.items():
        (tmp_path / "scene.txt").write_bytes(altered)
        with Slave(unpacked("patch"), location=str(tmp_path)) as slave:
            assert slave.component is None, name
            assert len(slave.log) == 1, name


def test_a_missing_or_damaged_creep_table_is_refused(unpacked: Unpack, tmp_path: Path) -> None:
    resources = unpacked("table").folder / "resources"
    shutil.copy(resources / "scene.txt", tmp_path)
    with Slave(unpacked("table"), location=str(tmp_path)) as slave:
        assert slave.component is None
        assert f"{tmp_path}/creep_table.bin" in slave.log[0][2]
    table = bytearray((resources / "creep_table.bin").read_bytes())
    table[len(table) // 2] ^= 1
    (tmp_path / "creep_table.bin").write_bytes(table)
    with Slave(unpacked("table"), location=str(tmp_path)) as slave:
        assert slave.component is None
        assert "creep_table has a wrong checksum" in slave.log[0][2]
    # scenes without it carry none
    assert not (unpacked("patch").folder / "resources" / "creep_table.bin").exists()


def signed(body: bytes) -> bytes:
    """With a good last line."""
    return body + f"end {zlib.crc32(body):08x}\n".encode()
