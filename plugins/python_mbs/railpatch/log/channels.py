"""The run log's own channels, in one table.

Everything that must agree about the log reads this table: the protobuf schemas (schema.py), the
checks of what is written (encode.py), the metadata in the file (writer.py), the axis labels of the
report, and the documentation (``markdown``). Channels with well-known Foxglove messages are listed
in ``WELL_KNOWN``; the library that defines those messages documents their fields.

Conventions that hold for every channel stand in ``CONVENTIONS``.
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache

from railpatch import _core
from railpatch.case.types import BODIES
from railpatch.record.quantities import ABOUT_SIGNS, ABSCISSA, QUANTITIES
from railpatch.record.units import UNITS
from railpatch.result import LOGGED

STATUSES: tuple[str, ...] = _core.CHOICES["status"]
# m, over which wheel forces are averaged before their ratio is judged (EN 14363)
SLIDING = 2.0
# N: below, a wheel has no ratio of its forces
LEAST_LOAD = 1.0

# attached by railpatch hunting: what its search has found
HUNTING = "hunting.json"

# codes of element_division, in this order from 0
ELEMENT_STATES: tuple[str, ...] = _core.CHOICES["element"]

CONVENTIONS = {
    "units": "SI; temperatures in degrees Celsius, angles in rad",
    "time": "log_time is simulation time in nanoseconds from the start of the run, not a date",
    "track_axes": "x forward along the track centre line, y right, z down; origin in the plane on "
    "the rails' or rollers' tops; roll, yaw, pitch follow the right-hand rule",
    "start_axes": "of a vehicle: the track axes at the start of the run, fixed to the ground",
    "wheelset_position": "the wheelset's centre at z = 0 lies one nominal wheel radius above the "
    "origin; forward rolling is a negative pitch rate of the wheelset, a positive one of rollers",
    "contact_axes": "of a patch: origin at its position, x along rolling, y lateral along the "
    "surface, normal pointing down into the rail or roller; contact_angle turns about x from "
    "track z to the normal",
    "profile_axes": "y and z of a profile as it was given, flange or gauge side at negative y",
    "forces": "on the wheel; on the rail or roller they are the opposite",
    "creepages": "wheel minus rail, divided by the rolling speed",
    "missing": "a value that the scene left out, or that was not found, is absent, never zero",
}


@dataclass(frozen=True)
class Field:
    """One field of a message.

    ``kind`` is a protobuf scalar ("double", "uint32", "string") or the ``Message`` it holds.
    ``size`` is 1 for a single value, n for a list of n values, 0 for a list of any length.
    ``unit`` is "-" for a number without unit and "" for text or a message.
    """

    name: str
    kind: str | Message
    unit: str
    text: str
    frame: str = ""
    size: int = 1
    required: bool = False
    choices: tuple[str, ...] = ()


# equal only to itself: its hash, by which classes are found for every message, costs nothing
@dataclass(frozen=True, eq=False)
class Message:
    """A protobuf message: its name without package, what it is, and its fields in order."""

    name: str
    text: str
    fields: tuple[Field, ...]

    def field(self, name: str) -> Field:
        """The field called ``name``; KeyError where there is none."""
        for field in self.fields:
            if field.name == name:
                return field
        raise KeyError(f"{self.name} has no field {name!r}")


@dataclass(frozen=True)
class Channel:
    """A channel of the log: its topic, its message and what it is for."""

    topic: str
    message: Message
    text: str


def _number(name: str, unit: str, text: str, frame: str = "", **more: object) -> Field:
    return Field(name, "double", unit, text, frame, **more)  # type: ignore[arg-type]


def _count(name: str, text: str, **more: object) -> Field:
    return Field(name, "uint32", "-", text, **more)  # type: ignore[arg-type]


def _status(text: str, required: bool = False) -> Field:
    return Field("status", "string", "", text, choices=STATUSES, required=required)


def _text(struct: str, name: str, size: int = 1) -> Field:
    """A text of the core's result."""
    return Field(name, "string", "", _core.QUANTITIES[struct][name]["text"], size=size)


