"""The complete sources of the FMU's library, so that an importer can compile them.

One include folder is enough, the one that holds all: public headers, FMI's headers, the table of
variables and those of Eigen's headers that are used lie at its top.
"""

from __future__ import annotations

import re
import sys
import zipfile
from pathlib import Path

INCLUDE = re.compile(r'^\s*#\s*include\s*["<]([^">]+)[">]', re.MULTILINE)
# Eigen's code for processors on which no FMU runs
OTHER_PROCESSORS = {"AltiVec", "ZVector", "MSA", "SYCL", "GPU", "HIP", "SVE"}
EIGEN = ("/usr/include/eigen3", "/usr/local/include/eigen3", "/opt/homebrew/include/eigen3")
# an FMU takes those of its version: railpatch/fmu/sources.py
FMI = ("fmi2Functions.h", "fmi2FunctionTypes.h", "fmi2TypesPlatform.h")
FMI += ("fmi3Functions.h", "fmi3FunctionTypes.h", "fmi3PlatformTypes.h")
FIRST = b'#include "before_cxx20.hpp"\n'
README = """Sources of this FMU's library, for importers that compile them.

A compiler with GCC's extensions is needed (GCC 12 or Clang 15, or later; not Visual C++), in C++17
or later, of which C++17 gives a library that can be unloaded everywhere; this folder is the only
include folder. buildDescription.xml lists what to
compile, and the options. With fmpy on Linux:

  fmpy compile NAME.fmu
"""


def sources(root: Path, generated: Path, headers: Path) -> dict[str, bytes]:
    """Path in the archive -> content. generated: what CMake wrote; headers: FMI's."""
    files = {"README.txt": README.encode()}
    files |= {path.name: path.read_bytes() for path in generated.glob("*.inc")}
    core = [p for ending in ("cpp", "hpp", "inc") for p in (root / "core").glob(f"*/*.{ending}")]
    plugin = list((root / "plugins" / "fmu" / "src").glob("*.[ch]pp"))
    for path in core + plugin:
        if path.name not in ("fft_fftw.cpp", "many.cpp"):  # the other backend; threads
            first = FIRST if path.suffix == ".cpp" else b""
            # rooms of the core at the top, where their includes begin
            name = path.relative_to(root).as_posix().removeprefix("core/")
            files[name] = first + path.read_bytes()
    older = "before_cxx20.hpp"
    files[older] = Path(__file__).with_name(older).read_bytes()
    for header in ("railpatch.h", "railpatch_fields.h"):
        files[header] = (root / "core" / "include" / header).read_bytes()
    files |= {name: (headers / name).read_bytes() for name in FMI}
    files |= eigen_headers("unsupported/Eigen/FFT")
    return files


def eigen_headers(first: str) -> dict[str, bytes]:
    """That header and all that it includes."""
    root = next((Path(folder) for folder in EIGEN if (Path(folder) / first).is_file()), None)
    if root is None:
        sys.exit(f"Eigen 3.4 was not found in {', '.join(EIGEN)}")
    found: dict[str, bytes] = {}
    waiting = [(root / first).resolve()]
    while waiting:
        path = waiting.pop()
        name = path.relative_to(root.resolve()).as_posix()
        if name in found:
            continue
        found[name] = path.read_bytes()
        for include in INCLUDE.findall(found[name].decode("utf-8", "replace")):
            places = (path.parent / include, root / include)
            header = next((place for place in places if place.is_file()), None)
            if header is not None and not OTHER_PROCESSORS & set(header.parts):
                waiting.append(header.resolve())
    return found


def write(files: dict[str, bytes], path: Path) -> None:
    """An archive that is the same for the same files."""
    path.parent.mkdir(parents=True, exist_ok=True)
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, content in sorted(files.items()):
            archive.writestr(zipfile.ZipInfo(name), content, zipfile.ZIP_DEFLATED)
