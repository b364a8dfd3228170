"""A record of a rig whose parameters are known, to try `railpatch match` on.

    python -m rig_model.synthetic DIR [--positions 37] [--noise 0.01] [--seed 1]

writes record.csv (ms, mrad, mm, kN), match.toml, which seeks the parameters from the middle of wide
ranges, and truth.toml with the values that the record was made with. The rig is the packaged
nominal one with a frame that yields and elements of 1 mm; lateral and longitudinal forces of both
wheels have normal noise of a part of half the load.
"""

from __future__ import annotations

import argparse
from collections.abc import Mapping, Sequence
from copy import deepcopy
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from railpatch.case.load import read_toml
from railpatch.case.types import SIDES
from railpatch.errors import CaseError
from railpatch.sweep.plan import put

from rig_model.balance import Balance, Balancer
from rig_model.predict import Prediction
from rig_model.programme import Position
from rig_model.scene import NOMINAL, rig_scene_of, scenes

OFFSET = "rig.columns.lateral_position.offset"
# of match.toml; the offset is in mm as its column
SEEK: dict[str, dict[str, Any]] = {
    "friction.coefficient": {"low": 0.1, "high": 0.9},
    "layer.thickness": {"low": 1e-6, "high": 1e-3, "logarithmic": True},
    "rig.frame.stiffness": {"low": 1e6, "high": 2e8, "logarithmic": True},
    OFFSET: {"low": -2.0, "high": 2.0},
}
# what the example's record was made with
TRUTH = {
    "friction.coefficient": 0.45,
    "layer.thickness": 8e-5,
    "rig.frame.stiffness": 1.2e7,
    OFFSET: 0.4,
}
# what the match begins with where the scene needs a value
GUESS = {
    "friction.coefficient": 0.3,
    "layer.thickness": 3e-5,
    "rig.frame.stiffness": 3e7,
    OFFSET: 0.0,
}
# rad, m: how far the run goes either way
YAW, LATERAL = 0.012, 2.5e-3
FORCES = {
    f"{side}_{what}": k for side in SIDES for k, what in enumerate(("longitudinal", "lateral"))
}
VERTICAL = {f"{side}_vertical": 2 for side in SIDES}
# between two positions where the way is taken in small ones
STEPS = 16
UNITS = {"time": ("ms", 1e3), "yaw": ("mrad", 1e3), "lateral_position": ("mm", 1e3)}


def write_synthetic(
    folder: Path,
    truth: Mapping[str, float] = TRUTH,
    *,
    count: int = 37,
    noise: float = 0.01,
    random: np.random.Generator | None = None,
    elements: float = 1e-3,
    seek: Mapping[str, Mapping[str, Any]] = SEEK,
    tables: Mapping[str, Mapping[str, Any]] | None = None,
    forces: Mapping[str, int] = FORCES,
) -> Path:
    """Writes record.csv, match.toml and truth.toml; returns the path of the match.

    truth: key of the scene -> its value. count: positions. noise: -, of half the load. elements: m,
    of the grid. seek: as in [match]. tables: further ones of [rig]. forces: measured ones, with
    their components. Raises CaseError.
    """
    folder.mkdir(parents=True, exist_ok=True)
    random = random or np.random.default_rng(1)
    columns = programme(count, forces)
    content = rig_content(columns, elements)
    content["rig"] |= tables or {}
    write_record(folder, columns)
    scene = rig_scene_of(with_values(content, truth), folder, {"balance.tolerance": 2e-5})
    balances = balanced(Balancer(scene), scene.positions())
    size = noise * 0.5 * scene.vertical_force
    for name, k in forces.items():
        side = name.partition("_")[0]
        force = np.array([-balance.result[side]["force"][k] for balance in balances])
        columns[name] = force + size * random.standard_normal(count)
    write_record(folder, columns)
    guess = {key: value for key, value in GUESS.items() if key in seek}
    match = with_values(content, guess) | {
        "match": {"observed": {name: {} for name in forces}, "seek": seek, "starts": 2}
    }
    place = folder / "match.toml"
    place.write_text(toml_of(match), encoding="utf-8")
    (folder / "truth.toml").write_text(toml_of(dict(truth)), encoding="utf-8")
    return place


