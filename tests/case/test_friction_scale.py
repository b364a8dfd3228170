"""[friction] scale: a factor of the law on each wheel, which moves."""

from __future__ import annotations

import pytest
import railpatch
from case_samples import PATCH, with_values
from railpatch.errors import CaseError
from railpatch.fmu.scenes import kind_scene

RAIL = kind_scene("wheelset_rail")[1].case.model_dump(exclude_none=True)


def test_each_wheel_has_its_own() -> None:
    """The bits of scenes whose coefficient is that of one wheel."""
    found = railpatch.solve(with_values(RAIL, friction__scale=[0.5, 2.0]))
    for side, factor in (("left", 0.5), ("right", 2.0)):
        coefficient = factor * RAIL["friction"]["coefficient"]
        alone = railpatch.solve(with_values(RAIL, friction__coefficient=coefficient))
        assert found[side]["force"] == alone[side]["force"]
        assert found[side]["friction_power"] == alone[side]["friction_power"]


def test_it_moves_and_a_patch_takes_the_second() -> None:
    contact = railpatch.Contact(PATCH)
    usual = contact.step()["creep_force"]
    same = contact.step(friction_scale=[0.1, 1.0])["creep_force"]
    assert same == pytest.approx(usual, rel=1e-6, abs=1e-3)
    low = contact.step(friction_scale=[1.0, 0.1])
    capacity = 0.1 * PATCH["friction"]["coefficient"] * low["normal_force"]
    assert sum(v * v for v in low["creep_force"]) ** 0.5 <= capacity * (1 + 1e-9)
    many = railpatch.solve_many(PATCH, {"friction_scale": [[1.0, 1.0], [1.0, 0.1]]})
    assert many["creep_force"][0] == pytest.approx(usual, rel=1e-5, abs=1e-3)
    assert many["creep_force"][1] == pytest.approx(low["creep_force"], rel=1e-5, abs=1e-3)


@pytest.mark.parametrize("scale", [[1.0, -0.1], [101.0, 1.0], [1.0], 0.5])
def test_other_values_are_refused(scale: object) -> None:
    with pytest.raises(CaseError, match=r"friction\.scale"):
        railpatch.solve(with_values(PATCH, friction__scale=scale))


def test_its_derivative_is_that_of_differences() -> None:
    case = with_values(RAIL, method__derivatives=True, method__tolerance=1e-10)
    contact = railpatch.Contact(case)
    contact.step(friction_scale=[0.6, 0.9])
    rate = contact.differentiate(friction_scale=[1.0, 0.0])
    ends = [contact.step(friction_scale=[0.6 + h, 0.9]) for h in (-1e-6, 1e-6)]
    for side in ("left", "right"):
        differences = [
            (b - a) / 2e-6
            for a, b in zip(ends[0][side]["force"], ends[1][side]["force"], strict=True)
        ]
        scale = max(map(abs, ends[0][side]["force"]))
        assert rate[side]["force"] == pytest.approx(differences, rel=1e-4, abs=1e-6 * scale)
    assert max(map(abs, rate["left"]["force"])) > 0
    assert rate["right"]["force"] == [0.0, 0.0, 0.0]
