"""The page of a match: what was found, measured and computed with bands, and how sure it is."""

from __future__ import annotations

from dataclasses import dataclass
from html import escape

import numpy as np
import plotly.graph_objects as go
from numpy.typing import ArrayLike, NDArray

from railpatch.match.found import Judged, Match
from railpatch.match.judge import NORMAL_95, correlations
from railpatch.match.plan import input_name, observed_name
from railpatch.page.document import document
from railpatch.page.figures import COLORS, GREY, plot, styled
from railpatch.page.parts import DOUBT, GOOD, PLAIN, Key, folded, opening
from railpatch.page.tables import number, short, table
from railpatch.record.quantities import BY_NAME
from railpatch.record.units import UNITS, Unit, dimension_of
from railpatch.report.data import SHOWN

DASHES = ("solid", "dash", "dot", "dashdot")
# of points left out, %: with fewer in their band of 95 % the band is in doubt
LEAST_WITHIN = 85.0
MOST_KEYS = 4  # parameters among the key numbers
BAND = "rgba(59,125,196,0.18)"


@dataclass(frozen=True)
class Shown:
    """The unit that the record has of a quantity: its name, "" of a plain number, and its size."""

    name: str
    unit: Unit

    def values(self, si: ArrayLike) -> NDArray[np.float64]:
        """Of values in SI units."""
        return (np.asarray(si, dtype=float) - self.unit.offset) / self.unit.factor

    def differences(self, si: ArrayLike) -> NDArray[np.float64]:
        """Of differences and deviations in SI units."""
        return np.asarray(si, dtype=float) / self.unit.factor

    def label(self, name: str) -> str:
        """A name with the unit."""
        return f"{name} [{self.name}]" if self.name else name


PLAIN_NUMBER = Shown("", Unit(1.0))


def page_of(match: Match) -> str:
    """The whole page."""
    own = match.explanations[0]
    parts = [opening_of(match)]
    if own.not_told:
        items = "".join(f"<li>{escape(text)}</li>" for text in own.not_told)
        parts.append(f"<div class=warn><b>What these points cannot tell</b><ul>{items}</ul></div>")
    for place in range(len(match.plan.table.observed)):
        parts.append(
            f"<h2>{escape(label_of(match, place))}</h2>"
            + plot(curves_of(match, place), f"curves-{place}")
        )
        parts.append(plot(residual_figure(match, place), f"left-{place}"))
    parts += [parameters_of(own), chains_of(match), screening_of(own), samples_of(own)]
    if own.rows is not None:
        parts.append(rows_of(own))
    if len(match.explanations) > 1:
        parts.append(explanations_of(match))
    if len(own.parameters) > 1:
        parts.append(correlations_of(own))
    parts.append(details_of(match))
    return document(match.plan.name, "".join(parts))


def opening_of(match: Match) -> str:
    """The verdict and the key numbers."""
    own = match.explanations[0]
    keys = [
        Key(p.key, short(p.value), f"{short(p.low)} to {short(p.high)} (95 %)")
        for p in own.parameters[:MOST_KEYS]
    ]
    for place, rms in enumerate(own.fit.rms):
        off = float(shown_of(match, place).differences(rms))
        keys.append(Key(f"off {label_of(match, place)}", short(off), "root mean square"))
    state = PLAIN
    if own.predicted is not None:
        share = 100 * own.predicted.within
        state = GOOD if share >= LEAST_WITHIN else DOUBT
        keys.append(
            Key("points left out, in their band", f"{share:.0f} %", "95 % are expected", state)
        )
    points = int(own.search.there.sum())
    names = ", ".join(f"{p.key} {short(p.value)}" for p in own.parameters)
    best = best_of(match)
    verdict = f"{names}, from {points} points."
    if len(match.explanations) > 1:
        name = best.explanation.name
        verdict += f" Of {len(match.explanations)} explanations, {name} predicts best."
    if own.not_told:
        verdict += " Not all of it is told by these points."
        state = DOUBT
    about = f"{match.plan.source}: parameters, with intervals of 95 %"
    return opening(match.plan.name, about, verdict, keys, state)


def best_of(match: Match) -> Judged:
    """The explanation that predicts best."""
    return min(match.explanations, key=rank)


def rank(judged: Judged) -> float:
    """Less is better: by points left out, else by Akaike's criterion."""
    return -judged.predicted.density if judged.predicted else judged.criterion


