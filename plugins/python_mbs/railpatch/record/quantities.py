"""What a record of a measured run may hold: one list for columns, log, checks and report."""

from __future__ import annotations

from dataclasses import dataclass

SIDES = ("left", "right")
# what is known, what drives a replay, what is kept beside it
ABSCISSA, INPUT, OUTPUT = "abscissa", "input", "output"


@dataclass(frozen=True)
class Quantity:
    """One quantity, in SI units.

    dimension: of ``units.UNITS``. role: ABSCISSA, INPUT or OUTPUT. low, high: beyond them the
    record is refused. least: a largest size below it is hardly meant; 0: any may be. column: of the
    log's table with what a run computes for it, times ``sign``; "": none.
    """

    name: str
    dimension: str
    text: str
    role: str
    low: float
    high: float
    least: float = 0.0
    column: str = ""
    sign: float = 1.0


def _of_wheel(side: str) -> tuple[Quantity, ...]:
    force, temperature = f"/{side}/contact.force", f"/{side}/contact"
    body = f"the {side} roller or rail"
    return (
        Quantity(
            f"{side}_lateral",
            "force",
            f"lateral force on {body}, to the right > 0",
            *(OUTPUT, -2e6, 2e6, 10.0, f"{force}.y", -1.0),
        ),
        Quantity(
            f"{side}_vertical",
            "force",
            f"vertical force on {body}, down > 0",
            *(OUTPUT, -2e5, 2e6, 1e3, f"{force}.z", -1.0),
        ),
        Quantity(
            f"{side}_longitudinal",
            "force",
            f"longitudinal force on {body}, forward > 0",
            *(OUTPUT, -2e6, 2e6, 1.0, f"{force}.x", -1.0),
        ),
        Quantity(
            f"{side}_ratio",
            "number",
            f"lateral over vertical force, L/V, of {body}",
            *(OUTPUT, -5.0, 5.0, 0.02),
        ),
        Quantity(
            f"{side}_wheel_temperature",
            "temperature",
            f"bulk temperature of the {side} wheel",
            *(OUTPUT, -80.0, 1200.0, 0.0, f"{temperature}.wheel_temperature"),
        ),
        Quantity(
            f"{side}_roller_temperature",
            "temperature",
            f"bulk temperature of {body}",
            *(OUTPUT, -80.0, 1200.0, 0.0, f"{temperature}.rail_temperature"),
        ),
    )


QUANTITIES: tuple[Quantity, ...] = (
    # seconds since 1970 too; the log's times end after 9.2e9 s
    Quantity("time", "time", "time", ABSCISSA, -4e9, 4e9),
    Quantity("progress", "number", "part of the run that is done, 0 to 1", ABSCISSA, 0.0, 1.0),
    Quantity("distance", "length", "distance along the track, of runs on it", ABSCISSA, -1e9, 1e9),
    Quantity(
        "yaw",
        "angle",
        "yaw angle, which is the angle of attack",
        *(INPUT, -0.1, 0.1, 2e-4, "/wheelset/state.yaw"),
    ),
    Quantity(
        "lateral_position",
        "length",
        "lateral position of the wheelset's centre, right > 0",
        *(INPUT, -0.1, 0.1, 2e-5, "/wheelset/state.y"),
    ),
    Quantity(
        "actuator_left",
        "length",
        "longitudinal position of the axle's left end, forward > 0; with actuator_right for yaw",
        *(INPUT, -1.0, 1.0, 2e-5),
    ),
    Quantity(
        "actuator_right",
        "length",
        "longitudinal position of the axle's right end, forward > 0",
        *(INPUT, -1.0, 1.0, 2e-5),
    ),
    Quantity(
        "vertical_load",
        "force",
        "vertical load on both wheels together, down > 0",
        *(INPUT, 500.0, 2e6, 500.0, "/wheelset/state.vertical_force"),
    ),
    Quantity(
        "speed",
        "speed",
        "speed of the rollers' surface at their nominal radius, forward > 0",
        *(INPUT, 1e-3, 150.0, 1e-3),
    ),
    Quantity(
        "roller_pitch_rate",
        "turning",
        "speed of rotation of the rollers; in place of speed",
        *(INPUT, 1e-3, 1e3, 1e-3, "/wheelset/state.roller_pitch_rate"),
    ),
    *(quantity for side in SIDES for quantity in _of_wheel(side)),
    Quantity("roll", "angle", "roll angle", *(OUTPUT, -0.2, 0.2, 1e-6, "/wheelset/state.roll")),
    Quantity(
        "vertical_position",
        "length",
        "vertical position of the wheelset's centre, down > 0",
        *(OUTPUT, -0.2, 0.2, 1e-6, "/wheelset/state.z"),
    ),
    Quantity(
        "pitch_rate",
        "turning",
        "speed of rotation of the wheelset; rolling forward < 0",
        *(OUTPUT, -1e3, 1e3, 1e-3, "/wheelset/state.pitch_rate"),
    ),
)
BY_NAME = {quantity.name: quantity for quantity in QUANTITIES}
# of a wheel's measured forces, the same sign for all: what the log's conventions are for the wheel
ABOUT_SIGNS = (
    "track axes, x forward, y right, z down; forces of a record act on the roller or rail, so "
    "vertical ones are > 0"
)


def ratio_side(name: str) -> str:
    """The side of a measured L/V; empty of other quantities."""
    return name.removesuffix("_ratio") if name.endswith("_ratio") else ""
