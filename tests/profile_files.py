"""Profile files as text, in the formats that are read."""

from __future__ import annotations

import numpy as np


def columns(y: np.ndarray, z: np.ndarray) -> str:
    """Two columns to ten digits."""
    return "".join(f"{a:.9e} {b:.9e}\n" for a, b in zip(y, z, strict=True))


def simpack(points: str, *, kind: int = 1, **keys: object) -> str:
    """kind: 0 rail, 1 wheel. keys: of the spline block, with _ for each point in their names."""
    lines = "".join(
        f"    {key.replace('_', '.')} = {value} ! a key\n" for key, value in keys.items()
    )
    return (
        f"! made for a test\nheader.begin\n  version = 1\n  type = {kind}\nheader.end\n"
        f"spline.begin\n{lines}  point.begin\n{points}  point.end\nspline.end\n"
    )


def miniprof(y: np.ndarray, z: np.ndarray) -> str:
    """Four digits, as the instrument writes them; keys that say nothing of the points with it."""
    header = (
        "ProgramName=MiniProf for Windows\nProgramVer=2.43.73\nDate=08/07/2015\nCarNo=\nSide=%L\n"
        "Xoffset=0.0000\nYoffset=0.0000\nRefPoint1=0.0000, 0.0000\nRefPoint2=10.0000, 0.0000\n"
        f"ColumnDef=X,Y\nXYPoints={y.size}\nChars=UTF8\nTemperature=25.0000\nSh=27.8749\n\n"
    )
    return header + "".join(f"{a:9.4f}{b:9.4f} \n" for a, b in zip(y, z, strict=True))
