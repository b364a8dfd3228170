"""Derivatives of a table's creep forces: from its own interpolation, against differences of what
it gives."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from railpatch import Contact
from railpatch.case.to_core import POSE_AND_VELOCITY

LOAD = 8e4
CREEPAGES = (1.1e-3, -6e-4, 0.3)  # longitudinal, lateral, spin
PATCH: dict[str, Any] = {
    "kind": "patch",
    "load": {"normal_force": LOAD},
    "material": {"shear_modulus": 82e9, "poisson_ratio": 0.28},
    "friction": {"coefficient": 0.3},
    "motion": {"creepage": [0.0, 0.0], "spin_creepage": 0.0, "rolling_speed": 20.0},
}
ELLIPSE = {"curvatures": [1.1, 0.9]}
GRID = {"elements": [12, 16]}
X, Y = np.meshgrid((np.arange(24) - 11.5) * 6e-4, (np.arange(28) - 13.5) * 6e-4)
# a lopsided one, which one ellipse does not stand for
WAVE = 8e-6 * np.cos(900 * Y + 0.8)
GAP: dict[str, Any] = {
    "geometry": {"undeformed_distance": (0.9 * X**2 + 0.8 * Y**2 + WAVE).tolist()},
    "grid": {"element_size": [6e-4, 6e-4]},
}
PATCHES: dict[str, dict[str, Any]] = {
    "hertz": {"geometry": ELLIPSE, "method": {"normal": "hertz"}},
    "beyond_the_table": {
        "geometry": {"semi_axes": [12e-3, 1e-3]},
        "method": {"normal": "half_space"},
        "grid": GRID,
    },
    "half_space": {"geometry": ELLIPSE, "method": {"normal": "half_space"}, "grid": GRID},
    "gap": {**GAP, "method": {"normal": "half_space"}},
}
READ = ("friction_power", "creep_power", "utilised_friction", "traction_coefficient", "wear_number")


def contact(name: str) -> Contact:
    own = PATCHES[name]
    method = {"tangential": "table", "derivatives": True, "tolerance": 1e-12}
    return Contact({**PATCH, **own, "method": {**own["method"], **method, "max_iterations": 1000}})


def state(creepages: tuple[float, ...], **changes: float) -> dict[str, Any]:
    names = ("xi", "eta", "phi")
    xi, eta, phi = (c + changes.get(n, 0.0) for n, c in zip(names, creepages, strict=True))
    return {
        "creepage": [xi, eta],
        "spin_creepage": phi,
        "normal_force": LOAD + changes.get("load", 0.0),
    }


DIRECTIONS: dict[str, tuple[dict[str, Any], float]] = {
    "xi": ({"creepage": [1.0, 0.0]}, 1e-7),
    "eta": ({"creepage": [0.0, 1.0]}, 1e-7),
    "phi": ({"spin_creepage": 1.0}, 1e-4),
    "load": ({"normal_force": 1.0}, 1.0),
}


def numbers(result: Any) -> np.ndarray:
    """Forces, moment over 1 mm, and what follows from them."""
    read = [result[name] for name in READ]
    return np.array([*result["creep_force"], 1e3 * result["spin_moment"], *read], dtype=float)


@pytest.mark.parametrize("name", ["hertz", "half_space", "gap"])
def test_a_patch(name: str) -> None:
    """To eight digits, by differences of the fourth order within a piece of the interpolation."""
    one = contact(name)
    one.step(**state(CREEPAGES))
    exact = {key: one.differentiate(**direction) for key, (direction, _step) in DIRECTIONS.items()}
    for key, (_direction, step) in DIRECTIONS.items():
        assert exact[key]["kind"] == "exact"

        def at(places: float, key: str = key, step: float = step) -> np.ndarray:
            return numbers(one.step(**state(CREEPAGES, **{key: places * step})))

        wanted = (8 * (at(1) - at(-1)) - (at(2) - at(-2))) / (12 * step)
        found = numbers(exact[key])
        # what rounding of the solved pressure leaves of a difference, of its greatest parts
        scale = np.maximum(np.abs(wanted), 1e-3 * np.abs(wanted[:2]).max())
        scale[3:] = np.abs(wanted[3:])
        assert (np.abs(found - wanted) <= 1e-8 * scale).all(), (key, (found - wanted) / scale)


@pytest.mark.parametrize("name", ["hertz", "half_space"])
def test_friction(name: str) -> None:
    """Forces scale: F(mu, w) = mu f(w/mu), so mu dF/dmu = F - sum of w dF/dw."""
    one = contact(name)
    force = numbers(one.step(**state(CREEPAGES)))[:3]
    by_friction = numbers(one.differentiate(friction_coefficient=1.0))[:3]
    slopes = [numbers(one.differentiate(**DIRECTIONS[k][0]))[:3] for k in ("xi", "eta", "phi")]
    wanted = force - sum(c * slope for c, slope in zip(CREEPAGES, slopes, strict=True))
    assert np.allclose(0.3 * by_friction, wanted, rtol=1e-10, atol=1e-9 * np.abs(force).max())


@pytest.mark.parametrize("name", PATCHES)
def test_at_rest(name: str) -> None:
    """Without creepage no force, but the slopes that it has nearby."""
    one = contact(name)
    found = {}
    for creepages in ((0.0, 0.0, 0.0), (1e-11, -1e-11, 1e-9), (-1e-11, 1e-11, -1e-9)):
        one.step(**state(creepages))
        found[creepages] = [
            numbers(one.differentiate(**DIRECTIONS[key][0]))[:3] for key in ("xi", "eta", "phi")
        ]
    rest, ahead, behind = (np.array(found[key]) for key in found)
    assert rest[0][0] < 0
    assert rest[1][1] < 0
    assert np.allclose(rest, 0.5 * (ahead + behind), rtol=1e-5, atol=1e-6 * np.abs(rest).max())
    # by symmetry: along rolling nothing across, and the reverse
    assert rest[0][1] == rest[0][2] == rest[1][0] == rest[2][0] == 0 or name == "gap"


USUAL = np.array([1e-3, 1e-3, 1e-4, 1e-4, 1e-3, 1e-3, 1, *[0.01] * 4, 1])
STEP = {"x": 1e-7, "y": 1e-8, "z": 1e-9, "roll": 1e-8, "yaw": 4e-7, "pitch": 1e-7}
SPEED = 20.0


def wheelset(track: str, normal: str, load: dict[str, float]) -> dict[str, Any]:
    grid = {"elements": [16, 16]} if normal == "hertz" else {"element_size": [5e-4, 5e-4]}
    own = {"kind": "roller", "roller_radius": 0.8, "roller_pitch_rate": SPEED / 0.8}
    return {
        "kind": "wheelset",
        "wheelset": {
            "nominal_radius": 0.46,
            "flange_back_distance": 1.36,
            "flange_back_position": -0.07,
            **load,
        },
        "track": {"gauge": 1.435, "gauge_height": 0.014}
        | ({"kind": "rail"} if track == "rail" else own),
        "grid": grid,
        "friction": {"coefficient": 0.3},
        "profiles": {"wheel": "S1002", "rail": "UIC60@1:40"},
        "method": {"normal": normal, "tangential": "table", "derivatives": True}
        | {"tolerance": 1e-11, "max_iterations": 1000},
    }


@pytest.mark.parametrize("normal", ["hertz", "half_space"])
@pytest.mark.parametrize("track", ["rail", "roller"])
def test_wheels(track: str, normal: str) -> None:
    """All columns on the tread, to 1e-5 of a row's greatest as the full theory's are. Of the
    half-space an element that comes or goes between the ends of a difference spoils it: then half
    the columns of a state tell."""
    rng = np.random.default_rng(5)
    one = Contact(wheelset(track, normal, {"z": 0.0}))
    find = Contact(wheelset(track, normal, {"vertical_force": 1e5}))
    sides: tuple[Any, ...] = ("left", "right")
    good = columns = 0
    for _ in range(4):
        y = rng.uniform(-3e-3, 3e-3)
        place = dict.fromkeys(POSE_AND_VELOCITY, 0.0) | {
            **{"y": y, "roll": -0.03 * y, "yaw": rng.uniform(-4e-3, 4e-3)},
            **{"speed": SPEED if track == "rail" else 0.0, "vy": rng.uniform(-0.03, 0.03)},
            **{"yaw_rate": rng.uniform(-0.03, 0.03)},
            "pitch_rate": -SPEED / 0.46 * (1 + rng.uniform(-1e-3, 1e-3)),
        }
        moving = {name: value for name, value in place.items() if name != "z"}
        place["z"] = find.step(**moving)["z"]
        assert one.step(**place)["status"] == "converged"
        matrix = one.jacobian()
        assert matrix["kind"] == "exact"
        for column, name in enumerate(POSE_AND_VELOCITY):
            step = STEP.get(name, 1e-7 * SPEED)
            ends = [one.step(**{**place, name: place[name] + way}) for way in (step, -step)]
            for side in sides:
                high, low = (np.array([*e[side]["force"], *e[side]["moment"]]) for e in ends)
                scale = np.abs(matrix[side] * USUAL).max(axis=1)
                missed = np.abs(matrix[side][:, column] - (high - low) / (2 * step))
                columns += 1
                good += bool((missed * USUAL[column] <= 1e-5 * scale).all())
    assert columns == 4 * 12 * 2
    assert good == columns if normal == "hertz" else good >= columns - 12
