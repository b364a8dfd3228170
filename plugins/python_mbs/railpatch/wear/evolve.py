"""Wheel profiles that wear, step by step: solve the mix, lay its wear over the profiles, smooth it,
take it off, and again.

A step is so long that no place loses more than ``largest_depth``. Wear is taken off along z: depth
over the way is the mass by width over density and circumference. The rail stays as it is.
"""

from __future__ import annotations

import json
import math
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from railpatch.case.load import Scene, check_case
from railpatch.contact import Contact
from railpatch.damage.distribution import Distribution
from railpatch.errors import CaseError
from railpatch.profiles import load_profile
from railpatch.profiles.pairing.conicity import equivalent_conicity
from railpatch.profiles.pairing.contact_points import Dimensions, contact_points, positions
from railpatch.result import SOLVED
from railpatch.wear.plan import WearPlan
from railpatch.writing import write_whole

Array = NDArray[np.float64]
STATE = "wear.json"
READ = {"unit": "m", "swap": False, "mirror": "none", "origin": [0.0, 0.0]}
HEAD = "# wheel profile, right-hand orientation, z down\n# y, z in m\n"


def wear_profiles(
    plan: WearPlan, folder: str | Path, *, progress: Callable[[float], None] | None = None
) -> list[dict[str, Any]]:
    """Runs, or goes on with what the folder holds; returns a row for each profile.

    folder gets wear.json with the rows and a file of each wheel's profile for each of them. A row:
    distance (m), profiles (by side), mass (kg, of each wheel, in all), balance (-, volume taken off
    the profiles over that of the mass, less 1), depth (m, greatest in all), conicity (equivalent,
    NaN as None), y_over_q (greatest of the mix). progress: of the part that is done.
    Raises CaseError.
    """
    folder = Path(folder)
    rows = _begun(plan, folder)
    while rows[-1]["distance"] < plan.table.distance:
        rows.append(_step(plan, folder, rows[-1]))
        _keep(plan, folder, rows)
        if progress is not None:
            progress(min(1.0, rows[-1]["distance"] / plan.table.distance))
    if rows[-1]["y_over_q"] is None:
        # what the last profiles do
        _, rows[-1]["y_over_q"] = _solve(plan, folder, rows[-1])
        _keep(plan, folder, rows)
    return rows


def _sides(plan: WearPlan) -> tuple[str, ...]:
    return check_case(plan.mix.case(plan.mix.points[0])).sides


def _begun(plan: WearPlan, folder: Path) -> list[dict[str, Any]]:
    """Rows so far: those of the folder, or the new profiles."""
    state = folder / STATE
    if state.is_file():
        kept = json.loads(state.read_text(encoding="utf-8"))
        if kept.get("mark") != plan.mark:
            raise CaseError(f"--output: {folder} holds another wear run, allowed the same or none")
        return kept["rows"]
    folder.mkdir(parents=True, exist_ok=True)
    case = check_case(plan.mix.case(plan.mix.points[0]))
    profiles = {}
    for side in case.sides:
        source = getattr(case.profiles, f"wheel_{side}") or case.profiles.wheel
        reading = case.profiles.wheel_file.reading if case.profiles.wheel_file else None
        found = load_profile(source, "wheel", smoothing=case.profiles.smoothing, reading=reading)
        profiles[side] = _write(folder, side, 0, found.y, found.z)
    first = {
        "distance": 0.0,
        "profiles": profiles,
        "mass": dict.fromkeys(case.sides, 0.0),
        "balance": 0.0,
        "depth": 0.0,
        "conicity": _conicity(plan, folder, profiles),
        "y_over_q": None,
    }
    _keep(plan, folder, [first])
    return [first]


def _keep(plan: WearPlan, folder: Path, rows: list[dict[str, Any]]) -> None:
    content = {"mark": plan.mark, "rows": rows}
    write_whole(folder / STATE, (json.dumps(content, indent=1) + "\n").encode())


def _write(folder: Path, side: str, number: int, y: Array, z: Array) -> str:
    name = f"wheel_{side}_{number:04d}.csv"
    lines = "".join(f"{a:.9f},{b:.9f}\n" for a, b in zip(y, z, strict=True))
    write_whole(folder / name, (HEAD + lines).encode())
    return name


def read_points(path: Path) -> tuple[Array, Array]:
    """m, y and z of a profile's file as it was written."""
    points = np.loadtxt(path, delimiter=",", comments="#")
    return points[:, 0], points[:, 1]


def _worn_case(plan: WearPlan, folder: Path, point: Any, profiles: dict[str, str]) -> Any:
    content = plan.mix.case(point)
    named = {k: v for k, v in content["profiles"].items() if not k.startswith("wheel")}
    for side, name in profiles.items():
        named[f"wheel_{side}"] = str((folder / name).resolve())
    if len(profiles) == 1:
        [name] = profiles.values()
        named = {k: v for k, v in named.items() if not k.startswith("wheel")}
        named["wheel"] = str((folder / name).resolve())
    content["profiles"] = {**named, "wheel_file": READ}
    return check_case(content)


