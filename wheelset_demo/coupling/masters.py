"""Masters: who exchanges what, and when. One step each is a function of the point before it.

One line a master; w is the wrench of the contact, u its inputs, h the communication step:

    parallel        both sides take the step with what they last heard of the other (Jacobi)
    hold            multibody under the last w, then the FMU with the new u (Gauss-Seidel)
    leapfrog        the same, but velocities first, then positions: one Euler step (held_run)
    linear          multibody under w + t dw/dt by output derivatives, then the FMU, u linear to it
    mean            FMU first, u linear ahead by its rates; multibody under the mean of w
    iterate         multibody under the mean of w for u linear to its own result, by fixed point
    iterate-mixed   the same, by Anderson's mixing of the wrenches tried
    iterate-newton  the same, by quasi-Newton steps from the FMU's directional derivatives
    implicit        one linearly implicit step (ros2) with the FMU's directional derivatives
    exchange        model exchange: Runge-Kutta of order 4 with the contact in every stage

The iterations and implicit roll the FMU back, the others only where it discards a step.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable
from dataclasses import dataclass, field, replace

import numpy as np

from wheelset_demo.coupling.multibody import MOTION, Multibody, power_by_motion
from wheelset_demo.coupling.slave import ContactSlave, CouplingFailure, Discarded, Outputs
from wheelset_demo.steppers import ARM, GAMMA
from wheelset_demo.system import COUNT, Vector

DIVERGED = 1e4  # times the least change of an iteration: it goes away
DEPTH = 8  # wrenches that are mixed: one more than there are components, and the last
NUDGE = 1e-3  # of a wrench, in parts of its size: the multibody side is linear in it
Correction = Callable[[Vector, Vector], Vector]


@dataclass(frozen=True)
class Point:
    """A communication point.

    time: s. motion: [12]. heard: outputs of the FMU for it. slope: [12], of the inputs, or [6], of
    the wrench, whichever a master keeps. given, taken: J, work of the contact on the wheelset by
    the FMU's side and by the multibody side. friction: J, turned into heat.
    """

    time: float
    motion: Vector
    heard: Outputs
    slope: Vector = field(default_factory=lambda: np.zeros(0))
    given: float = 0.0
    taken: float = 0.0
    friction: float = 0.0

    def next(
        self, step: float, motion: Vector, heard: Outputs, work: float, **more: Vector
    ) -> Point:
        """A step later; the FMU's side integrates its power output by the trapezoidal rule."""
        half = 0.5 * step
        return replace(
            self,
            time=self.time + step,
            motion=motion,
            heard=heard,
            given=self.given + half * (self.heard.power + heard.power),
            taken=self.taken + work,
            friction=self.friction + half * (self.heard.friction + heard.friction),
            **more,
        )


class Master(ABC):
    """Base of all. halvings: how often a step that the FMU discards is cut in half."""

    name = ""
    substeps = 1

    def __init__(self, side: Multibody, slave: ContactSlave, halvings: int = 0) -> None:
        self.side, self.slave, self.halvings = side, slave, halvings

    def begin(self, time: float, motion: Vector) -> Point:
        """The first point. Raises CouplingFailure where the contact cannot be solved there."""
        self.slave.substeps = self.substeps
        self.slave.begin(time, motion)
        return self.first(Point(time, motion, self.slave.outputs()))

    def first(self, point: Point) -> Point:
        """With what the master keeps."""
        return point

    def step(self, point: Point, step: float) -> Point:
        """A communication step (s), in parts where the FMU discards it.

        Raises CouplingFailure where halving does not help.
        """
        return self._cut(point, step, self.halvings)

    def _cut(self, point: Point, step: float, halvings: int) -> Point:
        saved = self.slave.save() if halvings else None
        try:
            return self.advance(point, step)
        except Discarded as reason:
            if saved is None:
                raise CouplingFailure(
                    f"step of {step:.4g} s at {point.time:.6g} s, halved {self.halvings} times, "
                    f"cannot be done: {reason}"
                ) from None
            self.slave.restore(saved)
        finally:
            if saved is not None:
                self.slave.release(saved)
        for _ in range(2):
            point = self._cut(point, 0.5 * step, halvings - 1)
        return point

    @abstractmethod
    def advance(self, point: Point, step: float) -> Point:
        """One step, in one. Raises Discarded, CouplingFailure."""


class Parallel(Master):
    """Zero-order hold on both sides: outputs come a step late."""

    name = "parallel"

    def advance(self, point: Point, step: float) -> Point:
        """See Master."""
        heard = self.slave.step(point.time, step, point.motion)
        motion, work = self.side.advance(point.time, point.motion, step, point.heard.wrench)
        return point.next(step, motion, heard, work)


class Hold(Master):
    """Zero-order hold, multibody side first."""

    name = "hold"

    def move(self, point: Point, step: float) -> tuple[Vector, float]:
        """Motion a step later, and the contact's work."""
        return self.side.advance(point.time, point.motion, step, point.heard.wrench)

    def advance(self, point: Point, step: float) -> Point:
        """See Master."""
        motion, work = self.move(point, step)
        return point.next(step, motion, self.slave.step(point.time, step, motion), work)


