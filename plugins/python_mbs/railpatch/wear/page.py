"""The page on profiles that wear."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import plotly.graph_objects as go

from railpatch.page.document import document
from railpatch.page.figures import LINES, plot, styled
from railpatch.page.parts import Key, folded, opening
from railpatch.page.tables import number, table
from railpatch.wear.evolve import FILES, read_points
from railpatch.writing import write_whole

SHOWN = 6  # profiles


def write_wear_page(rows: list[dict[str, Any]], folder: Path, name: str) -> Path:
    """wear.html in the folder, of rows as wear_profiles gives them."""
    last = rows[-1]
    deepest = f"{1e3 * last['depth']:.3g} mm"
    lost = []
    if "mass" in last:
        lost.append(("wheels", f"{1e3 * sum(last['mass'].values()):.4g} g", len(last["mass"])))
    if "rail_mass" in last:
        metre = f"{1e3 * sum(last['rail_mass'].values()):.4g} g/m"
        lost.append(("rails", metre, len(last["rail_mass"])))
    keys = [Key(f"worn off {what}", mass, f"of {count} {what}") for what, mass, count in lost]
    keys += [
        Key("greatest depth", deepest, f"after {label(last)}"),
        *course_key(rows, "conicity", "equivalent conicity"),
        *course_key(rows, "y_over_q", "greatest Y/Q of the mix"),
    ]
    masses = " and ".join(f"the {what} have lost {mass}" for what, mass, _ in lost)
    verdict = f"After {label(last)} {masses}, {deepest} at the deepest place."
    what = " and ".join(what for what, _, _ in lost)
    head = f"Profiles of {what} that wear over a mix of cases"
    body = [opening(f"Wear: {name}", head, verdict, keys)]
    for wheel_or_rail, key in FILES.items():
        if key not in last:
            continue
        for sides, heads in groups(rows, folder, wheel_or_rail):
            mark = f"{wheel_or_rail}-{sides[0]}"
            body += [
                f"<h2>{heads}</h2>",
                plot(depth_figure(rows, folder, wheel_or_rail, sides[0]), f"depth-{mark}"),
                plot(profiles_figure(rows, folder, wheel_or_rail, sides[0]), f"profile-{mark}"),
            ]
    body += [
        "<h2>Over the way</h2>",
        plot(course_figure(rows, "conicity", "equivalent conicity"), "conicity"),
        plot(course_figure(rows, "y_over_q", "greatest Y/Q of the mix"), "quotient"),
        folded("Steps", steps_table(rows), on_paper=True),
    ]
    page = folder / "wear.html"
    write_whole(page, document(f"wear {name}", "".join(body)).encode())
    return page


def course_key(rows: list[dict[str, Any]], name: str, words: str) -> list[Key]:
    """A number at the end, beside what it was at first; none where it was not found."""
    known = [row[name] for row in rows if row[name] is not None]
    return [Key(words, f"{known[-1]:.3f}", f"{known[0]:.3f} at first")] if known else []


def groups(rows: list[dict[str, Any]], folder: Path, body: str) -> list[tuple[list[str], str]]:
    """Sides whose profiles are the same at every step, together, with a head for them."""
    found: dict[tuple[bytes, ...], list[str]] = {}
    for side in rows[-1][FILES[body]]:
        texts = tuple((folder / row[FILES[body]][side]).read_bytes() for row in rows)
        found.setdefault(texts, []).append(side)
    return [
        (sides, f"Both {body}s" if len(sides) > 1 else f"{sides[0].capitalize()} {body}")
        for sides in found.values()
    ]


def steps_table(rows: list[dict[str, Any]]) -> str:
    """All rows, with how well the profiles' volume is the contacts' mass."""
    columns: list[tuple[str, Callable[[dict[str, Any]], str]]] = []
    last = rows[-1]
    if "distance" in last:
        columns.append(("way [km]", lambda row: number(1e-3 * row["distance"])))
    if "passages" in last:
        columns.append(("passages", lambda row: number(row["passages"])))
    if "mass" in last:
        columns.append(("off wheels [g]", lambda row: number(1e3 * sum(row["mass"].values()))))
    if "rail_mass" in last:
        columns.append(
            ("off rails [g/m]", lambda row: number(1e3 * sum(row["rail_mass"].values())))
        )
    columns += [
        ("greatest depth [mm]", lambda row: number(1e3 * row["depth"])),
        ("mass balance open by [%]", lambda row: f"{100 * abs(row['balance']):.2g}"),
        ("equivalent conicity", lambda row: known_or_not(row["conicity"])),
        ("greatest Y/Q", lambda row: known_or_not(row["y_over_q"])),
    ]
    return table(
        [head for head, _ in columns], [[cell(row) for _, cell in columns] for row in rows]
    )


def known_or_not(value: float | None) -> str:
    """A number of a row, which it may not have."""
    return "-" if value is None else number(value)


def shown(rows: list[dict[str, Any]]) -> list[dict[str, Any]]:
    """Some of them, the first and the last among these."""
    count = min(SHOWN, len(rows))
    places = {round(k * (len(rows) - 1) / max(count - 1, 1)) for k in range(count)}
    return [rows[k] for k in sorted(places)]


def profiles_figure(rows: list[dict[str, Any]], folder: Path, body: str, side: str) -> go.Figure:
    """z over y, down."""
    figure = go.Figure()
    for color, row in zip(LINES, shown(rows), strict=False):
        y, z = read_points(folder / row[FILES[body]][side])
        figure.add_scatter(x=1e3 * y, y=1e3 * z, name=label(row), line={"color": color})
    styled(figure, 380)
    figure.update_xaxes(title_text="y [mm]")
    figure.update_yaxes(title_text="z [mm]", autorange="reversed")
    return figure


def depth_figure(rows: list[dict[str, Any]], folder: Path, body: str, side: str) -> go.Figure:
    """What has worn off over y."""
    figure = go.Figure()
    y, new = read_points(folder / rows[0][FILES[body]][side])
    for color, row in zip(LINES, shown(rows), strict=False):
        _, z = read_points(folder / row[FILES[body]][side])
        figure.add_scatter(x=1e3 * y, y=1e3 * abs(new - z), name=label(row), line={"color": color})
    styled(figure, 380)
    figure.update_xaxes(title_text="y [mm]")
    figure.update_yaxes(title_text="wear depth [mm]")
    return figure


def course_figure(rows: list[dict[str, Any]], name: str, words: str) -> go.Figure:
    """A number of each row over the way."""
    known = [row for row in rows if row[name] is not None]
    figure = go.Figure()
    figure.add_scatter(
        x=[way_of(row) for row in known], y=[row[name] for row in known],
        mode="lines+markers", name=words, line={"color": LINES[0]}, showlegend=False,
    )  # fmt: skip
    styled(figure, 320)
    figure.update_xaxes(title_text="way [km]" if "distance" in rows[-1] else "passages")
    figure.update_yaxes(title_text=words)
    return figure


def way_of(row: dict[str, Any]) -> float:
    """km, or passages where no wheel wears."""
    return 1e-3 * row["distance"] if "distance" in row else row["passages"]


def label(row: dict[str, Any]) -> str:
    """Of a profile."""
    return f"{way_of(row):.4g} {'km' if 'distance' in row else 'passages'}"
