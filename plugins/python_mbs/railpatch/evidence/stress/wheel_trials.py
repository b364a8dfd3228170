"""Trials of wheels and wheelsets at odd positions."""

from __future__ import annotations

from collections.abc import Iterator
from math import cos, pi, sin
from typing import Any

from railpatch.case.theories import FAST
from railpatch.evidence.bench.problems import merged
from railpatch.evidence.stress.trial import (
    IN_THEORY,
    NO_CONTACT,
    SAYS_SO,
    SOLVED,
    Move,
    Trial,
    moves,
)

RADIUS = 0.46
WHEELSET: dict[str, Any] = {
    "kind": "wheelset",
    "friction": {"coefficient": 0.3},
    "grid": {"element_size": [1e-3, 1e-3]},
    "wheelset": {
        "vertical_force": 1e5,
        "speed": 20.0,
        "pitch_rate": -20.0 / RADIUS,
        "nominal_radius": RADIUS,
        "flange_back_distance": 1.36,
        "flange_back_position": -0.07,
    },
    "track": {"kind": "rail"},
    "profiles": {"wheel": "S1002", "rail": "UIC60@1:40"},
}
WHEEL = merged(WHEELSET, {"kind": "wheel_rail", "wheel": {"side": "right"}})
ROLLER = merged(
    WHEELSET,
    {"track": {"kind": "roller", "roller_radius": 0.8, "roller_pitch_rate": 25.0},
     "wheelset": {"speed": 0.0}},
)  # fmt: skip
HASTY = 1e-5  # s, steps shorter than that
LONGEST = 0.1  # m, of a patch that the grid holds
SOFT = 1e6  # N/m, springs on which the rail moves by more than a wheel can follow
SOFT_NOTE = "the rail gives way by centimetres: solved, or it says that it is not"
ODD = "a position that no wheelset takes: solved, or it says that it is not"


def wheel_trials(quick: bool) -> Iterator[Trial]:
    """All of them; quick: fewer of each."""
    shown = (0.0, 6e-3) if quick else (0.0, 1e-3, 3e-3, 5e-3, 6e-3, 7e-3, 8e-3, -6.5e-3)
    for y in shown:
        for yaw in (0.0, 0.02):
            yield wheelset(f"y = {1e3 * y:g} mm, yaw {1e3 * yaw:g} mrad", y=y, yaw=yaw)
    for force in (1.0, 1e3, 1e6):
        yield wheelset(f"{force:g} N", vertical_force=force)
    for key, value, text in (
        ("yaw", 0.3, "yaw 300 mrad"), ("yaw", 1.5, "yaw 1.5 rad"), ("roll", 0.05, "roll 50 mrad"),
        ("roll", 1.0, "roll 1 rad"), ("y", 0.05, "beside the track by 50 mm"),
        ("y", -1.0, "beside the track by 1 m"), ("vertical_force", 1e9, "1 GN"),
    ):  # fmt: skip
        yield wheelset(text, SAYS_SO + NO_CONTACT, ODD, **{key: value})
    for text, values in {
        "standstill": {"speed": 0.0, "pitch_rate": 0.0},
        "blocked": {"pitch_rate": 0.0},
        "spinning on the spot": {"speed": 0.0},
        "backward": {"speed": -20.0, "pitch_rate": 20.0 / RADIUS},
        "speed against pitch": {"pitch_rate": 20.0 / RADIUS},
        "150 m/s": {"speed": 150.0, "pitch_rate": -150.0 / RADIUS},
        "1e-6 m/s": {"speed": 1e-6, "pitch_rate": -1e-6 / RADIUS},
        "sideways": {"vy": 1.0},
        "falling": {"vz": 1.0},
        "turning": {"yaw_rate": 10.0, "roll_rate": 10.0},
    }.items():
        yield wheelset(text, **values)
    lifted = {"wheelset": {"vertical_force": None, "z": -0.01}}
    yield Trial(
        "wheel", "lifted and put back", merged(WHEELSET, lifted),
        (Move({}, NO_CONTACT), Move({"z": 2e-4}), Move({"z": -0.5}, NO_CONTACT), Move({"z": 2e-4}),
         Move({"z": 3e-4, "roll": 3e-4})),
    )  # fmt: skip
    yield Trial(
        "wheel", "pressed in by 20 mm", merged(WHEELSET, {"wheelset": {"vertical_force": None,
                                                                         "z": 0.02}}),
        moves({}, expects=SAYS_SO), ODD,
    )  # fmt: skip
    yield Trial("wheel", "roller", ROLLER, moves({}, {"yaw": 0.01}, {"yaw": -0.01}))
    yield Trial(
        "wheel", "from flange to flange", WHEELSET,
        moves(*({"y": 1e-3 * y, "roll": -5e-2 * 1e-3 * y} for y in range(-7, 8))),
    )  # fmt: skip
    yield from uneven_trials(quick)
    yield from moving_rail_trials(quick)
    yield from transient_trials(quick)
    yield from worn_trials(quick)
    for theory in FAST:
        method = {"method": {"tangential": theory, "normal": "kik_piotrowski"}}
        yield Trial(
            "wheel", "flange contact", merged(WHEEL, {**method, "wheelset": {"y": 6e-3}}),
            moves({}, expects=SAYS_SO),
        )  # fmt: skip


