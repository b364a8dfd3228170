"""A vehicle as a Pinocchio model, with coordinates that are plain numbers.

Each body hangs from the world by joints of one degree of freedom, so that there are as many
coordinates as velocities and a time stepper may treat both as vectors:

    free body                x, y, z, yaw, roll, pitch
    wheelset's carrier       x, y, z, yaw, roll
    on it: wheelset          spin about the axle
           axle boxes        pitch about the axle, left, right

x, y, z in the world's axes (m); at the start all bodies stand in the track's frame at their place.
The packaged coach has 18 + 20 + 4 + 8 = 50 of them.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import pinocchio as pin
from numpy.typing import NDArray

from wheelset_demo.scene import GRAVITY
from wheelset_demo.vehicle.bodies import BodyTable
from wheelset_demo.vehicle.scene import VehicleScene

Vector = NDArray[np.float64]
FREE = (
    ("x", pin.JointModelPX),
    ("y", pin.JointModelPY),
    ("z", pin.JointModelPZ),
    ("yaw", pin.JointModelRZ),
    ("roll", pin.JointModelRX),
    ("pitch", pin.JointModelRY),
)
# in place of a column: the body has no such coordinate
ABSENT = -1


@dataclass(frozen=True)
class VehicleModel:
    """The model and where its bodies are.

    joints: body name -> index of its joint. carriers: [wheelsets, 5], indices of coordinates of the
    wheelsets' carriers. spins: [wheelsets], of their spin. bodies: names of what elements act on:
    the free bodies, that of reference first, then of each wheelset its carrier, under the
    wheelset's name, and its axle boxes. columns: [bodies, 6], indices of their coordinates (x, y,
    z, yaw, roll, pitch), of which axle boxes share the first five with their wheelset and carriers
    have no pitch, ABSENT. arms: m, [bodies], lateral, from the origin of the first five to the
    body's centre. centres: m, [bodies, 3], at rest, in the track's frame of which x = 0 is at the
    last wheelset. rest: [nv], the coordinates then. ahead: those of them along the track.
    """

    model: pin.Model
    joints: dict[str, int]
    carriers: NDArray[np.int64]
    spins: NDArray[np.int64]
    bodies: tuple[str, ...]
    columns: NDArray[np.int64]
    arms: Vector
    centres: Vector
    rest: Vector
    ahead: NDArray[np.int64]

    def spell(self, column: int) -> str:
        """A coordinate in words: the body's and its name."""
        name: str = next(
            joint
            for index, joint in enumerate(self.model.names)
            if index and self.model.idx_vs[index] == column
        )
        # a carrier is what of a wheelset does not spin
        return name.replace("carrier_", "wheelset_")


def vehicle_model(scene: VehicleScene) -> VehicleModel:
    """Of a scene."""
    vehicle = scene.vehicle
    model = pin.Model()
    model.name = "vehicle"
    model.gravity.linear = np.array([0.0, 0.0, GRAVITY])
    joints: dict[str, int] = {}
    bodies, columns, arms, centres = [], [], [], []
    for table in vehicle.bodies:
        first = model.nv
        joints[table.name] = add_chain(model, table.name, table, len(FREE))
        bodies.append(table.name)
        columns.append([*range(first, first + 6)])
        arms.append(0.0)
        centres.append(vehicle.place(*table.position))
    carriers, spins = [], []
    for axle in vehicle.axles:
        first = model.nv
        held = add_chain(model, f"carrier_{axle.number}", None, 5)
        joints[axle.name] = add_spinning(model, held, axle.name, axle.table, 0.0)
        carriers.append([*range(first, first + 5)])
        spins.append(first + 5)
        radius = scene.case_of(axle).wheelset.nominal_radius
        bodies.append(axle.name)
        columns.append([*carriers[-1], ABSENT])
        arms.append(0.0)
        centres.append(vehicle.place(axle.x, 0.0, radius))
        for name, arm in axle.boxes.items():
            columns.append([*carriers[-1], model.nv])
            joints[name] = add_spinning(model, held, name, axle.table.axle_box, arm)
            bodies.append(name)
            arms.append(arm)
            centres.append(vehicle.place(axle.x, arm, radius))
    rest, ahead = np.zeros(model.nv), []
    for six, arm, centre in zip(columns, arms, centres, strict=True):
        rest[six[:3]] = centre[0], centre[1] - arm, centre[2]
        ahead.append(six[0])
    return VehicleModel(
        model,
        joints,
        np.array(carriers),
        np.array(spins),
        tuple(bodies),
        np.array(columns),
        np.array(arms),
        np.array(centres),
        rest,
        np.array(ahead),
    )


def add_chain(model: pin.Model, name: str, body: BodyTable | None, count: int) -> int:
    """The first joints of FREE one after the other, the body on the last; its index."""
    parent = 0
    for axis, joint in FREE[:count]:
        parent = model.addJoint(parent, joint(), pin.SE3.Identity(), f"{name}.{axis}")
    if body is not None:
        model.appendBodyToJoint(parent, inertia_of(body), pin.SE3.Identity())
    return parent


def add_spinning(
    model: pin.Model, carrier: int, name: str, body: BodyTable | None, arm: float
) -> int:
    """A body that turns about a carrier's axle, ``arm`` m to the right; its joint's index."""
    assert body is not None
    place = pin.SE3(np.eye(3), np.array([0.0, arm, 0.0]))
    joint: int = model.addJoint(carrier, pin.JointModelRY(), place, name)
    model.appendBodyToJoint(joint, inertia_of(body), pin.SE3.Identity())
    return joint


def inertia_of(body: BodyTable) -> pin.Inertia:
    """As Pinocchio's."""
    return pin.Inertia(body.mass, np.zeros(3), np.diag(body.inertia))
