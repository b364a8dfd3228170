"""Railway vehicles, of any number of wheelsets, on straight and curved track, with irregular rails.

    railpatch vehicle --compare

In Python:

    from wheelset_demo.vehicle import Simulation, load_vehicle_scene

    simulation = Simulation(load_vehicle_scene())
    for state in simulation.steps():       # at the start and after each n-th step (run.log_every)
        poses = simulation.body_poses()    # name -> (rotation [3, 3], place [3], m), world axes
        element = simulation.element       # railpatch.pinocchio.ForceElement, one row a wheelset
        ...

state.time in s, state.q and state.v [n] as in wheelset_demo.vehicle.model; element.states, .wheels,
.contact_wrench, .tracks, .positions, .rails and .result(index) are of that state. Names of bodies
are the scene's; wheelsets and axle boxes are wheelset_1, axle_box_1_left, axle_box_1_right and so
on from the front.
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from wheelset_demo.vehicle.scene import VehicleScene, load_vehicle_scene
    from wheelset_demo.vehicle.simulation import Simulation
    from wheelset_demo.vehicle.system import VehicleState

__all__ = ["Simulation", "VehicleScene", "VehicleState", "load_vehicle_scene"]

# what runs needs Pinocchio, what reads a scene does not: each is imported when it is asked for
PLACES = {
    "Simulation": "simulation",
    "VehicleScene": "scene",
    "VehicleState": "system",
    "load_vehicle_scene": "scene",
}


def __getattr__(name: str) -> Any:
    if name not in PLACES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(import_module(f"{__name__}.{PLACES[name]}"), name)
