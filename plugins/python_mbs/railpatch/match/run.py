"""A whole match: every explanation's fit, and the files that come of it."""

from __future__ import annotations

import json
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np

from railpatch.case.key_units import unit_of_key
from railpatch.case.kinds import kind_of
from railpatch.match.fit import Fit, Search, refuse_unsolved
from railpatch.match.found import Judged, Match, Parameter
from railpatch.match.found_parts import RowsFound
from railpatch.match.interval import intervals_of
from railpatch.match.judge import left_out, not_told
from railpatch.match.model import RunModel, model_of, need_writer, placed, toml_of
from railpatch.match.page import page_of
from railpatch.match.plan import Explanation, Plan
from railpatch.match.sample import need_samplers, sampled
from railpatch.match.screen import screened
from railpatch.sweep.plan import steps_of
from railpatch.writing import write_whole

Told = Callable[[str], None]


def write_match(match: Match, folder: Path) -> list[Path]:
    """match.toml, match.json, match.csv and match.html. Raises OSError, CaseError."""
    folder.mkdir(parents=True, exist_ok=True)
    scene = placed(match.scene(), match.plan.folder)
    text = json.dumps(match.to_dict(), indent=2, allow_nan=False) + "\n"
    return [
        write_whole(folder / "match.toml", toml_of(scene).encode()),
        write_whole(folder / "match.json", text.encode()),
        write_whole(folder / "match.csv", rows_of(match).encode()),
        write_whole(folder / "match.html", page_of(match).encode()),
    ]


def rows_of(match: Match) -> str:
    """Points as CSV: inputs, measured, computed, standard deviation of a point, SI units."""
    own, observed = match.explanations[0], list(match.plan.table.observed)
    model = own.search.model
    heads = [*model.inputs]
    columns = [*model.inputs.values()]
    for k, key in enumerate(observed):
        heads += [f"{key} measured", f"{key} computed", f"{key} spread"]
        columns += [model.measured[k], own.fit.computed[k], own.fit.spread[k]]
    if own.rows is not None:
        heads += [own.rows.name, f"{own.rows.name} low", f"{own.rows.name} high"]
        columns += [own.rows.values, own.rows.low, own.rows.high]
    lines = [",".join(f'"{head}"' for head in ["row", *heads])]
    for place, values in zip(model.rows, np.array(columns).T, strict=True):
        cells = ["" if np.isnan(v) else repr(float(v)) for v in values]
        lines.append(",".join([str(int(place) + 1), *cells]))
    return "\n".join(lines) + "\n"


def run_match(plan: Plan, *, threads: int = 1, tell: Told = lambda _: None) -> Match:
    """Fits every explanation. threads: of the solver. tell: is told how far it is.

    Raises CaseError, ProfileError.
    """
    need_writer()
    need_samplers(plan.table)
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
    model = model_of(plan, explanation, threads)
    search = Search(model, tell)
    refuse_unsolved(model, model.at(np.full(len(model.keys), 0.5)))
    felt = screened(search) if plan.table.screening else {}
    fit = search.run()
    fit.intervals = intervals_of(search, fit, plan.table.intervals)
    predicted = left_out(search, fit)
    parameters = tuple(
        Parameter(
            key,
            one.at(float(share)),
            one.at(low),
            one.at(high),
            (one.low, one.high),
            unit_of_parameter(plan, explanation, key),
        )
        for (key, one), share, (low, high) in zip(
            explanation.seek.items(), fit.shares, fit.intervals, strict=True
        )
    )
    rows = rows_found(search, fit)
    return Judged(
        explanation,
        search,
        fit,
        parameters,
        predicted,
        tuple(not_told(search, fit, felt, rows)),
        rows,
        search.chains(fit),
        felt,
        sampled(search, fit) if plan.table.sampling == "emcee" else {},
    )


def unit_of_parameter(plan: Plan, explanation: Explanation, key: str) -> str:
    """Of a key of the scene; of a column's offset that column's own."""
    steps = steps_of(key, "match.sought")
    if steps[:2] == ["rig", "columns"] and steps[-1] == "offset":
        name = str(steps[2])
        given = explanation.content["rig"].get("columns", {}).get(name, {}).get("unit")
        return str(given or plan.units.get(name, ""))
    return unit_of_key(kind_of(plan.kind).schema(), steps)


def rows_found(search: Search, fit: Fit) -> RowsFound | None:
    """What each row has for itself, at the optimum; None without rows."""
    model = search.model
    if not isinstance(model, RunModel) or not model.free:
        return None
    (name,) = model.plan.table.rows
    search.at_optimum(fit)
    found = model.followed.row_values(fit.covariance)
    return RowsFound(name, model.followed.progress, *found)
