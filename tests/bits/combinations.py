"""Cases of every kind, method, regime and law: base cases, each with every feature and with every
pair of features that the case's checks accept."""

from __future__ import annotations

import random
from collections.abc import Iterator
from itertools import combinations
from typing import Any

from case_samples import PATCH, WHEELSET, with_values

Case = dict[str, Any]
Feature = dict[str, Any]  # of with_values

SLIP: Feature = {
    "friction__law": "slip_velocity",
    "friction__coefficient": None,
    "friction__shape": "exponential",
    "friction__kinetic": 0.14,
    "friction__amplitude": 0.19,
    "friction__halving_speed": 1.25,
}
WARM: Feature = {
    "friction__law": "temperature",
    "friction__coefficient": None,
    "friction__reference": 0.4,
    "friction__change": -0.2,
    "friction__reference_temperature": 25.0,
    "friction__temperature_range": 300.0,
}
HEAT: Feature = {"temperature": {"wheel": 30.0, "rail": 20.0, "exchange": True}}
COMMON: dict[str, Feature] = {
    "normal hertz": {"method__normal": "hertz"},
    "normal kik_piotrowski": {"method__normal": "kik_piotrowski"},
    "normal analyn": {"method__normal": "analyn"},
    "tangential none": {"method__tangential": "none", "friction": None},
    "tangential linear": {"method__tangential": "linear"},
    "tangential polach": {"method__tangential": "polach"},
    "tangential fastsim": {"method__tangential": "fastsim"},
    "tangential fastrip": {"method__tangential": "fastrip"},
    "tangential table": {"method__tangential": "table"},
    "fitted rows": {"grid__fitted": [8, 8]},
    "slip velocity": {**SLIP, "friction__memory_distance": 1e-5},
    "slip velocity, rational": {**SLIP, "friction__shape": "rational"},
    "slip velocity, linear": {**SLIP, "friction__shape": "linear"},
    "slip velocity, polach": {
        **SLIP,
        "friction__shape": "polach",
        "friction__kinetic": None,
        "friction__amplitude": None,
        "friction__halving_speed": None,
        "friction__coefficient": 0.4,
        "friction__polach_a": 0.4,
        "friction__polach_b": 0.6,
    },
    "temperature": HEAT,
    "temperature law": {**WARM, **HEAT},
    "elastic layer": {"layer": {"shear_modulus": 8.2e9, "thickness": 5e-5}},
    "plastic layer": {
        "layer": {
            "shear_modulus": 8.2e9,
            "thickness": 5e-5,
            "yield_stress": 6e7,
            "hardening": 2e12,
            "plastic_rule": "magnitude",
        }
    },
    "softening table": {
        "layer": {"thickness": 0.0, "hardening_table": [[0.0, 9e7], [1e-5, 8e7], [5e-5, 6e7]]}
    },
    "unlike bodies": {"material": {"shear_modulus": [82e9, 26e9], "poisson_ratio": [0.28, 0.33]}},
    "friction factor": {"friction__factor": [[-3e-3, 1.0], [3e-3, 0.6]]},
    "spin offset": {"method__spin_offset": "sixth"},
    "fastsim as CONTACT's": {
        "method__normal": "hertz",
        "method__tangential": "fastsim",
        "method__flexibility_blending": "contact",
    },
    "fastsim, parabolic": {
        "method__tangential": "fastsim",
        "method__traction_bound": "parabolic",
        "method__flexibility_blending": "none",
        "method__percent_kalker": 60.0,
    },
    "modified fastsim": {
        "method__tangential": "fastsim",
        "method__fastsim_k0": 0.5,
        "method__fastsim_alpha": 0.2,
        "method__fastsim_beta": 0.6,
    },
    "polach, factors": {
        "method__tangential": "polach",
        "method__polach_k_a": 0.8,
        "method__polach_k_s": 0.4,
        "method__percent_kalker": 60.0,
    },
    "water": {
        "fluid": {"model": "film", "roughness": 1e-6, "boundary_friction": 0.2, "liquid": "water"}
    },
    "regimes of water": {
        "friction__coefficient": None,
        "method__tangential": "polach",
        "fluid": {
            "model": "regimes",
            "water_rate": 1e-7,
            "recovery": {"coefficient": 1e-3},
            "rail_work": [300.0, 200.0],
        },
    },
    "water by strips": {
        "fluid": {"model": "strip", "roughness": 1e-6, "boundary_friction": 0.2, "liquid": "water"}
    },
    "starved oil": {
        "fluid": {
            "model": "film",
            "share": "load_sharing",
            "roughness": 2e-6,
            "liquid": "oil",
            "viscosity": 0.1,
            "oil_film": 2.5e-6,
            "inlet_heating": True,
        }
    },
    "derivatives": {"method__derivatives": True},
}
OF_PATCHES: dict[str, Feature] = {
    "curvatures": {"geometry": {"curvatures": [0.8, 1.4]}},
    "line": {"geometry": {"line_contact_radius": 0.5, "width": 0.1}, "grid": {"elements": [24, 1]}},
    "distance": {
        "geometry": {
            "undeformed_distance": [
                [((i - 9.5) * 6e-4) ** 2 + 2 * ((j - 9.5) * 6e-4) ** 2 for i in range(20)]
                for j in range(20)
            ]
        },
        "grid": {"element_size": [6e-4, 6e-4]},
        "load": {"normal_force": 2e4},
    },
    "no motion": {
        "motion__regime": "none",
        "motion__creepage": None,
        "motion__spin_creepage": None,
        "motion__rolling_speed": None,
        "friction": None,
    },
    "shift": {"motion__regime": "shift", "motion__creepage": [1e-5, 3e-6]},
    "transient": {
        "motion__regime": "transient_rolling",
        "motion__distance": 3e-3,
        "motion__steps": 4,
    },
    "force": {"motion__creepage": None, "motion__tangential_force": [-1.5e4, 2e3]},
    "one force": {"motion__creepage": None, "motion__tangential_force": [-1.5e4, "creepage"]},
    "backwards": {"motion__direction": -1},
    "standstill": {"motion__rolling_speed": 0.0},
    "sliding": {"motion__creepage": [8e-3, -4e-3]},
    "element size": {"grid": {"element_size": [9e-4, 7e-4]}},
}
OF_WHEELS: dict[str, Feature] = {
    "vertical force": {"wheelset__z": None, "wheelset__vertical_force": 1.2e5},
    "roller": {
        "wheelset__speed": 0.0,
        "track__kind": "roller",
        "track__roller_radius": 0.8,
        "track__roller_pitch_rate": 12.5,
    },
    "transient": {"motion": {"regime": "transient_rolling"}, "wheelset__time_step": 2e-4},
    "flange": {"wheelset__y": 6.2e-3, "wheelset__yaw": 8e-3},
    "other side": {"wheel__side": "left"},
    "curved reference": {"method__reference_surface": "curved"},
    "patch rule": {"method__patch_rule": "contact", "wheelset__y": 5e-3},
    "inclined frame": {"method__contact_frame": "inclined"},
    "standstill": {"wheelset__speed": 0.0, "wheelset__pitch_rate": 0.0, "wheelset__vy": 1e-4},
    "rates": {
        "wheelset__vy": 0.02,
        "wheelset__vz": 1e-3,
        "wheelset__roll_rate": 0.01,
        "wheelset__yaw_rate": 0.05,
    },
    "deviations": {
        "wheelset__right": {"offset": [0, 0, 1e-4], "rotation": [2e-3, 0, 1e-3]},
        "track__right": {"offset": [0, 1e-3, 0], "velocity": [0, 0.01, 0.01]},
    },
    "curve": {"track__curvature": 2e-3, "track__cant": 0.05, "track__gauge_widening": 5e-3},
    "rail support": {
        "track__rail_support": {"stiffness": [2e7, 8e7], "damping": [1e4, 3e4]},
        "wheelset__time_step": 1e-3,
    },
    "flat": {"wheelset__right": {"flat": {"depth": 5e-4, "angle": 0.0}}},
    "joint": {"track__right": {"joint": {"position": 0.1, "depth": 1e-3, "step": 1e-4}}},
    "runout": {"wheelset__right": {"runout": [1e-4 * (k % 4 - 1.5) ** 2 for k in range(16)]}},
    "friction along": {"friction__along_track": [[-1.0, 1.0], [1.0, 0.5]]},
    "elements": {"grid": {"elements": [14, 14]}},
}
PATCH_BASE = with_values(
    PATCH, grid__elements=[10, 10], motion__creepage=[1.2e-3, -4e-4], motion__spin_creepage=0.25
)
WHEELSET_BASE = with_values(
    WHEELSET, grid={"element_size": [1e-3, 1e-3]}, wheelset__y=1.5e-3, wheelset__z=2.4e-4
)
WHEEL_BASE = {**WHEELSET_BASE, "kind": "wheel_rail"}