def balanced(balancer: Balancer, positions: Sequence[Position]) -> list[Balance]:
    """Of a run; where a position is not balanced from the last one, on smaller steps from there.

    Raises CaseError where that fails too."""
    found: list[Balance] = []
    for position in positions:
        balance = balancer.solve(position)
        if not balance.converged and found:
            balance = balancer.solve(position, stepped(balancer, found[-1], position))
        if not balance.converged:
            raise CaseError(f"position {position.index}: is {balance.status}, allowed a balance")
        found.append(balance)
    return found


def stepped(balancer: Balancer, last: Balance, position: Position) -> Prediction:
    """What is known a small step before a position, of balances on the way there."""
    before = last.position
    unknowns = np.array([getattr(last, name) for name in balancer.unknowns])
    known = Prediction(unknowns, balancer.jacobian)
    for part in np.linspace(0.0, 1.0, STEPS + 1)[1:]:
        values = {
            key: (1 - part) * getattr(last.position, key) + part * getattr(position, key)
            for key in ("y", "yaw")
        }
        here = replace(position, **values)
        balance = balancer.alone(here, balancer.beside(known, before, here))
        if balance.converged:
            unknowns = np.array([getattr(balance, name) for name in balancer.unknowns])
            known, before = Prediction(unknowns, balancer.jacobian), here
    return balancer.beside(known, before, position)


def programme(count: int, forces: Mapping[str, int]) -> dict[str, NDArray[np.float64]]:
    """s, rad, m, [count]: to and fro in yaw, the actuators beside it; forces are not there yet."""
    turn = np.interp(np.linspace(0, 1, count), [0, 0.25, 0.75, 1], [0, 1, -1, 0])
    columns = {
        "time": 10.0 * np.arange(count),
        "yaw": YAW * turn,
        "lateral_position": LATERAL * turn + 0.5e-3 * np.sin(7 * turn),
    }
    return columns | {name: np.full(count, 4e4) for name in forces}


def rig_content(columns: Mapping[str, Any], elements: float) -> dict[str, Any]:
    """The nominal scene, driven by the record."""
    content = read_toml(scenes() / NOMINAL)
    content["grid"]["element_size"] = [elements, elements]
    named = {name: {"name": name} for name in columns}
    content["rig"] = {"record": "record.csv", "frame": {}, "columns": named}
    return content


def with_values(content: Mapping[str, Any], values: Mapping[str, float]) -> dict[str, Any]:
    """With what is sought."""
    found = deepcopy(dict(content))
    for key, value in values.items():
        put(found, key, value)
    return found


def write_record(folder: Path, columns: Mapping[str, NDArray[np.float64]]) -> None:
    """As a machine would have written it: ms, mrad, mm, kN."""
    heads, values = [], []
    for name, column in columns.items():
        unit, factor = UNITS.get(name, ("kN", 1e-3))
        heads.append(f"{name} [{unit}]")
        values.append(factor * column)
    rows = [",".join(f"{value:.7g}" for value in row) for row in zip(*values, strict=True)]
    text = "\n".join([",".join(heads), *rows]) + "\n"
    (folder / "record.csv").write_text(text, encoding="utf-8")


def toml_of(content: Mapping[str, Any]) -> str:
    """Needs tomli-w, as `railpatch match` does."""
    import tomli_w

    return tomli_w.dumps(content)


def main() -> None:
    """The command."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("folder", type=Path)
    parser.add_argument("--positions", type=int, default=37)
    parser.add_argument("--noise", type=float, default=0.01, help="of half the load")
    parser.add_argument("--seed", type=int, default=1)
    options = parser.parse_args()
    place = write_synthetic(
        options.folder,
        count=options.positions,
        noise=options.noise,
        random=np.random.default_rng(options.seed),
    )
    print(f"written       {place.parent / 'record.csv'}\nwritten       {place}")


if __name__ == "__main__":
    main()
