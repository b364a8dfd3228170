"""A figure taken apart into its panels, each a plot of its own, so that they stand side by side or
one below the other as a page's width allows.

Titles of panels, of y axes and the legend become text of the page; what is left of a panel is
traces and two axes. Panels whose x axes are matched keep one x range where one of them is moved;
those whose y axes are matched keep one range.
"""

from __future__ import annotations

import base64
import re
from dataclasses import dataclass, field
from html import escape
from typing import Any

import numpy as np
import plotly.graph_objects as go

# what plotly's texts may have
_MARKUP = re.compile(r"&lt;(/?(?:sub|sup|b|i|br))&gt;")
_UNIT = re.compile(r"^(?P<name>.*?)\s*\[(?P<unit>[^\]]*)\]$")
_EDGE = 0.02  # of the figure's height, between a panel's top and its title
_PAD = 0.05  # of a range that panels share
_MARGINS = 110  # px of a figure that are not panels


@dataclass
class Panel:
    """One pair of axes. title: HTML. link: panels with the same one move together along x."""

    title: str
    traces: list[dict[str, Any]]
    layout: dict[str, Any]
    height: int
    link: str = ""


@dataclass
class Entry:
    """A line of the legend. symbol: "line", "dash", "dot", "circle" or another of plotly's."""

    name: str
    group: str
    color: str
    symbol: str


@dataclass
class Parts:
    """A figure in parts. columns: panels side by side where there is room."""

    panels: list[Panel] = field(default_factory=list)
    legend: list[Entry] = field(default_factory=list)
    columns: int = 1


def parts_of(figure: go.Figure) -> Parts:
    """Panels from top left to bottom right, and the legend."""
    spec = figure.to_dict()
    layout, traces = spec["layout"], spec["data"]
    keys = sorted({(t.get("yaxis") or "y", t.get("xaxis") or "x") for t in traces}, key=_number)
    places = {key: _place(layout, *key) for key in keys}
    keys.sort(key=lambda key: (-round(places[key]["y"][1], 3), places[key]["x"][0]))
    rows = len({round(place["y"][1], 3) for place in places.values()})
    parts = Parts(columns=len({round(place["x"][0], 3) for place in places.values()}))
    shared = _shared_ranges(layout, traces)
    height = max(190, int(((layout.get("height") or 450) - _MARGINS) / max(1, rows)))
    for key in keys:
        own = [t for t in traces if (t.get("yaxis") or "y", t.get("xaxis") or "x") == key]
        parts.panels.append(_panel(layout, key, places[key], own, shared, height))
    if layout.get("showlegend") is not False:
        parts.legend = _legend(traces)
    return parts


def packed(value: Any) -> Any:
    """Of a figure, as JSON has it: arrays of numbers as 4-byte floats, without what is empty."""
    if isinstance(value, dict):
        if "bdata" in value:
            return packed(_unpacked(value))
        return {key: packed(entry) for key, entry in value.items() if entry is not None}
    if isinstance(value, np.ndarray):
        return _array(value)
    if isinstance(value, (list, tuple)):
        if len(value) > 8 and all(isinstance(entry, (int, float)) for entry in value):
            return _array(np.asarray(value, dtype=float))
        return [packed(entry) for entry in value]
    if isinstance(value, np.generic):
        return packed(value.item())
    if isinstance(value, float) and not np.isfinite(value):
        return None
    return value


def marked_up(text: str) -> str:
    """HTML of a text of plotly, whose marks for subscripts and their like stay."""
    return _MARKUP.sub(r"<\1>", escape(text))


def _array(values: np.ndarray) -> Any:
    if values.dtype.kind not in "fiub":
        return [packed(entry) for entry in values.tolist()]
    small = np.ascontiguousarray(values, dtype="<f4")
    found = {"dtype": "f4", "bdata": base64.b64encode(small.tobytes()).decode()}
    return found if small.ndim == 1 else found | {"shape": ",".join(map(str, small.shape))}


def _unpacked(value: dict[str, Any]) -> np.ndarray:
    found = np.frombuffer(base64.b64decode(value["bdata"]), dtype=value["dtype"])
    shape = value.get("shape")
    return found if shape is None else found.reshape([int(n) for n in str(shape).split(",")])


def _number(key: tuple[str, str]) -> tuple[int, int]:
    return int(key[0][1:] or 1), int(key[1][1:] or 1)


def _axis(layout: dict[str, Any], name: str) -> dict[str, Any]:
    return layout.get(f"{name[0]}axis{name[1:]}") or {}


def _place(layout: dict[str, Any], y: str, x: str) -> dict[str, Any]:
    return {k: _axis(layout, n).get("domain") or (0.0, 1.0) for k, n in (("x", x), ("y", y))}


def _source(layout: dict[str, Any], name: str) -> str:
    """The axis that one is matched to, or itself."""
    seen = {name}
    while (other := _axis(layout, name).get("matches")) and other not in seen:
        seen.add(other)
        name = other
    return name


def _title(layout: dict[str, Any], name: str) -> str:
    axis = _axis(layout, name)
    own = (axis.get("title") or {}).get("text") or ""
    if own or not axis.get("matches"):
        return own
    return (_axis(layout, _source(layout, name)).get("title") or {}).get("text") or ""


