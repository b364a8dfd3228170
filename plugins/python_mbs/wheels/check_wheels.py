"""What must hold of the wheels: python check_wheels.py FOLDER

Every system and Python has its wheel; each is below 15 MB, records what it holds, carries the same
Python files, libraries and licences, and nothing under the GPL; its module asks for nothing but the
system and Python. Needs binutils and the Python package auditwheel.
"""

from __future__ import annotations

import argparse
import base64
import csv
import hashlib
import io
import re
import sys
import tempfile
import zipfile
from email import message_from_string
from pathlib import Path

ROOT = Path(__file__).parents[3]
sys.path.insert(0, str(ROOT / "plugins" / "fmu" / "cross"))

from check import must, output  # noqa: E402

LARGEST = 15e6  # bytes
GLIBC = (2, 28)
WANTED = {
    f"{tag}-{system}"
    for tag in ("cp310-cp310", "cp311-cp311", "cp312-abi3")
    for system in ("manylinux_2_28_x86_64", "win_amd64")
}
# of each version of FMI
LIBRARIES = {"railpatch_fmu_eigen", "railpatch_fmu3_eigen"}
PLATFORMS = ("linux64", "win64", "aarch64-linux")
TEXTS = {"LICENSE", "NOTICE", "MPL-2.0.txt", "LLVM.txt", "MinGW-w64.txt", "Zig.txt"}
SYSTEM = {
    "linux": r"lib(c|m|pthread|dl)\.so\.\d|ld-linux-x86-64\.so\.2",
    "win": r"KERNEL32\.dll|api-ms-win-crt-[a-z0-9-]*\.dll|ucrtbase\.dll",
}
PYTHON = {"cp310": r"python310\.dll", "cp311": r"python311\.dll", "cp312": r"python3\.dll"}


def files_in(archive: zipfile.ZipFile) -> list[str]:
    """Their names; auditwheel's archives have folders too."""
    return [name for name in archive.namelist() if not name.endswith("/")]


def check_record(archive: zipfile.ZipFile) -> None:
    """Every file is there as it was recorded."""
    (record,) = (name for name in files_in(archive) if name.endswith(".dist-info/RECORD"))
    rows = list(csv.reader(io.StringIO(archive.read(record).decode())))
    recorded = {name: digest for name, digest, _ in rows}
    must(recorded.keys() == set(files_in(archive)), "RECORD names every file, and no other")
    for name, digest in recorded.items():
        if name != record:
            found = base64.urlsafe_b64encode(hashlib.sha256(archive.read(name)).digest())
            must(digest == f"sha256={found.decode().rstrip('=')}", f"{name}: as recorded")


def check_content(path: Path, archive: zipfile.ZipFile) -> set[str]:
    """Libraries, licences; gives the names of what all wheels have alike."""
    names = files_in(archive)
    for platform in PLATFORMS:
        folder = f"railpatch/fmu/lib/{platform}/"
        libraries = [name for name in names if name.startswith(folder)]
        found = {Path(name).stem for name in libraries}
        must(
            found == LIBRARIES, f"{path.name}: {folder} has {sorted(LIBRARIES)}, found {libraries}"
        )
    for name in ("_core.pyi", "py.typed", "fmu/variables.toml", "fmu/lib/sources.zip"):
        must(f"railpatch/{name}" in names, f"{path.name} has {name}")
    must(not [n for n in names if re.search(r"fftw|GPL", n)], f"{path.name}: nothing of the GPL")
    (text,) = (archive.read(n).decode() for n in names if n.endswith(".dist-info/METADATA"))
    about = message_from_string(text)
    must(set(about.get_all("License-File", [])) == TEXTS, f"{path.name}: names {sorted(TEXTS)}")
    there = {n.rpartition("/")[2] for n in names if ".dist-info/licenses/" in n}
    must(there == TEXTS, f"{path.name} has {sorted(TEXTS)}, found {sorted(there)}")
    must("GPL" not in about["License-Expression"], f"{path.name}: {about['License-Expression']}")
    return {n for n in names if ".dist-info/" not in n and "/_core." not in n}


def check_module(path: Path, archive: zipfile.ZipFile) -> str:
    """What the extension module asks for; gives it in words."""
    (name,) = (n for n in files_in(archive) if re.match(r"railpatch/_core\..*(so|pyd)$", n))
    with tempfile.TemporaryDirectory() as folder:
        module = Path(archive.extract(name, folder))
        if "win_amd64" in path.name:
            return check_pe(path, module)
        return check_elf(path, module)


def check_elf(path: Path, module: Path) -> str:
    """Of Linux."""
    names = output("readelf", "-W", "--dyn-syms", module)
    newest = max(tuple(map(int, v.split("."))) for v in re.findall(r"GLIBC_([0-9.]+)", names))
    must(newest <= GLIBC, f"{path.name}: nothing newer than GLIBC {GLIBC}, found {newest}")
    dynamic = output("readelf", "-dW", module)
    must(not re.search("RPATH|RUNPATH|TEXTREL", dynamic), f"{path.name}: no RPATH, no TEXTREL")
    for library in re.findall(r"\(NEEDED\).*\[(.*)\]", dynamic):
        must(re.fullmatch(SYSTEM["linux"], library), f"{path.name}: {library} is of the system")
    own = [
        line.split()[7] for line in names.splitlines() if " GLOBAL " in line and " UND " not in line
    ]
    must(own == ["PyInit__core"], f"{path.name}: shows PyInit__core alone, found {own}")
    told = " ".join(output(sys.executable, "-m", "auditwheel", "show", path).split())
    found = re.search(r'platform tag: "([^"]+)"', told)
    must(found is not None, f"{path.name}: auditwheel knows its systems")
    return f"GLIBC_{'.'.join(map(str, newest))}, auditwheel: {found.group(1) if found else ''}"


def check_pe(path: Path, module: Path) -> str:
    """Of Windows."""
    text = output("objdump", "-p", module)
    needed = re.findall(r"DLL Name: (\S+)", text)
    python = PYTHON[path.name.split("-")[2]]
    must([n for n in needed if re.fullmatch(python, n)], f"{path.name}: needs {python}")
    for library in needed:
        allowed = f"{SYSTEM['win']}|{python}"
        must(re.fullmatch(allowed, library), f"{path.name}: {library} is of the system")
    return " ".join(name for name in needed if not name.startswith("api-"))


def main() -> None:
    """All wheels of a folder."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folder", type=Path)
    wheels = sorted(parser.parse_args().folder.glob("*.whl"))
    tags = {"-".join(path.stem.split("-")[2:]) for path in wheels}
    must(tags == WANTED, f"wheels for {sorted(WANTED)}, found {sorted(tags)}")
    contents = []
    for path in wheels:
        size = path.stat().st_size
        must(size < LARGEST, f"{path.name}: below {LARGEST:g} bytes, found {size}")
        with zipfile.ZipFile(path) as archive:
            check_record(archive)
            contents.append(check_content(path, archive))
            told = check_module(path, archive)
        print(f"{path.name}: {size / 1e6:.2f} MB; {told}")
    must(all(content == contents[0] for content in contents), "all wheels have the same files")


if __name__ == "__main__":
    main()
