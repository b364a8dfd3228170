"""The page of a run: one HTML file that needs no network."""

from __future__ import annotations

import plotly.graph_objects as go

from railpatch.evidence.bench.figures import styled
from railpatch.evidence.stress import text
from railpatch.evidence.stress.outcome import Report
from railpatch.evidence.stress.run import CLEAN, FAULT, SAYS_SO
from railpatch.page.document import document
from railpatch.page.figures import plot
from railpatch.page.tables import table

COLORS = {CLEAN: "#2f7fc1", SAYS_SO: "#e0a020", FAULT: "#c62828"}


def page(report: Report) -> str:
    """The HTML text."""
    listed = [row for row in report.rows if row.family != "mixture"]
    warn = "" if not report.faults else f"<p class=warn><b>{len(report.faults)} faults.</b></p>"
    unclean = text.not_clean(report)
    parts = [
        f"<h1>Numerical stability</h1><p class=sub>{text.verdict_of(report)} Seed "
        f"{report.plan.seed}.</p>{warn}<p>{text.INTRODUCTION}</p>",
        table((), report.machine.rows(), "summary"),
        table((), text.MEANINGS, "summary"),
        "<h2>By family and method</h2>",
        table(text.GROUP_HEAD, map(text.group_cells, report.groups)),
        "<h2>Time and conditions</h2><p>Each point is a case: time of a step over that of the "
        "nominal case, and the greatest violation of a condition over what is allowed.</p>",
        plot(figure(report), "time"),
        "<h2>What is not clean</h2>",
        table(text.ROW_HEAD, unclean) if unclean else "<p>Nothing.</p>",
        "<h2>Every case</h2><p>Without the random mixtures, whose rows are in the CSV file.</p>",
        table(text.ROW_HEAD, map(text.row_cells, listed)),
    ]
    return document("numerical stability", "".join(parts))


def figure(report: Report) -> go.Figure:
    """Conditions against time."""
    found = go.Figure()
    for verdict, color in COLORS.items():
        rows = [row for row in report.rows if row.verdict == verdict and row.conditions > 0]
        if not rows:
            continue
        found.add_scattergl(
            x=[row.relative_time for row in rows],
            y=[row.conditions for row in rows],
            text=[f"{row.family}: {row.name}, {row.method}" for row in rows],
            mode="markers",
            name=verdict,
            marker={"size": 5, "color": color},
        )
    return styled(found, "time over the nominal case's", "violation over what is allowed")
