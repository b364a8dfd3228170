"""Broyden's method for few unknowns, each evaluation of which is costly.

Solves f(x) = 0. The Jacobian J is found by differences once; then every evaluation corrects it by
the change of least size that explains what was seen (Broyden 1965, Math. Comp. 19, method 1):

    J <- J + (df - J dx) dx^T / (dx^T dx)

J lives on in the solver, so that the next solve of a neighbouring problem starts with it. "Size" is
measured with unknowns scaled such that the columns of the first J have norm one, and residuals
scaled by the caller.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from rig_model.search import Evaluation, Function, Root, Settings, Vector

# the search starts anew when this many evaluations did not halve the residual
PATIENCE = 5
# shorter steps towards the best point before a direction is given up
MOST_HALVINGS = 6


@dataclass(frozen=True)
class _Point:
    x: Vector
    f: Vector  # scaled
    merit: float
    evaluation: Evaluation


@dataclass
class _Count:
    """What one solve has used up, and the merits of its best points."""

    evaluations: int = 0
    iterations: int = 0
    restarts: int = 0
    merits: list[float] = field(default_factory=list)


class Broyden:
    """A solver whose Jacobian lives on between solves."""

    def __init__(self, settings: Settings) -> None:
        self.settings = settings
        self._jacobian: Vector | None = None  # of scaled residuals to scaled unknowns
        self._unknown_scale: Vector | None = None

    @property
    def jacobian(self) -> Vector | None:
        """[n, n], of the scaled problem, as the last solve left it; not to be changed in place.

        It may be kept, and set again before a solve near to where it was found. None: the next
        solve finds it by differences.
        """
        return self._jacobian

    @jacobian.setter
    def jacobian(self, value: Vector | None) -> None:
        self._jacobian = value

    def solve(self, function: Function, start: Vector) -> Root:
        """Searches a root from ``start``, [n]. Does not raise for a search that fails."""
        count = _Count()
        best = self._evaluate(function, np.array(start, dtype=float), count)
        if best is None:
            return Root(False, np.array(start, dtype=float), None, count.evaluations, 0, 0)
        while not self._is_root(best):
            if count.evaluations + self._cost() > self.settings.max_evaluations:
                break
            if self._jacobian is None and not self._differences(function, best, count):
                break
            point = self._step(function, best, count)
            if point is not None and point.merit < best.merit:
                best = point
            count.merits.append(best.merit)
            if (point is None or stalled(count.merits)) and not self._restart(count):
                break
        if not self._is_root(best):
            self._jacobian = None
        return Root(
            self._is_root(best),
            best.x,
            best.evaluation.residual,
            count.evaluations,
            count.iterations,
            count.restarts,
            best.evaluation.payload,
        )

    def _is_root(self, point: _Point) -> bool:
        return point.merit <= self.settings.tolerance

    def _cost(self) -> int:
        """Evaluations that the next step needs at least."""
        return 1 if self._jacobian is not None else 1 + len(self.settings.difference)

    def _evaluate(self, function: Function, x: Vector, count: _Count) -> _Point | None:
        """f at x, or None where it has no finite value."""
        if not np.isfinite(x).all():
            return None
        count.evaluations += 1
        evaluation = function(x)
        if evaluation.residual is None or not np.isfinite(evaluation.residual).all():
            return None
        scaled = evaluation.residual / self.settings.residual_scale
        merit = float(np.abs(scaled).max())
        if not evaluation.solved:
            # never a root, and worse than any root
            merit = max(merit, 2 * self.settings.tolerance)
        return _Point(x, scaled, merit, evaluation)

    def _differences(self, function: Function, best: _Point, count: _Count) -> bool:
        """J by one-sided differences, away from where f has no value. Whether that went well."""
        columns = []
        for k, step in enumerate(self.settings.difference):
            for signed in (step, -step):
                moved = best.x.copy()
                moved[k] += signed
                point = self._evaluate(function, moved, count)
                if point is not None:
                    columns.append((point.f - best.f) / signed)
                    break
            else:
                return False
        jacobian = np.column_stack(columns)
        if self._unknown_scale is None:
            norms = np.linalg.norm(jacobian, axis=0)
            self._unknown_scale = 1.0 / np.where(norms > 0, norms, 1.0)
        self._jacobian = jacobian * self._unknown_scale
        count.merits.clear()
        return True

    def _step(self, function: Function, best: _Point, count: _Count) -> _Point | None:
        """One step from the best point, shortened until f has a value, and after a restart until it
        is better; J is corrected by each."""
        assert self._jacobian is not None
        assert self._unknown_scale is not None
        try:
            newton = -np.linalg.solve(self._jacobian, best.f) * self._unknown_scale
        except np.linalg.LinAlgError:
            return None
        if not np.isfinite(newton).all():
            return None
        count.iterations += 1
        step = newton / max(1.0, float(np.max(np.abs(newton) / self.settings.step_limit)))
        for _ in range(MOST_HALVINGS + 1):
            if count.evaluations >= self.settings.max_evaluations:
                return None
            point = self._evaluate(function, best.x + step, count)
            if point is not None:
                self._correct(step / self._unknown_scale, point.f - best.f)
                # across a kink J would swing between both slopes: there the step has to be shorter
                if point.merit < best.merit or count.restarts == 0:
                    return point
            step = 0.5 * step
        return None

    def _correct(self, dx: Vector, df: Vector) -> None:
        """Broyden's update; makes a new array, for the caller may keep the old one."""
        assert self._jacobian is not None
        missed = df - self._jacobian @ dx
        if dx @ dx > 0:
            self._jacobian = self._jacobian + np.outer(missed, dx) / (dx @ dx)

    def _restart(self, count: _Count) -> bool:
        """Asks for a Jacobian by differences; False where the solve has had all of its own."""
        if count.restarts >= self.settings.max_restarts:
            return False
        count.restarts += 1
        self._jacobian = None
        return True


def stalled(merits: list[float]) -> bool:
    """Whether the last evaluations did not halve the best merit."""
    return len(merits) > PATIENCE and merits[-1] > 0.5 * merits[-1 - PATIENCE]
