"""The run log of a vehicle: from a simulation's present state."""

from __future__ import annotations

import math
from contextlib import suppress
from pathlib import Path
from typing import Any

import numpy as np
import pinocchio as pin
from railpatch.case.types import SIDES
from railpatch.log import VehicleGeometry, VehicleLog, scene_geometry
from railpatch.log.stream import Pace
from railpatch.result import logged, wheel_json

from wheelset_demo.record import attachments, ran_with
from wheelset_demo.scene import GRAVITY, SNAPSHOTS
from wheelset_demo.system import WORKS, ContactFailure
from wheelset_demo.trace import STORES
from wheelset_demo.vehicle.bodies import FreeBodyTable, VehicleTable
from wheelset_demo.vehicle.comfort import NAMES
from wheelset_demo.vehicle.plausible import doubts_of
from wheelset_demo.vehicle.scene import VehicleScene
from wheelset_demo.vehicle.simulation import Simulation

# m, drawn: length beyond the wheelsets, width and height of the body of reference; length beyond
# its wheelsets and width and height of beams, and their distance from the middle, of others
OVERHANG, WIDTH, HEIGHT = 2.5, 2.8, 2.7
BEYOND, BEAM, ARM = 0.4, 0.22, 1.0
LINE_STEP = 2.0  # m, of the centre line that is drawn


