"""Statistics of measurements: percentiles, frontier, growth, calibration of error estimates."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from railpatch.evidence.bench.measure import Measured
from railpatch.evidence.bench.shapes import Floats

ERRORS = ("force_error", "moment_error", "pressure_error", "power_error")
ESTIMATED = ("force", "moment", "pressure")
# what an error estimate must be: below it in so many cases, within the factor in so many
COVERED, WITHIN, FACTOR = 0.95, 0.80, 4.0
# of the scales of errors: what the truth itself is known to; smaller errors count as this one
NOISE = 3e-4
NO_ERROR = 1e-12  # below it an error is exact, and no estimate of it is too great


@dataclass(frozen=True)
class Summary:
    """A measurement in numbers; the names of values are columns of summary.csv.

    method, title: name and label of the method; label: with its grid.
    """

    method: str
    title: str
    label: str
    elements: int
    problem_set: str
    cases: int
    not_converged: int
    values: dict[str, float]

    def row(self) -> dict[str, object]:
        """One line of summary.csv."""
        head = {
            "method": self.method,
            "label": self.label,
            "elements": self.elements,
            "set": self.problem_set,
            "cases": self.cases,
            "not_converged": self.not_converged,
        }
        return {**head, **self.values}


def percentile(values: Floats, share: float) -> float:
    """Percentile of the finite values, NaN without any; between two values, the greater."""
    values = values[np.isfinite(values)]
    return float(np.percentile(values, share, method="higher")) if values.size else float("nan")


def summarize(measured: Measured) -> Summary:
    """Median, 95th percentile and greatest error, run times in seconds, work, memory."""
    columns, good = measured.columns, measured.good
    values: dict[str, float] = {}
    for name in ERRORS:
        found = columns[name][good]
        for key, share in (("median", 50), ("p95", 95), ("max", 100)):
            values[f"{name}_{key}"] = percentile(found, share)
    for name in ("cold", "warm"):
        values[f"{name}_median"] = percentile(columns[name], 50)
        values[f"{name}_p99"] = percentile(columns[name], 99)
        for work in ("iterations", "products"):
            values[f"{name}_{work}_median"] = percentile(columns[f"{name}_{work}"], 50)
            values[f"{name}_{work}_max"] = percentile(columns[f"{name}_{work}"], 100)
    values["start_difference_max"] = percentile(columns["start_difference"][good], 100)
    values["bytes"] = float(measured.bytes)
    for name in ESTIMATED:
        covered, within = calibration(
            columns[f"{name}_error"][good], columns[f"{name}_estimate"][good]
        )
        values[f"{name}_estimate_covers"] = covered
        values[f"{name}_estimate_within"] = within
    return Summary(
        method=measured.method.name,
        title=measured.method.label,
        label=measured.point,
        elements=measured.elements,
        problem_set=measured.set_name,
        cases=len(good),
        not_converged=int((~good).sum()),
        values=values,
    )


def calibration(error: Floats, estimate: Floats) -> tuple[float, float]:
    """Shares of cases with error <= estimate, and with estimate <= FACTOR times error.

    NaN without estimates. An error of nothing has no estimate that is too great a multiple of it,
    so such cases count for the first share only; one below NOISE counts as NOISE for the second.
    """
    given = np.isfinite(estimate) & np.isfinite(error)
    if not given.any():
        return float("nan"), float("nan")
    error, estimate = error[given], estimate[given]
    some = error > NO_ERROR
    covered = float((error <= estimate + NO_ERROR).mean())
    near = estimate[some] <= FACTOR * np.maximum(error[some], NOISE)
    within = float(near.mean()) if some.any() else float("nan")
    return covered, within


def frontier(time: Floats, error: Floats) -> list[int]:
    """Indices of the points that no other one beats in both, from the fastest to the most exact."""
    best, found = np.inf, []
    for index in np.lexsort((error, time)):
        if error[index] < best and np.isfinite(time[index]):
            best = error[index]
            found.append(int(index))
    return found


def growth(elements: Floats, time: Floats) -> float:
    """Exponent p of time = c N^p with N elements, least squares of the logarithms."""
    return float(np.polyfit(np.log(elements), np.log(time), 1)[0])


def fastest_within(summaries: list[Summary], error: float) -> Summary | None:
    """The fastest warm method and grid whose force error is within, by its 95th percentile."""
    good = [s for s in summaries if s.values["force_error_p95"] <= error and s.not_converged == 0]
    return min(good, key=lambda s: s.values["warm_median"], default=None)
