"""railpatch profile: the page, its figures' data, roles and wrong calls."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner, Result
from page_checks import check_page
from railpatch.command.cli import cli
from railpatch.profiles import builtin_profile, load_profile
from railpatch.profiles.formulas import S1002_JOINTS
from railpatch.profiles.pairing.contact_points import contact_points, positions
from railpatch.profiles.pairing.doctor import tables_of
from railpatch.profiles.pairing.figures import conicity_figure, contact_figure, shape_figure
from railpatch.profiles.shape import shape_of


def invoke(*arguments: object) -> Result:
    return CliRunner().invoke(cli, ["profile", *map(str, arguments)])


@pytest.mark.parametrize(
    ("arguments", "title", "role"),
    [
        (["S1002"], "S1002 on UIC60@1:40", "wheel"),
        (["UIC60@1:20"], "S1002 on UIC60@1:20", "rail"),
        (["cone@1:20", "--rail", "arc@0.3"], "cone@1:20 on arc@0.3", "wheel"),
        (["arc@0.3", "--wheel", "cone@1:20"], "cone@1:20 on arc@0.3", "rail"),
    ],
)
def test_page(arguments: list[str], title: str, role: str, tmp_path: Path) -> None:
    page = tmp_path / "plot.html"
    ran = invoke(*arguments, "-o", page)
    assert ran.exit_code == 0, ran.output
    said = ran.stdout.splitlines()
    assert said[0].startswith(f"{title}: ")
    assert said[-3:] == [str(page), *map(str, tables_of(page))]
    text = page.read_text(encoding="utf-8")
    assert f"<h2>{title}</h2>" in text
    assert f"{role} profile" in text
    for name in ("shape", "contact", "difference", "conicity"):
        assert f'id="{name}"' in text
    check_page(page)
    if "cone" in title:
        assert text.count("<td class=n>0.0500</td>") == 8


def test_dimensions_reach_the_page(tmp_path: Path) -> None:
    page = tmp_path / "plot.html"
    ran = invoke("S1002", "-o", page, "--gauge", 1.43, "--radius", 0.5, "--quiet")
    assert (ran.exit_code, ran.output) == (0, "")
    text = page.read_text(encoding="utf-8")
    assert "gauge 1430 mm" in text
    assert "radius 500 mm" in text


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["cone@1:20"], "is a wheel or a rail"),
        (["S1002", "--wheel", "S1002"], "is a wheel, written 'S1002'"),
        (["S1002", "--rail", "UIC60", "--wheel", "S1002"], "allowed one"),
        (["absent.prr"], "file not found"),
        (["S1002", "--rail", "absent.prr"], "file not found"),
        (["S1002", "--gauge", "-1"], "gauge"),
    ],
)
def test_wrong_calls_write_nothing(arguments: list[str], message: str, tmp_path: Path) -> None:
    page = tmp_path / "plot.html"
    ran = invoke(*arguments, "-o", page)
    assert ran.exit_code == 2
    assert message in ran.stderr
    assert not page.exists()


def test_slope_and_curvature_of_a_crown() -> None:
    shape = shape_of(load_profile("arc@0.3", "rail"))
    np.testing.assert_allclose(shape.slope, np.arcsin(shape.y / 0.3), rtol=0, atol=1e-12)
    np.testing.assert_allclose(shape.curvature, 1 / 0.3, rtol=1e-6)
    assert not shape.steps.size
    assert not shape.corners.size


def test_steps_of_the_curvature_lie_at_the_joints_of_arcs() -> None:
    shape = shape_of(load_profile("UIC60", "rail"))
    # arcs of 300, 80 and 13 mm, then a straight side: UIC 861-3
    joints = np.array([10.5e-3, 25.988035e-3, 36e-3])
    np.testing.assert_allclose(
        shape.y[shape.steps], np.concatenate([-joints[::-1], joints]), rtol=0, atol=1e-9
    )
    wheel = shape_of(load_profile("S1002", "wheel"))
    # EN 13715: the joints of tread line and flange; the tread's polynomials meet their neighbours
    # with equal curvature at -26 mm and -35 mm
    expected = [S1002_JOINTS[k] for k in (7, 6, 5, 4, 1)]
    np.testing.assert_allclose(1e3 * wheel.y[wheel.steps], expected, rtol=0, atol=1e-6)


def test_a_corner_in_a_file_is_marked(tmp_path: Path) -> None:
    y = np.arange(-30.0, 30.1, 0.5)
    file = tmp_path / "roof.txt"
    file.write_text("\n".join(f"{a:g} {0.3 * abs(a):g}" for a in y))
    shape = shape_of(load_profile(file, "rail", smoothing=0))
    assert shape.corners.size
    sharpest = shape.corners[np.argmax(np.abs(shape.curvature[shape.corners]))]
    assert abs(shape.y[sharpest]) < 1e-6
    names = {trace.name for trace in shape_figure(shape).data}
    assert names == {"profile", "corner"}


def test_figures_hold_the_numbers() -> None:
    points = contact_points("S1002", "UIC60@1:40", positions(4e-3, 1e-3))
    on_wheel, from_gauge, angle = (trace.y for trace in contact_figure(points).data)
    np.testing.assert_allclose(on_wheel, 1e3 * points.on_wheel)
    np.testing.assert_allclose(from_gauge, 1e3 * (points.position - 0.7175))
    np.testing.assert_allclose(angle, np.degrees(points.contact_angle))
    amplitude = np.array([1e-3, 2e-3])
    trace = conicity_figure(amplitude, np.array([0.1, 0.2])).data[0]
    assert (list(trace.x), list(trace.y)) == ([1.0, 2.0], [0.1, 0.2])


def test_answers_on_the_terminal_alone(tmp_path: Path) -> None:
    ran = invoke("S1002", "--gauge-height", 0.010)
    assert ran.exit_code == 0, ran.output
    assert ran.stdout.startswith("S1002 on UIC60@1:40: equivalent conicity ")
    for words in ("waves of", "greatest pressure in the middle", "steepest flank: "):
        assert words in ran.stdout
    assert not list(tmp_path.iterdir())


def test_terminal_ends_with_the_lines_that_read_a_file(tmp_path: Path) -> None:
    curve = builtin_profile("UIC60@1:40", "rail")
    assert curve is not None
    own = tmp_path / "rail.txt"
    np.savetxt(own, 1e3 * np.column_stack([curve.y, curve.z]), fmt="%.5f")
    ran = invoke(own, "--role", "rail")
    assert ran.exit_code == 0, ran.output
    lines = ran.stdout.splitlines()
    assert lines[lines.index("[profiles]") :] == [
        "[profiles]",
        f'rail = "{own}"',
        'rail_file = { unit = "mm", swap = false, mirror = "none" }',
    ]
