"""Makes a table of shapes: core/fast/shape_table.hpp tells what it is and how it is read.

Shapes of random places become nodes where the table so far errs by more than a part of what is
asked for; rounds of them go on until of new places 95 % err by less.

The first shapes are solved at all creepages. What they have there, are sums of functions that later
shapes share: these are solved at a third of the creepages, which tell how much of each function
they have (gappy principal components: Everson and Sirovich 1995, J. Opt. Soc. Am. A 12), and the
functions tell the rest.
"""

from __future__ import annotations

import hashlib
import io
import json
import struct
import time
import zipfile
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from railpatch import _core
from railpatch.case.creep_table import SHAPES_BODY, SHAPES_MAGIC, checksum, default_table
from railpatch.evidence.table.blob import padded
from railpatch.evidence.table.gaps import Gaps
from railpatch.evidence.table.kriging import MOST, Lengths, find_lengths, weights_of
from railpatch.evidence.table.pair import (
    CHECK,
    COARSE,
    DIVIDED,
    FULL,
    NODES,
    Pair,
    Place,
    Vector,
)
from railpatch.writing import write_whole

# long contacts turn from stick to slip between spins of 0.3 and 2
SPINS = np.array([0.0, 0.15, 0.3, 0.5, 0.75, 1.05, 1.5, 2.1, 3.0, 4.5, 7.0, 11.0])
DIRECTIONS, RADII, RADIUS, LANES, FUNCTIONS = 12, 9, 1.7, 8, 24
FIRST, ROUND = 60, 100
WHOLE = 100  # shapes that are solved at all creepages
KEPT = 20  # shapes between two that are kept
GAPS = 3  # of so many creepages later ones are solved at one
STATES = 4  # creepages of a place that is tried
NEEDED = 0.7  # of the error asked for: a shape that errs by less is no node
FAR_OFF = 2.0  # times the error asked for: of 95 % beyond it, and every place becomes a node
RENEWED = 1.5  # times as many nodes tell the lengths anew
APART = 0.6  # a fall of the rows' load below it, and there are two parts
LEVEL = 0.95
LEVELS = (50, 90, 95, 99, 100)  # of what is told of the error, per cent
FAR = 1e9


def creepages_of_nodes() -> Vector:
    """v [spin, 1 + direction * (radii - 1), 3]: without creepage, then by direction and size."""
    angle = 2 * np.pi * np.arange(DIRECTIONS) / DIRECTIONS
    part = np.arange(1, RADII) / RADII
    size = RADIUS * part / (1 - part)
    ring = np.zeros((DIRECTIONS, RADII - 1, 3))
    ring[..., 0] = np.cos(angle)[:, None] * size
    ring[..., 1] = np.sin(angle)[:, None] * size
    rows = np.concatenate([np.zeros((1, 3)), ring.reshape(-1, 3)])
    found = np.repeat(rows[None], len(SPINS), axis=0)
    found[..., 2] = SPINS[:, None]
    return found


def creepages_of_later() -> tuple[NDArray[np.intp], int]:
    """Numbers of those that later shapes are solved at, spin by spin, and how many of a spin."""
    spin, direction, size = np.ogrid[: len(SPINS), :DIRECTIONS, 1:RADII]
    chosen = np.ones((len(SPINS), 1 + DIRECTIONS * (RADII - 1)), bool)
    chosen[:, 1:] = ((spin + direction + size) % GAPS == 0).reshape(len(SPINS), -1)
    return np.flatnonzero(chosen), int(chosen[0].sum())


