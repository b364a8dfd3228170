"""Runs trials: results, conditions, energy, time, and the verdict."""

from __future__ import annotations

import time
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np

from railpatch import _core
from railpatch.case.load import Case, load_scene
from railpatch.case.patch import PatchCase
from railpatch.case.theories import FAST
from railpatch.case.to_core import config_of, input_of
from railpatch.case.types import SIDES
from railpatch.errors import CaseError, ProfileError
from railpatch.evidence.stress.conditions import energy_balance, findings, line_of
from railpatch.evidence.stress.step import FIELDS, VECTORS, Finding, Step
from railpatch.evidence.stress.trial import Move, Trial

# from good to bad; a trial has the worst of its steps
ORDER = ("refused", "no_contact", "converged", "out_of_range", "not_converged")
CLEAN, SAYS_SO, FAULT = "clean", "says so", "fault"
DEFAULT_ITERATIONS = 100
# products of the tangential operator in one of its iterations: of the linear system, and of the
# steps that follow where it does not help
PRODUCTS = 2000
# why fast theories may say that they are out of range
ENDS = {
    **dict.fromkeys(FAST, "ends where Kalker's coefficients are tabulated"),
    "linear": "no bound: ends where the force reaches friction",
    "table": "ends with its table",
}
# not given where the scene has no such stage
NUMBERS = ("normal_force", "max_pressure", "contact_area", "residual")
TANGENTIAL_NUMBERS = ("creep_force", "spin_moment", "friction_power")


@dataclass(frozen=True, kw_only=True)
class Row:
    """One line of the table. conditions: greatest share of a limit, and which; -1 without any.
    energy: NaN where it is not a whole balance. seconds: of all steps. relative_time: of a step,
    over the nominal case's. expected: whether every step ended as the trial expects. reason: of
    the verdict. note: why, by the trial."""

    family: str
    name: str
    method: str
    steps: int
    status: str
    residual: float
    conditions: float
    condition: str
    energy: float
    iterations: int
    products: int
    seconds: float
    relative_time: float
    verdict: str
    expected: bool
    reason: str
    note: str


def run_trial(trial: Trial, nominal_time: float = float("nan")) -> Row:
    """Runs all steps of a trial. nominal_time: s, of the nominal case."""
    try:
        scene = load_scene(trial.case)
        contact = _core.Contact(config_of(scene), False)
        values = input_of(scene.case)
        outcomes = list(outcomes_of(contact, scene.case, values, trial.moves))
    except (CaseError, ProfileError, ValueError, RuntimeError) as error:
        outcomes = [Outcome("refused", [], 0.0, trial.moves[0], str(error))]
    return row_of(trial, outcomes, nominal_time)


@dataclass
class Outcome:
    """What one step gave."""

    status: str
    patches: list[Step]
    seconds: float
    move: Move
    error: str = ""
    raw: dict[str, Any] | None = None


def outcomes_of(
    contact: Any, case: Case, values: dict[str, Any], moves: tuple[Move, ...]
) -> Iterator[Outcome]:
    """Takes the steps one after the other."""
    before: Step | None = None
    for move in moves:
        values = {**values, **move.changes}
        begin = time.perf_counter()
        try:
            raw = contact.step(values)
        except (CaseError, ValueError, RuntimeError) as error:
            yield Outcome("refused", [], time.perf_counter() - begin, move, str(error))
            continue
        seconds = time.perf_counter() - begin
        patches = steps_of(contact, case, values, raw, before)
        before = patches[0] if isinstance(case, PatchCase) else None
        yield Outcome(raw["status"], patches, seconds, move, raw=raw)


def steps_of(
    contact: Any, case: Case, values: dict[str, Any], raw: dict[str, Any], before: Step | None
) -> list[Step]:
    """Every patch with its fields."""
    if before is not None:
        # one step back is enough
        before = Step(before.case, before.values, before.patch, before.fields)
    return [
        Step(
            case, values, patch, fields_of(contact, SIDES.index(side), index, patch["grid"]), before
        )
        for side in SIDES
        for index, patch in enumerate(raw[side]["patches"] + raw[side]["alternatives"])
    ]


def fields_of(contact: Any, side: int, patch: int, grid: list[int]) -> dict[str, Any]:
    """The fields of a patch in their shapes."""
    found: dict[str, Any] = {}
    nx, ny = grid
    for name in FIELDS:
        try:
            values = contact.field(side, patch, name)
        except RuntimeError:
            values = None
        # nodes of fitted rows have their own x in each row
        of_axis = name == "y" or (name == "x" and values is not None and values.size == nx)
        if values is not None and not of_axis:
            values = values.reshape((2, ny, nx) if name in VECTORS else (ny, nx))
        found[name] = values
    return found


