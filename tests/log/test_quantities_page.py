"""What engineers read, on the pages of runs: the numbers of the log, each in its panel."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import plotly.graph_objects as go
import pytest
from railpatch.case.fluid import Fluid
from railpatch.case.friction import Friction
from railpatch.log import read_run
from railpatch.report import quantities, write_report
from railpatch.report.data import positions
from railpatch.report.vehicle.data import vehicle_run

from wheelset_demo.scene import load_wheelset_scene, scene_file
from wheelset_demo.simulation import run_scene
from wheelset_demo.vehicle import load_vehicle_scene
from wheelset_demo.vehicle.simulation import Simulation
from wheelset_demo.vehicle.trace import run_vehicle
from wheelset_demo.vehicle.wet_track import WetTable


@pytest.fixture(scope="module")
def wheelset_log(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("quantities")
    text = scene_file("s1002.toml").read_text(encoding="utf-8")
    text = text.replace('"half_space"', '"hertz"').replace('"full"', '"fastsim"')
    (folder / "own.toml").write_text(text, encoding="utf-8")
    scene = load_wheelset_scene(folder / "own.toml", {"distance": 0.6, "step": 1e-3})
    run_scene(scene, folder / "a.mcap")
    return folder / "a.mcap"


def panels(figure: go.Figure) -> dict[str, list[go.Scatter]]:
    """Traces by the title of their panel, which stands at its upper left corner."""
    titles = {(round(a.x, 6), round(a.y, 6)): a.text for a in figure.layout.annotations}
    found: dict[str, list[go.Scatter]] = {}
    for trace in figure.data:
        across = figure.layout[f"xaxis{(trace.xaxis or 'x')[1:]}"].domain
        upward = figure.layout[f"yaxis{(trace.yaxis or 'y')[1:]}"].domain
        title = titles.get((round(across[0], 6), round(upward[1], 6)))
        if title is not None:
            found.setdefault(title, []).append(trace)
    return found


def test_a_wheelset_has_all_of_them(wheelset_log: Path) -> None:
    data = positions(read_run(wheelset_log))
    figure = quantities.figure(data)
    assert figure is not None
    found = panels(figure)
    assert set(found) == {
        *("wear number T\u03b3 [N]", "Y/Q", "guiding force Y [kN]", "wheel load Q [kN]"),
        *("traction coefficient", "utilised friction"),
        *("greatest traction [MPa]", "extent along x [mm]"),
        *("extent across [mm]", "y on the wheel's profile [mm]", "y on the rail's profile [mm]"),
        *("rolling radius difference [mm]", "radius difference over 2 y"),
    }
    # against the forces of the log, by separate arithmetic
    for trace, side, outward in zip(found["Y/Q"], ("left", "right"), (1, -1), strict=True):
        force = data.contact[side]["force"]
        assert np.allclose(trace.y, outward * force[:, 1] / -force[:, 2], atol=1e-12)
    for trace, side in zip(found["wheel load Q [kN]"], ("left", "right"), strict=True):
        assert np.allclose(trace.y, -1e-3 * data.contact[side]["force"][:, 2])
    assert all(0 <= v <= 1 + 1e-9 for trace in found["utilised friction"] for v in trace.y)
    for trace, side in zip(found["traction coefficient"], ("left", "right"), strict=True):
        patches = [p for m in data.contact[side].messages for p in m["patches"]]
        wanted = [np.hypot(*p["creep_force"][:2]) / p["normal_force"] for p in patches]
        assert np.allclose(trace.y, wanted, rtol=1e-9)
    # wear number: over speed it is the power that creepages supply, here all of one sign
    for trace, side in zip(found["wear number T\u03b3 [N]"], ("left", "right"), strict=True):
        patches = [m["patches"] for m in data.contact[side].messages]
        wanted = [
            sum(
                abs(p["creep_force"][0] * p["creepage"][0])
                + abs(p["creep_force"][1] * p["creepage"][1])
                + abs(p["spin_moment"] * p["spin_creepage"])
                for p in own
            )
            for own in patches
        ]
        assert np.allclose(trace.y, wanted, rtol=1e-9)


def test_the_page_has_the_figure(wheelset_log: Path, tmp_path: Path) -> None:
    page = write_report(wheelset_log, tmp_path / "a.html").read_text(encoding="utf-8")
    assert "<h2>What engineers read</h2>" in page


def test_a_vehicle(tmp_path: Path) -> None:
    """Five courses of each wheel and one of each wheelset; greatest numbers in its table."""
    scene = load_vehicle_scene().with_method(normal="hertz", tangential="fastsim")
    scene = scene.with_run(duration=0.02, log_every=1)
    run_vehicle(Simulation(scene), output=tmp_path / "a.mcap")
    data = vehicle_run(read_run(tmp_path / "a.mcap"))
    found = panels(quantities.vehicle_figure(data))
    for side in ("left", "right"):
        assert len(found[f"{side} wheels: T\u03b3 [N]"]) == 4
    contact = data.contact[1, "left"]
    assert np.allclose(found["left wheels: T\u03b3 [N]"][0].y, contact["wear_number"])
    assert len(found["rolling radius difference [mm]"]) == 4
    for body in ("wheel", "rail"):
        first = [m["patches"][0][f"{body}_profile_position"][0] for m in contact.messages]
        drawn = found[f"left wheels: y on the {body}'s profile [mm]"][0].y
        assert np.allclose(drawn, 1e3 * np.array(first))
    assert not any(word in title for title in found for word in ("liquid", "film", "paste"))
    page = write_report(tmp_path / "a.mcap", tmp_path / "a.html").read_text(encoding="utf-8")
    for words in quantities.HEAD:
        assert f">{words}</th>" in page


def test_a_vehicle_on_wet_rails(tmp_path: Path) -> None:
    """Friction, share of the asperities, film in µm, and the water of a paste that dries."""
    oxide = {"solid_content": 0.2, "drying": {"time": 0.05}}
    fluid = Fluid(model="film", roughness=1e-6, liquid="water", temperature=20.0, oxide=oxide)
    scene = load_vehicle_scene().with_method(normal="hertz", tangential="fastsim")
    scene = scene.with_run(duration=0.02, log_every=1)
    scene = replace(scene, case=scene.case.model_copy(update={"fluid": fluid}))
    run_vehicle(Simulation(scene), output=tmp_path / "a.mcap")
    data = vehicle_run(read_run(tmp_path / "a.mcap"))
    found = panels(quantities.vehicle_figure(data))
    contact = data.contact[1, "left"]
    patches = [m["patches"][0] for m in contact.messages]
    for title, name, factor in (
        ("friction with the liquid", "effective_friction", 1.0),
        ("load on asperities", "mean_asperity_share", 1.0),
        ("film [µm]", "central_film_thickness", 1e6),
    ):
        drawn = found[f"left wheels: {title}"][0].y
        assert np.allclose(drawn, factor * np.array([p[name] for p in patches]), rtol=1e-12)
    # the exponential of the time
    for title in ("left wheels: water left in the paste", "right wheels: water left in the paste"):
        assert len(found[title]) == 4
        water = np.array(found[title][0].y)
        assert np.allclose(water, np.exp(-contact.time / 0.05), rtol=1e-6)
    assert 0 < water[-1] < 0.7
    assert not any("water rate" in title or "wheels ahead" in title for title in found)


def test_a_vehicle_over_a_wet_stretch(tmp_path: Path) -> None:
    """The rate where each wheel is, and the work by which those ahead have cleaned its rail."""
    recovery = {"coefficient": 2e-4}
    fluid = Fluid(model="regimes", water_rate=1e-9, recovery=recovery)
    scene = load_vehicle_scene().with_method(normal="hertz", tangential="polach")
    scene = scene.with_run(duration=0.1, log_every=4)
    start = scene.vehicle.length - 0.5
    wet = (WetTable(position=start, length=1.0, water_rate=25e-9),)
    case = scene.case.model_copy(update={"fluid": fluid, "friction": Friction(coefficient=0.4)})
    run_vehicle(Simulation(replace(scene, case=case, wet=wet)), output=tmp_path / "a.mcap")
    data = vehicle_run(read_run(tmp_path / "a.mcap"))
    found = panels(quantities.vehicle_figure(data))
    for side in ("left", "right"):
        rates = found[f"{side} wheels: water rate [µl/s]"]
        first, others = np.array(rates[0].y), [np.array(one.y) for one in rates[1:]]
        x = data.wheelsets[1]["x"]
        inside = (start <= x) & (x < start + 1.0)
        assert inside.any()
        assert not inside.all()
        assert np.allclose(first, np.where(inside, 25.0, 1.0), rtol=1e-12)
        assert all(np.allclose(one, 1.0, rtol=1e-12) for one in others)
        works = [np.array(one.y) for one in found[f"{side} wheels: work of wheels ahead [J/m]"]]
        # nothing is ahead of the first; the second's way is that of the first
        assert (works[0] == 0).all()
        assert all((work >= 0).all() for work in works)
        logged = data.contact[2, side]["rail_work"]
        assert np.allclose(works[1], logged, rtol=1e-12)
