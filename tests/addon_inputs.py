"""What the drivers read: the Manchester benchmark's profiles and positions of a wheelset."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from profile_files import columns, simpack
from published_data import MANCHESTER, numbers
from railpatch.published import read_numbers

POSITION = ("y_ws_mm", "roll_rad", "yaw_rad", "pitch_rate_rad_s")


def write_inputs(folder: Path) -> tuple[dict[str, Path], Path]:
    """The files of wheel and rail, that of the positions."""
    files = {}
    for body, kind, mirror in (("wheel", 1, 1), ("rail", 0, 0)):
        rows = read_numbers(MANCHESTER[body])
        y, z = (np.array([row[key] for row in rows]) for key in ("y_mm", "z_mm"))
        points = columns(-y[::-1], z[::-1]) if mirror else columns(y, z)
        keys = {"units_len_f": "+1.0E+03", "mirror_y": mirror, "inversion": mirror}
        files[body] = folder / f"{body}.{'prw' if kind else 'prr'}"
        files[body].write_text(simpack(points, kind=kind, **keys))
    lines = [
        " ".join(repr(row[key]) for key in POSITION) for row in numbers("manchester_a22_right.csv")
    ]
    positions = folder / "positions.txt"
    positions.write_text("\n".join(lines) + "\n")
    return files, positions
