"""The methods that are measured: one line each.

A method whose case the schema refuses ends the run with that message; where it does not apply to a
set of problems, ``sets`` says so.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from itertools import chain
from typing import Any

from railpatch import _core
from railpatch.case import theories
from railpatch.case.accuracy import fitted_size
from railpatch.evidence.bench.problems import Batch, merged
from railpatch.evidence.bench.sets import AnyBatch
from railpatch.evidence.bench.shapes import Surface
from railpatch.evidence.bench.steps import contact_of

# cost of a step: "full" solves a system on the grid, fewer problems are taken on fine grids;
# "fast" takes microseconds, every problem is taken several times
FULL, FAST = "full", "fast"
FAST_REPEAT = 5
COARSE = (8, 10, 12, 16, 20, 24, 32, 48, 64)
SCALES = (6, 8, 10, 12, 14, 16, 20, 24)
# elements across of the normal problem below fitted rows: 24 to 96 of them give the same errors of
# the force on set B, those of what rows make of the pressure
NORMAL_GRID = 24

ROOM = 0.2  # around non-elliptic contacts for approximate normal theories, over their size

Overrides = Mapping[str, Any]


@dataclass(frozen=True)
class Method:
    """A method on its grids.

    overrides: keys of the case that it replaces, None takes a table or key away; or what gives
    them for a batch and a grid. grids: elements across the contact, or what ``unit`` says; (0,) for
    a method that chooses itself. quick: those of --quick. sets: that it applies to. growth: its
    cost is measured over the number of elements. whole_up_to: on finer grids, the number of
    problems falls with the cube of them. normal_grid: elements across of the normal problem, where
    the grid is that of the tangential problem alone.
    """

    name: str
    label: str
    overrides: Overrides | Callable[[AnyBatch, int], Overrides]
    cost: str = FULL
    grids: tuple[int, ...] = COARSE
    quick: tuple[int, ...] = (10, 16, 24, 32)
    sets: str = "ABCDW"
    growth: bool = False
    unit: str = "across"
    whole_up_to: int = 32
    normal_grid: int | None = None

    @property
    def repeat(self) -> int:
        """Passes over the problems."""
        return FAST_REPEAT if self.cost == FAST else 1

    def count(self, elements: int, total: int) -> int:
        """How many of a set's problems are taken."""
        if self.cost == FAST or elements <= self.whole_up_to:
            return total
        return max(1, round(total * (self.whole_up_to / elements) ** 3))

    def point(self, elements: int) -> str:
        """Name of the method on one grid."""
        if not elements:
            return self.label
        size = f"{elements} across" if self.unit == "across" else f"{self.unit} {elements}"
        return f"{self.label}, {size}"

    def contact(self, batch: AnyBatch, elements: int, *more: Overrides) -> _core.Contact:
        """The core's handle, with more overrides. Raises CaseError where the case is refused."""
        own = self.overrides(batch, elements) if callable(self.overrides) else self.overrides
        for other in more:
            own = merged(own, other)
        return contact_of(batch, own, self.normal_grid or elements or COARSEST)


# of the tables of a method that chooses its grid itself and replaces them
COARSEST = 8


def tangential(name: str, **method: Any) -> dict[str, Any]:
    """Overrides that choose a theory."""
    return {"method": {"tangential": name, **method}}


def fitted(normal: str) -> Callable[[AnyBatch, int], Overrides]:
    """Fitted rows at a scale; Hertz's pressure needs no grid besides."""

    def overrides(batch: AnyBatch, scale: int) -> Overrides:
        grid: dict[str, Any] = {"fitted": list(fitted_size(scale, batch.axis_ratio))}
        if normal == "hertz":
            grid["elements"] = None
        return {**tangential("full", normal=normal), "grid": grid}

    return overrides


def with_room(theory: str, **method: Any) -> Callable[[AnyBatch, int], Overrides]:
    """Overrides for normal theories whose contact areas are larger than the half-space's."""

    def overrides(batch: AnyBatch, elements: int) -> Overrides:
        return {**tangential(theory, **method), **room(batch, elements)}

    return overrides


