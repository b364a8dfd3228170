"""The page of a sweep: what came out, sensitivities, responses, all cases, those that failed."""

from __future__ import annotations

import math
from collections import Counter
from html import escape
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from plotly.subplots import make_subplots

from railpatch.case.load import KINDS
from railpatch.page.document import document
from railpatch.page.figures import COLORS, plot, styled
from railpatch.page.parts import BAD, DOUBT, GOOD, Key, folded, opening
from railpatch.page.tables import number, short, table
from railpatch.page.viewer import Axis, parallel_axes
from railpatch.sweep.outcome import Sweep
from railpatch.sweep.plan import SENSITIVITY
from railpatch.sweep.units import labelled, unit_of_output, unit_of_varied
from railpatch.writing import write_whole

PAGE = "sweep.html"
# of what a page can show at once
MOST_LINES = 5000
MOST_OUTPUTS = 6
MOST_TICKS = 7
MOST_ROWS = 50
MOST_KEYS = 4  # outputs among the key numbers
LARGE = ((1e9, "G"), (1e6, "M"), (1e3, "k"))
SMALL = ((0.1, ""), (1e-3, "m"), (1e-6, "\u00b5"), (1e-9, "n"))
PREFIXES = {**dict.fromkeys(("N", "N m", "Pa", "W", "J"), LARGE), "m": SMALL}
MEANS = 20  # places along a key where the mean is drawn
# told where a key was varied so; its name has "(log)" there
LOGARITHMIC = "Axes of keys with (log) are logarithmic, as their ranges are divided."

Array = NDArray[np.float64]


def write_page(sweep: Sweep) -> Path:
    """Writes the page into the sweep's folder. Raises OSError."""
    body = "".join([*_opening(sweep), *_sections(sweep)])
    return write_whole(sweep.folder / PAGE, document(sweep.plan.name, body).encode())


def output_values(sweep: Sweep, name: str) -> Array:
    """Of every case, NaN where it has none: texts too."""
    place = sweep.outputs.index(name)
    values = [row.outputs[place] for row in sweep.rows]
    return np.array([v if isinstance(v, int | float) else np.nan for v in values], dtype=float)


def key_values(sweep: Sweep, key: str) -> tuple[Array, list[str] | None]:
    """Of every case; texts as numbers of their order, with the texts."""
    place = sweep.plan.keys.index(key)
    values = [point[place] for point in sweep.plan.points]
    if all(isinstance(v, int | float) and not isinstance(v, bool) for v in values):
        return np.array(values, dtype=float), None
    texts = list(dict.fromkeys(map(str, values)))
    return np.array([texts.index(str(v)) for v in values], dtype=float), texts


def unit_of(sweep: Sweep, name: str) -> str:
    """Of an output."""
    return unit_of_output(sweep.plan.kind, name)


def output_label(sweep: Sweep, name: str) -> str:
    """With its unit."""
    return labelled(name, unit_of(sweep, name))


def key_label(sweep: Sweep, key: str) -> str:
    """With its unit, and whether its axis is logarithmic."""
    name = f"{key} (log)" if is_logarithmic(sweep, key) else key
    return labelled(name, unit_of_varied(sweep.plan.kind, key))


def is_logarithmic(sweep: Sweep, key: str) -> bool:
    """Whether the key's range was divided by its logarithm; all its values are > 0 then."""
    return sweep.plan.vary[sweep.plan.keys.index(key)].logarithmic


def with_unit(text: str, unit: str) -> str:
    """A number's text."""
    shown = unit.replace("^2", "\u00b2").replace("^3", "\u00b3")
    return f"{text}\u00a0{shown}" if unit else text


def glance(values: Array, unit: str) -> str:
    """Numbers that are read at a glance, with one prefix: 762 to 798 MPa."""
    size = float(np.nanmax(np.abs(values)))
    found = (p for p in PREFIXES.get(unit, ()) if size >= p[0])
    least, prefix = next(found, (1.0, ""))
    factor = least if prefix else 1.0
    texts = dict.fromkeys(short(float(value) / factor) for value in values)
    return with_unit(" to ".join(texts), prefix + unit)


