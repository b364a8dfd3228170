"""Forces of wheels and rails whose profiles vary along the way take and give back their energy.

Without friction and at a held height the elastic energy E of a contact is a function of the place x
along the track and of the wheel's pitch, so that over any way

    the integral of Fx dx + M dpitch = -(change of E),

M the moment about the axle. Over a passage that begins and ends on the same profile that is 0: a
wheel that climbs gets back what it gave. With friction and all rates the powers balance as in
test_power.py.
"""

from __future__ import annotations

from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from railpatch import Contact
from railpatch.profiles import load_profile
from railpatch.profiles.turnout import case_of

Case = dict[str, Any]
LOAD, RADIUS = 8e4, 0.46  # N, m
WAVES, DEPTH = 3, 4e-5  # of the radius round a wheel; m

# rails that go over into others and back, where profiles say how high and where they lie and where
# the top and the face do
PLACED = {"origin": [0.7535, 0.0]}
METHODS = {
    "half_space": {"normal": "half_space"},
    "curved": {"normal": "half_space", "reference_surface": "curved"},
    "hertz": {"normal": "hertz"},
}
# what is left open of the work both ways: by the grid's energy, which moves with the contact, as in
# test_power.py, and by Hertz's pressure, which is no gradient of its energy (docs/power.md: 4 % in
# the median)
GRID = {"half_space": 5e-3, "curved": 5e-3, "hertz": 0.15}


def scene(**track: Any) -> Case:
    """One wheel with its load."""
    return {
        "kind": "wheel_rail",
        "wheelset": {
            "y": 0.002,
            "vertical_force": LOAD,
            "nominal_radius": RADIUS,
            "flange_back_distance": 1.36,
            "flange_back_position": -0.07,
        },
        "track": {"gauge": 1.435, **track},
        "profiles": {"wheel": "S1002", "rail": "UIC60@1:40"},
        "friction": {"coefficient": 0.3},
        "grid": {"elements": [20, 20]},
    }


def along_the_rail(middle: str = "UIC60@1:30", **placed: Any) -> Case:
    """There and back between two profiles."""
    places = [(0.0, "UIC60@1:40"), (0.4, middle), (0.9, "UIC60@1:40")]
    sections = [{"position": x, "profile": profile} for x, profile in places]
    case = scene(right={"sections": sections, **placed}, section_blend="cubic")
    del case["profiles"]["rail"]
    return case


def round_the_wheel(folder: Path, count: int = 12) -> Case:
    """Waves of the radius, as slices."""
    wheel = load_profile("S1002", "wheel")
    sections = []
    for k, angle in enumerate(2 * np.pi * np.arange(count) / count):
        z = wheel.z + DEPTH * np.cos(WAVES * angle)
        np.savetxt(folder / f"{k}.txt", 1e3 * np.column_stack([wheel.y, z]), fmt="%.9f")
        sections.append({"angle": float(angle), "profile": str(folder / f"{k}.txt")})
    case = scene(section_blend="cubic")
    case["wheelset"]["right"] = {"sections": sections}
    case["profiles"] |= {"smoothing": 0.0, "wheel_file": {"unit": "mm", "swap": False}}
    case["profiles"]["wheel_file"]["mirror"] = "none"
    return case


def frictionless(case: Case, method: Case) -> Case:
    """At a height in place of a load."""
    wheelset = {k: v for k, v in case["wheelset"].items() if k != "vertical_force"}
    found = {k: v for k, v in case.items() if k != "friction"}
    found["wheelset"] = {**wheelset, "z": 0.0}
    found["method"] = {"tangential": "none", "tolerance": 1e-9, "max_iterations": 1000, **method}
    if method["normal"] == "hertz":
        del found["grid"]
    return found


class Passage:
    """Of a frictionless wheel at a held height, by steps of a place: x, m, or pitch, rad."""

    def __init__(self, case: Case, name: str, method: Case, place: float) -> None:
        self.name = name
        self.z = float(Contact(case).step(**{name: place})["z"])
        self.contact = Contact(frictionless(case, method))

    def at(self, place: float) -> tuple[float, float]:
        """Force along the track, N, or moment about the axle, N m; elastic energy, J."""
        found = self.contact.step(**{self.name: float(place)}, z=self.z)
        assert found["status"] == "converged", (place, found["status"])
        along = found["force"][0] if self.name == "x" else found["moment"][1]
        return along, found["pressure_energy"]

    def left_open(self, begin: float, end: float, steps: int) -> float:
        """By the trapezoidal rule, of the work both ways."""
        force, energy = np.array([self.at(p) for p in np.linspace(begin, end, steps + 1)]).T
        mean, step = 0.5 * (force[1:] + force[:-1]), (end - begin) / steps
        open_ = np.sum(mean) * step + energy[-1] - energy[0]
        return abs(open_) / max(np.sum(np.abs(mean)) * step, abs(energy[-1] - energy[0]))


@pytest.mark.parametrize("placed", [False, True], ids=["by face", "placed"])
@pytest.mark.parametrize("method", METHODS)
def test_a_passage_gives_back_its_energy(method: str, placed: bool, measured) -> None:
    """From a rail into another one and back to the first."""
    case = along_the_rail("UIC60@1:38", **PLACED) if placed else along_the_rail()
    passage = Passage(case, "x", METHODS[method], 0.2)
    whole, there = passage.left_open(-0.05, 0.95, 60), passage.left_open(0.05, 0.35, 32)
    measured(f"passage, {method}, placed {placed}: open {whole:.1e}, one way {there:.1e}")
    assert max(whole, there) < GRID[method]


