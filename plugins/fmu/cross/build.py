"""Builds the FMU's libraries for all platforms: python build.py FOLDER

Everything is made below FOLDER; what `railpatch fmu --libraries` takes is in FOLDER/lib. Needs the
Python packages railpatch (of this checkout), ziglang (Clang for all systems, with their headers)
and fmpy (the headers of FMI), CMake, Ninja and Eigen. --platforms names some of those below.
"""

from __future__ import annotations

import argparse
import importlib.util
import os
import shutil
import subprocess
import sys
from collections.abc import Sequence
from pathlib import Path

import gather
from railpatch.fmu.libraries import stamp

ROOT = Path(__file__).parents[3]
# FMI's name (2.0 has none for ARM: that of 3.0): target of the compiler, CMake's system, processor
PLATFORMS = {
    "linux64": ("x86_64-linux-gnu.2.17", "Linux", "x86_64"),
    "win64": ("x86_64-windows-gnu", "Windows", "x86_64"),
    "aarch64-linux": ("aarch64-linux-gnu.2.17", "Linux", "aarch64"),
    "darwin64": ("x86_64-macos", "Darwin", "x86_64"),
    "aarch64-darwin": ("aarch64-macos", "Darwin", "aarch64"),
}
DEFAULT = ("linux64", "win64", "aarch64-linux")
ENDINGS = {"Linux": ".so", "Windows": ".dll", "Darwin": ".dylib"}
OPTIONS = {
    "CMAKE_BUILD_TYPE": "Release",
    "RAILPATCH_FFT": "eigen",
    "RAILPATCH_FMU": "ON",
    "RAILPATCH_PYTHON": "OFF",
    "RAILPATCH_TESTS": "OFF",
    "RAILPATCH_UNITY": "ON",
    "RAILPATCH_WERROR": "OFF",  # this Clang warns of more than the compilers that we check with
}
# what the compiler's own runtime, linked into each library, is under
RUNTIME = """- parts of LLVM's runtime libraries (libc++, libc++abi, libunwind), Apache License 2.0
  with LLVM Exceptions, and of Zig's compiler-rt, MIT License (all platforms);
- on Windows parts of the MinGW-w64 runtime, Zope Public License 2.1 and others.
"""


def package(name: str) -> Path:
    """Folder of an installed Python package."""
    found = importlib.util.find_spec(name)
    if found is None or found.origin is None:
        sys.exit(f"the Python package {name} is missing: pip install {name}")
    return Path(found.origin).parent


def compile_for(name: str, folder: Path, targets: Sequence[str], **more: str | Path) -> Path:
    """What CMake makes for a platform; gives its tree, FOLDER/NAME. more: options of CMake."""
    target, system, processor = PLATFORMS[name]
    options = {
        **OPTIONS,
        "CMAKE_TOOLCHAIN_FILE": Path(__file__).with_name("toolchain.cmake"),
        "CMAKE_SYSTEM_NAME": system,
        "CMAKE_SYSTEM_PROCESSOR": processor,
        "RAILPATCH_ZIG": package("ziglang") / "zig",
        "RAILPATCH_TARGET": target,
        "Python_EXECUTABLE": sys.executable,
        **more,
    }
    tree = folder / name
    settings = [f"-D{key}={value}" for key, value in options.items()]
    run("cmake", "-S", ROOT, "-B", tree, "-G", "Ninja", *settings)
    run("cmake", "--build", tree, "--target", *targets)
    return tree


def build(name: str, folder: Path) -> None:
    """One platform's libraries, for both versions of FMI, into FOLDER/lib."""
    tree = compile_for(name, folder, ["railpatch_fmu", "bits_steps"])
    place = folder / "lib" / name
    place.mkdir(parents=True, exist_ok=True)
    for library in ("railpatch_fmu_eigen", "railpatch_fmu3_eigen"):
        shutil.copy(tree / "plugins/fmu" / f"{library}{ENDINGS[PLATFORMS[name][1]]}", place)


def run(*command: str | Path) -> None:
    """A program; ends where it fails."""
    if subprocess.run([str(part) for part in command], check=False).returncode != 0:
        sys.exit(f"failed: {' '.join(map(str, command))}")


def add_licences(folder: Path, zig: Path) -> None:
    """Texts for what the compiler links in."""
    folder.mkdir(parents=True, exist_ok=True)
    shutil.copy(zig / "lib" / "libcxx" / "LICENSE.TXT", folder / "LLVM.txt")
    shutil.copy(zig / "lib" / "libc" / "mingw" / "COPYING", folder / "MinGW-w64.txt")
    shutil.copy(zig / "LICENSE", folder / "Zig.txt")
    (folder.parent / "runtime.txt").write_text(RUNTIME, encoding="utf-8")


def use_cache(folder: Path) -> None:
    """What the compiler keeps is below FOLDER, where nothing else is said."""
    for cache in ("ZIG_GLOBAL_CACHE_DIR", "ZIG_LOCAL_CACHE_DIR"):
        os.environ.setdefault(cache, str(folder / "cache"))


def main() -> None:
    """All platforms, sources, licences."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folder", type=Path)
    parser.add_argument("--platforms", nargs="+", choices=PLATFORMS, default=list(DEFAULT))
    arguments = parser.parse_args()
    folder = arguments.folder.resolve()
    use_cache(folder)
    # nothing of an earlier run is packed
    shutil.rmtree(folder / "lib", ignore_errors=True)
    for name in arguments.platforms:
        build(name, folder)
    generated = folder / arguments.platforms[0] / "plugins" / "fmu" / "generated"
    headers = package("fmpy") / "c-code"
    gather.write(gather.sources(ROOT, generated, headers), folder / "lib" / "sources.zip")
    add_licences(folder / "lib" / "licenses", package("ziglang"))
    (folder / "lib" / "stamp.txt").write_text(stamp() + "\n")


if __name__ == "__main__":
    main()
