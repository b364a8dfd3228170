"""The kinds of scene files that this package runs."""

from __future__ import annotations

from railpatch.case import WheelsetCase
from railpatch.case.kinds import SceneKind, with_tables

from wheelset_demo.scene import DEFAULT, MODELS, scene_file
from wheelset_demo.vehicle.scene import DEFAULT as DEFAULT_VEHICLE
from wheelset_demo.vehicle.scene import OPTIONAL, TABLES, ElementTable


def wheelset_run() -> SceneKind:
    """A wheelset on track, in time."""
    model = with_tables(WheelsetCase, MODELS)
    command = "railpatch wheelset SCENE -o run.mcap"
    return SceneKind("wheelset_run", model, scene_file(DEFAULT), command)


def vehicle() -> SceneKind:
    """A vehicle on track, in time."""
    model = with_tables(WheelsetCase, {**TABLES, "suspension": list[ElementTable]}, *OPTIONAL)
    command = "railpatch vehicle SCENE -o run.mcap"
    return SceneKind("vehicle", model, scene_file(DEFAULT_VEHICLE), command)
