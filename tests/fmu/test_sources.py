"""Sources as importers compile them: what their library shows, and that it can be unloaded."""

from __future__ import annotations

import importlib.util
import re
import shutil
import subprocess
from pathlib import Path

import fmpy
import pytest

ROOT = Path(__file__).parents[2]
CROSS = ROOT / "plugins" / "fmu" / "cross"
# what in the packed sources does so by itself, without the core behind it
LIBRARY = """
#include "plugins/fmu/src/log.hpp"
#include "railpatch.h"

namespace railpatch {
inline const std::string &own() {
  static const std::string text = "own";
  return text;
}
}  // namespace railpatch
const char *rp_error_text(rp_error) { return railpatch::own().c_str(); }
extern "C" FMI2_Export const char *fmi2GetVersion() {
  static std::string text;
  text = rp_error_text(RP_OK) + railpatch::fmu::text_of(1.5) + railpatch::fmu::text_of_whole(2);
  return text.c_str();
}
"""
PROGRAM = """
#include <dlfcn.h>
#include <cstring>
int main(int, char **arguments) {
  for (int k = 0; k < 3; ++k) {
    void *library = dlopen(arguments[1], RTLD_NOW);
    if (library == nullptr) return 1;
    const auto version = reinterpret_cast<const char *(*)()>(dlsym(library, "fmi2GetVersion"));
    if (version == nullptr || std::strcmp(version(), "own1.52") != 0) return 2;
    if (dlclose(library) != 0 || dlopen(arguments[1], RTLD_NOW | RTLD_NOLOAD)) return 3;
  }
  return 0;
}
"""


def packed_sources() -> dict[str, bytes]:
    """The files below sources/, but for the table of variables and Eigen."""
    spec = importlib.util.spec_from_file_location("gather", CROSS / "gather.py")
    assert spec is not None
    assert spec.loader is not None
    gather = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(gather)
    headers = Path(fmpy.__file__).parent / "c-code"
    return gather.sources(ROOT, ROOT / "absent", headers)


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The sources, in a folder."""
    place = tmp_path_factory.mktemp("sources")
    for name, content in packed_sources().items():
        if not name.startswith(("Eigen/", "unsupported/")):
            (place / name).parent.mkdir(parents=True, exist_ok=True)
            (place / name).write_bytes(content)
    return place


def compiled(folder: Path, name: str, text: str, *options: str) -> Path:
    """A library or program of the text."""
    compiler = shutil.which("g++") or shutil.which("c++")
    assert compiler is not None
    source, made = folder / f"{name}.cpp", folder / name
    source.write_text(text)
    command = [compiler, "-std=c++17", f"-I{folder}", *options, str(source), "-o", str(made)]
    subprocess.run(command, check=True)
    return made


def test_every_source_begins_by_hiding_what_is_not_of_fmi(folder: Path) -> None:
    sources = list(folder.rglob("*.cpp"))
    assert len(sources) > 50
    for path in sources:
        assert path.read_text().startswith('#include "before_cxx20.hpp"\n'), path
    # these hold tables in templates of the standard library, which no option here hides
    own = list(folder.glob("plugins/**/*.cpp"))
    assert not [p for p in own if re.search(r"std::(to_string|make_shared)", p.read_text())]


def test_a_library_without_options_shows_functions_of_fmi_and_unloads(folder: Path) -> None:
    """As fmpy compiles it: no options for visibility or the linker, and a program without C++."""
    first = '#include "before_cxx20.hpp"\n#include "fmi2Functions.h"\n'
    log = f"{folder}/plugins/fmu/src/log.cpp"
    made = compiled(folder, "own.so", first + LIBRARY, "-O3", "-fPIC", "-shared", log)
    listed = subprocess.run(
        ["nm", "-DC", "--defined-only", made], capture_output=True, text=True, check=True
    ).stdout
    symbols = [line.split(maxsplit=2)[1:] for line in listed.splitlines()]
    # pieces of templates of the standard library stay, and can be replaced by any other's
    rest = [name for kind, name in symbols if not (kind == "W" and "std::" in name)]
    assert rest == ["fmi2GetVersion"]
    program = compiled(folder, "program", PROGRAM, "-ldl")
    assert subprocess.run([program, made], check=False).returncode == 0
