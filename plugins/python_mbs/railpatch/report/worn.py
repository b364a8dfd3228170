"""Wear over the profiles of a run whose scene asked for [damage]."""

from __future__ import annotations

import tempfile
from pathlib import Path
from typing import Any

import numpy as np
import plotly.graph_objects as go
from plotly.subplots import make_subplots

from railpatch.case.types import BODIES, SIDES
from railpatch.errors import ProfileError
from railpatch.log.reader import Run
from railpatch.log.worn import worn_of
from railpatch.page import tables
from railpatch.page.figures import GREY, LINES, plot, styled
from railpatch.profiles import load_profile
from railpatch.report.scene import scene_of

Wheel = tuple[int, str]
TEXT = (
    "Of the whole run, by y of each profile as it was given, flange or gauge side at negative y: "
    "depth that has worn off, measured across y, of wheels spread round them, of {counterpart}. "
    "Mass is that of the patches themselves, which each body loses, and over the profiles the sum "
    "of the distribution; depths are the greatest."
)
SPREAD = {"rail": "rails along the way of the run", "roller": "rollers round them"}
# m, that profiles are shown beyond what is worn
MARGIN = 0.012


def sections(run: Run) -> list[str]:
    """HTML; nothing where the log has none."""
    found = worn_of(run)
    if not found:
        return []
    kind = run.metadata["railpatch"].get("track_kind") or "rail"
    text = TEXT.format(counterpart=SPREAD.get(kind, SPREAD["rail"]))
    return [
        f"<h2>Wear over the profiles</h2><p>{text}</p>",
        tables.table(head(kind), [row(wheel, values, kind) for wheel, values in found.items()]),
        plot(figure(run, found, kind), "wear"),
    ]


def scale_of(body: str, kind: str) -> tuple[float, str]:
    """Of depths: a rail is passed once, which leaves nanometres."""
    return (1e9, "nm") if (body, kind) == ("rail", "rail") else (1e6, "µm")


def head(kind: str) -> tuple[str, ...]:
    """Of the table."""
    wheel, rail = (scale_of(body, kind)[1] for body in BODIES)
    return (
        *("wheel", "way [m]", "mass [g]", "over the wheel [g]", f"over the {kind} [g]"),
        *(f"wheel depth [{wheel}]", "at y [mm]", f"{kind} depth [{rail}]", "at y [mm]"),
    )


def row(wheel: Wheel, values: dict[str, Any], kind: str) -> list[object]:
    """Of the table."""
    cells: list[object] = [f"{wheel[0]} {wheel[1]}", tables.short(values["way"])]
    cells += [tables.short(1e3 * values[name]) for name in ("mass", "wheel_mass", "rail_mass")]
    y = np.array(values.get("y") or [np.nan])
    for body in BODIES:
        depth = np.array(values.get(f"{body}_depth") or [0.0])
        factor, _ = scale_of(body, kind)
        cells += [tables.short(factor * depth.max()), tables.short(1e3 * y[depth.argmax()])]
    return cells


def figure(run: Run, found: dict[Wheel, dict[str, Any]], kind: str) -> go.Figure:
    """Depths of wheels and rails, left beside right, over their profiles where these are known."""
    shown = make_subplots(
        4,
        2,
        row_heights=[0.32, 0.18, 0.32, 0.18],
        horizontal_spacing=0.1,
        vertical_spacing=0.06,
        subplot_titles=("left", "right"),
    )
    for (number, side), values in found.items():
        column, name = SIDES.index(side) + 1, f"wheelset {number}"
        for body in BODIES:
            shown.add_trace(
                go.Scatter(
                    x=1e3 * np.array(values.get("y") or []),
                    y=scale_of(body, kind)[0] * np.array(values.get(f"{body}_depth") or []),
                    name=name,
                    legendgroup=name,
                    showlegend=body == "wheel" and side == "left" and len(found) > len(SIDES),
                    mode="lines",
                    line={"color": LINES[(number - 1) % len(LINES)], "width": 1.5},
                ),
                row=2 * BODIES.index(body) + 1,
                col=column,
            )
    for side in SIDES:
        reach = reach_of(found, side)
        for body in BODIES:
            place = 2 * BODIES.index(body) + 2, SIDES.index(side) + 1
            _add_profile(shown, profile_of(run, body, side), reach, place)
        shown.update_xaxes(range=[1e3 * end for end in reach], col=SIDES.index(side) + 1)
    for place, body in enumerate(BODIES):
        name, unit = kind if body == "rail" else body, scale_of(body, kind)[1]
        shown.update_yaxes(title_text=f"{name} depth [{unit}]", row=2 * place + 1, col=1)
        shown.update_yaxes(title_text="z [mm]", autorange="reversed", row=2 * place + 2, col=1)
        shown.update_yaxes(autorange="reversed", row=2 * place + 2, col=2)
        shown.update_xaxes(title_text=f"y on the {name}'s profile [mm]", row=2 * place + 2)
    return styled(shown, 760)


def reach_of(found: dict[Wheel, dict[str, Any]], side: str) -> tuple[float, float]:
    """m, of what is shown of both profiles of a side: what is worn, and a margin."""
    worn = [values["y"] for (_, own), values in found.items() if own == side and values.get("y")]
    if not worn:
        return -5 * MARGIN, 5 * MARGIN
    return min(map(min, worn)) - MARGIN, max(map(max, worn)) + MARGIN


def _add_profile(
    shown: go.Figure,
    points: tuple[np.ndarray, np.ndarray] | None,
    reach: tuple[float, float],
    place: tuple[int, int],
) -> None:
    if points is None:
        return
    inside = (points[0] >= reach[0]) & (points[0] <= reach[1])
    y, z = (part[inside] for part in points)
    line = go.Scatter(
        x=1e3 * y, y=1e3 * z, mode="lines", line={"color": GREY, "width": 1.5}, showlegend=False
    )
    shown.add_trace(line, row=place[0], col=place[1])


def profile_of(run: Run, body: str, side: str) -> tuple[np.ndarray, np.ndarray] | None:
    """m, y and z of the scene's profile, built in or attached; None where it is not known."""
    named = scene_of(run).get("profiles") or {}
    name = named.get(f"{body}_{side}") or named.get(body)
    if not isinstance(name, str):
        return None
    try:
        attached = run.attachments.get(Path(name).name)
        if attached is None:
            profile = load_profile(name, body)
        else:
            with tempfile.TemporaryDirectory() as folder:
                file = Path(folder) / Path(name).name
                file.write_bytes(attached.data)
                profile = load_profile(file, body)
    except (ProfileError, OSError):
        return None
    return np.asarray(profile.y), np.asarray(profile.z)
