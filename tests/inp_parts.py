"""Parts of input files of CONTACT, that tests change."""

from __future__ import annotations

from pathlib import Path

from published_data import MANCHESTER
from railpatch.errors import CaseError
from railpatch.inp.files import convert
from railpatch.published import read_numbers

# the parts of a basic case, by block; a test changes some
BASIC = {
    "module": "3 MODULE",
    "first": "203100  PBTNFS",
    "second": "022020  LDCMZE",
    "third": "0000211 HGIAOWR",
    "solver": "200 50 30 1 1e-5",
    "motion": "50000. -0.0012 0. 1d-4  FN CKSI CETA CPHI",
    "friction": "0.35 0.35",
    "rolling": "0d 0.6 15000.",
    "material": "0.28, 0.28  82000. 82000.",
    "heat": "",
    "potcon": "1",
    "grid": "24 20 -7.2 -4.8 0.6 0.48",
    "distance": "1 1\n2.E-3 0. 4D-3 0. 0. 0.",
    "extra": "",
    "end": "0 MODULE",
}
WHEEL = {
    "module": "1 1 MODULE",
    "first": "1203100",
    "second": "0022033",
    "third": "0000211",
    "solver": "500 60 30 1 1e-5",
    "friction": "0.3 0.3",
    "material": "0.28 0.28 82000. 82000.",
    "heat": "",
    "patches": "0.4 0.4 1. 90d 8. 4.",
    "track": "14. 0 1435. 0.025",
    "rail": "'rail.txt' 0 1. 0. -1",
    "deviation": "0 0 0 0 0 0",
    "support": "",
    "wheelset": "1360. -70. 460.",
    "wheel": "'wheel.txt' 0 1. 0. -1",
    "position": "0 2. 60000. 0 0.1d 0",
    "velocity": "20000. 0 0 0 0 -43.48",
    "flexibility": "",
    "end": "0",
}


def text_of(parts: dict[str, str], **changes: str) -> str:
    return "\n".join((parts | changes).values()) + "\n"


def with_profiles(place: Path) -> Path:
    """A folder with the benchmark's profiles."""
    for body in ("wheel", "rail"):
        rows = read_numbers(MANCHESTER[body])
        lines = (f"{row['y_mm']!r} {row['z_mm']!r}" for row in rows)
        (place / f"{body}.txt").write_text("\n".join(lines))
    return place


def tables_of(folder: Path, text: str, case: int = 0):
    path = folder / "case.inp"
    path.write_text(text)
    found = convert(path)[case]
    if found.tables is None:
        raise CaseError(found.refused)
    return found.tables


def place(tables, path: str):
    for key in path.split("."):
        tables = tables[key]
    return tables
