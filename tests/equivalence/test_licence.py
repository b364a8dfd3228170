"""The installed package holds what its licence says: FFTW in a build with FFTW alone."""

from __future__ import annotations

import re
from importlib import metadata
from pathlib import Path

from railpatch import _core

# names of its functions, of its library, and what it says of itself
FFTW = re.compile(rb"fftw_(plan|malloc|execute|destroy)|libfftw3|fftw-3")


def test_no_fftw_in_a_package_with_eigens_transforms() -> None:
    files = [Path(str(entry.locate())) for entry in metadata.files("railpatch") or ()]
    binaries = [path for path in files if path.suffix == ".so"]
    assert len(binaries) >= 2, "the extension module and the library of FMUs"
    found = {path.name for path in binaries if FFTW.search(path.read_bytes())}
    named = {path.name for path in files if re.search("fftw|GPL", path.name)}
    if _core.fft_backend() == "eigen":
        assert found == named == set()
    else:
        assert any(name.startswith("_core") for name in found)
    assert {"LICENSE", "NOTICE", "MPL-2.0.txt"} <= {path.name for path in files}
