"""The cases and paths that are swept."""

from __future__ import annotations

import copy
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

from railpatch.contact import Contact
from railpatch.evidence.continuity.sweep import Path

MICRO = 1e-6
GRIDS: dict[str, dict[str, Any]] = {
    "24 x 24": {"grid": {"elements": [24, 24]}},
    "0.5 mm": {"grid": {"element_size": [5e-4, 5e-4]}},
    "0.2 mm": {"grid": {"element_size": [2e-4, 2e-4]}},
    "fitted 12 x 12": {"grid": {"element_size": [5e-4, 5e-4], "fitted": [12, 12]}},
    "hertz, fastsim": {
        "grid": {"elements": [24, 24]},
        "method": {"normal": "hertz", "tangential": "fastsim"},
    },
}
RADIUS, SPEED = 0.46, 20.0  # m, m/s
DRIVEN = 1.0005  # circumferential over forward speed at the nominal radius


@dataclass(frozen=True)
class Scene:
    """A case, how it is named, and its path; load: N, of all wheels."""

    name: str
    grid: str
    case: dict[str, Any]
    path: Path
    load: float


def wheel_case(load: float, wheels: int = 1) -> dict[str, Any]:
    """One wheel or both under a load (N, of a wheel) at 20 m/s, driven a little."""
    case: dict[str, Any] = {
        "kind": "wheel_rail" if wheels == 1 else "wheelset",
        "wheelset": {
            "vertical_force": load * wheels,
            "speed": SPEED,
            "pitch_rate": -SPEED / RADIUS * DRIVEN,
            "nominal_radius": RADIUS,
            "flange_back_distance": 1.36,
            "flange_back_position": -0.07,
        },
        "track": {"gauge": 1.435, "gauge_height": 0.014},
        "profiles": {"wheel": "S1002", "rail": "UIC60@1:40"},
        "friction": {"coefficient": 0.3},
    }
    return case


def with_grid(case: dict[str, Any], grid: str) -> dict[str, Any]:
    """The case with one of the grids and theories."""
    changed = copy.deepcopy(case)
    for table, values in GRIDS[grid].items():
        changed[table] = {**changed.get(table, {}), **copy.deepcopy(values)}
    return changed


def lateral(name: str = "y", start: float = -0.012, stop: float = 0.012, **fixed: Any) -> Path:
    """y in steps of 10 and 1 micrometres."""
    return Path(name, lambda y: {"y": y, **fixed}, start, stop, 10 * MICRO, MICRO)


def yaw(y: float = 0.0) -> Path:
    """Yaw in steps of 20 and 2 microradians, about 1.5 micrometres at the wheel."""

    def changes(angle: float) -> dict[str, Any]:
        return {"yaw": angle, "y": y}

    name = f"yaw, y = {1e3 * y:g} mm"
    return Path(name, changes, -0.03, 0.03, 20 * MICRO, 2 * MICRO, "yaw [mrad]")


def lifting(case: dict[str, Any], y: float) -> Path:
    """z from 0.1 mm above first contact to where the wheel bears its load."""
    z = Contact(case).step(y=y)["z"]

    def changes(at: float) -> dict[str, Any]:
        return {"z": at, "y": y}

    name = f"z, y = {1e3 * y:g} mm"
    return Path(name, changes, z - 2e-4, z, 5 * MICRO, MICRO, "z [mm]")


def at_height(case: dict[str, Any]) -> dict[str, Any]:
    """The case with z given in place of the force."""
    changed = copy.deepcopy(case)
    changed["wheelset"].pop("vertical_force")
    changed["wheelset"]["z"] = 0.0
    return changed


def standstill() -> Path:
    """Speed through zero, below 1 mm/s and above, while the wheel moves sideways a little."""

    def changes(speed: float) -> dict[str, Any]:
        return {"speed": speed, "pitch_rate": -speed / RADIUS * DRIVEN, "vy": 2 * MICRO, "y": 0.004}

    name = "speed through standstill"
    return Path(name, changes, -3e-3, 3e-3, 10 * MICRO, MICRO, "speed [mm/s]")


def scenes(quick: bool = False) -> Iterator[Scene]:
    """All that is measured; quick: one wheel under a light load, on the cheapest grid."""
    for grid in ["24 x 24"] if quick else GRIDS:
        for load in (1e4,) if quick else (1e4, 8e4):
            case = with_grid(wheel_case(load), grid)
            name = f"one wheel, {1e-3 * load:g} kN"
            yield Scene(name, grid, case, lateral(), load)
            yield Scene(name, grid, case, lateral("y, yaw 12 mrad", yaw=0.012), load)
            yield Scene(name, grid, at_height(case), lifting(case, 0.005), load)
            yield Scene(name, grid, case, standstill(), load)
            if not quick:
                yield Scene(name, grid, case, yaw(0.005), load)
    if not quick:
        case = with_grid(wheel_case(1e4, 2), "24 x 24")
        yield Scene("both wheels, 10 kN each", "24 x 24", case, lateral(), 2e4)