class Leapfrog(Hold):
    """Zero-order hold, velocities first."""

    name = "leapfrog"

    def move(self, point: Point, step: float) -> tuple[Vector, float]:
        """See Hold."""
        return self.side.kick(point.time, point.motion, step, point.heard.wrench)


class Linear(Master):
    """First order on both sides, multibody side first. slope: [6], of the wrench."""

    name = "linear"

    def first(self, point: Point) -> Point:
        """Forces held in the first step."""
        return replace(point, slope=np.zeros(6))

    def advance(self, point: Point, step: float) -> Point:
        """See Master."""
        start = point.motion
        motion, work = self.side.advance(point.time, start, step, point.heard.wrench, point.slope)
        heard = self.slave.step(point.time, step, start, (motion - start) / step)
        return point.next(step, motion, heard, work, slope=self.slave.wrench_rate())


class Mean(Master):
    """First order ahead of the FMU, which goes first, mean forces back. slope: [12], of inputs."""

    name = "mean"
    substeps = 4

    def first(self, point: Point) -> Point:
        """No acceleration is known before the first step."""
        return replace(point, slope=np.append(point.motion[COUNT:], np.zeros(COUNT)))

    def advance(self, point: Point, step: float) -> Point:
        """See Master."""
        heard = self.slave.step(point.time, step, point.motion, point.slope)
        wrench = self.slave.mean_wrench()
        motion, work = self.side.advance(point.time, point.motion, step, wrench)
        v = motion[COUNT:]
        slope = np.append(v, (v - point.motion[COUNT:]) / step)
        return point.next(step, motion, heard, work, slope=slope)


class Iterate(Master):
    """The mean wrench that agrees with the motion it makes, by fixed point with rollback.

    tolerance: of the wrench, in parts of the contact's load. most: iterations.
    """

    name = "iterate"

    def __init__(
        self,
        side: Multibody,
        slave: ContactSlave,
        halvings: int = 0,
        *,
        tolerance: float = 1e-7,
        most: int = 40,
    ) -> None:
        super().__init__(side, slave, halvings)
        self.tolerance, self.most = tolerance, most
        self.iterations = 0

    def begin(self, time: float, motion: Vector) -> Point:
        """See Master."""
        point = super().begin(time, motion)
        load = float(np.abs(point.heard.wrench[:3]).max())
        self._size = load * np.array([1.0, 1.0, 1.0, ARM, ARM, ARM])
        return point

    def advance(self, point: Point, step: float) -> Point:
        """See Master."""
        saved = self.slave.save()
        try:
            return self._agree(point, step, saved)
        finally:
            self.slave.release(saved)

    def _agree(self, point: Point, step: float, saved: object) -> Point:
        wrench, least = point.heard.wrench, np.inf
        correction = self.correction(point, step)
        for count in range(self.most):
            motion, work = self.side.advance(point.time, point.motion, step, wrench)
            if count:
                self.slave.restore(saved)
            slope = (motion - point.motion) / step
            heard = self.slave.step(point.time, step, point.motion, slope)
            self.iterations += 1
            change = (self.slave.mean_wrench() - wrench) / self._size
            size = float(np.abs(change).max())
            if size <= self.tolerance:
                return point.next(step, motion, heard, work)
            if size > DIVERGED * least:
                break
            least = min(least, size)
            wrench = self._size * correction(wrench / self._size, change)
        raise Discarded(
            f"the iteration does not converge, {count + 1} times, wrenches still change by "
            f"{size:.1e} of the load: take a smaller step or a master with derivatives"
        )

    def correction(self, point: Point, step: float) -> Correction:
        """What makes the next wrench of one and what it is off: the one that was found."""
        return lambda value, change: value + change


class Mixing:
    """Of all wrenches tried in this step, the combination whose changes cancel best.

    Anderson (J. ACM 12 (1965) 547-560), in the form of differences: with DX of the values and DF
    of the changes, x + f - (DX + DF) g, where g minimises |f - DF g|.
    """

    def __init__(self) -> None:
        self._values: list[Vector] = []
        self._changes: list[Vector] = []

    def __call__(self, value: Vector, change: Vector) -> Vector:
        """The next value."""
        self._values.append(value)
        self._changes.append(change)
        if len(self._values) == 1:
            return value + change
        moved = np.diff(self._values[-DEPTH:], axis=0).T
        turned = np.diff(self._changes[-DEPTH:], axis=0).T
        parts = np.linalg.lstsq(turned, change, rcond=1e-10)[0]
        return value + change - (moved + turned) @ parts


class IterateMixed(Iterate):
    """The same, mixed."""

    name = "iterate-mixed"

    def correction(self, point: Point, step: float) -> Correction:
        """See Iterate."""
        return Mixing()


