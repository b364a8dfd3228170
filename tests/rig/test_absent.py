"""What a run's scene leaves out leaves nothing behind: no bits, no channels, no columns."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest
from railpatch.log import read_run
from railpatch.log.table import log_table

from rig_model.run import replay
from rig_model.scene import load_rig_scene

BULK = """
[temperature]
wheel = 60.0
rail = 20.0
conductivity = 50.0
heat_capacity = 450.0
density = 7850.0
[temperature.bulk]
mass = [350.0, 900.0]
air_conductance = [20.0, 30.0]
"""
# tables -> what they add to a log: topics, or words in names of columns
ADDED = {
    "\n[rig.frame]\nstiffness = 20e6\n": "frame",
    "\n[rig.conditioning]\nplateau = 1.3\nwork = 2e6\n": "conditioning",
    BULK: "temperature",
    "\n[rig.drift]\nyaw = [1e-4, 2e-4]\n": "",
    "\n[rig.offset]\ny = 1e-4\n": "",
}
# fields that time the run itself
TIMED = ("wall_time", "start_time")


def logged(path: Path, log: Path) -> dict[str, list[object]]:
    """Column -> values as the log has them, of a short run."""
    replay(load_rig_scene(path, {"positions": 3}), log)
    table = log_table(read_run(log).channels)
    return {
        column.name: [repr(value) for value in column.values]
        for column in table.columns
        if not column.name.endswith(TIMED)
    }


@pytest.mark.parametrize("table", ADDED)
def test_absent_tables_leave_nothing(
    scene_with: Callable[..., Path], tmp_path: Path, table: str
) -> None:
    """Before and after a run with them the same bits; what they add is in no plain log."""
    before = logged(scene_with(), tmp_path / "before.mcap")
    there = logged(scene_with(end=table), tmp_path / "with.mcap")
    after = logged(scene_with(), tmp_path / "after.mcap")
    assert after == before
    added = set(there) - set(before)
    assert set(before) <= set(there)
    assert bool(added) == bool(ADDED[table])
    assert all(ADDED[table] in name or "heat" in name for name in added)
    word = ADDED[table] or "drift"
    assert not [name for name in before if word in name and "max_temperature" not in name]
    assert there != before


@pytest.mark.parametrize(
    "table", ["\n[rig.drift]\nyaw = [0.0]\n", "\n[rig.offset]\n", "\n[rig.offset]\nyaw = 0.0\n"]
)
def test_nothing_added_is_nothing(
    scene_with: Callable[..., Path], tmp_path: Path, table: str
) -> None:
    """Offsets of nothing give the bits of none."""
    plain = logged(scene_with(), tmp_path / "plain.mcap")
    assert logged(scene_with(end=table), tmp_path / "with.mcap") == plain
