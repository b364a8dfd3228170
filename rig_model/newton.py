"""Newton's method for few unknowns, each evaluation of which is costly, with exact derivatives.

Solves f(x) = 0 by x <- x - J^-1 f. A step is shortened to the step limit, and halved until it
lowers the largest scaled residual. J is asked for at points from which a step starts only.
"""

from __future__ import annotations

import numpy as np

from rig_model.search import Evaluation, Function, Root, Settings, Vector

# shorter steps towards the best point before the search is given up
MOST_HALVINGS = 4


class Newton:
    """The search; ``difference`` and ``max_restarts`` of the settings are not used."""

    def __init__(self, settings: Settings) -> None:
        self.settings = settings

    def solve(self, function: Function, start: Vector) -> Root:
        """Searches a root from ``start``, [n]. Does not raise for a search that fails."""
        x = np.array(start, dtype=float)
        evaluation = function(x)
        evaluations, iterations = 1, 0
        merit = self._merit(evaluation)
        while merit > self.settings.tolerance:
            step = self._step(evaluation)
            if step is None:
                break
            iterations += 1
            for _ in range(MOST_HALVINGS + 1):
                if evaluations >= self.settings.max_evaluations:
                    return root(False, x, evaluation, evaluations, iterations)
                trial = function(x + step)
                evaluations += 1
                trial_merit = self._merit(trial)
                if trial_merit < merit:
                    x, evaluation, merit = x + step, trial, trial_merit
                    break
                step = 0.5 * step
            else:
                break
        return root(merit <= self.settings.tolerance, x, evaluation, evaluations, iterations)

    def _merit(self, evaluation: Evaluation) -> float:
        """The largest scaled residual; infinite where f has no finite value."""
        if evaluation.residual is None or not np.isfinite(evaluation.residual).all():
            return np.inf
        merit = float(np.abs(evaluation.residual / self.settings.residual_scale).max())
        # never a root, and worse than any root
        return merit if evaluation.solved else max(merit, 2 * self.settings.tolerance)

    def _step(self, evaluation: Evaluation) -> Vector | None:
        """From the point last evaluated; None where there is no way on."""
        if evaluation.residual is None or evaluation.slope is None:
            return None
        slope = evaluation.slope()
        if not np.isfinite(slope).all():
            return None
        try:
            step = -np.linalg.solve(slope, evaluation.residual)
        except np.linalg.LinAlgError:
            return None
        return step / max(1.0, float(np.max(np.abs(step) / self.settings.step_limit)))


def root(
    converged: bool, x: Vector, evaluation: Evaluation, evaluations: int, iterations: int
) -> Root:
    """How the search ended."""
    return Root(converged, x, evaluation.residual, evaluations, iterations, 0, evaluation.payload)
