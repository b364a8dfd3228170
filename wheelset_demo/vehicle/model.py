"""A vehicle as a Pinocchio model: 50 degrees of freedom, coordinates that are plain numbers.

Each body hangs from the world by joints of one degree of freedom, so that there are as many
coordinates as velocities and a time stepper may treat both as vectors:

    car body, bogie frames   x, y, z, yaw, roll, pitch                  18
    wheelset's carrier       x, y, z, yaw, roll                         20
    on it: wheelset          spin about the axle                         4
           axle boxes        pitch about the axle, left, right           8

x, y, z in the world's axes (m); at the start all bodies stand in the track's frame at their place.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import pinocchio as pin
from numpy.typing import NDArray

from wheelset_demo.scene import GRAVITY
from wheelset_demo.vehicle.scene import WHEELSETS, BodyTable, VehicleScene, VehicleTable

Vector = NDArray[np.float64]
FREE = (
    ("x", pin.JointModelPX),
    ("y", pin.JointModelPY),
    ("z", pin.JointModelPZ),
    ("yaw", pin.JointModelRZ),
    ("roll", pin.JointModelRX),
    ("pitch", pin.JointModelRY),
)
BOGIES = 2
CAR_BODY = "car_body"


@dataclass(frozen=True)
class VehicleModel:
    """The model and where its bodies are.

    joints: body name -> index of its joint. carriers: [4, 5], indices of coordinates of the
    wheelsets' carriers. bodies: names of what suspensions act on: car body, bogie frames, axle
    boxes. columns: [bodies, 6], indices of their coordinates (x, y, z, yaw, roll, pitch), of which
    axle boxes share the first five with their wheelset. arms: m, [bodies], lateral, from the origin
    of the first five to the body's centre.
    """

    model: pin.Model
    joints: dict[str, int]
    carriers: NDArray[np.int64]
    spins: NDArray[np.int64]
    bodies: tuple[str, ...]
    columns: NDArray[np.int64]
    arms: Vector


def vehicle_model(scene: VehicleScene) -> VehicleModel:
    """Of a scene."""
    vehicle = scene.vehicle
    model = pin.Model()
    model.name = "vehicle"
    model.gravity.linear = np.array([0.0, 0.0, GRAVITY])
    joints: dict[str, int] = {}
    bodies, columns, arms = [], [], []
    for name, table in free_bodies(vehicle):
        first = model.nv
        joints[name] = add_chain(model, name, table, len(FREE))
        bodies.append(name)
        columns.append(np.arange(first, first + 6))
        arms.append(0.0)
    carriers, spins = [], []
    for k in range(WHEELSETS):
        first = model.nv
        held = add_chain(model, f"carrier_{k + 1}", None, 5)
        name = f"wheelset_{k + 1}"
        joints[name] = model.addJoint(held, pin.JointModelRY(), pin.SE3.Identity(), name)
        model.appendBodyToJoint(joints[name], inertia_of(vehicle.wheelset), pin.SE3.Identity())
        carriers.append(np.arange(first, first + 5))
        spins.append(first + 5)
        for side, sign in (("left", -1.0), ("right", 1.0)):
            arm = sign * vehicle.axle_box.lateral
            name = f"axle_box_{k + 1}_{side}"
            columns.append(np.array([*range(first, first + 5), model.nv]))
            place = pin.SE3(np.eye(3), np.array([0.0, arm, 0.0]))
            joints[name] = model.addJoint(held, pin.JointModelRY(), place, name)
            model.appendBodyToJoint(joints[name], inertia_of(vehicle.axle_box), pin.SE3.Identity())
            bodies.append(name)
            arms.append(arm)
    return VehicleModel(
        model,
        joints,
        np.array(carriers),
        np.array(spins),
        tuple(bodies),
        np.array(columns),
        np.array(arms),
    )


def free_bodies(vehicle: VehicleTable) -> list[tuple[str, BodyTable]]:
    """Car body and bogie frames."""
    frames = [(bogie_name(k), vehicle.bogie_frame) for k in range(BOGIES)]
    return [(CAR_BODY, vehicle.car_body), *frames]


def bogie_name(index: int) -> str:
    """Of the leading (0) or trailing (1) bogie frame."""
    return f"bogie_{index + 1}"


def add_chain(model: pin.Model, name: str, body: BodyTable | None, count: int) -> int:
    """The first joints of FREE one after the other, the body on the last; its index."""
    parent = 0
    for axis, joint in FREE[:count]:
        parent = model.addJoint(parent, joint(), pin.SE3.Identity(), f"{name}.{axis}")
    if body is not None:
        model.appendBodyToJoint(parent, inertia_of(body), pin.SE3.Identity())
    return parent


def inertia_of(body: BodyTable) -> pin.Inertia:
    """As Pinocchio's."""
    return pin.Inertia(body.mass, np.zeros(3), np.diag(body.inertia))


def places_along(vehicle: VehicleTable) -> dict[str, float]:
    """m, along the track, of all bodies; the last wheelset is at 0."""
    half, base = 0.5 * vehicle.bogie_distance, 0.5 * vehicle.wheelbase
    middle = half + base
    found = {CAR_BODY: middle}
    for bogie, ahead in enumerate((half, -half)):
        found[bogie_name(bogie)] = middle + ahead
        for k, there in ((2 * bogie, base), (2 * bogie + 1, -base)):
            for name in (f"wheelset_{k + 1}", f"axle_box_{k + 1}_left", f"axle_box_{k + 1}_right"):
                found[name] = middle + ahead + there
    return found
