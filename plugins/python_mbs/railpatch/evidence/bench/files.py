"""The files of a benchmark: page, pictures and tables."""

from __future__ import annotations

import csv
import gzip
import json
from dataclasses import asdict
from pathlib import Path

from railpatch.evidence.bench.features import FeatureCost
from railpatch.evidence.bench.measure import COLUMNS, Measured
from railpatch.evidence.bench.page import page
from railpatch.evidence.bench.picture import write_pictures
from railpatch.evidence.bench.run import Report
from railpatch.evidence.bench.sets import SEED
from railpatch.evidence.bench.tail import Tail
from railpatch.evidence.bench.targets import rows


def write_report(report: Report, folder: Path) -> list[Path]:
    """Writes report.html, summary.csv, cases.csv.gz, cost.csv, features.csv, tail.csv, run.json,
    frontier.svg and .png."""
    folder.mkdir(parents=True, exist_ok=True)
    written = [
        write_summary(report, folder / "summary.csv"),
        write_cases(report.measured, folder / "cases.csv.gz"),
        write_cost(report, folder / "cost.csv"),
        write_features(report.features, folder / "features.csv"),
        write_tails(report.tails, folder / "tail.csv"),
        write_run(report, folder / "run.json"),
        *write_pictures(report, folder),
    ]
    target = folder / "report.html"
    target.write_text(page(report), encoding="utf-8")
    return [target, *written]


def write_summary(report: Report, path: Path) -> Path:
    """One line for each method, grid and set; units as in ``statistics.Summary``."""
    lines = [summary.row() for summary in report.outcome.summaries]
    with path.open("w", newline="", encoding="utf-8") as file:
        writer = csv.DictWriter(file, list(lines[0]))
        writer.writeheader()
        writer.writerows(lines)
    return path


def write_cases(measured: list[Measured], path: Path) -> Path:
    """One line for each method, grid and step; columns as in ``measure.Measured``."""
    with gzip.open(path, "wt", newline="", encoding="utf-8") as file:
        writer = csv.writer(file)
        writer.writerow(["method", "elements", "set", "batch", "step", "good", *COLUMNS])
        for m in measured:
            table = zip(*(m.columns[name] for name in COLUMNS), strict=True)
            for place, good, values in zip(m.place, m.good, table, strict=True):
                numbers = [f"{value:.6g}" for value in values]
                writer.writerow(
                    [m.method.name, m.elements, m.set_name, *place, int(good), *numbers]
                )
    return path


def write_cost(report: Report, path: Path) -> Path:
    """Cost over the number of elements."""
    with path.open("w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file)
        writer.writerow(["method", "across", "elements", "cold_s", "warm_s"])
        for c in report.outcome.costs:
            writer.writerow([c.method.name, c.across, c.elements, c.cold, c.warm])
    return path


def write_features(features: list[FeatureCost], path: Path) -> Path:
    """Cost of each piece of physics; columns as in ``features.FeatureCost``."""
    with path.open("w", newline="", encoding="utf-8") as file:
        writer = csv.DictWriter(file, list(asdict(features[0])))
        writer.writeheader()
        writer.writerows(asdict(feature) for feature in features)
    return path


def write_tails(tails: list[Tail], path: Path) -> Path:
    """One line for each method and what is prescribed; columns as in ``tail.Tail.row``."""
    with path.open("w", newline="", encoding="utf-8") as file:
        writer = csv.DictWriter(file, list(tails[0].row()))
        writer.writeheader()
        writer.writerows(one.row() for one in tails)
    return path


def write_run(report: Report, path: Path) -> Path:
    """Machine, options, truth and targets."""
    content = {
        "machine": asdict(report.machine),
        "quick": report.plan.quick,
        "sets": report.plan.sets,
        "methods": [method.name for method in report.plan.methods],
        "seed": SEED,
        "truth": report.truth.recipes,
        "normal_problem_s": report.outcome.normal,
        "rig": asdict(report.outcome.wheel),
        "contact_search_s": report.search,
        "wheel_evaluations": [asdict(one) for one in report.evaluations],
        "targets": [asdict(row) for row in rows(report.outcome)],
    }
    path.write_text(json.dumps(content, indent=2), encoding="utf-8")
    return path
