"""`railpatch subsurface`: what it prints, writes and refuses."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
import railpatch
from click.testing import CliRunner, Result
from railpatch.command.cli import cli

# circle of 4 mm under Hertz' pressure: p0 = 3 F/(2 pi a^2) = 1 GPa
RADIUS, PEAK = 4e-3, 1e9
FORCE = 2 * np.pi * RADIUS**2 * PEAK / 3
CASE = f"""kind = "patch"
[geometry]
semi_axes = [{RADIUS}, {RADIUS}]
[grid]
elements = [40, 40]
[load]
normal_force = {FORCE}
[material]
poisson_ratio = 0.3
[friction]
coefficient = 0.3
[method]
normal = "hertz"
[motion]
creepage = [1e-5, 0.0]
"""


def run(folder: Path, *arguments: object, case: str = CASE) -> Result:
    file = folder / "case.toml"
    file.write_text(case)
    words = ["subsurface", file, *arguments]
    return CliRunner().invoke(cli, [str(word) for word in words])


def test_the_greatest_shear_lies_where_it_does_below_a_circle(tmp_path: Path) -> None:
    """Johnson 1985, eq. 4.13 on: 0.310 p0 at 0.48 a, nu = 0.3."""
    found = run(tmp_path, "--json")
    assert found.exit_code == 0, found.output
    table = {name: np.array(values) for name, values in json.loads(found.output).items()}
    k = table["greatest_shear"].argmax()
    assert table["greatest_shear"][k] == pytest.approx(0.310 * PEAK, rel=0.01)
    # 24 depths from 0 to 1.5 diameters
    assert table["depth"][k] == pytest.approx(0.48 * RADIUS, abs=3 * RADIUS / 23)
    assert abs(table["greatest_shear_x"][k]) < 0.1 * RADIUS


def test_files_hold_the_same_stresses(tmp_path: Path) -> None:
    depths = ("--depth", "1e-3", "--depth", "3e-3")
    for name in ("a.csv", "a.npz", "a.html"):
        assert run(tmp_path, *depths, "-o", tmp_path / name, "--quiet").output == ""
    arrays = np.load(tmp_path / "a.npz")
    assert arrays["stress"].shape == (6, 2, len(arrays["y"]), len(arrays["x"]))
    lines = np.genfromtxt(tmp_path / "a.csv", delimiter=",", names=True, deletechars="")
    np.testing.assert_allclose(lines["stress_nn_(Pa)"], arrays["stress"][2].ravel(), rtol=1e-8)
    np.testing.assert_allclose(lines["depth_(m)"], np.repeat([1e-3, 3e-3], len(lines) // 2))
    assert "von Mises stress" in (tmp_path / "a.html").read_text()


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (("-o", "x.pdf"), "allowed a name that ends in .html, .csv, .npz"),
        (("--depth", "-1"), "--depth"),
        (("--patch", "2"), "--patch: value is 2, allowed 1 to 1"),
        (("--patch", "0"), "--patch"),
        (("--body", "sleeper"), "--body"),
    ],
)
def test_wrong_calls(tmp_path: Path, arguments: tuple[str, ...], words: str) -> None:
    found = run(tmp_path, *arguments)
    assert found.exit_code == 2
    assert words in found.output


def test_theories_without_elements_are_named(tmp_path: Path) -> None:
    fast = CASE.replace('normal = "hertz"', 'normal = "hertz"\ntangential = "polach"')
    found = run(tmp_path, case=fast)
    assert found.exit_code == 2
    assert "no pressure element by element" in found.output


def test_depths_in_mm_are_doubted(tmp_path: Path) -> None:
    """As the case's own are: 0.5 m below a contact nothing is left."""
    done = run(tmp_path, "--depth", "1e-3", "--depth", "0.5")
    assert done.exit_code == 0, done.output
    assert "warning: --depth: a depth is 0.5 m" in done.output
    assert "--depth" not in run(tmp_path, "--depth", "0.05").output
    assert run(tmp_path, "--depth", "0.5", "--strict").exit_code == 2
    contact = railpatch.Contact(tmp_path / "case.toml")
    contact.step()
    below = railpatch.Subsurface(contact, [1e-3, 0.05])
    assert below.warnings == []
    below.at([[0.0, 0.0, 0.051]])
    assert ["points: a depth is 0.051 m" in text for text in below.warnings] == [True]
    below.at([[0.0, 0.0, 0.05]])
    assert below.warnings == []
    [text] = railpatch.Subsurface(contact, [1e-3, 0.06]).warnings
    assert text.startswith("depth: a depth is 0.06 m, hardly meant above 0.05 m")


def test_an_accuracy_in_place_of_a_grid(tmp_path: Path) -> None:
    """It chose a table, which has no tractions, and ended with an error of the core."""
    below = "[subsurface]\ndepths = [1e-3, 2e-3]\n"
    file = tmp_path / "case.toml"
    stresses = []
    for old, new in (("", ""), ("[grid]\nelements = [40, 40]\n", "")):
        text = CASE.replace(old, new).replace(
            'normal = "hertz"', "" if not old else "accuracy = 0.03"
        )
        file.write_text(text + below)
        stresses.append(railpatch.solve(file)["subsurface"]["von_mises"])
    assert stresses[1] == pytest.approx(stresses[0], rel=0.03)


def test_damage_by_elements_needs_a_grid(tmp_path: Path) -> None:
    """An accuracy chooses rows of nodes or a table: it ended with a TypeError."""
    file = tmp_path / "case.toml"
    text = CASE.replace("[grid]\nelements = [40, 40]\n", "").replace(
        'normal = "hertz"', "accuracy = 0.03"
    )
    file.write_text(text + "[damage]\n")
    with pytest.raises(railpatch.CaseError, match=r"^damage.basis: value is 'elements', allowed"):
        railpatch.solve(file)
    file.write_text(text + '[damage]\nbasis = "patch"\n')
    assert railpatch.solve(file).status == "converged"