def _listed(struct: str, name: str, frame: str = "") -> Field:
    """A quantity of the core's result, with unit and text from its list."""
    known = _core.QUANTITIES[struct][name]
    kind = "double" if known["type"] == "double" else "uint32"
    unit = "degC" if known["unit"] == "degrees C" else known["unit"]
    # the frame has a column of its own
    text = known["text"].replace(f", {frame} axes", "") if frame else known["text"]
    return Field(name, kind, unit, text, frame, size=math.prod(known["shape"]))


WHEELSET_STATE = Message(
    "WheelsetState",
    "Position and speeds of the wheelset, and what drives it.",
    (
        _number("progress", "-", "part of the run that is done, 0 to 1"),
        _number("x", "m", "distance travelled along the track", "track"),
        _number("y", "m", "lateral position of the wheelset's centre", "track", required=True),
        _number("z", "m", "vertical position of the wheelset's centre", "track", required=True),
        _number("roll", "rad", "roll angle", "track", required=True),
        _number("yaw", "rad", "yaw angle, which is the angle of attack", "track", required=True),
        _number("pitch", "rad", "angle turned about the axle; only the 3D scene needs it"),
        _number("speed", "m/s", "forward speed of the centre; 0 on a roller rig", "track"),
        _number("vy", "m/s", "lateral speed of the centre", "track"),
        _number("vz", "m/s", "vertical speed of the centre", "track"),
        _number("roll_rate", "rad/s", "rate of the roll angle", "track"),
        _number("yaw_rate", "rad/s", "rate of the yaw angle", "track"),
        _number("pitch_rate", "rad/s", "speed of rotation about the axle", "wheelset"),
        _number("roller_pitch", "rad", "angle turned by the rollers; only the 3D scene needs it"),
        _number("roller_pitch_rate", "rad/s", "speed of rotation of the rollers", "track"),
        _number("vertical_force", "N", "vertical load on the wheelset, down", "track"),
        _number("force", "N", "sum of both wheels' contact forces", "track", size=3),
        _number("moment", "N m", "their moment about the wheelset's centre", "track", size=3),
        _number("curvature", "1/m", "curvature of the track, right-hand curve > 0", "track"),
        _number("cant", "rad", "cant of the track", "track"),
        _number("left_rail", "m", "lateral, vertical place of the left rail", "track", size=2),
        _number("right_rail", "m", "the same of the right rail", "track", size=2),
        _number("drive_torque", "N m", "of motors or brakes, > 0 pulls; of driven wheelsets"),
        _number("slip_speed", "m/s", "rolling at the nominal radius, less the vehicle's speed"),
        *(_listed("result", name) for name in LOGGED),
    ),
)

ELEMENTS = Message(
    "Elements",
    "How many elements of the potential contact are in each state.",
    tuple(_count(state, f"elements in state {state}") for state in ELEMENT_STATES),
)

ERROR_ESTIMATE = Message(
    "ErrorEstimate",
    "Bounds that 95 % of the errors against the exact theory stay below, by the method's measured "
    "errors.",
    (
        _number("creep_force", "N", "of the creep force: length of the error vector"),
        _number("spin_moment", "N m", "of the spin moment"),
        _number("max_pressure", "Pa", "of the highest contact pressure"),
    ),
)

SUBSURFACE = Message(
    "Subsurface",
    "Greatest stresses at depths below a patch, or below all patches of a wheel.",
    (
        Field("body", "string", "", "body that is looked at", choices=BODIES),
        _number("depth", "m", "below the body's own surface", size=0),
        _number("max_shear", "Pa", "greatest shear of each depth", size=0),
        _number("von_mises", "Pa", "greatest von Mises stress of each depth", size=0),
        _number("dang_van", "Pa", "greatest Dang Van stress of each depth", size=0),
    ),
)

DAMAGE = Message(
    "Damage",
    "Wear and rolling contact fatigue of a patch; of a wheel sums of its patches by share for the "
    "wear rate and the whole-life damage, else the greatest.",
    (
        _number("wear_rate", "kg/m", "mass that each body loses by metre rolled"),
        _number("wheel_depth_rate", "-", "greatest wear depth by metre rolled, round the wheel"),
        _number("rail_depth", "m", "greatest wear depth of one passage"),
        _number("fatigue_index", "-", "FI_surf: above 0 beyond the surface's shakedown limit"),
        _number("stress_index", "Pa", "greatest traction less the yield stress in shear"),
        _number("whole_life_damage", "-", "of one passage, by the whole-life function of T gamma"),
        _number("work_scale", "-", "of a patch's elements' work; null of a wheel and by the patch"),
    ),
)

