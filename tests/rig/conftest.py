"""Scenes for the tests of the rig."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest

from rig_model.scene import MEASURED, NOMINAL, load_rig_scene, scenes


@pytest.fixture(scope="session")
def nominal_file() -> Path:
    """The package's scene with nominal profiles."""
    return scenes() / NOMINAL


@pytest.fixture(scope="session")
def measured_file() -> Path:
    """The package's scene with the measured profiles."""
    return scenes() / MEASURED


@pytest.fixture
def scene_with(tmp_path: Path, nominal_file: Path) -> Callable[..., Path]:
    """A copy of the nominal scene, beside its profiles, with some text replaced."""

    def write(*changes: tuple[str, str], end: str = "") -> Path:
        text = nominal_file.read_text()
        for old, new in changes:
            assert text.count(old) == 1, f"{old!r} occurs {text.count(old)} times"
            text = text.replace(old, new)
        for profile in nominal_file.parent.glob("*.csv"):
            (tmp_path / profile.name).write_bytes(profile.read_bytes())
        path = tmp_path / "scene.toml"
        path.write_text(text + end)
        return path

    return write


@pytest.fixture
def few(nominal_file: Path):
    """The nominal scene with five positions."""
    return load_rig_scene(nominal_file, {"positions": 5})
