"""FMUs of the shared scenes, packed and unpacked once a session."""

from __future__ import annotations

import zipfile
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from fmu_scenes import OWN, SCENES
from railpatch.case import load_scene
from railpatch.fmu import pack_fmu
from slave import Fmu

# the library with FFTW, which packages with Eigen's transforms leave out: `make fmu-fftw`
FFTW = Path(__file__).parents[2] / "build/fmu_fftw/railpatch/fmu/lib"


@pytest.fixture(scope="session")
def packed(tmp_path_factory: pytest.TempPathFactory) -> Callable[..., Path]:
    """Name of a scene, backend -> path of its FMU."""
    folder = tmp_path_factory.mktemp("fmu")

    def pack(name: str, backend: Any = OWN) -> Path:
        path = folder / f"{name}_{backend}.fmu"
        if not path.exists():
            libraries = FFTW if backend == "fftw" != OWN else None
            scene = load_scene(SCENES[name])
            pack_fmu(scene, path, name=name, backend=backend, libraries=libraries)
        return path

    return pack


@pytest.fixture(scope="session")
def unpacked(packed: Callable[..., Path]) -> Callable[..., Fmu]:
    """Name of a scene, backend -> its FMU, unpacked and loaded."""
    found: dict[Any, Fmu] = {}

    def unpack(name: str, backend: str = OWN) -> Fmu:
        if (name, backend) not in found:
            path = packed(name, backend)
            folder = path.with_suffix("")
            zipfile.ZipFile(path).extractall(folder)
            found[name, backend] = Fmu(folder)
        return found[name, backend]

    return unpack
