"""Trials with a history, a plastic layer, other friction laws, or temperature."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

from railpatch.evidence.stress.half_space import HalfSpace
from railpatch.evidence.stress.trial import (
    CREEPAGE,
    FORCE,
    FRICTION,
    MODULUS,
    NO_CONTACT,
    POISSON,
    PRESSURE,
    SAYS_SO,
    SEMI_AXIS,
    SPIN,
    Move,
    Trial,
    moves,
    nominal,
)

ELEMENTS = 24
STEP = 2 * SEMI_AXIS / ELEMENTS  # m, of an element
# m: displacement at which all slides (Cattaneo 1938): 3 mu F (2 - nu)/(16 a G)
SLIDING = 3 * FRICTION * FORCE * (2 - POISSON) / (16 * SEMI_AXIS * MODULUS)
SHIFTS = (1e-9, 1e-3, 0.5, 0.99, 1.0, 3.0, 1e3)  # of sliding
DISTANCES = (0.1, 0.5, 1.0, 2.0, 7.3, 24.0, 240.0)  # elements; a contact is 24 long
# of minus the inverse self-compliance (softening), and of the elastic slope (hardening)
SOFTENING = (0.5, 0.999, 1.001, 2.0, 10.0)
HARDENING = (1e-3, 1.0, 1e4)
YIELDS = (1e-4, 1e-2, 0.3, 1.0, 10.0)  # of the greatest traction bound
REGIMES = ("shift", "transient_rolling", "steady_rolling")
LAYER = {"shear_modulus": 8.2e9, "thickness": 5e-5}


def inelastic_trials(quick: bool) -> Iterator[Trial]:
    """All of them; quick: fewer of each."""
    yield from shifts()
    yield from transients(quick)
    yield from plastic(quick)
    yield from laws(quick)
    yield from temperatures()


def moving(regime: str, size: float, steps: int = 1) -> dict[str, Any]:
    """[motion] of so much of saturation, in the regime's own units."""
    if regime == "shift":
        return {"motion": {"regime": regime, "creepage": [size * SLIDING, 0.0], "steps": steps}}
    motion: dict[str, Any] = {"regime": regime, "creepage": [size * CREEPAGE, 0.0]}
    if regime == "transient_rolling":
        motion |= {"distance": 2 * STEP * steps, "steps": steps}
    return {"motion": motion}


def shifts() -> Iterator[Trial]:
    """Displacement without rolling: loading, reversal, load changes, none at all."""
    for size in SHIFTS:
        there, back = [size * SLIDING, 0.0], [-2 * size * SLIDING, 0.0]
        yield Trial(
            "shift", f"{size:g} of sliding, twice, then back", nominal(moving("shift", size)),
            moves({}, {"creepage": there}, {"creepage": back}, {"creepage": [0.0, 0.0]}),
        )  # fmt: skip
        yield Trial(
            "shift", f"{size:g} of sliding across, and turned",
            nominal({"motion": {"regime": "shift", "creepage": [0.0, size * SLIDING],
                                "spin_creepage": size * SLIDING / SEMI_AXIS}}),
            moves({}, {"creepage": there}, {"spin_creepage": -size * SLIDING / SEMI_AXIS}),
        )  # fmt: skip
    held = nominal(moving("shift", 0.5))
    yield Trial(
        "shift", "load times 100, over 100", held,
        moves({}, {"normal_force": 100 * FORCE}, {"normal_force": FORCE},
              {"normal_force": 0.01 * FORCE, "creepage": [0.0, 0.0]}),
    )  # fmt: skip
    yield Trial(
        "shift", "1 m", nominal({"motion": {"regime": "shift", "creepage": [1.0, 0.0]}}),
        moves({}, {"creepage": [-1.0, 0.0]}),
    )  # fmt: skip
    for share in (0.0, 0.5, 0.99, 0.999):
        motion = {
            "motion": {
                "regime": "shift", "creepage": None,
                "tangential_force": [share * FRICTION * FORCE, 0.0],
            }
        }  # fmt: skip
        back = {"tangential_force": [-share * FRICTION * FORCE, 0.0]}
        yield Trial(
            "shift", f"force {share:g} of saturation, and reversed", nominal(motion),
            moves({}, back),
        )  # fmt: skip
    lifted = nominal(curved(approach=1e-4), moving("shift", 0.5))
    yield Trial("shift", "contact lost and regained", lifted, lost_and_regained())


def curved(**load: float) -> dict[str, Any]:
    """Given curvatures on elements of one size, with an approach (m) or a force (N)."""
    curvature = 3.0 * FORCE * (1 - POISSON) / (8 * MODULUS * SEMI_AXIS**3)
    return {
        "geometry": {"semi_axes": None, "curvatures": [curvature, curvature]},
        "grid": {"elements": None, "element_size": [STEP, STEP], "max_elements": [40, 40]},
        "load": {"normal_force": None, **load},
    }


