"""CPython for other systems: headers and import libraries to build with, interpreters to try with.

They come from Maven's registry, where the project JavaCPP Presets publishes CPython for Linux and
for Windows in archives of some 25 MB; Maven's client fetches them.
"""

from __future__ import annotations

import hashlib
import shutil
import subprocess
import sys
import zipfile
from dataclasses import dataclass
from pathlib import Path

GROUP = "org.bytedeco"
ARTIFACT = "cpython"


@dataclass(frozen=True)
class Python:
    """One CPython for one system."""

    version: str
    release: str  # of the presets
    system: str  # linux, windows
    sha256: str

    @property
    def tag(self) -> str:
        """As in a wheel's name: cp310."""
        return "cp" + "".join(self.version.split(".")[:2])

    @property
    def minor(self) -> str:
        """As one says it: 3.10."""
        return self.version.rpartition(".")[0]

    @property
    def archive(self) -> str:
        """Name of the file."""
        return f"{ARTIFACT}-{self.version}-{self.release}-{self.system}-x86_64.jar"

    @property
    def root(self) -> str:
        """Folder in the archive."""
        return f"org/bytedeco/cpython/{self.system}-x86_64/"

    @property
    def headers(self) -> str:
        """Folder of Python.h in the archive."""
        inner = "" if self.system == "windows" else f"python{self.minor}/"
        return f"{self.root}include/{inner}"


PYTHONS = (
    Python(
        "3.10.8",
        "1.5.8",
        "linux",
        "2f101b1aa06effdbda3c318c1728b13f22b571707c7b7704abaf5d19a33aa981",
    ),
    Python(
        "3.11.3",
        "1.5.9",
        "linux",
        "668b42f6a8b1a9789de7d3ca54a81fefb754cd8e885554b42858bbcbc0dd497c",
    ),
    Python(
        "3.12.1",
        "1.5.10",
        "linux",
        "a135fcf4dc01adebf7ea439252276fc3196db80f7e0dd3da0b61f1ec489b68bd",
    ),
    Python(
        "3.10.8",
        "1.5.8",
        "windows",
        "1e7d342425c87184fbedd8754045db556c63765678a0f11b4539465642ab018b",
    ),
    Python(
        "3.11.3",
        "1.5.9",
        "windows",
        "3263a50b256447bb7b9e604d6587627e419891370fc33b94469e6a06ff4de834",
    ),
    Python(
        "3.12.1",
        "1.5.10",
        "windows",
        "e69bc4491c311e19ea7169bafc5efbbe03b980d69c6962b049daf1fcb4913391",
    ),
    # not built with, but tried with
    Python(
        "3.14.3",
        "1.5.13",
        "linux",
        "eb5f1a6fe2dc498ac18927189a37f28a47b0ba06ae6bd85112eff023fe2eb46f",
    ),
)


def fetch(python: Python, folder: Path) -> Path:
    """Its archive, in the folder; ends where its content is not the one that is known."""
    path = folder / python.archive
    if not path.is_file():
        folder.mkdir(parents=True, exist_ok=True)
        name = f"{GROUP}:{ARTIFACT}:{python.version}-{python.release}:jar:{python.system}-x86_64"
        print(f"fetching {name}", flush=True)
        command = ["mvn", "-q", "dependency:copy", f"-Dartifact={name}"]
        done = subprocess.run([*command, f"-DoutputDirectory={folder}"], check=False)
        if done.returncode != 0 or not path.is_file():
            sys.exit(f"failed: {' '.join(command)}")
    found = hashlib.sha256(path.read_bytes()).hexdigest()
    if found != python.sha256:
        sys.exit(f"{path}: its SHA-256 is {found}, not {python.sha256}")
    return path


def headers(python: Python, archives: Path, folder: Path) -> None:
    """What an extension module is built with: FOLDER/include, for Windows also FOLDER/libs."""
    shutil.rmtree(folder, ignore_errors=True)
    # python3.lib is for the stable interface alone, and then alone
    library = "python3.lib" if python.tag == "cp312" else f"python{python.tag[2:]}.lib"
    with zipfile.ZipFile(fetch(python, archives)) as archive:
        for name in archive.namelist():
            if name.startswith(python.headers) and name.endswith(".h"):
                target = folder / "include" / name.removeprefix(python.headers)
            elif name == f"{python.root}libs/{library}":
                target = folder / "libs" / library
            else:
                continue
            target.parent.mkdir(parents=True, exist_ok=True)
            target.write_bytes(archive.read(name))


def imported(library: bytes) -> list[tuple[str, bool]]:
    """What an import library names, and whether it is data.

    Its form: Microsoft, PE Format, "Archive (Library) File Format", "Import Library Format".
    """
    if not library.startswith(b"!<arch>\n"):
        raise ValueError("an import library begins with !<arch>")
    found, at = [], 8
    while at + 60 <= len(library):
        size = int(library[at + 48 : at + 58])
        member = library[at + 60 : at + 60 + size]
        if member[:4] == b"\x00\x00\xff\xff":  # an import; others are the library's own
            kind = int.from_bytes(member[18:20], "little") & 3
            found.append((member[20 : member.index(b"\x00", 20)].decode(), kind == 1))
        at += 60 + size + size % 2
    return found


def stable_interface(folder: Path, name: str) -> None:
    """python3.dll beside a Python that has none: it hands on to the DLL of this name.

    The presets publish the import library of the stable interface, but not its DLL.
    """
    names = imported((folder / "libs" / "python3.lib").read_bytes())
    lines = [f"  {n} = {name}.{n}{' DATA' if data else ''}" for n, data in names]
    definition = folder / "python3.def"
    definition.write_text("\n".join(["LIBRARY python3.dll", "EXPORTS", *lines, ""]))
    empty = folder / "python3.c"
    empty.write_text("int DllMain(void *m, unsigned why, void *r) { return 1; }\n")
    zig = [sys.executable, "-m", "ziglang", "cc", "-target", "x86_64-windows-gnu", "-shared"]
    words = [*zig, empty, definition, "-o", folder / "python3.dll"]
    done = subprocess.run(list(map(str, words)), capture_output=True, text=True)
    if done.returncode != 0:
        sys.exit(f"failed: {' '.join(map(str, words))}\n{done.stderr[-2000:]}")


def interpreter(python: Python, archives: Path, folder: Path) -> Path:
    """The whole of a Python in FOLDER/TAG, made once; gives its program."""
    made = folder / python.tag
    windows = python.system == "windows"
    program = made / ("python.exe" if windows else f"bin/python{python.minor}")
    if not program.is_file():
        shutil.rmtree(made, ignore_errors=True)
        with zipfile.ZipFile(fetch(python, archives)) as archive:
            for name in archive.namelist():
                if name.startswith(python.root) and not name.endswith("/"):
                    target = made / name.removeprefix(python.root)
                    target.parent.mkdir(parents=True, exist_ok=True)
                    target.write_bytes(archive.read(name))
        if windows:
            for tool in made.glob("bin/*.exe"):
                shutil.copy(tool, made)
            if not (made / "python3.dll").is_file():
                stable_interface(made, f"python{python.tag[2:]}")
        else:
            program.chmod(0o755)
    return program