_IN_CONTACT_FRAME = (
    *("creepage", "spin_creepage", "rolling_speed"),
    *("normal_force", "approach", "creep_force", "spin_moment"),
)
_OF_FLUID = (
    *("central_film_thickness", "mean_asperity_share", "fluid_temperature", "effective_friction"),
)
PATCH = Message(
    "Patch",
    "One contact patch.",
    (
        # their order is that of the field numbers: what is new goes to the end
        _status(_core.QUANTITIES["patch"]["status"]["text"], required=True),
        _listed("patch", "position", "track"),
        _listed("patch", "contact_angle", "track"),
        *(_listed("patch", name, "contact") for name in _IN_CONTACT_FRAME),
        _listed("patch", "max_pressure"),
        _listed("patch", "contact_area"),
        Field("elements", ELEMENTS, "", _core.QUANTITIES["patch"]["elements"]["text"]),
        _listed("patch", "max_temperature"),
        _listed("patch", "friction_power"),
        _listed("patch", "elastic_energy"),
        _count("iterations", "iterations of the solution"),
        _listed("patch", "residual"),
        _number("wall_time", "s", "wall-clock time of the solution"),
        Field(
            "error_estimate",
            ERROR_ESTIMATE,
            "",
            _core.QUANTITIES["patch"]["error_estimate"]["text"],
        ),
        _listed("patch", "plastic_power"),
        _listed("patch", "outer_iterations"),
        _listed("patch", "ambiguous_elements"),
        _listed("patch", "share"),
        _listed("patch", "creep_power"),
        _listed("patch", "wheel_heat"),
        _listed("patch", "rail_heat"),
        _listed("patch", "pressure_energy"),
        _text("patch", "reason"),
        *(_listed("patch", name) for name in _OF_FLUID),
        _listed("patch", "wear_number"),
        _listed("patch", "traction_coefficient"),
        _listed("patch", "utilised_friction"),
        _listed("patch", "max_traction"),
        _listed("patch", "contact_size", "contact"),
        _listed("patch", "wheel_profile_position", "profile"),
        _listed("patch", "rail_profile_position", "profile"),
        Field("subsurface", SUBSURFACE, "", "stresses below it; only where the scene asks"),
        Field("damage", DAMAGE, "", "of both bodies; only where the scene asks"),
        _listed("patch", "fluid_power"),
    ),
)

_SUMS = (
    *("contact_power", "creep_power", "friction_power", "plastic_power", "elastic_energy"),
    *("max_temperature", "residual"),
    *("wheel_heat", "rail_heat", "wheel_temperature", "rail_temperature"),
    "pressure_energy",
)
WHEEL_CONTACT = Message(
    "WheelContact",
    "Contact of one wheel with its rail or roller.",
    (
        _status(_core.QUANTITIES["side"]["status"]["text"], required=True),
        _listed("side", "force", "track"),
        _listed("side", "moment", "track"),
        _number("z", "m", "vertical position of the wheelset, where it was found", "track"),
        _listed("side", "rolling_radius"),
        _number("wall_time", "s", "wall-clock time of the solution"),
        Field("patches", PATCH, "", "the contact patches; none without contact", size=0),
        _listed("side", "rail_deflection", "track"),
        _listed("side", "rail_deflection_rate", "track"),
        Field(
            "alternatives",
            PATCH,
            "",
            "solutions of other divisions into patches, which count with their share in the force",
            size=0,
        ),
        _number(
            "friction_work", "J", "taken by the creepages since the start: creep_power over time"
        ),
        _number(
            "mean_guiding_force",
            "N",
            f"Y on the rail, outward > 0: mean over the last {SLIDING:g} m, of every time step",
            "track",
        ),
        _number("mean_wheel_load", "N", "Q on the rail, down: mean as that of Y", "track"),
        *(_listed("side", name) for name in _SUMS),
        _text("side", "reason"),
        _text("side", "warnings", size=0),
        _listed("side", "wear_number"),
        _listed("side", "guiding_force", "track"),
        _listed("side", "wheel_load", "track"),
        _listed("side", "derailment_quotient"),
        Field("subsurface", SUBSURFACE, "", "greatest of all patches; only where the scene asks"),
        Field("damage", DAMAGE, "", "of all patches; only where the scene asks"),
        _listed("side", "fluid_power"),
        _listed("side", "oxide_water"),
        _number(
            "water_rate",
            "m^3/s",
            "supply of liquid for each contact where the wheel is; only in runs over wet stretches "
            "or with recovery",
        ),
        _number(
            "rail_work",
            "J/m",
            "friction work by which wheels ahead have cleaned each metre of the rail there; as "
            "water_rate",
        ),
    ),
)

