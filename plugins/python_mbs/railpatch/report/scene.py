"""What a log's scene says of a run: friction, load, speed, the wheelset's size."""

from __future__ import annotations

import json
from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

import numpy as np

from railpatch.case.fluid import DRY_FRICTION
from railpatch.case.types import SIDES
from railpatch.log.reader import Run, Series

if TYPE_CHECKING:
    from railpatch.report.data import Positions

EFFECTIVE = "effective.json"
LONGEST = 60  # of a value that is shown
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


def leaves_of(place: str, value: Any) -> Iterator[tuple[str, Any]]:
    """Keys of a scene with their values; lists of tables by number, other lists whole."""
    if isinstance(value, dict):
        for key, inner in value.items():
            yield from leaves_of(f"{place}.{key}" if place else str(key), inner)
    elif isinstance(value, list) and any(isinstance(inner, dict) for inner in value):
        for number, inner in enumerate(value):
            yield from leaves_of(f"{place}[{number}]", inner)
    elif value is not None:
        yield place, value


def differences_of(run: Run, other: Run) -> list[tuple[str, str, str]]:
    """Key, value in a run, value in another one: what their scenes differ in, and files of one name
    with other content. "-" is what a scene has not. Nothing where a log has no scene."""
    own, theirs = (dict(leaves_of("", scene_of(one))) for one in (run, other))
    if not own or not theirs:
        return []
    keys = dict.fromkeys([*own, *theirs])
    found = [
        (key, shown(own.get(key)), shown(theirs.get(key)))
        for key in keys
        if own.get(key) != theirs.get(key)
    ]
    for name in run.attachments.keys() & other.attachments.keys() - {EFFECTIVE}:
        sizes = [len(one.attachments[name].data) for one in (run, other)]
        if run.attachments[name].data != other.attachments[name].data and named(name, own, theirs):
            found.append((f"content of {name}", *(f"{size} bytes" for size in sizes)))
    return found


def named(name: str, *scenes: dict[str, Any]) -> bool:
    """Whether a scene names a file, as a profile; the scene's own file is none of them."""
    return any(value == name for scene in scenes for value in scene.values())


def shown(value: Any) -> str:
    """Of a scene, for a table."""
    text = "-" if value is None else value if isinstance(value, str) else json.dumps(value)
    return text if len(text) <= LONGEST else f"{text[: LONGEST - 4]} ..."


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
