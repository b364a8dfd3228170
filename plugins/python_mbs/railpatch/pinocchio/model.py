"""A wheelset as a Pinocchio model, with coordinates that are Railpatch's."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np
import pinocchio as pin

GRAVITY = 9.81  # m/s^2
CARRIER = "carrier"
WHEELSET = "wheelset"
# joints of the composite carrier, in the order of its coordinates
COMPOSITE = (
    ("x", pin.JointModelPX),
    ("y", pin.JointModelPY),
    ("z", pin.JointModelPZ),
    ("roll", pin.JointModelRX),
    ("yaw", pin.JointModelRZ),
)


@dataclass(frozen=True)
class Body:
    """A rigid body, balanced about the wheelset's centre.

    mass: kg. inertia: kg m^2, about x, y, z through the wheelset's centre; for the spinning body
    about its axle (y) and twice about any diameter.
    """

    mass: float
    inertia: tuple[float, float, float]

    def __post_init__(self) -> None:
        values = (self.mass, *self.inertia)
        if len(values) != 4 or not all(np.isfinite(values)) or min(values) <= 0:
            raise ValueError(f"body: values are {values}, allowed four > 0 (kg, kg m^2)")

    def pinocchio(self) -> pin.Inertia:
        """As Pinocchio's."""
        return pin.Inertia(self.mass, np.zeros(3), np.diag(self.inertia))


def wheelset_model(
    wheelset: Body,
    nominal_radius: float,
    *,
    carrier: Literal["composite", "free_flyer"] = "composite",
    carrier_body: Body | None = None,
    gravity: float = GRAVITY,
) -> pin.Model:
    """A wheelset on a carrier that does not spin, in world axes that are the track's.

    wheelset: the spinning body; its inertias about x and z must be equal. nominal_radius: m.
    carrier_body: axle boxes and what else is carried without spinning. gravity: m/s^2, down.

    carrier = "composite": the carrier's five joints are named "x", "y", "z", "roll", "yaw", the
    spinning one "wheelset". q is then x, y, z, roll, yaw, pitch as Railpatch has them (z = 0: the
    centre lies one nominal radius above the rails' tops) and v is speed, vy, vz, roll_rate,
    yaw_rate, pitch_rate. Their number is the same, so a stepper may treat them as plain vectors.

    carrier = "free_flyer": joints "carrier" and "wheelset"; the carrier needs a body, because
    nothing else resists its turning about the axle, and something that holds it there.

    A wheelset without a carrier, one body on a free-flyer, integrates badly: its big spin turns the
    axes that the free-flyer's velocity is written in, at V/r radians a second.

    Raises ValueError.
    """
    if not (np.isfinite(nominal_radius) and nominal_radius > 0):
        raise ValueError(f"nominal_radius: value is {nominal_radius}, allowed > 0 (m)")
    if wheelset.inertia[0] != wheelset.inertia[2]:
        raise ValueError(
            f"wheelset: inertia is {wheelset.inertia}, allowed equal ones about x and z: it spins"
        )
    model = pin.Model()
    model.name = WHEELSET
    model.gravity.linear = np.array([0.0, 0.0, gravity])
    start = pin.SE3(np.eye(3), np.array([0.0, 0.0, -nominal_radius]))
    if carrier == "composite":
        held = add_composite(model, start)
    elif carrier == "free_flyer":
        if carrier_body is None:
            raise ValueError("carrier_body: missing, allowed a Body with carrier = 'free_flyer'")
        held = model.addJoint(0, pin.JointModelFreeFlyer(), start, CARRIER)
    else:
        raise ValueError(f"carrier: value is {carrier!r}, allowed 'composite' or 'free_flyer'")
    if carrier_body is not None:
        model.appendBodyToJoint(held, carrier_body.pinocchio(), pin.SE3.Identity())
    spinning = model.addJoint(held, pin.JointModelRY(), pin.SE3.Identity(), WHEELSET)
    model.appendBodyToJoint(spinning, wheelset.pinocchio(), pin.SE3.Identity())
    return model


def add_composite(model: pin.Model, start: pin.SE3) -> int:
    """Prismatic and revolute joints in the order of Railpatch's coordinates; the last index."""
    parent, placement = 0, start
    for name, joint in COMPOSITE:
        parent = model.addJoint(parent, joint(), placement, name)
        placement = pin.SE3.Identity()
    return parent
