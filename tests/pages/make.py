"""Makes pages that need a solver, for test_browser.py: python tests/pages/make.py DIR"""

from __future__ import annotations

import subprocess
import sys
import tempfile
from pathlib import Path

POINTS = ((0.1, 0.08), (0.3, 0.19), (0.6, 0.27), (1.0, 0.31), (1.6, 0.33), (2.5, 0.34), (4.0, 0.34))
MATCH = """
kind = "patch"
[geometry]
semi_axes = [6e-3, 4e-3]
[load]
normal_force = 8e4
[motion]
creepage = [0.0, 0.0]
[friction]
coefficient = 0.3
[method]
normal = "hertz"
tangential = "polach"
[match]
record = "points.csv"
starts = 2
[match.inputs]
"creepage[0]" = { name = "slip", unit = "%" }
[match.observed]
"creep_force[0]" = { name = "traction", unit = "-", sign = -1, over = "normal_force" }
[match.seek]
"friction.coefficient" = { low = 0.05, high = 0.6 }
"method.polach_k_a" = { low = 0.05, high = 1.0, logarithmic = true }
"""

WEAR = """
[sweep]
scene = "wheelset.toml"
design = "list"
[[vary]]
key = "wheelset.y"
values = [-0.004, 0.0, 0.002, 0.004]
[[vary]]
key = "wheelset.yaw"
values = [-0.001, 0.0, 0.0005, 0.001]
[wear]
distance = 1.5e6
weights = [1, 2, 2, 1]
largest_depth = 5e-5
"""
# of wear and rolling contact fatigue by cases
DAMAGE = """
[sweep]
scene = "wheelset.toml"
outputs = ["right.damage.wear_rate", "right.damage.rail_depth", "right.damage.fatigue_index"]
[[vary]]
key = "wheelset.y"
low = -0.006
high = 0.006
count = 9
[[vary]]
key = "friction.coefficient"
values = [0.2, 0.3, 0.5]
"""
WHEELSET = """
kind = "wheelset"
[friction]
coefficient = 0.3
[grid]
elements = [16, 16]
[wheelset]
vertical_force = 120e3
roll = "balanced"
pitch_rate = "free"
speed = 20.0
nominal_radius = 0.46
flange_back_distance = 1.36
flange_back_position = -0.070
[track]
gauge = 1.435
gauge_height = 0.014
[profiles]
wheel = "S1002"
rail = "UIC60@1:40"
[damage]
"""


def run(*arguments: object) -> None:
    """A command of railpatch; its exit code 3 says that a case has no result."""
    command = [Path(sys.executable).with_name("railpatch"), *arguments, "--quiet"]
    done = subprocess.run(list(map(str, command)), check=False)
    if done.returncode not in (0, 3):
        sys.exit(done.returncode)


def main() -> None:
    """One page of each kind into DIR."""
    output = Path(sys.argv[1])
    output.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        run("profile", "S1002", "-o", output / "profile.html")
        run("init", "sweep", folder / "scene")
        run("sweep", folder / "scene" / "sweep.toml", "-o", folder / "sweep")
        (folder / "match.toml").write_text(MATCH)
        lines = [f"{slip};{traction}" for slip, traction in POINTS]
        (folder / "points.csv").write_text("\n".join(["slip;traction", *lines]) + "\n")
        run("match", folder / "match.toml", "-o", folder / "match")
        run("hunting", "-o", folder / "hunting.mcap")
        run("report", folder / "hunting.mcap", "-o", output / "hunting.html")
        (folder / "wheelset.toml").write_text(WHEELSET)
        (folder / "wear.toml").write_text(WEAR)
        run("wear", folder / "wear.toml", "-o", folder / "wear")
        (folder / "damage.toml").write_text(DAMAGE)
        run("sweep", folder / "damage.toml", "-o", folder / "damage")
        run("subsurface", folder / "wheelset.toml", "-o", output / "subsurface.html")
        for kind in ("stress", "bench"):
            run(kind, "-o", folder / kind, "--quick")
        for made, page in (
            ("sweep/sweep.html", "sweep"),
            ("match/match.html", "match"),
            ("wear/wear.html", "wear"),
            ("damage/sweep.html", "damage"),
            ("stress/stress.html", "stress"),
            ("bench/report.html", "bench"),
        ):
            (output / f"{page}.html").write_bytes((folder / made).read_bytes())


if __name__ == "__main__":
    main()
