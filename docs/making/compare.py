"""Tables of the book: what is computed beside closed forms and published numbers.

    python docs/making/compare.py NAME        # carter, kalker, manchester, rig

Prints a table in Markdown. Ends with 1 where a difference is beyond what the tests bound, whose
published numbers these are (tests/published/data, with sources and reading errors).
"""

from __future__ import annotations

import sys
import tempfile
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import railpatch
from railpatch.published import read_numbers, read_rows

ROOT = Path(__file__).resolve().parents[2]
DATA = ROOT / "tests/published/data"
Rows = list[list[str]]


def show(head: list[str], rows: Rows) -> None:
    """Prints a table."""
    for row in (head, ["---"] * len(head), *rows):
        print(f"| {' | '.join(row)} |")


def carter() -> bool:
    """Carter 1926: |F| over friction times load is 1 - (1 - xi R / (mu a))^2."""
    radius, friction, force, modulus, poisson = 0.5, 0.3, 178.9e3, 82e9, 0.28
    # of two like bodies: 1/E* = (1 - nu)/G
    half = np.sqrt(4 * force * radius * (1 - poisson) / (np.pi * modulus))
    saturation = friction * half / radius
    rows, worst = [], 0.0
    for share in (0.1, 0.25, 0.5, 0.75, 0.9, 1.5):
        case = {
            "kind": "patch",
            "material": {"shear_modulus": modulus, "poisson_ratio": poisson},
            "geometry": {"line_contact_radius": radius, "width": 1.0},
            "load": {"normal_force": force},
            "grid": {"elements": [200, 1]},
            "motion": {"regime": "steady_rolling", "creepage": [-share * saturation, 0.0]},
            "friction": {"coefficient": friction},
        }
        found = railpatch.solve(case)["creep_force"][0] / (friction * force)
        exact = 1 - max(0.0, 1 - share) ** 2
        worst = max(worst, abs(found - exact))
        rows.append(
            [f"{share:g}", f"{exact:.4f}", f"{found:.4f}", f"{100 * (found - exact):+.2f} %"]
        )
    show(["creepage over that of full slip", "closed form", "200 elements", "difference"], rows)
    return worst < 0.01


def kalker() -> bool:
    """Kalker 1990, table E3: three digits, trusted to 1 to 2 %."""
    published = {row["ratio"]: row for row in ratios("a/b")}
    modulus, minor, small, rows, worst = 82e9, 0.004, 1e-6, [], 0.0
    for ratio in (0.2, 0.5, 1.0):
        a, b = minor, minor / ratio
        unit = a * b * modulus * small
        for name, nu in (("nu0", 0.0), ("nu025", 0.25), ("nu05", 0.5)):
            forces = [
                small_creep(a, b, nu, creepage, spin)[component]
                for creepage, spin, component in (
                    ([small, 0.0], 0.0, 0),
                    ([0.0, small], 0.0, 1),
                    ([0.0, 0.0], small / np.sqrt(a * b), 1),
                )
            ]
            own = [-force / unit for force in forces]
            known = [float(published[ratio][f"c{k}_{name}"]) for k in (11, 22, 23)]
            errors = [one / other - 1 for one, other in zip(own, known, strict=True)]
            worst = max(worst, *map(abs, errors))
            pairs = zip(known, own, strict=True)
            cells = [f"{other:g}, {one:.3f}" for other, one in pairs]
            rows.append([f"{ratio:g}", f"{nu:g}", *cells, f"{100 * max(map(abs, errors)):.1f} %"])
    show(["a/b", "Poisson", "C11: table, own", "C22", "C23", "greatest difference"], rows)
    return worst < 0.02


def ratios(axes: str) -> list[dict[str, Any]]:
    """Rows of Kalker's table by which ratio they hold."""
    rows = [row for _, row in read_rows(DATA / "kalker_coefficients.csv") if row["axes"] == axes]
    return [{**row, "ratio": float(row["ratio"])} for row in rows]


