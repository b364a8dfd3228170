"""A run followed through changes of its scene: derivatives as differences of whole replays, and
positions of rows found from forces that a replay with known ones gave."""

from __future__ import annotations

from copy import deepcopy
from pathlib import Path

import numpy as np
import pytest
from railpatch.case.load import read_toml
from railpatch.errors import CaseError
from railpatch.sweep.plan import put

from rig_model.follow import Follower
from rig_model.rows import Rows
from rig_model.scene import NOMINAL, scenes

NAMES = ("left_lateral", "right_lateral", "left_vertical", "right_longitudinal", "left_ratio")
COLUMNS = ("time", "yaw", "lateral_position", *NAMES[:-1], "left_longitudinal")
YAW = (2e-3, 8e-3, 1e-3)
LATERAL = (0.4e-3, 1.2e-3, -1.5e-3)


def rig(folder: Path, *, driven: bool = True, forces: np.ndarray | None = None) -> dict:
    """The nominal rig on coarse elements, and a record of three rows."""
    content = read_toml(scenes() / NOMINAL)
    content["grid"]["element_size"] = [1e-3, 1e-3]
    content["track"]["left"] = {"offset": [0.0, 0.0, 0.0]}
    columns = [name for name in COLUMNS if driven or name != "lateral_position"]
    lines = [",".join(columns)]
    for i, (yaw, lateral) in enumerate(zip(YAW, LATERAL, strict=True)):
        row = {"time": 10.0 * i, "yaw": yaw, "lateral_position": lateral}
        measured = np.full(5, 4e4) if forces is None else forces[:, i]
        row |= dict(zip((*NAMES[:-1], "left_longitudinal"), measured, strict=True))
        lines.append(",".join(repr(float(row[name])) for name in columns))
    (folder / "record.csv").write_text("\n".join(lines) + "\n")
    units = {"time": "s", "yaw": "rad", "lateral_position": "m"}
    content["rig"] = {
        "record": "record.csv",
        "columns": {name: {"name": name, "unit": units.get(name, "N")} for name in columns},
        "balance": content["rig"].get("balance", {}),
    }
    if not driven:
        content["rig"]["lateral_position"] = [[0.0, 0.0], [1.0, 0.0]]
    return content


def changed(content: dict, key: str, value: float) -> dict:
    other = deepcopy(content)
    put(other, key, value)
    return other


def exactly(content: dict) -> dict:
    """Solved so far that differences of whole replays are derivatives."""
    return changed(changed(content, "method.tolerance", 1e-8), "rig.balance.tolerance", 1e-7)


# key, value, step of a derivative, part of the greatest slope that it may be off by: what is exact
# and moves no contact by 1e-3 to 5e-3; what moves contacts by 2e-2, for elements that come into
# contact make steps in a difference; what is itself a difference over a hundredth of a number by as
# much as that
SOUGHT = (
    ("friction.coefficient", 0.52, 1e-3, 1e-3),
    ("layer.thickness", 5e-5, 5e-7, 2e-2),
    ("wheelset.vertical_force", 133.95e3, 100.0, 5e-3),
    ("track.left.offset[1]", 0.0, 1e-5, 2e-2),
    ("rig.columns.lateral_position.offset", 0.0, 1e-5, 2e-2),
    ("rig.frame.stiffness", 2e7, 2e4, 1e-2),
    ("rig.frame.friction[0][1]", 8e3, 40.0, 1e-2),
)


def test_derivatives_are_those_of_whole_replays(tmp_path: Path) -> None:
    """A frame whose slider slides and sticks, so that rows owe something to those before."""
    content = rig(tmp_path)
    content["rig"]["frame"] = {"stiffness": 2e7, "friction": [[3e7, 8e3]]}
    followed = Follower(content, tmp_path, NAMES[:3])
    assert followed.exact
    others = [changed(content, key, value + step) for key, value, step, _ in SOUGHT]
    slopes = followed.slopes(content, others, [step for _, _, step, _ in SOUGHT])
    reference = Follower(exactly(content), tmp_path, NAMES[:3])
    for k, (key, value, step, allowed) in enumerate(SOUGHT):
        ends = [
            reference.computed(exactly(changed(content, key, value + sign * step / 2)))
            for sign in (1, -1)
        ]
        difference = (ends[0] - ends[1]) / step
        scale = np.abs(difference).max(axis=1, keepdims=True)
        assert np.all(scale > 0), key
        assert np.abs((slopes[:, :, k] - difference) / scale).max() < allowed, key


def test_without_exact_derivatives(tmp_path: Path) -> None:
    """The rule of another program has none: differences at the balanced states."""
    content = changed(rig(tmp_path), "method.patch_rule", "contact")
    followed = Follower(content, tmp_path, NAMES[:3])
    assert not followed.exact
    key, value, step, _ = SOUGHT[0]
    slopes = followed.slopes(content, [changed(content, key, value + step)], [step])
    reference = Follower(exactly(content), tmp_path, NAMES[:3])
    ends = [
        reference.computed(exactly(changed(content, key, value + sign * step))) for sign in (1, -1)
    ]
    difference = (ends[0] - ends[1]) / (2 * step)
    # forces on elements that stay where they are rise by steps as these come into contact: eight
    # of them lie across it
    assert np.abs(slopes[:, :, 0] - difference).max() < 5e-2 * np.abs(difference).max()


def test_rows_are_where_the_forces_were_made(tmp_path: Path) -> None:
    names = (*NAMES[:2], "right_longitudinal", "left_longitudinal")
    made = rig(tmp_path)
    order = (*NAMES[:-1], "left_longitudinal")
    forces = Follower(exactly(made), tmp_path, order).computed(exactly(made))
    content = rig(tmp_path, driven=False, forces=forces)
    rows = Rows("lateral_position", -3e-3, 3e-3, 9)
    followed = Follower(content, tmp_path, names, rows)
    followed.weigh(np.full(4, 50.0))
    followed.computed(content)
    slopes = followed.slopes(content, [changed(content, "friction.coefficient", 0.521)], [1e-3])
    values, low, high, _ = followed.row_values(np.zeros((1, 1)))
    assert values == pytest.approx(LATERAL, abs=2e-5)
    assert np.all((low < LATERAL) & (high > LATERAL))
    for i in range(len(YAW)):
        along, weights = rows.along(i)
        assert along is not None
        # nothing is left of a derivative along a row's own value
        part = (weights * along) @ slopes[:, i, 0] / np.sqrt(weights @ along**2)
        assert abs(part) < 1e-9 * np.sqrt(weights @ slopes[:, i, 0] ** 2)


def test_what_rows_cannot_be_is_refused(tmp_path: Path) -> None:
    content = rig(tmp_path)
    with pytest.raises(CaseError, match="allowed lateral_position, yaw"):
        Rows("roll", 0.0, 1.0, 3)
    with pytest.raises(CaseError, match="allowed what the record does not drive"):
        Follower(content, tmp_path, NAMES[:2], Rows("lateral_position", -1e-3, 1e-3, 3))
    content["rig"]["frame"] = {"stiffness": 2e7, "friction": [[3e7, 8e3]]}
    with pytest.raises(CaseError, match=r"rig\.frame\.friction"):
        Follower(content, tmp_path, NAMES[:2], Rows("lateral_position", -1e-3, 1e-3, 3))
