"""Conditions of friction laws, plastic layers and surface temperature, computed again."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from railpatch.evidence.stress import laws
from railpatch.evidence.stress.half_space import Array, shifted
from railpatch.evidence.stress.liquids import boundary_of, greatest_of
from railpatch.evidence.stress.step import Finding, Step

# of values that follow from others by a formula
FORMULA = 1e-6


def friction_of(step: Step) -> Array:
    """-, [ny, nx], friction coefficient: of the law where it is constant, else the one given."""
    friction = step.case.friction
    assert friction is not None
    factor = laws.factors(friction, step["y"])[:, None] if friction.factor else 1.0
    fluid = step.case.fluid
    if fluid is not None and step.has("fluid_pressure") and step.case.method.tangential == "full":
        # what the liquid bears has none
        mu = (
            step["friction"] if friction.law != "coulomb" else boundary_of(fluid, friction.greatest)
        )
        pressure = step["pressure"]
        part = (pressure - step["fluid_pressure"]) / np.where(pressure > 0, pressure, 1.0)
        return mu * part * factor
    if fluid is not None:
        return np.full_like(step["pressure"], greatest_of(step)) * factor
    if friction.law == "coulomb":
        return np.full_like(step["pressure"], friction.greatest) * factor
    return step["friction"]


def bound_of(step: Step) -> Array:
    """Pa, [ny, nx], the most that the traction can be."""
    bound = friction_of(step) * step["pressure"]
    return np.minimum(bound, step["yield_stress"]) if step.has("yield_stress") else bound


def inelastic_findings(step: Step) -> Iterator[Finding]:
    """Those of the laws that the case has."""
    friction = step.case.friction
    assert friction is not None
    if friction.law != "coulomb":
        yield from friction_findings(step)
    if step.case.layer is not None and step.case.layer.is_plastic:
        yield from plastic_findings(step)
    if step.case.temperature is not None:
        yield from temperature_findings(step)


def upstream(step: Step, field: Array) -> Array:
    """Values in the element where the material was before, of a step in steady rolling."""
    return shifted(field, step.direction)


def friction_findings(step: Step) -> Iterator[Finding]:
    """The coefficient follows its law: from the slip's speed with memory, or the temperature."""
    friction = step.case.friction
    assert friction is not None
    contact = step.contact
    factor = laws.factors(friction, step["y"])[:, None]
    given = step["friction"][contact]
    least, most = laws.range_of(friction)
    ends = (np.broadcast_to(end * factor, contact.shape)[contact] for end in (least, most))
    low, high = ends
    outside = np.maximum(low - given, given - high).max()
    yield Finding("friction outside its law", float(outside) / max(most, 1e-300), FORMULA)
    if friction.memory_distance > 0 and step.regime != "steady_rolling":
        return  # the law's ends are all that is checked
    if friction.law == "temperature":
        wanted = laws.by_temperature(friction, step["temperature"].max(axis=0))
    else:
        speed = np.hypot(*step["micro_slip"]) * step.patch["rolling_speed"]
        wanted = laws.by_speed(friction, speed)
    if friction.memory_distance > 0:
        wanted = remembered(step, wanted)
        contact = gapless(step)
    error = np.abs(step["friction"] - wanted * factor)[contact].max(initial=0.0)
    # friction and temperature are solved in turn, to the tolerance
    limit = 10 * step.tolerance if friction.law == "temperature" else FORMULA
    yield Finding("friction law", float(error) / max(most, 1e-300), limit)


def remembered(step: Step, wanted: Array) -> Array:
    """-, the coefficient that follows the wanted one along a row, from the one at rest (report,
    section 4): mu = (d mu_before + D mu(s))/(d + D), D = max(s, s_0) dx/V."""
    friction = step.case.friction
    assert friction is not None
    rate = step.patch["rolling_speed"]
    speed = np.hypot(*step["micro_slip"]) * rate
    slid = np.maximum(speed, friction.memory_speed) * step.half_space.dx / rate
    distance = friction.memory_distance
    found, order = np.array(wanted), slice(None, None, -step.direction)
    carried = np.full(wanted.shape[0], float(laws.by_speed(friction, np.zeros(1))[0]))
    for i in range(wanted.shape[1])[order]:
        new = (distance * carried + slid[:, i] * wanted[:, i]) / (distance + slid[:, i])
        carried = np.where(step.contact[:, i], new, carried)
        found[:, i] = carried
    return found


def state_before(step: Step, name: str) -> Array:
    """A field of the same material one step before; in steady rolling, of the element upstream."""
    if step.regime == "steady_rolling":
        return upstream(step, step[name])
    if step.history is None:
        return np.zeros_like(step[name])
    elements = step.ahead / step.half_space.dx
    return shifted(step.history[name], elements)


def plastic_increment(step: Step) -> Array:
    """m, [2, ny, nx], plastic displacement of the step."""
    change = step["plastic_displacement"] - state_before(step, "plastic_displacement")
    return np.where(step.contact, change, 0.0)