def lost_and_regained() -> tuple[Move, ...]:
    """Approaches: in contact, apart, in contact again, hardly, and back."""
    return (Move(), Move({"approach": -1e-5}, NO_CONTACT), Move({"approach": 1e-4}), Move(),
            Move({"approach": 5e-6}), Move({"approach": 1e-4}))  # fmt: skip


def transients(quick: bool) -> Iterator[Trial]:
    """Steps from a tenth of an element to ten contact lengths, loads, reversal."""
    for elements in DISTANCES:
        for size in (0.01, 0.5, 3.0):
            case = nominal({"motion": {"regime": "transient_rolling", "steps": 1,
                                       "distance": elements * STEP,
                                       "creepage": [size * CREEPAGE, 0.3 * size * CREEPAGE],
                                       "spin_creepage": 0.2 * size * SPIN}})  # fmt: skip
            yield Trial(
                "transient", f"steps of {elements:g} elements, {size:g} of saturation", case,
                moves({}, {}, {}, {"direction": -1}, {}, {"creepage": [0.0, 0.0]}),
            )  # fmt: skip
    base = nominal(moving("transient_rolling", 0.5))
    yield Trial(
        "transient", "load times 100, over 100", base,
        moves({}, {"normal_force": 100 * FORCE}, {}, {"normal_force": FORCE}, {},
              {"normal_force": 0.01 * FORCE}, {}),
    )  # fmt: skip
    yield Trial(
        "transient", "steps that change", base,
        moves(*({"distance": size * STEP} for size in (0.1, 240.0, 1e-6, 1.0, 24.0, 1e-3))),
    )  # fmt: skip
    yield Trial(
        "transient", "creepage turned about", base,
        moves({}, {"creepage": [-100 * CREEPAGE, 0.0]}, {"creepage": [1e-12, 0.0]},
              {"creepage": [0.0, 1.0]}, {"spin_creepage": 100 * SPIN}),
    )  # fmt: skip
    yield Trial(
        "transient", "standstill and on", base,
        moves({}, {"rolling_speed": 0.0}, {"rolling_speed": 10.0}, {"rolling_speed": 1e-6}),
    )  # fmt: skip
    lifted = nominal(curved(approach=1e-4), moving("transient_rolling", 0.5))
    yield Trial("transient", "contact lost and regained", lifted, lost_and_regained())
    count = 10 if quick else 60
    yield Trial("transient", f"{count} steps to the steady state", base, moves(*[{}] * count))
    for share in (0.5, 0.99, 0.999):
        motion = {"motion": {"creepage": None,
                             "tangential_force": [share * FRICTION * FORCE, 0.0]}}  # fmt: skip
        yield Trial(
            "transient", f"force {share:g} of saturation, and reversed", nominal(base, motion),
            moves({}, {}, {"tangential_force": [-share * FRICTION * FORCE, 0.0]}, {}),
        )  # fmt: skip


def self_stiffness(layer: Mapping[str, Any]) -> float:
    """Pa/m, inverse of the displacement of one loaded element of the nominal grid."""
    thickness = layer.get("thickness", 0.0)
    flexibility = thickness / layer["shear_modulus"] if thickness else 0.0
    space = HalfSpace((3, 3), STEP, STEP, MODULUS, POISSON, flexibility)
    return 1 / space.flexibility()


def plastic(quick: bool) -> Iterator[Trial]:
    """Yield stress and hardening over their ranges, in every regime."""
    bound = FRICTION * PRESSURE
    elastic = {"elastic layer": LAYER, "no elastic layer": {"thickness": 0.0}}
    slopes = [(-s, f"softening {s:g} of snap-back") for s in SOFTENING]
    slopes += [(h, f"hardening {h:g} of elastic slope") for h in HARDENING] + [(0.0, "ideal")]
    for regime in REGIMES:
        for kind, layer in elastic.items():
            for slope, text in slopes:
                snaps = slope <= -0.999
                for part in (0.3,) if quick else (0.05, 0.3, 0.9):
                    own = {**layer, "yield_stress": part * bound,
                           "hardening": slope * self_stiffness(layer)}  # fmt: skip
                    yield Trial(
                        "plastic", f"{regime}, {kind}, {text}, yield at {part:g}",
                        nominal({"layer": own}, moving(regime, 1.5)),
                        steps_of(regime, SAYS_SO if snaps else ("converged",)),
                        "beyond the snap-back limit there need be no solution near by"
                        if snaps else "",
                    )  # fmt: skip
        for part in YIELDS:
            for rule in ("path", "magnitude"):
                own = {**LAYER, "yield_stress": part * bound, "plastic_rule": rule,
                       "hardening": 0.1 * self_stiffness(LAYER)}  # fmt: skip
                yield Trial(
                    "plastic", f"{regime}, yield at {part:g} of the bound, {rule}",
                    nominal({"layer": own}, moving(regime, 2.0)), steps_of(regime),
                )  # fmt: skip
        points = [[0.0, 0.2 * bound], [1e-6, 0.5 * bound], [5e-6, 0.3 * bound], [1e-4, bound]]
        own = {**LAYER, "hardening_table": points}
        yield Trial(
            "plastic", f"{regime}, hardening by a table",
            nominal({"layer": own}, moving(regime, 1.0)), steps_of(regime, SAYS_SO),
            "falls faster than the snap-back limit in a part",
        )  # fmt: skip


