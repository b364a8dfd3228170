"""Friction and layer of a roller rig from a record that a replay with known ones made."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from railpatch.case.kinds import kind_of, write_example
from railpatch.log import read_run
from railpatch.match import load_match, run_match, write_match
from railpatch.match.page import curves_of, residual_figure
from railpatch.record.quantities import BY_NAME
from railpatch.report.beside import Computed

OBSERVED = ("left_lateral", "right_lateral")
NOISE = 600.0  # N
MATCH = """
[rig]
record = "record.csv"
[match]
starts = 1
intervals = "covariance"
[match.observed]
left_lateral = {}
right_lateral = {}
[match.seek]
"friction.coefficient" = { low = 0.2, high = 0.8, start = 0.4 }
"""


@pytest.fixture
def scene(tmp_path: Path) -> Path:
    """The packaged rig on few positions and coarse elements."""
    path = write_example(kind_of("rig"), tmp_path / "rig")[0]
    text = path.read_text().replace(
        "element_size = [0.4e-3, 0.4e-3]", "element_size = [1e-3, 1e-3]"
    )
    path.write_text(text.replace("positions = 37", "positions = 5"))
    return path


def record_of(scene: Path, observed: tuple[str, ...] = OBSERVED, noise: float = NOISE) -> None:
    """A replay of the scene as a machine would have written it. noise: N, or - of a ratio."""
    run = kind_of("rig").run
    assert run is not None
    run(scene, scene.with_name("run.mcap"))
    found = Computed(read_run(scene.with_name("run.mcap")))
    names = ["yaw", "lateral_position", *observed]
    units = {"yaw": ("mrad", 1e3), "lateral_position": ("mm", 1e3)}
    units |= {name: ("-", 1.0) for name in observed if name.endswith("_ratio")}
    random = np.random.default_rng(3)
    columns, heads = [np.asarray(found.table["time"].values, dtype=float)], ["time [s]"]
    for name in names:
        unit, factor = units.get(name, ("kN", 1e-3))
        values = found.values(BY_NAME[name])
        assert values is not None
        off = noise if name in observed else 0.0
        columns.append(factor * (values + off * random.standard_normal(len(values))))
        heads.append(f"{name} [{unit}]")
    lines = [",".join(f"{value:.6g}" for value in row) for row in np.array(columns).T]
    scene.with_name("record.csv").write_text("\n".join([",".join(heads), *lines]) + "\n")


def test_friction_is_found_from_forces_and_yaw(scene: Path) -> None:
    record_of(scene)
    text = scene.read_text()
    text = text[: text.index("[rig]")].replace("coefficient = 0.52", "coefficient = 0.4")
    path = scene.with_name("match.toml")
    path.write_text(text + MATCH)
    found = run_match(load_match(path))
    parameter = found.parameters["friction.coefficient"]
    assert parameter.low < 0.52 < parameter.high
    assert parameter.high - parameter.low < 0.06
    # ten numbers tell the noise to a fourth
    rms = float(np.sqrt(np.mean(found.explanations[0].fit.rms ** 2)))
    assert 0.5 * NOISE < rms < 1.5 * NOISE
    # the page has the record's own units: yaw in mrad, forces in kN
    record = np.loadtxt(scene.with_name("record.csv"), delimiter=",", skiprows=1)
    for place in range(len(OBSERVED)):
        figure = curves_of(found, place)
        (measured,) = (curve for curve in figure.data if curve.name == "measured")
        assert figure.layout.xaxis.title.text == "yaw [mrad]"
        assert figure.layout.yaxis.title.text == f"{OBSERVED[place].replace('_', ' ')} [kN]"
        assert measured.x == pytest.approx(record[:, 1], rel=1e-12)
        assert measured.y == pytest.approx(record[:, 3 + place], rel=1e-12)
        assert max(abs(residual_figure(found, place).data[0].y)) < 1e-2 * NOISE
    # the scene that comes of it runs, also from another folder
    write_match(found, scene.parent / "out")
    ended = kind_of("rig").run(scene.parent / "out" / "match.toml", scene.with_name("again.mcap"))
    assert ended.status == "converged"


def test_friction_is_found_where_the_record_has_ratios_alone(scene: Path) -> None:
    record_of(scene, ("left_ratio", "right_ratio"), 0.008)
    text = scene.read_text()
    text = text[: text.index("[rig]")].replace("coefficient = 0.52", "coefficient = 0.4")
    seek = MATCH.replace("[match.observed]\nleft_lateral = {}\nright_lateral = {}\n", "")
    path = scene.with_name("match.toml")
    path.write_text(text + seek)
    found = run_match(load_match(path))
    assert set(found.plan.table.observed) == {"left_ratio", "right_ratio"}
    parameter = found.parameters["friction.coefficient"]
    assert parameter.low < 0.52 < parameter.high
    assert parameter.high - parameter.low < 0.1
