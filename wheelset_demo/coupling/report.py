"""Table, plot and page of a study."""

from __future__ import annotations

import html
import io
import math
from collections.abc import Callable
from dataclasses import asdict
from pathlib import Path
from typing import Any

from railpatch.page.document import document
from railpatch.page.parts import Key, opening
from railpatch.page.tables import table

from wheelset_demo.coupling.energy import Balance
from wheelset_demo.coupling.stability import LARGEST
from wheelset_demo.coupling.study import Row, Study

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
    for text, shown in tables_of(study):
        widths = [max(len(row[k]) for row in shown) for k in range(len(shown[0]))]
        lines = ["  ".join(c.rjust(w) for c, w in zip(row, widths, strict=True)) for row in shown]
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
    rest = []
    for text, (head, *rows) in tables_of(study):
        rest.append(f"<h2>{html.escape(text)}</h2>{table(head, rows)}")
    body = (
        opening_of(study)
        + "<h2>Largest stable step, and what the coupling does to the energy</h2><p>Points are "
        "runs, lines eigenvalues.</p>"
        + f'<figure class="scroll">{svg[svg.index("<svg") :]}</figure>{"".join(rest)}'
    )
    return document("co-simulation", body)


def opening_of(study: Study) -> str:
    """The largest stable step of each master at the speed where it is shortest."""
    rows = {name: [row for row in study.of(name) if row is not None] for name in study.masters}
    least = {
        name: min(found, key=lambda row: row.bound.by_runs) for name, found in rows.items() if found
    }
    keys = [
        Key(name, step_text(row.bound.by_runs), f"by eigenvalues {step_text(row.bound.by_matrix)}")
        for name, row in least.items()
    ]
    verdict = "No master ran."
    if least:
        best = max(least, key=lambda name: least[name].bound.by_runs)
        verdict = (
            f"{best} bears the longest communication steps: "
            f"{step_text(least[best].bound.by_runs)} at the worst speed."
        )
    about = f"{study.scene}, at {', '.join(f'{s.speed:g}' for s in study.speeds)} m/s"
    return opening("Co-simulation: longest stable steps", about, verdict, keys)


def write(study: Study, path: Path) -> None:
    """A page or a plot, by the name's ending. Raises OSError, ImportError."""
    text = svg_of(study) if path.suffix == ".svg" else page_of(study)
    path.write_text(text, encoding="utf-8")