def parameters_of(own: Judged) -> str:
    """Each with its interval and range."""
    rows = [
        [p.key, number(p.value), number(p.low), number(p.high), *(number(e) for e in p.of_range)]
        for p in own.parameters
    ]
    head = ["parameter", "value", "from", "to", "sought from", "to"]
    return "<h2>Parameters</h2>" + table(head, rows)


def chains_of(match: Match) -> str:
    """Factors and offsets of measuring chains; nothing without."""
    lines = []
    for key, parts in match.explanations[0].chains.items():
        shown = shown_of(match, list(match.plan.table.observed).index(key))
        for name, (value, error) in parts.items():
            unit = shown if name == "offset" else PLAIN_NUMBER
            ends = (value, value - NORMAL_95 * error, value + NORMAL_95 * error)
            lines.append(
                [key, name, unit.name or "-", *(number(float(unit.differences(v))) for v in ends)]
            )
    head = ["measured", "of its chain", "unit", "value", "from", "to"]
    return "<h2>Measuring chains</h2>" + table(head, lines) if lines else ""


def screening_of(own: Judged) -> str:
    """What the points feel; nothing without."""
    if not own.screening:
        return ""
    lines = [
        [key, number(one.effect), number(one.spread), "yes" if one.felt else "no"]
        for key, one in own.screening.items()
    ]
    text = (
        "<p>How far a measured number moves from end to end of a parameter's range (rms, in its "
        "error; Morris's elementary effects), and the spread of that over the trajectories.</p>"
    )
    return (
        "<h2>What the points feel</h2>"
        + text
        + table(["parameter", "effect", "spread", "felt"], lines)
    )


def samples_of(own: Judged) -> str:
    """Of the posterior; nothing without."""
    lines = [
        [key, number(one.median), number(one.low), number(one.high)]
        for key, one in own.samples.items()
    ]
    head = ["parameter", "median", "from", "to"]
    return "<h2>Samples of the posterior</h2>" + table(head, lines) if lines else ""


def rows_of(own: Judged) -> str:
    """What each row has for itself, with ends of 95 %."""
    rows = own.rows
    assert rows is not None
    quantity = BY_NAME[rows.name]
    unit = next(iter(UNITS[quantity.dimension]))
    factor, shown = SHOWN.get(unit, (1.0, unit))
    figure = go.Figure()
    figure.add_scatter(
        x=rows.progress,
        y=factor * rows.values,
        error_y={
            "type": "data",
            "symmetric": False,
            "array": factor * (rows.high - rows.values),
            "arrayminus": factor * (rows.values - rows.low),
        },
        mode="markers",
        marker={"color": COLORS["left"], "size": 6},
        name="found, with ends of 95 %",
    )
    name = rows.name.replace("_", " ")
    figure.update_xaxes(title="progress of the run")
    figure.update_yaxes(title=f"{name} [{shown}]")
    return f"<h2>{escape(name.capitalize())} of each row</h2>" + plot(styled(figure, 360), "rows")


def explanations_of(match: Match) -> str:
    """All beside each other, the one that predicts best first."""
    rows, values, first = [], [], shown_of(match, 0)
    for judged in sorted(match.explanations, key=rank):
        held, name = judged.predicted, judged.explanation.name
        rows.append(
            [
                name,
                number(float(first.differences(judged.fit.rms[0]))),
                number(float(first.differences(held.rms[0]))) if held else "-",
                f"{100 * held.within:.0f} %" if held else "-",
                number(held.density) if held else "-",
                number(judged.criterion),
            ]
        )
        values += [
            [name, p.key, number(p.value), number(p.low), number(p.high)] for p in judged.parameters
        ]
    rms = first.label("rms")
    head = ["explanation", rms, f"{rms}, left out", "within 95 %", "log likelihood", "Akaike"]
    text = (
        "<p>Points left out in turn and predicted by the rest: their rms, the part of them inside "
        "the band of 95 % and the mean logarithm of their likelihood, by which explanations are "
        "ordered; Akaike's criterion, of all points, is the less the better.</p>"
    )
    found = ["explanation", "parameter", "value", "from", "to"]
    return f"<h2>Explanations</h2>{text}{table(head, rows)}{table(found, values)}"


def shown_of(match: Match, place: int) -> Shown:
    """The record's unit of what was observed."""
    key, column = list(match.plan.table.observed.items())[place]
    if match.plan.record is None:
        return of_run(match, key)
    return shown_as("" if column.over else match.plan.record.units.get(observed_name(key), ""))


def shown_of_input(match: Match, name: str) -> Shown:
    """The record's unit of an input."""
    if match.plan.record is None:
        return of_run(match, name)
    return shown_as(match.plan.record.units.get(input_name(name), ""))


