"""What a match finds: parameters, explanations, and what is told of them."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np

from railpatch._core import version
from railpatch.match.fit import Fit, Search
from railpatch.match.found_parts import RowsFound, Sampled, Screened
from railpatch.match.judge import LeftOut, correlations
from railpatch.match.plan import Explanation, ObservedColumn, Plan
from railpatch.match.point_units import unit_of_observed
from railpatch.record.quantities import BY_NAME
from railpatch.record.units import UNITS


@dataclass(frozen=True)
class Parameter:
    """What was found of one key: its value, the interval that holds it with 95 %, and its unit, ""
    where none is known."""

    key: str
    value: float
    low: float
    high: float
    of_range: tuple[float, float]
    unit: str = ""


@dataclass(frozen=True)
class Judged:
    """One explanation with its fit. search: what it was found with. rows: what each has for itself.
    chains: factor and offset of measuring chains, by what was observed: value and standard
    deviation. screening, samples: by key, empty without."""

    explanation: Explanation
    search: Search
    fit: Fit
    parameters: tuple[Parameter, ...]
    predicted: LeftOut | None
    not_told: tuple[str, ...]
    rows: RowsFound | None = None
    chains: dict[str, dict[str, tuple[float, float]]] = field(default_factory=dict)
    screening: dict[str, Screened] = field(default_factory=dict)
    samples: dict[str, Sampled] = field(default_factory=dict)

    @property
    def criterion(self) -> float:
        """-, Akaike's: twice the number of parameters, those of rows too, minus twice the logarithm
        of likelihood."""
        count = len(self.parameters) + self.search.model.free
        return 2 * count - 2 * self.fit.likelihood

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
        content = own.explanation.case({found.key: found.value for found in own.parameters})
        if own.rows is not None:
            content["rig"][own.rows.name] = own.rows.table()
        return content

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
                    "unit": found.unit,
                }
                for found in own.parameters
            },
            "ranges": {found.key: list(found.of_range) for found in own.parameters},
            "residuals": overall(own, self.plan) | residuals_of(own, self.plan),
            "comparison": [
                {"model": judged.explanation.name, "log_likelihood_held_out": held_out(judged)}
                for judged in sorted(self.explanations, key=lambda one: -(held_out(one) or 0.0))
            ],
            "correlations": {
                key: dict(zip(keys, row.tolist(), strict=True))
                for key, row in zip(keys, table, strict=True)
            },
            "not_told": list(own.not_told),
            "rows": {own.rows.name: own.rows.to_dict()} if own.rows else {},
            "chains": {
                key: {name: {"value": v, "error": e} for name, (v, e) in parts.items()}
                for key, parts in own.chains.items()
            },
            "screening": {key: vars(one) for key, one in own.screening.items()},
            "samples": {key: vars(one) for key, one in own.samples.items()},
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


def overall(judged: Judged, plan: Plan) -> dict[str, Any]:
    """Of all that was observed: rms in its unit, where quantities differ in units over the greatest
    measured value of each."""
    model = judged.search.model
    units = {unit_of(key, column, plan) for key, column in plan.table.observed.items()}
    alone = len(units) == 1
    scale = np.ones(len(plan.table.observed)) if alone else judged.search.scale
    left = judged.fit.left / scale[:, None]
    used = left[np.isfinite(model.measured)]
    return {"rms": float(np.sqrt(np.mean(used**2))), "unit": units.pop() if alone else "-"}


def unit_of(key: str, column: ObservedColumn, plan: Plan) -> str:
    """SI unit of what was observed."""
    if plan.record is not None:
        return unit_of_observed(key, column, column.over)
    return next(iter(UNITS[BY_NAME[key].dimension]))


def held_out(judged: Judged) -> float | None:
    """Logarithm of the likelihood of all points, each predicted while it was left out."""
    found = judged.predicted
    return None if found is None else found.density * int(judged.search.there.sum())


def residuals_of(judged: Judged, plan: Plan) -> dict[str, Any]:
    """By what was observed."""
    noise = judged.fit.noise
    return {
        key: {"rms": float(rms), "error": float(error), "discrepancy": float(error * noise.size)}
        for key, rms, error in zip(plan.table.observed, judged.fit.rms, noise.error, strict=True)
    }


def left_out_of(judged: Judged, plan: Plan) -> dict[str, Any] | None:
    """Of points that were predicted."""
    found = judged.predicted
    if found is None:
        return None
    rms = dict(zip(plan.table.observed, found.rms.tolist(), strict=True))
    return {"rms": rms, "within_95": found.within, "log_density": found.density}
