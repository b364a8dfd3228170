"""Forces and accelerations of a vehicle beside the limits of EN 14363:2016.

Forces are means over 2 m of way; Y and Y/Q are outward, a wheelset's sum of Y is by its size. The
standard takes percentiles of 99.85 % in sections of track and estimates from many of them; here the
whole run is one section, and its percentile is the one that the run itself found, of its kept
steps. A run that found none is not assessed: its greatest values stand beside the limits. These are
of every time step, of the logged ones where the log has no others. Loads at rest are those that the
log has. The standard measures accelerations on the floor and filters them; here they are those of a
body's centre, as logged.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from railpatch.case.types import SIDES
from railpatch.errors import ProfileError
from railpatch.page.parts import BAD, GOOD, PLAIN, Key
from railpatch.page.parts import against as judged
from railpatch.page.tables import short
from railpatch.profiles import load_profile
from railpatch.profiles.shape import shape_of
from railpatch.report.scene import friction_of, scene_of
from railpatch.report.vehicle.data import VehicleRun, Wheel

Array = np.ndarray

LEAST_WAY = 52.0  # m, that percentiles ask for: 50 m of means over 2 m
LEAST_RATE = 100.0  # Hz, of kept steps, likewise
RATIO = 0.8  # Y/Q
# N: Prud'homme's limit of the sum of Y is 10 kN and a third of the static axle load
PRUDHOMME, AXLE_PART = 10e3, 3.0
# N: Q may be 90 kN above the static load, and by speed in km/h at most
ABOVE_STATIC = 90e3
MOST = ((160.0, 200e3), (200.0, 190e3), (250.0, 180e3), (300.0, 170e3), (np.inf, 160e3))
UNLOADING = 0.6  # of the static load
# m/s^2, root mean squares of ride characteristics of passenger vehicles: lateral, vertical
RIDE = (0.5, 0.75)
AXES = ("lateral", "vertical")
# of the table: names with their signs, as the panels of figures.py have them, and units
COLUMNS = (("Y outward", " [kN]"), ("Q", " [kN]"), ("Y/Q outward", ""), ("|sum of Y|", " [kN]"))


@dataclass(frozen=True)
class Spread:
    """Percentile of 99.85 % as EN 14363 counts it, and the greatest one, of the same sign; NaN
    where nothing is known."""

    percentile: float
    most: float

    @property
    def compared(self) -> float:
        """What stands beside a limit: the greatest one where there is no percentile."""
        return self.percentile if np.isfinite(self.percentile) else self.most


def counted(data: VehicleRun) -> bool:
    """Whether the run found percentiles as EN 14363 counts them."""
    return bool(data.assessment.get("places"))


def greatest(values: Array) -> float:
    """Of what is known; NaN of none."""
    known = values[np.isfinite(values)]
    return float(known.max()) if known.size else float("nan")


def static_load(data: VehicleRun, number: int) -> float:
    """N, of an axle at rest; of a log without it the mean over the run of both wheels' loads."""
    known = data.assessment.get("static_load")
    if known:
        return float(known[number - 1])
    return float(np.nanmean(sum(data.loads[number, side] for side in SIDES)))


def ratio_spread(data: VehicleRun, wheel: Wheel) -> Spread:
    """Of Y/Q, Y outward."""
    return _spread(data, "derailment", _place(wheel), lambda: data.ratio(wheel))


def guiding_spread(data: VehicleRun, wheel: Wheel) -> Spread:
    """N, of Y, outward: below 0 where it never was."""
    return _spread(data, "outward_guiding_force", _place(wheel), lambda: data.mean_guiding[wheel])


def load_spread(data: VehicleRun, wheel: Wheel) -> Spread:
    """N, of Q."""
    return _spread(data, "load", _place(wheel), lambda: data.mean_loads[wheel])


def sum_spread(data: VehicleRun, number: int) -> Spread:
    """N, of a wheelset's sum of Y, by size."""
    return _spread(data, "shift", number - 1, lambda: np.abs(sum_of_guiding(data, number)))


