"""Profiles of a case of wheels: files of points, and of slices with features, .slcs along the track
and .slcw round the wheel.

A file of slices holds, in this order: U_OFFSET U_SCALE; NSLC; NFEAT and perhaps NKINK NACCEL;
U_INTPOL; NSLC times u 'file'; with NFEAT > 1 for each slice u and NFEAT places along its profile.
Assumed, as the grammar does not say it: a slice lies at U_OFFSET + U_SCALE u (mm or rad), its file
is named from the folder of the file of slices, and places are arc lengths in mm from the profile's
first point.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from railpatch.errors import CaseError
from railpatch.inp.words import Reader, read_text

MM = 1e-3
BODIES = ("wheel", "rail")
ENDINGS = {"wheel": ".slcw", "rail": ".slcs"}
MOST_SLICES, MOST_FEATURES = 10_000, 100


@dataclass(frozen=True)
class Slice:
    """A profile at a place: mm along the track, or rad round the wheel."""

    place: float
    file: str
    features: tuple[float, ...]  # mm


def profiles_of(
    blocks: dict[str, Any], folder: Path, refuse: Callable[[str], CaseError]
) -> tuple[dict[str, Any], dict[str, list[dict[str, Any]]]]:
    """[profiles], and sections by body where there are some. Raises CaseError."""
    found: dict[str, Any] = {}
    sections: dict[str, list[dict[str, Any]]] = {}
    lengths = []
    for body in BODIES:
        p = blocks[body]
        smooth, method = p["SMOOTH"], int(p.get("ISMOOTH", 0))
        if smooth > 0 and method == 0:
            raise refuse(
                f"SMOOTH = {smooth:g} of {p['file']!r} by ISMOOTH = 0, which is no length (write "
                "SMOOTH = 0, or PRFOPT = 1 and ISMOOTH 1 or 2 first in the line below it),"
            )
        lengths.append(MM * max(smooth, 0.0))
        suffix = Path(p["file"]).suffix.lower()
        if suffix in ENDINGS.values() and suffix != ENDINGS[body]:
            raise refuse(f"{p['file']} as a {body}")
        if suffix == ENDINGS[body]:
            sections[body] = sections_of(read_slices(folder / p["file"], body), body, p["file"])
        if body not in sections:
            found[body] = p["file"]
        elif body == "wheel":
            found[body] = sections[body][0]["profile"]
        mirror = ("y" if p["MIRRORY"] == 1 else "") + ("z" if p.get("MIRRORZ", 0) == 1 else "")
        reading = {"mirror": mirror} if mirror else {}
        if body in sections and not mirror and p.get("MIRRORZ", 0) == -1:
            # a nose has no sides by which up is told from down
            reading["mirror"] = "none"
        if p["SCALE"] not in (0.0, 1.0):
            unit = {1000.0: "m", 25.4: "in"}.get(p["SCALE"])
            if unit is None:
                raise refuse(f"SCALE = {p['SCALE']:g} of a profile (1, 25.4 or 1000)")
            reading["unit"] = unit
        if reading:
            found[f"{body}_file"] = reading
    if lengths[0] != lengths[1]:
        raise refuse("two profiles with different smoothing")
    found["smoothing"] = lengths[0]
    return found, sections


def read_slices(path: Path, body: str) -> list[Slice]:
    """Of a file, by place. Raises CaseError with its line."""
    reader = Reader(path.name, read_text(path))
    angle = body == "wheel"
    offset, scale = reader.real("U_OFFSET", angle=angle), reader.real("U_SCALE")
    if scale == 0:
        raise reader.error("U_SCALE is 0: all slices lie at one place")
    reader.end_line()
    count = reader.integer("NSLC")
    if not 1 <= count <= MOST_SLICES:
        raise reader.error(f"NSLC is {count}, allowed 1 ... {MOST_SLICES}")
    reader.end_line()
    features = reader.integer("NFEAT")
    if not 0 <= features <= MOST_FEATURES:
        raise reader.error(f"NFEAT is {features}, allowed 0 ... {MOST_FEATURES}")
    for name in ("NKINK", "NACCEL"):
        if reader.optional():
            raise reader.error(
                f"{name} has no counterpart: the grammar does not say where they lie"
            )
    reader.end_line()
    if (blend := reader.integer("U_INTPOL")) != 1:
        raise reader.error(f"U_INTPOL = {blend} has no counterpart: slices are interpolated, 1")
    reader.end_line()
    rows = []
    for _ in range(count):
        rows.append((reader.real("u", angle=angle), reader.string("the name of a slice's profile")))
        reader.end_line()
    places: dict[float, tuple[float, ...]] = {}
    for _ in range(count if features > 1 else 0):
        u = reader.real("u of features", angle=angle)
        places[u] = tuple(reader.real("S_F") for _ in range(features))
        if min(places[u]) < 0:
            raise reader.error("S_F is below 0, allowed arc lengths from the profile's first point")
        reader.end_line()
    if places and places.keys() != {u for u, _ in rows}:
        raise reader.error("features are those of other slices than the profiles")
    return sorted(
        (Slice(offset + scale * u, name, places.get(u, ())) for u, name in rows),
        key=lambda one: one.place,
    )


def sections_of(slices: list[Slice], body: str, source: str) -> list[dict[str, Any]]:
    """As a case has them; files named from the folder of the case."""
    folder = Path(source).parent
    found = []
    for one in slices:
        place = (
            {"position": MM * one.place}
            if body == "rail"
            else {"angle": math.fmod(math.fmod(one.place, 2 * math.pi) + 2 * math.pi, 2 * math.pi)}
        )
        features = {"features": [MM * s for s in one.features]} if one.features else {}
        found.append({**place, "profile": str(folder / one.file), **features})
    return sorted(found, key=lambda section: section.get("angle", 0.0))


def put_sections(
    tables: dict[str, Any], sections: dict[str, list[dict[str, Any]]], side: str
) -> None:
    """Into a case's tables."""
    for body, table in (("wheel", "wheelset"), ("rail", "track")):
        if body in sections:
            tables[table].setdefault(side, {})["sections"] = sections[body]
    if any(len(own) > 1 for own in sections.values()):
        tables["track"]["section_blend"] = "cubic"
