"""The kinds of scene files that this package runs."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Any

from railpatch.case import WheelsetCase
from railpatch.case.kinds import Ending, Prepared, SceneKind, with_tables
from railpatch.case.load import check_table
from railpatch.record.columns import Columns, given
from railpatch.record.forces import PARTS
from railpatch.record.quantities import ratio_side
from railpatch.record.read import read_record

from rig_model.curve import DEFAULT, Curve, SteadyCurve, load_curve_scene, steady_curves
from rig_model.measured import PREFIX
from rig_model.scene import default_scene, load_rig_scene
from rig_model.tables import Rig


def rig() -> SceneKind:
    """A run of the roller rig."""
    model = with_tables(WheelsetCase, {"rig": Rig})
    command = "railpatch rig SCENE -o run.mcap"
    units = dict.fromkeys(("positions", "balanced", "evaluations"), "")
    return SceneKind(
        *("rig", model, default_scene(), command, run_rig, None, follow_rig, prepare_rig),
        units=units,
    )


def run_rig(scene: Path, log: Path) -> Ending:
    """All positions."""
    from rig_model.run import replay

    loaded = load_rig_scene(scene)
    summary = replay(loaded, log)
    missed = int((~summary.converged).sum())
    reason = f"{missed} of {len(summary.converged)} positions are not balanced" if missed else None
    values = {
        "positions": len(summary.converged),
        "balanced": int(summary.converged.sum()),
        "evaluations": float(summary.evaluations.mean()),
    }
    status = "not_converged" if missed else "converged"
    return Ending(status, reason, [*loaded.doubts, *summary.warned.lines()], values)


def follow_rig(content: dict[str, Any], folder: Path, names: Sequence[str], rows: Any) -> Any:
    """The run of a scene's content, followed; rows: of railpatch.match.plan.RowsTable by name."""
    from rig_model.follow import Follower
    from rig_model.rows import Rows

    sought = None
    for name, table in rows.items():
        sought = Rows(name, table.low, table.high, table.starts)
    return Follower(content, folder, names, sought)


def prepare_rig(content: dict[str, Any], folder: Path, rows: Sequence[str]) -> Prepared:
    """A run's content for a match: where neither record nor scene say them, the lateral position
    is 0 and rows come every second. Raises CaseError."""
    rig = dict(content["rig"])
    table = check_table(Columns, rig["columns"], "rig.columns") if "columns" in rig else None
    record = read_record(folder / rig["record"], given(table) if table else None, prefix=PREFIX)
    told = []
    if "lateral_position" not in {*record.signals, *rig, *rows}:
        rig["lateral_position"] = [[0.0, 0.0], [1.0, 0.0]]
        told.append(
            "rig.lateral_position: nobody says it, taken as 0 but for rig.offset.y; "
            "[match.rows.lateral_position] finds one for each row"
        )
    if record.kind != "time" and "duration" not in rig:
        rig["duration"] = float(len(record.at) - 1)
        told.append("rig.duration: nobody says it, taken as 1 s from row to row")
    return Prepared(
        content | {"rig": rig}, forces_of(record.signals), record.units, [*record.warnings, *told]
    )


def forces_of(measured: Iterable[str]) -> tuple[str, ...]:
    """What is observed where nobody says: forces, and L/V of sides without a lateral force."""
    names = tuple(measured)
    return tuple(
        name
        for name in names
        if name.rpartition("_")[2] in PARTS
        or (ratio_side(name) and f"{ratio_side(name)}_lateral" not in names)
    )


def curve() -> SceneKind:
    """Steady curving."""
    model = with_tables(WheelsetCase, {"curve": Curve})
    known = {"radius": "m", **SteadyCurve.UNITS, "residuals": ""}
    units = {f"curves.{name}": unit for name, unit in known.items()}
    return SceneKind("curve", model, DEFAULT, "railpatch curve SCENE", run_curve, units=units)


def run_curve(scene: Path, _log: Path) -> Ending:
    """The balance in each curve, as ``curves[0].y``, by the scene's method."""
    found = steady_curves(load_curve_scene(scene))
    missed = [curve for curve in found if not curve.converged]
    reason = "; ".join(f"curve of {c.radius:g} m: {c.result.reason or c.status}" for c in missed)
    warned = dict.fromkeys(text for curve in found for text in curve.result.warnings)
    left_out = ("wall_time", "start_time")
    curves = [{k: v for k, v in c.to_dict().items() if k not in left_out} for c in found]
    status = missed[0].status if missed else "converged"
    return Ending(status, reason or None, list(warned), {"curves": curves})
