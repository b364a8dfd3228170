"""Energies and powers of a wheelset on its suspension.

Mechanical balance, over any part of a run:

    change of (kinetic + gravity + suspension)
        = work of the contact forces + work of the drive - work of the dampers

where the drive is what keeps the suspension's reference at its speed. The contact forces' power on
the wheelset is F.v + M.omega. What they take goes into the creepages, creep_power of the element,
and into the elastic energy of the pressure in the contacts, pressure_energy:

    - work of the contact forces = work of the creepages + change of pressure's elastic energy

The first holds for any contact law, so it tests time stepper and force elements; the second tests
the contact: docs/power.md. The tractions' elastic energy has no part in it: in steady rolling each
step has the tractions of an endless one, whose energy nothing supplies, and in transient rolling
the work of the creepages holds it. friction_power is what the theory itself counts as heat, by some
theories not all of the creep power.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import pinocchio as pin
from numpy.typing import NDArray

from railpatch.pinocchio.element import ForceElement
from railpatch.pinocchio.suspension import Suspension


@dataclass(frozen=True)
class Energies:
    """J. kinetic: of all bodies in the world frame. gravity, suspension: potential energies.
    elastic: of the pressure in the contacts."""

    kinetic: float
    gravity: float
    suspension: float
    elastic: float

    @property
    def mechanical(self) -> float:
        """J, of bodies and springs, without the contacts."""
        return self.kinetic + self.gravity + self.suspension


@dataclass(frozen=True)
class Powers:
    """W. contact: of the contact forces on the wheelsets. friction: supplied by the creepages and
    the spin in the contacts, >= 0 up to rounding. damping: in the dampers, >= 0. drive: put in by
    the moving references."""

    contact: float
    friction: float
    damping: float
    drive: float


def energies(
    model: pin.Model,
    data: pin.Data,
    q: NDArray,
    v: NDArray,
    element: ForceElement,
    suspensions: Iterable[Suspension] = (),
) -> Energies:
    """At the last step of element and suspensions, whose q and v these are.

    Raises ValueError for an element in a moving frame: kinetic energy is that in the model's world,
    but work is counted on the track.
    """
    if element.frame_speed != 0:
        raise ValueError(f"frame_speed: value is {element.frame_speed}, allowed 0 for energies")
    return Energies(
        pin.computeKineticEnergy(model, data, q, v),
        pin.computePotentialEnergy(model, data, q),
        sum(suspension.potential for suspension in suspensions),
        element.pressure_energy,
    )


def powers(element: ForceElement, suspensions: Iterable[Suspension] = ()) -> Powers:
    """At the last step of element and suspensions."""
    springs = list(suspensions)
    return Powers(
        element.contact_power,
        element.creep_power,
        sum(suspension.damping_power for suspension in springs),
        sum(suspension.drive_power for suspension in springs),
    )
