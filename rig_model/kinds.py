"""The kinds of scene files that this package runs."""

from __future__ import annotations

from railpatch.case import WheelsetCase
from railpatch.case.kinds import SceneKind, with_tables

from rig_model.curve import DEFAULT, Curve
from rig_model.scene import Rig, default_scene


def rig() -> SceneKind:
    """A run of the roller rig."""
    model = with_tables(WheelsetCase, {"rig": Rig})
    return SceneKind("rig", model, default_scene(), "railpatch rig SCENE -o run.mcap")


def curve() -> SceneKind:
    """Steady curving."""
    model = with_tables(WheelsetCase, {"curve": Curve})
    return SceneKind("curve", model, DEFAULT, "railpatch curve SCENE")
