"""Profiles of wheels and rails that wear, step by step: solve the mix, lay its wear over the
profiles, smooth it, take it off, and again.

A step is so long that no place loses more than ``largest_depth``. Wear is taken off along z: depth
over the way is the mass by width over density and circumference; of a rail, mass by width and metre
over density, times the passages.
"""

from __future__ import annotations

import json
import math
from collections.abc import Callable
from concurrent.futures.process import BrokenProcessPool
from contextlib import nullcontext
from dataclasses import dataclass
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
from railpatch.sweep.local import pool_of
from railpatch.wear.plan import WearPlan
from railpatch.writing import write_whole

Array = NDArray[np.float64]
STATE = "wear.json"
READ = {"unit": "m", "swap": False, "mirror": "none", "origin": [0.0, 0.0]}
# of a row: where each body's files and masses are
FILES = {"wheel": "profiles", "rail": "rails"}
MASSES = {"wheel": "mass", "rail": "rail_mass"}


@dataclass(frozen=True)
class Part:
    """What one case of the mix does in its share of the way: wear by side, greatest Y/Q."""

    wear: dict[str, Distribution]
    quotient: float | None


def wear_profiles(
    plan: WearPlan,
    folder: str | Path,
    *,
    workers: int = 1,
    progress: Callable[[float], None] | None = None,
) -> list[dict[str, Any]]:
    """Runs, or goes on with what the folder holds; returns a row for each profile.

    folder gets wear.json with the rows and a file of each profile that wears for each of them. A
    row: of wheels that wear distance (m), profiles (by side), mass (kg, of each wheel, in all); of
    rails that wear passages, rails (files by side), rail_mass (kg/m, in all); balance (-, volume
    taken off the profiles over that of the mass, less 1), depth (m, greatest in all), conicity
    (equivalent, NaN as None), y_over_q (greatest of the mix). workers: processes that solve the
    mix; the rows are the same with any number of them. progress: of the part that is done.
    Raises CaseError.
    """
    folder = Path(folder)
    rows = _begun(plan, folder)
    try:
        with pool_of(workers) if workers > 1 else nullcontext() as pool:
            _wear(plan, folder, rows, map if pool is None else pool.map, progress)
    except BrokenProcessPool:
        raise CaseError(
            f"--workers: one of {workers} ended, by a signal or for want of memory; steps that are"
            f" done are in {folder}, and the same call goes on there"
        ) from None
    return rows


def _wear(
    plan: WearPlan,
    folder: Path,
    rows: list[dict[str, Any]],
    solve: Any,
    progress: Callable[[float], None] | None,
) -> None:
    """Adds rows until all is worn. solve: as map()."""
    while _way(plan, rows[-1]) < plan.table.total:
        rows.append(_step(plan, folder, rows[-1], solve))
        _keep(plan, folder, rows)
        if progress is not None:
            progress(min(1.0, _way(plan, rows[-1]) / plan.table.total))
    if rows[-1]["y_over_q"] is None:
        # what the last profiles do
        _, rows[-1]["y_over_q"] = _solve(plan, folder, rows[-1], solve)
        _keep(plan, folder, rows)


def _way(plan: WearPlan, row: dict[str, Any]) -> float:
    """m, or passages where no wheel wears."""
    return row["distance"] if "wheel" in plan.table.worn else row["passages"]


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
    first: dict[str, Any] = {}
    if "wheel" in plan.table.worn:
        first["distance"] = 0.0
    if "rail" in plan.table.worn:
        first["passages"] = 0.0
    for body in plan.table.worn:
        files = first[FILES[body]] = {}
        first[MASSES[body]] = dict.fromkeys(case.sides, 0.0)
        for side in case.sides:
            source, reading = case.profiles.of(body, side)[1], case.profiles.reading(body)
            assert source is not None
            found = load_profile(source, body, smoothing=case.profiles.smoothing, reading=reading)
            files[side] = _write(folder, body, side, 0, found.y, found.z)
    first |= {"balance": 0.0, "depth": 0.0, "conicity": None, "y_over_q": None}
    first["conicity"] = _conicity(plan, folder, first)
    _keep(plan, folder, [first])
    return [first]


def _keep(plan: WearPlan, folder: Path, rows: list[dict[str, Any]]) -> None:
    content = {"mark": plan.mark, "rows": rows}
    write_whole(folder / STATE, (json.dumps(content, indent=1) + "\n").encode())