# keys of a result that the contact channels leave out, and why; by message
_IN_FIELDS = "in the fields channel"
LEFT_OUT = {
    "Subsurface": {"points": "of a single solve", "fields": "of a single solve"},
    "Damage": {"fields": "of a single solve"},
    "WheelContact": {"stages": "the case file is attached; `railpatch explain` tells its stages"},
    "Patch": {"stages": "as for the wheel"}
    | dict.fromkeys(
        (
            *("x", "y", "pressure", "traction", "micro_slip", "element_division", "temperature"),
            *("fluid_pressure", "film_thickness", "asperity_share"),
        ),
        _IN_FIELDS,
    )
    | dict.fromkeys(("row_position", "row_angle"), "of a curved reference surface, not logged")
    | dict.fromkeys(
        ("viscous_power", "rolling_resistance_moment"), "of viscoelastic bodies, none of wheels"
    ),
}

PATCH_FIELDS = Message(
    "PatchFields",
    "The fields of one patch; lists run along x first, then along y.",
    (
        _count("patch", "index of the patch in the contact channel, from 0", required=True),
        _count("rows", "elements along y", required=True),
        _count("columns", "elements along x", required=True),
        _number("x", "m", "element centres, rows * columns values", "contact", size=0),
        _number("y", "m", "element centres, rows * columns values", "contact", size=0),
        _number("pressure", "Pa", "normal pressure, rows * columns values", "contact", size=0),
        _number(
            "traction",
            "Pa",
            "traction on the wheel: x of every element, then y; 2 * rows * columns values",
            "contact",
            size=0,
        ),
        _number(
            "micro_slip",
            "-",
            "micro-slip over the rolling speed: x of every element, then y; 2 * rows * columns "
            "values",
            "contact",
            size=0,
        ),
        Field(
            "element_division",
            "uint32",
            "-",
            "state of each element: "
            + ", ".join(f"{code} {name}" for code, name in enumerate(ELEMENT_STATES)),
            size=0,
        ),
        _number(
            "temperature",
            "degC",
            "surface temperature of the wheel, then of the rail; 2 * rows * columns values",
            size=0,
        ),
        _number("fluid_pressure", "Pa", "of the liquid, rows * columns values", "contact", size=0),
        _number("film_thickness", "m", "of the liquid, rows * columns values", "contact", size=0),
        _number("asperity_share", "-", "of the load, rows * columns values", "contact", size=0),
    ),
)

CONTACT_FIELDS = Message(
    "ContactFields",
    "Snapshot of the fields of one wheel's patches, at chosen moments.",
    (Field("patches", PATCH_FIELDS, "", "one entry per patch", size=0),),
)

RIG_BALANCE = Message(
    "RigBalance",
    "Force balance of the roller rig at one position.",
    (
        _status("how the search for balance ended", required=True),
        _count("evaluations", "evaluations of the balance equations"),
        _count("iterations", "iterations of Broyden's method"),
        _number(
            "residuals",
            "N m, N, N m",
            "at the end: moment about the axle, vertical force, roll moment",
            size=3,
        ),
        _number("z", "m", "found: vertical position of the wheelset", "track"),
        _number("roll", "rad", "found: roll angle of the wheelset", "track"),
        _number("pitch_rate", "rad/s", "found: pitch rate of the wheelset", "wheelset"),
    ),
)

