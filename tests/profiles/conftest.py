"""Where the reference profiles are, and profile files made for a test."""

from __future__ import annotations

import os
from collections.abc import Callable
from pathlib import Path

import pytest

PROJECT = Path(__file__).parents[2]


@pytest.fixture(scope="session")
def reference_profiles() -> Path:
    """The folder of the measured profiles."""
    folder = os.environ.get("RAILPATCH_REFERENCE", PROJECT.parent / "shared" / "reference")
    profiles = Path(folder) / "profiles"
    if not profiles.is_dir():
        pytest.skip(f"no reference data: {profiles} is absent, set RAILPATCH_REFERENCE")
    return profiles


@pytest.fixture
def write(tmp_path: Path) -> Callable[[str, str], Path]:
    """Writes a text file and returns its path."""

    def write_file(name: str, text: str) -> Path:
        path = tmp_path / name
        path.write_text(text)
        return path

    return write_file
