"""Table, plot and page of a study."""

from __future__ import annotations

import html
import io
import math
from collections.abc import Callable
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
HEADS = (
    "Largest stable communication step by runs of the FMU",
    "The same by the eigenvalues of one step",
    "Energy made or lost by the coupling at half of that step, in parts of the friction work",
    "The same at 1 ms, where that is stable",
)
NAN_TEXT = "failed"


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
    return NAN_TEXT if math.isnan(found.error) else f"{found.share:.0e}"


CELLS: tuple[Callable[[Row], str], ...] = (
    lambda row: step_text(row.bound.by_runs),
    lambda row: step_text(row.bound.by_matrix),
    lambda row: share_text(row.half),
    lambda row: share_text(row.asked),
)


def tables_of(study: Study) -> list[tuple[str, list[list[str]]]]:
    """Headlines and rows, masters over speeds in m/s."""
    head = ["m/s", *(f"{s.speed:g}" for s in study.speeds)]
    return [
        (text, [head, *([name, *cells_of(cell, study.of(name))] for name in study.masters)])
        for text, cell in zip(HEADS, CELLS, strict=True)
    ]


def cells_of(cell: Callable[[Row], str], rows: list[Row | None]) -> list[str]:
    """Of one master."""
    return [NAN_TEXT if row is None else cell(row) for row in rows]


def text_of(study: Study) -> str:
    """For the terminal."""
    blocks = [f"scene: {study.scene}"]
    for text, table in tables_of(study):
        widths = [max(len(row[k]) for row in table) for k in range(len(table[0]))]
        lines = ["  ".join(c.rjust(w) for c, w in zip(row, widths, strict=True)) for row in table]
        blocks.append("\n".join([text, *lines]))
    return "\n\n".join(blocks)


def markdown_of(study: Study) -> str:
    """The same for documents."""
    blocks = []
    for text, (head, *rows) in tables_of(study):
        lines = [head, ["---"] * len(head), *rows]
        blocks.append(text + "\n\n" + "\n".join("| " + " | ".join(c) + " |" for c in lines))
    return "\n\n".join(blocks)


def dict_of(study: Study) -> dict[str, Any]:
    """SI units; null for what was not run or failed."""
    rows = [row_of(row) for row in study.rows]
    speeds = [{k: known(v) for k, v in asdict(s).items()} for s in study.speeds]
    failures = [{"speed": speed, "message": text} for speed, text in study.failures.items()]
    return {"scene": study.scene, "speeds": speeds, "rows": rows, "failures": failures}


def known(value: float) -> float | None:
    """None for NaN."""
    return None if math.isnan(value) else value


def row_of(row: Row) -> dict[str, Any]:
    """One row of dict_of()."""
    found: dict[str, Any] = asdict(row.bound)
    for key, one in (("half", row.half), ("at_1_ms", row.asked)):
        failed = one is None or math.isnan(one.error)
        found[key] = None if failed else {**asdict(one), "share": one.share}
    return found


def svg_of(study: Study) -> str:
    """Steps and energies over speed. Raises ImportError without matplotlib."""
    import matplotlib

    matplotlib.use("svg")
    from matplotlib import pyplot

    matplotlib.rcParams.update({"svg.hashsalt": "railpatch", "font.size": 9})
    figure, (steps, energy) = pyplot.subplots(1, 2, figsize=(12, 4.6), layout="constrained")
    speeds = [s.speed for s in study.speeds]
    for k, name in enumerate(study.masters):
        rows, color = study.of(name), f"C{k}"
        style = {"color": color, "lw": 1.2}
        steps.plot(
            speeds, [1e3 * r.bound.by_matrix or None if r else None for r in rows], ls="-", **style
        )
        shown = [1e3 * r.bound.by_runs or None if r else None for r in rows]
        steps.plot(speeds, shown, "o", ms=4, color=color, label=name)
        shares = [r.half.share if r and r.half else None for r in rows]
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
    # beside the panels, where it hides no point
    handles, labels = steps.get_legend_handles_labels()
    energy.legend(handles, labels, fontsize=7.5, loc="upper left", bbox_to_anchor=(1.01, 1.0))
    text = io.StringIO()
    figure.savefig(text, format="svg", metadata={"Date": None, "Creator": None})
    pyplot.close(figure)
    return text.getvalue()


def page_of(study: Study) -> str:
    """Self-contained HTML."""
    svg = svg_of(study)
    tables = []
    for text, table in tables_of(study):
        rows = []
        for k, cells in enumerate(table):
            tag = "td" if k else "th"
            rows.append("".join(f"<{tag}>{html.escape(cell)}</{tag}>" for cell in cells))
        content = "".join(f"<tr>{row}</tr>" for row in rows)
        tables.append(f"<h2>{html.escape(text)}</h2><table>{content}</table>")
    return (
        '<!DOCTYPE html><html lang="en"><head><meta charset="utf-8"><title>Co-simulation'
        f"</title><style>{STYLE}</style></head><body><h1>Co-simulation: stable steps</h1>"
        f"<p>Scene {html.escape(study.scene)}. Points are runs, lines eigenvalues.</p>"
        f"{svg[svg.index('<svg') :]}{''.join(tables)}</body></html>\n"
    )


def write(study: Study, path: Path) -> None:
    """A page or a plot, by the name's ending. Raises OSError, ImportError."""
    text = svg_of(study) if path.suffix == ".svg" else page_of(study)
    path.write_text(text, encoding="utf-8")