def least_load(data: VehicleRun, wheel: Wheel) -> float:
    """N, of Q."""
    known = data.assessment.get("least_load")
    return float(known[_place(wheel)] if known else np.nanmin(data.mean_loads[wheel]))


def unloading(data: VehicleRun, wheel: Wheel) -> float:
    """-, share of a wheel's load at rest, a half of its axle's, that its least is below it."""
    return 1 - 2 * least_load(data, wheel) / static_load(data, wheel[0])


def _place(wheel: Wheel) -> int:
    """Of a wheel in the log's lists."""
    return 2 * (wheel[0] - 1) + SIDES.index(wheel[1])


def _spread(data: VehicleRun, name: str, place: int, logged: Callable[[], Array]) -> Spread:
    """As the run found it, the greatest one else of what was logged."""
    percentile, most = (data.assessment.get(key) for key in (name, f"most_{name}"))
    return Spread(
        float(percentile[place]) if percentile else float("nan"),
        float(most[place]) if most else greatest(logged()),
    )


def sum_of_guiding(data: VehicleRun, number: int) -> Array:
    """N, [n]: sum of Y of a wheelset; both are outward."""
    return data.mean_guiding[number, "left"] - data.mean_guiding[number, "right"]


def sum_limit(data: VehicleRun, number: int) -> float:
    """N, Prud'homme's, with the scene's factor."""
    factor = (scene_of(data.run).get("run") or {}).get("shift_factor", 1.0)
    return float(factor) * (PRUDHOMME + static_load(data, number) / AXLE_PART)


def load_limit(data: VehicleRun, number: int) -> float:
    """N, of Q."""
    speed = 3.6 * float(np.nanmax(data.state["speed"]))
    if not np.isfinite(speed):
        speed = 0.0
    most = next(load for upto, load in MOST if speed <= upto + 0.5)
    return min(ABOVE_STATIC + static_load(data, number) / 2, most)


def nadal(data: VehicleRun) -> tuple[float, float, float]:
    """Nadal's (tan g - f)/(1 + f tan g), the flange angle g in rad, and friction f; NaN where the
    wheel's profile or the friction is not known."""
    friction, _ = friction_of(data.run)
    name = (scene_of(data.run).get("profiles") or {}).get("wheel")
    try:
        shape = shape_of(load_profile(name, "wheel")) if isinstance(name, str) else None
    except (ProfileError, OSError):
        shape = None
    if shape is None or not np.isfinite(friction):
        return float("nan"), float("nan"), friction
    # from the flange's tip to the tread the wheel rises; behind the tip it falls
    angle = float((-shape.slope).max())
    tangent = np.tan(angle)
    return float((tangent - friction) / (1 + friction * tangent)), angle, friction


def ride(data: VehicleRun) -> tuple[str, tuple[float, float]]:
    """Name of the first body, and root mean squares of its lateral and vertical acceleration about
    their means, m/s^2."""
    values = data.bodies["bodies[0].acceleration"] if data.body_names() else np.empty(0)
    if values.ndim != 2:
        return "", (float("nan"), float("nan"))
    name = data.body_names()[0].replace("_", " ")
    known = data.assessment.get("acceleration_rms")
    lateral, vertical = known or (float(np.nanstd(values[:, axis])) for axis in (1, 2))
    return name, (lateral, vertical)


def key_numbers(data: VehicleRun) -> list[Key]:
    """Of all wheels, each beside its limit."""
    keys = []
    ratios = {wheel: ratio_spread(data, wheel).compared for wheel in data.contact}
    keys.append(_key(data, "Y/Q", ratios, dict.fromkeys(ratios, RATIO), 1.0, ""))
    sums = {(n, ""): sum_spread(data, n).compared for n in data.wheelsets}
    limits = {(n, ""): sum_limit(data, n) for n in data.wheelsets}
    keys.append(_key(data, "sum of Y, a wheelset", sums, limits, 1e-3, " kN"))
    loads = {wheel: load_spread(data, wheel).compared for wheel in data.contact}
    most = {wheel: load_limit(data, wheel[0]) for wheel in loads}
    keys.append(_key(data, "wheel load Q", loads, most, 1e-3, " kN"))
    lifted = {wheel: unloading(data, wheel) for wheel in data.contact}
    limits = dict.fromkeys(lifted, UNLOADING)
    keys.append(_key(data, "wheel unloading", lifted, limits, 100.0, " %"))
    name, found = ride(data)
    for axis, value, limit in zip(AXES, found, RIDE, strict=True):
        if np.isfinite(value):
            note, state = against(data, value, limit, f"{limit:g} m/s², {name}")
            keys.append(Key(f"{axis} acceleration, rms", f"{short(value)} m/s²", note, state))
    return keys


