"""Fixtures shared by all tests."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

PROJECT = Path(__file__).resolve().parents[1]


@pytest.fixture(scope="session")
def reference() -> Path:
    """The folder of published numbers and measured profiles; a user may not have it."""
    folder = Path(os.environ.get("RAILPATCH_REFERENCE", PROJECT.parent / "shared" / "reference"))
    if not folder.is_dir():
        pytest.skip(f"no reference data: {folder} is absent, set RAILPATCH_REFERENCE")
    return folder


@pytest.fixture(scope="session")
def reference_profiles(reference: Path) -> Path:
    """The folder of the measured profiles."""
    return reference / "profiles"