RIG_MEASURED = Message(
    "RigMeasured",
    f"What a measured run's record has for one position: {ABOUT_SIGNS}.",
    tuple(
        _number(
            quantity.name,
            next(iter(UNITS[quantity.dimension])),
            quantity.text,
            "" if quantity.dimension in ("number", "temperature") else "track",
        )
        for quantity in QUANTITIES
        if quantity.role != ABSCISSA
    ),
)

RIG_FRAME = Message(
    "RigFrame",
    "The roller rig's frame between lateral actuators and wheelset, at one balanced position.",
    (
        _number("actuator", "m", "lateral position of the actuators", "track"),
        _number("deflection", "m", "of the wheelset from the actuators", "track"),
        _number("force", "N", "lateral, of the frame on the wheelset", "track"),
        _number("residual", "N", "open in the lateral balance", "track"),
        _number("energy", "J", "stored in the frame's springs, between the rollers too"),
        _number("heat", "J", "of the frame's dry friction since the start"),
        _number("actuator_work", "J", "put in by the actuators since the first position"),
        _number("contact_work", "J", "put in by the lateral contact forces since then"),
        _count("sliding", "elements with dry friction that slid on the way to this position"),
        _number("gauge_opening", "m", "by which the rollers are further apart", "track"),
        _number("gauge_force", "N", "that spreads the rollers: the mean of both outward forces"),
        _number("gauge_residual", "N", "open in the balance of the gauge"),
    ),
)

RIG_CONDITIONING = Message(
    "RigConditioning",
    "Friction of one wheel that changes with the work done on its running band, at one position.",
    (
        _number("factor", "-", "of the scene's friction law"),
        _number("conditioning", "-", "mean over the contact: 0 as found, 1 at the plateau"),
        _number("power", "W", "of friction, that of a layer which yields included"),
        _number("work", "J", "of friction since the first position"),
        _number(
            "position",
            "m",
            "at chosen moments: middles of the strips, from the wheelset's middle along its axle, "
            "or of rollers from the track's middle",
            size=0,
        ),
        _number("conditioned", "-", "of each of them, from 0 to 1", size=0),
    ),
)

ENERGY = Message(
    "Energy",
    "Energies of a wheelset or a vehicle on track, and work done since the start.",
    (
        _number("kinetic", "J", "kinetic energy of all bodies", "track"),
        _number("gravity", "J", "potential energy of gravity"),
        _number("suspension", "J", "potential energy of springs and static load"),
        _number("elastic", "J", "elastic energy of the pressure in the contacts"),
        _number("contact_work", "J", "work of the contact forces on the wheelsets"),
        _number("friction_work", "J", "lost in the contacts: creep_power of all wheels over time"),
        _number("damping_work", "J", "taken by the dampers"),
        _number("drive_work", "J", "put in by what holds the speed"),
        _number("mechanical_residual", "J", "open in the balance of bodies and springs"),
        _number("contact_residual", "J", "open in the balance of the contacts"),
    ),
)

MOMENTUM = Message(
    "Momentum",
    "Momentum of all bodies, and what the forces on them have put in since the start.",
    (
        _number("momentum", "N s", "momentum", "track", size=3),
        _number("turning", "N m s", "moment of momentum about the centre of mass", "track", size=3),
        _number("impulse", "N s", "impulse of all forces since the start", "track", size=3),
        _number("turning_impulse", "N m s", "of their moments about it", "track", size=3),
        _number("residual", "N s", "open in the balance of momentum", "track", size=3),
        _number("turning_residual", "N m s", "open in that of its moment", "track", size=3),
    ),
)

VEHICLE_STATE = Message(
    "VehicleState",
    "How far the vehicle has come, and the track under its middle.",
    (
        _number("progress", "-", "part of the run that is done, 0 to 1"),
        _number("x", "m", "distance along the track", "track", required=True),
        _number("speed", "m/s", "forward speed", "track"),
        _number("curvature", "1/m", "curvature of the track, right-hand curve > 0", "track"),
        _number("cant", "rad", "cant of the track", "track"),
    ),
)

