"""Forces at the published positions of the NRC roller rig.

Dry run at 10 mph and 13,750 lb a side: wheelset positions after force balance, and the forces that
the authors' own model of the rig gives there (CONTACT, 2025). The numbers are the package's own
nrc_dry_10mph_13750lb.csv, which reports show; forces there act on the roller, so ours are their
negatives. Each component must agree within 1 % of the wheel's vertical load where the wheel
has one patch, within 2 % where it has two: the share of the second patch, on the flange root,
depends more on how the measured profiles are smoothed.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from railpatch import Contact
from railpatch.published import read_rows
from railpatch.report import reference

from rig_model import scene as rig_scene

SIDES = {"L": "left", "R": "right"}
ALLOWED = {1: 0.01, 2: 0.02}  # of the wheel's vertical load, by number of patches


@pytest.fixture(scope="module")
def compared():
    """One entry a wheel: row, number of patches, force on the roller (N, [3]), published force."""
    scene_file = rig_scene.default_scene()
    assert scene_file.name == rig_scene.MEASURED
    scene = rig_scene.load_rig_scene(scene_file)
    # points and normals of the program that gave the forces
    method = scene.case.method.model_copy(update={"patch_rule": "contact"})
    scene = replace(scene, case=scene.case.model_copy(update={"method": method}))
    contact = Contact(scene.at_height())
    entries = []
    for _, row in read_rows(reference.find()):
        result = contact.step(
            y=1e-3 * float(row["y_ws_mm"]),
            z=1e-3 * float(row["z_ws_mm"]),
            roll=float(row["roll_rad"]),
            yaw=float(row["yaw_rad"]),
            pitch_rate=float(row["pitch_rate_rad_s"]),
        )
        wheel = result[SIDES[row["side"]]]
        assert wheel["status"] == "converged"
        published = np.array([float(row[f"f{axis}_on_roller_N"]) for axis in "xyz"])
        entries.append((row, len(wheel["patches"]), -np.array(wheel["force"]), published))
    return entries


def test_all_rows_are_there(compared):
    assert len(compared) == 26
    assert {row["side"] for row, *_ in compared} == {"L", "R"}


def test_number_of_patches(compared):
    for row, patches, _, _ in compared:
        assert patches == int(row["patches"]), row


def test_forces(compared):
    print("\nside  yaw mrad   y mm  patches   difference of Fx, Fy, Fz, % of the wheel's Fz")
    worst = []
    for row, _, found, published in compared:
        difference = (found - published) / published[2]
        allowed = ALLOWED[int(row["patches"])]
        worst.append(np.abs(difference).max() / allowed)
        print(
            f"{row['side']:>4} {1e3 * float(row['yaw_rad']):+9.0f} {float(row['y_ws_mm']):+6.2f} "
            f"{row['patches']:>8} " + " ".join(f"{100 * d:+8.2f}" for d in difference)
        )
    assert max(worst) < 1, "the table above is printed with pytest -s"
