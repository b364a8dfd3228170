"""Builds the library with the calls of the program CONTACT for Linux and Windows:
python build.py FOLDER

Everything is made below FOLDER; FOLDER/lib has the libraries, the header and the Fortran module.
Needs what plugins/fmu/cross/build.py needs. --platforms names some.
"""

from __future__ import annotations

import argparse
import shutil
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent / "fmu" / "cross"))

from build import ENDINGS, PLATFORMS, compile_for, use_cache  # noqa: E402 -- beside the FMU's

DEFAULT = ("linux64", "win64")


def main() -> None:
    """All platforms."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folder", type=Path)
    parser.add_argument("--platforms", nargs="+", choices=DEFAULT, default=list(DEFAULT))
    arguments = parser.parse_args()
    folder = arguments.folder.resolve()
    use_cache(folder)
    place = folder / "lib"
    shutil.rmtree(place, ignore_errors=True)
    place.mkdir(parents=True)
    more = {"RAILPATCH_FMU": "OFF", "RAILPATCH_CONTACT_ADDON": "ON"}
    for name in arguments.platforms:
        tree = compile_for(name, folder, ["contact_addon"], **more)
        library = f"contact_addon_{name}{ENDINGS[PLATFORMS[name][1]]}"
        shutil.copy(tree / "plugins" / "contact_addon" / library, place)
    for name in ("contact_addon.h", "contact_addon.f90"):
        shutil.copy(HERE / "include" / name, place)


if __name__ == "__main__":
    main()