def small_creep(a: float, b: float, nu: float, creepage: list[float], spin: float) -> Any:
    """Creep force where all but the trailing edge sticks, from two grids to elements of size 0."""
    coarse, fine = (
        np.array(
            railpatch.solve(
                {
                    "kind": "patch",
                    "material": {"shear_modulus": 82e9, "poisson_ratio": nu},
                    "geometry": {"semi_axes": [a, b]},
                    "load": {"normal_force": 1e5},
                    "grid": {"elements": [count, count]},
                    "motion": {
                        "regime": "steady_rolling",
                        "creepage": creepage,
                        "spin_creepage": spin,
                    },
                    "friction": {"coefficient": 5.0},
                    "method": {"tolerance": 1e-7},
                }
            )["creep_force"]
        )
        for count in (30, 60)
    )
    return 2 * fine - coarse


def manchester() -> bool:
    """Manchester benchmark A-2.2, right wheel: CONTACT's published results on a grid of 0.2 mm."""
    case = {
        "kind": "wheel_rail",
        "material": {"shear_modulus": 82e9, "poisson_ratio": 0.28},
        "wheelset": {
            "vertical_force": 1e4,
            "speed": 2.0,
            "nominal_radius": 0.46,
            "flange_back_distance": 1.36,
            "flange_back_position": -0.07,
        },
        "track": {"kind": "rail", "gauge": 1.435, "gauge_height": 0.014},
        "profiles": {"wheel": "S1002", "rail": "UIC60@1:40"},
        "grid": {"element_size": [2e-4, 2e-4]},
        "friction": {"coefficient": 0.3},
    }
    contact, rows, worst = railpatch.Contact(case), [], 0.0
    for row in read_numbers(DATA / "manchester_a22_right.csv")[::4]:
        result = contact.step(
            y=1e-3 * row["y_ws_mm"],
            roll=row["roll_rad"],
            yaw=row["yaw_rad"],
            pitch_rate=row["pitch_rate_rad_s"],
        ).to_dict()
        patch = result["patches"][0]
        # published forces act on the rail
        pairs = [(-row[f"force_{k}_N"], patch["creep_force"][n]) for n, k in enumerate("xy")]
        pressure = row["max_pressure_MPa"], 1e-6 * patch["max_pressure"]
        worst = max(worst, *(abs(one - other) / 1e4 for one, other in pairs))
        worst = max(worst, 0.5 * abs(pressure[1] / pressure[0] - 1))
        cells = [f"{one:.0f}, {other:.0f}" for one, other in (*pairs, pressure)]
        rows.append([f"{row['y_ws_mm']:g}", *cells])
    head = ["y, mm", "longitudinal force, N: published, own", "lateral, N", "peak pressure, MPa"]
    show(head, rows)
    return worst < 0.01


def rig() -> bool:
    """NRC's roller rig: forces by CONTACT's own model of it, at the published positions."""
    from railpatch.log import read_run
    from railpatch.report.data import positions
    from railpatch.report.reference import find, load, match

    from rig_model.run import replay
    from rig_model.scene import load_rig_scene

    with tempfile.TemporaryDirectory() as folder:
        log = Path(folder) / "run.mcap"
        summary = replay(load_rig_scene(), log)
        data = positions(read_run(log))
    file = find()
    assert file is not None
    rows, worst = [], 0.0
    for found in match(load(file), data):
        own = -data.force[found.row.side][found.index]
        ratios = found.row.force[1] / found.row.force[2], own[1] / own[2]
        worst = max(worst, abs(ratios[1] - ratios[0]))
        rows.append(
            [
                f"{1e3 * found.row.yaw:g}",
                found.row.side,
                f"{found.row.force[1] / 1e3:.2f}, {own[1] / 1e3:.2f}",
                f"{found.row.force[2] / 1e3:.2f}, {own[2] / 1e3:.2f}",
                f"{ratios[0]:.4f}, {ratios[1]:.4f}",
            ]
        )
    show(["yaw, mrad", "wheel", "lateral, kN: CONTACT, own", "vertical, kN", "L/V"], rows)
    return summary.good and worst < 0.01


TABLES: dict[str, Callable[[], bool]] = {
    "carter": carter,
    "kalker": kalker,
    "manchester": manchester,
    "rig": rig,
}


if __name__ == "__main__":
    sys.exit(0 if TABLES[sys.argv[1]]() else 1)
