"""Contacts of one pair of profiles: places, shapes of pressure, motions that give creepages.

What is solved is one wheel on its rail or roller at heights found for its load. The shapes of a
table are solved with the case's friction: forces over friction times load depend on creepages over
friction only, so other coefficients are other creepages.
"""

from __future__ import annotations

from dataclasses import asdict, dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from railpatch.case.accuracy import fitted_size
from railpatch.case.load import Scene, load_scene
from railpatch.case.wheel import WheelRailCase
from railpatch.contact import Contact
from railpatch.errors import CaseError
from railpatch.many import solve_many

Vector = NDArray[np.float64]
# of v, core/fast/shape_table.hpp
STIFFNESS = np.array([4.2, 3.7, 2.3])
SPEED = 20.0  # m/s on rails, which steady forces do not depend on
STEP = 0.05  # of creepages, and 1/m of spin, that tell how they follow from rates
COARSE = {"elements": [16, 16]}
# elements, and scale of railpatch.case.accuracy.fitted_size
# of nodes, of nodes with two parts, of states that are tried
NODES, DIVIDED, CHECK = (40, 16), (48, 20), (48, 22)
FULL = {"tangential": "full", "tolerance": 1e-4, "max_iterations": 500}


@dataclass(frozen=True)
class Ranges:
    """Of the places of a wheelset, m, rad, N, and of friction and curvature of the track (1/m)."""

    y: tuple[float, float] = (-6e-3, 7.5e-3)
    yaw: float = 0.03
    roll: float = 3e-3
    load: tuple[float, float] = (1e4, 1.5e5)
    friction: tuple[float, float] = (0.15, 0.6)
    curvature: float = 1 / 150
    creepage: tuple[float, float] = (3e-5, 6e-3)


@dataclass
class Place:
    """A patch of a wheel at rest: its number k of count, how it moves, and its pressure's shape.

    motion: creepages by pitch_rate, vy, yaw_rate, [3, 3], and at rest, [3]. axes, centre: m.
    features: as in core/fast/shape_table.hpp, not scaled. fall: least load of a row between two
    parts, over the lesser one's greatest row; 1 where there is one part.
    """

    at: dict[str, float]
    k: int
    motion: Vector
    rest: Vector
    rates: dict[str, float]
    arm: float
    normal_force: float
    axes: Vector
    centre: Vector
    features: Vector
    fall: float


