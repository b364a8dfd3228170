"""Results in CONTACT's units and signs: mm, N, N/mm^2, of body 1 (the rail), creepages of body 1
minus body 2."""

from __future__ import annotations

from typing import Any

import numpy as np

FIELDS = {
    "x": ("x", 1e3),
    "y": ("y", 1e3),
    "h": ("undeformed_distance", 1e3),
    "mu": ("friction", 1.0),
    "pn": ("pressure", 1e-6),
    "eldiv": ("element_division", 1.0),
    "taucrt": ("yield_stress", 1e-6),
}
VECTORS = {"px,py": ("traction", -1e-6), "sx,sy": ("micro_slip", -1.0)}


def patch_in_contact(
    patch: dict[str, Any],
    offset: tuple[float, float] = (0.0, 0.0),
    motion: dict[str, Any] | None = None,
) -> dict[str, Any]:
    """Of one patch: FN, FX, FY (N), MZ (N mm), PEN (mm), CKSI, CETA (-), CPHI (rad/mm), areas
    (mm^2), PMAX (N/mm^2), VELOC (mm/s), TMAX (degrees C, greatest temperature), and with fields
    these; of a shift CKSI and CETA in mm, CPHI in rad, slip in mm, and no VELOC. offset: m, of the
    origin that moments and spin are about from the contact's. motion: of the case, whose creepages
    are given and in no result. What the case has not is null."""
    shift = (motion or {}).get("regime") == "shift"
    # creepages and slip are of rolling, or in m
    length = 1e3 if shift else 1.0
    patch = (motion or {}) | {key: value for key, value in patch.items() if value is not None}
    force = patch.get("creep_force") or [None, None]
    spin, creepage = patch.get("spin_creepage"), patch.get("creepage") or [None, None]
    moment = patch.get("spin_moment")
    if moment is not None:
        moment += offset[0] * force[1] - offset[1] * force[0]
    if spin is not None and creepage[0] is not None:
        creepage = [creepage[0] + spin * offset[1], creepage[1] - spin * offset[0]]
    found = {
        "status": patch["status"],
        "FN": patch["normal_force"],
        "FX": scaled(force[0], -1.0),
        "FY": scaled(force[1], -1.0),
        "MZ": scaled(moment, -1e3),
        "PEN": scaled(patch["approach"], 1e3),
        "CKSI": scaled(creepage[0], -length),
        "CETA": scaled(creepage[1], -length),
        "CPHI": scaled(spin, -1e-3 * length),
        "VELOC": None if shift else scaled(patch.get("rolling_speed"), 1e3),
        "AREA": scaled(patch["contact_area"], 1e6),
        "PMAX": scaled(patch["max_pressure"], 1e-6),
        "TMAX": patch.get("max_temperature"),
    }
    return found | fields_in_contact(patch, offset, length)


def fields_in_contact(
    patch: dict[str, Any], offset: tuple[float, float], length: float = 1.0
) -> dict[str, Any]:
    """[rows][columns], of a patch with fields. length: what slip is told in, of our unit."""
    found = {}
    for name, (own, unit) in FIELDS.items():
        if (values := patch.get(own)) is not None:
            moved = {"x": 1e3 * offset[0], "y": 1e3 * offset[1]}.get(name, 0.0)
            found[name] = (unit * np.asarray(values, dtype=float) + moved).tolist()
    for names, (own, unit) in VECTORS.items():
        if (values := patch.get(own)) is not None:
            unit *= length if own == "micro_slip" else 1.0
            for name, part in zip(names.split(","), np.asarray(values, dtype=float), strict=True):
                found[name] = (unit * part).tolist()
    if (values := patch.get("temperature")) is not None:
        wheel, rail = np.asarray(values, dtype=float)
        found |= {"temp1": rail.tolist(), "temp2": wheel.tolist()}
    return found


def in_contact(
    result: dict[str, Any],
    offset: tuple[float, float] = (0.0, 0.0),
    motion: dict[str, Any] | None = None,
) -> dict[str, Any]:
    """Of a patch, a wheel or a wheelset."""
    if "left" in result:
        sides = {name: in_contact(result[name]) for name in ("left", "right")}
        return {"status": result["status"], "Z_WS": scaled(result["z"], 1e3), **sides}
    if "patches" not in result:
        return patch_in_contact(result, offset, motion)
    force = [scaled(value, -1.0) for value in result["force"]]
    return {
        "status": result["status"],
        "Z_WS": scaled(result.get("z"), 1e3),
        **dict(zip(("FX_TR", "FY_TR", "FZ_TR"), force, strict=True)),
        "patches": [place_in_contact(patch) for patch in result["patches"]],
    }


def place_in_contact(patch: dict[str, Any]) -> dict[str, Any]:
    """Of a wheel's patch: with its place in the track (mm) and angle (rad)."""
    place = [scaled(value, 1e3) for value in patch["position"]]
    names = ("XCP_TR", "YCP_TR", "ZCP_TR")
    return (
        patch_in_contact(patch)
        | dict(zip(names, place, strict=True))
        | {"DELTCP_TR": patch["contact_angle"]}
    )


def scaled(value: float | None, unit: float) -> float | None:
    """Also of none; no -0."""
    return None if value is None else unit * value + 0.0


def without_fields(value: Any) -> Any:
    """The same without arrays of elements."""
    names = {*FIELDS, "px", "py", "sx", "sy", "temp1", "temp2"}
    if isinstance(value, dict):
        return {key: without_fields(part) for key, part in value.items() if key not in names}
    return [without_fields(part) for part in value] if isinstance(value, list) else value


def for_matlab(value: Any) -> Any:
    """What scipy writes: no null, lists of numbers as arrays, of tables as cells."""
    if value is None:
        return float("nan")
    if isinstance(value, dict):
        return {name: for_matlab(part) for name, part in value.items()}
    if isinstance(value, list):
        if value and isinstance(value[0], dict):
            cells = np.empty(len(value), dtype=object)
            for place, part in enumerate(value):
                cells[place] = for_matlab(part)
            return cells
        return np.asarray(value, dtype=float)
    return value
