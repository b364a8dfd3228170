"""Published numbers of the NRC roller rig, to show beside a replay of it.

The file holds forces on the rollers, computed by CONTACT's authors for the dry run at 10 mph and
13,750 lb a side. Rows are matched with positions of the run by yaw angle and lateral position; a
row matches more than one position where the run passes there again.
"""

from __future__ import annotations

import os
from dataclasses import dataclass
from importlib import resources
from pathlib import Path

import numpy as np

from railpatch.published import read_rows
from railpatch.report.data import Positions

FILE = "nrc_dry_10mph_13750lb.csv"
ABOUT = (
    "They are computed, not measured: by the program CONTACT's own model of the rig, with the "
    "profiles measured for report DOT/FRA/ORD-24/18. Their positions were balanced with an older "
    "version of that program than the one that gave the forces, and at large yaw are off balance: "
    "at 18 mrad by a roll moment of 3.8 kN m, which shows as a difference of the vertical forces."
)
_TOLERANCE = 1e-6  # m and rad
_SIDES = {"L": "left", "R": "right"}


@dataclass(frozen=True)
class Row:
    """One wheel of the reference: SI units, force on the roller in track axes."""

    side: str
    y: float
    z: float
    roll: float
    yaw: float
    pitch_rate: float
    force: tuple[float, float, float]
    patches: int


@dataclass(frozen=True)
class Match:
    """A row of the reference and the position of the run that it belongs to."""

    index: int
    row: Row


def find(directory: str | os.PathLike[str] | None = None) -> Path | None:
    """The reference file: that of this package, or of ``directory`` if given; None: it has none."""
    if directory is None:
        return Path(str(resources.files("railpatch.report") / FILE))
    path = Path(directory) / FILE
    return path if path.is_file() else None


def load(path: Path) -> list[Row]:
    """Reads the reference; ValueError, with the line, where it is not as expected."""
    rows = []
    for number, entry in read_rows(path):
        try:
            rows.append(_row(entry))
        except (KeyError, TypeError, ValueError) as error:
            raise ValueError(f"{path}, line {number}: {error!r}") from None
    return rows


def match(rows: list[Row], data: Positions) -> list[Match]:
    """Every pair of a row and a position with the same yaw and lateral position."""
    yaw, y = data.state["yaw"], data.state["y"]
    pairs = []
    for index in range(data.count):
        pairs += [
            Match(index, row)
            for row in rows
            if abs(row.yaw - yaw[index]) <= _TOLERANCE and abs(row.y - y[index]) <= _TOLERANCE
        ]
    return pairs


def differences(matches: list[Match], data: Positions) -> dict[str, np.ndarray]:
    """Run minus reference for each match, by quantity; forces on the roller, SI units.

    Quantities: "x", "y", "z" of the force, "ratio" (lateral over vertical force), "patches" (their
    number), and the wheelset's "z_ws", "roll" and "pitch_rate".
    """
    index = np.array([m.index for m in matches], dtype=int)
    expected = np.array([m.row.force for m in matches]).reshape(-1, 3)
    force = np.array([-data.force[m.row.side][m.index] for m in matches]).reshape(-1, 3)
    found = dict(zip("xyz", (force - expected).T, strict=True))
    found["ratio"] = force[:, 1] / force[:, 2] - expected[:, 1] / expected[:, 2]
    found["patches"] = np.array(
        [data.patch_count(m.row.side)[m.index] - m.row.patches for m in matches], dtype=float
    )
    for name, own in (("z_ws", "z"), ("roll", "roll"), ("pitch_rate", "pitch_rate")):
        found[name] = data.state[own][index] - [getattr(m.row, own) for m in matches]
    return found


def _row(entry: dict[str, str]) -> Row:
    force = tuple(float(entry[f"f{axis}_on_roller_N"]) for axis in "xyz")
    return Row(
        side=_SIDES[entry["side"]],
        y=1e-3 * float(entry["y_ws_mm"]),
        z=1e-3 * float(entry["z_ws_mm"]),
        roll=float(entry["roll_rad"]),
        yaw=float(entry["yaw_rad"]),
        pitch_rate=float(entry["pitch_rate_rad_s"]),
        force=force,  # type: ignore[arg-type]
        patches=int(entry["patches"]),
    )
