"""Stresses below the surface as CSV, NumPy arrays and a page."""

from __future__ import annotations

import io
from collections.abc import Mapping
from html import escape
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from railpatch.subsurface import STRESSES
from railpatch.writing import write_whole

Vector = NDArray[np.float64]
MEASURES = {"von_mises": "von Mises stress", "greatest_shear": "greatest shear stress",
            "dang_van": "Dang Van stress"}  # fmt: skip


def write(
    output: Path, name: str, found: Mapping[str, Any], table: Mapping[str, Vector], place: str
) -> None:
    """By the ending of the file's name. Raises OSError."""
    content = {".csv": csv, ".npz": arrays}.get(output.suffix.lower())
    write_whole(output, content(found) if content else page(name, found, table, place))


def csv(found: Mapping[str, Any]) -> bytes:
    """One line for each point, units in the head."""
    names = [f"stress_{c}" for c in STRESSES]
    columns = [*found["stress"], found["von_mises"], found["greatest_shear"]]
    depth, y, x = np.meshgrid(found["depth"], found["y"], found["x"], indexing="ij")
    values = np.stack([c.ravel() for c in (depth, x, y, *columns)], axis=1)
    text = io.StringIO()
    head = ["depth (m)", "x (m)", "y (m)", *(f"{n} (Pa)" for n in names),
            "von_mises (Pa)", "greatest_shear (Pa)"]  # fmt: skip
    np.savetxt(text, values, fmt="%.9g", delimiter=",", header=",".join(head), comments="")
    return text.getvalue().encode()


def arrays(found: Mapping[str, Any]) -> bytes:
    """All fields under their names."""
    data = io.BytesIO()
    np.savez_compressed(data, allow_pickle=False, **found)
    return data.getvalue()


def page(name: str, found: Mapping[str, Any], table: Mapping[str, Vector], place: str) -> bytes:
    """One HTML file that needs no network."""
    from railpatch.below.figures import over_depth, sections
    from railpatch.page.document import document
    from railpatch.page.figures import plot

    body = [f"<h1>{escape(name)}: below the surface</h1><p class=sub>{escape(place)}</p><p>"]
    for key, words in MEASURES.items():
        k = int(np.argmax(table[key]))
        value, depth = 1e-6 * table[key][k], 1e3 * table["depth"][k]
        body.append(f"Greatest {words.removeprefix('greatest ')} {value:.1f} MPa at a depth of "
                    f"{depth:.2f} mm. ")  # fmt: skip
        if k == len(table["depth"]) - 1 and k > 0:
            body.append("That is the deepest one asked for: more may lie below. ")
    body.append(
        "</p><p>The body is a half-space under the patch's pressure and tractions. Residual and "
        "thermal stresses are not in it. x points along rolling, y across, depth into the body."
        "</p>"
    )
    body.append(plot(sections(found), "sections") + plot(over_depth(table, MEASURES), "depths"))
    return document(f"{name}: below the surface", "".join(body)).encode()