def _opening(sweep: Sweep) -> list[str]:
    """What came out, and what did not."""
    plan, failed = sweep.plan, sweep.failed
    kind = "one contact each" if plan.kind in KINDS else f"a run of the kind {plan.kind} each"
    count, good = len(sweep.rows), len(sweep.rows) - len(failed)
    shown = shown_outputs(sweep)
    keys = [_range(sweep, name) for name in shown[:MOST_KEYS]]
    state = GOOD if good == count else DOUBT if good else BAD
    keys.append(Key("cases with a result", f"{good} of {count}", "", state))
    verdict = f"All {count} cases have a result."
    if failed:
        verdict = f"{good} of {count} cases have a result; {len(failed)} have none."
    if shown:
        name = shown[0]
        values = output_values(sweep, name)
        at = int(np.nanargmax(np.abs(values)))
        far = glance(values[at : at + 1], unit_of(sweep, name))
        verdict += f" {name} is farthest from zero, {far}, at {_at(sweep, at)}."
    verdict += _strongest(sweep, shown)
    about = f"{plan.table.scene}, {kind}; design {plan.table.design}"
    parts = [opening(plan.name, about, verdict, keys, state), _left_out(shown, MOST_KEYS)]
    if failed:
        counts = Counter(sweep.rows[i].status for i in failed)
        told = ", ".join(f"{count} {status}" for status, count in counts.items())
        parts.append(f'<p class="warn">{escape(told)}: see the end of this page.</p>')
    return parts


def _left_out(names: list[str], most: int) -> str:
    """What of the outputs is not shown here, and where it is; nothing where all are."""
    more = names[most:]
    if not more:
        return ""
    text = f"{len(more)} more of {len(names)} outputs are in the table below, Results: "
    return f"<p class=sub>{escape(text + ', '.join(more))}.</p>"


def _unvaried(sweep: Sweep) -> str:
    """Outputs that are the same in all cases, with their value, and those that no case has a number
    of; nothing where there are none."""
    count, told, empty = len(sweep.rows), [], []
    for name in sweep.outputs:
        values = output_values(sweep, name)
        known = values[np.isfinite(values)]
        if not known.size:
            empty.append(name)
        elif count > 1 and not varies(values):
            there = f"all {count}" if known.size == count else f"the {known.size} of {count}"
            having = "" if known.size == count else " that have it"
            shown = glance(known[:1], unit_of(sweep, name))
            told.append(f"{name} is {shown}, the same in {there} cases{having}")
    if empty:
        told.append(f"no case has a number of {', '.join(empty)}")
    return f"<p class=sub>{escape('; '.join(told))}.</p>" if told else ""


def varies(values: Array) -> bool:
    """Whether an output has more than one value."""
    return bool(np.nanmax(values) > np.nanmin(values))


def _range(sweep: Sweep, name: str) -> Key:
    """Least and greatest of an output."""
    values = output_values(sweep, name)
    unit, ends = unit_of(sweep, name), np.array([np.nanmin(values), np.nanmax(values)])
    mean = np.array([np.nanmean(values)])
    return Key(name, glance(ends, unit), f"mean {glance(mean, unit)}")


def _strongest(sweep: Sweep, shown: list[str]) -> str:
    """The key that most of the first output's variance goes with, where the design tells."""
    if sweep.plan.table.design not in SENSITIVITY or not shown:
        return ""
    values = output_values(sweep, shown[0])
    if not np.isfinite(values).all():
        return ""
    from railpatch.sweep.sensitivity import indices_of

    # mu* of Morris stands second, the total index of Sobol fourth
    place = 1 if sweep.plan.table.design == "morris" else 3
    found = max(indices_of(sweep.plan, values), key=lambda row: float(row[place]))
    return f" It depends most on {found[0]}."


def shown_outputs(sweep: Sweep) -> list[str]:
    """Those that are numbers, and vary where any does."""
    known = [name for name in sweep.outputs if np.isfinite(output_values(sweep, name)).any()]
    return [name for name in known if varies(output_values(sweep, name))] or known


def _sections(sweep: Sweep) -> list[str]:
    shown, parts = shown_outputs(sweep), []
    if shown:
        parts += _sensitivities(sweep, shown)
        parts += _responses(sweep, shown)
        parts += _extremes(sweep, shown)
    parts.append(_unvaried(sweep))
    if shown:
        parts += _parallel(sweep, shown)
    warned = Counter(text for row in sweep.rows for text in row.warnings)
    if warned:
        parts.append(
            "<h2>Warnings</h2>"
            + table(
                ["cases", "text"], [[count, text] for text, count in warned.most_common(MOST_ROWS)]
            )
        )
    parts += _failed(sweep)
    took = sum(row.seconds for row in sweep.rows)
    lines = [
        ["scene", sweep.plan.table.scene],
        ["design", sweep.plan.table.design],
        ["time", f"{took:.3g} s of all cases, {sweep.wall_time:.3g} s now"],
        ["cases that were there", str(sweep.reused)],
    ]
    return [*parts, folded("How it was computed", table([], lines, "summary"), on_paper=True)]


