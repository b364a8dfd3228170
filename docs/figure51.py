"""Asymmetries of traction curves that a frame and conditioning make: draws docs/figure51.svg.

NRC's dry run at 10 mph and 13,750 lb a side with its measured profiles. The report
DOT/FRA/ORD-24/18 (Vollebregt 2024, section 6.1.4, figure 51) counts four deviations of measured
traction curves from what is expected: L/V at no yaw, rising against falling yaw, positive against
negative yaw, left against right wheel. Section 6.3.3 reproduces all but the second.

    python docs/figure51.py docs/figure51.svg
    python docs/figure51.py --sizes           # what each mechanism gives, as tables
"""

from __future__ import annotations

import sys
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from railpatch.case.types import SIDES

from rig_model.balance import Balancer
from rig_model.scene import load_rig_scene

COUNT = 73  # steps of 1 mrad
QUARTER = COUNT // 4
HELD = [[0.0, 0.3e-3], [1.0, 0.3e-3]]  # m, actuators where the published run begins
# m, N: where the published wheelset stands from there, and the lateral forces of the replay there
TABLE = [[-6.9e-3, -54e3], [-0.35e-3, -23e3], [0.0, 0.0], [2.0e-3, 72e3]]
# N/m, N: the published way back from -18 mrad lies 2 mm beside the way out at -2 mrad
FRICTION = [[20e6, 5e3]]
FRAME = {"lateral_position": HELD, "frame.stiffness_table": TABLE}
DRY = FRAME | {"frame.friction": FRICTION}
CONDITIONED = {"conditioning.plateau": 1.2, "conditioning.work": 5e6}
PANELS = {
    "rigid, published positions": {},
    "frame yields": FRAME,
    "frame with dry friction": DRY,
    "and friction that conditions": DRY | CONDITIONED,
}