class Pair:
    """A wheel and its rail or roller, of a case of kind wheel_rail."""

    def __init__(
        self, case: dict[str, Any], folder: str, ranges: Ranges, seed: int, label: str
    ) -> None:
        self.ranges, self.random, self.folder = ranges, np.random.default_rng(seed), folder
        self.label = label
        self._case = case
        scene = self.scene({"tangential": "fastsim"}, COARSE, z=0.0)
        checked = scene.case
        if not isinstance(checked, WheelRailCase):
            raise CaseError(f"kind: value is {checked.kind!r}, allowed 'wheel_rail'")
        material = checked.material
        self.shear_modulus = float(np.mean(material.shear_modulus))
        self.poisson_ratio = float(np.mean(material.poisson_ratio))
        self.friction = checked.friction.coefficient
        track = checked.track
        self.roller = track.kind == "roller"
        turning = (track.roller_pitch_rate or 0.0) * (track.roller_radius or 0.0)
        self.speed = abs(turning) or SPEED
        self._still = Contact(scene)
        loaded = self.scene({"tangential": "polach"}, COARSE, vertical_force=1e5)
        self._loaded = Contact(loaded)
        self._radius = checked.wheelset.nominal_radius

    def about(self) -> dict[str, Any]:
        """What says which pair it is: the case and the ranges of its places."""
        return {"case": self._case, "ranges": asdict(self.ranges)}

    def scene(
        self, method: dict[str, Any], grid: dict[str, Any], friction: float | None = None,
        **height: float,
    ) -> Scene:  # fmt: skip
        """The pair by other methods; friction: None is the case's; height: z (m) or vertical_force
        (N)."""
        found = {key: value for key, value in self._case.items() if key not in ("grid", "method")}
        wheelset = {
            key: value
            for key, value in found.get("wheelset", {}).items()
            if key not in ("z", "vertical_force")
        }
        kept = {
            key: value
            for key, value in self._case.get("method", {}).items()
            if key in ("normal", "reference_surface", "patch_rule", "contact_frame")
        }
        if friction is not None:
            found["friction"] = {**found["friction"], "coefficient": friction}
        return load_scene(
            {
                **found,
                "wheelset": {**wheelset, **height},
                "grid": grid,
                "method": {**kept, **method},
            },
            self.folder,
        )

    def place(self) -> Place:
        """A random one with contact."""
        r = self.ranges
        while True:
            # a place hangs on no other: a run that goes on finds the same
            self._loaded.reset()
            self._still.reset()
            where = {
                "y": self.random.uniform(*r.y),
                "yaw": self.random.uniform(-r.yaw, r.yaw),
                "roll": self.random.uniform(-r.roll, r.roll),
            }
            load = float(np.exp(self.random.uniform(*np.log(r.load))))
            rest = self._loaded.step(**where, vertical_force=load)
            if not rest.solved:
                continue
            found = self._patch({**where, "z": rest["z"]}, rest["rolling_radius"])
            if found is not None:
                return found

    def _patch(self, at: dict[str, float], radius: float) -> Place | None:
        rates = {"pitch_rate": -self.speed / radius, "vy": 0.0, "yaw_rate": 0.0, **self._along()}
        still = self._still.step(**at, **rates, fields=True)
        patches = still["patches"]
        if not patches:
            return None
        k = int(self.random.integers(len(patches)))
        patch = patches[k]
        pressure = np.asarray(patch["pressure"])
        if not pressure.sum() > 0:
            return None
        arm = float(patch["position"][1])

        def creepages(**changes: float) -> Vector:
            found = self._still.step(**at, **{**rates, **changes})["patches"][k]
            return np.array([*found["creepage"], found["spin_creepage"]])

        rest = creepages()
        steps = (
            ({"pitch_rate": 1.001 * rates["pitch_rate"]}, 0.001 * rates["pitch_rate"]),
            ({"vy": 0.02}, 0.02),
            ({"yaw_rate": 0.1, **self._along(0.1 * arm)}, 0.1),
        )
        motion = np.stack([(creepages(**step) - rest) / size for step, size in steps], axis=-1)
        axes, centre, features = shape(np.asarray(patch["x"]), np.asarray(patch["y"]), pressure)
        return Place(
            at, k, motion, rest, rates, arm, patch["normal_force"], axes, centre, features,
            fall_of(pressure),
        )  # fmt: skip

    def _along(self, turning: float = 0.0) -> dict[str, float]:
        """What keeps the rolling speed, where a yawing wheelset's contact moves by turning, m/s."""
        if self.roller:
            return {}
        return {"speed": SPEED + turning}

    def unit(self, place: Place) -> Vector:
        """Creepages of v = 1, [3]."""
        square, reach = float(np.prod(place.axes)), float(np.sqrt(np.mean(place.axes**2)))
        scale = self.friction * place.normal_force / (self.shear_modulus * square)
        return scale / STIFFNESS / np.array([1.0, 1.0, reach])

    def inputs(self, place: Place, creepages: Vector, elements: list[int]) -> dict[str, Vector]:
        """Moving inputs of a place for creepages [n, 3] about the patch's reference, as a grid has
        it."""
        # slips and the rolling speed, which creepages are over, are linear in the rates u:
        # c = (c0 + A u)/(1 + g.u), so A and g are in c at u = 0 and at both ends of each step
        size = STEP / np.abs(place.motion.diagonal())
        steps = np.concatenate([np.zeros((1, 3)), np.diag(size), -np.diag(size)])
        quick = self.scene({"tangential": "polach"}, {"elements": elements}, z=0.0)
        found = self._creepages(quick, place, self._moving(place, steps))
        rest, up, down = found[0], found[1:4], found[4:]
        bent, span = 2.0 * rest - up - down, up - down
        g = (bent * span).sum(axis=1) / (span * span).sum(axis=1) / size
        slopes = ((up * (1.0 + g * size)[:, None] - rest) / size[:, None]).T
        systems = slopes - creepages[:, :, None] * g
        change = np.linalg.solve(systems, (creepages - rest)[:, :, None])[:, :, 0]
        return self._moving(place, change)

    @staticmethod
    def _creepages(scene: Scene, place: Place, inputs: dict[str, Vector]) -> Vector:
        """Those of the patch, [n, 3]."""
        names = ["patches.creepage", "patches.spin_creepage"]
        states = solve_many(scene, inputs, threads=1, sequence=len(inputs["y"]), outputs=names)
        creepage, spin = (states[name][:, place.k] for name in names)
        return np.column_stack([creepage, spin])

    def _moving(self, place: Place, change: Vector) -> dict[str, Vector]:
        """Moving inputs for changes [n, 3] of pitch_rate, vy and yaw_rate."""
        found = {name: np.full(len(change), value) for name, value in place.at.items()}
        found["pitch_rate"] = place.rates["pitch_rate"] + change[:, 0]
        found["vy"], found["yaw_rate"] = change[:, 1], change[:, 2]
        for name, value in self._along(1.0).items():
            found[name] = SPEED + (value - SPEED) * change[:, 2] * place.arm
        return found

    def at_centre(self, place: Place, v: Vector) -> Vector:
        """Creepages about the reference, [n, 3], of v [n, 3] about the pressure's centre."""
        found = v * self.unit(place)
        found[:, 0] += found[:, 2] * place.centre[1]
        found[:, 1] -= found[:, 2] * place.centre[0]
        return found

    @staticmethod
    def grid(place: Place, fineness: tuple[int, int]) -> dict[str, Any]:
        """Of the full theory, for a place's shape."""
        elements, scale = fineness
        a, b = place.axes
        return {"elements": [elements, elements], "fitted": list(fitted_size(scale, a / b))}

    def natural(self, place: Place, count: int) -> tuple[Vector, float]:
        """Random creepages [count, 3] of running on straight and curved track, and a friction
        coefficient."""
        r = self.ranges
        size = np.exp(self.random.uniform(*np.log(r.creepage), (count, 2)))
        signs = self.random.choice([-1.0, 1.0], (count, 2))
        turn = self.random.uniform(-r.curvature, r.curvature, count) * self.speed
        found = np.zeros((count, 3))
        found[:, :2] = size * signs
        found[:, 2] = place.rest[2] + turn * place.motion[2, 2]
        return found, float(np.exp(self.random.uniform(*np.log(r.friction))))

    def solve(
        self, place: Place, creepages: Vector, method: dict[str, Any], grid: dict[str, Any],
        threads: int, friction: float | None = None, moved_on: list[int] | None = None,
        sequence: int | None = None,
    ) -> tuple[Vector, NDArray[np.bool_]]:  # fmt: skip
        """Forces [n, 2] over the bound and moment over c times it, about the reference, of a patch;
        and which are solved. friction: None is the case's; moved_on: elements of the grid whose
        creepages they are, None the one that solves; sequence: so many states go on from each
        other, None all."""
        # one after the other the pressure stays, and tractions begin near the last ones
        inputs = self.inputs(place, creepages, moved_on or grid["elements"])
        states = solve_many(
            self.scene(method, grid, friction, z=0.0), inputs, threads=threads,
            sequence=sequence or len(creepages),
        )  # fmt: skip
        k = place.k
        if k >= states["patches.status"].shape[1]:
            return np.zeros((len(creepages), 3)), np.zeros(len(creepages), bool)
        bound = (friction or self.friction) * states["patches.normal_force"][:, k]
        size = np.sqrt(np.prod(place.axes))
        moment = states["patches.spin_moment"][:, k] / size
        force = np.column_stack([states["patches.creep_force"][:, k], moment]) / bound[:, None]
        return force, states["patches.status"][:, k] == "converged"