@pytest.mark.parametrize("method", ["half_space", "hertz"])
def test_a_turn_of_a_wheel_out_of_round_gives_back_its_energy(
    method: str, tmp_path: Path, measured
) -> None:
    passage = Passage(round_the_wheel(tmp_path), "pitch", METHODS[method], 0.6)
    wave = 2 * np.pi / WAVES
    left = [passage.left_open(*way, 32) for way in ((0.0, wave), (0.1, 0.1 + 0.5 * wave))]
    measured(f"round the wheel, {method}: open {left[0]:.2e}, half a wave {left[1]:.2e}")
    assert max(left) < GRID[method]


def test_what_is_open_falls_with_the_square_of_the_step(measured) -> None:
    """Until what the grid leaves is all that is left."""
    passage = Passage(along_the_rail(), "x", METHODS["half_space"], 0.2)
    left = [passage.left_open(0.05, 0.35, steps) for steps in (2, 4, 8, 16)]
    measured(f"by step: open {', '.join(f'{v:.1e}' for v in left)} of the work both ways")
    for coarse, fine in pairwise(left):
        assert fine < 0.3 * coarse + 1e-3


def random_state(rng: np.random.Generator) -> Case:
    """Of a wheelset in motion along the track: places and rates, a wheel's and a rail's own too."""

    def u(most: float) -> float:
        return float(most * rng.uniform(-1, 1))

    places = {"x": float(rng.uniform(0.32, 0.62)), "pitch": u(3.0)}
    places |= {"y": u(1e-3), "yaw": u(0.02), "roll": u(2e-3)}
    rates = {"x": 20.0, "pitch": -20.0 / RADIUS * (1 + u(2e-3)), "y": u(0.05), "z": u(0.02)}
    rates |= {"yaw": u(0.3), "roll": u(0.05)}
    wheel, rail = ([u(0.5) for _ in range(3)] for _ in range(2))
    return {"places": places, "rates": rates, "wheel": wheel, "rail": rail}


def inputs_of(state: Case, later: float = 0.0) -> Case:
    """later: s, by which all has moved on."""
    places, rates = state["places"], state["rates"]
    found = {name: places.get(name, 0.0) + later * rate for name, rate in rates.items()}
    if "z" not in places:
        del found["z"]
    names = {"x": "speed", "y": "vy", "z": "vz"}
    found |= {names.get(name, f"{name}_rate"): rate for name, rate in rates.items()}
    bodies = [
        {"velocity": state[of], "offset": [later * v for v in state[of]]}
        for of in ("wheel", "rail")
    ]
    return {**found, "right": bodies[0], "track": {"right": bodies[1]}}


def power(result: Any, state: Case) -> float:
    """W, of force and moment on the wheelset and the wheel and, reversed, on the rail."""
    places, rates = state["places"], state["rates"]
    force, moment = np.array(result["force"]), np.array(result["moment"])
    c, s = np.cos(places["roll"]), np.sin(places["roll"])
    d, t = np.cos(places["yaw"]), np.sin(places["yaw"])
    axes = np.array([[d, -t, 0], [c * t, c * d, -s], [s * t, s * d, c]])
    spin = np.array([rates["roll"], 0, 0]) + rates["yaw"] * axes[:, 2]
    spin = spin + rates["pitch"] * axes[:, 1]
    given = force @ [rates[name] for name in "xyz"] + moment @ spin
    return float(given + force @ axes @ state["wheel"] - force @ state["rail"])


def test_powers_balance_on_a_nose_under_a_wheel_out_of_round(tmp_path: Path, measured) -> None:
    """Both at once, with yaw and all rates: the wheelset's, the wheel's and the rail's own."""
    (tmp_path / "nose").mkdir()
    nose = case_of("crossing", tmp_path / "nose")
    case = round_the_wheel(tmp_path)
    del case["profiles"]["rail"]
    case["track"] = nose["track"]
    case["profiles"]["rail_file"] = nose["profiles"]["rail_file"]
    case["wheelset"]["y"] = 0.0
    case["method"] = {"tolerance": 1e-9, "max_iterations": 1000}
    loaded = Contact(case)
    held = {k: v for k, v in case["wheelset"].items() if k != "vertical_force"}
    full = Contact({**case, "wheelset": {**held, "z": 0.0}})
    none = Contact(frictionless(case, METHODS["half_space"]))
    rng = np.random.default_rng(20261127)
    open_, elastic = [], []
    for _ in range(6):
        state = random_state(rng)
        found = loaded.step(**inputs_of(state))
        assert found["status"] == "converged", state
        state["places"]["z"] = found["z"]
        result, step = full.step(**inputs_of(state)), 1e-6
        ends = [none.step(**inputs_of(state, t))["pressure_energy"] for t in (step, -step)]
        elastic.append((ends[0] - ends[1]) / (2 * step))
        open_.append(power(result, state) + result["friction_power"] + elastic[-1])
    part = np.sum(np.abs(open_)) / np.sum(np.abs(elastic))
    measured(f"nose and waves: open {part:.2e} of dE/dt, worst {np.abs(open_).max():.3g} W")
    assert part < 5e-3
    assert np.max(np.abs(open_)) < 5e-3 * np.mean(np.abs(elastic))