def plastic_findings(step: Step) -> Iterator[Finding]:
    """Yield stress by the plastic displacement, which grows along the traction."""
    layer = step.case.layer
    assert layer is not None
    contact = step.contact
    traction = step["traction"][:, contact]
    size = np.hypot(*traction)
    stress, path = step["yield_stress"][contact], step["plastic_path"][contact]
    wanted = laws.yield_stress(layer, path)
    yield Finding("yield law", float((np.abs(stress - wanted) / wanted).max()), FORMULA)
    increment = plastic_increment(step)[:, contact]
    grown = np.hypot(*increment)
    highest = float(grown.max())
    if highest == 0:
        return
    work = (traction * increment).sum(axis=0)
    yield Finding(
        "plastic work", -float(work.min()) / max(float((size * grown).max()), 1e-300), FORMULA
    )
    # where there is an increment and no slip, the traction has the yield stress; friction that
    # falls with slip may end below it
    yields = (grown > FORMULA * highest) & (np.hypot(*step["micro_slip"][:, contact]) == 0)
    short = np.where(yields, (stress - size) / stress, 0.0)
    yield Finding("yield without its stress", float(short.max()), 10 * step.tolerance)
    if layer.plastic_rule == "magnitude":
        total = np.hypot(*step["plastic_displacement"])[contact]
        error = np.abs(path - total).max() / max(float(total.max()), 1e-300)
    else:
        before = state_before(step, "plastic_path")[contact]
        error = np.abs(path - before - grown).max() / max(float(path.max()), 1e-300)
    yield Finding("plastic path", float(error), FORMULA)


def temperature_findings(step: Step) -> Iterator[Finding]:
    """Temperatures are numbers, not below the bulk's; in steady rolling those of moving sources."""
    heat = step.case.temperature
    assert heat is not None
    temperature = step["temperature"][:, step.contact]
    coldest = min(heat.wheel, heat.rail)
    size = max(float(np.ptp(step["temperature"])), abs(heat.wheel - heat.rail), 1e-300)
    # rail and wheel exchange heat: between the two without friction
    yield Finding("below bulk temperature", (coldest - float(temperature.min())) / size, 1e-9)
    yield Finding(
        "greatest temperature",
        abs(step.patch["max_temperature"] - float(temperature.max())) / size,
        1e-9,
    )
    if step.regime == "steady_rolling" and heat.depth == 0 and step.patch["rolling_speed"] > 0:
        wanted = surface_temperature(step)
        error = np.abs(step["temperature"] - wanted)[:, gapless(step)]
        yield Finding("temperature", float(error.max(initial=0.0)) / size, FORMULA)


def gapless(step: Step) -> Array:
    """Elements in contact in rows whose contact has no gap, [ny, nx]."""
    edges = np.abs(np.diff(step.contact.astype(int), axis=1)).sum(axis=1)
    return step.contact & (edges <= 2)[:, None]


def heat_flux(step: Step) -> Array:
    """W/m^2, [ny, nx], that friction and the layer's plastic work give to both bodies.

    No element gives heat back; what that and the place of the spin term leave of friction's power,
    and what the elements' work leaves of the layer's plastic power, goes to them by their share.
    """
    layer = step.case.layer
    work = np.maximum(step.friction_work, 0.0)
    total = float(work.sum()) * step.area
    taken = max(step.patch["friction_power"], 0.0)
    flux = work * (taken / total) if total > 0 else work
    if layer is not None and layer.is_plastic:
        speed = step.patch["rolling_speed"]
        plastic = (step["traction"] * plastic_increment(step)).sum(axis=0)
        plastic = plastic * speed / step.rolled
        sum_of_it = float(plastic.sum()) * step.area
        if sum_of_it > 0:
            plastic = plastic * (step.patch["plastic_power"] / sum_of_it)
        flux = flux + layer.plastic_heat_fraction * plastic
    return flux


def surface_temperature(step: Step) -> Array:
    """Degrees C, [2, ny, nx] of wheel and rail in contact, of flux that is constant on elements.

    Carslaw and Jaeger 1959, section 2.9: columns that have been heated for the time x/V since the
    leading edge; a body takes heat by its effusivity, and both surfaces become equally warm.
    """
    heat = step.case.temperature
    assert heat is not None
    products = zip(heat.conductivity, heat.heat_capacity, heat.density, strict=True)
    wheel, rail = (float(np.sqrt(np.prod(values))) for values in products)
    mixed = (wheel * heat.wheel + rail * heat.rail) / (wheel + rail)
    flux = heat_flux(step)[:, :: -step.direction]  # from the leading edge on
    nx = flux.shape[1]
    # an element's work is that of its way from the one upstream: roots of the times since its ends
    # passed the centre of another one
    root = np.sqrt(np.arange(nx + 1))
    weight = 2 * np.sqrt(step.half_space.dx / (np.pi * step.patch["rolling_speed"]))
    kernel = weight * np.diff(root) / (wheel + rail)
    rise = np.array([np.convolve(row, kernel)[:nx] for row in flux])[:, :: -step.direction]
    return np.broadcast_to(mixed + rise, (2, *rise.shape))