def steps_of(regime: str, expects: tuple[str, ...] = ("converged",)) -> tuple[Move, ...]:
    """Loading, further on, and reversal."""
    if regime == "steady_rolling":
        return moves({}, {"creepage": [-CREEPAGE, 0.5 * CREEPAGE]}, expects=expects)
    unit = SLIDING if regime == "shift" else CREEPAGE
    return moves({}, {}, {"creepage": [-2 * unit, 0.5 * unit]}, {}, expects=expects)


def laws(quick: bool) -> Iterator[Trial]:
    """Slip-velocity laws: slow to steep, with and without memory, over speed."""
    shapes: dict[str, dict[str, Any]] = {
        "exponential": {"kinetic": 0.03, "amplitude": 0.27},
        "rational": {"kinetic": 0.03, "amplitude": 0.27},
        "linear": {"kinetic": 0.03, "amplitude": 0.27},
        "rising": {"shape": "exponential", "kinetic": 0.4, "amplitude": -0.3},
    }
    for regime in REGIMES[1:]:
        for shape, numbers in shapes.items():
            for halving in (1.0, 0.3, 0.03):
                for memory in (0.0, 1e-3):
                    law = {
                        "law": "slip_velocity",
                        "shape": shape,
                        "coefficient": None,
                        "halving_speed": halving,
                        "memory_distance": memory,
                        **numbers,
                    }
                    for speed in (1e-6, 10.0) if quick else (1e-6, 1.0, 10.0, 150.0):
                        text = f"{regime}, {shape} {halving:g} m/s, memory {1e3 * memory:g} mm"
                        motion = {"motion": {"rolling_speed": speed}}
                        yield Trial(
                            "slip velocity", f"{text}, {speed:g} m/s",
                            nominal({"friction": law}, moving(regime, 1.0), motion),
                            moves({}, {"creepage": [5 * CREEPAGE, CREEPAGE]},
                                  {"creepage": [0.2 * CREEPAGE, 0.0]},
                                  {"creepage": [0.0, 0.0], "spin_creepage": 3 * SPIN},
                                  expects=falling(shape)),
                            "falling friction may have several solutions, or none that is stable"
                            if shape != "rising" else "",
                        )  # fmt: skip
    steep = {"friction": {"law": "slip_velocity", "shape": "polach", "coefficient": 0.55,
                          "polach_a": 0.1, "polach_b": 2.3}}  # fmt: skip
    yield Trial(
        "slip velocity", "Polach's law to a tenth within 1 m/s", nominal(steep),
        moves(*({"creepage": [size, 0.0]} for size in (1e-4, 1e-3, 1e-2, 0.1, 1.0, 1e-3)),
              expects=SAYS_SO),
    )  # fmt: skip


def falling(shape: str) -> tuple[str, ...]:
    """What a law may answer: with falling friction it may say that it found none."""
    return ("converged",) if shape == "rising" else SAYS_SO


def temperatures() -> Iterator[Trial]:
    """Surface temperature over speed and material, and friction that depends on it."""
    for regime in REGIMES[1:]:
        for speed in (1e-6, 1e-2, 10.0, 150.0):
            for size in (0.1, 30.0):
                heat = {"temperature": {"wheel": 150.0, "rail": -20.0}}
                case = nominal(heat, moving(regime, size), {"motion": {"rolling_speed": speed}})
                yield Trial(
                    "temperature", f"{regime}, {speed:g} m/s, {size:g} of saturation", case,
                    moves({}, {}, {"direction": -1}, {"rolling_speed": 0.0}),
                )  # fmt: skip
        for change in (-0.29, -0.1, 0.3):
            for range_ in (1.0, 100.0, 1e4):
                for speed in (1.0, 40.0):
                    law = {"law": "temperature", "coefficient": None, "reference": 0.3,
                           "change": change, "reference_temperature": 0.0,
                           "temperature_range": range_}  # fmt: skip
                    case = nominal({"friction": law, "temperature": {}}, moving(regime, 20.0),
                                   {"motion": {"rolling_speed": speed}})  # fmt: skip
                    yield Trial(
                        "temperature",
                        f"{regime}, friction {change:+g} within {range_:g} K, {speed:g} m/s", case,
                        moves({}, {}, expects=SAYS_SO),
                        "steep feedback of heat on friction may have no stable solution",
                    )  # fmt: skip
    glass = {"temperature": {"conductivity": [0.5, 50.0], "density": [2500.0, 7850.0]}}
    yield Trial("temperature", "glass on steel", nominal(glass, moving("steady_rolling", 3.0)))
    for share in (0.0, 1.0):
        own = {**LAYER, "yield_stress": 0.3 * FRICTION * PRESSURE, "plastic_heat_fraction": share}
        yield Trial(
            "temperature", f"plastic layer, {share:g} of its work",
            nominal({"temperature": {}, "layer": own}, moving("steady_rolling", 2.0)),
        )  # fmt: skip
