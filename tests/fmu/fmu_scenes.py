"""Scenes that the FMU tests share."""

from __future__ import annotations

import zipfile
from pathlib import Path
from typing import Any

from case_samples import PATCH, WHEELSET, with_values
from railpatch import _core
from railpatch.case import load_scene
from railpatch.fmu import pack_fmu
from slave import OK, Fmu, Slave


def gap(count: int, size: float) -> list[list[float]]:
    """m, undeformed distance of a paraboloid on a square grid of elements."""
    axis = [(i - (count - 1) / 2) * size for i in range(count)]
    return [[x**2 + 2 * y**2 for x in axis] for y in axis]


# s, communication step
STEP = 1e-3
# a wheelset of 20 kN, and one wheel near its flange, where contact jumps between patches
LOADED = with_values(WHEELSET, wheelset__z=None, wheelset__vertical_force=2e4)
RAIL = with_values(WHEELSET, wheelset__z=2.0e-4)
ROLLER = with_values(
    RAIL,
    wheelset__speed=0.0,
    track={
        "kind": "roller",
        "gauge": 1.435,
        "gauge_height": 0.014,
        "roller_radius": 1.0,
        "roller_pitch_rate": 2.0,
    },
)
PATCHES = {
    **with_values(
        WHEELSET,
        wheelset__z=None,
        wheelset__vertical_force=5e4,
        wheelset__y=5.5e-3,
        wheelset__max_patches=6,
        profiles__rail="UIC60@1:20",
    ),
    "kind": "wheel_rail",
}
HEAT = {"wheel": 30.0, "rail": 20.0, "exchange": True}
WARM_LAW = {
    "law": "temperature",
    "reference": 0.4,
    "change": -0.2,
    "reference_temperature": 25.0,
    "temperature_range": 300.0,
}
# with a memory of the friction coefficient
FALLING = {
    **{"law": "slip_velocity", "kinetic": 0.1, "amplitude": 0.25, "halving_speed": 0.02},
    "memory_distance": 1e-3,
}
SCENES: dict[str, dict[str, Any]] = {
    "patch": PATCH,
    "patch_approach": with_values(
        PATCH, geometry={"curvatures": [1.0, 1.5]}, load={"approach": 5e-5}
    ),
    "patch_normal": with_values(PATCH, motion=None, friction=None),
    "line": with_values(
        PATCH, geometry={"line_contact_radius": 0.5, "width": 0.1}, grid={"elements": [16, 1]}
    ),
    "gap": with_values(
        PATCH,
        geometry={"undeformed_distance": gap(24, 5e-4)},
        grid={"element_size": [5e-4, 5e-4]},
        load={"normal_force": 2e4},
    ),
    "fast": with_values(PATCH, method={"normal": "hertz", "tangential": "fastsim"}),
    "rows": with_values(PATCH, method={"normal": "analyn", "tangential": "fastsim"}),
    "closed_form": with_values(PATCH, method={"normal": "hertz", "tangential": "polach"}),
    "strips": with_values(PATCH, method={"tangential": "fastrip"}),
    "fitted": with_values(PATCH, method={"normal": "hertz"}, grid={"fitted": [8, 8]}),
    "table": with_values(PATCH, method={"normal": "hertz", "tangential": "table"}),
    "layer": with_values(PATCH, layer={"shear_modulus": 8.2e9, "thickness": 5e-5}),
    "plastic": with_values(
        PATCH,
        motion__creepage=[2e-3, 0.0],
        layer={"shear_modulus": 8.2e9, "thickness": 2e-5, "yield_stress": 1.5e8, "hardening": 1e12},
    ),
    "falling": with_values(
        PATCH,
        friction={"law": "slip_velocity", "kinetic": 0.2, "amplitude": 0.2, "halving_speed": 0.1},
    ),
    "modified": with_values(
        PATCH,
        method={"normal": "kik_piotrowski_corrected", "tangential": "fastsim", "fastsim_beta": 0.6},
        friction={"law": "slip_velocity", "kinetic": 0.2, "amplitude": 0.2, "halving_speed": 0.1},
    ),
    "hot": with_values(PATCH, motion__creepage=[1e-2, 0.0], friction=WARM_LAW, temperature=HEAT),
    "warm": with_values(RAIL, wheelset__pitch_rate=-2.3 / 0.46, temperature=HEAT),
    "prescribed_force": with_values(
        PATCH, motion__creepage=[0.0, 1e-4], motion__tangential_force=[-5e3, "creepage"]
    ),
    "rail": RAIL,
    "roller": ROLLER,
    "loaded": LOADED,
    "left_wheel": {**RAIL, "kind": "wheel_rail", "wheel": {"side": "left"}},
    "patches": PATCHES,
    "frictionless": with_values(RAIL, method={"tangential": "none"}, friction=None),
    "transient": with_values(RAIL, motion__regime="transient_rolling", wheelset__time_step=STEP),
    "falling_wheels": with_values(RAIL, wheelset__pitch_rate=-2.01 / 0.46, friction=FALLING),
    "falling_transient": with_values(
        RAIL,
        motion__regime="transient_rolling",
        wheelset__time_step=STEP,
        wheelset__pitch_rate=-2.05 / 0.46,
        friction=FALLING,
    ),
    "transient_patch": with_values(
        PATCH, motion__regime="transient_rolling", motion__distance=1e-2, motion__steps=1
    ),
    "supported": with_values(
        RAIL,
        track__rail_support={"stiffness": [2e7, 5e7], "damping": [1e4, 5e4]},
        wheelset__time_step=STEP,
    ),
    "springs": with_values(
        RAIL, track__rail_support={"stiffness": [2e7, 5e7]}, wheelset__time_step=STEP
    ),
    "sections": with_values(
        RAIL,
        wheelset__z=3e-4,
        profiles__rail=None,
        **{
            f"track__{side}__sections": [
                {"position": 0.0, "profile": "UIC60@1:40"},
                {"position": 2.0, "profile": "UIC60@1:20"},
            ]
            for side in ("left", "right")
        },
    ),
    "turnout": with_values(
        RAIL,
        wheelset__z=None,
        wheelset__vertical_force=1.2e5,
        profiles__rail=None,
        profiles__rail_left="UIC60@1:40",
        track__section_blend="cubic",
        track__right__origin=[0.7605, 1e-5],
        track__right__sections=[
            {"position": 0.0, "profile": "UIC60@1:40", "features": [0.06, 0.09]},
            {"position": 2.0, "profile": "UIC60@1:20", "features": [0.062, 0.09], "kink": True},
            {"position": 2.5, "profile": "UIC60@1:40", "features": [0.063, 0.09]},
        ],
        wheelset__right__sections=[
            {"angle": 0.0, "profile": "S1002"},
            {"angle": 3.0, "profile": "worn@14"},
        ],
    ),
    "along": with_values(RAIL, friction__along_track=[[0.0, 1.0], [1.0, 0.5]]),
    "flat": with_values(
        RAIL,
        wheelset__z=3e-4,
        wheelset__left__flat={"depth": 1e-4, "rounding": 6e-3},
        track__right__joint={"position": 0.5, "depth": 1e-4},
    ),
}
# what is set before each step, by scene
MOTIONS: dict[str, list[dict[str, float]]] = {
    "patch": [
        {"creepage[1]": 2e-3},
        {"creepage[2]": -5e-4, "spin_creepage": 0.4},
        {"normal_force": 6e4, "direction": -1},
        {"rolling_speed": 0.0},
    ],
    "patch_approach": [{"approach": 8e-5}, {"approach": -1e-6}, {"approach": 3e-5}],
    "patch_normal": [{"normal_force": 2e4}],
    "prescribed_force": [{"tangential_force[1]": 8e3}, {"creepage[2]": -5e-4, "normal_force": 6e4}],
    "line": [{"creepage[1]": 2e-3}, {"normal_force": 5e4}],
    "gap": [{"creepage[2]": 2e-3}, {"normal_force": 1e4}],
    "fast": [{"creepage[2]": 2e-3}, {"normal_force": 1e4, "spin_creepage": 0.2}],
    "rows": [{"creepage[2]": 2e-3}, {"normal_force": 1e4, "spin_creepage": 0.2}],
    "closed_form": [{"creepage[2]": 2e-3}, {"normal_force": 1e4, "spin_creepage": 0.2}],
    "strips": [{"creepage[2]": 2e-3}, {"normal_force": 1e4, "spin_creepage": 0.2}],
    "fitted": [{"creepage[2]": 2e-3}, {"normal_force": 1e4, "spin_creepage": 0.2}],
    "table": [{"creepage[2]": 2e-3}, {"normal_force": 1e4, "spin_creepage": 0.2}],
    "layer": [{"creepage[1]": 2e-3}],
    "plastic": [{"creepage[2]": 1e-3}, {"normal_force": 6e4}],
    "falling": [{"creepage[1]": 4e-3}, {"spin_creepage": 0.2}],
    "modified": [{"creepage[1]": 4e-3}, {"spin_creepage": 0.2}, {"normal_force": 2e4}],
    "hot": [{"temperature.wheel": 150.0}, {"creepage[1]": 4e-3, "temperature.rail": 40.0}],
    "warm": [{"temperature.rail": 45.0}, {"wheelset.z": -1e-3}, {"wheelset.z": 2.1e-4}],
    "rail": [
        {"wheelset.y": 1e-4, "wheelset.yaw": 1e-3},
        {"wheelset.vy": 0.01, "wheelset.left.offset[3]": 2e-5, "track.right.rotation[1]": 1e-4},
        {"wheelset.z": -1e-3},
        {"wheelset.z": 1.9e-4, "wheelset.right.rotation[3]": 1e-3},
    ],
    "roller": [
        {"wheelset.y": 1e-4, "wheelset.yaw": 1e-3},
        {"track.roller_pitch_rate": 2.01, "track.left.offset[1]": 1e-4},
        {"wheelset.z": -1e-3},
        {"wheelset.z": 1.9e-4},
    ],
    "loaded": [{"wheelset.y": 1e-4}, {"wheelset.vertical_force": 3e4, "wheelset.roll": 1e-5}],
    "left_wheel": [{"wheelset.yaw": -1e-3, "track.left.offset[2]": 1e-4}],
    "patches": [{"wheelset.y": y} for y in (5.75e-3, 6e-3, 6.25e-3, 5.5e-3, 0.0)],
    "frictionless": [{"wheelset.yaw": 1e-3}, {"wheelset.z": 2.1e-4}],
    "falling_wheels": [{"wheelset.yaw": 1e-3}, {"wheelset.vy": 0.01}, {"wheelset.speed": 2.2}],
    "falling_transient": [{"wheelset.yaw": 1e-3}, {"wheelset.vy": 0.01}, {"wheelset.z": 2.1e-4}],
    "transient": [{"wheelset.yaw": 1e-3}, {"wheelset.vy": 0.01}, {"wheelset.z": 2.1e-4}],
    "transient_patch": [{"creepage[1]": 5e-4}, {"creepage[2]": -5e-4, "normal_force": 6e4}],
    "supported": [{"wheelset.y": 1e-4}, {"wheelset.z": 2.2e-4, "track.left.velocity[2]": 0.01}],
    "springs": [{"wheelset.y": 1e-4}, {"wheelset.z": 6e-4, "wheelset.yaw": 1e-3}],
    "sections": [{"wheelset.x": 0.4}, {"wheelset.x": 1.7, "wheelset.yaw": 1e-3}],
    "turnout": [
        {"wheelset.x": 0.4, "wheelset.pitch": 0.2},
        {"wheelset.x": 2.2, "wheelset.pitch": -0.3},
    ],
    "along": [{"wheelset.x": 0.4}, {"wheelset.x": 0.9, "wheelset.yaw": 1e-3}],
    "flat": [
        {"wheelset.x": 0.4, "wheelset.pitch": 0.5},
        {"wheelset.x": 0.5, "wheelset.pitch": 1e-2, "wheelset.left.angular_velocity[3]": 0.02},
    ],
}
OWN = _core.fft_backend()


class Packer:
    """FMUs of scenes by name, packed and unpacked once."""

    def __init__(self, folder: Path, scenes: dict[str, Any], **options: dict[str, Any]) -> None:
        """options: those of pack_fmu, by name of the scene."""
        self._folder, self._scenes, self._options = folder, scenes, options
        self._found: dict[str, Fmu] = {}

    def __call__(self, name: str) -> Fmu:
        if name not in self._found:
            path = self._folder / f"{name}.fmu"
            options = {"backend": OWN, **self._options.get(name, {})}
            pack_fmu(load_scene(self._scenes[name]), path, name=name, **options)
            zipfile.ZipFile(path).extractall(path.with_suffix(""))
            self._found[name] = Fmu(path.with_suffix(""))
        return self._found[name]


def run(slave: Slave, motions: list[dict[str, float]], time: float) -> dict[str, float]:
    """Outputs after some steps."""
    for values in motions:
        assert slave.set(values) == OK, slave.log
        assert slave.step(time, STEP) == OK, slave.log
        time += STEP
    return slave.outputs()
