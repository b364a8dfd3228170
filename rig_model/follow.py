"""A run of the rig followed through changes of its scene: what is measured, and its derivatives.

Each position's balance starts where it was before the change, with its Jacobian, moved along the
derivatives of the balance where these are known; derivatives are those of rig_model/partial.py. A
frame's sliders go on with the changed run, so that what a position owes to those before it is in
its derivative. What else a run remembers (bodies that store heat, friction that conditions), and a
gauge that opens, is differenced by whole runs.

One input may be unknown in each row (``Rows``): it then is where the row's measured numbers are met
best, and derivatives are those along it (variable projection, Golub and Pereyra 1973, in the form
of Kaufman 1975: the row's own part of each derivative is taken out).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from railpatch.case.fluid import changes_with_time
from railpatch.case.types import SIDES
from railpatch.errors import CaseError
from railpatch.record.quantities import BY_NAME, OUTPUT
from railpatch.report.beside import with_ratios

from rig_model.balance import Balance, Balancer, lateral_forces
from rig_model.partial import Partial, computed, way_of
from rig_model.predict import Prediction
from rig_model.programme import Position
from rig_model.rows import RowProblem, Rows
from rig_model.scene import RigScene, rig_scene_of
from rig_model.search import Vector

Array = NDArray[np.float64]
Content = dict[str, Any]

# of parameters (parts of their ranges), up to which a balance starts along its derivatives
NEAR = 0.1


class Follower:
    """A run, replayed for one content of its scene after another.

    names: of what is measured. yaw: rad, progress: -, time: s, [m], of the positions. measured:
    [names, m], SI units, NaN in gaps. exact: whether the contact has exact derivatives. rows: what
    is unknown in each row, None without.
    """

    def __init__(
        self, content: Content, folder: Path, names: Sequence[str], rows: Rows | None = None
    ) -> None:
        """Raises CaseError, ProfileError."""
        self._folder, self.names, self.rows = folder, tuple(names), rows
        scene = self._scene(content)
        if rows is not None:
            rows.check(scene)
        positions = scene.positions()
        self.yaw = np.array([p.yaw for p in positions])
        self.progress = np.array([p.progress for p in positions])
        self.time = np.array([p.time for p in positions])
        self.measured = measured_of(scene, self.names)
        reach = rows.ends("lateral_position") if rows is not None else ()
        by_runs = remembers(scene)
        self._balancer = Balancer(scene, derivatives=not by_runs, reach=reach)
        self.exact = not by_runs and self._has_exact(positions[0])
        conditions = scene.rig.conditioning is not None
        self._size = len(self._balancer.unknowns) + len(SIDES) * conditions
        self._known: list[Prediction | None] = [None] * len(positions)
        # parameters of what is known; [m, p, n], of unknowns and factors of friction by them
        self._place: Array | None = None
        self._moves: Array | None = None
        self._last: tuple[Content, RigScene, list[Balance]] | None = None
        self.forget()

    def computed(self, content: Content, place: Array | None = None) -> Array:
        """[names, m], SI units, NaN where a position is not balanced. place: [p], parameters of the
        content, by which a balance near the last slopes starts closer. Raises CaseError."""
        _, balances = self._replayed(content, place)
        return self._table(balances)

    def slopes(
        self,
        content: Content,
        changed: Sequence[Content],
        steps: Sequence[float],
        place: Array | None = None,
    ) -> Array:
        """[names, m, p]: derivatives by parameters, each of which is a step on in one of the
        changed contents. NaN where a position is not balanced. place: as of computed. Raises
        CaseError."""
        scene, balances = self._replayed(content, place)
        if remembers(scene):
            return self._by_runs(balances, changed, steps, place)
        ways = [
            way_of(scene, self._scene(other), step, exact=self.exact)
            for other, step in zip(changed, steps, strict=True)
        ]
        partial = self._partial(scene)
        found = np.full((len(self.names), len(balances), len(ways)), np.nan)
        moves = np.full((len(balances), len(ways), len(self._balancer.unknowns)), np.nan)
        for i, balance in enumerate(balances):
            if not balance.converged:
                continue
            partial.go_to(balance.position, self._unknowns(balance))
            pairs = [partial.total(partial.by_way(way)) for way in ways]
            slopes = np.column_stack([pair[0] for pair in pairs])
            if self.rows is not None:
                slopes = self.rows.projected(i, slopes)
            found[:, i, :] = slopes
            moves[i] = [pair[1] for pair in pairs]
            if partial.frame is None:
                continue
            forces = lateral_forces(balance.result)
            partial.frame.moved(balance.position.y, balance.y, 0.0, forces)
            for way, (_, dx) in zip(ways, pairs, strict=True):
                if way.frame is not None:
                    y = balance.y + way.step * float(np.nan_to_num(dx[3]))
                    way.frame.moved(way.positions[i].y, y, 0.0, forces)
        self._moves = moves
        return found

    def weigh(self, error: Array) -> None:
        """[names], SI units: errors by which rows find what is their own."""
        if self.rows is not None and not np.array_equal(self.rows.errors, error):
            self.rows.errors = np.array(error)
            self._last = None

    def row_values(self, covariance: Array) -> tuple[Array, Array, Array, Array]:
        """Of the last slopes: values of the rows, both ends of 95 %, whether other places meet the
        row as well, [m] each. covariance: [p, p], of the parameters."""
        assert self.rows is not None
        found = [self.rows.told(i, covariance) for i in range(len(self.rows.fits))]
        value, low, high, several = (np.array(column) for column in zip(*found, strict=True))
        return value, low, high, several

    def forget(self) -> None:
        """The next replay solves again, and looks at rows' whole ranges if there are rows."""
        self._last = None
        if self.rows is not None:
            self.rows.forget(len(self.progress))

    # --- what is kept ----------------------------------------------------------------------------

    def _scene(self, content: Content) -> RigScene:
        """As exact as the contact's forces are, so that small changes are seen."""
        scene = rig_scene_of(content, self._folder, {"balance.method": "broyden"})
        tolerance = min(scene.rig.balance.tolerance, 2 * scene.case.method.tolerance)
        balance = scene.rig.balance.model_copy(update={"tolerance": tolerance})
        return replace(scene, rig=scene.rig.model_copy(update={"balance": balance}))

    def _partial(self, scene: RigScene) -> Partial:
        return Partial(
            scene,
            self._balancer.contact,
            self._balancer.settings.difference,
            self.names,
            exact=self.exact,
            held=self.rows.field if self.rows is not None else None,
        )

    def _has_exact(self, position: Position) -> bool:
        """Whether the contact has exact derivatives."""
        self._balancer.solve(position)
        return bool(self._balancer.contact.differentiate(z=1.0)["kind"] == "exact")

    def _replayed(
        self, content: Content, place: Array | None = None
    ) -> tuple[RigScene, list[Balance]]:
        """All positions, started from those of the last content."""
        if self._last is not None and self._last[0] == content:
            return self._last[1:]
        scene, balances, known = self._run(content, place)
        for i, found in enumerate(known):
            self._known[i] = found or self._known[i]
        if self._place is None or place is None or not all(known):
            self._moves = None
        self._place = place
        self._last = (content, scene, balances)
        return scene, balances

    def _run(
        self, content: Content, place: Array | None
    ) -> tuple[RigScene, list[Balance], list[Prediction | None]]:
        """Each position's balance, and what is known then; None where it is not balanced."""
        scene = self._scene(content)
        self._balancer = self._balancer.changed(scene)
        ahead = self._ahead(place)
        balances, known = [], []
        for position in scene.positions():
            start = self._known[position.index]
            if start is not None and ahead is not None:
                start = beyond(start, ahead[position.index])
            balance, found = self._balanced(scene, position, start)
            balances.append(balance)
            known.append(found)
        return scene, balances, known

    def _ahead(self, place: Array | None) -> Array | None:
        """[m, n], how far unknowns are from where they are known, if that is near."""
        if self.rows is not None or self._moves is None or self._place is None or place is None:
            return None
        step = place - self._place
        return np.nan_to_num(step @ self._moves) if np.abs(step).max() <= NEAR else None

    def _solved(self, position: Position, known: Prediction | None) -> tuple[Balance, Prediction]:
        if self.rows is None:
            balance = self._balancer.solve(position, known)
        else:
            balance = self._balancer.alone(position, known)
        states = balance.conditioning
        factors = {side: state.factor for side, state in states.items()} if states else None
        return balance, Prediction(self._unknowns(balance), self._balancer.jacobian, factors)

    def _unknowns(self, balance: Balance) -> Vector:
        return np.array([getattr(balance, name) for name in self._balancer.unknowns])

    def _balanced(
        self, scene: RigScene, position: Position, start: Prediction | None
    ) -> tuple[Balance, Prediction | None]:
        i = position.index
        if self.rows is None:
            balance, known = self._solved(position, start)
            return balance, known if balance.converged else None
        partial = self._partial(scene)

        def slope(balance: Balance) -> Array:
            partial.go_to(balance.position, self._unknowns(balance))
            return partial.total(partial.by_row(self.rows.field))[0]

        problem = RowProblem(
            self._solved,
            self._balancer.beside,
            self._observed,
            slope,
        )
        return self.rows.fit(i, position, self.measured[:, i], problem).best.balance, None

    def _table(self, balances: Sequence[Balance]) -> Array:
        return np.array([self._observed(balance) for balance in balances]).T

    def _observed(self, balance: Balance) -> Array:
        """[names], NaN where a position is not balanced."""
        if not balance.converged:
            return np.full(len(self.names), np.nan)
        x = np.array([balance.z, balance.roll, balance.pitch_rate])
        return np.array([computed(balance.result, x, name) for name in self.names])

    def _by_runs(
        self,
        balances: Sequence[Balance],
        changed: Sequence[Content],
        steps: Sequence[float],
        place: Array | None,
    ) -> Array:
        here, found, moves = self._table(balances), [], []
        before = [self._all_of(known) for known in self._known]
        for k, (other, step) in enumerate(zip(changed, steps, strict=True)):
            moved = None if place is None else place + step * (np.arange(len(steps)) == k)
            _, there, known = self._run(other, moved)
            found.append((self._table(there) - here) / step)
            moves.append([(self._all_of(b) - a) / step for a, b in zip(before, known, strict=True)])
        self._moves = np.stack(moves, axis=1)
        return np.stack(found, axis=-1)

    def _all_of(self, known: Prediction | None) -> Array:
        """Unknowns and factors of friction, NaN where they are not known."""
        if known is None:
            return np.full(self._size, np.nan)
        return np.append(known.unknowns, list((known.factors or {}).values()))