def _extremes(sweep: Sweep, names: list[str]) -> list[str]:
    """Least, mean and greatest of each output, and where."""
    rows = []
    for name in names:
        values = output_values(sweep, name)
        low, high = int(np.nanargmin(values)), int(np.nanargmax(values))
        rows.append(
            [
                name,
                unit_of(sweep, name) or "-",
                number(values[low]),
                number(float(np.nanmean(values))),
                number(values[high]),
                _at(sweep, high),
            ]
        )
    head = ["output", "unit", "least", "mean", "greatest", "greatest at"]
    return ["<h2>Results</h2>" + table(head, rows)]


def _at(sweep: Sweep, case: int) -> str:
    pairs = zip(sweep.plan.keys, sweep.plan.points[case], strict=True)
    texts = ((key, f"{v:.5g}" if isinstance(v, float) else str(v)) for key, v in pairs)
    kind = sweep.plan.kind
    return ", ".join(f"{key} {with_unit(v, unit_of_varied(kind, key))}" for key, v in texts)


def _responses(sweep: Sweep, outputs: list[str]) -> list[str]:
    """Each output over each key: cases, and their mean."""
    names, left_out = outputs[:MOST_OUTPUTS], _left_out(outputs, MOST_OUTPUTS)
    keys = sweep.plan.keys
    figure = make_subplots(
        rows=len(names),
        cols=len(keys),
        shared_yaxes=True,
        horizontal_spacing=0.03,
        vertical_spacing=0.2 / len(names),
    )
    for column, key in enumerate(keys, 1):
        at, texts = key_values(sweep, key)
        logarithmic = is_logarithmic(sweep, key)
        for row, name in enumerate(names, 1):
            values = output_values(sweep, name)
            few = _few(len(at))
            figure.add_scatter(
                x=at[few],
                y=values[few],
                mode="markers",
                name="case",
                showlegend=False,
                marker={"size": 4, "color": COLORS["left"], "opacity": 0.5},
                row=row,
                col=column,
            )
            x, mean = _means(at, values, logarithmic=logarithmic)
            figure.add_scatter(
                x=x,
                y=mean,
                mode="lines",
                name="mean",
                showlegend=False,
                line={"color": COLORS["right"], "width": 2},
                row=row,
                col=column,
            )
            # each has its own: on a narrow screen they stand below each other
            figure.update_xaxes(title_text=key_label(sweep, key), row=row, col=column)
            if logarithmic:
                ticks = logarithmic_ticks(at)
                shown = {"tickvals": ticks, "ticktext": [f"{tick:g}" for tick in ticks]}
                figure.update_xaxes(type="log", **shown, row=row, col=column)
            if texts:
                figure.update_xaxes(
                    tickvals=list(range(len(texts))), ticktext=texts, row=row, col=column
                )
            if column == 1:
                figure.update_yaxes(title_text=output_label(sweep, name), row=row, col=column)
    styled(figure, 120 + 240 * len(names))
    text = "Dots are cases, the line is their mean along the key."
    if any(is_logarithmic(sweep, key) for key in keys):
        text += f" {LOGARITHMIC}"
    text = f"<p class=sub>{text}</p>{left_out}"
    figure.update_xaxes(exponentformat="SI")
    figure.update_yaxes(exponentformat="SI")
    return ["<h2>Responses</h2>" + text + plot(figure, "responses")]


def logarithmic_ticks(values: Array) -> list[float]:
    """1, 2 and 5 of each decade within the values, or powers of ten where these are many."""
    low, high = float(np.nanmin(values)), float(np.nanmax(values))
    powers = range(math.floor(math.log10(low)), math.ceil(math.log10(high)) + 1)
    found = [float(f"{digit}e{power}") for power in powers for digit in (1, 2, 5)]
    inside = [tick for tick in found if low <= tick * (1 + 1e-9) and tick <= high * (1 + 1e-9)]
    return inside if len(inside) <= MOST_TICKS else [float(f"1e{power}") for power in powers]


def _few(count: int) -> NDArray[np.int64]:
    """Evenly spread places of what is drawn."""
    return np.unique(np.linspace(0, count - 1, min(count, MOST_LINES)).astype(np.int64))