class Shapes:
    """The nodes of a table in the making."""

    def __init__(self, pair: Pair, threads: int) -> None:
        self.pair, self.threads = pair, threads
        self.features: list[Vector] = []
        self.remainders: list[Vector] = []
        self.lengths: Lengths | None = None
        self._told = 0  # nodes that told the lengths
        self._before, self._began = 0.0, time.process_time()
        self._v = creepages_of_nodes().reshape(-1, 3)
        self._gaps: Gaps | None = None
        # of the pair, the grids and the creepages: shapes of others are not taken up
        recipe = (pair.about(), NODES, DIVIDED, COARSE, FULL, APART, WHOLE, self._v.tolist())
        text = json.dumps(recipe, sort_keys=True)
        self.key = hashlib.sha256(text.encode()).hexdigest()

    def __len__(self) -> int:
        return len(self.features)

    @property
    def seconds(self) -> float:
        """Processor time that they took, s, with that of runs that were stopped."""
        return self._before + time.process_time() - self._began

    def add(self, place: Place) -> None:
        """Solves a node; one that the full theory does not solve everywhere is left out."""
        some, of_spin = np.arange(len(self._v)), len(self._v) // len(SPINS)
        if len(self) >= WHOLE:
            some, of_spin = creepages_of_later()
            if self._gaps is None:
                self._gaps = Gaps(self._rows()[:WHOLE], some)
        missing = self._missing(place, self._v[some], of_spin)
        if missing is None:
            return
        rows = missing if self._gaps is None else self._gaps.filled(missing)
        rows = rows.reshape(len(SPINS), -1, 3)
        found = np.zeros((len(SPINS), DIRECTIONS, RADII, 3))
        found[:, :, 0] = rows[:, :1]
        found[:, :, 1:] = rows[:, 1:].reshape(len(SPINS), DIRECTIONS, RADII - 1, 3)
        self.features.append(place.features)
        self.remainders.append(found.astype(np.float32))

    def _missing(self, place: Place, v: Vector, of_spin: int) -> Vector | None:
        """What the full theory has beyond the ellipses at v [n, 3], so many of a spin; [n, 3] over
        the bound, the moment about the pressure's centre. None where it is not solved."""
        creepages = self.pair.at_centre(place, v)
        grid = self.pair.grid(place, NODES if place.fall > APART else DIVIDED)
        full, solved = self.pair.solve(place, creepages, FULL, grid, self.threads, sequence=of_spin)
        fast, _ = self.pair.solve(place, creepages, {"tangential": "table"}, COARSE, self.threads)
        if not (solved.all() and np.isfinite(fast).all()):
            return None
        missing = full - fast
        x, y = place.centre / np.sqrt(np.prod(place.axes))
        missing[:, 2] -= x * missing[:, 1] - y * missing[:, 0]
        return missing

    def keep(self, file: Path) -> None:
        """Writes what is solved so far, and where the random places are; raises OSError."""
        buffer = io.BytesIO()
        text = json.dumps(self.pair.random.bit_generator.state)
        np.savez(
            buffer, key=self.key, random=text, seconds=self.seconds, features=self.features,
            rows=self.remainders,
        )  # fmt: skip
        write_whole(file, buffer.getvalue())

    def go_on(self, file: Path) -> None:
        """Takes what ``keep`` wrote for the same pair; else nothing. Raises OSError."""
        try:
            with np.load(file) as found:
                if str(found["key"]) != self.key:
                    return
                self.features = list(found["features"])
                self.remainders = list(found["rows"])
                self._before = float(found["seconds"])
                self.pair.random.bit_generator.state = json.loads(str(found["random"]))
        except (FileNotFoundError, ValueError, KeyError, zipfile.BadZipFile):
            return

    def _rows(self) -> Vector:
        """Of the nodes so far, [node, creepage, 3], in the order of ``creepages_of_nodes``."""
        found = np.array(self.remainders, float)
        at_rest = found[:, :, :1, 0]
        moving = found[:, :, :, 1:].reshape(len(found), len(SPINS), -1, 3)
        return np.concatenate([at_rest, moving], axis=2).reshape(len(found), -1, 3)

    def scale(self) -> Vector:
        """Of the features. Raises RuntimeError before there is any data."""
        if self.lengths is None:
            raise RuntimeError("no table was made yet")
        return 1.0 / self.lengths.length

    def functions(self) -> tuple[Vector, Vector]:
        """Of creepage [FUNCTIONS, ...], of which the first counts once; and weights [n, FUNCTIONS]
        of nodes."""
        features = np.array(self.features)
        rows = np.array(self.remainders, float).reshape(len(self), -1)
        mean = rows.mean(axis=0)
        own, size, shared = np.linalg.svd(rows - mean, full_matrices=False)
        most = min(FUNCTIONS - 1, len(self) - 1)
        amounts = own[:, :most] * size[:most]
        if len(self) >= RENEWED * self._told:
            some = np.random.default_rng(len(self)).permutation(len(self))[:MOST]
            self.lengths = find_lengths(features[some], amounts[some], self.lengths)
            self._told = len(self)
        assert self.lengths is not None
        middle, weight = weights_of(features, amounts, self.lengths)
        found, of_nodes = np.zeros((FUNCTIONS, rows.shape[1])), np.zeros((len(self), FUNCTIONS))
        found[0] = mean + middle @ shared[:most]
        found[1 : most + 1], of_nodes[:, 1 : most + 1] = shared[:most], weight
        return found.reshape(FUNCTIONS, *self.remainders[0].shape), of_nodes

    def data(self, reach: float, error: list[float], about: dict[str, Any]) -> bytes:
        """The table's bytes."""
        count = len(self)
        functions, weight = self.functions()
        # all functions as large as 16 bits take
        size = np.abs(functions).reshape(FUNCTIONS, -1).max(axis=1)
        size = np.where(size > 0, size, 1.0)
        unit = max(size[0], 1e-9) / 32767
        numbers = np.round(functions / size[:, None, None, None, None] * 32767).astype("<i2")
        numbers = np.ascontiguousarray(np.moveaxis(numbers, 0, -1))
        blocks = -(-count // LANES)
        weights = np.zeros((blocks * LANES, FUNCTIONS), "<f8")
        weights[:count] = weight * size / size[0]
        features = np.full((blocks * LANES, 8), FAR, "<f4")
        features[:count] = np.array(self.features) * self.scale()
        lanes = np.ascontiguousarray(features.reshape(blocks, LANES, 8).transpose(0, 2, 1))
        text = json.dumps(about, sort_keys=True).encode()
        body = SHAPES_BODY.pack(
            count, len(text), self.pair.poisson_ratio, reach, RADIUS, *SPINS, *self.scale(), unit,
            *error,
        )  # fmt: skip
        body += lanes.tobytes() + weights.tobytes() + numbers.tobytes() + padded(text)
        body += default_table().tobytes()
        head = struct.calcsize("<8sQQ")
        return struct.pack("<8sQQ", SHAPES_MAGIC, head + len(body), checksum(body)) + body


def tried(shapes: Shapes, place: Place, table: Path) -> tuple[Vector, Vector]:
    """Errors of force over the bound and of moment over c times it at random creepages."""
    pair = shapes.pair
    creepages, friction = pair.natural(place, STATES)
    method = {"tangential": "table", "table_file": str(table)}
    (full, solved), (fast, _) = (
        pair.solve(place, creepages, of, grid, shapes.threads, friction, COARSE["elements"])
        for of, grid in ((FULL, pair.grid(place, CHECK)), (method, COARSE))
    )
    missing = (full - fast)[solved]
    return np.hypot(missing[:, 0], missing[:, 1]), np.abs(missing[:, 2])


def distance(shapes: Shapes, place: Place) -> float:
    """To the nearest node."""
    nodes = np.array(shapes.features)
    return float(np.linalg.norm((nodes - place.features) * shapes.scale(), axis=1).min())


def refine(
    shapes: Shapes, error: float, most: int, table: Path, kept: Path, step: Callable[[str], None]
) -> None:
    """Adds shapes of random places that err by too much, in rounds, until few do. table, kept:
    files for the tables on the way, and for what is solved."""
    pair = shapes.pair
    while len(shapes) < most:
        table.write_bytes(shapes.data(FAR, [1.0, 1.0], {}))
        places = [pair.place() for _ in range(ROUND)]
        errors = [tried(shapes, place, table)[0] for place in places]
        found = float(np.quantile(np.concatenate(errors), LEVEL))
        step(f"{len(shapes)} shapes, 95 % below {100 * found:.2f} %")
        # a round has few states: well below, so that a larger sample holds
        if found < 0.8 * error:
            return
        learn(shapes, places, errors, error, most, step)
        shapes.keep(kept)


def learn(
    shapes: Shapes, places: list[Place], errors: list[Vector], error: float, most: int,
    step: Callable[[str], None],
) -> None:  # fmt: skip
    """Adds shapes of places that were tried and err by too much."""
    found = float(np.quantile(np.concatenate(errors), LEVEL))
    needed = NEEDED * error if found < FAR_OFF * error else 0.0
    for place, own in zip(places, errors, strict=True):
        if len(shapes) < most and len(own) and own.max() > needed:
            shapes.add(place)
            step(f"{len(shapes)} shapes, 95 % below {100 * found:.2f} %")


def judge(
    shapes: Shapes, check: int, table: Path, about: dict[str, Any], step: Callable[[str], None]
) -> tuple[bytes, list[Place], list[Vector]]:
    """The table's bytes with its error from so many states of places that made no shape, these
    places, and their errors of the force."""
    table.write_bytes(shapes.data(FAR, [1.0, 1.0], {}))
    places = [shapes.pair.place() for _ in range(-(-check // STATES))]
    told = []
    for number, place in enumerate(places, start=1):
        told.append(tried(shapes, place, table))
        step(f"{len(shapes)} shapes, held out {number}/{len(places)}")
    reach = float(max(distance(shapes, place) for place in places))
    force, moment = (np.concatenate(errors) for errors in zip(*told, strict=True))
    about = {
        **about,
        "error": {
            "force": np.percentile(force, LEVELS).tolist(),
            "moment": np.percentile(moment, LEVELS).tolist(),
            "cases": len(force),
        },
        "shapes": len(shapes),
        "pair": shapes.pair.label,
        "version": _core.version(),
    }
    stated = [float(np.quantile(found, LEVEL)) for found in (force, moment)]
    return shapes.data(reach, stated, about), places, [own for own, _ in told]


def make_shapes(
    pair: Pair, error: float, check: int, threads: int, step: Callable[[str], None],
    most: int, parts: Path,
) -> bytes:  # fmt: skip
    """The bytes of a table for a pair. error: of force over friction's bound, asked for of 95 % of
    the states; check: states that tell it, others each time until it is reached; step: called with
    what is being done; most: shapes; parts: a folder for what is solved, from which a run that was
    stopped goes on. Raises OSError.
    """
    parts.mkdir(parents=True, exist_ok=True)
    kept, table = parts / "shapes.npz", parts / "table.bin"
    shapes = Shapes(pair, threads)
    shapes.go_on(kept)
    while len(shapes) < min(FIRST, most):
        shapes.add(pair.place())
        step(f"{len(shapes)} shapes")
        if len(shapes) % KEPT == 0:
            shapes.keep(kept)
    while True:
        refine(shapes, error, most, table, kept, step)
        about = {"asked": error, "seconds": round(shapes.seconds)}
        data, places, errors = judge(shapes, check, table, about, step)
        if len(shapes) >= most or np.quantile(np.concatenate(errors), LEVEL) <= error:
            return data
        # the rounds' few states were lucky: these are no longer held out
        learn(shapes, places, errors, error, most, step)
        shapes.keep(kept)
