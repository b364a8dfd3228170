"""The case file: its schema, its checks, and loading it from TOML or a dictionary."""

from railpatch.case.common import Friction, Grid, Layer, Material, Method, Temperature
from railpatch.case.load import Scene, json_schema, load_scene
from railpatch.case.patch import Geometry, Load, Motion, PatchCase
from railpatch.case.wheel import (
    Deviation,
    Profiles,
    Track,
    Wheel,
    WheelRailCase,
    Wheelset,
    WheelsetCase,
)
from railpatch.errors import CaseError

__all__ = [
    "CaseError",
    "Deviation",
    "Friction",
    "Geometry",
    "Grid",
    "Layer",
    "Load",
    "Material",
    "Method",
    "Motion",
    "PatchCase",
    "Profiles",
    "Scene",
    "Temperature",
    "Track",
    "Wheel",
    "WheelRailCase",
    "Wheelset",
    "WheelsetCase",
    "json_schema",
    "load_scene",
]
