"""The kinds of scene files that this package runs."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from railpatch.case import WheelsetCase
from railpatch.case.kinds import Ending, SceneKind, with_tables
from railpatch.errors import CaseError

from wheelset_demo.scene import DEFAULT, MODELS, scene_file
from wheelset_demo.vehicle.scene import DEFAULT as DEFAULT_VEHICLE
from wheelset_demo.vehicle.scene import LISTS, OPTIONAL, TABLES

# beside the coach
OTHER_VEHICLES = ("freight_wagon.toml", "locomotive.toml")
# of summaries: what is measured by the clock
TIMES = {"solve_seconds", "wall_time", "logging_share", "seconds", "real_time"}
# of a wheelset's summary and of a vehicle's: what its numbers are in, by name or by the table's
WHEELSET_UNITS = {
    **dict.fromkeys(("steps", "in_the_air", "evaluations"), ""),
    **dict.fromkeys(("mechanical_error", "contact_error", "momentum_error", "turning_error"), ""),
    **dict.fromkeys(("distance", "waves"), "m"),
    **dict.fromkeys(("waves.count", "waves.conicity"), ""),
    "duration": "s",
    "energies": "J",
    # of both bodies, in several units
    **dict.fromkeys(("wear", "wear_text"), ""),
}
VEHICLE_UNITS = {
    **dict.fromkeys(("steps", "derailment", "derailment_percentile", "unloading"), ""),
    **dict.fromkeys(("distance", "offset"), "m"),
    "duration": "s",
    **dict.fromkeys(("load_range", "load_percentile", "load_median"), "N"),
    **dict.fromkeys(("static_loads", "shift", "shift_percentile", "shift_limit"), "N"),
    **dict.fromkeys(("comfort", "acceleration_percentile"), "m/s^2"),
    **dict.fromkeys(("friction", "open_balance", "lost"), "J"),
    "step_times": "",
    "support.rail_deflection": "m",
    **dict.fromkeys(("support.pad_force", "support.ballast_force"), "N"),
    "measured_track": "m",
    "measured_track.rows": "",
    # by names that a scene gives, in several units
    **dict.fromkeys(("ride_comfort", "wear", "wear_text"), ""),
}


def wheelset_run() -> SceneKind:
    """A wheelset on track, in time."""
    model = with_tables(WheelsetCase, MODELS)
    command = "railpatch wheelset SCENE -o run.mcap"
    return SceneKind(
        *("wheelset_run", model, scene_file(DEFAULT), command, run_wheelset), units=WHEELSET_UNITS
    )


def run_wheelset(scene: Path, log: Path) -> Ending:
    """The whole run."""
    check_pinocchio()
    from wheelset_demo.scene import load_wheelset_scene
    from wheelset_demo.simulation import run_scene

    return ending_of(run_scene(load_wheelset_scene(scene), log))


def check_pinocchio() -> None:
    """Raises CaseError that says what to install."""
    try:
        import railpatch.pinocchio  # noqa: F401
    except ImportError as error:
        raise CaseError(str(error)) from None


def ending_of(summary: Any) -> Ending:
    """Of a run's summary, without the times it took."""
    left_out = TIMES | {"good", "message", "warnings"}
    values = {k: v for k, v in summary.to_dict().items() if k not in left_out}
    if summary.good:
        return Ending("converged", None, list(summary.warnings), values)
    return Ending("not_converged", summary.message, list(summary.warnings), values)


def vehicle() -> SceneKind:
    """A vehicle on track, in time."""
    lists = {name: list[table] for name, table in LISTS.items()}  # type: ignore[valid-type]
    model = with_tables(WheelsetCase, {**TABLES, **lists}, *OPTIONAL, *LISTS)
    command = "railpatch vehicle SCENE -o run.mcap"
    scene = scene_file(DEFAULT_VEHICLE)
    return SceneKind(
        "vehicle",
        model,
        scene,
        command,
        run_vehicle,
        units=VEHICLE_UNITS,
        others=tuple(scene_file(name) for name in OTHER_VEHICLES),
    )


def run_vehicle(scene: Path, log: Path) -> Ending:
    """The whole run."""
    check_pinocchio()
    from wheelset_demo.system import ContactFailure
    from wheelset_demo.vehicle.compare import run_summary
    from wheelset_demo.vehicle.scene import load_vehicle_scene

    try:
        return ending_of(run_summary(load_vehicle_scene(scene), None, log))
    except ContactFailure as failure:
        # before the first step; one in a run is in its summary
        return Ending("not_converged", str(failure), [], {})
