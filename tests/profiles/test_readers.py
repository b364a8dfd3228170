"""Readers: keys, comments, units, orientation."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from profile_files import columns, miniprof, simpack
from published_data import MANCHESTER, NRC
from railpatch.profiles import fit_profile, load_profile, read_profile
from railpatch.profiles.raw import Reading

Write = Callable[[str, str], Path]

# a wheel: tread falling outwards, flange of 25 mm at -50 mm
Y = np.linspace(-60, 60, 61)
Z = np.where(Y < -35, 25 * np.exp(-(((Y + 50) / 9) ** 2)), 0.0) - 0.05 * Y

DIGITS = 5e-11  # m, rounding of the ten digits written


def assert_is_the_wheel(path: Path, role: str | None = "wheel") -> None:
    raw = read_profile(path, role)
    np.testing.assert_allclose(raw.y, 1e-3 * Y, rtol=0, atol=DIGITS)
    np.testing.assert_allclose(raw.z, 1e-3 * Z, rtol=0, atol=DIGITS)


def test_two_columns_in_mm(write: Write) -> None:
    assert_is_the_wheel(write("w.txt", "# y z\n" + columns(Y, Z)))


def test_two_columns_in_m_with_commas_and_titles(write: Write) -> None:
    text = "y,z\n" + columns(1e-3 * Y, 1e-3 * Z).replace(" ", ",")
    assert_is_the_wheel(write("w.csv", text))


@pytest.mark.parametrize(("unit", "metres"), [("m", 1.0), ("mm", 1e-3), ("in", 0.0254)])
def test_titles_say_the_unit_of_length(write: Write, unit: str, metres: float) -> None:
    for titles in (f"y [{unit}] z [{unit}]", f'"Höhe quer ({unit})" "Höhe ({unit})"'):
        path = write("w.txt", f"{titles}\n" + columns(1e-3 / metres * Y, 1e-3 / metres * Z))
        raw = read_profile(path, "wheel")
        np.testing.assert_allclose(raw.y, 1e-3 * Y, rtol=0, atol=0.0254 * DIGITS / 1e-3)
        assert raw.notes == [f"unit of length {unit}, as its titles say"]
        assert raw.taken.unit == unit
    asked = read_profile(path, "wheel", Reading(unit=unit))
    assert asked.notes == [f"unit of length {unit} as asked"]


def test_weights_are_told(write: Write) -> None:
    rows = columns(Y, Z).splitlines()
    path = write("w.txt", "\n".join(f"{row} {1 + k % 3}" for k, row in enumerate(rows)))
    assert "third column taken as the points' weights, 1 to 3" in read_profile(path, "wheel").notes
    path = write("w.txt", "\n".join(f"{row} 1" for row in rows))
    assert not any("weight" in note for note in read_profile(path, "wheel").notes)


def test_commas_in_comments_tell_nothing_of_the_numbers(write: Write) -> None:
    heading = "% track 12,4 km, 3,5 years, 60E1,1 right\n"
    assert_is_the_wheel(write("w.txt", heading + columns(Y, Z)))
    german = columns(Y, Z).replace(" ", ";").replace(".", ",")
    assert_is_the_wheel(write("w.csv", "# km 1,5\n" + german + "# 2,5 mm beside it, 3,1 km\n"))


def test_z_up_and_flange_at_plus_y_are_detected(write: Write) -> None:
    path = write("w.txt", columns(-Y, -Z))
    assert_is_the_wheel(path)
    assert read_profile(path, "wheel").notes == [
        "unit of length taken as mm",
        "y mirrored: the flange lay at +y",
        "z mirrored: the flange pointed to -z",
    ]


def test_simpack_unit_and_mirror(write: Write) -> None:
    keys = {"units_len_f": "+1.0E+03", "mirror_y": 1, "inversion": 1}
    assert_is_the_wheel(write("w.prw", simpack(columns(-Y, Z), **keys)))


def test_simpack_shift_and_rotation(write: Write) -> None:
    # shift, then rotation: y' = y cos - z sin
    angle = 0.02
    y = Y * np.cos(angle) + Z * np.sin(angle) - 3.0
    z = -Y * np.sin(angle) + Z * np.cos(angle) + 2.0
    keys = {"units_len_f": 1e3, "units_ang_f": 1.0, "shift_y": 3.0, "shift_z": -2.0}
    assert_is_the_wheel(write("w.prw", simpack(columns(y, z), rotate=angle, **keys)))


def test_simpack_rotation_in_degrees(write: Write) -> None:
    degree = 180 / np.pi
    y, z = Y * np.cos(0.02) + Z * np.sin(0.02), -Y * np.sin(0.02) + Z * np.cos(0.02)
    keys = {"units_len_f": 1e3, "units_ang_f": degree, "rotate": 0.02 * degree}
    assert_is_the_wheel(write("w.prw", simpack(columns(y, z), **keys)))


def test_simpack_bounds_comments_and_weights(write: Write) -> None:
    rows = columns(Y, Z).splitlines()
    rows[3] = "!" + rows[3]
    rows[4] = rows[4] + "  0.0"
    rows[5] = rows[5] + "  0.5 ! half"
    keys = {"units_len_f": 1e3, "bound_y_min": -57.0, "bound_y_max": 1e9, "bound_z_min": 1}
    raw = read_profile(write("w.prw", simpack("\n".join(rows) + "\n", bound_z_max=0, **keys)))
    # lower bound: -60, -58 go; comment: -54; weight 0: -52
    np.testing.assert_allclose(1e3 * raw.y[:3], [-56, -50, -48], rtol=0, atol=1e-9)
    np.testing.assert_allclose(raw.weight[:3], [1, 0.5, 1])


def test_simpack_rail_by_header(write: Write) -> None:
    y = np.linspace(-30, 30, 61)
    raw = read_profile(write("r.dat", simpack(columns(y, y**2 / 60), kind=0, units_len_f=1e3)))
    assert raw.role == "rail"
    assert raw.z.max() == pytest.approx(0.015)


def test_miniprof_columns(write: Write) -> None:
    body = "".join(f"{i} {b:.9e} {a:.9e}\n" for i, (a, b) in enumerate(zip(Y, Z, strict=True)))
    text = f"ProgramName=MiniProf\nColumnDef=N,Y,X\nXYPoints={Y.size}\n\n{body}"
    path = write("w.whl", text)
    assert_is_the_wheel(path, None)
    assert read_profile(path).measured


def test_nrc_wheels_and_rollers() -> None:
    """Numbers of the measurements' own headers and rows: z down, flange back at 0, tape line at
    70."""
    wheel = read_profile(NRC["wheel_left"], "wheel")
    assert wheel.y.size == 667
    assert wheel.y[0] == pytest.approx(0.1423e-3)
    assert wheel.notes == ["unit of length taken as mm", "points turned round, to begin at -y"]
    tape = np.interp(0.070, wheel.y, wheel.z)
    assert wheel.z.max() - tape == pytest.approx(27.8749e-3, abs=5e-5)  # Sh of the header
    roller = read_profile(NRC["rail_right"], "rail")
    assert roller.y.size == 329
    assert roller.y[0] == pytest.approx(-38.0143e-3)
    assert roller.z[0] == pytest.approx(51.8192e-3)


@pytest.mark.parametrize(("name", "file"), [("wheel_right", "w.whl"), ("rail_left", "r.ban")])
def test_columns_are_what_the_instruments_file_gives(write: Write, name: str, file: str) -> None:
    """The same curve, smoothed as the instrument's files are by themselves."""
    role = "wheel" if name.startswith("wheel") else "rail"
    raw = read_profile(NRC[name], role)
    path = write(file, miniprof(1e3 * raw.y[::-1], 1e3 * raw.z[::-1]))
    measured = read_profile(path)
    assert (measured.role, measured.measured) == (role, True)
    np.testing.assert_array_equal(measured.y, raw.y)
    np.testing.assert_array_equal(measured.z, raw.z)
    found = fit_profile(raw, NRC["smoothing"])
    expected = fit_profile(measured)
    for key in ("y", "z", "dy", "dz", "arc_length"):
        np.testing.assert_array_equal(getattr(found, key), getattr(expected, key))


def test_measured_and_published_points_become_curves() -> None:
    paths = {**MANCHESTER, **NRC}
    smoothing = paths.pop("smoothing")
    for name, path in paths.items():
        raw = read_profile(path, "wheel" if name.startswith("wheel") else "rail")
        profile = fit_profile(raw, smoothing if "nrc" in path else None)
        assert profile.y.size >= 0.93 * raw.y.size, path
        np.testing.assert_allclose(np.hypot(profile.dy, profile.dz), 1, rtol=0, atol=5e-3)


def test_relative_paths_start_at_the_folder(write: Write, tmp_path: Path) -> None:
    write("w.txt", columns(Y, Z))
    assert load_profile("w.txt", "wheel", folder=tmp_path).y.size == Y.size
