"""The measured sweeps as a table and as pictures."""

from __future__ import annotations

import copy
import csv
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from railpatch.evidence.continuity.scenes import Scene
from railpatch.evidence.continuity.sweep import LIMIT, Sweep, measure

RULES = ("blended", "contact")
HEAD = ("scene", "grid", "path", "rule", "jump %", "of", "at", "closer %", "most", "bad", "samples")


@dataclass(frozen=True)
class Entry:
    """One sweep by one rule."""

    scene: Scene
    rule: str
    sweep: Sweep

    def row(self) -> tuple[Any, ...]:
        """What HEAD names."""
        at, component = self.sweep.worst_at
        path = self.scene.path
        return (
            self.scene.name,
            self.scene.grid,
            path.name,
            self.rule,
            f"{self.sweep.worst:.3f}",
            component,
            f"{at * path.scale:.3f}",
            f"{self.sweep.remaining:.3f}" if self.sweep.closer else "",
            self.sweep.most_patches,
            self.sweep.bad,
            len(self.sweep.samples),
        )


def run(scenes: Iterable[Scene], rules: Iterable[str], advance: Callable[[Any], None]):
    """The sweeps of all scenes, one after the other."""
    for scene in scenes:
        for rule in rules:
            case = copy.deepcopy(scene.case)
            case["method"] = {**case.get("method", {}), "patch_rule": rule}
            entry = Entry(scene, rule, measure(case, scene.path, scene.load))
            advance(entry)
            yield entry


def write_table(entries: list[Entry], folder: Path) -> Path:
    """continuity.csv in the folder."""
    folder.mkdir(parents=True, exist_ok=True)
    path = folder / "continuity.csv"
    with path.open("w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(HEAD)
        writer.writerows(entry.row() for entry in entries)
    return path


def draw(entries: list[Entry], folder: Path) -> list[Path]:
    """One picture of each scene in the folder: forces, and jumps beyond the slope."""
    import matplotlib

    matplotlib.use("svg")
    from matplotlib import pyplot

    matplotlib.rcParams.update({"svg.hashsalt": "railpatch", "font.size": 9})
    written = []
    groups: dict[tuple[str, str, str], list[Entry]] = {}
    for entry in entries:
        key = (entry.scene.name, entry.scene.grid, entry.scene.path.name)
        groups.setdefault(key, []).append(entry)
    for key, group in groups.items():
        figure, panels = pyplot.subplots(2, 1, figsize=(7, 5), sharex=True, layout="constrained")
        for entry in reversed(group):
            draw_entry(entry, panels)
        panels[0].set_title(", ".join(key))
        panels[0].set_ylabel("force [% of the load]")
        panels[0].legend(ncols=2)
        panels[1].axhline(LIMIT, color="k", lw=0.8, ls=":")
        panels[1].set_ylabel("jump [% of the load]")
        panels[1].set_ylim(1e-4, None)
        panels[1].set_xlabel(group[0].scene.path.label)
        for panel in panels:
            panel.grid(alpha=0.3)
        name = "_".join("".join(c if c.isalnum() else "_" for c in part) for part in key)
        path = folder / f"{name}.svg"
        figure.savefig(path, metadata={"Date": None, "Creator": None})
        pyplot.close(figure)
        written.append(path)
    return written


def draw_entry(entry: Entry, panels: Any, most: int = 800) -> None:
    """Fx and Fy of the last wheel, and the greatest jump of any component, thinned out."""
    new = entry.rule == RULES[0]
    sweep, scale = entry.sweep, entry.scene.path.scale
    every = max(1, len(sweep.samples) // most)
    for k, name in enumerate(("Fx", "Fy")):
        panels[0].plot(
            scale * sweep.at[::every],
            sweep.forces[::every, -1, k],
            color=f"C{k}" if new else "0.6",
            lw=1.2 if new else 2.4,
            label=f"{name}, {entry.rule}",
        )
    jumps = sweep.jumps.max(axis=(1, 2))
    # the greatest of those left out is kept
    blocks = np.array_split(np.arange(jumps.size), min(most, jumps.size))
    tops = [block[jumps[block].argmax()] for block in blocks]
    style = {"color": "C3" if new else "0.6", "lw": 0.9 if new else 2.0, "label": entry.rule}
    panels[1].semilogy(scale * sweep.at[1:-2][tops], np.maximum(jumps[tops], 1e-4), **style)