def worn_trials(quick: bool) -> Iterator[Trial]:
    """Worn wheels on worn rails by every normal theory, from the tread onto the flange."""
    for pair in range(2 if quick else 12):
        for normal in (
            "half_space", "hertz", "kik_piotrowski", "kik_piotrowski_corrected", "analyn",
        ):  # fmt: skip
            worn = {
                "profiles": {"wheel": f"worn@{2 * pair}", "rail": f"worn@{2 * pair + 1}"},
                "method": {"normal": normal},
                "grid": {"element_size": None, "elements": [10, 10]},
                "wheelset": {"vertical_force": 8e4},
            }
            yield Trial(
                "worn", f"worn pair {pair}, {normal}", merged(WHEEL, worn),
                moves(*({"y": 1e-3 * y} for y in range(-4, 13, 2)), expects=IN_THEORY),
                "beyond where the flange climbs no height carries the load",
            )  # fmt: skip


def uneven_trials(quick: bool) -> Iterator[Trial]:
    """Wheels with flats or out of round, rails with joints, rolled over step by step."""
    for depth in (1e-3,) if quick else (1e-5, 2.5e-4, 1e-3, 4e-3):
        # m, half the flat's length, and beyond its ends
        half = (2 * RADIUS * depth) ** 0.5
        turns = [share * half / RADIUS for share in (-1.5, -1.0, -0.9, -0.3, 0.0, 0.3, 1.0, 1.5)]
        flat = {"wheelset": {"right": {"flat": {"depth": depth}}}}
        long = 2 * half > LONGEST
        yield Trial(
            "uneven", f"flat of {1e3 * depth:g} mm", merged(WHEEL, flat),
            moves(*({"pitch": turn} for turn in turns), expects=IN_THEORY if long else SOLVED),
            "stands on both its ends, one patch longer than the grid" if long else "",
        )  # fmt: skip
    for waves, height in ((3, 1e-3), (20, 5e-5), (60, 1e-5)):
        angles = [2 * pi * i / 720 for i in range(720)]
        runout = [height * cos(waves * angle) for angle in angles]
        yield Trial(
            "uneven", f"{waves} waves of {1e6 * height:g} um around the wheel",
            merged(WHEEL, {"wheelset": {"right": {"runout": runout}}}),
            moves(*({"pitch": 0.02 * i} for i in range(8))),
        )  # fmt: skip
    joints = {
        "dip of 1 mm": {"depth": 1e-3},
        "dip of 10 mm": {"depth": 0.01},
        "step up of 2 mm": {"step": 2e-3},
        "step down of 2 mm": {"step": -2e-3},
        "gap of 6 mm": {"gap": 6e-3},
        "gap of 30 mm with a step": {"gap": 0.03, "step": 1e-3},
    }
    places = (-0.3, -0.05, -0.02, -4e-3, 0.0, 4e-3, 0.02, 0.05, 0.3)
    for name, joint in list(joints.items())[: 2 if quick else None]:
        case = merged(WHEEL, {"track": {"right": {"joint": {"position": 0.0, **joint}}}})
        yield Trial("uneven", name, case, moves(*({"x": x} for x in places)))


