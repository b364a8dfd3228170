"""Warnings of what no vehicle and no track has: masses, inertias, springs in another unit."""

from __future__ import annotations

import math
from collections.abc import Iterator
from itertools import pairwise

from wheelset_demo.scene import GRAVITY
from wheelset_demo.vehicle.alignment import AlignmentTable
from wheelset_demo.vehicle.bodies import BodyTable, VehicleTable
from wheelset_demo.vehicle.deviations import DipTable
from wheelset_demo.vehicle.elements import ElementTable
from wheelset_demo.vehicle.scene import VehicleScene
from wheelset_demo.vehicle.sections import CANT_BASE
from wheelset_demo.vehicle.support import SupportTable
from wheelset_demo.vehicle.wet_track import WetTable

# kg: railway vehicles from a narrow-gauge tram to a loaded freight wagon
MASSES = {"body": (100.0, 1.2e5), "wheelset": (300.0, 5e3), "axle_box": (10.0, 1e3)}
# kg, of the heaviest body: nothing that is lighter is a vehicle's
LIGHTEST = 1e3
# m, sqrt(inertia/mass): from an axle box of 50 mm to a car body of 50 m
GYRATION = (0.02, 15.0)
# of elements' numbers other than 0
ELEMENT = {
    "stiffness": (1e3, 1e10, "N/m"),
    "damping": (1.0, 1e8, "N s/m"),
    "series_stiffness": (1e3, 1e10, "N/m"),
    "turning_stiffness": (1.0, 1e9, "N m/rad"),
    "turning_damping": (0.1, 1e8, "N m s/rad"),
    "friction_stiffness": (1e3, 1e10, "N/m"),
    "friction_force": (1.0, 1e6, "N"),
    "friction_coefficient": (1e-3, 1.0, "-"),
    "turning_friction_stiffness": (1.0, 1e9, "N m/rad"),
    "turning_friction_moment": (1.0, 1e6, "N m"),
}
# m, N, of a bump stop's last point
STOP = ((1e-4, 1.0), (10.0, 1e7))
# m, of cant that is none
LEVEL = 1e-3
# m/s^2, across, that cant does not take: twice what trains that tilt have
UNBALANCED = 4.0
# m, by which springs give under the weight of the body between them
SAG = 1.0
SUPPORT = {
    "rail_mass": (5.0, 1e3, "kg"),
    "pad_stiffness": (1e6, 1e10, "N/m"),
    "pad_damping": (10.0, 1e7, "N s/m"),
    "sleeper_mass": (20.0, 2e3, "kg"),
    "sleeper_inertia": (1.0, 2e3, "kg m^2"),
    "ballast_stiffness": (1e6, 1e10, "N/m"),
    "ballast_damping": (10.0, 1e7, "N s/m"),
    "seat_distance": (0.5, 3.0, "m"),
}


def outside(name: str, value: float, low: float, high: float, unit: str) -> Iterator[str]:
    """The warning of a number that is not 0 and out of its range."""
    if value and not low <= abs(value) <= high:
        shown = "" if unit == "-" else f" {unit}"
        yield f"{name} is {value:g}{shown}, outside {low:g} to {high:g}{shown}"


# m, of way in a time step: irregularities of the track have waves of 3 m and more
LONGEST_WAY = 0.25


def doubts_of(scene: VehicleScene) -> list[str]:
    """Warnings of all that a scene says, before anything runs."""
    return [
        *long_steps(scene.speed, scene.run.step),
        *doubtful_bodies(scene.vehicle),
        *doubtful_elements(scene.vehicle),
        *doubtful_support(scene.support),
        *low_outer_rail(scene.alignment),
        *too_fast(scene.speed, scene.alignment),
        *unmet_dips(scene.dip, scene.way),
        *unmet_water(scene.wet, scene.way),
    ]


def long_steps(speed: float, step: float) -> Iterator[str]:
    """The warning of time steps (s) in which a vehicle (m/s) passes what excites it."""
    if abs(speed) * step > LONGEST_WAY:
        yield (
            f"run.step is {step:g} s, in which {abs(speed) * step:.3g} m of track are passed, more "
            f"than {LONGEST_WAY:g} m"
        )


def doubtful_bodies(vehicle: VehicleTable) -> list[str]:
    """Warnings of bodies whose mass or inertia no railway vehicle has."""
    found: list[str] = []

    def check(name: str, kind: str, body: BodyTable) -> None:
        low, high = MASSES[kind]
        if vehicle.bodies[0].name == name:
            low = LIGHTEST
        found.extend(outside(f"vehicle.{name}.mass", body.mass, low, high, "kg"))
        for axis, inertia in zip("xyz", body.inertia, strict=True):
            radius = math.sqrt(inertia / body.mass)
            if not GYRATION[0] <= radius <= GYRATION[1]:
                found.append(
                    f"vehicle.{name}.inertia about {axis} is {inertia:g} kg m^2: a radius of "
                    f"gyration of {radius:.3g} m, outside {GYRATION[0]:g} to {GYRATION[1]:g} m"
                )

    for body in vehicle.bodies:
        check(body.name, "body", body)
    for table in vehicle.wheelset:
        check("wheelset", "wheelset", table)
        if table.axle_box is not None:
            check("wheelset.axle_box", "axle_box", table.axle_box)
    return found


