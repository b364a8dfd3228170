"""Table, plot and page of a study."""

from __future__ import annotations

import html
import io
from dataclasses import asdict
from pathlib import Path
from typing import Any

from wheelset_demo.coupling.energy import Balance
from wheelset_demo.coupling.stability import LARGEST
from wheelset_demo.coupling.study import Row, Study

STYLE = """body{font:15px/1.5 sans-serif;max-width:70em;margin:2em auto;padding:0 1em}
table{border-collapse:collapse}
td,th{padding:.2em .7em;text-align:right;border-bottom:1px solid #ccc}
td:first-child,th:first-child{text-align:left}svg{max-width:100%;height:auto}"""
WORDS = (
    "Largest stable communication step of a wheelset whose contact is in an FMU: by runs, and in "
    "brackets by the eigenvalues of one step. Energy: what the coupling makes or loses in parts of "
    "the friction work, at half of the largest step and at 1 ms where that is stable."
)


def step_text(step: float) -> str:
    """s, with a unit that suits."""
    if step >= LARGEST:
        return f">= {1e3 * LARGEST:.0f} ms"
    if step <= 0:
        return "none"
    return f"{1e3 * step:.2f} ms" if step >= 1e-4 else f"{1e6 * step:.1f} us"


def share_text(found: Balance | None) -> str:
    """Of friction work."""
    if found is None:
        return "-"
    return f"{found.share:.0e}" if found.share == found.share else "failed"


def table_of(study: Study) -> list[list[str]]:
    """Header and rows."""
    head = ["speed", *study.masters]
    rows = [head]
    for speed in study.speeds:
        cells = [f"{speed.speed:g} m/s"]
        for name in study.masters:
            bound = next(r.bound for r in study.of(name) if r.bound.speed == speed.speed)
            cells.append(f"{step_text(bound.by_runs)} ({step_text(bound.by_matrix)})")
        rows.append(cells)
    return rows


def energy_table_of(study: Study) -> list[list[str]]:
    """Header and rows."""
    rows = [["energy", *study.masters]]
    for speed in study.speeds:
        found = [
            next(r for r in study.of(name) if r.bound.speed == speed.speed)
            for name in study.masters
        ]
        cells = [f"{share_text(r.half)} / {share_text(r.asked)}" for r in found]
        rows.append([f"{speed.speed:g} m/s", *cells])
    return rows


def text_of(study: Study) -> str:
    """For the terminal."""
    blocks = [f"scene: {study.scene}", WORDS]
    for table in (table_of(study), energy_table_of(study)):
        widths = [max(len(row[k]) for row in table) for k in range(len(table[0]))]
        lines = ["  ".join(c.rjust(w) for c, w in zip(row, widths, strict=True)) for row in table]
        blocks.append("\n".join(lines))
    return "\n\n".join(blocks)


def markdown_of(study: Study) -> str:
    """The same tables for documents."""
    blocks = []
    for head, *rows in (table_of(study), energy_table_of(study)):
        lines = [head, ["---"] * len(head), *rows]
        blocks.append("\n".join("| " + " | ".join(cells) + " |" for cells in lines))
    return "\n\n".join(blocks)


def dict_of(study: Study) -> dict[str, Any]:
    """SI units; null for what was not run or failed."""
    rows = [row_of(row) for row in study.rows]
    return {"scene": study.scene, "speeds": [asdict(s) for s in study.speeds], "rows": rows}


def row_of(row: Row) -> dict[str, Any]:
    """One row of dict_of()."""
    found: dict[str, Any] = asdict(row.bound)
    for key, one in (("half", row.half), ("at_1_ms", row.asked)):
        failed = one is None or one.error != one.error
        found[key] = None if failed else {**asdict(one), "share": one.share}
    return found


def svg_of(study: Study) -> str:
    """Steps and energies over speed. Raises ImportError without matplotlib."""
    import matplotlib

    matplotlib.use("svg")
    from matplotlib import pyplot

    matplotlib.rcParams.update({"svg.hashsalt": "railpatch", "font.size": 9})
    figure, (steps, energy) = pyplot.subplots(1, 2, figsize=(11, 4.6), layout="constrained")
    speeds = [s.speed for s in study.speeds]
    for k, name in enumerate(study.masters):
        rows, color = study.of(name), f"C{k}"
        style = {"color": color, "lw": 1.2}
        steps.plot(speeds, [1e3 * r.bound.by_matrix or None for r in rows], ls="-", **style)
        shown = [1e3 * r.bound.by_runs or None for r in rows]
        steps.plot(speeds, shown, "o", ms=4, color=color, label=name)
        shares = [r.half.share if r.half else None for r in rows]
        energy.plot(speeds, shares, "o-", ms=4, label=name, **style)
    forms = study.speeds
    for key, label, dashes in (
        ("bounce", "2 / bounce frequency", ":"),
        ("creep", "2 V m / f of creep", "--"),
        ("lag", "4 damping / frequency$^2$", "-."),
    ):
        steps.plot(speeds, [1e3 * getattr(s, key) for s in forms], dashes, color="0.4", label=label)
    steps.set_ylabel("largest stable step [ms]: runs (points), eigenvalues (lines)")
    energy.set_ylabel("energy made or lost / friction work, at half of it")
    for panel in (steps, energy):
        panel.set(xscale="log", yscale="log", xlabel="speed [m/s]")
        panel.grid(alpha=0.3, which="both")
    steps.legend(fontsize=7.5)
    text = io.StringIO()
    figure.savefig(text, format="svg", metadata={"Date": None, "Creator": None})
    pyplot.close(figure)
    return text.getvalue()


def page_of(study: Study) -> str:
    """Self-contained HTML."""
    svg = svg_of(study)
    tables = []
    for table in (table_of(study), energy_table_of(study)):
        rows = []
        for k, cells in enumerate(table):
            tag = "td" if k else "th"
            rows.append("".join(f"<{tag}>{html.escape(cell)}</{tag}>" for cell in cells))
        tables.append("<table>" + "".join(f"<tr>{row}</tr>" for row in rows) + "</table>")
    return (
        '<!DOCTYPE html><html lang="en"><head><meta charset="utf-8"><title>Co-simulation'
        f"</title><style>{STYLE}</style></head><body><h1>Co-simulation: stable steps</h1>"
        f"<p>Scene {html.escape(study.scene)}. {html.escape(WORDS)}</p>"
        f"{svg[svg.index('<svg') :]}{'<br>'.join(tables)}</body></html>\n"
    )


def write(study: Study, path: Path) -> None:
    """A page or a plot, by the name's ending. Raises OSError, ImportError."""
    text = svg_of(study) if path.suffix == ".svg" else page_of(study)
    path.write_text(text, encoding="utf-8")