class Broyden:
    """A quasi-Newton method: its matrix fits the last change of the residual, too.

    Broyden (Math. Comp. 19 (1965) 577-593), in the form for the inverse, B: with the last move s
    and what it took off the residual, y, B += (s - B y) (s B) / (s B y).
    """

    def __init__(self, inverse: Vector) -> None:
        self._inverse = inverse
        self._last: tuple[Vector, Vector] | None = None

    def __call__(self, value: Vector, change: Vector) -> Vector:
        """The next value."""
        if self._last is not None:
            before, moved = self._last
            mapped = self._inverse @ (before - change)
            weight = float(moved @ mapped)
            if weight != 0:
                turned = np.outer(moved - mapped, moved @ self._inverse) / weight
                self._inverse = self._inverse + turned
        move = self._inverse @ change
        self._last = change, move
        return value + move


class IterateNewton(Iterate):
    """The same by a quasi-Newton method that begins with derivatives of the step's start."""

    name = "iterate-newton"

    def correction(self, point: Point, step: float) -> Correction:
        """See Iterate."""
        by_motion = self.slave.wrench_by_motion()
        found = point.heard.wrench
        end, _ = self.side.advance(point.time, point.motion, step, found)
        units = np.diag(self._size) * NUDGE
        ends = [self.side.advance(point.time, point.motion, step, found + u)[0] for u in units]
        # the mean over a straight line from the start changes by half of what its end does
        mean = 0.5 * by_motion @ (np.array(ends) - end).T / NUDGE / self._size[:, None]
        return Broyden(np.linalg.inv(np.eye(len(mean)) - mean))


class Implicit(Master):
    """The multibody side takes a linearly implicit step of order 2, see wheelset_demo.steppers.

    The contact's part of its matrix are the FMU's directional derivatives, every n steps; the
    second stage asks the FMU at a motion that is then rolled back.
    """

    name = "implicit"

    def __init__(
        self, side: Multibody, slave: ContactSlave, halvings: int = 0, *, every: int = 10
    ) -> None:
        super().__init__(side, slave, halvings)
        self.every = every

    def begin(self, time: float, motion: Vector) -> Point:
        """See Master."""
        self._age, self._step = 0, 0.0
        return super().begin(time, motion)

    def advance(self, point: Point, step: float) -> Point:
        """See Master."""
        if step != self._step or self._age >= self.every:
            self._renew(point, step)
        self._age += 1
        rates = self.side.rates(point.time, point.motion, point.heard.wrench)
        first = self._inverse @ np.append(rates, 1.0)
        ahead = point.motion + step * first[:MOTION]
        saved = self.slave.save()
        try:
            heard = self.slave.step(point.time, step, ahead)
            self.slave.restore(saved)
        finally:
            self.slave.release(saved)
        rates = self.side.rates(point.time + step, ahead, heard.wrench)
        second = self._inverse @ (np.append(rates, 1.0) - 2 * first)
        change = step * (1.5 * first + 0.5 * second)
        motion = point.motion + change[:MOTION]
        heard = self.slave.step(point.time, step, motion)
        return point.next(step, motion, heard, float(change[MOTION]))

    def _renew(self, point: Point, step: float) -> None:
        """Of motion, work and time."""
        wrench, by_motion = point.heard.wrench, self.slave.wrench_by_motion()
        matrix = np.zeros((MOTION + 2, MOTION + 2))
        by_held, by_wrench, by_time = self.side.derivatives(point.time, point.motion, wrench)
        matrix[:MOTION, :MOTION] = by_held + by_wrench @ by_motion
        matrix[MOTION, :MOTION] = power_by_motion(point.motion, wrench, by_motion)
        matrix[:MOTION, MOTION + 1] = by_time
        self._inverse = np.linalg.inv(np.eye(MOTION + 2) - GAMMA * step * matrix)
        self._age, self._step = 0, step


class Exchange(Master):
    """No co-simulation: the FMU is evaluated in each stage of an explicit step of order 4."""

    name = "exchange"

    def begin(self, time: float, motion: Vector) -> Point:
        """See Master."""
        self.slave.begin_exchange(time, motion)
        return super().begin(time, motion)

    def advance(self, point: Point, step: float) -> Point:
        """See Master."""

        def rates(past: float, motion: Vector) -> Vector:
            wrench = self.slave.evaluate(point.time + past, motion).wrench
            return self.side.rates(point.time + past, motion, wrench)

        half, start = 0.5 * step, point.motion
        a = self.side.rates(point.time, start, point.heard.wrench)
        b = rates(half, start + half * a[:MOTION])
        c = rates(half, start + half * b[:MOTION])
        d = rates(step, start + step * c[:MOTION])
        change = step / 6 * (a + 2 * b + 2 * c + d)
        motion = start + change[:MOTION]
        heard = self.slave.evaluate(point.time + step, motion)
        return point.next(step, motion, heard, float(change[MOTION]))


MASTERS: dict[str, type[Master]] = {
    kind.name: kind
    for kind in (
        Parallel,
        Hold,
        Leapfrog,
        Linear,
        Mean,
        Iterate,
        IterateMixed,
        IterateNewton,
        Implicit,
        Exchange,
    )
}
