"""What is packed beside the scene: libraries of several systems, sources, picture, reference."""

from __future__ import annotations

import csv
import re
import struct
import zipfile
import zlib
from collections.abc import Callable
from pathlib import Path

import pytest
from fmpy import read_model_description
from fmpy.model_description import read_build_description
from fmpy.validation import validate_fmu
from fmu_scenes import OWN, SCENES
from railpatch.case import load_scene
from railpatch.errors import CaseError
from railpatch.fmu import pack_fmu
from railpatch.fmu.libraries import libraries_of, stamp
from slave import Fmu, Slave

PLATFORMS = {
    "linux64": ".so",
    "win64": ".dll",
    "aarch64-linux": ".so",
    "darwin64": ".dylib",
    "aarch64-darwin": ".dylib",
}
SOURCES = {"core/a.cpp": b"int a;\n", "core/a.hpp": b"", "plugins/b.cpp": b"int b;\n"}


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """Like one of `make fmu`: this machine's library for its own, marks for the others."""
    own = libraries_of(OWN).binaries["linux64"]
    for platform, ending in PLATFORMS.items():
        place = tmp_path / "lib" / platform
        place.mkdir(parents=True)
        content = own if platform == "linux64" else platform.encode()
        (place / f"railpatch_fmu_{OWN}{ending}").write_bytes(content)
    with zipfile.ZipFile(tmp_path / "lib" / "sources.zip", "w") as archive:
        for name, content in SOURCES.items():
            archive.writestr(name, content)
    (tmp_path / "lib" / "stamp.txt").write_text(stamp())
    (tmp_path / "lib" / "licenses").mkdir()
    (tmp_path / "lib" / "licenses" / "Other.txt").write_text("a licence")
    (tmp_path / "lib" / "runtime.txt").write_text("- a runtime library.\n")
    return tmp_path / "lib"


@pytest.mark.parametrize("text", [None, "0.0.1 0123456789abcdef"])
def test_libraries_of_another_version_are_refused(
    folder: Path, tmp_path: Path, text: str | None
) -> None:
    (folder / "stamp.txt").unlink()
    if text is not None:
        (folder / "stamp.txt").write_text(text)
    path = tmp_path / "none.fmu"
    found = "holds no libraries" if text is None else "libraries are of another version"
    with pytest.raises(CaseError, match=rf"{found}.*make fmu"):
        pack_fmu(load_scene(SCENES["patch"]), path, backend=OWN, libraries=folder)
    assert not path.exists()


def test_every_platform_and_the_sources_are_packed(folder: Path, tmp_path: Path) -> None:
    path = tmp_path / "many.fmu"
    pack_fmu(load_scene(SCENES["patch"]), path, backend=OWN, libraries=folder)
    assert validate_fmu(str(path)) == []
    description = read_model_description(str(path))
    identifier = description.coSimulation.modelIdentifier
    with zipfile.ZipFile(path) as archive:
        names = set(archive.namelist())
        for platform, ending in PLATFORMS.items():
            assert f"binaries/{platform}/{identifier}{ending}" in names
        assert archive.read(f"binaries/win64/{identifier}.dll") == b"win64"
        for name, content in SOURCES.items():
            assert archive.read(f"sources/{name}") == content
        notice = archive.read("documentation/licenses/NOTICE.txt").decode()
        assert "documentation/licenses/Other.txt" in names
    assert "a runtime library" in notice
    assert "GCC runtime" not in notice
    [listed] = description.buildConfigurations[0].sourceFileSets
    assert listed.sourceFiles == ["core/a.cpp", "plugins/b.cpp"]
    [built] = read_build_description(str(path))
    assert built.modelIdentifier == identifier
    assert built.sourceFileSets[0].sourceFiles == listed.sourceFiles


def test_other_libraries_another_guid(folder: Path, tmp_path: Path) -> None:
    guids = set()
    for content in (b"one", b"two"):
        (folder / "win64" / f"railpatch_fmu_{OWN}.dll").write_bytes(content)
        path = tmp_path / "same.fmu"
        pack_fmu(load_scene(SCENES["patch"]), path, backend=OWN, libraries=folder)
        guids.add(read_model_description(str(path)).guid)
    assert len(guids) == 2


def test_a_folder_without_libraries_is_refused(tmp_path: Path) -> None:
    with pytest.raises(CaseError, match=re.escape(str(tmp_path))):
        pack_fmu(load_scene(SCENES["patch"]), tmp_path / "a.fmu", libraries=tmp_path)


def test_picture_is_a_png(unpacked: Callable[..., Fmu]) -> None:
    content = (unpacked("patch").folder / "model.png").read_bytes()
    assert content.startswith(b"\x89PNG\r\n\x1a\n")
    place, parts = 8, {}
    while place < len(content):
        (length,) = struct.unpack_from(">I", content, place)
        kind, body = content[place + 4 : place + 8], content[place + 8 : place + 8 + length]
        (checksum,) = struct.unpack_from(">I", content, place + 8 + length)
        assert checksum == zlib.crc32(kind + body)
        parts[kind], place = body, place + 12 + length
    width, height, depth, colour = struct.unpack_from(">IIBB", parts[b"IHDR"])
    assert (depth, colour) == (8, 2)
    assert len(zlib.decompress(parts[b"IDAT"])) == height * (1 + 3 * width)


@pytest.mark.parametrize(
    ("name", "output"),
    [
        ("patch", "creep_force[1]"),
        ("left_wheel", "patch[1].position[2]"),
        ("rail", "right.patch[1].creepage[2]"),
        ("loaded", "z"),
    ],
)
def test_reference_is_what_the_slave_starts_with(
    name: str, output: str, unpacked: Callable[..., Fmu]
) -> None:
    fmu = unpacked(name)
    text = (fmu.folder / "documentation" / "reference.csv").read_text()
    rows = list(csv.DictReader(line for line in text.splitlines() if not line.startswith("#")))
    with Slave(fmu).initialize() as slave:
        outputs = slave.outputs()
    assert output in {row["name"] for row in rows}
    for row in rows:
        expected = pytest.approx(float(row["value"]), rel=1e-12, abs=1e-12)
        assert outputs[row["name"]] == expected, row["name"]
