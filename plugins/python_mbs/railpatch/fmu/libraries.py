"""What was built beforehand: the libraries of all platforms, the sources, and their licences.

A folder holds PLATFORM/railpatch_fmu_BACKEND.ENDING (FMI 2.0) and railpatch_fmu3_BACKEND.ENDING
(FMI 3.0) for every platform, by FMI 2.0's name; where it was made by `make fmu` also sources.zip,
licenses/, runtime.txt and stamp.txt.
"""

from __future__ import annotations

import hashlib
import zipfile
from dataclasses import dataclass
from importlib import resources
from pathlib import Path
from typing import TYPE_CHECKING

from railpatch._core import version
from railpatch.errors import CaseError
from railpatch.fmu.document import notice
from railpatch.fmu.sources import of_version

if TYPE_CHECKING:
    from importlib.resources.abc import Traversable

# FMI 3.0's names of the platforms that FMI 2.0 has
PLATFORMS3 = {
    "linux64": "x86_64-linux",
    "win64": "x86_64-windows",
    "darwin64": "x86_64-darwin",
}
ENDINGS = {"win": ".dll", "lin": ".so", "dar": ".dylib"}


@dataclass(frozen=True)
class Libraries:
    """Content of such a folder, for one backend."""

    binaries: dict[str, bytes]  # by platform
    sources: dict[str, bytes]  # path below sources/
    licences: dict[str, bytes]  # name of the text
    runtime: str | None  # what the compiler added; None: that of GCC

    def files(self, identifier: str, backend: str) -> dict[str, bytes]:
        """Path in the archive -> content."""
        files = {f"sources/{path}": content for path, content in self.sources.items()}
        for platform, content in self.binaries.items():
            files[f"binaries/{platform}/{identifier}{ending(platform)}"] = content
        for name, content in self.licences.items():
            if backend == "fftw" or not name.startswith("GPL"):
                files[f"documentation/licenses/{name}"] = content
        text = notice(backend, self.runtime)
        return {**files, "documentation/licenses/NOTICE.txt": text.encode()}


def ending(platform: str) -> str:
    """Of a library's name: win64 -> .dll, aarch64-linux -> .so."""
    return ENDINGS[platform.rpartition("-")[2][:3]]


def stamp() -> str:
    """What libraries and this package must have in common: version, table of variables."""
    table = (resources.files("railpatch.fmu") / "variables.toml").read_bytes()
    return f"{version()} {hashlib.sha256(table).hexdigest()[:16]}"


def libraries_of(backend: str, folder: Path | None = None, version: int = 2) -> Libraries:
    """Those of a folder; without one those that were built with the package. version: of FMI.
    Raises CaseError."""
    own = resources.files("railpatch.fmu")
    root: Traversable = own / "lib" if folder is None else folder
    made = root / "stamp.txt"
    if folder is not None and not made.is_file():
        raise CaseError(
            f"--libraries: value is {str(folder)!r}, which holds no libraries of an FMU, "
            "allowed a folder that `make fmu` or `make fmu-fftw` made"
        )
    if folder is not None and made.read_text().strip() != stamp():
        raise CaseError(
            f"--libraries: value is {str(folder)!r}, whose libraries are of another version, "
            "allowed those of this one: run `make fmu` or `make fmu-fftw` again"
        )
    binaries = {}
    for place in sorted(root.iterdir(), key=lambda p: p.name) if root.is_dir() else ():
        if place.name[:3] in ENDINGS or "-" in place.name:
            name = "railpatch_fmu3" if version == 3 else "railpatch_fmu"
            path = place / f"{name}_{backend}{ending(place.name)}"
            platform = PLATFORMS3.get(place.name, place.name) if version == 3 else place.name
            if path.is_file():
                binaries[platform] = path.read_bytes()
    if not binaries:
        where = "this package was built without it" if folder is None else f"{folder} has none"
        raise CaseError(f"--fft: value is {backend!r}, but {where}")
    runtime = root / "runtime.txt"
    return Libraries(
        binaries=binaries,
        sources={
            path: content
            for path, content in sources_of(root / "sources.zip").items()
            if of_version(path, version)
        },
        licences={**texts_of(own / "licenses"), **texts_of(root / "licenses")},
        runtime=runtime.read_text(encoding="utf-8") if runtime.is_file() else None,
    )


def texts_of(folder: Traversable) -> dict[str, bytes]:
    """Name -> content of a folder's files."""
    if not folder.is_dir():
        return {}
    return {p.name: p.read_bytes() for p in sorted(folder.iterdir(), key=lambda p: p.name)}


def sources_of(path: Traversable) -> dict[str, bytes]:
    """The files of an archive; none where it is absent."""
    if not path.is_file():
        return {}
    with path.open("rb") as file, zipfile.ZipFile(file) as archive:
        return {name: archive.read(name) for name in sorted(archive.namelist())}
