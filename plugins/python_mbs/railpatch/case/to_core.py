"""From a checked case to the structs of the core, as dictionaries by field name."""

from __future__ import annotations

from typing import Any

from railpatch.case.common import WHEEL_METHOD, Friction, Layer, Temperature
from railpatch.case.creep_table import default_table
from railpatch.case.load import Case, Scene
from railpatch.case.longitudinal import shape_config
from railpatch.case.patch import SHAPES, PatchCase
from railpatch.case.resolve import resolved
from railpatch.case.theories import FAST_NUMBERS
from railpatch.case.types import MOST_POINTS, SIDES
from railpatch.case.wheel import WheelRailCase, WheelsetCase
from railpatch.profiles import Profile, load_profile
from railpatch.profiles.sections import matching_sections

WHEELSET_STATE = (
    *("x", "y", "roll", "pitch", "yaw"),
    *("speed", "vy", "vz", "roll_rate", "pitch_rate", "yaw_rate"),
    "time_step",
)
DEVIATION = ("offset", "rotation", "velocity", "angular_velocity")


def config_of(scene: Scene) -> dict[str, Any]:
    """Fields of rp_config; what is left out keeps the core's default. Raises CaseError,
    ProfileError."""
    case = resolved(scene.case)
    config: dict[str, Any] = {
        "kind": case.kind,
        "shear_modulus": case.material.shear_modulus,
        "poisson_ratio": case.material.poisson_ratio,
        "normal": case.method.normal,
        "tangential": case.method.tangential,
        "tolerance": case.method.tolerance,
        "derivatives": int(case.method.derivatives),
        "spin_offset": case.method.spin_offset,
        "reference_surface": case.method.reference_surface,
        "flexibility_blending": case.method.flexibility_blending,
        **{name: getattr(case.method, name) for name in FAST_NUMBERS},
    }
    optional = {
        "max_iterations": case.method.max_iterations,
        "traction_bound": case.method.traction_bound,
        **friction_config(case.friction),
        **layer_config(case.layer),
        **temperature_config(case.temperature),
    }
    config.update({key: value for key, value in optional.items() if value is not None})
    if case.has_tangential and case.method.tangential == "table":
        config["creep_table"] = default_table()
    config.update(patch_config(scene) if isinstance(case, PatchCase) else wheel_config(scene, case))
    config.update(grid_config(case))
    return config


def friction_config(friction: Friction | None) -> dict[str, Any]:
    """Friction law."""
    if friction is None:
        return {}
    config: dict[str, Any] = {"friction_law": friction.law}
    if friction.law == "coulomb":
        config["friction_coefficient"] = friction.coefficient
    if friction.law == "slip_velocity":
        amplitudes, speeds = friction.terms
        config["slip_law"] = "exponential" if friction.shape == "polach" else friction.shape
        config["friction_kinetic"] = friction.kinetic_coefficient
        config["friction_amplitude"] = [*amplitudes, 0.0][:2]
        config["friction_halving_speed"] = [*speeds, 1.0][:2]
    if friction.law == "temperature":
        for name in ("reference", "change", "reference_temperature", "temperature_range"):
            config[f"friction_{name}"] = getattr(friction, name)
    if friction.law != "coulomb":
        config["friction_memory_distance"] = friction.memory_distance
        config["friction_memory_speed"] = friction.memory_speed
    names = ("position", "factor")
    if friction.factor is not None:
        config.update(points_config("friction", names, friction.factor))
    if friction.along_track is not None:
        config.update(points_config("friction_along", names, friction.along_track))
    return config


def layer_config(layer: Layer | None) -> dict[str, Any]:
    """Third-body layer."""
    if layer is None:
        return {}
    config: dict[str, Any] = {
        "layer_shear_modulus": layer.shear_modulus,
        "layer_thickness": layer.thickness,
    }
    if not layer.is_plastic:
        return config
    config["plastic_rule"] = layer.plastic_rule
    config["plastic_heat_fraction"] = layer.plastic_heat_fraction
    if layer.hardening_table is None:
        config["layer_yield_stress"] = layer.yield_stress
        config["layer_hardening"] = layer.hardening
        return config
    config["layer_yield_stress"] = layer.hardening_table[0][1]
    names = ("displacement", "stress")
    return {**config, **points_config("hardening", names, layer.hardening_table)}


def temperature_config(heat: Temperature | None) -> dict[str, Any]:
    """Surface temperature."""
    if heat is None:
        return {}
    return {
        "temperature": 1,
        "bulk_temperature": [heat.wheel, heat.rail],
        "heat_exchange": int(heat.exchange),
        "conductivity": heat.conductivity,
        "heat_capacity": heat.heat_capacity,
        "density": heat.density,
        "temperature_depth": heat.depth,
    }


def points_config(prefix: str, names: tuple[str, str], points: list[list[float]]) -> dict[str, Any]:
    """A table of pairs as the core's arrays of fixed length."""
    columns = zip(*points, strict=True)
    padded = {
        f"{prefix}_{name}": [*column, *[0.0] * (MOST_POINTS - len(points))]
        for name, column in zip(names, columns, strict=True)
    }
    return {f"{prefix}_points": len(points), **padded}


def grid_config(case: Case) -> dict[str, Any]:
    """Elements by number or by size; the other is zero."""
    line = isinstance(case, PatchCase) and case.geometry.line_contact_radius is not None
    if case.grid is None:
        return {"elements": [24, 1 if line else 24], "element_size": [0.0, 0.0]}
    standard = [0, 0] if case.grid.element_size else [24, 1 if line else 24]
    return {
        "elements": case.grid.elements or standard,
        "element_size": case.grid.element_size or [0.0, 0.0],
        "max_elements": case.grid.max_elements or [0, 0],
        "fitted": case.grid.fitted or [0, 0],
    }


