"""Published numbers that tests compare with: tests/published/data, each with its source."""

from __future__ import annotations

from pathlib import Path

from railpatch.published import read_numbers

from rig_model.scene import scenes

FOLDER = Path(__file__).parent / "published" / "data"
# points of the Manchester benchmark's profiles
MANCHESTER = {
    "wheel": str(FOLDER / "manchester_s1002.csv"),
    "rail": str(FOLDER / "manchester_uic60.csv"),
}
# the roller rig's measured profiles, as its scene names them
NRC = {
    f"{body}_{side}": str(scenes() / f"nrc_{side}_{name}.csv")
    for body, name in (("wheel", "wheel"), ("rail", "roller"))
    for side in ("left", "right")
} | {"smoothing": 2e-3}


def numbers(name: str) -> list[dict[str, float]]:
    """The rows of one table."""
    return read_numbers(FOLDER / name)
