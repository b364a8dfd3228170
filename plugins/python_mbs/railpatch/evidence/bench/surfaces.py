"""Patches of wheels on rails and rollers, as surfaces whose rows are parabolas.

They are made once (``python -m railpatch.evidence.bench.surfaces TABLE.csv OUTPUT.npz``) and stored
with the package, so that the problems stay what they are when the contact search changes. Sources:
S1002 on UIC60 at the positions of the Manchester benchmark A-2.2 (Shackleton and Iwnicki 2008),
whose roll angles and pitch rates TABLE holds, tests/published/data/manchester_a22_right.csv; and
nominal profiles of the NRC roller rig at the positions that balance them.
"""

from __future__ import annotations

import sys
from collections.abc import Iterator
from importlib import resources
from pathlib import Path
from typing import Any

import numpy as np

from railpatch import _core
from railpatch.case.load import Scene, load_scene
from railpatch.case.moving import changed_case
from railpatch.case.to_core import config_of, input_of
from railpatch.case.types import SIDES
from railpatch.evidence.bench.problems import FRICTION, Batch
from railpatch.evidence.bench.shapes import Floats, Surface
from railpatch.published import read_numbers

FILE = "patches.npz"
ELEMENT = (4e-4, 1e-4)  # m, of the grid on which wheel on rail is looked at
ACROSS = 100  # elements for finding the contact's box
LEAST_LOAD = 0.02  # of the wheel's: patches with less are left out
# creepages of the positions slide most patches; parts of them do not
PARTS = (1.0, 0.3, 0.1)
RIG_POSITIONS = 145  # of the whole run, 0.5 mrad apart
RIG_YAW = (0.0, 0.5, 1.0, 1.5, 2.0, 3.0, 4.0, 6.0, 10.0)  # mrad, these and their negatives


def stored_patches() -> list[Batch]:
    """The stored patches, one batch each."""
    with resources.files("railpatch.evidence.bench").joinpath(FILE).open("rb") as file:
        data = np.load(file)
        names = [str(name) for name in data["names"]]
        return [
            batch_of(name, {key: data[f"{key}_{i}"] for key in ("y", "rows", "numbers")})
            for i, name in enumerate(names)
        ]


def batch_of(name: str, data: dict[str, Floats]) -> Batch:
    """One patch from its arrays."""
    lx, ly, force, xi, eta, spin, speed, direction = (float(v) for v in data["numbers"])
    first, last, count = data["y"]
    return Batch(
        name=name,
        shape=Surface(np.linspace(first, last, int(count)), data["rows"].astype(float), (lx, ly)),
        normal_force=np.full(len(PARTS), force),
        creepage=np.outer(PARTS, (xi, eta)),
        spin=spin * np.array(PARTS),
        speed=speed,
        direction=int(direction),
    )


def manchester_states(table: str) -> Iterator[tuple[str, dict[str, Any]]]:
    """Positions of the benchmark, the right wheel's."""
    for row in read_numbers(table):
        yield (
            f"Manchester y = {row['y_ws_mm']:g} mm",
            {
                "y": 1e-3 * row["y_ws_mm"],
                "roll": row["roll_rad"],
                "yaw": row["yaw_rad"],
                "pitch_rate": row["pitch_rate_rad_s"],
            },
        )


MANCHESTER = {
    "kind": "wheel_rail",
    "wheelset": {
        "vertical_force": 1e4,
        "speed": 2.0,
        "nominal_radius": 0.46,
        "flange_back_distance": 1.36,
        "flange_back_position": -0.07,
    },
    "track": {"kind": "rail", "gauge": 1.435, "gauge_height": 0.014},
    "profiles": {"wheel": "S1002", "rail": "UIC60@1:40"},
    "wheel": {"side": "right"},
    "grid": {"element_size": list(ELEMENT)},
    "friction": {"coefficient": FRICTION},
}


def rig_states(scene: Any) -> Iterator[tuple[str, dict[str, Any]]]:
    """Balanced positions of a rig's scene at the yaw angles wanted, each once."""
    from rig_model.balance import Balancer

    balancer = Balancer(scene)
    wanted = {sign * yaw for yaw in RIG_YAW for sign in (1, -1)}
    for position in scene.positions():
        balance = balancer.solve(position)
        yaw = round(1e3 * position.yaw, 3)
        if yaw not in wanted:
            continue
        wanted.remove(yaw)
        if not balance.converged:
            raise ValueError(f"position {position.index} of {scene.name} is not balanced")
        yield (
            f"rig yaw = {yaw:+g} mrad",
            {
                "y": position.y,
                "yaw": position.yaw,
                "z": balance.z,
                "roll": balance.roll,
                "pitch_rate": balance.pitch_rate,
            },
        )


