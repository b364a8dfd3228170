"""Fast normal theories on wheels: smooth in the wheelset's height, met loads, left as right.

A second part of contact appears, comes close and merges on the way down; the force must not jump.
A jump stands out as a step far above the neighbouring ones in a sweep of equal steps.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
import railpatch
from case_samples import WHEELSET, with_values

METHODS = ("kik_piotrowski", "kik_piotrowski_corrected", "analyn")


def wheel_case(method: str, **values: Any) -> dict[str, Any]:
    return with_values(
        WHEELSET,
        method={"normal": method, "tangential": "none"},
        grid__element_size=[2e-4, 2e-4],
        friction=None,
        **values,
    )


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("y", [0.0, 5e-4, 5e-3])
def test_force_is_smooth_in_height(method: str, y: float) -> None:
    case = wheel_case(method, kind="wheel_rail", wheelset__y=y, wheelset__vertical_force=5e3)
    del case["wheelset"]["z"]
    start = railpatch.solve(case)["z"]
    contact = railpatch.Contact(wheel_case(method, kind="wheel_rail", wheelset__y=y))
    forces, patches = [], set()
    for z in start + np.linspace(0, 6e-5, 241):
        result = contact.step(z=z)
        assert result["status"] == "converged"
        forces.append(-result["force"][2])
        patches.add(len(result["patches"]))
    steps = np.diff(forces)
    print(f"\n{method} y = {y}: {forces[0]:.0f} ... {forces[-1]:.0f} N, patches {patches}, largest")
    print(f"step over median {np.abs(steps).max() / np.median(steps):.2f}, least {steps.min():.1f}")
    assert np.abs(steps).max() < 3 * np.median(steps)


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("tangential", ["none", "fastsim", "full"])
def test_load_is_met(method: str, tangential: str) -> None:
    case = with_values(
        WHEELSET,
        method={"normal": method, "tangential": tangential},
        friction=None if tangential == "none" else WHEELSET["friction"],
        wheelset__y=1e-3,
        wheelset__z=None,
        wheelset__vertical_force=1.2e5,
    )
    result = railpatch.solve(case)
    assert result.status == "converged"
    assert result["force"][2] == pytest.approx(-1.2e5, rel=2e-5)
    for side in ("left", "right"):
        for patch in result[side]["patches"]:
            assert patch["max_pressure"] > 0
            assert patch["contact_area"] > 0
            assert patch["elastic_energy"] > 0


@pytest.mark.parametrize("method", METHODS)
def test_left_as_right(method: str) -> None:
    results = [railpatch.solve(wheel_case(method, wheelset__y=y)) for y in (1.5e-3, -1.5e-3)]
    one, other = results[0].to_dict(), results[1].to_dict()
    for a, b in (("left", "right"), ("right", "left")):
        mirrored = [one[a]["force"][0], -one[a]["force"][1], one[a]["force"][2]]
        assert other[b]["force"] == pytest.approx(mirrored, rel=1e-12, abs=1e-9)


@pytest.mark.parametrize("method", METHODS)
def test_what_is_not_needed_is_left_out(method: str) -> None:
    """No influence coefficients and no transforms where no stage works on the half-space."""

    def bytes_of(normal: str, tangential: str) -> dict[str, int]:
        case = with_values(WHEELSET, method={"normal": normal, "tangential": tangential})
        stages = railpatch.Contact(case).stages()
        return {stage["name"]: stage["bytes"] for stage in stages if stage["present"]}

    fast, full = bytes_of(method, "fastsim"), bytes_of("half_space", "fastsim")
    assert "influence" not in fast
    assert "influence" in full
    assert "influence" in bytes_of(method, "full")
    assert fast["normal"] < full["normal"]
