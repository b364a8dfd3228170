"""Some 270 cases as a user who makes no mistake would write them, numbered and seeded: every kind,
method, regime and law, features in pairs, loads, speeds, profiles and positions by chance, and the
examples of the documentation. None may have a warning, and each must be solved.
"""

from __future__ import annotations

import random
import re
import sys
from pathlib import Path
from typing import Any

from bits.combinations import COMMON, OF_PATCHES, OF_WHEELS, sample
from case_samples import PATCH, WHEELSET, with_values
from railpatch.case.kinds import kinds
from railpatch.case.load import load_scene
from railpatch.errors import CaseError

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib

Case = dict[str, Any]
DOCS = Path(__file__).parents[2] / "docs"
# features whose own words are outside what is usual, or that belong to one of these
ODD = {
    "standstill": "a wheel that slides or a force at rest",
    "rates": "a wheelset on its way, out of balance",
}
# a layer between bodies as good as rigid, to see it alone
RIGID = "shear_modulus = 1e15"
FINE = {"grid": {"elements": [12, 12]}}
PAIRS = (
    ("S1002", "UIC60@1:40"),
    ("S1002", "UIC60@1:20"),
    ("S1002", "60E1@1:40"),
    ("S1002", "54E1@1:40"),
    ("cone@1:20", "UIC60@1:20"),
    ("worn@7", "worn@7"),
)


def combined() -> list[tuple[str, Case]]:
    """Every feature, and pairs of them, of patches and wheels."""
    found = []
    drawn = sample(240, 3)
    # a frame that only rollers have
    rollers = [case for name, case in drawn if name == "wheelset: roller"]
    drawn += [
        ("wheelset: inclined frame + roller", with_values(case, **OF_WHEELS["inclined frame"]))
        for case in rollers
    ]
    for name, case in drawn:
        features = name.split(": ")[1].split(" + ")
        if set(features) & set(ODD) or ("softening table" in features and "force" in name):
            # 15 kN on 113 mm^2 of a layer that bears 60 MPa
            continue
        if "tangential linear" in features and {"flange", "starved oil"} & set(features):
            # beyond what friction can carry
            continue
        grid = case.get("grid", {})
        coarse = grid.get("elements") in ([10, 10], [14, 14]) or case["kind"] != "patch"
        if coarse and "fitted" not in grid:
            case = {**case, **FINE}
        if "roller" in features:
            # as fast as the roller's surface
            case = with_values(case, wheelset__pitch_rate=-12.5 * 0.8 / 0.46)
        if case["kind"] == "wheelset":
            # both wheels carry, on a flat, a joint, an uneven tread too
            state = {"y": 0.0, "z": None, "vertical_force": 1.2e5, "roll": "balanced"}
            level = with_values(case, **{f"wheelset__{k}": v for k, v in state.items()})
            case = level if accepted(level) else with_values(case, wheelset__y=0.0)
        found.append((name, case))
    return found


def drawn_patches(rng: random.Random, count: int) -> list[tuple[str, Case]]:
    """Of wheels of 0.3 to 0.6 m radius on heads of 0.2 to 0.5 m, with 20 to 120 kN."""
    found = []
    for i in range(count):
        wheel, rail = rng.uniform(0.3, 0.6), rng.uniform(0.2, 0.5)
        case = with_values(
            PATCH,
            geometry={"curvatures": [0.5 / wheel, 0.5 / rail]},
            load__normal_force=rng.uniform(2e4, 1.2e5),
            grid__elements=[12, 12],
            motion__creepage=[rng.uniform(-4e-3, 4e-3), rng.uniform(-4e-3, 4e-3)],
            motion__spin_creepage=rng.uniform(-1.0, 1.0),
            motion__rolling_speed=rng.uniform(1.0, 80.0),
            friction__coefficient=rng.uniform(0.05, 0.6),
            method={"tangential": rng.choice(["full", "fastsim", "fastrip", "polach"])},
        )
        found.append((f"patch: drawn {i}", case))
    return found


def drawn_wheels(rng: random.Random, count: int) -> list[tuple[str, Case]]:
    """Wheels and wheelsets in balance, 50 to 220 kN an axle, up to 4 mm aside."""
    found = []
    for i in range(count):
        wheel, rail = PAIRS[i % len(PAIRS)]
        radius, speed = rng.uniform(0.38, 0.5), rng.uniform(5.0, 80.0)
        y = rng.uniform(-4e-3, 4e-3) if wheel != "worn@7" else 0.0
        load = rng.uniform(5e4, 2.2e5)
        both = i % 2 == 0
        state: dict[str, Any] = {
            "y": y,
            "z": None,
            "vertical_force": load if both else 0.5 * load,
            "speed": speed,
            "nominal_radius": radius,
            "roll": "balanced" if both else 0.0,
            "pitch_rate": "free" if both else -speed / radius,
            "yaw": rng.uniform(-2e-3, 2e-3),
        }
        case = with_values(
            WHEELSET,
            **{f"wheelset__{key}": value for key, value in state.items()},
            grid=FINE["grid"],
            friction__coefficient=rng.uniform(0.1, 0.5),
            profiles={"wheel": wheel, "rail": rail},
            method={
                "normal": rng.choice(["half_space", "hertz", "kik_piotrowski", "analyn"]),
                "tangential": rng.choice(["full", "fastsim", "polach"]),
            },
        )
        kind = "wheelset" if both else "wheel_rail"
        found.append((f"{kind}: drawn {i}", {**case, "kind": kind}))
    return found


def documented() -> list[tuple[str, Case]]:
    """Cases of the documentation's examples that stand alone, and the packaged ones of contacts."""
    found = [
        (f"packaged: {name}", tomllib.loads(kinds()[name].scene.read_text(encoding="utf-8")))
        for name in ("patch", "wheel_rail", "wheelset")
    ]
    for page in sorted(DOCS.glob("*.md")):
        blocks = re.findall(r"```toml\n(.*?)```", page.read_text(encoding="utf-8"), re.DOTALL)
        for number, block in enumerate(blocks):
            try:
                content = tomllib.loads(block)
            except tomllib.TOMLDecodeError:
                continue
            if RIGID in block:
                continue
            found.append((f"docs/{page.name} {number}", content))
    return found


def accepted(case: Case) -> bool:
    """Whether it is a case: pairs of features may exclude each other."""
    try:
        load_scene(case)
    except (CaseError, TypeError):
        return False
    return True


def correct_cases() -> list[tuple[str, Case]]:
    """All of them, the same each time."""
    rng = random.Random(16)
    own = [*documented(), *drawn_patches(rng, 36), *drawn_wheels(rng, 48)]
    return [named for named in [*own, *combined()] if accepted(named[1])]


# of these each is among the cases, but for ODD
FEATURES = {*COMMON, *OF_PATCHES, *OF_WHEELS}
