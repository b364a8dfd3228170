"""Forces where contacts appear and join, and through standstill: draws docs/continuity.svg.

One S1002 wheel under 10 kN on UIC60 at 1:40, the rules and speeds of docs/continuity.md.

    python docs/continuity.py docs/continuity.svg
"""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Any

from railpatch.evidence.continuity import scenes
from railpatch.evidence.continuity.scenes import MICRO
from railpatch.evidence.continuity.sweep import Path as SweepPath
from railpatch.evidence.continuity.sweep import Sweep, measure

# y, m, and yaw, rad
EVENTS = {
    "a second contact vanishes": (5.12e-3, 5.25e-3, 0.0),
    "two contacts become one": (6.51e-3, 6.57e-3, 0.012),
}


def lateral(rule: str, start: float, stop: float, yaw: float) -> Sweep:
    """Steps of a micrometre."""
    case = scenes.wheel_case(1e4)
    case["method"] = {"patch_rule": rule}

    def changes(y: float) -> dict[str, Any]:
        return {"y": y, "yaw": yaw}

    return measure(case, SweepPath("y", changes, start, stop, MICRO, MICRO))


def standstill(speed: float) -> Sweep:
    """Through standstill with the given standstill_speed, m/s."""
    case = scenes.wheel_case(1e4)
    case["method"] = {"standstill_speed": speed}
    return measure(case, scenes.standstill())


def main() -> None:
    import matplotlib

    matplotlib.use("svg")
    from matplotlib import pyplot

    matplotlib.rcParams.update({"svg.hashsalt": "railpatch", "font.size": 9})
    figure, panels = pyplot.subplots(1, 3, figsize=(10.5, 3.6), layout="constrained")

    def plot(panel: Any, sweep: Sweep, name: str, new: bool, component: int) -> None:
        style = {"color": "C3", "lw": 1.4} if new else {"color": "0.55", "lw": 2.6}
        forces = sweep.forces[:, -1, component]
        panel.plot(sweep.path.scale * sweep.at, forces, label=name, **style)
        print(f"{name}: jump {sweep.jump:.3f} % of the load")

    for panel, (event, place), component in zip(panels, EVENTS.items(), (0, 1), strict=False):
        plot(panel, lateral("contact", *place), "contact", False, component)
        plot(panel, lateral("blended", *place), "blended", True, component)
        panel.set_title(event)
        panel.set_xlabel("y [mm]")
        panel.set_ylabel(f"F{'xy'[component]} [% of the load]")
    plot(panels[2], standstill(0.0), "0", False, 1)
    plot(panels[2], standstill(1e-3), "1 mm/s", True, 1)
    panels[2].set_title("standstill_speed")
    panels[2].set_xlabel("speed [mm/s]")
    panels[2].set_ylabel("Fy [% of the load]")
    for panel in panels:
        panel.grid(alpha=0.3)
        panel.legend()
    path = Path(sys.argv[1] if len(sys.argv) > 1 else Path(__file__).with_suffix(".svg"))
    figure.savefig(path, metadata={"Date": None, "Creator": None})
    print(path)


if __name__ == "__main__":
    main()
