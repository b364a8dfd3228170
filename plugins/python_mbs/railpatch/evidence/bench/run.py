"""A whole benchmark: its plan and its measurements."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

from railpatch.evidence.bench import cost
from railpatch.evidence.bench.evaluations import Evaluation, evaluations, search_time
from railpatch.evidence.bench.features import FeatureCost, feature_costs
from railpatch.evidence.bench.machine import Machine, this_machine
from railpatch.evidence.bench.measure import Measured, measure
from railpatch.evidence.bench.methods import Method
from railpatch.evidence.bench.sets import SETS
from railpatch.evidence.bench.statistics import summarize
from railpatch.evidence.bench.tail import Tail, tails
from railpatch.evidence.bench.targets import Outcome
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
        return len(self.points()) + len(self.sizes()) + 5

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
    tails: list[Tail]


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
    walks = tails(plan.quick, progress)
    return Report(plan, machine, truth, measured, outcome, features, wheels, search, walks)
