"""Trials of steady rolling with Coulomb friction: shape, grid, friction, motion, load, layer."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np

from railpatch.case.theories import BY_ROWS
from railpatch.evidence.stress.trial import (
    CREEPAGE,
    FORCE,
    FRICTION,
    METHODS,
    MODULUS,
    NO_CONTACT,
    POISSON,
    REFUSED,
    SAYS_SO,
    SEMI_AXIS,
    SPIN,
    Move,
    Trial,
    expected,
    moves,
    nominal,
)

RATIOS = (0.01, 0.02, 0.05, 0.2, 0.5, 2.0, 5.0, 20.0, 50.0, 100.0)
ACROSS = (3, 4, 5, 7, 10, 16, 33, 64, 100, 150, 300)
FRICTIONS = (0.0, 1e-12, 1e-6, 1e-3, 0.05, 0.6, 1.0, 2.0, 10.0)
CREEPAGES = (1e-12, 1e-9, 1e-6, 1e-4, 1e-3, 1e-2, 0.1, 1.0)
SPINS = (1e-9, 1e-3, 0.1, 1.0, 3.0, 10.0, 30.0, 100.0)  # of saturation
SPEEDS = (1e-6, 1e-3, 1.0, 150.0)
LOADS = (1.0, 1e2, 1e4, 1e6)
LAYERS = (1e-3, 1e-2, 0.1, 1.0, 10.0, 1e2, 1e3)  # stiffness over that of steel
SHARES = (0.0, 1e-9, 0.01, 0.5, 0.9, 0.99, 0.999)  # of saturation
TOLERANCES = {
    1e-12: "near the rounding of the products",
    0.1: "a pressure known to a tenth may touch the border of the grid, and then says so",
}
DIAGONAL = (2**-0.5, 2**-0.5)
# radius of curvature of the nominal case's bodies: 1/(2 c)
CURVATURE = 3.0 * FORCE * (1 - POISSON) / (8 * MODULUS * SEMI_AXIS**3)


def creep(xi: float, eta: float = 0.0, spin: float = 0.0) -> dict[str, Any]:
    """[motion] by creepages and spin."""
    return {"motion": {"creepage": [xi, eta], "spin_creepage": spin}}


def steady_trials(quick: bool) -> Iterator[Trial]:
    """All of them; quick: fewer of each."""
    yield from shapes()
    yield from grids(quick)
    yield from frictions()
    yield from creepages()
    yield from spins()
    yield from speeds()
    yield from loads()
    yield from layers()
    yield from forces()
    yield from sequences()
    yield from distances()
    yield from lines()
    yield from options()


def shapes() -> Iterator[Trial]:
    """Ratio of the semi-axes, of equal area."""
    for ratio in RATIOS:
        a, b = SEMI_AXIS * ratio**0.5, SEMI_AXIS / ratio**0.5
        shape = {"geometry": {"semi_axes": [a, b]}}
        motion = creep(0.5 * CREEPAGE, 0.2 * CREEPAGE, 0.3 * SPIN)
        for name, method in METHODS.items():
            note = "" if expected(name) == ("converged",) else "may say that it is out of its range"
            yield Trial(
                "shape", f"a/b = {ratio:g}", nominal(shape, motion, method),
                moves({}, expects=expected(name)), note,
            )  # fmt: skip
        for normal in BY_ROWS:
            method = {"method": {"normal": normal, "tangential": "fastsim"}}
            yield Trial(
                "shape", f"a/b = {ratio:g}, {normal}", nominal(shape, motion, method),
                moves({}, expects=SAYS_SO),
            )  # fmt: skip
    for ratio in (0.01, 1.0, 100.0):
        for nu in (0.0, 0.5):
            a, b = SEMI_AXIS * ratio**0.5, SEMI_AXIS / ratio**0.5
            shape = {
                "geometry": {"semi_axes": [a, b]},
                "material": {"shear_modulus": MODULUS, "poisson_ratio": nu},
            }
            yield Trial("shape", f"a/b = {ratio:g}, Poisson's ratio {nu}", nominal(shape, motion))


def grids(quick: bool) -> Iterator[Trial]:
    """Elements across, square and not."""
    motion = creep(0.5 * CREEPAGE, 0.2 * CREEPAGE, 0.3 * SPIN)
    sizes = [[n, n] for n in ACROSS] + [[3, 100], [100, 3], [2, 2], [300, 20], [20, 300]]
    for size in sizes:
        if quick and max(size) > 64:
            continue
        grid = {"grid": {"elements": size}}
        yield Trial("grid", f"{size[0]} x {size[1]} elements", nominal(grid, motion))
    for rows in ([3, 3], [4, 40], [40, 4], [48, 48], [64, 36]):
        if quick and rows[0] * rows[1] > 400:
            continue
        fitted = {"grid": {"elements": None, "fitted": rows}, "method": {"normal": "hertz"}}
        yield Trial("grid", f"{rows[0]} nodes in {rows[1]} rows", nominal(fitted, motion))


def frictions() -> Iterator[Trial]:
    """Friction coefficient, at a creepage of the nominal saturation."""
    for friction in FRICTIONS:
        law = {"friction": {"coefficient": friction}}
        for name, method in METHODS.items():
            yield Trial(
                "friction", f"coefficient {friction:g}",
                nominal(law, creep(0.5 * CREEPAGE, 0.2 * CREEPAGE, 0.3 * SPIN), method),
                moves({}, expects=expected(name)),
            )  # fmt: skip
    strip = {"friction": {"factor": [[-1e-6, 1e-3], [1e-6, 1.0]]}}
    yield Trial("friction", "falls to a thousandth across a row", nominal(strip))
    strip = {"friction": {"factor": [[-0.003, 1.0], [-0.001, 0.0], [0.001, 0.0], [0.003, 3.0]]}}
    yield Trial("friction", "none in the middle", nominal(strip))


def creepages() -> Iterator[Trial]:
    """Size and direction of the creepage."""
    for size in CREEPAGES:
        for way, (x, y) in {
            "longitudinal": (1.0, 0.0), "lateral": (0.0, -1.0), "diagonal": DIAGONAL,
        }.items():  # fmt: skip
            for name, method in METHODS.items():
                if way != "diagonal" and name not in ("full", "fitted rows"):
                    continue
                yield Trial(
                    "creepage", f"{size:g} {way}", nominal(creep(size * x, size * y), method),
                    moves({}, expects=expected(name)),
                )  # fmt: skip
    for method in METHODS.values():
        yield Trial("creepage", "none", nominal(creep(0.0), method))


def spins() -> Iterator[Trial]:
    """Spin, alone and with creepage."""
    for size in SPINS:
        for with_creepage in (0.0, 0.7):
            what = " and creepage" if with_creepage else ""
            motion = creep(with_creepage * CREEPAGE, -with_creepage * CREEPAGE, size * SPIN)
            for name, method in METHODS.items():
                yield Trial(
                    "spin", f"{size:g} of saturation{what}", nominal(motion, method),
                    moves({}, expects=expected(name)),
                )  # fmt: skip


def speeds() -> Iterator[Trial]:
    """Rolling speed; standstill and reversal in a sequence."""
    for name, method in METHODS.items():
        for speed in SPEEDS:
            yield Trial(
                "speed", f"{speed:g} m/s", nominal({"motion": {"rolling_speed": speed}}, method)
            )
        turned = nominal(creep(CREEPAGE, 0.5 * CREEPAGE, 0.5 * SPIN), method)
        yield Trial(
            "speed", "forward, standstill, backward, forward", turned,
            moves({}, {"rolling_speed": 0.0}, {"rolling_speed": 10.0, "direction": -1},
                  {"direction": 1}, expects=expected(name)),
        )  # fmt: skip


def loads() -> Iterator[Trial]:
    """Normal force on given curvatures, and on a given ellipse."""
    for name, method in METHODS.items():
        for load in LOADS:
            curved = {
                "geometry": {"semi_axes": None, "curvatures": [CURVATURE, 0.7 * CURVATURE]},
                "load": {"normal_force": load},
            }
            yield Trial(
                "load", f"{load:g} N", nominal(curved, method), moves({}, expects=expected(name))
            )
    for approach, expects in (
        (1e-9, SAYS_SO), (1e-6, ("converged",)), (1e-3, ("converged",)), (0.0, NO_CONTACT),
        (-1e-3, NO_CONTACT),
    ):  # fmt: skip
        curved = {
            "geometry": {"semi_axes": None, "curvatures": [CURVATURE, 0.7 * CURVATURE]},
            "load": {"normal_force": None, "approach": approach},
        }
        yield Trial("load", f"approach {approach:g} m", nominal(curved), moves({}, expects=expects))


def layers() -> Iterator[Trial]:
    """Elastic layer, by the stiffness of the bodies G/a."""
    for ratio in LAYERS:
        thickness = 1e-4
        layer = {"layer": {"thickness": thickness,
                           "shear_modulus": ratio * MODULUS * thickness / SEMI_AXIS}}  # fmt: skip
        for part, motion in (
            ("half of saturation", creep(0.5 * CREEPAGE * (1 + 1 / ratio))),
            ("near full sliding", creep(4 * CREEPAGE * (1 + 1 / ratio), 0.0, SPIN / ratio)),
        ):
            for name in ("full", "fitted rows"):
                yield Trial(
                    "layer", f"{ratio:g} of steel's stiffness, {part}",
                    nominal(layer, motion, METHODS[name]),
                )  # fmt: skip


def forces() -> Iterator[Trial]:
    """Prescribed tangential force."""
    most = FRICTION * FORCE
    for share in SHARES:
        for name in ("full", "fitted rows"):
            for way, (x, y) in {
                "along": (1.0, 0.0), "across": (0.0, -1.0), "diagonal": DIAGONAL,
            }.items():  # fmt: skip
                force = [share * most * x, share * most * y]
                motion = {"motion": {"creepage": None, "tangential_force": force}}
                yield Trial(
                    "prescribed force", f"{share:g} of saturation {way}",
                    nominal(motion, METHODS[name]),
                )  # fmt: skip
            motion = {
                "motion": {
                    "creepage": [0.0, 0.3 * CREEPAGE],
                    "spin_creepage": 0.5 * SPIN,
                    "tangential_force": [share * most, "creepage"],
                }
            }
            yield Trial(
                "prescribed force", f"{share:g} of saturation along, lateral creepage and spin",
                nominal(motion, METHODS[name]), moves({}, expects=SAYS_SO),
                "lateral creepage and spin take a part of what friction carries",
            )  # fmt: skip
    for share, expects in ((1.0, SAYS_SO), (1.001, REFUSED)):
        motion = {"motion": {"creepage": None, "tangential_force": [share * most, 0.0]}}
        yield Trial(
            "prescribed force", f"{share:g} of saturation along", nominal(motion),
            moves({}, expects=expects),
            "at saturation the creepage is without bound, beyond it the case is an error",
        )  # fmt: skip


def sequences() -> Iterator[Trial]:
    """Load jumps, contact lost and regained, the same contact all along."""
    grid = {"geometry": {"semi_axes": None, "curvatures": [CURVATURE, CURVATURE]}}
    for name, method in METHODS.items():
        yield Trial(
            "sequence", "load times 100, over 100", nominal(grid, method),
            moves({}, {"normal_force": 100 * FORCE}, {"normal_force": FORCE},
                  {"normal_force": 0.01 * FORCE}, {"normal_force": FORCE},
                  expects=expected(name)),
        )  # fmt: skip
    lifted = nominal(grid, {"load": {"normal_force": None, "approach": 1e-4}})
    yield Trial(
        "sequence", "contact lost and regained", lifted,
        (Move(), Move({"approach": -1e-5}, NO_CONTACT), Move({"approach": 1e-4}),
         Move({"approach": 1e-6}), Move({"approach": 1e-4})),
    )  # fmt: skip
    sized = nominal(grid, {"grid": {"elements": None, "element_size": [5e-4, 5e-4],
                                    "max_elements": [64, 64]}})  # fmt: skip
    yield Trial(
        "sequence", "load jumps on elements of one size", sized,
        (Move(), Move({"normal_force": 100.0}), Move({"normal_force": FORCE}),
         Move({"normal_force": 1e7}, ("out_of_range",)), Move({"normal_force": FORCE})),
        note="10 MN do not fit the elements that the case allows",
    )  # fmt: skip
    for name in ("full", "fitted rows"):
        yield Trial(
            "sequence", "creepage turned about and back", nominal(METHODS[name]),
            moves({"creepage": [10 * CREEPAGE, 0.0]}, {"creepage": [-10 * CREEPAGE, 0.0]},
                  {"creepage": [1e-9, 0.0]}, {"creepage": [0.0, 0.0], "spin_creepage": 30 * SPIN},
                  {"creepage": [CREEPAGE, CREEPAGE], "spin_creepage": 0.0}),
        )  # fmt: skip


def gap_case(distance: Any, size: float = 5e-4, **load: float) -> dict[str, Any]:
    """A case of any undeformed distance."""
    return nominal(
        {
            "geometry": {"semi_axes": None, "undeformed_distance": distance.tolist()},
            "grid": {"elements": None, "element_size": [size, size]},
            "load": {"normal_force": None, **load} if load else {},
        }
    )


def distances() -> Iterator[Trial]:
    """Undeformed distances that are no paraboloid."""
    place = 5e-4 * (np.arange(40) - 19.5)
    x, y = np.meshgrid(place, place)
    round_ = CURVATURE * (x**2 + y**2)
    two = CURVATURE * (x**2 + (np.abs(y) - 0.005) ** 2)
    fourth = CURVATURE / 0.006**2 * (x**4 + y**4)
    waves = round_ + 5e-6 * np.cos(2 * np.pi * x / 2e-3) * np.cos(2 * np.pi * y / 2e-3)
    rough = round_ + 2e-6 * np.random.default_rng(5).standard_normal(x.shape)
    for name, distance in (
        ("two hills", two), ("fourth power", fourth), ("waves", waves), ("rough", rough),
    ):  # fmt: skip
        for load in (1e2, 1e4, 5e4):
            case = gap_case(distance)
            case["load"] = {"normal_force": load}
            case["motion"] = {**case["motion"], "spin_creepage": 0.3 * SPIN}
            yield Trial("distance", f"{name}, {load:g} N", case)
    for name, distance in (("flat", 0 * round_), ("tilted", 1e-3 * x)):
        yield Trial(
            "distance", name, gap_case(distance), moves({}, expects=("out_of_range",)),
            "the contact reaches the border of the grid",
        )  # fmt: skip
    yield Trial(
        "distance", "hollow", gap_case(-round_), moves({}, expects=("out_of_range",)),
        "the bodies touch at the border of the grid",
    )  # fmt: skip


def lines() -> Iterator[Trial]:
    """Line contact."""
    for load in (1.0, 1e6):
        for across in (3, 20, 300):
            case = nominal(
                {
                    "geometry": {"semi_axes": None, "line_contact_radius": 0.5, "width": 1.0},
                    "load": {"normal_force": load},
                    "grid": {"elements": [across, 1]},
                    "motion": {"creepage": [1e-6 * load**0.5, 3e-7 * load**0.5]},
                }
            )
            yield Trial("line contact", f"{load:g} N/m, {across} elements", case)


def options() -> Iterator[Trial]:
    """Tolerances, iterations, and the peer's spin term."""
    motion = creep(0.5 * CREEPAGE, 0.2 * CREEPAGE, 0.3 * SPIN)
    for tolerance in (1e-12, 1e-10, 1e-8, 0.1):
        for name in ("full", "fitted rows"):
            method = {"method": {"tolerance": tolerance}}
            yield Trial(
                "option", f"tolerance {tolerance:g}", nominal(motion, METHODS[name], method),
                moves({}, expects=("converged",) if 1e-11 < tolerance < 0.01 else SAYS_SO),
                TOLERANCES.get(tolerance, ""),
            )  # fmt: skip
    for most in (1, 3):
        method = {"method": {"max_iterations": most}}
        yield Trial(
            "option", f"{most} iterations at most", nominal(motion, method),
            moves({}, {"normal_force": 2 * FORCE}, expects=("not_converged", "converged")),
            "too few: says so and gives the best so far",
        )  # fmt: skip
    for offset in ("none", "sixth"):
        yield Trial(
            "option", f"spin term, {offset}", nominal(motion, {"method": {"spin_offset": offset}})
        )
