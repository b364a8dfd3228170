"""The whole study: bounds and balances of masters over speeds."""

from __future__ import annotations

import math
import tempfile
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field, replace
from pathlib import Path

from railpatch.case.common import Grid
from railpatch.errors import CaseError
from railpatch.fmu import pack_fmu
from railpatch.fmu.scene import has_history

from wheelset_demo.coupling.energy import Balance, balance, release
from wheelset_demo.coupling.slave import ContactSlave, CouplingFailure
from wheelset_demo.coupling.stability import (
    LARGEST,
    Bound,
    Rolling,
    bound_by_matrix,
    bound_by_runs,
)
from wheelset_demo.scene import WheelsetScene
from wheelset_demo.system import ContactFailure

ASKED = 1e-3  # s, a step that engineers use


@dataclass(frozen=True)
class Row:
    """A master at a speed: its largest step, balances at half of it and at 1 ms, if stable."""

    bound: Bound
    half: Balance | None
    asked: Balance | None


@dataclass(frozen=True)
class Speed:
    """Closed forms at a speed (m/s), s: explicit steps that hold forces.

    bounce: 2 over the frequency of the bounce on the contacts. creep: 2 over the decay rate of the
    fastest motion by creep forces, 2 V m/f. lag: 4 damping/frequency^2 of the bounce, above which
    held forces drive it. growth: 1/s, of the wheelset itself.
    """

    speed: float
    bounce: float
    creep: float
    lag: float
    growth: float


@dataclass(frozen=True)
class Study:
    """scene: its name. speeds, rows: in the order they were asked for. failures: why there are no
    rows of further masters at a speed (m/s)."""

    scene: str
    speeds: list[Speed]
    rows: list[Row]
    failures: dict[float, str] = field(default_factory=dict)

    def of(self, master: str) -> list[Row | None]:
        """Over speeds; None: failed."""
        found = {row.bound.speed: row for row in self.rows if row.bound.master == master}
        return [found.get(speed.speed) for speed in self.speeds]

    @property
    def masters(self) -> list[str]:
        """Names."""
        return list(dict.fromkeys(row.bound.master for row in self.rows))


def with_elements(scene: WheelsetScene, count: int) -> WheelsetScene:
    """A scene with a grid of count x count elements."""
    case = scene.case.model_copy(update={"grid": Grid(elements=[count, count])})
    return replace(scene, case=case)


@contextmanager
def slave_of(scene: WheelsetScene) -> Iterator[ContactSlave]:
    """The scene's contact in an FMU of its own. Raises CaseError."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "contact.fmu"
        height = scene.at_height(derivatives=True)
        if has_history(height.case):
            raise CaseError(
                f"{scene.name}: its steps depend on earlier ones, allowed a scene of wheels "
                "without history"
            )
        pack_fmu(height, path, name="contact", derivatives="always", averages=True)
        with ContactSlave(path) as slave:
            yield slave


def study(
    scene: WheelsetScene,
    speeds: Sequence[float],
    masters: Sequence[str],
    advance: Callable[[object], None] | None = None,
) -> Study:
    """All of them; what fails at a speed is left out there, and told. advance: called after each
    master at each speed. Raises CaseError, CouplingFailure before
    there is any row."""
    found = Study(scene.name, [], [])
    with slave_of(scene) as slave:
        for speed in speeds:
            try:
                study_speed(found, scene, speed, masters, slave, advance)
            except (CaseError, ContactFailure, CouplingFailure) as failure:
                # a scene that cannot be run at all has no rows to lose
                if isinstance(failure, CaseError) and not found.rows:
                    raise
                found.failures[speed] = str(failure)
    return found


def study_speed(
    found: Study,
    scene: WheelsetScene,
    speed: float,
    masters: Sequence[str],
    slave: ContactSlave,
    advance: Callable[[object], None] | None,
) -> None:
    """Adds the rows of one speed (m/s). Raises CaseError, ContactFailure, CouplingFailure; rows
    that were found before stay."""
    # all that is known of a speed that fails at once
    found.speeds.append(Speed(speed, *[math.nan] * 4))
    rolling = Rolling(scene, speed)
    found.speeds[-1] = closed_forms(rolling)
    moving, start = release(scene, speed)
    for name in masters:
        by_runs, runs = bound_by_runs(rolling, slave, name)
        by_matrix = bound_by_matrix(rolling.system, name)
        bound = Bound(name, speed, by_runs, by_matrix, runs)
        half = balance(moving, start, slave, name, 0.5 * by_runs) if by_runs else None
        milli = balance(moving, start, slave, name, ASKED) if by_runs >= ASKED else None
        found.rows.append(Row(bound, half, milli))
        if advance is not None:
            advance(bound)


def closed_forms(rolling: Rolling) -> Speed:
    """Of the linearised motion."""
    system = rolling.system
    rate, frequency = system.least_damped_bounce
    return Speed(
        rolling.speed,
        min(LARGEST, 2 / system.bounce),
        min(LARGEST, 2 / system.creep),
        min(LARGEST, 4 * rate / frequency**2),
        system.growth,
    )
