"""What a run leaves in memory: the logged steps as arrays."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray
from railpatch import Result
from railpatch.case.types import SIDES
from railpatch.damage.run import RunWear
from railpatch.result import Warned

from wheelset_demo.scene import WheelsetScene
from wheelset_demo.system import WORKS, ContactFailure, State, System

# J, in the order of a row of `energies`
STORES = ("kinetic", "gravity", "suspension", "elastic")


@dataclass
class Trace:
    """The n logged steps of a run.

    times: [n], s. motions: [n][12]. works: [n][4], J, by WORKS, since the start. energies: [n][4],
    J, by STORES. impulses, momenta: [n][6], N s, N m s, by IMPULSES, since the start and of all
    bodies. radii: [n][2], m, rolling radii left and right. contacts: [n][2], m, lateral
    positions of the contacts, weighted with their load; NaN for a wheel in the air. statuses: [n],
    by side. warned: of all steps. result: of the last one. failure: what ended the run before its
    end. evaluations, solve_seconds: contact work of the whole run. wear: over the profiles, of
    a case with [damage].
    """

    scene: WheelsetScene
    times: list[float] = field(default_factory=list)
    motions: list[NDArray[np.float64]] = field(default_factory=list)
    works: list[NDArray[np.float64]] = field(default_factory=list)
    energies: list[list[float]] = field(default_factory=list)
    impulses: list[NDArray[np.float64]] = field(default_factory=list)
    momenta: list[NDArray[np.float64]] = field(default_factory=list)
    radii: list[list[float]] = field(default_factory=list)
    contacts: list[list[float]] = field(default_factory=list)
    statuses: list[dict[str, str]] = field(default_factory=list)
    warned: Warned = field(default_factory=Warned)
    result: Result | None = None
    failure: ContactFailure | None = None
    evaluations: int = 0
    solve_seconds: float = 0.0
    wear: RunWear | None = None

    def add(self, system: System, state: State) -> None:
        """A step whose rates were the last ones asked of the system."""
        snapshot = self.snapshot_due()
        result = system.element.result(fields=snapshot)
        stored = system.energies(state)
        self.times.append(state.time)
        self.motions.append(state.motion)
        self.works.append(state.work)
        self.energies.append([getattr(stored, name) for name in STORES])
        self.impulses.append(state.impulse)
        self.momenta.append(system.momentum(state))
        self.radii.append([result[side]["rolling_radius"] for side in SIDES])
        self.contacts.append([lateral(result[side]["patches"]) for side in SIDES])
        self.statuses.append({side: result[side]["status"] for side in SIDES})
        self.warned.add(f"{state.time:.4g} s", result.warnings)
        self.result = result

    def snapshot_due(self) -> bool:
        """Whether the fields of the next step belong into the log."""
        every = self.scene.snapshot_every
        return every > 0 and len(self.times) % every == 0

    def finish(self, system: System) -> None:
        """Notes the work of the run."""
        self.evaluations = system.evaluations
        self.solve_seconds = system.element.solve_seconds

    def coordinate(self, index: int) -> NDArray[np.float64]:
        """[n], one of the motion's components."""
        return np.array([motion[index] for motion in self.motions])

    def work(self, name: str) -> NDArray[np.float64]:
        """[n], J, by the names of WORKS."""
        return np.array([work[WORKS.index(name)] for work in self.works])

    def change(self, name: str) -> NDArray[np.float64]:
        """[n], J, since the start, by the names of STORES."""
        values = np.array([row[STORES.index(name)] for row in self.energies])
        return values - values[0]

    def mechanical_residual(self) -> NDArray[np.float64]:
        """[n], J, what is missing in the balance of bodies and springs."""
        stored = sum(self.change(name) for name in STORES[:3])
        return stored - self.work("contact") - self.work("drive") + self.work("damping")

    def contact_residual(self) -> NDArray[np.float64]:
        """[n], J, what is missing in the balance of the contacts."""
        return self.work("contact") + self.work("friction") + self.change("elastic")

    def balance_residual(self) -> NDArray[np.float64]:
        """[n], J, what is missing in the balance of all."""
        return self.mechanical_residual() + self.contact_residual()

    def momentum_residual(self) -> NDArray[np.float64]:
        """[n, 6], N s, N m s, by IMPULSES: what is missing in the balance of momenta."""
        return np.array(self.momenta) - self.momenta[0] - np.array(self.impulses)

    def momentum_errors(self) -> tuple[float, float]:
        """Greatest parts missing of momentum and of moment of momentum, by those at the start."""
        missing = np.abs(self.momentum_residual()).max(axis=0)
        scale = np.abs(self.momenta[0])
        return float(missing[:3].max() / scale[:3].max()), float(
            missing[3:].max() / scale[3:].max()
        )


def lateral(patches: list[dict]) -> float:
    """m, lateral position of a wheel's contact; NaN without one."""
    loads = [patch["normal_force"] for patch in patches]
    if not sum(loads) > 0:
        return float("nan")
    return float(np.average([patch["position"][1] for patch in patches], weights=loads))
