"""The rig's frame: what lies between the lateral actuators and the wheelset.

Actuators and arms bend when the rollers push the wheelset aside (report DOT/FRA/ORD-24/18, section
6.3.1). The wheelset's lateral position y then is not where its actuators are, and follows from

    F_y = R(d),   d = y - y_actuators

with F_y the lateral force of both contacts and R the force that resists the deflection d. It has no
inertia: the run is slow. R is that of a spring, linear or through the rows of a table, and of
parallel elements of a spring and a dry slider in series (Jenkins 1962; Iwan 1966, J. Appl. Mech.
33), each with stiffness k and limit h:

    t = k (d - s), where |t| <= h;   else t = h sign(d - s) and s = d - t/k

s is how far the slider has gone. It moves on from one position of the run to the next, which is
passed monotonically, as in plasticity of one dimension with the trial stress and its return. The
slider makes h |ds| of heat. At the start s = 0.

The rollers stand on the frame too. What spreads them is the mean of the forces by which the wheels
push them outwards; a spring of the stiffness k lets the gauge open by g, each roller by half of it:

    (F_y,left - F_y,right) / 2 = k g

with the forces on the wheels, as the virtual work of a change of g says. Without either spring that
part is rigid.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from rig_model.search import Vector
from rig_model.tables import FrameTable


@dataclass(frozen=True)
class Resistance:
    """At one deflection. force: N. stiffness: N/m, its derivative. slips: m, [elements]."""

    force: float
    stiffness: float
    slips: Vector


@dataclass(frozen=True)
class FrameState:
    """After one position.

    actuator: m, lateral position of the actuators. deflection: m, of the wheelset from there.
    force: N, lateral, of the frame on the wheelset. residual: N, of the lateral balance. energy: J,
    stored in springs. heat: J, of dry friction since the start. actuator_work, contact_work: J,
    put in by actuators and contact forces since the first position, by trapezoids between
    positions. sliding: number of elements that slid on the way here. gauge_opening: m. gauge_force:
    N, that spreads the rollers. gauge_residual: N, of its balance.
    """

    actuator: float
    deflection: float
    force: float
    residual: float
    energy: float
    heat: float
    actuator_work: float
    contact_work: float
    sliding: int
    gauge_opening: float
    gauge_force: float
    gauge_residual: float


class Frame:
    """Springs and dry sliders in parallel; the sliders keep their places.

    unknowns: names of what is found with the balance: "y", where the wheelset moves against its
    actuators, and "gauge", the gauge's opening, both m.
    """

    def __init__(self, table: FrameTable) -> None:
        self._lateral, self._gauge = table.is_lateral, table.gauge_stiffness
        self.unknowns = ("y",) * self._lateral + ("gauge",) * (self._gauge is not None)
        if table.stiffness_table is not None:
            rows = [(row[0], row[1]) for row in table.stiffness_table]
        else:
            rows = [(0.0, 0.0), (1.0, table.stiffness or 0.0)]
        self._at, self._force = np.array(rows, dtype=float).T
        self._slopes = np.diff(self._force) / np.diff(self._at)
        elements = np.array(table.friction or [], dtype=float).reshape(-1, 2)
        self._stiffness, self._limit = elements.T
        self._slips = np.zeros(len(elements))
        self._heat = 0.0
        self._last: FrameState | None = None

    @property
    def softest(self) -> float:
        """N/m, least stiffness of the spring."""
        return float(self._slopes.min())

    def resistance(self, deflection: float) -> Resistance:
        """On a monotone way from the last position to a deflection (m); changes nothing."""
        force, stiffness = self._spring(deflection)
        trial = self._stiffness * (deflection - self._slips)
        held = np.clip(trial, -self._limit, self._limit)
        slides = held != trial
        slips = np.where(slides, deflection - held / self._stiffness, self._slips)
        return Resistance(
            force + float(held.sum()), stiffness + float(self._stiffness[~slides].sum()), slips
        )

    def residuals(self, deflection: float, opening: float, forces: Vector) -> Vector:
        """N, of the unknowns in their order; forces: N, [2], lateral on the wheels."""
        found = []
        if self._lateral:
            found.append(forces[0] + forces[1] - self.resistance(deflection).force)
        if self._gauge is not None:
            found.append(spreading(forces) - self._gauge * opening)
        return np.array(found)

    def slopes(self, name: str, deflection: float, rates: Vector) -> Vector:
        """N/m (or N over the unit of ``name``): of the residuals by an unknown of the balance, with
        the rates of the forces by it."""
        found = []
        if self._lateral:
            resisted = self.resistance(deflection).stiffness if name == "y" else 0.0
            found.append(rates[0] + rates[1] - resisted)
        if self._gauge is not None:
            found.append(spreading(rates) - (self._gauge if name == "gauge" else 0.0))
        return np.array(found)

    def moved(self, actuator: float, y: float, opening: float, forces: Vector) -> FrameState:
        """To the balance of a position, m and N: sliders go on, works are counted. forces: [2], as
        of residuals."""
        deflection = y - actuator
        contact_force = float(forces[0] + forces[1])
        at = self.resistance(deflection)
        self._heat += float(self._limit @ np.abs(at.slips - self._slips))
        sliding = int(np.count_nonzero(at.slips != self._slips))
        self._slips = at.slips
        # what is rigid resists with what it is pushed by
        resisting = at.force if self._lateral else contact_force
        spread = spreading(forces)
        held = spread if self._gauge is None else self._gauge * opening
        state = FrameState(
            actuator,
            deflection,
            -resisting,
            contact_force - resisting,
            self.energy(deflection) + 0.5 * (self._gauge or 0.0) * opening**2,
            self._heat,
            0.0,
            0.0,
            sliding,
            opening,
            held,
            spread - held,
        )
        if (last := self._last) is not None:
            # the actuators carry the frame's force on the wheelset; the contacts its opposite
            mean = 0.5 * (state.force + last.force)
            way = (actuator + deflection) - (last.actuator + last.deflection)
            spread_work = 0.5 * (held + last.gauge_force) * (opening - last.gauge_opening)
            state = replace(
                state,
                actuator_work=last.actuator_work + mean * (actuator - last.actuator),
                contact_work=last.contact_work - mean * way + spread_work,
            )
        self._last = state
        return state

    def energy(self, deflection: float) -> float:
        """J, in all springs between actuators and wheelset, where the sliders are; 0 at no
        deflection before any has moved."""
        stretch = deflection - self._slips
        return self._spring_energy(deflection) + 0.5 * float(self._stiffness @ stretch**2)

    def _piece(self, deflection: float) -> int:
        """Of the table; the first and the last go on beyond it."""
        piece = int(np.searchsorted(self._at, deflection, side="right")) - 1
        return min(max(piece, 0), len(self._slopes) - 1)

    def _spring(self, deflection: float) -> tuple[float, float]:
        k = self._piece(deflection)
        slope = float(self._slopes[k])
        return float(self._force[k]) + slope * (deflection - float(self._at[k])), slope

    def _spring_energy(self, deflection: float) -> float:
        """Exact: the trapezoids between 0, the table's rows and the deflection."""
        low, high = sorted((0.0, deflection))
        inner = [at for at in self._at.tolist() if low < at < high]
        points = [low, *inner, high]
        forces = [self._spring(at)[0] for at in points]
        area = float(np.diff(points) @ (np.array(forces[1:]) + np.array(forces[:-1]))) / 2
        return area if deflection >= 0 else -area


def spreading(forces: Vector) -> float:
    """N, that opens the gauge; forces: [2], lateral on the left and the right wheel."""
    return 0.5 * float(forces[0] - forces[1])
