"""Warnings of a report."""

from __future__ import annotations

from html import escape

from railpatch.log.reader import Run


def warnings(run: Run, shown: str, bad: int, count: int, noun: str) -> list[str]:
    """Of a log that is cut off, a run that stopped, contacts that were not solved.

    shown: how much the report shows.
    """
    parts = []
    if run.truncated:
        parts.append(
            f"<p class=warn><b>This log is cut off:</b> {escape(run.problem)}. "
            f"The report shows the {shown} before that.</p>"
        )
    if run.stopped_by:
        parts.append(
            f"<p class=warn><b>This run stopped before its end</b> ({escape(run.stopped_by)}).</p>"
        )
    if bad:
        parts.append(
            f"<p class=warn><b>{bad} of {count} {noun} did not converge.</b> "
            "Red crosses mark them in the figures.</p>"
        )
    return parts