class Recorder:
    """Writes a simulation's states into a log, thinned as the scene's [run] says."""

    def __init__(self, log: VehicleLog, simulation: Simulation) -> None:
        self._log = log
        run = simulation.scene.run
        self._pace = None if run.write_rate is None else Pace(run.write_rate)
        self._fields = Pace(
            SNAPSHOTS / run.duration if run.snapshot_rate is None else run.snapshot_rate
        )
        self._start: np.ndarray | None = None
        self._done = 0.0, 0
        self._written = -math.inf
        self._blocks = 0

    def write(self, simulation: Simulation) -> None:
        """The present state, where its turn has come; the run's last one too."""
        time, run = simulation.state.time, simulation.scene.run
        last = time > run.duration - 0.5 * run.step
        if self._pace is not None and not self._pace.due(time) and not last:
            return
        with self._log.stream.counted():
            self._comfort(simulation)
            self._log.write(time, **self.messages(simulation, self._fields.due(time)))
        self._written = time

    def _comfort(self, simulation: Simulation) -> None:
        """Blocks that have become whole, at their ends."""
        comfort = simulation.comfort
        if comfort is None:
            return
        for end, block in list(zip(comfort.ends, comfort.blocks, strict=True))[self._blocks :]:
            self._log.write_comfort(end, comfort_message(comfort.names, block))
            self._blocks += 1

    def ended(self, simulation: Simulation, assessed: dict[str, Any]) -> None:
        """What is known at the end alone: percentiles and mean comfort."""
        with self._log.stream.counted():
            found = dict(assessed)
            if simulation.comfort is not None:
                told = simulation.comfort.summary()
                self._comfort(simulation)
                if told["blocks"]:
                    found["comfort_blocks"] = told["blocks"]
                    found["comfort"] = [
                        {"name": name, **values} for name, values in told["points"].items()
                    ]
            wear = simulation.wear
            if wear is not None:
                time = simulation.state.time
                self._log.write_wear(time, {w: wear.message(w) for w in wear.by_wheel})
            if found:
                self._log.write_assessment(simulation.state.time, found)

    def failed(self, simulation: Simulation, failure: ContactFailure) -> None:
        """The last state that is good, if it is not written yet, and the contacts that were asked
        for last, which were not all solved."""
        time = simulation.state.time
        with self._log.stream.counted():
            wrong = self.messages(simulation, False)
            if time > self._written:
                with suppress(ContactFailure):
                    simulation.solve_again()
                    self._log.write(time, **self.messages(simulation, False))
            # a motion that is not a number has nothing to show
            with suppress(ValueError):
                self._log.write(max(failure.time, time + 1e-9), **wrong)

    def messages(self, simulation: Simulation, fields: bool) -> dict[str, Any]:
        """Arguments of VehicleLog.write."""
        element, alignment = simulation.element, simulation.system.alignment
        frames = [(row[:9].reshape(3, 3), row[9:]) for row in element.tracks]
        # at each wheelset and in the middle
        along = np.append(element.positions, element.positions.mean())
        curvature, cant = alignment.curvature(along).tolist(), alignment.cant_angle(along).tolist()
        places = [
            {"x": x, "curvature": bend, "cant": angle}
            for x, bend, angle in zip(along.tolist(), curvature, cant, strict=True)
        ]
        return {
            "state": self._state(simulation) | places[-1],
            "wheelsets": [
                self._wheelset(simulation, k, place, fields) for k, place in enumerate(places[:-1])
            ],
            "bodies": bodies(simulation),
            "tracks": [(origin.tolist(), quaternion(turn)) for turn, origin in frames],
            "energy": self._energy(simulation),
            "stats": self._stats(simulation),
        }

    def _state(self, simulation: Simulation) -> dict[str, float]:
        system, state = simulation.system, simulation.state
        return {
            "progress": state.time / simulation.scene.run.duration,
            "speed": float(np.hypot(*state.v[system.vehicle.columns[0][:2]])),
        }

    def _wheelset(
        self, simulation: Simulation, index: int, place: dict[str, float], fields: bool
    ) -> dict[str, Any]:
        element, system = simulation.element, simulation.system
        result = element.result(index, fields=fields)
        # with what rails that are not level add along the track
        sloped = system.slope_wrenches[index]
        wrench = element.contact_wrench[index].copy()
        wrench[[0, 4, 5]] += sloped.sum(axis=0)
        wrench = wrench.tolist()
        rails = element.rails[index, 0, :, 1:].tolist()
        state = element.state(index) | {
            **place,
            "force": wrench[:3],
            "moment": wrench[3:],
            "left_rail": rails[0],
            "right_rail": rails[1],
            **logged(result),
        }
        if index in system.drives.driven:
            q, v = simulation.state.q, simulation.state.v
            state["drive_torque"] = float(system.drives.torque[index])
            state["slip_speed"] = float(system.drives.slip_speeds(q, v)[index])
        wheels = slice(2 * index, 2 * index + 2)
        lost = simulation.state.work[len(WORKS) :][wheels].tolist()
        means = simulation.means.guiding[wheels].tolist(), simulation.means.loads[wheels].tolist()
        found: dict[str, Any] = {"state": state}
        for side, work, more, guiding, load in zip(
            SIDES, lost, sloped.tolist(), *means, strict=True
        ):
            # z is given in vehicle runs
            wheel = wheel_json(result[side]) | {"friction_work": work, "z": None}
            wheel |= {"mean_guiding_force": guiding, "mean_wheel_load": load}
            wheel["force"][0] += more[0]
            wheel["moment"][1] += more[1]
            wheel["moment"][2] += more[2]
            found[side] = wheel
        if system.wet is not None:
            rate, *spent = element.water[index].tolist()
            if np.isnan(rate):
                rate = system.scene.case.fluid.water_rate
            for side, work in zip(SIDES, spent, strict=True):
                found[side] |= {"water_rate": rate, "rail_work": work}
        if system.support is not None:
            found["support"] = system.support.logged(index)
            places, rates = system.support.place[index], system.support.rate[index]
            for k, side in enumerate(SIDES):
                own = slice(2 * k, 2 * k + 2)
                found[side] |= {
                    "rail_deflection": places[own].tolist(),
                    "rail_deflection_rate": rates[own].tolist(),
                }
        if fields:
            found["fields"] = {side: result[side]["patches"] for side in SIDES}
        return found

    def _energy(self, simulation: Simulation) -> dict[str, float]:
        stored = np.asarray(simulation.energies)
        if self._start is None:
            self._start = stored
        change = stored - self._start
        work = dict(zip(WORKS, simulation.state.work[: len(WORKS)].tolist(), strict=True))
        bodies_and_springs = float(change[:3].sum())
        return {
            **dict(zip(STORES, stored.tolist(), strict=True)),
            **{f"{name}_work": value for name, value in work.items()},
            "mechanical_residual": bodies_and_springs
            - work["contact"]
            - work["drive"]
            + work["damping"],
            "contact_residual": work["contact"] + work["friction"] + float(change[3]),
        }

    def _stats(self, simulation: Simulation) -> dict[str, Any]:
        """Work since the step that was written before."""
        now = simulation.wall_seconds, simulation.element.solves
        before, self._done = self._done, now
        return {
            "wall_time": now[0] - before[0],
            "contact_evaluations": len(SIDES) * (now[1] - before[1]),
        }


def comfort_message(names: list[str], block: np.ndarray) -> dict[str, Any]:
    """Of one block; the names are those of comfort.py's table."""
    return {
        "points": [
            {"name": name, **dict(zip(NAMES, values, strict=True))}
            for name, values in zip(names, block.tolist(), strict=True)
        ]
    }