def _write(folder: Path, body: str, side: str, number: int, y: Array, z: Array) -> str:
    name = f"{body}_{side}_{number:04d}.csv"
    head = f"# {body} profile, right-hand orientation, z down\n# y, z in m\n"
    lines = "".join(f"{a:.9f},{b:.9f}\n" for a, b in zip(y, z, strict=True))
    write_whole(folder / name, (head + lines).encode())
    return name


def read_points(path: Path) -> tuple[Array, Array]:
    """m, y and z of a profile's file as it was written."""
    points = np.loadtxt(path, delimiter=",", comments="#")
    return points[:, 0], points[:, 1]


def _worn_content(plan: WearPlan, folder: Path, point: Any, row: dict[str, Any]) -> dict[str, Any]:
    """A case of the mix with the row's profiles."""
    content = plan.mix.case(point)
    named = dict(content["profiles"])
    for body in plan.table.worn:
        named = {k: v for k, v in named.items() if not k.startswith(body)}
        files = {side: str((folder / name).resolve()) for side, name in row[FILES[body]].items()}
        if len(files) == 1:
            [named[body]] = files.values()
        else:
            named |= {f"{body}_{side}": file for side, file in files.items()}
        named[f"{body}_file"] = READ
    content["profiles"] = named
    return content


def solve_part(job: tuple[int, float, dict[str, Any]]) -> Part:
    """One case of the mix: its number, its share of the way, its content. Raises CaseError."""
    number, share, content = job
    case = check_case(content)
    contact = Contact(Scene(case, Path()))
    result = contact.step()
    if result.status not in SOLVED:
        raise CaseError(f"case {number} of the mix is {result.status}: {result.reason}")
    wear = {side: Distribution() for side in case.sides}
    quotients = []
    for side, parts in contact.wear_rows().items():
        for of_wheel, rows in parts:
            wear[side].add(rows, share, of_wheel)
        wheel = result[side] if len(wear) > 1 else result.data
        quotients.append(wheel["derailment_quotient"])
    known = [value for value in quotients if math.isfinite(value)]
    return Part(wear, max(known, default=None))


def _solve(
    plan: WearPlan, folder: Path, row: dict[str, Any], solve: Any
) -> tuple[dict[str, Distribution], float | None]:
    """Wear of each side by metre run, and the greatest Y/Q of the mix."""
    mix = zip(plan.mix.points, plan.shares, strict=True)
    jobs = [
        (number, share, _worn_content(plan, folder, point, row))
        for number, (point, share) in enumerate(mix)
    ]
    found: dict[str, Distribution] = {}
    quotients = []
    for part in solve(solve_part, jobs):
        for side, one in part.wear.items():
            found.setdefault(side, Distribution()).merge(one)
        if part.quotient is not None:
            quotients.append(part.quotient)
    return found, max(quotients, default=None)


def smoothed(depth: Array, spacing: float, deviation: float) -> Array:
    """Convolved with a bell curve of that standard deviation (m); the sum stays."""
    if not deviation > 0:
        return depth
    reach = math.ceil(5 * deviation / spacing)
    bell = np.exp(-0.5 * (np.arange(-reach, reach + 1) * spacing / deviation) ** 2)
    return np.convolve(depth, bell / bell.sum(), mode="same")


def take_off(y: Array, z: Array, at: Array, depth: Array, body: str = "wheel") -> Array:
    """z (m, down) of a profile less a depth over y: of a wheel from the flange's tip on, of a rail
    its head, beyond whose widest places the points go along with these."""
    step = np.interp(y, at, depth)
    if body == "rail":
        first, last = np.sort([int(np.argmin(y)), int(np.argmax(y))])
        step[:first], step[last + 1 :] = step[first], step[last]
        return z + step
    tip = int(np.argmax(z))
    step[:tip] = np.minimum(step[:tip], step[tip]) if tip else step[:tip]
    return z - step


def volume_of(y: Array, before: Array, after: Array, body: str = "wheel") -> float:
    """m^2, of the section taken off: of a wheel from the flange's tip on, of a rail's head."""
    if body == "rail":
        first, last = np.sort([int(np.argmin(y)), int(np.argmax(y))])
        kept, lost = slice(first, last + 1), after - before
    else:
        kept, lost = slice(int(np.argmax(before)), None), before - after
    order = np.argsort(y[kept])
    return float(np.trapezoid(lost[kept][order], y[kept][order]))


@dataclass(frozen=True)
class Rate:
    """What a body loses by way: depth (m, over the bins' y) and mass, by side."""

    depth: dict[str, Array]
    mass: dict[str, float]  # kg of a wheel, kg/m of a rail, by m or passage
    section: float  # kg/m^2 of a wheel, kg/m^3 of a rail: mass over the section's area