def of_run(match: Match, name: str) -> Shown:
    """The record's unit of a run's quantity; the SI unit of what the record does not have."""
    own = next(iter(UNITS[BY_NAME[name].dimension]), "") if name in BY_NAME else ""
    return shown_as(match.plan.units.get(name) or own)


def shown_as(unit: str) -> Shown:
    """A unit by its name."""
    if unit in ("", "-"):
        return PLAIN_NUMBER
    dimension = dimension_of(unit)
    return Shown(unit, UNITS[dimension][unit]) if dimension else Shown(unit, Unit(1.0))


def label_of(match: Match, place: int) -> str:
    """Of what was observed, with its unit."""
    key, column = list(match.plan.table.observed.items())[place]
    name = key if match.plan.record is not None else key.replace("_", " ")
    return f"{name} / {column.over}" if column.over else shown_of(match, place).label(name)


def input_label(match: Match, name: str) -> str:
    """Of an input, with its unit."""
    return shown_of_input(match, name).label(name)


def curves_of(match: Match, place: int) -> go.Figure:
    """Measured points and computed curves over the first input, with the band of 95 %, in the
    record's units."""
    own, shown = match.explanations[0], shown_of(match, place)
    name, at = next(iter(own.search.model.inputs.items()))
    at = shown_of_input(match, name).values(at)
    order = np.argsort(at, kind="stable")
    figure = go.Figure()
    spread = shown.differences(NORMAL_95 * own.fit.spread[place][order])
    computed = shown.values(own.fit.computed[place][order])
    figure.add_scatter(
        x=np.concatenate([at[order], at[order][::-1]]),
        y=np.concatenate([computed + spread, (computed - spread)[::-1]]),
        mode="lines",
        fill="toself",
        fillcolor=BAND,
        line={"width": 0},
        hoverinfo="skip",
        name="95 % of points",
    )
    for number_, judged in enumerate(match.explanations):
        figure.add_scatter(
            x=at[order],
            y=shown.values(judged.fit.computed[place][order]),
            mode="lines",
            name=judged.explanation.name,
            line={
                "dash": DASHES[number_ % len(DASHES)],
                "color": COLORS["left"] if number_ == 0 else GREY,
            },
        )
    figure.add_scatter(
        x=at,
        y=shown.values(own.search.measured[place]),
        mode="markers",
        name="measured",
        marker={"color": COLORS["right"], "size": 6},
    )
    figure.update_xaxes(title=input_label(match, name))
    figure.update_yaxes(title=label_of(match, place))
    return styled(figure, 440)


def residual_figure(match: Match, place: int) -> go.Figure:
    """Measured minus computed, over the same."""
    own, shown = match.explanations[0], shown_of(match, place)
    name, at = next(iter(own.search.model.inputs.items()))
    figure = go.Figure()
    figure.add_scatter(
        x=shown_of_input(match, name).values(at),
        y=shown.differences(own.fit.left[place]),
        mode="markers",
        marker={"color": COLORS["right"], "size": 6},
        name="measured minus computed",
    )
    figure.update_xaxes(title=input_label(match, name))
    figure.update_yaxes(title=shown.label("difference"))
    figure.update_layout(showlegend=False)
    return styled(figure, 260)


def correlations_of(own: Judged) -> str:
    """Of the parameters."""
    keys = [p.key for p in own.parameters]
    rows = [
        [key, *(number(float(v)) for v in row)]
        for key, row in zip(keys, correlations(own.fit), strict=True)
    ]
    return "<h2>Correlations</h2>" + table(["", *keys], rows)


def details_of(match: Match) -> str:
    """What was done, folded."""
    own, options = match.explanations[0], match.plan.table
    noise = own.fit.noise
    each = [(shown_of(match, place), error) for place, error in enumerate(noise.error)]
    errors = [f"{number(float(one.differences(error)))} {one.name}".strip() for one, error in each]
    lines = [
        ["record", match.plan.source],
        ["loss", options.loss],
        ["starts", str(options.starts)],
        ["intervals", options.intervals],
        ["noise of a point", ", ".join(errors)],
        ["of the model, over that", number(noise.size)],
        ["over, in standard deviations of the inputs", number(noise.length) if noise.size else "-"],
        ["evaluations of all points", str(sum(j.evaluations for j in match.explanations))],
        ["time", f"{match.seconds:.3g} s"],
    ]
    return folded("How it was found", table([], lines, "summary"), on_paper=True)