def _solve(
    plan: WearPlan, folder: Path, row: dict[str, Any]
) -> tuple[dict[str, Distribution], float | None]:
    """Wear of each wheel by metre run, and the greatest Y/Q of the mix."""
    found = {side: Distribution() for side in row["profiles"]}
    quotients = []
    for number, (point, share) in enumerate(zip(plan.mix.points, plan.shares, strict=True)):
        contact = Contact(Scene(_worn_case(plan, folder, point, row["profiles"]), Path()))
        result = contact.step()
        if result.status not in SOLVED:
            raise CaseError(f"case {number} of the mix is {result.status}: {result.reason}")
        for side, parts in contact.wear_rows().items():
            for of_wheel, rows in parts:
                found[side].add(rows, share, of_wheel)
            wheel = result[side] if len(found) > 1 else result.data
            quotients.append(wheel["derailment_quotient"])
    known = [value for value in quotients if math.isfinite(value)]
    return found, max(known, default=None)


def smoothed(depth: Array, spacing: float, deviation: float) -> Array:
    """Convolved with a bell curve of that standard deviation (m); the sum stays."""
    if not deviation > 0:
        return depth
    reach = math.ceil(5 * deviation / spacing)
    bell = np.exp(-0.5 * (np.arange(-reach, reach + 1) * spacing / deviation) ** 2)
    return np.convolve(depth, bell / bell.sum(), mode="same")


def take_off(y: Array, z: Array, at: Array, depth: Array) -> Array:
    """z (m, down) of a wheel's profile less a depth over y, from the flange's tip on."""
    tip = int(np.argmax(z))
    step = np.interp(y, at, depth)
    step[:tip] = np.minimum(step[:tip], step[tip]) if tip else step[:tip]
    return z - step


def volume_of(y: Array, before: Array, after: Array) -> float:
    """m^2, of the section taken off, from the flange's tip on."""
    tip = int(np.argmax(before))
    order = np.argsort(y[tip:])
    return float(np.trapezoid((before - after)[tip:][order], y[tip:][order]))


def _step(plan: WearPlan, folder: Path, row: dict[str, Any]) -> dict[str, Any]:
    table = plan.table
    found, row["y_over_q"] = _solve(plan, folder, row)
    case = check_case(plan.mix.case(plan.mix.points[0]))
    density, round_ = case.damage.worn_density, math.tau * case.wheelset.nominal_radius
    any_one = next(iter(found.values()))
    spacing = any_one.y[1] - any_one.y[0]
    depths = {
        side: smoothed(one.depth("wheel", density, round_), spacing, table.smoothing)
        for side, one in found.items()
    }
    masses = {side: one.mass("wheel") for side, one in found.items()}
    if table.alike and len(depths) > 1:
        mean = sum(depths.values()) / len(depths)
        depths = dict.fromkeys(depths, mean)
        masses = dict.fromkeys(masses, sum(masses.values()) / len(masses))
    greatest = max(float(depth.max()) for depth in depths.values())
    way = table.distance - row["distance"]
    if greatest > 0:
        way = min(way, table.largest_depth / greatest)
    if table.largest_step is not None:
        way = min(way, table.largest_step)
    number = int(next(iter(row["profiles"].values()))[-8:-4]) + 1
    profiles, errors, deepest = {}, [], 0.0
    for side, depth in depths.items():
        y, z = read_points(folder / row["profiles"][side])
        worn = take_off(y, z, any_one.y, way * depth)
        profiles[side] = _write(folder, side, number, y, worn)
        new = read_points(folder / f"wheel_{side}_0000.csv")[1]
        deepest = max(deepest, float((new - worn).max()))
        wanted = way * masses[side] / (density * round_)
        errors.append(volume_of(y, z, worn) / wanted - 1 if wanted > 0 else 0.0)
    return {
        "distance": row["distance"] + way,
        "profiles": profiles,
        "mass": {side: row["mass"][side] + way * masses[side] for side in masses},
        "balance": max(errors, key=abs),
        "depth": deepest,
        "conicity": _conicity(plan, folder, profiles),
        "y_over_q": None,
    }


def _conicity(plan: WearPlan, folder: Path, profiles: dict[str, str]) -> float | None:
    """Equivalent one of the right wheel's profile, or of the one there is, on both sides."""
    case = _worn_case(plan, folder, plan.mix.points[0], profiles)
    if case.track.kind != "rail":
        return None
    side = "right" if "right" in profiles else next(iter(profiles))
    rail = getattr(case.profiles, f"rail_{side}") or case.profiles.rail
    sizes = Dimensions(
        nominal_radius=case.wheelset.nominal_radius,
        flange_back_distance=case.wheelset.flange_back_distance,
        flange_back_position=case.wheelset.flange_back_position,
        gauge=case.track.gauge,
        gauge_height=case.track.gauge_height,
    )
    y = positions(plan.table.amplitude + 2e-3, 1e-4)
    found = contact_points(
        folder / profiles[side],
        rail,
        y,
        sizes,
        readings={"wheel": case.profiles.wheel_file.reading},
    )
    difference = found.rolling_radius_difference
    if not np.isfinite(difference).all():
        return None  # the wheel leaves the rail within the wave
    value = equivalent_conicity(y, difference, plan.table.amplitude)
    return value if math.isfinite(value) else None
