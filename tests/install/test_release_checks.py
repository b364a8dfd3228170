"""The checks of wheels and FMUs themselves, on archives and names as they come."""

from __future__ import annotations

import base64
import hashlib
import importlib
import sys
import zipfile
from collections.abc import Iterator
from pathlib import Path
from types import ModuleType

import pytest
from railpatch.fmu.libraries import PLATFORMS3

PLUGINS = Path(__file__).parents[2] / "plugins"
OWN = ("check_wheels", "check", "build", "gather")
CONTENT = {"railpatch/own.py": b"own = 1\n", "railpatch-1.dist-info/METADATA": b"Name: own\n"}


@pytest.fixture
def wheels(monkeypatch: pytest.MonkeyPatch) -> Iterator[ModuleType]:
    """The program that looks at wheels; its modules are gone afterwards."""
    for folder in ("fmu/cross", "python_mbs/wheels"):
        monkeypatch.syspath_prepend(PLUGINS / folder)
    before = {name: sys.modules.pop(name) for name in OWN if name in sys.modules}
    yield importlib.import_module("check_wheels")
    for name in OWN:
        sys.modules.pop(name, None)
    sys.modules.update(before)


def written(path: Path, folders: bool, more: dict[str, bytes]) -> zipfile.ZipFile:
    """A wheel with its record; folders: as auditwheel writes it; more: content after the record."""
    lines = ["railpatch-1.dist-info/RECORD,,"]
    for name, content in CONTENT.items():
        digest = base64.urlsafe_b64encode(hashlib.sha256(content).digest()).decode().rstrip("=")
        lines.append(f"{name},sha256={digest},{len(content)}")
    with zipfile.ZipFile(path, "w") as archive:
        if folders:
            archive.writestr("railpatch/", b"")
        for name, content in {**CONTENT, **more}.items():
            archive.writestr(name, content)
        archive.writestr("railpatch-1.dist-info/RECORD", "\n".join(lines) + "\n")
    return zipfile.ZipFile(path)


@pytest.mark.parametrize("folders", [False, True])
def test_a_record_names_files_alone(wheels: ModuleType, tmp_path: Path, folders: bool) -> None:
    with written(tmp_path / "own.whl", folders, {}) as archive:
        wheels.check_record(archive)
        assert "railpatch/" not in wheels.files_in(archive)


@pytest.mark.parametrize(
    ("more", "told"),
    [
        ({"railpatch/other.py": b""}, "RECORD names every file"),
        ({"railpatch/own.py": b"own = 2\n"}, "own.py: as recorded"),
    ],
)
def test_what_is_not_recorded_is_found(
    wheels: ModuleType, tmp_path: Path, more: dict[str, bytes], told: str
) -> None:
    with (
        written(tmp_path / "own.whl", True, more) as archive,
        pytest.raises(SystemExit, match=told),
    ):
        wheels.check_record(archive)


def test_platforms_have_a_check_under_both_versions_names(wheels: ModuleType) -> None:
    known, built = sys.modules["check"].SYSTEM, sys.modules["build"].DEFAULT
    assert {name for p in built for name in (p, PLATFORMS3.get(p, p))} <= set(known)
