"""A whole match: every explanation's fit, and the files that come of it."""

from __future__ import annotations

import json
import time
from collections.abc import Callable
from dataclasses import dataclass
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from railpatch._core import version
from railpatch.errors import CaseError
from railpatch.match.fit import Fit, Search, refuse_unsolved
from railpatch.match.judge import LeftOut, correlations, left_out, not_told
from railpatch.match.model import Model
from railpatch.match.plan import Explanation, Plan
from railpatch.writing import write_whole

Array = NDArray[np.float64]
Told = Callable[[str], None]


@dataclass(frozen=True)
class Parameter:
    """What was found of one key: its value, and the interval that holds it with 95 %."""

    key: str
    value: float
    low: float
    high: float
    of_range: tuple[float, float]


@dataclass(frozen=True)
class Judged:
    """One explanation with its fit. search: what it was found with."""

    explanation: Explanation
    search: Search
    fit: Fit
    parameters: tuple[Parameter, ...]
    predicted: LeftOut | None
    not_told: tuple[str, ...]

    @property
    def criterion(self) -> float:
        """-, Akaike's: twice the number of parameters minus twice the logarithm of likelihood."""
        return 2 * len(self.parameters) - 2 * self.fit.likelihood

    @property
    def evaluations(self) -> int:
        """Of the scene at all points."""
        return self.search.model.evaluations


@dataclass(frozen=True)
class Match:
    """What was found. explanations: the match's own first. seconds: by the clock."""

    plan: Plan
    explanations: tuple[Judged, ...]
    seconds: float

    @property
    def parameters(self) -> dict[str, Parameter]:
        """Of the match's own explanation, by key."""
        return {found.key: found for found in self.explanations[0].parameters}

    def scene(self) -> dict[str, Any]:
        """The content of the scene with the values found."""
        own = self.explanations[0]
        return own.explanation.case({found.key: found.value for found in own.parameters})

    def to_dict(self) -> dict[str, Any]:
        """What match.json holds."""
        own = self.explanations[0]
        table = correlations(own.fit)
        keys = [found.key for found in own.parameters]
        return {
            "version": version(),
            "points": int(own.search.there.sum()),
            "parameters": {
                found.key: {
                    "value": found.value,
                    "low": found.low,
                    "high": found.high,
                    "range": list(found.of_range),
                }
                for found in own.parameters
            },
            "residuals": residuals_of(own, self.plan),
            "correlations": {
                key: dict(zip(keys, row.tolist(), strict=True))
                for key, row in zip(keys, table, strict=True)
            },
            "not_told": list(own.not_told),
            "explanations": {
                judged.explanation.name: {
                    "parameters": {
                        found.key: [found.value, found.low, found.high]
                        for found in judged.parameters
                    },
                    "log_likelihood": judged.fit.likelihood,
                    "akaike": judged.criterion,
                    "residuals": residuals_of(judged, self.plan),
                    "left_out": left_out_of(judged, self.plan),
                }
                for judged in self.explanations
            },
            "evaluations": sum(judged.evaluations for judged in self.explanations),
            "seconds": self.seconds,
        }

    def write(self, folder: Path) -> list[Path]:
        """match.toml, match.json, match.csv and match.html. Raises OSError, CaseError."""
        from railpatch.match.page import page_of

        folder.mkdir(parents=True, exist_ok=True)
        text = json.dumps(self.to_dict(), indent=2, allow_nan=False) + "\n"
        return [
            write_whole(folder / "match.toml", toml_of(self.placed(folder)).encode()),
            write_whole(folder / "match.json", text.encode()),
            write_whole(folder / "match.csv", rows_of(self).encode()),
            write_whole(folder / "match.html", page_of(self).encode()),
        ]

    def placed(self, folder: Path) -> dict[str, Any]:
        """The scene's content; files that it names by their way from a folder."""
        content = self.scene()
        for key, name in list(content.get("profiles", {}).items()):
            file = self.plan.folder / name if isinstance(name, str) else None
            if file is not None and file.is_file():
                content["profiles"][key] = str(file.resolve())
        return content


def residuals_of(judged: Judged, plan: Plan) -> dict[str, Any]:
    """By what was observed."""
    noise = judged.fit.noise
    return {
        key: {"rms": float(rms), "error": float(error), "discrepancy": float(error * noise.size)}
        for key, rms, error in zip(
            plan.table.observed, judged.fit.rms, noise.error, strict=True
        )
    }


def left_out_of(judged: Judged, plan: Plan) -> dict[str, Any] | None:
    """Of points that were predicted."""
    found = judged.predicted
    if found is None:
        return None
    rms = dict(zip(plan.table.observed, found.rms.tolist(), strict=True))
    return {"rms": rms, "within_95": found.within, "log_density": found.density}


def rows_of(match: Match) -> str:
    """Points as CSV: inputs, measured, computed, standard deviation of a point, SI units."""
    own, observed = match.explanations[0], list(match.plan.table.observed)
    model = own.search.model
    heads = [*model.inputs]
    columns = [*model.inputs.values()]
    for k, key in enumerate(observed):
        heads += [f"{key} measured", f"{key} computed", f"{key} spread"]
        columns += [model.measured[k], own.fit.computed[k], own.fit.spread[k]]
    lines = [",".join(f'"{head}"' for head in ["row", *heads])]
    for place, values in zip(model.rows, np.array(columns).T, strict=True):
        cells = ["" if np.isnan(v) else repr(float(v)) for v in values]
        lines.append(",".join([str(int(place) + 1), *cells]))
    return "\n".join(lines) + "\n"


def toml_of(content: dict[str, Any]) -> str:
    """Raises CaseError where the writer is not installed."""
    need_writer()
    import tomli_w

    return tomli_w.dumps(content)


def need_writer() -> None:
    """Raises CaseError where the writer is not installed."""
    if find_spec("tomli_w") is None:
        raise CaseError("tomli-w is not installed: pip install 'railpatch[match]'")


def run_match(plan: Plan, *, threads: int = 1, tell: Told = lambda _: None) -> Match:
    """Fits every explanation. threads: of the solver. tell: is told how far it is.

    Raises CaseError, ProfileError.
    """
    begin = time.perf_counter()
    judged = []
    for explanation in plan.explanations:
        named = "" if len(plan.explanations) == 1 else f"{explanation.name}: "

        def told(text: str, named: str = named) -> None:
            tell(named + text)

        judged.append(judge(plan, explanation, threads, told))
    return Match(plan, tuple(judged), time.perf_counter() - begin)


def judge(plan: Plan, explanation: Explanation, threads: int, tell: Told) -> Judged:
    """One explanation. Raises CaseError, ProfileError."""
    model = Model(plan, explanation, threads)
    search = Search(model, tell)
    refuse_unsolved(model, model.at(np.full(len(model.keys), 0.5)))
    fit = search.run()
    fit.intervals = search.intervals(fit, plan.table.intervals)
    predicted = left_out(search, fit)
    parameters = tuple(
        Parameter(key, one.at(float(share)), one.at(low), one.at(high), (one.low, one.high))
        for (key, one), share, (low, high) in zip(
            explanation.seek.items(), fit.shares, fit.intervals, strict=True
        )
    )
    return Judged(explanation, search, fit, parameters, predicted, tuple(not_told(search, fit)))
