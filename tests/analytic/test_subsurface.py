"""Stresses below the surface from Python: balance by separate code, and what is refused."""

from __future__ import annotations

import numpy as np
import pytest
from case_samples import PATCH, WHEELSET, with_values
from railpatch import CaseError, Contact, Subsurface
from railpatch.subsurface import STRESSES

CASE = with_values(PATCH, grid__elements=[24, 24], motion__creepage=[1e-3, 0.0])
PAIRS = {"xx": (0, 0), "ss": (1, 1), "nn": (2, 2), "xs": (0, 1), "sn": (1, 2), "nx": (0, 2)}


def solved() -> Contact:
    contact = Contact(CASE)
    assert contact.step().solved
    return contact


def tensors(stress: np.ndarray) -> np.ndarray:
    """[..., 3, 3] of components along the first axis."""
    found = np.zeros((*stress.shape[1:], 3, 3))
    for name, values in zip(STRESSES, stress, strict=True):
        i, j = PAIRS[name]
        found[..., i, j] = found[..., j, i] = values
    return found


def test_forces_in_the_body_balance() -> None:
    """div s = 0 by central differences, depth along n in the rail and against it in the wheel."""
    contact = solved()
    step, at = 2e-5, np.array([1.1e-3, -0.7e-3, 2e-3])
    below = Subsurface(contact, [1e-3])
    for body, down in (("rail", 1.0), ("wheel", -1.0)):
        points = np.concatenate([[at + step * e, at - step * e] for e in np.eye(3)])
        stress, _ = below.at(points, body=body)
        found = tensors(stress.T).reshape(3, 2, 3, 3)
        slopes = (found[:, 0] - found[:, 1]) / (2 * step)
        slopes[2] *= down
        divergence = sum(slopes[i, i] for i in range(3))
        size = np.abs(slopes).max()
        assert np.abs(divergence).max() < 1e-3 * size


def test_measures_are_those_of_the_tensors() -> None:
    below = Subsurface(solved(), [0.5e-3, 2e-3, 5e-3], displacements=True, dang_van=0.4)
    found = below.solve(body="rail")
    s = tensors(found["stress"])
    grid = (3, len(found["y"]), len(found["x"]))
    assert s.shape == (*grid, 3, 3)
    assert found["displacement"].shape == (3, *grid)
    principal = np.linalg.eigvalsh(s)[..., ::-1]
    size = np.abs(principal).max()
    np.testing.assert_allclose(np.moveaxis(found["principal_stress"], 0, -1), principal,
                               atol=1e-6 * size)  # fmt: skip
    deviator = s - np.trace(s, axis1=-2, axis2=-1)[..., None, None] / 3 * np.eye(3)
    mises = np.sqrt(1.5 * (deviator**2).sum(axis=(-2, -1)))
    np.testing.assert_allclose(found["von_mises"], mises, atol=1e-6 * size)
    shear = 0.5 * (principal[..., 0] - principal[..., 2])
    np.testing.assert_allclose(found["greatest_shear"], shear, atol=1e-6 * size)
    # no ball about the deviators is smaller than the half of their greatest distance, nor larger
    # than about their middle; Tresca's shear of a deviator lies between sqrt(1/2) and sqrt(3/8)
    # of its length
    assert found["dang_van"].shape == grid[:2]
    hydrostatic = np.trace(s, axis1=-2, axis2=-1) / 3
    assert (found["dang_van"] <= shear.max(axis=-1) + 0.4 * hydrostatic.max(axis=-1).clip(0)).all()
    assert (found["dang_van"] > 0).any()


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        ({"depth": [-1e-3]}, "depth: value is -0.001"),
        ({"depth": [1e-3, np.nan]}, "depth: value is not finite"),
        ({"depth": []}, "depth: value has shape"),
        ({"depth": "1 mm"}, "depth: value is '1 mm'"),
        ({"depth": ["1e-3"]}, "depth: value is .*, allowed numbers"),
        ({"depth": [True]}, "depth: value is .*, allowed numbers"),
        ({"depth": np.ma.masked_array([1e-3, 2e-3], [0, 1])}, "allowed numbers"),
        ({"depth": [1e-3], "dang_van": 4.0}, "dang_van: value is 4"),
    ],
)
def test_bad_input_is_refused(arguments: dict, words: str) -> None:
    with pytest.raises(CaseError, match=words):
        Subsurface(Contact(CASE), **arguments)


def test_a_patch_that_is_not_there_is_named() -> None:
    contact = Contact(CASE)
    below = Subsurface(contact, [1e-3])
    with pytest.raises(LookupError, match="no such patch"):
        below.solve()
    contact.step()
    with pytest.raises(LookupError, match="patch 3"):
        below.solve(patch=3)
    for wrong in ({"side": "top"}, {"body": "sleeper"}, {"patch": -1}):
        with pytest.raises(CaseError, match=next(iter(wrong))):
            below.solve(**wrong)
    fast = Contact(with_values(CASE, method={"normal": "hertz", "tangential": "polach"}))
    fast.step()
    with pytest.raises(LookupError, match="no pressure"):
        Subsurface(fast, [1e-3]).solve()
    # a pressure without tractions is not what lies below either
    grid = Contact(with_values(CASE, method={"normal": "half_space", "tangential": "polach"}))
    grid.step()
    with pytest.raises(LookupError, match="'polach' gives no pressure"):
        Subsurface(grid, [1e-3]).solve()


def test_wheels_have_it_on_both_sides() -> None:
    case = with_values(
        WHEELSET, wheelset__z=None, wheelset__vertical_force=1e5, grid__element_size=[1e-3, 1e-3]
    )
    contact = Contact(case)
    height = contact.step()["z"]
    below = Subsurface(contact, [2e-3])
    left, right = (below.solve(side=side)["von_mises"].max() for side in ("left", "right"))
    # a centred wheelset is as loaded on either side
    assert left == pytest.approx(right, rel=1e-9)
    assert left > 1e8
    # gone with the contact that it lay under
    lifted = Contact(with_values(WHEELSET, grid__element_size=[1e-3, 1e-3]))
    below = Subsurface(lifted, [2e-3])
    assert lifted.step(z=height).solved
    below.solve(side="left")
    assert lifted.step(z=height - 1e-2).status == "no_contact"
    with pytest.raises(LookupError, match="no such patch"):
        below.solve(side="left")
