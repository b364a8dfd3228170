"""The page on profiles that wear."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import plotly.graph_objects as go

from railpatch.page.document import document
from railpatch.page.figures import LINES, plot, styled
from railpatch.page.parts import Key, folded, opening
from railpatch.page.tables import number, table
from railpatch.wear.evolve import read_points
from railpatch.writing import write_whole

SHOWN = 6  # profiles


def write_wear_page(rows: list[dict[str, Any]], folder: Path, name: str) -> Path:
    """wear.html in the folder, of rows as wear_profiles gives them."""
    last = rows[-1]
    mass = sum(last["mass"].values())
    deepest = f"{1e3 * last['depth']:.3g} mm"
    way = f"{1e-3 * last['distance']:.4g} km"
    keys = [
        Key("worn off", f"{1e3 * mass:.4g} g", f"of {len(last['mass'])} wheels"),
        Key("greatest depth", deepest, f"after {way}"),
        *course_key(rows, "conicity", "equivalent conicity"),
        *course_key(rows, "y_over_q", "greatest Y/Q of the mix"),
    ]
    verdict = (
        f"After {way} the wheels have lost {1e3 * mass:.4g} g, {deepest} at the deepest place."
    )
    body = [opening(f"Wear: {name}", "Wheel profiles that wear over a mix of cases", verdict, keys)]
    for sides, heads in groups(rows, folder):
        body += [
            f"<h2>{heads}</h2>",
            plot(depth_figure(rows, folder, sides[0]), f"depth-{sides[0]}"),
            plot(profiles_figure(rows, folder, sides[0]), f"profile-{sides[0]}"),
        ]
    body += [
        "<h2>Over the way</h2>",
        plot(course_figure(rows, "conicity", "equivalent conicity"), "conicity"),
        plot(course_figure(rows, "y_over_q", "greatest Y/Q of the mix"), "quotient"),
        folded("Steps", steps_table(rows)),
    ]
    page = folder / "wear.html"
    write_whole(page, document(f"wear {name}", "".join(body)).encode())
    return page


def course_key(rows: list[dict[str, Any]], name: str, words: str) -> list[Key]:
    """A number at the end, beside what it was at first; none where it was not found."""
    known = [row[name] for row in rows if row[name] is not None]
    return [Key(words, f"{known[-1]:.3f}", f"{known[0]:.3f} at first")] if known else []


def groups(rows: list[dict[str, Any]], folder: Path) -> list[tuple[list[str], str]]:
    """Wheels whose profiles are the same at every step, together, with a head for them."""
    found: dict[tuple[bytes, ...], list[str]] = {}
    for side in rows[-1]["profiles"]:
        texts = tuple((folder / row["profiles"][side]).read_bytes() for row in rows)
        found.setdefault(texts, []).append(side)
    return [
        (sides, "Both wheels" if len(sides) > 1 else f"{sides[0].capitalize()} wheel")
        for sides in found.values()
    ]


def steps_table(rows: list[dict[str, Any]]) -> str:
    """All rows, with how well the profiles' volume is the contacts' mass."""
    head = ["way [km]", "worn off [g]", "greatest depth [mm]", "mass balance open by [%]",
            "equivalent conicity", "greatest Y/Q"]  # fmt: skip
    cells = [
        [
            number(1e-3 * row["distance"]), number(1e3 * sum(row["mass"].values())),
            number(1e3 * row["depth"]), f"{100 * abs(row['balance']):.2g}",
            *("-" if row[name] is None else number(row[name]) for name in ("conicity", "y_over_q")),
        ]
        for row in rows
    ]  # fmt: skip
    return table(head, cells)


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