def row_of(trial: Trial, outcomes: list[Outcome], nominal_time: float) -> Row:
    """The line of a trial, by the worst of its steps."""
    worst = Finding("", -1.0, 1.0)
    share, energy, residual, faults, told = -1.0, float("nan"), 0.0, [], []
    iterations = products = 0
    for number, outcome in enumerate(outcomes):
        where = f"step {number + 1}: " if len(outcomes) > 1 else ""
        for step in outcome.patches:
            residual = max_or_nan(residual, step.patch["residual"])
            iterations += step.patch["normal_iterations"] + step.patch["newton_iterations"]
            products += step.patch["inner_iterations"]
            if step.good:
                for finding in findings(step, trial.family != "mixture"):
                    if not finding.share <= share:
                        share, worst = float(finding.share), finding
                balance = energy_balance(step)
                energy = balance if np.isnan(energy) else max_or_nan(energy, balance)
        faults += [where + text for text in faults_of(outcome)]
        told += [where + text for text in unsolved(outcome)]
    if not share <= 1:
        faults.append(f"{worst.name}: {worst.value:.2e}, allowed {worst.limit:.2e}")
    seconds = sum(outcome.seconds for outcome in outcomes)
    return Row(
        family=trial.family,
        name=trial.name,
        method=trial.method,
        steps=len(outcomes),
        status=max((outcome.status for outcome in outcomes), key=ORDER.index),
        residual=residual,
        conditions=share,
        condition=worst.name,
        energy=energy,
        iterations=iterations,
        products=products,
        seconds=seconds,
        relative_time=seconds / len(outcomes) / nominal_time,
        verdict=FAULT if faults else SAYS_SO if told else CLEAN,
        expected=all(outcome.status in outcome.move.expects for outcome in outcomes),
        reason="; ".join(faults or told),
        note=trial.note or (ENDS.get(trial.method, "") if told else ""),
    )


def max_or_nan(a: float, b: float) -> float:
    """The greater one; NaN where one is."""
    return float(np.maximum(a, b))


def unsolved(outcome: Outcome) -> Iterator[str]:
    """A status that says that there is no solution."""
    if outcome.status in ("not_converged", "out_of_range"):
        yield outcome.status


def faults_of(outcome: Outcome) -> Iterator[str]:
    """What must not be, whatever the status."""
    if outcome.status not in outcome.move.expects and outcome.status in (
        "converged",
        "no_contact",
        "refused",
    ):
        text = f" ({outcome.error})" if outcome.error else ""
        yield f"{outcome.status}, expected {' or '.join(outcome.move.expects)}{text}"
    for step in outcome.patches:
        yield from no_numbers(step)
        yield from too_many_iterations(step)
    if outcome.raw is not None and outcome.status == "converged":
        for side in SIDES:
            vectors = (*outcome.raw[side]["force"], *outcome.raw[side]["moment"])
            wheels = outcome.patches and not isinstance(outcome.patches[0].case, PatchCase)
            if wheels and not np.isfinite(vectors).all():
                yield f"force of the {side} wheel is no number"


def no_numbers(step: Step) -> Iterator[str]:
    """Values that are no number where the scene has them."""
    patch = step.patch
    if patch["status"] == "out_of_range" and not step.has("pressure"):
        return  # the contact does not fit: nothing was solved
    names: list[str] = list(NUMBERS)
    if step.regime != "none" and step.case.method.tangential != "none":
        names += TANGENTIAL_NUMBERS
    if not line_of(step):
        names.append("approach")
    if patch["status"] != "no_contact":
        for name in names:
            # a search that found no force at all has an infinite residual
            searched = name == "residual" and patch["status"] == "out_of_range"
            wrong = np.isnan(patch[name]) if searched else ~np.isfinite(patch[name])
            if wrong.any():
                yield f"{name} is no number"
    for name, values in step.fields.items():
        if values is not None and not np.isfinite(values).all():
            yield f"{name} holds {int((~np.isfinite(values)).sum())} that are no numbers"


def too_many_iterations(step: Step) -> Iterator[str]:
    """Iterations beyond the bound that the case gives."""
    most = step.case.method.max_iterations or DEFAULT_ITERATIONS
    patch = step.patch
    rounds = max(patch["outer_iterations"], 1)
    for name, bound in (
        ("newton_iterations", most * rounds),
        ("outer_iterations", most),
        ("inner_iterations", PRODUCTS * most * rounds),
    ):
        if patch[name] > bound:
            yield f"{name} are {patch[name]}, allowed {bound}"
    exact = step.case.method.normal == "half_space"
    if exact and patch["normal_iterations"] > most * rounds:
        yield f"normal_iterations are {patch['normal_iterations']}, allowed {most * rounds}"
