"""Trials of wheels and wheelsets at odd positions."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from railpatch.bench.problems import merged
from railpatch.stress.trial import NO_CONTACT, SAYS_SO, Move, Trial, moves

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
    for theory in ("fastsim", "fastrip", "polach", "linear", "table"):
        method = {"method": {"tangential": theory, "normal": "kik_piotrowski"}}
        yield Trial(
            "wheel", "flange contact", merged(WHEEL, {**method, "wheelset": {"y": 6e-3}}),
            moves({}, expects=SAYS_SO),
        )  # fmt: skip


def wheelset(
    name: str, expects: tuple[str, ...] = ("converged",), note: str = "", **values: Any
) -> Trial:
    """A wheelset with some keys changed."""
    return Trial(
        "wheel", name, merged(WHEELSET, {"wheelset": values}), moves({}, expects=expects), note
    )
