"""Damage of one patch: element by element, or by its wear number."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from railpatch.case.asked import Damage
from railpatch.damage.laws import archard, fatigue_index, usfd, whole_life

Array = NDArray[np.float64]
ROWS = 40  # of a patch without elements
MOST_SCALE = 2.0  # of the elements' work; what is more lies behind the trailing edge
# names and units of what a patch's damage holds; kg/m is per metre rolled
UNITS = {
    "wear_rate": "kg/m",
    "wheel_depth_rate": "",
    "rail_depth": "m",
    "fatigue_index": "",
    "stress_index": "Pa",
    "whole_life_damage": "",
    "work_scale": "",
}


def moved(values: Array, by: int) -> Array:
    """[..., nx], a column further along x (by = 1) or back (-1); 0 comes in."""
    found = np.zeros_like(values)
    if by > 0:
        found[..., 1:] = values[..., :-1]
    else:
        found[..., :-1] = values[..., 1:]
    return found


def work_of(fields: dict[str, Any], direction: int) -> Array:
    """N/m^2, [ny, nx]: work of friction by metre rolled and area, >= 0.

    An element's traction works over the slips at both of its ends: that of its own way from
    upstream, and that of the way on, which is its neighbour's; behind the trailing edge, where
    fields hold none, it goes on straight.
    """
    traction, slip = fields["traction"], fields["micro_slip"]
    touching = fields["pressure"] > 0
    downstream = -1 if direction > 0 else 1
    after, inside = moved(slip, -downstream), moved(touching, -downstream)
    behind = np.where(moved(touching, downstream), 2 * slip - moved(slip, downstream), slip)
    after = np.where(inside, after, behind)
    return np.where(touching, np.maximum(-(traction * (slip + after)).sum(axis=0) / 2, 0.0), 0.0)


def scaled_work(
    fields: dict[str, Any], direction: int, power: float, speed: float, area: float
) -> tuple[Array, float | None]:
    """Work of elements of an area (m^2), as work_of() has it, whose sum is power (W) over speed,
    and the factor that makes it so.

    Where nearly all sticks, fields hold next to no slip: friction works as material leaves the
    contact, which takes what is beyond MOST_SCALE. Its slip there gives its displacement back and
    goes with its traction, so that the work goes with that one's square.
    """
    work = work_of(fields, direction)
    given = power / speed if speed > 0 else 0.0
    summed = float(work.sum()) * area
    scale = given / summed if summed > 0 else math.inf
    work = min(scale, MOST_SCALE) * work
    if scale <= MOST_SCALE or not given > 0:
        return work, scale if math.isfinite(scale) else None
    touching = fields["pressure"] > 0
    leaves = touching & ~moved(touching, 1 if direction > 0 else -1)
    share = np.where(leaves, (np.asarray(fields["traction"]) ** 2).sum(axis=0), 0.0)
    if not (total := float(share.sum())) > 0:
        return work, None
    return work + share * ((given - float(work.sum()) * area) / (total * area)), MOST_SCALE


def damage_of(
    patch: dict[str, Any],
    law: Damage,
    radius: float,
    *,
    left: bool,
    direction: int,
    speed: float,
    fast: bool = False,
) -> tuple[dict[str, Any], dict[str, Array]]:
    """Numbers of a patch, and by row what wears.

    patch: a result with fields where the law asks for elements. radius: m, on which the wheel
    rolls, NaN: unknown, and no depth of the wheel. direction: of rolling. speed: m/s, of rolling.
    fast: the tractions are a fast theory's, whose work is what its forces take.
    Rows: s: m, lateral in the contact frame; wheel, rail: m, y in the axes of each profile, which a
    patch given by itself has not; height: m, across each row; wear: kg/m^2, mass by metre rolled
    and by width of the row.

    wear_rate: kg/m, mass that each body loses by metre rolled. wheel_depth_rate: -, greatest depth
    by metre rolled, round the wheel. rail_depth: m, greatest depth of one passage. work_scale: -,
    by which the elements' work was multiplied so that its sum is friction_power over the speed, of
    a fast theory creep_power; None by the patch, and without work. stress_index: Pa; None of
    theories without tractions.
    """
    elements = law.basis == "elements"
    if elements:
        power = max(patch["creep_power" if fast else "friction_power"], 0.0)
        found, table = _rows_of_elements(patch, law, direction, speed, power)
    else:
        found, table = _rows_of_patch(patch, law, speed)
    depth = table["wear"] / law.worn_density  # m, of one passage
    greatest = float(depth.max()) if depth.size else 0.0
    numbers = {
        "wear_rate": float((table["wear"] * table["height"]).sum()),
        "wheel_depth_rate": greatest / (math.tau * radius) if radius > 0 else None,
        "rail_depth": greatest,
        "fatigue_index": fatigue_index(patch["traction_coefficient"], patch["max_pressure"], law),
        "whole_life_damage": whole_life(patch["wear_number"], law),
        **found,
    }
    # the profiles' y axes go from the flange outward: on the left against the contact frame's s
    across = (-1 if left else 1) * math.cos(patch.get("contact_angle", 0.0))
    for body in ("wheel", "rail"):
        if (at := patch.get(f"{body}_profile_position")) is not None and math.isfinite(at[0]):
            table[body] = at[0] + across * table["s"]
    return numbers, table


def _rows_of_elements(
    patch: dict[str, Any], law: Damage, direction: int, speed: float, power: float
) -> tuple[dict[str, Any], dict[str, Array]]:
    x, y = np.asarray(patch["x"]), np.asarray(patch["y"])
    dx = abs(x[1] - x[0]) if len(x) > 1 else patch["contact_size"][0]
    dy = abs(y[1] - y[0]) if len(y) > 1 else patch["contact_size"][1]
    work, scale = scaled_work(patch, direction, power, speed, dx * dy)
    pressure = np.asarray(patch["pressure"])
    if law.wear == "usfd":
        wear = usfd(work, law)
    else:
        slip = np.hypot(*np.asarray(patch["micro_slip"]))
        wear = archard(pressure, slip, speed, law)
    size = np.hypot(*np.asarray(patch["traction"]))
    found = {
        "stress_index": float((size - law.shear_yield).max()),
        "work_scale": scale,
        "fields": {"work": work, "wear": wear, "stress_index": size - law.shear_yield},
    }
    table = {"s": y, "height": np.full(len(y), dy), "wear": wear.sum(axis=1) * dx}
    return found, table


def _rows_of_patch(
    patch: dict[str, Any], law: Damage, speed: float
) -> tuple[dict[str, Any], dict[str, Array]]:
    """The patch's mean over its width as half an ellipse, by the work or pressure of all of it."""
    area, width = patch["contact_area"], patch["contact_size"][1]
    greatest = patch["max_traction"]
    known = greatest is not None and math.isfinite(greatest)
    found = {"stress_index": greatest - law.shear_yield if known else None, "work_scale": None}
    s = (np.arange(ROWS) + 0.5) / ROWS - 0.5
    chord = np.sqrt(1.0 - (2 * s) ** 2)
    if not area > 0:
        zeros = np.zeros(ROWS)
        return found, {"s": zeros, "height": zeros, "wear": zeros}
    creepage = math.hypot(*patch["creepage"])
    if law.wear == "usfd":
        wear = float(usfd(patch["wear_number"] / area, law))
    else:
        mean = patch["normal_force"] / area
        rate = archard(patch["max_pressure"], creepage, speed, law)
        wear = float(rate) * mean / patch["max_pressure"]
    height = np.full(ROWS, width / ROWS)
    shape = chord / (chord * height).sum()
    table = {"s": s * width, "height": height, "wear": wear * area * shape}
    return found, table
