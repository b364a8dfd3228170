"""Stresses below the surface as CSV, NumPy arrays and a page."""

from __future__ import annotations

import io
from collections.abc import Mapping
from html import escape
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from railpatch.below.greatest import COLUMNS
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
    from railpatch.page.parts import Key, folded, opening
    from railpatch.page.tables import table as html_table

    keys, open_ends, told = [], [], {}
    for key, words in MEASURES.items():
        k = int(np.argmax(table[key]))
        value = f"{1e-6 * table[key][k]:.1f} MPa"
        told[key] = f"{value}, {1e3 * table['depth'][k]:.2f} mm deep"
        keys.append(Key(words, value, f"{1e3 * table['depth'][k]:.2f} mm below the surface"))
        if k == len(table["depth"]) - 1 and k > 0:
            open_ends.append(words)
    verdict = f"The greatest von Mises stress is {told['von_mises']}."
    body = [opening(f"{name}: below the surface", place, verdict, keys)]
    if open_ends:
        text = (
            f"{', '.join(open_ends)}: greatest at the deepest place asked for, more may lie below."
        )
        body.append(f'<p class="warn">{escape(text[0].upper() + text[1:])}</p>')
    rows = [
        [*(f"{(1e3 if unit == 'm' else 1e-6) * table[column][k] + 0.0:.2f}"
           for column, unit in COLUMNS.items())]
        for k in range(len(table["depth"]))
    ]  # fmt: skip
    head = [f"{column.replace('_', ' ')} [{'mm' if unit == 'm' else 'MPa'}]"
            for column, unit in COLUMNS.items()]  # fmt: skip
    text = (
        "<p>The body is a half-space under the patch's pressure and tractions. Residual and "
        "thermal stresses are not in it. x points along rolling, y across, depth into the body.</p>"
    )
    body += [
        "<h2>Where it is greatest</h2>",
        plot(sections(found), "sections"),
        "<h2>Over the depth</h2>",
        plot(over_depth(table, MEASURES), "depths"),
        folded("All depths", html_table(head, rows)),
        folded("How it was computed", text, on_paper=True),
    ]
    return document(f"{name}: below the surface", "".join(body)).encode()
