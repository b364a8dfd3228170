"""Makes a table of shapes: core/fast/shape_table.hpp tells what it is and how it is read.

Shapes of random places become nodes where the table so far errs by more than a part of what is
asked for; rounds of them go on until of new places 95 % err by less.
"""

from __future__ import annotations

import json
import struct
import time
from collections.abc import Callable
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np

from railpatch import _core
from railpatch.case.creep_table import SHAPES_BODY, SHAPES_MAGIC, checksum, default_table
from railpatch.evidence.table.blob import padded
from railpatch.evidence.table.pair import CHECK, COARSE, FULL, NODES, Pair, Place, Vector

# long contacts turn from stick to slip between spins of 0.3 and 2
SPINS = np.array([0.0, 0.15, 0.3, 0.5, 0.75, 1.05, 1.5, 2.1, 3.0, 4.5, 7.0, 11.0])
DIRECTIONS, RADII, RADIUS, LANES = 12, 9, 1.7, 8
# of the features over their standard deviation
WEIGHT = np.array([1.5, 1.0, 1.0, 0.5, 1.0, 1.0, 1.0, 0.0])
FIRST, ROUND = 60, 60
STATES = 4  # creepages of a place that is tried
NEEDED = 0.5  # of the error asked for: a shape that errs by less is no node
LEVEL = 0.95
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


class Shapes:
    """The nodes of a table in the making."""

    def __init__(self, pair: Pair, threads: int) -> None:
        self.pair, self.threads = pair, threads
        self.features: list[Vector] = []
        self.remainders: list[Vector] = []
        self.scale = np.ones(8)
        self._v = creepages_of_nodes()

    def __len__(self) -> int:
        return len(self.features)

    def add(self, place: Place) -> None:
        """Solves a node; one that the full theory does not solve everywhere is left out."""
        creepages = self.pair.at_centre(place, self._v.reshape(-1, 3))
        grid = self.pair.grid(place, NODES)
        full, solved = self.pair.solve(place, creepages, FULL, grid, self.threads)
        fast, _ = self.pair.solve(place, creepages, {"tangential": "table"}, COARSE, self.threads)
        if not (solved.all() and np.isfinite(fast).all()):
            return
        missing = full - fast
        # the moment about the pressure's centre
        x, y = place.centre / np.sqrt(np.prod(place.axes))
        missing[:, 2] -= x * missing[:, 1] - y * missing[:, 0]
        rows = missing.reshape(len(SPINS), -1, 3)
        found = np.zeros((len(SPINS), DIRECTIONS, RADII, 3))
        found[:, :, 0] = rows[:, :1]
        found[:, :, 1:] = rows[:, 1:].reshape(len(SPINS), DIRECTIONS, RADII - 1, 3)
        self.features.append(place.features)
        self.remainders.append(found.astype(np.float32))

    def set_scale(self) -> None:
        """By the nodes there are."""
        spread = np.maximum(np.std(self.features, axis=0), 1e-3)
        self.scale = WEIGHT / spread

    def data(self, reach: float, error: list[float], about: dict[str, Any]) -> bytes:
        """The table's bytes."""
        count = len(self)
        remainder = np.array(self.remainders)
        unit = np.maximum(np.abs(remainder).reshape(-1, 3).max(axis=0) / 32767, 1e-9)
        numbers = np.zeros((*remainder.shape[:-1], 4), "<i2")
        numbers[..., :3] = np.round(remainder / unit)
        blocks = -(-count // LANES)
        features = np.full((blocks * LANES, 8), FAR, "<f4")
        features[:count] = np.array(self.features) * self.scale
        lanes = np.ascontiguousarray(features.reshape(blocks, LANES, 8).transpose(0, 2, 1))
        text = json.dumps(about, sort_keys=True).encode()
        body = SHAPES_BODY.pack(
            count, len(text), self.pair.poisson_ratio, reach, RADIUS, *SPINS, *self.scale, *unit,
            *error,
        )  # fmt: skip
        body += lanes.tobytes() + numbers.tobytes() + padded(text) + default_table().tobytes()
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
    return float(np.linalg.norm((nodes - place.features) * shapes.scale, axis=1).min())


def make_shapes(
    pair: Pair, error: float, check: int, threads: int, step: Callable[[str], None],
    most: int,
) -> bytes:  # fmt: skip
    """The bytes of a table for a pair. error: of force over friction's bound, asked for of 95 % of
    the states; check: states that tell it; step: called with what is being done; most: shapes."""
    began = time.perf_counter()
    shapes = Shapes(pair, threads)
    while len(shapes) < min(FIRST, most):
        shapes.add(pair.place())
        step(f"{len(shapes)} shapes")
    shapes.set_scale()
    with TemporaryDirectory() as folder:
        table = Path(folder) / "table.bin"
        found = np.inf
        while len(shapes) < most:
            table.write_bytes(shapes.data(FAR, [1.0, 1.0], {}))
            places = [pair.place() for _ in range(ROUND)]
            errors = [tried(shapes, place, table)[0] for place in places]
            found = float(np.quantile(np.concatenate(errors), LEVEL))
            step(f"{len(shapes)} shapes, 95 % below {100 * found:.2f} %")
            # a round has few states: well below, so that a larger sample holds
            if found < 0.8 * error:
                break
            for place, own in zip(places, errors, strict=True):
                if len(shapes) < most and len(own) and own.max() > NEEDED * error:
                    shapes.add(place)
                    step(f"{len(shapes)} shapes, 95 % below {100 * found:.2f} %")
        made = time.perf_counter() - began
        table.write_bytes(shapes.data(FAR, [1.0, 1.0], {}))
        places = [pair.place() for _ in range(-(-check // STATES))]
        told = []
        for number, place in enumerate(places, start=1):
            told.append(tried(shapes, place, table))
            step(f"{len(shapes)} shapes, held out {number}/{len(places)}")
    reach = float(max(distance(shapes, place) for place in places))
    force, moment = (np.concatenate(errors) for errors in zip(*told, strict=True))
    levels = (50, 95, 99)
    about = {
        "error": {
            "force": np.percentile(force, levels).tolist(),
            "moment": np.percentile(moment, levels).tolist(),
            "cases": len(force),
        },
        "asked": error,
        "shapes": len(shapes),
        "seconds": round(made),
        "pair": pair.label,
        "version": _core.version(),
    }
    stated = [float(np.percentile(found, 95)) for found in (force, moment)]
    return shapes.data(reach, stated, about)
