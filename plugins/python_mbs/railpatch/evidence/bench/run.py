"""A whole benchmark: measurements, files and the page."""

from __future__ import annotations

import csv
import gzip
import json
from collections.abc import Callable, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

from railpatch.evidence.bench import cost
from railpatch.evidence.bench.evaluations import Evaluation, evaluations, search_time
from railpatch.evidence.bench.features import FeatureCost, feature_costs
from railpatch.evidence.bench.machine import Machine, this_machine
from railpatch.evidence.bench.measure import COLUMNS, Measured, measure
from railpatch.evidence.bench.methods import Method
from railpatch.evidence.bench.sets import SEED, SETS
from railpatch.evidence.bench.statistics import summarize
from railpatch.evidence.bench.targets import Outcome, rows
from railpatch.evidence.bench.truth import TruthFile, batches_of

QUICK_RIG_POSITIONS = 37


@dataclass(frozen=True)
class Plan:
    """What is measured. sets: letters. quick: a part of everything, in some two minutes."""

    methods: Sequence[Method]
    sets: str
    quick: bool

    def points(self) -> list[tuple[Method, int, str]]:
        """Method, elements across, set."""
        return [
            (method, elements, name)
            for method in self.methods
            for elements in (method.quick if self.quick else method.grids)
            for name in self.sets
            if name in method.sets
        ]

    def sizes(self) -> list[tuple[Method, int]]:
        """Method and elements across for the cost over the number of elements."""
        across = cost.QUICK_SIZES if self.quick else cost.SIZES
        return [(method, n) for method in self.methods if method.growth for n in across]

    @property
    def total(self) -> int:
        """Steps of the progress bar."""
        return len(self.points()) + len(self.sizes()) + 4

    def check(self) -> None:
        """Makes one contact of every method and set. Raises CaseError where a case is refused."""
        for method, elements, name in self.points():
            method.contact(batches_of(name)[0], elements)


@dataclass(frozen=True)
class Report:
    """All that was measured, for files and page."""

    plan: Plan
    machine: Machine
    truth: TruthFile
    measured: list[Measured]
    outcome: Outcome
    features: list[FeatureCost]
    evaluations: list[Evaluation]
    search: float  # s, contact search of one wheel


def run_bench(
    plan: Plan, truth: TruthFile, progress: Callable[[Any], None] = lambda _: None
) -> Report:
    """Measures everything of the plan. Raises CaseError where a method is refused."""
    plan.check()
    machine = this_machine()
    measured = []
    for method, elements, name in plan.points():
        limit = SETS[name].quick if plan.quick else None
        measured.append(measure(method, elements, name, truth, limit))
        progress(measured[-1])
    costs = []
    for method, across in plan.sizes():
        costs.append(cost.size_cost(method, across))
        progress(costs[-1])
    normal = cost.normal_cost()
    progress(normal)
    wheel = cost.wheel_cost(QUICK_RIG_POSITIONS if plan.quick else cost.RIG_POSITIONS)
    progress(wheel)
    outcome = Outcome([summarize(m) for m in measured], costs, normal, wheel)
    features = feature_costs(plan.quick, progress)
    wheels = evaluations(plan.quick, progress)
    search = search_time(plan.quick)
    return Report(plan, machine, truth, measured, outcome, features, wheels, search)


def write_report(report: Report, folder: Path) -> list[Path]:
    """Writes report.html, summary.csv, cases.csv.gz, cost.csv, features.csv, run.json, frontier.svg
    and .png."""
    from railpatch.evidence.bench.page import page
    from railpatch.evidence.bench.picture import write_pictures

    folder.mkdir(parents=True, exist_ok=True)
    written = [
        write_summary(report, folder / "summary.csv"),
        write_cases(report.measured, folder / "cases.csv.gz"),
        write_cost(report, folder / "cost.csv"),
        write_features(report.features, folder / "features.csv"),
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