def against(data: VehicleRun, value: float, limit: float, text: str) -> tuple[str, str]:
    """Note and state of a number beside its limit. One of a run without percentiles is within
    nothing: it may be above a limit."""
    note, state = judged(value, limit, text)
    return (
        (note, state) if counted(data) or state == BAD else (f"not assessed: limit {text}", PLAIN)
    )


def _key(
    data: VehicleRun,
    name: str,
    values: dict[tuple[int, str], float],
    limits: dict[tuple[int, str], float],
    factor: float,
    unit: str,
) -> Key:
    """The one that is nearest to its limit, or above it."""
    shares = {wheel: value / limits[wheel] for wheel, value in values.items()}
    known = {wheel: share for wheel, share in shares.items() if np.isfinite(share)}
    if not known:
        return Key(name, "-", "not known")
    worst = max(known, key=lambda wheel: known[wheel])
    where = f"wheelset {worst[0]} {worst[1]}".strip()
    text = f"{short(factor * limits[worst])}{unit}, {where}"
    note, state = against(data, values[worst], limits[worst], text)
    return Key(name, f"{short(factor * values[worst])}{unit}", note, state)


def verdict(data: VehicleRun, keys: list[Key]) -> tuple[str, str]:
    """In a sentence or two, and its state."""
    above = [key.name for key in keys if key.state == BAD]
    if not counted(data):
        return _not_assessed(data, above), BAD if above else PLAIN
    if above:
        return f"Above the limits of EN 14363: {'; '.join(above)}.", BAD
    if all(key.state == PLAIN for key in keys):
        return "Nothing in this log can be held against a limit.", PLAIN
    return "All that this page holds against EN 14363 stays within its limits.", GOOD


def _not_assessed(data: VehicleRun, above: list[str]) -> str:
    """Why there is no assessment, and what stands beside the limits in its place."""
    way = way_of(data)
    if way < LEAST_WAY:
        why = f"{short(way)} m of way are too short for what it counts ({LEAST_WAY:g} m)"
    else:
        why = f"the run found no percentiles, of steps kept at {LEAST_RATE:g} Hz or more"
    said = (
        f"No assessment by EN 14363: {why}. What stands beside its limits is the greatest value on "
        "this way, of accelerations the root mean square: no pass and no fail."
    )
    return f"{said} Above a limit already: {'; '.join(above)}." if above else said


def way_of(data: VehicleRun) -> float:
    """m, that the log has."""
    return float(data.along[-1] - data.along[0])


def rows(data: VehicleRun) -> list[list[object]]:
    """Y, Q, Y/Q of each wheel and the sum of Y of its wheelset, as head() names them."""
    found, counts = [], counted(data)
    for number in data.wheelsets:
        total = sum_spread(data, number)
        for side in SIDES:
            wheel = number, side
            columns = (
                (guiding_spread(data, wheel), 1e-3),
                (load_spread(data, wheel), 1e-3),
                (ratio_spread(data, wheel), 1.0),
                (total, 1e-3),
            )
            cells: list[object] = [f"{number} {side}"]
            for one, factor in columns:
                cells += [short(factor * one.percentile)] if counts else []
                cells.append(short(factor * one.most))
            found.append(cells)
    return found


def head(data: VehicleRun) -> list[str]:
    """Of the table of rows(): of each quantity with its sign its percentile, where the run found
    them, and its greatest value."""
    found = ["wheel"]
    for name, unit in COLUMNS:
        found += [f"{name} 99.85 %{unit}"] if counted(data) else []
        found.append(f"{name} most{unit}")
    return found