def doubtful_elements(vehicle: VehicleTable) -> list[str]:
    """Warnings of springs, dampers, stops and sliders that no railway vehicle has."""
    found: list[str] = []
    for k, element in enumerate(vehicle.element):
        named = f"vehicle.element[{k}] {element.name!r}"
        for key, (low, high, unit) in ELEMENT.items():
            for axis, value in zip("xyz", getattr(element, key), strict=True):
                found.extend(outside(f"{named}: {key}, {axis},", value, low, high, unit))
        if element.bump_stop is None:
            continue
        for axis in "xyz":
            if (curve := getattr(element.bump_stop, axis)) is None:
                continue
            for what, unit, value, limits in zip(
                ("displacement", "force"), ("m", "N"), curve[-1], STOP, strict=True
            ):
                name = f"{named}: last {what} of bump_stop.{axis}"
                found.extend(outside(name, value, *limits, unit))
    return [*found, *sagging(vehicle)]


def vertical_stiffness(element: ElementTable) -> float:
    """N/m, the most that it has along z."""
    found = element.stiffness[2] + element.friction_stiffness[2]
    if element.bump_stop is not None and (curve := element.bump_stop.z) is not None:
        found += max((b[1] - a[1]) / (b[0] - a[0]) for a, b in pairwise(curve))
    return found


def sagging(vehicle: VehicleTable) -> Iterator[str]:
    """Of bodies whose weight would press all springs that touch them by more than a metre."""
    stiffness = {body.name: 0.0 for body in vehicle.bodies}
    for element in vehicle.element:
        for place in element.places:
            for name in set(place.between) & set(stiffness):
                stiffness[name] += vertical_stiffness(element)
    for body in vehicle.bodies:
        sum_z, weight = stiffness[body.name], body.mass * GRAVITY
        if sum_z > 0 and weight > SAG * sum_z:
            yield (
                f"vehicle.{body.name}: its weight of {weight:.3g} N presses its vertical springs "
                f"({sum_z:.3g} N/m) by {weight / sum_z:.3g} m: stiffness is in N/m"
            )


def doubtful_support(support: SupportTable | None) -> list[str]:
    """Warnings of a track below the rails that none has."""
    found: list[str] = []
    if support is None:
        return found
    for key, (low, high, unit) in SUPPORT.items():
        value = getattr(support, key)
        if isinstance(value, list):
            for way, one in zip(("lateral", "vertical"), value, strict=True):
                found.extend(outside(f"support.{key}, {way},", one, low, high, unit))
        elif value is not None:
            found.extend(outside(f"support.{key}", value, low, high, unit))
    return found


def low_outer_rail(alignment: AlignmentTable) -> Iterator[str]:
    """The warning of cant the other way round: as in turnouts alone."""
    if alignment.cant < -LEVEL:
        yield (
            f"alignment.cant is {alignment.cant:g} m: the inner rail of the curve lies higher; > 0 "
            "raises the outer one, whichever way the curve turns"
        )


def too_fast(speed: float, alignment: AlignmentTable) -> Iterator[str]:
    """The warning of a speed (m/s) that no train has in the curves of its track."""
    arcs = {"alignment": (alignment.radius, alignment.cant)}
    if alignment.section is not None:
        arcs = {
            f"alignment.section[{k}]": (section.radius, section.cant)
            for k, section in enumerate(alignment.section)
        }
    for name, (radius, cant) in arcs.items():
        if radius is None:
            continue
        left = speed**2 / abs(radius) - GRAVITY * cant / CANT_BASE
        if left > UNBALANCED:
            yield (
                f"wheelset.speed is {speed:g} m/s: in a curve of {name}.radius {radius:g} m with a "
                f"cant of {cant:g} m {left:.3g} m/s^2 are left across the track, above "
                f"{UNBALANCED:g} m/s^2"
            )
            return


def unmet_dips(dips: tuple[DipTable, ...], reached: float) -> list[str]:
    """Warnings of joints that no wheelset comes to. reached: m, of the first at the run's end."""
    return [
        f"dip[{k}].position is {dip.position:g} m, and the first wheelset ends at {reached:.6g} m: "
        "no wheel comes to it"
        for k, dip in enumerate(dips)
        if dip.position - 0.5 * dip.length > reached
    ]


def unmet_water(wet: tuple[WetTable, ...], reached: float) -> list[str]:
    """Warnings of wet stretches that no wheelset comes to. reached: m, as of unmet_dips."""
    return [
        f"wet[{k}].position is {one.position:g} m, and the first wheelset ends at {reached:.6g} m: "
        "no wheel comes to it"
        for k, one in enumerate(wet)
        if one.position > reached
    ]