def moving_rail_trials(quick: bool) -> Iterator[Trial]:
    """Rails on springs and dampers, out of gauge, and frames of contact that turn."""
    for stiffness in (1e5, 1e8, 1e12) if quick else (1.0, 1e3, 1e5, 1e7, 1e8, 1e10, 1e12, 1e15):
        case = merged(WHEELSET, {"track": {"rail_support": {"stiffness": [stiffness, stiffness]}}})
        expects = SAYS_SO if stiffness < SOFT else SOLVED
        note = SOFT_NOTE if stiffness < SOFT else ""
        changes = ({}, {"yaw": 5e-3}, {"yaw": -5e-3, "y": 2e-3})
        yield Trial(
            "moving rail", f"springs of {stiffness:g} N/m", case, moves(*changes, expects=expects),
            note,
        )  # fmt: skip
    for damping in (1e3, 1e6, 1e12):
        support = {"stiffness": [2e7, 5e7], "damping": [damping, damping]}
        for step in (1e-6, 1e-3, 1.0):
            case = merged(
                WHEELSET,
                {"track": {"rail_support": support}, "wheelset": {"time_step": step}},
            )
            hasty = step < HASTY
            yield Trial(
                "moving rail", f"dampers of {damping:g} N s/m, steps of {step:g} s", case,
                (Move(), *moves({"y": 1e-3}, {"y": -1e-3}, expects=SAYS_SO if hasty else SOLVED)),
                "a millimetre sideways in a microsecond: solved, or it says that it is not"
                if hasty else "",
            )  # fmt: skip
    for widening in (-4e-3, 0.01, 0.03):
        case = merged(WHEELSET, {"track": {"gauge_widening": widening}})
        yield Trial("moving rail", f"gauge wider by {1e3 * widening:g} mm", case, moves({}))
    inclined = merged(ROLLER, {"method": {"contact_frame": "inclined"}})
    for yaw in (0.0, 0.01, 0.05):
        yield Trial(
            "moving rail", f"roller, inclined frame, yaw {1e3 * yaw:g} mrad", inclined,
            moves({"yaw": yaw}, {"yaw": -yaw}),
        )  # fmt: skip


def transient_trials(quick: bool) -> Iterator[Trial]:
    """Wheels that roll on from their last tractions, in steps of any length."""
    transient = merged(WHEELSET, {"motion": {"regime": "transient_rolling"}})
    for step in (1e-4,) if quick else (1e-7, 1e-5, 1e-4, 1e-2, 1.0):
        case = merged(transient, {"wheelset": {"time_step": step}})
        sway = [{"y": 2e-3 * sin(0.8 * i), "yaw": 4e-3 * cos(0.8 * i)} for i in range(8)]
        yield Trial("transient wheels", f"swaying, steps of {step:g} s", case, moves(*sway))
    case = merged(transient, {"wheelset": {"time_step": 1e-4}})
    yield Trial(
        "transient wheels", "from flange to flange", case,
        moves(*({"y": 1e-3 * y, "roll": -5e-5 * y} for y in range(-7, 8))),
    )  # fmt: skip
    yield Trial(
        "transient wheels", "stops and goes back", case,
        moves(
            {}, {"speed": 1e-3, "pitch_rate": -1e-3 / RADIUS}, {"speed": 0.0, "pitch_rate": 0.0},
            {"y": 1e-5}, {"speed": -5.0, "pitch_rate": 5.0 / RADIUS}, {},
        ),
    )  # fmt: skip
    high = merged(case, {"wheelset": {"vertical_force": None, "z": 2e-4}})
    yield Trial(
        "transient wheels", "lifted and put back", high,
        (Move(), Move({"z": -1e-3}, NO_CONTACT), Move({"z": 2e-4}), Move({"z": 3e-4})),
    )  # fmt: skip


def wheelset(
    name: str, expects: tuple[str, ...] = ("converged",), note: str = "", **values: Any
) -> Trial:
    """A wheelset with some keys changed."""
    return Trial(
        "wheel", name, merged(WHEELSET, {"wheelset": values}), moves({}, expects=expects), note
    )