def shape(x: Vector, y: Vector, pressure: Vector) -> tuple[Vector, Vector, Vector]:
    """Semi-axes, centre (m) and features of a pressure [ny, nx], see core/fast/shape_table.hpp."""
    share = pressure / pressure.sum()
    rows = share.sum(axis=1)
    centre = np.array([(share * x).sum(), (share * y[:, None]).sum()])
    across, along = (y - centre[1])[:, None], x - centre[0]

    def moment(i: int, j: int) -> float:
        return float((share * along**i * across**j).sum())

    step = [grid[1] - grid[0] if len(grid) > 1 else 0.0 for grid in (x, y)]
    own = [step[0] ** 2 / 12, step[1] ** 2 / 12]
    a, b = np.sqrt(5 * (moment(2, 0) + own[0])), np.sqrt(5 * (moment(0, 2) + own[1]))
    powers = ((0, 3), (0, 4), (1, 1), (2, 1), (2, 2), (4, 0))
    gathered = (rows**2).sum() * b / step[1]
    found = [np.log(a / b), *(moment(i, j) / (a**i * b**j) for i, j in powers), np.log(gathered)]
    return np.array([a, b]), centre, np.array(found)


def fall_of(pressure: Vector) -> float:
    """Least load of a row over that of the lesser of the greatest rows before and after it."""
    rows = pressure.sum(axis=1)
    rows = rows[np.flatnonzero(rows)[0] : np.flatnonzero(rows)[-1] + 1]
    before, after = np.maximum.accumulate(rows), np.maximum.accumulate(rows[::-1])[::-1]
    return float((rows / np.minimum(before, after)).min())
