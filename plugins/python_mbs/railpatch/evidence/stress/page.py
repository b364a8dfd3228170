"""The page of a run: one HTML file that needs no network."""

from __future__ import annotations

import plotly.graph_objects as go

from railpatch.evidence.bench.figures import styled
from railpatch.evidence.stress import text
from railpatch.evidence.stress.outcome import Report
from railpatch.evidence.stress.run import CLEAN, FAULT, SAYS_SO
from railpatch.page.document import document
from railpatch.page.figures import BAD as BAD_COLOR
from railpatch.page.figures import LINES, plot
from railpatch.page.parts import BAD, DOUBT, GOOD, Key, folded, opening
from railpatch.page.tables import short, table

COLORS = {CLEAN: LINES[0], SAYS_SO: LINES[1], FAULT: BAD_COLOR}
NAMES = {CLEAN: "solved and found right", SAYS_SO: "not solved, and said so", FAULT: "wrong"}


def page(report: Report) -> str:
    """The HTML text."""
    listed = [row for row in report.rows if row.family != "mixture"]
    unclean = text.not_clean(report)
    parts = [
        opening_of(report),
        "<h2>How long stiff cases take, and how well they are solved</h2><p>Each point is a case: "
        "time of a step over that of a plain case, and the greatest violation of a condition over "
        "what is allowed: below 1 all conditions are met.</p>",
        plot(figure(report), "time"),
        "<h2>By family and method</h2>",
        table(text.GROUP_HEAD, map(text.group_cells, report.groups)),
        folded("What the words mean", table((), text.MEANINGS, "summary"), on_paper=True),
        "<h2>What is not clean</h2>",
        table(text.ROW_HEAD, unclean) if unclean else "<p>Nothing.</p>",
        folded(
            "Every case, without the random mixtures, whose rows are in the CSV file",
            table(text.ROW_HEAD, map(text.row_cells, listed)),
        ),
        folded("The machine", table((), report.machine.rows(), "summary")),
    ]
    return document("numerical stability", "".join(parts))


def opening_of(report: Report) -> str:
    """How many cases ended well, and how the others."""
    count, faults = len(report.rows), len(report.faults)
    clean = [row for row in report.rows if row.verdict == CLEAN]
    told = count - len(clean) - faults
    slow = max((row.relative_time for row in clean), default=float("nan"))
    worst = max((row.conditions for row in clean), default=float("nan"))
    keys = [
        Key("solved, and found right by other code", f"{len(clean)} of {count}"),
        Key(
            "wrong, and not said so",
            str(faults),
            "none is allowed",
            BAD if faults else GOOD,
        ),
        Key(
            "not solved, and said so",
            str(told),
            f"{len(report.unexpected)} of them unexpected",
            DOUBT if report.unexpected else GOOD,
        ),
        Key("slowest solved case", f"{short(slow)} times", "the time of a plain one"),
        Key("greatest violation of a condition", short(worst), "of what is allowed"),
    ]
    verdict = f"No result was wrong without saying so, in {count} stiff and extreme cases."
    if faults:
        verdict = f"{faults} of {count} results were wrong without saying so."
    about = f"{text.INTRODUCTION} Seed {report.plan.seed}."
    return opening("Numerical stability", about, verdict, keys, BAD if faults else GOOD)


def figure(report: Report) -> go.Figure:
    """Conditions against time."""
    found = go.Figure()
    for verdict, color in COLORS.items():
        rows = [row for row in report.rows if row.verdict == verdict and row.conditions > 0]
        if not rows:
            continue
        found.add_scatter(
            x=[row.relative_time for row in rows],
            y=[row.conditions for row in rows],
            text=[f"{row.family}: {row.name}, {row.method}" for row in rows],
            mode="markers",
            name=NAMES[verdict],
            marker={"size": 5, "color": color},
        )
    styled(found, "time over that of a plain case", "violation over what is allowed")
    # over many powers of ten
    found.update_yaxes(exponentformat="power", minor={"showgrid": False}, dtick=2)
    return found
