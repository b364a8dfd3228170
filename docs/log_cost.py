"""What logging takes of runs: the table of docs/logs.md, by wall-clock time on this machine.

python docs/log_cost.py
"""

from __future__ import annotations

import tempfile
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

from railpatch.log import read_run


def rig(path: Path) -> Any:
    from rig_model.run import replay
    from rig_model.scene import load_rig_scene

    return replay(load_rig_scene(), path)


def wheelset(name: str, **keys: Any) -> Callable[[Path], Any]:
    def run(path: Path) -> Any:
        from wheelset_demo.scene import load_wheelset_scene, scene_file
        from wheelset_demo.simulation import run_scene

        return run_scene(load_wheelset_scene(scene_file(name), keys), path)

    return run


def vehicle(theory: str, duration: float) -> Callable[[Path], Any]:
    def run(path: Path) -> Any:
        from wheelset_demo.vehicle.compare import run_summary, with_theory
        from wheelset_demo.vehicle.scene import load_vehicle_scene

        scene = load_vehicle_scene(None, {"duration": duration})
        return run_summary(with_theory(scene, theory), None, path)

    return run


RUNS: dict[str, Callable[[Path], Any]] = {
    "roller rig, 37 positions": rig,
    "wheelset, `s1002.toml`, 3 s": wheelset("s1002.toml"),
    "the same, 12 s": wheelset("s1002.toml", distance=240.0),
    "wheelset, `hunting.toml`, 10 s": wheelset("hunting.toml", distance=500.0),
    "vehicle, full theory, 10 s": vehicle("full", 10.0),
    "vehicle, Hertz and FASTSIM, 10 s": vehicle("fastsim", 10.0),
}


def main() -> None:
    """Prints one row a run."""
    print("| run | wall time | steps written | log | logging |")
    print("|---|---|---|---|---|")
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "run.mcap"
        for name, run in RUNS.items():
            begin = time.perf_counter()
            share = run(path).logging_share
            wall = time.perf_counter() - begin
            written = read_run(path)
            steps, size = written.counts["/solver/stats"], 1e-6 * path.stat().st_size
            row = (name, f"{wall:.1f} s", steps, f"{size:.2f} MB", f"{100 * share:.1f} %")
            print("|", " | ".join(map(str, row)), "|", flush=True)


if __name__ == "__main__":
    main()