def beyond(known: Prediction, step: Array) -> Prediction:
    """What is known, a step on in its unknowns and factors of friction."""
    size, names = len(known.unknowns), list(known.factors or {})
    factors = (
        {
            name: max(known.factors[name] + float(step[size + k]), 0.0)
            for k, name in enumerate(names)
        }
        if known.factors
        else None
    )
    return replace(known, unknowns=known.unknowns + step[:size], factors=factors)


def remembers(scene: RigScene) -> bool:
    """Whether a position depends on those before it by more than a frame's sliders, or has unknowns
    whose derivatives rig_model/partial.py has not: a gauge that opens."""
    frame = scene.rig.frame
    if changes_with_time(scene.case):
        return True
    opens = frame is not None and frame.gauge_stiffness is not None
    return opens or scene.rig.conditioning is not None


def measured_of(scene: RigScene, names: Sequence[str]) -> Array:
    """[names, m], SI units, NaN in gaps; L/V of sides whose forces were measured too. Raises
    CaseError."""
    assert scene.measured is not None
    signals = {n: v for n, v in scene.measured.signals.items() if BY_NAME[n].role == OUTPUT}
    known = with_ratios(signals)
    for name in names:
        if name not in known:
            raise CaseError(
                f"match.observed: value is {name!r}, allowed what the record has by [rig.columns]: "
                f"{', '.join(known)}"
            )
    return np.array([known[name] for name in names])