def room(batch: AnyBatch, elements: int) -> Overrides:
    """Tables with a wider undeformed distance, where the shape is one."""
    if isinstance(batch, Batch) and isinstance(batch.shape, Surface):
        return batch.shape.tables(elements, ROOM)
    return {}


def without_grid(theory: str, **method: Any) -> Overrides:
    """A closed form on Hertz's ellipse."""
    return {**tangential(theory, normal="hertz", **method), "grid": None}


def strips(name: str, label: str, theory: str, sets: str, **method: Any) -> Method:
    """A fast theory that sweeps over rows."""
    roomy = method.get("normal") in ("kik_piotrowski", "analyn")
    overrides = (with_room if roomy else tangential)(theory, **method)
    return Method(name, label, overrides, FAST, grids=(10, 20, 32), quick=(10, 20), sets=sets)


LABELS = {
    "linear": "linear theory",
    "polach": "Polach",
    "table": "table of the full theory",
    "fastsim": "FASTSIM, elliptic",
    "fastrip": "FaStrip",
}
# of the theory of the same name
OPTIONS: dict[str, tuple[tuple[str, str, dict[str, str]], ...]] = {
    "fastsim": (
        ("fastsim_parabolic", "FASTSIM, parabolic", {"traction_bound": "parabolic"}),
        ("fastsim_contact", "FASTSIM as in CONTACT", {"flexibility_blending": "contact"}),
    ),
}


def closed_forms(theory: str) -> Iterator[Method]:
    """A theory without tractions."""
    if not theories.has_tractions(theory):
        label = LABELS.get(theory, theory)
        yield Method(theory, label, without_grid(theory), FAST, (0,), (0,), "AC")


def on_ellipse(theory: str) -> Iterator[Method]:
    """A theory with tractions on Hertz's ellipse, and with other options."""
    if theories.has_tractions(theory):
        yield strips(theory, LABELS.get(theory, theory), theory, "AC", normal="hertz")
        for name, label, option in OPTIONS.get(theory, ()):
            yield strips(name, label, theory, "AC", normal="hertz", **option)


UNIFORM = Method("uniform", "full theory, uniform grid", tangential("full"), growth=True)
FITTED = Method(
    "fitted", "full theory, fitted rows", fitted("hertz"),
    grids=SCALES, quick=(8, 10, 14), sets="ACD", unit="scale", whole_up_to=16,
)  # fmt: skip
FITTED_HALF_SPACE = Method(
    "fitted_half_space", "full theory, fitted rows on half-space pressure", fitted("half_space"),
    grids=(8, 10, 14, 20), quick=(10,), sets="BCW", unit="scale", whole_up_to=16,
    normal_grid=NORMAL_GRID,
)  # fmt: skip
METHODS = (
    FITTED,
    FITTED_HALF_SPACE,
    UNIFORM,
    Method("uniform_hertz", "full theory, uniform grid, Hertz pressure",
           tangential("full", normal="hertz"), grids=(16, 32), quick=(16,), sets="ACD"),
    *chain.from_iterable(closed_forms(name) for name in theories.FAST),
    *chain.from_iterable(on_ellipse(name) for name in theories.FAST),
    strips("half_space_fastsim", "half-space pressure, FASTSIM", "fastsim", "BCW"),
    strips("kik_piotrowski_fastsim", "Kik-Piotrowski, FASTSIM", "fastsim", "BW",
           normal="kik_piotrowski"),
    strips("analyn_fastsim", "ANALYN, FASTSIM", "fastsim", "BW", normal="analyn"),
)  # fmt: skip


def chosen_methods(names: str | None) -> tuple[Method, ...]:
    """Those named, separated by commas; all by default. Raises ValueError for others."""
    if names is None:
        return METHODS
    known = {method.name: method for method in METHODS}
    wanted = [name.strip() for name in names.split(",")]
    wrong = [name for name in wanted if name not in known]
    if wrong:
        raise ValueError(f"methods: value is {wrong[0]!r}, allowed {', '.join(known)}")
    return tuple(known[name] for name in wanted)
