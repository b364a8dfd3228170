"""Makes docs/vehicle.svg and prints the tables of docs/vehicle.md. Takes some minutes.

python docs/vehicle.py FILE.svg [SECONDS]
"""

from __future__ import annotations

import sys
from pathlib import Path

import matplotlib

matplotlib.use("svg")
import matplotlib.pyplot as plt

from wheelset_demo.vehicle import Simulation, load_vehicle_scene
from wheelset_demo.vehicle.compare import HEADER, THEORIES, rows_of, with_theory
from wheelset_demo.vehicle.trace import (
    VehicleSummary,
    VehicleTrace,
    run_vehicle,
    summarise,
)

CHOSEN = ("fastsim", "kik", "full", "fitted")
DRAWN = {"fastsim": "C1", "full": "C0"}
RESULTS = ("theory", "Y/Q", "sum of Y kN", "Q kN", "offset mm", "car body m/s^2", "friction kJ")


def runs(duration: float) -> dict[str, tuple[VehicleTrace, VehicleSummary]]:
    """By theory."""
    scene = load_vehicle_scene().with_run(duration=duration)
    found = {}
    for name in CHOSEN:
        simulation = Simulation(with_theory(scene, name))
        trace = run_vehicle(simulation)
        found[name] = trace, summarise(trace, simulation)
        print(name, found[name][1].text(), sep="\n", file=sys.stderr, flush=True)
    return found


def markdown(header: tuple[str, ...], rows: list[list[str]]) -> str:
    """A table."""
    return "\n".join(
        "| " + " | ".join(row) + " |" for row in [header, ["---"] * len(header), *rows]
    )


def results(name: str, summary: VehicleSummary) -> list[str]:
    """A row of what the vehicle did."""
    low, high = (force / 1e3 for force in summary.load_range)
    lateral, vertical = summary.comfort
    return [
        THEORIES[name].text,
        f"{summary.derailment:.3f}",
        f"{summary.shift / 1e3:.1f}",
        f"{low:.1f} to {high:.1f}",
        f"{1e3 * summary.offset:.2f}",
        f"{lateral:.3f}, {vertical:.3f}",
        f"{sum(summary.friction) / 1e3:.1f}",
    ]


def figure(found: dict[str, tuple[VehicleTrace, VehicleSummary]], file: Path) -> None:
    """Of the leading wheelset and the car body along the track."""
    plt.rcParams.update({"svg.hashsalt": "vehicle", "font.size": 8, "path.simplify_threshold": 1.0})
    _, axes = plt.subplots(4, 1, figsize=(8, 8), sharex=True, constrained_layout=True)
    labels = ("y of wheelset 1, mm", "Y, outer wheel 1, kN", "Q, outer wheel 1, kN")
    for name, colour in DRAWN.items():
        trace = found[name][0]
        s = trace.array("positions")[:, 0]
        means = [trace.array(key)[:, 0] / 1e3 for key in ("mean_guiding", "mean_loads")]
        values = (1e3 * trace.array("lateral")[:, 0], *means)
        for ax, value, label in zip(axes, values, labels, strict=False):
            ax.plot(s[::5], value[::5], colour, lw=0.7, label=THEORIES[name].text)
            ax.set_ylabel(label)
        axes[3].plot(s[::5], trace.array("felt")[::5, 1], colour, lw=0.7)
    axes[3].set(ylabel="felt at the car body\nlateral, m/s^2", xlabel="m along the track")
    axes[0].legend(loc="upper right")
    plt.savefig(file, metadata={"Date": None})


def main() -> None:
    """Runs, figure, tables."""
    found = runs(float(sys.argv[2]) if len(sys.argv) > 2 else 20.0)
    figure(found, Path(sys.argv[1]))
    print(markdown(HEADER, rows_of({name: summary for name, (_, summary) in found.items()})))
    print()
    print(markdown(RESULTS, [results(name, summary) for name, (_, summary) in found.items()]))


if __name__ == "__main__":
    main()