def bodies(simulation: Simulation) -> list[dict[str, Any]]:
    """Free bodies and wheelsets; these without their spin."""
    system, state = simulation.system, simulation.state
    placed, model = system.data.oMi, system.model
    found = []
    free = len(simulation.scene.vehicle.bodies)
    for name, columns in zip(system.vehicle.bodies[:free], system.vehicle.columns, strict=False):
        place = placed[system.vehicle.joints[name]]
        acceleration = simulation.rates.values[system.count + columns[:3]].copy()
        acceleration[2] -= GRAVITY
        moved = {
            "velocity": state.v[columns[:3]].tolist(),
            "acceleration": (place.rotation.T @ acceleration).tolist(),
        }
        found.append(body(name, place) | moved)
    for axle, columns in zip(simulation.scene.vehicle.axles, system.vehicle.carriers, strict=True):
        velocity = state.v[columns[:3]].tolist()
        carrier = placed[model.parents[system.vehicle.joints[axle.name]]]
        found.append(body(axle.name, carrier) | {"velocity": velocity})
    return found


def body(name: str, place: pin.SE3) -> dict[str, Any]:
    """Name and pose."""
    return {
        "name": name,
        "position": place.translation.tolist(),
        "orientation": quaternion(place.rotation),
    }


def quaternion(turn: np.ndarray) -> list[float]:
    """x, y, z, w."""
    return pin.Quaternion(turn).coeffs().tolist()


def open_log(path: Path, simulation: Simulation) -> VehicleLog:
    """The log of a simulation that is to run. Raises OSError."""
    scene = simulation.scene
    return VehicleLog(
        path,
        wheelsets=simulation.system.wheelsets,
        case_text=scene.text,
        case_name=scene.name,
        profiles=attachments(scene) | record_of(scene),
        geometry=geometry(simulation),
        scene_rate=scene.run.scene_rate,
        ran_with=ran_with(scene, doubts_of(scene)),
    )


def record_of(scene: VehicleScene) -> dict[str, bytes]:
    """The content of the rails' record by its name; none of a spectrum."""
    if scene.measured is None:
        return {}
    return {scene.measured.path.name: scene.measured.path.read_bytes()}


def geometry(simulation: Simulation) -> VehicleGeometry:
    """What is drawn: boxes as large as the scene says or its dimensions let one guess."""
    scene = simulation.scene
    along = np.linspace(0.0, scene.length - 1.0, max(2, math.ceil(scene.length / LINE_STEP)))
    _, line = simulation.system.alignment.frames(along)
    own = {
        axle.number: scene_geometry(scene.case_of(axle))
        for axle in scene.vehicle.axles
        if scene.case_of(axle) is not scene.case
    }
    return VehicleGeometry(scene_geometry(scene.case), boxes_of(scene.vehicle), line, own)


def boxes_of(vehicle: VehicleTable) -> dict[str, list[tuple[list[float], list[float]]]]:
    """Of the free bodies by name: centres and sizes, m, in their axes."""
    reference, *others = vehicle.bodies
    found = {}
    for table in (reference, *others):
        if table.size is not None:
            found[table.name] = [([0.0, 0.0, 0.0], table.size)]
        elif table is reference:
            floor = max((body.position[2] for body in others), default=0.5) + 0.5
            # in its axes, z down from its centre, and x from it to the middle of the wheelsets
            middle = 0.5 * (vehicle.axles[0].x + vehicle.axles[-1].x) - table.position[0]
            down = table.position[2] - floor - 0.5 * HEIGHT
            size = [vehicle.length + 2 * OVERHANG, WIDTH, HEIGHT]
            found[table.name] = [([middle, 0.0, down], size)]
        else:
            found[table.name] = frame_of(table, vehicle)
    return found


def frame_of(body: FreeBodyTable, vehicle: VehicleTable) -> list[tuple[list[float], list[float]]]:
    """Two beams along and one across, over the wheelsets that elements join the body to."""
    pairs = [place.between for element in vehicle.element for place in element.places]
    joined = {name for pair in pairs if body.name in pair for name in pair}
    axles = [axle for axle in vehicle.axles if joined & {axle.name, *axle.boxes}]
    arm = max((y for axle in axles for y in axle.boxes.values()), default=ARM)
    ends = [axle.x for axle in axles] or [body.position[0]]
    middle, length = 0.5 * (max(ends) + min(ends)) - body.position[0], max(ends) - min(ends)
    beam = [length + 2 * BEYOND, BEAM, BEAM]
    beams = [([middle, side * arm, 0.0], beam) for side in (-1.0, 1.0)]
    return [*beams, ([middle, 0.0, 0.0], [2 * BEAM, 2 * arm, BEAM])]