def patch_config(scene: Scene) -> dict[str, Any]:
    """Geometry and load of a patch."""
    case = scene.case
    assert isinstance(case, PatchCase)
    shape = next(name for name in SHAPES if getattr(case.geometry, name) is not None)
    config: dict[str, Any] = {
        "geometry": shape,
        "load": "force" if case.load.normal_force is not None else "position",
        "regime": case.motion.regime,
        "force_prescribed": [int(prescribed) for prescribed in case.motion.prescribed],
    }
    if shape == "undeformed_distance":
        config[shape] = scene.gap()
    else:
        config[shape] = getattr(case.geometry, shape)
    if case.geometry.width is not None:
        config["width"] = case.geometry.width
    return config


def wheel_config(scene: Scene, case: WheelRailCase | WheelsetCase) -> dict[str, Any]:
    """Dimensions, track and profiles of a wheel or wheelset."""
    wheelset, track = case.wheelset, case.track
    config: dict[str, Any] = {
        "load": "position" if wheelset.z is not None else "force",
        "regime": case.motion.regime if case.has_tangential else "none",
        "nominal_radius": wheelset.nominal_radius,
        "flange_back_distance": wheelset.flange_back_distance,
        "flange_back_position": wheelset.flange_back_position,
        "track": track.kind,
        "gauge": track.gauge,
        "gauge_height": track.gauge_height,
        "gauge_widening": track.gauge_widening,
        "cant": track.cant,
        "curvature": track.curvature,
        "wheel": profile_pair(scene, case, "wheel"),
        "rail": profile_pair(scene, case, "rail"),
    }
    if track.roller_radius is not None:
        config["roller_radius"] = track.roller_radius
    if track.rail_support is not None:
        config["rail_stiffness"] = track.rail_support.stiffness
        config["rail_damping"] = track.rail_support.damping
    config.update(sections_config(scene, case))
    if wheelset.max_patches is not None:
        config["max_patches"] = wheelset.max_patches
    chosen = {name: getattr(case.method, name) for name in WHEEL_METHOD}
    config.update({name: value for name, value in chosen.items() if value is not None})
    if isinstance(case, WheelRailCase):
        config["side"] = case.wheel.side
    return {**config, **shape_config(case, scene.folder)}


def profile_pair(scene: Scene, case: WheelRailCase | WheelsetCase, body: Any) -> list[Any]:
    """[left, right] of the wheels or the rails; None for a side that has no wheel."""
    pair: list[Any] = []
    for side in SIDES:
        by_sections = body == "rail" and getattr(case.track, side).sections is not None
        if side not in case.sides or by_sections:
            pair.append(None)
            continue
        _, name = case.profiles.of(body, side)
        assert name is not None
        profile = load_profile(name, body, folder=scene.folder, smoothing=case.profiles.smoothing)
        pair.append(profile_arrays(profile))
    return pair


def profile_arrays(profile: Profile) -> dict[str, Any]:
    """The arrays of rp_profile."""
    return {key: getattr(profile, key) for key in ("arc_length", "y", "z", "dy", "dz")}


def sections_config(scene: Scene, case: WheelRailCase | WheelsetCase) -> dict[str, Any]:
    """Profiles of the rails along the track, where they vary; [left, right]."""
    rails = [getattr(case.track, side) for side in SIDES]
    found = [
        rail.sections if rail.sections and side in case.sides else []
        for side, rail in zip(SIDES, rails, strict=True)
    ]
    if not any(found):
        return {}
    profiles = []
    for sections in found:
        loaded = [
            load_profile(s.profile, "rail", folder=scene.folder, smoothing=case.profiles.smoothing)
            for s in sections
        ]
        profiles.append([profile_arrays(p) for p in matching_sections(loaded)] if loaded else [])
    positions = [[section.position for section in sections] for sections in found]
    return {"rail_sections": profiles, "section_position": positions}


def input_of(case: Case) -> dict[str, Any]:
    """Fields of rp_input."""
    if isinstance(case, PatchCase):
        values = case.motion.model_dump(exclude={"regime", "distance", "steps"})
        values["creepage"] = case.motion.creepages[0]
        values["tangential_force"] = case.motion.forces
        if case.motion.distance is not None:
            values["distance"] = case.motion.distance / (case.motion.steps or 1)
        values.update(case.load.model_dump(exclude_none=True))
        return {**values, **bulk_of(case)}
    wheelset, track = case.wheelset, case.track
    values = {name: getattr(wheelset, name) for name in WHEELSET_STATE}
    if wheelset.z is not None:
        values["z"] = wheelset.z
    else:
        values["vertical_force"] = wheelset.vertical_force
    if track.roller_pitch_rate is not None:
        values["roller_pitch_rate"] = track.roller_pitch_rate
    for name, table in (("wheel", wheelset), ("rail", track)):
        for key in DEVIATION:
            values[f"{name}_{key}"] = [getattr(table.left, key), getattr(table.right, key)]
    return {**values, **bulk_of(case)}


def bulk_of(case: Case) -> dict[str, Any]:
    """Bulk temperatures of a step, in a scene that has them."""
    heat = case.temperature
    return {} if heat is None else {"bulk_temperature": [heat.wheel, heat.rail]}
