"""A vehicle at rest: what its elements carry, and whether they hold its bodies.

With B [rows, nv] the displacements of the elements' rows by the coordinates and k their stiffness,
bodies on wheelsets that are held still sink by u under their weights g,

    (B^T k B) u = g,    preload = k B u,

as springs that were free of force before the vehicle was put on them have it. Where the scene has
the bodies is where they are then; what the wheelsets hold up is the load on the rails.

All rails do is to hold wheelsets in z and roll: the elements have to hold everything else together.
With the body of reference held in x, y and yaw no motion must be left that costs no force.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from railpatch.errors import CaseError

from wheelset_demo.scene import GRAVITY
from wheelset_demo.vehicle.model import ABSENT, VehicleModel

Vector = NDArray[np.float64]
# (rad/s)^2: what is slower than this is not held
LEAST = 1e-6
# -, of the weight: what may be left of forces that springs without sliders cannot balance
LEFT = 1e-6
# of a carrier's coordinates, those that rails hold; of a free body, those that track hunting leaves
HELD_BY_RAILS, FREE_ON_TRACK = (2, 4), (0, 1, 3)


class Statics:
    """preload: N, N m, [rows]. loads: N, [wheelsets], on the rails. moments: N m, [wheelsets], of
    it about x: of loads that left and right do not share equally."""

    def __init__(
        self, model: VehicleModel, matrix: Vector, stiffness: Vector, with_sliders: Vector
    ) -> None:
        """matrix: B. stiffness, with_sliders: N/m, N m/rad, [rows]. Raises CaseError."""
        self._model, self._matrix, self._stiffness = model, matrix, stiffness
        width = model.model.nv
        masses, self._diagonal = np.zeros(width), np.zeros(width)
        for name, columns in self._coordinates():
            inertia = model.model.inertias[model.joints[name]]
            mass, turning = inertia.mass, np.diag(inertia.inertia)
            parts = [mass, mass, mass, turning[2], turning[0], turning[1]]
            for column, part, weight in zip(columns, parts, [0, 0, mass, 0, 0, 0], strict=True):
                if column != ABSENT:
                    self._diagonal[column] += part
                    masses[column] += weight
        self._weights = GRAVITY * masses
        self._refuse_loose(with_sliders)
        moving = np.setdiff1d(np.arange(width), [*model.carriers.ravel(), *model.spins])
        self._moving, self._down = moving, self._stiff(stiffness)
        inner = self._down[np.ix_(moving, moving)]
        self._inner = np.linalg.pinv(inner, rcond=1e-12, hermitian=True)
        sunk = self._inner @ self._weights[moving]
        self._refuse_dropped(inner @ sunk)
        u = np.zeros(width)
        u[moving] = sunk
        self.preload = stiffness * (matrix @ u)
        # of directions that carry nothing but for rounding
        self.preload[np.abs(self.preload) < 1e-9 * np.abs(self.preload).max(initial=0.0)] = 0.0
        carried = matrix.T @ self.preload
        vertical, roll = (model.carriers[:, k] for k in HELD_BY_RAILS)
        self.loads = self._weights[vertical] - carried[vertical]
        self.moments = -carried[roll]
        for k in np.flatnonzero(self.loads <= 0).tolist():
            raise CaseError(
                f"vehicle.wheelset: wheelset_{k + 1} carries {self.loads[k]:.6g} N, allowed > 0"
            )

    def sunk(self, down: Vector) -> Vector:
        """m, rad, [nv], of bodies as wheelsets are moved down (m, [wheelsets]), at equal forces."""
        found = np.zeros(len(self._diagonal))
        found[self._model.carriers[:, HELD_BY_RAILS[0]]] = down
        moving = self._moving
        found[moving] = -self._inner @ (self._down @ found)[moving]
        return found

    def _coordinates(self) -> list[tuple[str, list[int]]]:
        """Names and columns of all bodies, wheelsets by their carriers'."""
        return list(zip(self._model.bodies, self._model.columns.tolist(), strict=True))

    def _stiff(self, stiffness: Vector) -> Vector:
        found: Vector = self._matrix.T @ (stiffness[:, None] * self._matrix)
        return found

    def _refuse_loose(self, stiffness: Vector) -> None:
        """Raises CaseError for a body that nothing holds in some direction."""
        model = self._model
        held = [*model.carriers[:, HELD_BY_RAILS].ravel(), *model.spins]
        held += model.columns[0, FREE_ON_TRACK].tolist()
        moving = np.setdiff1d(np.arange(model.model.nv), held)
        root = np.sqrt(self._diagonal[moving])
        scaled = self._stiff(stiffness)[np.ix_(moving, moving)] / np.outer(root, root)
        values, vectors = np.linalg.eigh(scaled)
        if values[0] < LEAST:
            column = int(moving[np.argmax(np.abs(vectors[:, 0]))])
            raise CaseError(
                f"vehicle.element: nothing holds {model.spell(column)}, allowed elements with a "
                "stiffness there"
            )

    def _refuse_dropped(self, carried: Vector) -> None:
        """Raises CaseError where springs alone do not carry the weight."""
        missing = np.abs(carried - self._weights[self._moving])
        if missing.max(initial=0.0) > LEFT * self._weights.max():
            column = int(self._moving[np.argmax(missing)])
            raise CaseError(
                f"vehicle.element: no spring carries {self._model.spell(column)}, allowed elements "
                "with a vertical stiffness; sliders carry nothing at rest"
            )
