"""Layout of panels for viewers of the run log: Foxglove's JSON, which Lichtblick reads too.

The plots are listed in plots.py by topic and field; names and units come from the log's table, so
that a field which is not in the table is an error here.
"""

from __future__ import annotations

import json
from collections.abc import Collection
from typing import Any

from railpatch.layout.plots import KINDS, Curve, Tab, tabs_of
from railpatch.log.channels import WELL_KNOWN

__all__ = ["KINDS", "Curve", "Tab", "layout", "layout_text", "tabs_of", "topics_of"]

# panels of the Foxglove layout are called by their type and an identifier
_SCENE, _RAW, _TABS = "3D!scene", "RawMessages!raw", "Tab!tabs"


def layout_text(kind: str, wheelsets: int = 4, topics: Collection[str] | None = None) -> str:
    """The file of a layout. Arguments and errors as of layout()."""
    return json.dumps(layout(kind, wheelsets, topics), indent=1) + "\n"


def layout(kind: str, wheelsets: int = 4, topics: Collection[str] | None = None) -> dict[str, Any]:
    """A layout: 3D scene, raw messages, tabs of plots.

    kind: one of KINDS. wheelsets: of a vehicle. topics: those of a log; others are left out. Raises
    ValueError for another kind, and where nothing is left.
    """
    if kind not in KINDS:
        raise ValueError(f"kind is {kind!r}; it must be one of {', '.join(KINDS)}")
    if wheelsets < 1:
        raise ValueError(f"wheelsets is {wheelsets}; it must be >= 1")
    tabs = _kept(tabs_of(kind, wheelsets), topics)
    if not tabs:
        raise ValueError("topics: none of them is plotted")
    configs: dict[str, Any] = {}
    entries = []
    for number, tab in enumerate(tabs):
        names = []
        for place, (title, curves) in enumerate(tab.plots.items()):
            name = f"Plot!tab{number}plot{place}"
            configs[name] = _plot(title, curves)
            names.append(name)
        entries.append({"title": tab.title, "layout": _stack(names)})
    configs[_TABS] = {"activeTabIdx": 0, "tabs": entries}
    configs[_RAW] = _raw(tabs[0])
    left: Any = _RAW
    if topics is None or "/tf" in topics:
        configs[_SCENE] = _scene(kind)
        left = {"first": _SCENE, "second": _RAW, "direction": "column", "splitPercentage": 68}
    return {
        "configById": configs,
        "globalVariables": {},
        "userNodes": {},
        "playbackConfig": {"speed": 1},
        "layout": {"first": left, "second": _TABS, "direction": "row", "splitPercentage": 50},
    }


def topics_of(found: dict[str, Any]) -> set[str]:
    """All topics that a layout shows."""
    topics = set()
    for name, config in found["configById"].items():
        if name.startswith("Plot!"):
            topics |= {path["value"].split(".")[0] for path in config["paths"]}
        elif name.startswith("RawMessages!"):
            topics.add(config["topicPath"])
        elif name.startswith("3D!"):
            topics |= set(config["topics"]) | {"/tf"}
    return topics


def _kept(tabs: list[Tab], topics: Collection[str] | None) -> list[Tab]:
    """Tabs and plots that have something to show."""
    if topics is None:
        return tabs
    kept = []
    for tab in tabs:
        plots = {
            title: [curve for curve in curves if curve.topic in topics]
            for title, curves in tab.plots.items()
        }
        plots = {title: curves for title, curves in plots.items() if curves}
        if plots:
            kept.append(Tab(tab.title, plots))
    return kept


def _stack(names: list[str]) -> Any:
    """Panels of equal height, one below the other."""
    if len(names) == 1:
        return names[0]
    share = 100 / len(names)
    return {
        "first": names[0],
        "second": _stack(names[1:]),
        "direction": "column",
        "splitPercentage": share,
    }


def _plot(title: str, curves: list[Curve]) -> dict[str, Any]:
    return {
        "foxglovePanelTitle": title,
        "paths": [
            {
                "value": curve.path,
                "label": curve.label,
                "enabled": True,
                "timestampMethod": "receiveTime",
            }
            for curve in curves
        ],
        "xAxisVal": "timestamp",
        "isSynced": True,
        "showLegend": True,
        # beside the curves: floating it lies over them
        "legendDisplay": "left",
        "showPlotValuesInLegend": False,
        "showXAxisLabels": True,
        "showYAxisLabels": True,
        "sidebarDimension": 180,  # px
    }


def _raw(tab: Tab) -> dict[str, Any]:
    first = next(iter(tab.plots.values()))[0]
    return {"topicPath": first.topic, "diffEnabled": False, "showFullMessageForDiff": False}


def _scene(kind: str) -> dict[str, Any]:
    """The camera looks from ahead, right and above; it follows a vehicle."""
    vehicle = kind == "vehicle"
    return {
        "cameraState": {
            "distance": {"vehicle": 34.0, "roller": 6.0}.get(kind, 4.5),
            "perspective": True,
            "phi": 68.0,
            "thetaOffset": -62.0 if vehicle else -38.0,
            "target": [0, 0, 0],
            "targetOffset": [0, 0, {"vehicle": -1.0, "roller": -0.4}.get(kind, 0.2)],
            "targetOrientation": [0, 0, 0, 1],
            "fovy": 40,
            "near": 0.05,
            "far": 5000,
        },
        "followMode": "follow-pose",
        "followTf": "view" if vehicle else "world",
        "scene": {"transforms": {"showLabel": False, "axisScale": 0, "lineWidth": 0}},
        "transforms": {},
        "topics": {topic: {"visible": True} for topic in WELL_KNOWN if topic.startswith("/scene/")},
        "layers": {},
        "imageMode": {},
    }