@dataclass(frozen=True)
class Curves:
    """yaw: rad, [n]. ratio: side -> L/V, [n]; on the wheel."""

    yaw: np.ndarray
    ratio: dict[str, np.ndarray]

    def ways(self, side: str) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Yaw from -18 to 18 mrad, L/V there while it rises and while it falls; at its ends both
        are one."""
        ratio, turn, other = self.ratio[side], QUARTER, 3 * QUARTER
        rising = np.concatenate([ratio[other:-1], ratio[: turn + 1]])
        return self.yaw[turn : other + 1][::-1], rising, ratio[turn : other + 1][::-1]

    def asymmetries(self) -> dict[str, float]:
        """The report's four, each the greatest in L/V."""
        mean = {side: 0.5 * (self.ways(side)[1] + self.ways(side)[2]) for side in SIDES}
        loops = [self.ways(side)[2] - self.ways(side)[1] for side in SIDES]
        turned = {side: np.abs(mean[side][::-1]) for side in SIDES}
        # where yaw is small the signs of L/V at both wheels need not be opposite
        yaw = self.ways("left")[0]
        far = np.abs(yaw) > 1.5e-3
        return {
            "1": float(max(abs(mean[side][len(yaw) // 2]) for side in SIDES)),
            "2": float(max(np.abs(loop).max() for loop in loops)),
            "3": float(max(np.abs(np.abs(mean[s]) - turned[s])[far].max() for s in SIDES)),
            "4": float(np.abs(np.abs(mean["left"]) - turned["right"])[far].max()),
        }

    def returning(self) -> float:
        """Mean of |L/V| at both wheels while |yaw| falls less that while it rises, from 4 mrad."""
        found = []
        for side in SIDES:
            yaw, rising, falling = self.ways(side)
            more = (np.abs(falling) - np.abs(rising)) * np.sign(yaw)
            found.append(more[(np.abs(yaw) > 3.5e-3) & (np.abs(yaw) < 17.5e-3)].mean())
        return float(np.mean(found))


def replayed(**changes: Any) -> Curves:
    """A run of the packaged scene; keys of [rig] that replace its own."""
    overrides = {"positions": COUNT, "balance.method": "newton"} | changes
    scene = load_rig_scene(None, overrides)
    balancer = Balancer(scene)
    yaw, forces = [], []
    for position in scene.positions():
        balance = balancer.solve(position)
        if not balance.converged:
            sys.exit(f"{changes}: {1e3 * position.yaw:.3g} mrad: {balance.status}")
        yaw.append(position.yaw)
        forces.append([balance.result[side]["force"] for side in SIDES])
    force = np.array(forces)
    ratio = {side: force[:, k, 1] / force[:, k, 2] for k, side in enumerate(SIDES)}
    return Curves(np.array(yaw), ratio)


def row(name: str, curves: Curves) -> str:
    """Of a table in Markdown."""
    numbers = [f"{value:.3f}" for value in curves.asymmetries().values()]
    return f"| {name} | {' | '.join(numbers)} | {curves.returning():+.4f} |"


def sizes() -> None:
    """What each mechanism gives, over its parameters."""
    rigid = {"lateral_position": HELD}
    for limit in (2e3, 5e3, 10e3):
        print(row(f"frame, dry friction {1e-3 * limit:g} kN", replayed(**FRAME, **friction(limit))))
    for name, base in (("rigid", rigid), ("frame", FRAME)):
        for plateau, work in ((0.8, 5e6), (1.1, 5e6), (1.2, 5e6), (1.2, 1e6), (1.2, 2e7)):
            keys = {"conditioning.plateau": plateau, "conditioning.work": work}
            shown = f"{name}, plateau {plateau:g}, {1e-6 * work:g} MJ/m"
            print(row(shown, replayed(**base, **keys)), flush=True)
    for stiffness in (5e6, 20e6):
        changes = {"frame.gauge_stiffness": stiffness}
        print(row(f"rigid, gauge {1e-6 * stiffness:g} MN/m", replayed(**rigid, **changes)))


def friction(limit: float) -> dict[str, Any]:
    """A slider whose spring reaches its limit on 0.25 mm."""
    return {"frame.friction": [[limit / 0.25e-3, limit]]}


def draw(runs: dict[str, Curves], path: Path) -> None:
    import matplotlib

    matplotlib.use("svg")
    from matplotlib import pyplot

    matplotlib.rcParams.update({"svg.hashsalt": "railpatch", "font.size": 9})
    figure, panels = pyplot.subplots(
        2, 2, figsize=(9.5, 7.0), sharex=True, sharey=True, layout="constrained"
    )
    for panel, (name, curves) in zip(panels.flat, runs.items(), strict=True):
        for side, colour in zip(SIDES, ("#3b7dc4", "#e0812b"), strict=True):
            yaw, rising, falling = curves.ways(side)
            panel.plot(1e3 * yaw, rising, color=colour, lw=1.4, label=f"{side}, rising")
            panel.plot(1e3 * yaw, falling, "--", color=colour, lw=1.4, label=f"{side}, falling")
        panel.set_title(name)
        panel.grid(alpha=0.3)
    for panel in panels[1]:
        panel.set_xlabel("yaw [mrad]")
    for panel in panels[:, 0]:
        panel.set_ylabel("L/V")
    mark(panels[1, 1], runs["and friction that conditions"])
    panels[0, 0].legend(loc="upper right")
    figure.savefig(path, metadata={"Date": None, "Creator": None})


def mark(panel: Any, curves: Curves) -> None:
    """The four asymmetries, where they are greatest or plain to see."""
    yaw, rising, falling = curves.ways("left")
    loop = int(np.abs(falling - rising).argmax())
    _, right, _ = curves.ways("right")
    places = {
        "1": (0.0, rising[len(yaw) // 2]),
        "2": (1e3 * yaw[loop], 0.5 * (rising + falling)[loop]),
        "3": (-16.0, np.interp(-16e-3, yaw, rising)),
        "4": (16.0, np.interp(16e-3, yaw, right)),
    }
    for number, (x, y) in places.items():
        panel.annotate(
            number,
            (x, y),
            xytext=(0, 14),
            textcoords="offset points",
            ha="center",
            bbox={"boxstyle": "circle", "fc": "white", "lw": 0.7},
            arrowprops={"arrowstyle": "-", "lw": 0.7},
        )


def main() -> None:
    if "--sizes" in sys.argv:
        sizes()
        return
    runs = {name: replayed(**changes) for name, changes in PANELS.items()}
    for name, curves in runs.items():
        print(row(name, curves))
    path = Path(sys.argv[1] if len(sys.argv) > 1 else Path(__file__).with_suffix(".svg"))
    draw(runs, path)
    print(path)


if __name__ == "__main__":
    main()
