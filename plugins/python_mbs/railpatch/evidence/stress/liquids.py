"""Conditions of a liquid between the bodies, computed again; and random wet trials."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any

import numpy as np

from railpatch.case.fluid import Fluid
from railpatch.evidence.bench.problems import merged
from railpatch.evidence.stress.step import Finding, Step, curvatures_of
from railpatch.evidence.stress.trial import (
    METHODS,
    SAYS_SO,
    Move,
    Trial,
    expected,
    nominal,
)

COUNT, QUICK_COUNT = 3_000, 60
# of numbers that follow from others in closed form
FORMULA = 1e-9
# greatest of the shipped knots
REGIMES = 0.55
Random = np.random.Generator


def boundary_of(fluid: Fluid, dry: float) -> float:
    """-, of asperities that the liquid wets."""
    found = fluid.core.get("boundary_friction", fluid.boundary_friction)
    return dry if found is None else float(found)


def greatest_of(step: Step) -> float:
    """-, most that the friction coefficient can be, with a liquid or without."""
    fluid = step.case.fluid
    if fluid is None:
        assert step.case.friction is not None
        return step.case.friction.greatest
    if fluid.model == "regimes":
        return REGIMES if fluid.knots is None else max(knot[3] for knot in fluid.knots)
    return float(step.patch["effective_friction"])


def liquid_findings(step: Step) -> Iterator[Finding]:
    """Shares and friction within their ends; the film of an ellipse by its formula again."""
    fluid = step.case.fluid
    if fluid is None or fluid.model == "regimes":
        return
    patch = step.patch
    share, film = patch["mean_asperity_share"], patch["central_film_thickness"]
    dry = 0.0 if step.case.friction is None else step.case.friction.greatest
    most = max(boundary_of(fluid, dry), dry, fluid.limiting_friction)
    yield Finding("share of asperities above 1", share - 1, FORMULA)
    yield Finding("share of asperities below 0", -share, FORMULA)
    yield Finding("film below 0", -film, 1e-30)
    yield Finding("wet friction above its ends", patch["effective_friction"] - most, FORMULA)
    if fluid.model == "strip" and step.has("fluid_pressure"):
        liquid, pressure = step["fluid_pressure"], step["pressure"]
        unit = max(float(pressure.max()), 1e-300)
        yield Finding("liquid below 0", -float(liquid.min()) / unit, 1e-30)
        yield Finding("liquid above the load", float((liquid - pressure).max()) / unit, FORMULA)
    plain = fluid.model == "film" and fluid.share == "film_ratio" and fluid.starvation == 1
    given = fluid.viscosity is not None and fluid.liquid is None and fluid.oxide is None
    flooded = math.isnan(step.values.get("oil_film", math.nan)) and math.isnan(
        step.values.get("water_rate", math.nan)
    )
    if plain and given and flooded and step.case.geometry.semi_axes and patch["rolling_speed"] > 0:
        wanted = film_of(step)
        yield Finding("film by its formula", abs(film / wanted - 1), 1e-8)
        wanted = math.exp(-1.8 * (wanted / fluid.roughness) ** 1.2)
        yield Finding("share by its formula", abs(share - wanted), 1e-8)


def film_of(step: Step) -> float:
    """m, Nijenbanning, Venner and Moes 1994."""
    fluid, material = step.case.fluid, step.case.material
    assert fluid is not None
    rx, ry = (0.5 / c for c in curvatures_of(step))
    # of both bodies: (1 - nu^2)/E = (1 - nu)/(2 G)
    sides = zip(material.shear_modulus, material.poisson_ratio, strict=True)
    modulus = 2 / sum((1 - nu) / (2 * g) for g, nu in sides)
    u = fluid.viscosity * 2 * step.patch["rolling_speed"] / (modulus * rx)
    n = step.patch["normal_force"] / (modulus * rx**2) * u**-0.75
    alpha = fluid.core["pressure_coefficient"] * modulus * u**0.25
    d = rx / ry
    k = 1 + 0.006 * math.log(d) + 0.63 * d ** (4 / 7)
    ri = 145 * (1 + 0.796 * d ** (14 / 15)) ** (-15 / 7) / d / n**2
    ei = 3.18 * k ** (-14 / 25) * d ** (-1 / 15) * n ** (-2 / 15)
    rp = 1.29 * (1 + 0.691 * d) ** (-2 / 3) * alpha ** (2 / 3)
    ep = 1.48 * k ** (-7 / 20) * d ** (-1 / 24) * n ** (-1 / 12) * alpha**0.75
    s = 1.5 * (1 + math.exp(-1.2 * ei / ep))
    i = (ri**1.5 + (ei**-4 + (1.8 / d) ** -4) ** (-3 / 8)) ** (2 / 3)
    return float((i**s + (rp**-8 + ep**-8) ** (-s / 8)) ** (1 / s) * rx * math.sqrt(u))


def between(random: Random, low: float, high: float) -> float:
    """Between two positive numbers, evenly in the logarithm."""
    return float(np.exp(random.uniform(np.log(low), np.log(high))))


def wet_mixture(seed: int, number: int) -> Trial:
    """The wet trial with this number: 0.01 to 150 m/s, roughness 10 nm to 10 um, layers of 1 nm to
    10 um, -10 (water 0) to 100 degrees C, loads from 100 N."""
    random = np.random.default_rng([seed, 21, number])
    method = str(random.choice(["full", "fitted rows", "linear", "polach", "fastsim", "table"]))
    model = str(random.choice(["film", "strip", "regimes"], p=[0.55, 0.3, 0.15]))
    if model == "regimes":
        method = "polach"
    force = between(random, 100.0, 3e5)
    ratio = between(random, 0.2, 5.0)
    size = 0.006 * float(np.cbrt(force / 1e5)) * between(random, 0.7, 1.5)
    axes = [size * ratio**0.5, size / ratio**0.5]
    angle, creepage = random.uniform(0, 2 * np.pi), between(random, 1e-6, 0.3)
    motion = {
        "creepage": [creepage * float(np.cos(angle)), creepage * float(np.sin(angle))],
        "rolling_speed": between(random, 0.01, 150.0),
        "direction": int(random.choice([-1, 1])),
    }
    if random.random() < 0.3:
        motion["spin_creepage"] = float(random.uniform(-2, 2))
    case = nominal(
        {"geometry": {"semi_axes": axes}, "load": {"normal_force": force}},
        {"friction": {"coefficient": float(random.uniform(0.1, 0.7))}, "motion": motion},
    )
    case = merged(case, METHODS[method])
    if random.random() < 0.4 and method not in ("fitted rows",):
        case = merged(case, {"method": {"normal": "hertz"}})
    if method == "full":
        count = round(between(random, 6, 26))
        case["grid"] = {"elements": [count, count]}
    case["fluid"], words = liquid(random, model)
    if model == "regimes":  # a knot's friction is its own
        del case["friction"]["coefficient"]
    moves = [Move({}, statuses_of(method))]
    for _ in range(int(random.choice([0, 1, 2]))):
        changes: dict[str, Any] = {"rolling_speed": between(random, 0.01, 150.0)}
        if model == "film" and random.random() < 0.5 and "water_rate" not in case["fluid"]:
            changes["oil_film"] = between(random, 1e-9, 1e-5)
        if words != "given" and model != "regimes":
            changes["water_temperature"] = temperature(random, words)
        moves.append(Move(changes, statuses_of(method)))
    return Trial("wet", f"{number}: {model}, {words}", case, tuple(moves))


def statuses_of(method: str) -> tuple[str, ...]:
    """Statuses: the linear theory ends where friction with a liquid does, soon."""
    return SAYS_SO if method == "linear" else expected(method)


def temperature(random: Random, words: str) -> float:
    """degrees C, of what is a liquid then."""
    return float(random.uniform(0 if words == "water" else -10, 100))


def liquid(random: Random, model: str) -> tuple[dict[str, Any], str]:
    """The table [fluid], and in a word what the viscosity is."""
    if model == "regimes":
        rate = 0.0 if random.random() < 0.1 else between(random, 1e-12, 1e-3)
        return {"model": model, "water_rate": rate}, "water"
    found: dict[str, Any] = {"model": model, "roughness": between(random, 1e-8, 1e-5)}
    words = str(random.choice(["water", "given", "oil"]))
    if words != "given":
        found |= {"liquid": words, "temperature": temperature(random, words)}
    if words != "water":
        found["viscosity"] = between(random, 3e-4, 3.0)
    if random.random() < 0.7:
        found["boundary_friction"] = float(random.uniform(0.05, 0.3))
    if random.random() < 0.2:
        found["oxide"] = {"solid_content": float(random.uniform(0, 0.6))}
    if model == "film":
        found["share"] = str(random.choice(["film_ratio", "load_sharing"]))
        if random.random() < 0.2:
            found["water_rate"] = between(random, 1e-12, 1e-3)
        if random.random() < 0.2 and words != "given":
            found["inlet_heating"] = True
        if found["share"] == "load_sharing" and random.random() < 0.3:
            found["mean_pressure"] = "contact"
    return found, words