def _rate(plan: WearPlan, body: str, found: dict[str, Distribution], case: Any) -> Rate:
    """By metre of the wheels' way, or by passage where no wheel wears."""
    table, density = plan.table, case.damage.worn_density
    round_ = math.tau * case.wheelset.nominal_radius if body == "wheel" else 1.0
    times = 1.0 if body == "wheel" else table.passages_by_way
    depths, masses = {}, {}
    for side, one in found.items():
        spacing = one.y[1] - one.y[0]
        depths[side] = times * smoothed(one.depth(body, density, round_), spacing, table.smoothing)
        masses[side] = times * one.mass(body)
    alike = table.alike if body == "wheel" else table.rails_alike
    if alike and len(depths) > 1:
        mean = sum(depths.values()) / len(depths)
        depths = dict.fromkeys(depths, mean)
        masses = dict.fromkeys(masses, sum(masses.values()) / len(masses))
    return Rate(depths, masses, density * round_)


def _step(plan: WearPlan, folder: Path, row: dict[str, Any], solve: Any) -> dict[str, Any]:
    table = plan.table
    case = check_case(plan.mix.case(plan.mix.points[0]))
    found, row["y_over_q"] = _solve(plan, folder, row, solve)
    at = next(iter(found.values())).y
    rates = {body: _rate(plan, body, found, case) for body in table.worn}
    greatest = max(float(d.max()) for rate in rates.values() for d in rate.depth.values())
    way = table.total - _way(plan, row)
    if greatest > 0:
        way = min(way, table.largest_depth / greatest)
    if table.largest_step is not None:
        way = min(way, table.largest_step)
    new = _worn(plan, folder, row, rates, way, at)
    return new | {"conicity": _conicity(plan, folder, new), "y_over_q": None}


def _worn(
    plan: WearPlan, folder: Path, row: dict[str, Any], rates: dict[str, Rate], way: float, at: Array
) -> dict[str, Any]:
    """A row and its files, a way after another row with these rates. at: m, y of the bins."""
    new: dict[str, Any] = {}
    if "wheel" in plan.table.worn:
        new["distance"] = row["distance"] + way
    if "rail" in plan.table.worn:
        new["passages"] = row["passages"] + way * plan.table.passages_by_way
    errors, deepest = [], 0.0
    for body, rate in rates.items():
        files = new[FILES[body]] = {}
        number = int(next(iter(row[FILES[body]].values()))[-8:-4]) + 1
        for side, depth in rate.depth.items():
            y, z = read_points(folder / row[FILES[body]][side])
            worn = take_off(y, z, at, way * depth, body)
            files[side] = _write(folder, body, side, number, y, worn)
            first = read_points(folder / f"{body}_{side}_0000.csv")[1]
            deepest = max(deepest, float(np.abs(first - worn).max()))
            wanted = way * rate.mass[side] / rate.section
            if wanted > 0:
                errors.append(volume_of(y, z, worn, body) / wanted - 1)
        before = row[MASSES[body]]
        new[MASSES[body]] = {side: before[side] + way * m for side, m in rate.mass.items()}
    return new | {"balance": max(errors, key=abs, default=0.0), "depth": deepest}


def _conicity(plan: WearPlan, folder: Path, row: dict[str, Any]) -> float | None:
    """Equivalent one of the right wheel's profile on its rail, or of the side there is, on both."""
    case = check_case(_worn_content(plan, folder, plan.mix.points[0], row))
    if case.track.kind != "rail":
        return None
    side = "right" if "right" in case.sides else case.sides[0]
    wheel, rail = (case.profiles.of(body, side)[1] for body in ("wheel", "rail"))
    assert wheel is not None
    assert rail is not None
    sizes = Dimensions(
        nominal_radius=case.wheelset.nominal_radius,
        flange_back_distance=case.wheelset.flange_back_distance,
        flange_back_position=case.wheelset.flange_back_position,
        gauge=case.track.gauge,
        gauge_height=case.track.gauge_height,
    )
    y = positions(plan.table.amplitude + 2e-3, 1e-4)
    files = {"wheel": case.profiles.wheel_file, "rail": case.profiles.rail_file}
    readings: Any = {body: table.reading for body, table in files.items() if table is not None}
    found = contact_points(wheel, rail, y, sizes, readings=readings)
    difference = found.rolling_radius_difference
    if not np.isfinite(difference).all():
        return None  # the wheel leaves the rail within the wave
    value = equivalent_conicity(y, difference, plan.table.amplitude)
    return value if math.isfinite(value) else None
