"""The page on profiles that wear."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import plotly.graph_objects as go

from railpatch.page.document import document
from railpatch.page.figures import LINES, plot, styled
from railpatch.page.parts import Key, opening
from railpatch.wear.evolve import read_points
from railpatch.writing import write_whole

SHOWN = 6  # profiles


def write_wear_page(rows: list[dict[str, Any]], folder: Path, name: str) -> Path:
    """wear.html in the folder, of rows as wear_profiles gives them."""
    last = rows[-1]
    mass = sum(last["mass"].values())
    keys = [
        Key("distance", f"{1e-3 * last['distance']:.4g} km", f"{len(rows) - 1} steps"),
        Key("worn off", f"{1e3 * mass:.4g} g", f"of {len(last['mass'])} wheels"),
        Key("greatest depth", f"{1e3 * last['depth']:.3g} mm"),
        Key("mass balance", f"{100 * max(abs(r['balance']) for r in rows):.2g} %", "worst step"),
    ]
    body = [
        opening(
            f"Wear: {name}", "Wheel profiles that wear over a mix of cases.",
            f"{1e3 * last['depth']:.3g} mm worn off after {1e-3 * last['distance']:.4g} km", keys,
        ),
    ]  # fmt: skip
    for side in last["profiles"]:
        body += [
            f"<h2>Profile, {side} wheel</h2>",
            plot(profiles_figure(rows, folder, side), f"profile-{side}"),
            plot(depth_figure(rows, folder, side), f"depth-{side}"),
        ]
    body += [
        "<h2>Over the way</h2>",
        plot(course_figure(rows, "conicity", "equivalent conicity"), "conicity"),
        plot(course_figure(rows, "y_over_q", "greatest Y/Q of the mix"), "quotient"),
    ]
    page = folder / "wear.html"
    write_whole(page, document(f"wear {name}", "".join(body)).encode())
    return page


def shown(rows: list[dict[str, Any]]) -> list[dict[str, Any]]:
    """Some of them, the first and the last among these."""
    count = min(SHOWN, len(rows))
    places = {round(k * (len(rows) - 1) / max(count - 1, 1)) for k in range(count)}
    return [rows[k] for k in sorted(places)]


def profiles_figure(rows: list[dict[str, Any]], folder: Path, side: str) -> go.Figure:
    """z over y, down."""
    figure = go.Figure()
    for color, row in zip(LINES, shown(rows), strict=False):
        y, z = read_points(folder / row["profiles"][side])
        figure.add_scatter(x=1e3 * y, y=1e3 * z, name=label(row), line={"color": color})
    styled(figure, 380)
    figure.update_xaxes(title_text="y, mm")
    figure.update_yaxes(title_text="z, mm", autorange="reversed")
    return figure


def depth_figure(rows: list[dict[str, Any]], folder: Path, side: str) -> go.Figure:
    """What has worn off over y."""
    figure = go.Figure()
    y, new = read_points(folder / rows[0]["profiles"][side])
    for color, row in zip(LINES, shown(rows), strict=False):
        _, z = read_points(folder / row["profiles"][side])
        figure.add_scatter(x=1e3 * y, y=1e3 * (new - z), name=label(row), line={"color": color})
    styled(figure, 380)
    figure.update_xaxes(title_text="y, mm")
    figure.update_yaxes(title_text="wear depth, mm")
    return figure


def course_figure(rows: list[dict[str, Any]], name: str, words: str) -> go.Figure:
    """A number of each row over the way."""
    known = [row for row in rows if row[name] is not None]
    figure = go.Figure()
    figure.add_scatter(
        x=[1e-3 * row["distance"] for row in known], y=[row[name] for row in known],
        mode="lines+markers", name=words, line={"color": LINES[0]}, showlegend=False,
    )  # fmt: skip
    styled(figure, 320)
    figure.update_xaxes(title_text="way, km")
    figure.update_yaxes(title_text=words)
    return figure


def label(row: dict[str, Any]) -> str:
    """Of a profile."""
    return f"{1e-3 * row['distance']:.4g} km"