BODY = Message(
    "Body",
    "Where one body is and how it moves.",
    (
        Field("name", "string", "", "of the body", required=True),
        _number("position", "m", "of its centre of mass", "start", size=3, required=True),
        _number("orientation", "-", "quaternion x, y, z, w", "start", size=4, required=True),
        _number("velocity", "m/s", "of its centre of mass", "start", size=3),
        _number("acceleration", "m/s^2", "of its centre, less gravity's", "body", size=3),
        _number("lateral", "m", "distance from the track's centre line, right > 0", "track"),
        _number("roll", "rad", "roll angle against the track", "track"),
        _number("yaw", "rad", "yaw angle against the track", "track"),
    ),
)

VEHICLE_BODIES = Message(
    "VehicleBodies",
    "All bodies of the vehicle.",
    (Field("bodies", BODY, "", "one entry per body, always in the same order", size=0),),
)

WEAR = Message(
    "Wear",
    "What a run has worn off one wheel and what it rolled on, over their profiles.",
    (
        _number("way", "m", "rolled"),
        _number("mass", "kg", "that each body lost, by the contacts"),
        _number("wheel_mass", "kg", "the same, summed over the wheel's profile"),
        _number("rail_mass", "kg", "the same, summed over the rail's or roller's profile"),
        _number("y", "m", "middles of bins, of both profiles", "profile", size=0),
        _number("wheel", "kg/m", "mass by width of the wheel's profile", size=0),
        _number("rail", "kg/m", "mass by width of the rail's or roller's profile", size=0),
        _number("wheel_depth", "m", "that is worn off, across y, round the wheel", size=0),
        _number("rail_depth", "m", "that is worn off along the way, or round the roller", size=0),
    ),
)

COMFORT_POINT = Message(
    "ComfortPoint",
    "Comfort at one point of a body, in its axes.",
    (
        Field("name", "string", "", "of the point in the scene", required=True),
        _number("longitudinal", "m/s^2", "weighted by Wd, of 5 s or their 95 %", "body"),
        _number("lateral", "m/s^2", "weighted by Wd, likewise", "body"),
        _number("vertical", "m/s^2", "weighted by Wb, likewise", "body"),
        _number("mean_comfort", "-", "N_MV = 6 times the length of the 95 % percentiles"),
    ),
)

COMFORT = Message(
    "Comfort",
    "Continuous comfort (EN 12299): root mean squares over the 5 s before.",
    (Field("points", COMFORT_POINT, "", "one entry per point of the scene", size=0),),
)

ASSESSMENT = Message(
    "Assessment",
    "Loads at rest and extremes of a whole run, its percentiles as EN 14363 counts them, left and "
    "right wheel of the first wheelset first, and mean comfort as EN 12299 does. Y and Q are means "
    "over 2 m, extremes those of every time step. guiding_force is of a wheel, shift of a "
    "wheelset.",
    (
        _count("places", "number of the places, every 0.5 m, that percentiles are of"),
        _number("static_load", "N", "of each wheelset on level rails at rest", size=0),
        _number("derailment", "-", "99.85 % of each wheel's Y/Q, Y outward", size=0),
        _number("guiding_force", "N", "0.15 or 99.85 % of each wheel's Y, by size", size=0),
        _number("outward_guiding_force", "N", "99.85 % of each wheel's Y, outward > 0", size=0),
        _number("shift", "N", "0.15 or 99.85 % of each wheelset's sum of Y, by size", size=0),
        _number("load", "N", "99.85 % of each wheel's Q", size=0),
        _number("median_load", "N", "50 % of each wheel's Q", size=0),
        _number("acceleration", "m/s^2", "lateral, vertical, of the body of reference", size=2),
        _number("derailment_limit", "-", "of Y/Q"),
        _number("shift_limit", "N", "of a wheelset's sum of Y"),
        _number("most_derailment", "-", "greatest Y/Q of each wheel, Y outward", size=0),
        _number("most_guiding_force", "N", "greatest Y of each wheel, either way", size=0),
        _number("most_outward_guiding_force", "N", "greatest Y of each wheel, outward > 0", size=0),
        _number("most_shift", "N", "greatest sum of Y of each wheelset, either way", size=0),
        _number("least_load", "N", "least Q of each wheel", size=0),
        _number("most_load", "N", "greatest Q of each wheel", size=0),
        _number(
            "acceleration_rms",
            "m/s^2",
            "lateral, vertical, standard deviations of the body of reference's",
            size=2,
        ),
        _count("comfort_blocks", "number of whole blocks of 5 s"),
        Field("comfort", COMFORT_POINT, "", "95 % of them, one entry per point", size=0),
    ),
)