def _headings(layout: dict[str, Any], place: dict[str, Any]) -> list[str]:
    """Annotations that stand above a panel, from its middle or its left end."""
    (left, right), top = place["x"], place["y"][1]
    found = []
    for note in layout.get("annotations") or ():
        if note.get("xref") != "paper" or note.get("showarrow"):
            continue
        inside = left - 1e-9 <= note["x"] < right or note["x"] == right == 1.0
        if inside and abs(note["y"] - top) < _EDGE:
            found.append((note["x"] - left, note["text"]))
    # a title from the middle is the panel's, one from the left end is that of its y axis
    return [text for _, text in sorted(found, reverse=True)]


def _panel(
    layout: dict[str, Any],
    key: tuple[str, str],
    place: dict[str, Any],
    traces: list[dict[str, Any]],
    shared: dict[str, list[float]],
    height: int,
) -> Panel:
    y, x = key
    headings = _headings(layout, place)
    y_title, x_title = _title(layout, y), _title(layout, x)
    if y_title:
        headings.append(y_title)
    elif _source(layout, y) != y:
        headings += _headings(layout, _place(layout, _source(layout, y), _source(layout, y)))[-1:]
    kept = {name: dict(_axis(layout, axis)) for name, axis in (("x", x), ("y", y))}
    for axis in kept.values():
        for gone in ("anchor", "domain", "matches", "showticklabels", "title", "automargin"):
            axis.pop(gone, None)
    kept["x"]["title"] = {"text": x_title}
    if "scaleanchor" in kept["y"]:
        kept["y"] |= {"scaleanchor": "x", "constrain": "domain"}
        kept["x"]["constrain"] = "domain"
    if (known := shared.get(_source(layout, y))) is not None and "range" not in kept["y"]:
        kept["y"]["range"] = known
    own = [_trace(trace, x_title, headings[-1] if headings else "") for trace in traces]
    inner: dict[str, Any] = {"xaxis": kept["x"], "yaxis": kept["y"]}
    if "coloraxis" in layout:
        inner["coloraxis"] = layout["coloraxis"]
    unique = list(dict.fromkeys(headings))
    return Panel(" · ".join(map(marked_up, unique)), own, inner, height, x_title)


def _trace(trace: dict[str, Any], x_title: str, y_title: str) -> dict[str, Any]:
    found = {k: v for k, v in trace.items() if k not in ("xaxis", "yaxis")}
    found["showlegend"] = False
    if found.get("type", "scatter") in ("scatter", "scattergl"):
        found["type"] = "scatter"
        if found.get("hoverinfo") != "skip":
            found["hovertemplate"] = _hover(found, x_title, y_title)
    elif found["type"] == "heatmap":
        found["hoverongaps"] = False
    return found


def _hover(trace: dict[str, Any], x_title: str, y_title: str) -> str:
    """Name of the curve, then both values with their names and units."""
    lines = ["%{text}"] if trace.get("text") is not None else []
    name = trace.get("name")
    lines += [f"<b>{name}</b>"] if name else []
    for title, key, digits in ((x_title, "x", 4), (y_title, "y", 5)):
        found = _UNIT.match(title)
        text, unit = found.groups() if found else (title, "")
        lines.append(f"{text} %{{{key}:.{digits}g}} {unit}".strip())
    return "<br>".join(lines) + "<extra></extra>"


def _shared_ranges(layout: dict[str, Any], traces: list[dict[str, Any]]) -> dict[str, list[float]]:
    """By y axis that others are matched to: what all their traces need."""
    sources = {_source(layout, f"y{k[5:]}") for k in layout if k.startswith("yaxis")}
    names = [f"y{k[5:]}" for k in layout if k.startswith("yaxis")]
    found = {}
    for source in sources:
        members = [name for name in names if _source(layout, name) == source]
        if len(members) < 2 or _axis(layout, source).get("type") == "log":
            continue
        values = [_values(t) for t in traces if (t.get("yaxis") or "y") in members]
        known = np.concatenate([v[np.isfinite(v)] for v in values]) if values else np.empty(0)
        if known.size:
            low, high = float(known.min()), float(known.max())
            pad = _PAD * (high - low) or 1.0
            found[source] = [low - pad, high + pad]
    return found


def _values(trace: dict[str, Any]) -> np.ndarray:
    values = trace.get("y")
    if isinstance(values, dict):
        values = _unpacked(values)
    if values is None:
        return np.empty(0)
    return np.array([np.nan if v is None else v for v in values], dtype=float)


def _legend(traces: list[dict[str, Any]]) -> list[Entry]:
    found: dict[str, Entry] = {}
    for trace in traces:
        name = trace.get("name")
        if not name or trace.get("showlegend") is False:
            continue
        group = trace.get("legendgroup") or name
        if group in found or trace.get("type") not in (None, "scatter", "scattergl", "bar"):
            continue
        line, marker = trace.get("line") or {}, trace.get("marker") or {}
        lines = "lines" in (trace.get("mode") or "lines")
        color = line.get("color") if lines else marker.get("color")
        symbol = (line.get("dash") or "line") if lines else (marker.get("symbol") or "circle")
        color = color or marker.get("color") or trace.get("fillcolor") or "#8a919c"
        found[group] = Entry(name, group, str(color), symbol.replace("solid", "line"))
    # one curve needs no legend
    return list(found.values()) if len(found) > 1 else []
