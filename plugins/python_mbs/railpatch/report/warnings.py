"""Warnings of a report."""

from __future__ import annotations

from html import escape

from railpatch.log.reader import Run
from railpatch.result import Warned


def warned(run: Run) -> Warned:
    """Of all wheels of a log."""
    found = Warned()
    for channel in run.channels.values():
        for time, message in zip(channel.time, channel.messages, strict=True):
            found.add(f"{time:.4g} s", message.get("warnings") or ())
    return found


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
    doubts = run.metadata.get("railpatch", {}).get("doubts", "").split(" | ")
    lines = [escape(line) for line in (*filter(None, doubts), *warned(run).lines())]
    if lines:
        parts.append(
            "<p class=warn><b>Can this be meant?</b> "
            f"{'. '.join(line[0].upper() + line[1:] for line in lines)}.</p>"
        )
    if bad:
        parts.append(
            f"<p class=warn><b>{bad} of {count} {noun} did not converge.</b> "
            "Red crosses mark them in the figures.</p>"
        )
    return parts
