"""The table as bytes; core/fast/creep_table.hpp tells the form."""

from __future__ import annotations

import json
from typing import Any

import numpy as np

from railpatch.case.creep_table import BODY, HEAD, MAGIC, checksum
from railpatch.evidence.table.recipe import Recipe
from railpatch.evidence.table.spline import Coefficients


def pack(recipe: Recipe, c: Coefficients, about: dict[str, Any], error: list[float]) -> bytes:
    """The bytes of a table. about: what else the recipe's text tells; error: of force and moment,
    95th percentile."""
    text = json.dumps({**json.loads(recipe.text()), **about}, sort_keys=True).encode()
    counts = (recipe.ratios + 3, recipe.psi + 3, recipe.theta + 3, recipe.t + 3)
    low, high = np.log(recipe.lowest_ratio), np.log(recipe.highest_ratio)
    body = BODY.pack(
        *counts, len(text), 0, *recipe.poisson_ratio, low, high, recipe.radius,
        *c.remainder_scale, *error,
    )  # fmt: skip
    scale = c.scale.astype("<f8").tobytes()
    body += scale + c.linear.tobytes() + padded(c.remainder.tobytes()) + padded(text)
    return HEAD.pack(MAGIC, HEAD.size + len(body), checksum(body)) + body


def padded(data: bytes) -> bytes:
    """To a multiple of 8 bytes."""
    return data + bytes(-len(data) % 8)