TRACK_SUPPORT = Message(
    "TrackSupport",
    "Track below the rails under one wheelset; pairs are lateral, vertical.",
    (
        _number("left_pad_force", "N", "of the left rail on its pad", "track", size=2),
        _number("right_pad_force", "N", "of the right rail on its pad", "track", size=2),
        _number("left_ballast_force", "N", "of the left rail seat on its ballast", "track", size=2),
        _number("right_ballast_force", "N", "of the right rail seat", "track", size=2),
        _number("sleeper", "m, m, rad", "its y, z and roll from rest", "track", size=3),
    ),
)

SOLVER_STATS = Message(
    "SolverStats",
    "Work and wall-clock time of one position or time step.",
    (
        _number("wall_time", "s", "wall-clock time in all", required=True),
        _number("left_wall_time", "s", "part of it in the left wheel's contact"),
        _number("right_wall_time", "s", "part of it in the right wheel's contact"),
        _count("contact_evaluations", "contact problems solved"),
        _count("left_normal_iterations", "iterations of the left normal problem"),
        _count("left_tangential_iterations", "iterations of the left tangential problem"),
        _count("right_normal_iterations", "iterations of the right normal problem"),
        _count("right_tangential_iterations", "iterations of the right tangential problem"),
    ),
)

CHANNELS = (
    Channel("/wheelset/state", WHEELSET_STATE, "where the wheelset is and how it moves"),
    Channel("/left/contact", WHEEL_CONTACT, "result of the left wheel"),
    Channel("/right/contact", WHEEL_CONTACT, "result of the right wheel"),
    Channel("/rig/balance", RIG_BALANCE, "force balance; only in runs of the roller rig"),
    Channel("/rig/measured", RIG_MEASURED, "measured beside it; only in replays of a record"),
    Channel("/rig/frame", RIG_FRAME, "frame that yields; only in rigs that have one"),
    Channel("/left/conditioning", RIG_CONDITIONING, "left friction; only in rigs where it changes"),
    Channel("/right/conditioning", RIG_CONDITIONING, "right friction; only in such rigs"),
    Channel("/wheelset/energy", ENERGY, "balance of energies; only in runs on track"),
    Channel("/wheelset/momentum", MOMENTUM, "balance of momenta; only in runs on track"),
    Channel("/left/wear", WEAR, "of the left wheel; once, at the end, where there is [damage]"),
    Channel("/right/wear", WEAR, "of the right wheel"),
    Channel("/solver/stats", SOLVER_STATS, "iterations and times"),
    Channel("/left/fields", CONTACT_FIELDS, "fields of the left patches, at chosen moments"),
    Channel("/right/fields", CONTACT_FIELDS, "fields of the right patches, at chosen moments"),
)

# of a vehicle in place of these
VEHICLE_CHANNELS = (
    Channel("/vehicle/state", VEHICLE_STATE, "how far the vehicle has come"),
    Channel("/vehicle/bodies", VEHICLE_BODIES, "car body, bogie frames, wheelsets"),
    Channel("/vehicle/energy", ENERGY, "balance of energies"),
    Channel("/vehicle/comfort", COMFORT, "every 5 s; only in scenes that ask for comfort"),
    Channel("/vehicle/assessment", ASSESSMENT, "loads at rest, at the start; all of it at the end"),
    Channel("/solver/stats", SOLVER_STATS, "iterations and times"),
)
# and of each of its wheelsets, N = 1 in front
AXLE_CHANNELS = (
    Channel("/wheelset/N/state", WHEELSET_STATE, "where wheelset N is and how it moves"),
    Channel("/wheelset/N/left/contact", WHEEL_CONTACT, "result of its left wheel"),
    Channel("/wheelset/N/right/contact", WHEEL_CONTACT, "result of its right wheel"),
    Channel("/wheelset/N/support", TRACK_SUPPORT, "track below; only in scenes that have one"),
    Channel("/wheelset/N/left/wear", WEAR, "of its left wheel; once, at the end"),
    Channel("/wheelset/N/right/wear", WEAR, "of its right wheel"),
    Channel("/wheelset/N/left/fields", CONTACT_FIELDS, "fields of its left patches"),
    Channel("/wheelset/N/right/fields", CONTACT_FIELDS, "fields of its right patches"),
)

