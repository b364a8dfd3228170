"""Builds the library with the calls of the program CONTACT for Linux and Windows:
python build.py TREES FOLDER

TREES is the folder of plugins/fmu/cross/build.py, made there or here: both take the core that was
compiled for a system from the same tree. FOLDER/lib has the libraries, the header and the Fortran
module. Needs what that program needs. --platforms names some.
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
    parser.add_argument("trees", type=Path)
    parser.add_argument("folder", type=Path)
    parser.add_argument("--platforms", nargs="+", choices=DEFAULT, default=list(DEFAULT))
    arguments = parser.parse_args()
    trees, folder = arguments.trees.resolve(), arguments.folder.resolve()
    use_cache(trees)
    place = folder / "lib"
    shutil.rmtree(place, ignore_errors=True)
    place.mkdir(parents=True)
    for name in arguments.platforms:
        tree = compile_for(name, trees, ["contact_addon"], RAILPATCH_CONTACT_ADDON="ON")
        library = f"contact_addon_{name}{ENDINGS[PLATFORMS[name][1]]}"
        shutil.copy(tree / "plugins" / "contact_addon" / library, place)
    for name in ("contact_addon.h", "contact_addon.f90"):
        shutil.copy(HERE / "include" / name, place)


if __name__ == "__main__":
    main()
