"""The files of a run: page, table and document."""

from __future__ import annotations

import csv
from collections.abc import Sequence
from dataclasses import asdict, fields
from pathlib import Path

from railpatch.evidence.stress.outcome import Report
from railpatch.evidence.stress.page import page
from railpatch.evidence.stress.run import Row
from railpatch.evidence.stress.text import markdown


def write_report(report: Report, folder: Path) -> list[Path]:
    """Writes stress.html, stress.csv and stress.md."""
    folder.mkdir(parents=True, exist_ok=True)
    written = [folder / f"stress.{suffix}" for suffix in ("html", "csv", "md")]
    written[0].write_text(page(report), encoding="utf-8")
    write_rows(report.rows, written[1])
    written[2].write_text(markdown(report), encoding="utf-8")
    return written


def write_rows(rows: Sequence[Row], path: Path) -> None:
    """One line for each trial; columns as in ``run.Row``."""
    with path.open("w", newline="", encoding="utf-8") as file:
        writer = csv.DictWriter(file, [column.name for column in fields(Row)])
        writer.writeheader()
        for row in rows:
            values = asdict(row)
            writer.writerow(
                {name: f"{value:.4g}" if isinstance(value, float) else value
                 for name, value in values.items()}
            )  # fmt: skip