def accepted_pairs(base: Case, features: dict[str, Feature]) -> Iterator[tuple[str, Case]]:
    """The case as it is, with each feature, and with each pair; names and cases."""
    yield "plain", base
    for name, feature in features.items():
        yield name, with_values(base, **feature)
    for (one, first), (two, second) in combinations(features.items(), 2):
        yield f"{one} + {two}", with_values(with_values(base, **first), **second)


def all_cases() -> Iterator[tuple[str, Case]]:
    """Name and case of every combination, what is refused included."""
    wheels = {k: v for k, v in OF_WHEELS.items() if k != "other side"}
    one_wheel = {k: OF_WHEELS[k] for k in ("other side", "vertical force", "roller", "transient")}
    for kind, base, features in (
        ("patch", PATCH_BASE, {**COMMON, **OF_PATCHES}),
        ("wheelset", WHEELSET_BASE, {**COMMON, **wheels}),
        ("wheel_rail", WHEEL_BASE, one_wheel),
    ):
        for name, case in accepted_pairs(base, features):
            yield f"{kind}: {name}", case


def sample(count: int, seed: int = 1) -> list[tuple[str, Case]]:
    """That many of all: those with one feature, so that each kind, method, regime and law is among
    them, and as many pairs of features as are left."""
    cases = list(all_cases())
    alone = [named for named in cases if " + " not in named[0]]
    pairs = [named for named in cases if " + " in named[0]]
    return alone + random.Random(seed).sample(pairs, max(count - len(alone), 0))
