"""Derivatives of a contact's numbers by what is sought: the core's own where it has them."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from railpatch.match import load_match
from railpatch.match.model import ContactModel

SCENE = """kind = "patch"
[material]
shear_modulus = 82e9
poisson_ratio = 0.28
[geometry]
semi_axes = [6e-3, 6e-3]
[load]
normal_force = 1e5
[grid]
elements = [10, 10]
[motion]
creepage = [0.0, 0.0]
spin_creepage = 0.0
[friction]
coefficient = 0.3
[layer]
shear_modulus = 8.2e9
thickness = 5e-5
[method]
normal = "hertz"
[match]
record = "curve.csv"
starts = 1
[match.sought]
"""
SOUGHT = {
    "friction.coefficient": "[0.1, 0.5]",
    "motion.spin_creepage": "[-0.2, 0.4]",
    "layer.thickness": "[1e-6, 1e-3]",
}
SHARES = np.array([0.5, 0.4, 0.55])


@pytest.fixture
def model(tmp_path: Path):
    """Of what is sought, on forces and tractions of five creepages."""

    def made(**sought: str) -> ContactModel:
        lines = [f'"{key}" = {ends}' for key, ends in sought.items()]
        (tmp_path / "scene.toml").write_text(SCENE + "\n".join(lines) + "\n")
        rows = [f"{c},{-3e4 * c / 2e-3},{0.1 * c / 2e-3}" for c in (5e-4, 1e-3, 2e-3, 4e-3, 8e-3)]
        heads = "creepage,force_x,lateral_traction"
        (tmp_path / "curve.csv").write_text("\n".join([heads, *rows]) + "\n")
        plan = load_match(tmp_path / "scene.toml")
        return ContactModel(plan, plan.explanations[0])

    return made


def test_exact_and_differences_agree(model) -> None:
    """Against central differences of all states; the layer's thickness has no exact one."""
    found = model(**SOUGHT)
    slopes = found.slopes(SHARES)
    assert slopes is not None
    for k, width in enumerate((1e-3, 1e-3, 1e-3)):
        step = width * (np.arange(3) == k)
        central = (found.at(SHARES + step) - found.at(SHARES - step)) / (2 * width)
        for o in range(2):
            scale = np.abs(central[o]).max()
            assert np.abs(slopes[o, :, k] - central[o]).max() < 5e-3 * scale, (k, o)


def test_what_is_exact_takes_no_states(model) -> None:
    """Of all rows: none for what the core differentiates, two where something else is sought."""
    found = model(**{key: SOUGHT[key] for key in ("friction.coefficient", "motion.spin_creepage")})
    found.slopes(SHARES[:2])
    assert found.evaluations == 0
    found = model(**SOUGHT)
    found.slopes(SHARES)
    assert found.evaluations == 2
    found = model(**{"layer.thickness": SOUGHT["layer.thickness"]})
    assert found.slopes(SHARES[2:]) is None


def test_rows_move_what_is_sought(model) -> None:
    """A creepage that the rows have is no parameter's."""
    found = model(**{"friction.coefficient": "[0.1, 0.5]", "motion.creepage[1]": "[-1e-3, 1e-3]"})
    slopes = found.slopes(np.array([0.5, 0.5]))
    assert slopes is not None
    assert found.evaluations == 2