def _means(at: Array, values: Array, *, logarithmic: bool = False) -> tuple[Array, Array]:
    """Mean of an output over a key, at its values or over parts of its range, or of the range of
    its logarithm."""
    if logarithmic:
        places, means = _means(np.log(at), values)
        return np.exp(places), means
    known = np.isfinite(values)
    at, values = at[known], values[known]
    places = np.unique(at)
    if len(places) > MEANS:
        edges = np.linspace(at.min(), at.max(), MEANS + 1)
        part = np.clip(np.searchsorted(edges, at, side="right") - 1, 0, MEANS - 1)
        places = 0.5 * (edges[:-1] + edges[1:])
    else:
        part = np.searchsorted(places, at)
    count = np.bincount(part, minlength=len(places))
    sums = np.bincount(part, weights=values, minlength=len(places))
    there = count > 0
    return places[there], sums[there] / count[there]


def _parallel(sweep: Sweep, names: list[str]) -> list[str]:
    """All keys and outputs of each case as a line."""
    few = _few(len(sweep.rows))
    color = output_values(sweep, names[0])[few]
    known = np.isfinite(color)
    axes = []
    for key in sweep.plan.keys:
        at, texts = key_values(sweep, key)
        axes.append(Axis(key_label(sweep, key), at[few][known], texts, is_logarithmic(sweep, key)))
    axes += [Axis(output_label(sweep, name), output_values(sweep, name)[few][known])
             for name in names[:MOST_OUTPUTS]]  # fmt: skip
    left = len(sweep.rows) - int(known.sum())
    text = f"<p class=sub>{left} cases are not drawn.</p>" if left else ""
    text += _left_out(names, MOST_OUTPUTS)
    shown = parallel_axes("parallel", axes, len(sweep.plan.keys))
    return ["<h2>All cases</h2>" + text + wide(shown, len(axes) // 2)]


def wide(figure: str, columns: int) -> str:
    """A figure that is moved sideways where the page is too narrow for its columns."""
    least = min(1100, 120 + 150 * columns)
    return f'<div class="scroll"><div style="min-width: {least}px">{figure}</div></div>'


def _sensitivities(sweep: Sweep, names: list[str]) -> list[str]:
    if sweep.plan.table.design not in SENSITIVITY:
        return []
    from railpatch.sweep.sensitivity import indices_of

    parts = ["<h2>Sensitivities</h2>"]
    morris = sweep.plan.table.design == "morris"
    if morris:
        text = (
            "Elementary effects (Morris 1991, Technometrics 33; Campolongo, Cariboni and "
            "Saltelli 2007): mu* is the mean size of the output's change when the key goes "
            "through its range, sigma how far that change depends on the place."
        )
        head = ["output", "key", "unit", "mu*", "\u00b1 95 %", "sigma"]
    else:
        text = (
            "Sobol's indices (Sobol 2001, Mathematics and Computers in Simulation 55; Saltelli "
            "et al. 2010): the part of the output's variance that goes with the key alone, and "
            "with it and its interactions."
        )
        head = ["output", "key", "first", "\u00b1 95 %", "total", "\u00b1 95 %"]
    parts.append(f"<p class=sub>{escape(text)}</p>")
    rows, open_ones = [], []
    for name in names:
        values = output_values(sweep, name)
        missing = int((~np.isfinite(values)).sum())
        if missing:
            open_ones.append(f"{name}: {missing} cases have no value")
            continue
        for key, *found in indices_of(sweep.plan, values):
            unit = [unit_of(sweep, name) or "-"] if morris else []  # Sobol's are shares
            rows.append([name, key, *unit, *map(number, found)])
    if rows:
        parts.append(table(head, rows))
    if open_ones:
        parts.append(
            f'<p class="warn">Indices need every case: {escape("; ".join(open_ones))}.</p>'
        )
    return parts


def _failed(sweep: Sweep) -> list[str]:
    failed = sweep.failed
    if not failed:
        return []
    rows = [
        [i, sweep.rows[i].status, _at(sweep, i), sweep.rows[i].reason or ""]
        for i in failed[:MOST_ROWS]
    ]
    more = len(failed) - len(rows)
    text = f"<p>And {more} more: they are in sweep.parquet.</p>" if more > 0 else ""
    return [
        "<h2>Cases without a good result</h2>"
        + table(["case", "status", "at", "reason"], rows)
        + text
    ]
