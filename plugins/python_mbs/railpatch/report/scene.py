"""What a log's scene says of a run: friction, load, speed, the wheelset's size."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any

import numpy as np

from railpatch.case.fluid import DRY_FRICTION
from railpatch.case.types import SIDES
from railpatch.log.reader import Run, Series

if TYPE_CHECKING:
    from railpatch.report.data import Positions

EFFECTIVE = "effective.json"
MPH = 0.44704  # m/s, exactly


def scene_of(run: Run) -> dict[str, Any]:
    """The scene's tables as the run had them; empty of an older log."""
    attached = run.attachments.get(EFFECTIVE)
    if attached is None:
        return {}
    try:
        found = json.loads(attached.data)
    except ValueError:
        return {}
    return found if isinstance(found, dict) else {}


def friction_of(run: Run) -> tuple[float, str]:
    """Greatest coefficient of friction, NaN where it is not known, and what a law makes of it."""
    fluid = scene_of(run).get("fluid") or {}
    if fluid.get("model") == "regimes":
        knots = fluid.get("knots")
        dry = knots[0][3] if knots else DRY_FRICTION
        return float(dry), "of the driest of the water's regimes"
    table = scene_of(run).get("friction") or {}
    if table.get("coefficient") is not None:
        value = table["coefficient"]
        value = float(np.max(value)) if isinstance(value, list) else float(value)
        return value, "constant" if table.get("law") == "coulomb" else f"law {table.get('law')}"
    kinetic, amplitude = table.get("kinetic"), table.get("amplitude")
    if kinetic is None or amplitude is None:
        return float("nan"), ""
    return kinetic + amplitude, f"falls with the speed of slip to {kinetic:g}"


def rolling_speed(contacts: dict[Any, Series]) -> np.ndarray:
    """m/s, of every patch in a log; none where there is no contact."""
    found = [
        patch["rolling_speed"]
        for series in contacts.values()
        for message in series.messages
        for patch in message.get("patches", ())
        if patch.get("rolling_speed") is not None
    ]
    return np.abs(np.array(found, dtype=float))


def speed_of(data: Positions) -> float:
    """m/s, of rolling: of the contacts, else of the wheelset; NaN where neither is known."""
    speeds = rolling_speed(data.contact)
    speeds = speeds if speeds.size else np.abs(data.state["speed"])
    known = speeds[np.isfinite(speeds)]
    return float(np.median(known)) if known.size else float("nan")


def contact_places(data: Positions) -> np.ndarray:
    """m, [n, 2]: lateral position of each wheel's contact, weighted with the load."""
    found = np.full((data.count, len(SIDES)), np.nan)
    for column, side in enumerate(SIDES):
        for row, message in enumerate(data.contact[side].messages):
            patches = [p for p in message.get("patches", ()) if p.get("position")]
            loads = np.array([p.get("normal_force") or 0.0 for p in patches])
            if loads.sum() > 0:
                places = [p["position"][1] for p in patches]
                found[row, column] = float(np.average(places, weights=loads))
    return found
