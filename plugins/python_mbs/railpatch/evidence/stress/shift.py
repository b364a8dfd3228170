"""The work of a step of shift, once more: elements stick first and slide then.

An element slides against its bound in the direction in which it ends (Mindlin and Deresiewicz
1953). One that slid that way before, or that has more traction than its bound is now, slides on by
the mean of both ends. The bound at the beginning of sliding lies between those of both ends, by the
part of slip in slip and elastic displacement.
"""

from __future__ import annotations

import numpy as np

from railpatch.evidence.stress.half_space import Array
from railpatch.evidence.stress.inelastic import friction_of, plastic_increment
from railpatch.evidence.stress.step import Step

AT_BOUND = 1 - 1e-6


def bounds(step: Step) -> tuple[Array, Array]:
    """Pa, [ny, nx], of friction, at the step's end and at its beginning."""
    last = step.history
    now = friction_of(step) * step["pressure"]
    # by the coefficient of now, also where it has changed
    return now, np.zeros_like(now) if last is None else friction_of(step) * last["pressure"]


def slides(step: Step) -> tuple[Array, Array]:
    """[2, ny, nx] each: tractions (Pa) that elements slide against, and their slip (m)."""
    now, before = step["traction"], step.traction_before
    bound, bound_before = bounds(step)
    left = ~step.contact & (before != 0).any(axis=0)
    slip = np.where(left, step.surface_slip, step["micro_slip"])
    size = np.hypot(*now)
    way = np.divide(now, size, out=np.zeros_like(now), where=size > 0)
    along = (before * way).sum(axis=0)
    on = (np.hypot(*before) >= AT_BOUND * bound_before) & (along > 0)
    on |= (along >= size) | (size == 0)
    lengths = np.hypot(*slip), np.hypot(*(step.displacement - step.displacement_before))
    part = np.divide(lengths[0], sum(lengths), out=np.zeros_like(size), where=lengths[0] > 0)
    against = way * (size + 0.5 * part * (bound_before - bound))
    return np.where(on, 0.5 * (now + before), against), slip


def rubbed_in_shift(step: Step) -> float:
    """J, what friction takes in the elements."""
    traction, slip = slides(step)
    return -float((traction * slip).sum()) * step.area


def beyond_the_mean(step: Step) -> float:
    """J, what a shift's rigid slip supplies beyond the mean of both ends' forces: nothing where it
    has none."""
    if not any(step.motion):
        return 0.0
    mean = 0.5 * (step["traction"] + step.traction_before)
    traction, slip = slides(step)
    found = float(((mean - traction) * slip).sum()) * step.area
    if step.has("plastic_displacement"):
        layer = float((mean * plastic_increment(step)).sum()) * step.area
        found += step.patch["plastic_power"] - layer
    return found
