"""The cases and paths that are swept."""

from __future__ import annotations

import copy
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

from railpatch.continuity.sweep import Path

MICRO = 1e-6
GRIDS: dict[str, dict[str, Any]] = {
    "0.5 mm": {"grid": {"element_size": [5e-4, 5e-4]}},
    "0.2 mm": {"grid": {"element_size": [2e-4, 2e-4]}},
    "24 x 24": {"grid": {"elements": [24, 24]}},
    "fitted 12 x 12": {"grid": {"element_size": [5e-4, 5e-4], "fitted": [12, 12]}},
    "hertz, fastsim": {
        "grid": {"elements": [24, 24]},
        "method": {"normal": "hertz", "tangential": "fastsim"},
    },
}
RADIUS = 0.46  # m


@dataclass(frozen=True)
class Scene:
    """A case, how it is named, and its paths."""

    name: str
    grid: str
    case: dict[str, Any]
    path: Path


def wheel_case(load: float, *, wheels: int = 1, wheel: str = "S1002", rail: str = "UIC60@1:40"):
    """One wheel or both under a load (N, of a wheel) at 20 m/s, driven a little."""
    case: dict[str, Any] = {
        "kind": "wheel_rail" if wheels == 1 else "wheelset",
        "wheelset": {
            "vertical_force": load * wheels,
            "speed": 20.0,
            "pitch_rate": -20.0 / RADIUS * 1.0005,
            "nominal_radius": RADIUS,
            "flange_back_distance": 1.36,
            "flange_back_position": -0.07,
        },
        "track": {"gauge": 1.435, "gauge_height": 0.014},
        "profiles": {"wheel": wheel, "rail": rail},
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
    """Yaw in steps of 10 and 1 microradians, about 0.75 micrometres at the wheel."""
    changes = lambda angle: {"yaw": angle, "y": y}  # noqa: E731
    name = f"yaw, y = {1e3 * y:g} mm"
    return Path(name, changes, -0.03, 0.03, 20 * MICRO, MICRO, "yaw [mrad]")


def lifting(case: dict[str, Any], y: float, lift: float = 1e-4, press: float = 2e-4) -> Path:
    """z from above first touch to below the loaded position (found first)."""
    from railpatch.contact import Contact

    z = Contact(case).step(y=y)["z"]
    return Path(
        f"z, y = {1e3 * y:g} mm",
        lambda at: {"z": at, "y": y},
        z - press - lift,
        z + 2e-5,
        10 * MICRO,
        MICRO,
        "z [mm]",
    )


def at_height(case: dict[str, Any]) -> dict[str, Any]:
    """The case with z given; its load remains as what forces are compared with."""
    changed = copy.deepcopy(case)
    changed["wheelset"].pop("vertical_force")
    changed["wheelset"]["z"] = 0.0
    return changed


def standstill(radius: float = RADIUS) -> Path:
    """Speed through zero with a slip that stays: 1 and 10 micrometres a second, V0 = 1 mm/s."""

    def changes(speed: float) -> dict[str, Any]:
        slip = 2 * MICRO
        return {"speed": speed, "pitch_rate": -speed / radius * 1.0005, "vy": slip, "y": 0.004}

    return Path("speed through standstill", changes, -3e-3, 3e-3, 10 * MICRO, MICRO, "speed [mm/s]")


def scenes(quick: bool = False) -> Iterator[Scene]:
    """All that is measured; quick: one wheel under a light load."""
    light, heavy = wheel_case(1e4), wheel_case(8e4)
    for grid in list(GRIDS)[: 1 if quick else None]:
        case = with_grid(light, grid)
        yield Scene("S1002 on UIC60, 10 kN", grid, case, lateral())
        if quick:
            continue
        yield Scene("S1002 on UIC60, 10 kN", grid, case, lateral("y, yaw 12 mrad", yaw=0.012))
        yield Scene("S1002 on UIC60, 80 kN", grid, with_grid(heavy, grid), lateral())
        yield Scene("S1002 on UIC60, 80 kN", grid, with_grid(heavy, grid), yaw(0.005))
        yield Scene("S1002 on UIC60, 10 kN", grid, case, yaw(0.005))
        yield Scene("S1002 on UIC60, 10 kN", grid, case, standstill())