def patches_of(scene: Scene, states: Iterator[tuple[str, dict[str, Any]]]) -> Iterator[Batch]:
    """Every patch of some load at the given positions."""
    contact = _core.Contact(config_of(scene), False)
    for name, state in states:
        result = contact.step(input_of(changed_case(scene.case, state)))
        for side in scene.case.sides:
            patches = result[side]["patches"]
            load = sum(patch["normal_force"] for patch in patches)
            for index, patch in enumerate(patches):
                # one that no grid holds has neither force nor fields
                if not patch["normal_force"] >= LEAST_LOAD * load:
                    continue
                fields = {
                    key: contact.field(SIDES.index(side), index, key)
                    for key in ("x", "y", "undeformed_distance")
                }
                yield patch_batch(f"{name}, {side} {index + 1}", patch, fields)


def patch_batch(name: str, patch: dict[str, Any], fields: dict[str, Floats]) -> Batch:
    """A patch about the centre of its contact's box."""
    x, y = fields["x"], fields["y"]
    gap = fields["undeformed_distance"].reshape(len(y), len(x))
    rows = np.polynomial.polynomial.polyfit(x, gap.T, 2).T
    half = np.array([np.ptp(x), np.ptp(y)]) / 2
    surface = moved(Surface(y, rows, (half[0], half[1])), (x.mean(), y.mean()))
    centre = np.array([x.mean(), y.mean()])
    for _ in range(2):
        shift, half = contact_box(surface, patch["normal_force"])
        centre = centre + shift
        surface = moved(Surface(surface.y, surface.rows, (half[0], half[1])), shift)
    xi, eta = patch["creepage"]
    spin = patch["spin_creepage"]
    return Batch(
        name=name,
        shape=surface,
        normal_force=np.array([patch["normal_force"]]),
        # the same rigid slip seen from the box's centre
        creepage=np.array([[xi - spin * centre[1], eta + spin * centre[0]]]),
        spin=np.array([spin]),
        speed=patch["rolling_speed"],
        direction=patch["direction"],
    )


def moved(surface: Surface, to: tuple[float, float] | Floats) -> Surface:
    """The surface with its origin at x, y of the given one."""
    c0, c1, c2 = surface.rows.T
    x = to[0]
    rows = np.stack([c0 + c1 * x + c2 * x**2, c1 + 2 * c2 * x, c2], axis=1)
    return Surface(surface.y - to[1], rows, surface.half_size)


def contact_box(surface: Surface, force: float) -> tuple[Floats, Floats]:
    """m: centre and half-size of the box that bounds the contact."""
    case = {
        "kind": "patch",
        **surface.tables(ACROSS),
        "load": {"normal_force": force},
        "method": {"tangential": "none", "tolerance": 1e-7},
    }
    contact = _core.Contact(config_of(load_scene(case)), False)
    result = contact.step({"normal_force": force})
    if result["status"] != "converged":
        raise ValueError(f"normal problem: {result['status']}")
    x, y = contact.field(1, 0, "x"), contact.field(1, 0, "y")
    touching = contact.field(1, 0, "pressure").reshape(len(y), len(x)) > 0
    ends = [
        places[np.flatnonzero(touching.any(axis=axis))[[0, -1]]]
        for axis, places in ((0, x), (1, y))
    ]
    step = np.array([x[1] - x[0], y[1] - y[0]])
    ends = np.array(ends)
    return ends.mean(axis=1), (ends[:, 1] - ends[:, 0] + step) / 2


def main(table: str, output: str) -> None:
    """Makes the file of patches."""
    from rig_model.scene import NOMINAL, load_rig_scene, scenes

    batches = list(patches_of(load_scene(MANCHESTER), manchester_states(table)))
    rig = load_rig_scene(scenes() / NOMINAL, {"positions": RIG_POSITIONS})
    case = rig.at_height().case
    grid = case.grid.model_copy(update={"element_size": list(ELEMENT)})
    fine = Scene(case.model_copy(update={"grid": grid}), Path())
    batches += patches_of(fine, rig_states(rig))
    arrays: dict[str, Any] = {"names": np.array([batch.name for batch in batches])}
    for i, batch in enumerate(batches):
        arrays.update({f"{key}_{i}": value for key, value in arrays_of(batch).items()})
    np.savez_compressed(output, **arrays)


def arrays_of(batch: Batch) -> dict[str, Floats]:
    """One patch as arrays: see ``batch_of``."""
    surface = batch.shape
    assert isinstance(surface, Surface)
    # rows that the contact comes near to
    near = np.abs(surface.y) < 1.5 * surface.half_size[1] + 4 * ELEMENT[1]
    y = surface.y[near]
    numbers = [
        *surface.half_size,
        batch.normal_force[0],
        *batch.creepage[0],
        batch.spin[0],
        batch.speed,
        batch.direction,
    ]
    return {
        "y": np.array([y[0], y[-1], len(y)]),
        "rows": surface.rows[near].astype(np.float32),
        "numbers": np.array(numbers),
    }


if __name__ == "__main__":
    main(*sys.argv[1:])