# each topic once
ALL_CHANNELS = tuple({c.topic: c for c in CHANNELS + VEHICLE_CHANNELS + AXLE_CHANNELS}.values())

# topic: (Foxglove message, what it is for)
WELL_KNOWN = {
    "/tf": (
        "foxglove.FrameTransforms",
        "frames world (z up), track, wheelset, wheels, rollers; of a vehicle start, its bodies, "
        "track_N and wheels_N",
    ),
    "/scene/bodies": ("foxglove.SceneUpdate", "bodies, rollers or rails; once, at the start"),
    "/scene/contact": ("foxglove.SceneUpdate", "contact patches and arrows of their forces"),
}


def vehicle_channels(wheelsets: int) -> tuple[Channel, ...]:
    """All channels of a vehicle."""
    return VEHICLE_CHANNELS + tuple(
        Channel(numbered(entry.topic, number), entry.message, numbered(entry.text, number))
        for number in range(1, wheelsets + 1)
        for entry in AXLE_CHANNELS
    )


def numbered(text: str, number: int) -> str:
    """Of the table's N, the wheelset's number."""
    return re.sub(r"\bN\b", str(number), text)


@cache
def channel(topic: str) -> Channel:
    """The channel of ``topic``; KeyError where the table has none."""
    general = re.sub(r"^/wheelset/[1-9][0-9]*/", "/wheelset/N/", topic)
    for entry in ALL_CHANNELS:
        if entry.topic == general:
            return entry
    raise KeyError(f"no channel {topic!r} in the run log")


def flat_fields(message: Message, prefix: str = "") -> Iterator[tuple[str, Field]]:
    """Every field with its dotted path, those of nested messages too ("patches[].position")."""
    for field in message.fields:
        path = prefix + field.name
        yield path, field
        if isinstance(field.kind, Message):
            yield from flat_fields(field.kind, f"{path}{'[]' if field.size == 0 else ''}.")


def note(field: Field) -> str:
    """Unit, shape, frame and meaning of a field in one line."""
    shape = {0: "list", 1: ""}.get(field.size, f"[{field.size}]")
    frame = f"{field.frame} axes" if field.frame else ""
    choices = "one of " + ", ".join(field.choices) if field.choices else ""
    parts = (field.unit, shape, frame, choices)
    lead = "; ".join(part for part in parts if part)
    return f"{lead}: {field.text}" if lead else field.text


def unit(topic: str, path: str) -> str:
    """Unit of the field at the dotted ``path`` of a channel ("patches[].approach")."""
    for name, field in flat_fields(channel(topic).message):
        if name == path:
            return field.unit
    raise KeyError(f"{topic} has no field {path!r}")


def markdown() -> str:
    """The table as Markdown, for the documentation."""
    lines = ["# Channels of the run log", ""]
    lines += [f"- {name.replace('_', ' ')}: {text}" for name, text in CONVENTIONS.items()]
    lines += ["", "| channel | message | content |", "|---|---|---|"]
    lines += [f"| {c.topic} | railpatch.{c.message.name} | {c.text} |" for c in ALL_CHANNELS]
    lines += [f"| {topic} | {name} | {text} |" for topic, (name, text) in WELL_KNOWN.items()]
    for message in dict.fromkeys(c.message for c in ALL_CHANNELS):
        lines += ["", f"## railpatch.{message.name}", "", message.text, ""]
        lines += ["| field | unit | frame | shape | meaning |", "|---|---|---|---|---|"]
        for path, field in flat_fields(message):
            shape = {0: "list", 1: "one"}.get(field.size, str(field.size))
            lines.append(f"| {path} | {field.unit} | {field.frame} | {shape} | {field.text} |")
    return "\n".join(lines) + "\n"
