"""The add-on with CONTACT's calls, through drivers in C and Fortran that link with it alone: its
numbers are those of railpatch.solve, and those that CONTACT's own test programs print."""

from __future__ import annotations

import ctypes
import re
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
import railpatch
from addon_inputs import write_inputs
from profile_files import columns, simpack
from published_data import MANCHESTER, numbers
from railpatch.profiles import Reading, load_profile
from railpatch.published import read_numbers

HERE = Path(__file__).resolve().parent
ROOT = HERE.parents[1]
ADDON = ROOT / "plugins" / "contact_addon"
# `make test-python` builds it
LIBRARY = ROOT / "build" / "release" / "plugins" / "contact_addon" / "contact_addon_linux64.so"
LINK = [f"-L{LIBRARY.parent}", f"-l:{LIBRARY.name}", f"-Wl,-rpath,{LIBRARY.parent}", "-lm"]


def parsed(*command: object) -> dict[str, float]:
    """What a driver prints."""
    done = subprocess.run([str(word) for word in command], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    rows = (line.split() for line in done.stdout.splitlines())
    return {name: float(value) for name, value in rows}


@pytest.fixture(scope="module")
def made(tmp_path_factory):
    """Both drivers, the benchmark's profiles and positions."""
    folder = tmp_path_factory.mktemp("contact_addon")
    strict = ["-std=c11", "-pedantic", "-Wall", "-Wextra", "-Werror", f"-I{ADDON / 'include'}"]
    c = ["gcc", *strict, HERE / "driver.c", "-o", folder / "in_c", *LINK]
    module = ADDON / "include" / "contact_addon.f90"
    fortran = ["gfortran", "-std=f2018", "-Wall", "-Werror", "-J", folder, module]
    fortran += [HERE / "driver.f90", "-o", folder / "in_fortran", *LINK]
    for command in (c, fortran):
        done = subprocess.run([str(word) for word in command], capture_output=True, text=True)
        assert done.returncode == 0, done.stderr
    files, positions = write_inputs(folder)
    return folder, files, positions


@pytest.fixture(scope="module")
def basic(made):
    return parsed(made[0] / "in_c", "basic", made[0])


@pytest.fixture(scope="module")
def wheels(made):
    folder, files, positions = made
    return parsed(folder / "in_c", "wheels", files["rail"], files["wheel"], positions, folder)


def test_fortran_gives_the_same(made, basic, wheels):
    folder, files, positions = made
    found = parsed(folder / "in_fortran", "basic", folder)
    found |= parsed(
        folder / "in_fortran", "wheels", files["rail"], files["wheel"], positions, folder
    )
    both = basic | wheels
    assert len(found) > 3000
    # but for what its compiler makes of a sum and of the given distances
    for name, value in found.items():
        assert both[name] == pytest.approx(value, rel=1e-9, abs=1e-12), name


# printed by the program's own test of basic contacts: Fn, Fx, Fy (N), Mz (N m)
PRINTED = {
    "first": (42083.1, 4883.3, 4617.4, 23.7),
    "second": (42083, 2374.7, 1433.2, 10.2),
    "third": (19563, 1251.4, -405.2, -2.3),
    "fourth": (42083.1, 4883.3, 4617.4, 23.7),
}


def test_basic_contacts_are_those_of_contact(basic):
    """To the last digit printed and the solvers' tolerances, 1e-4 and 1e-5."""
    for name, printed in PRINTED.items():
        found = [basic[f"{name}.{key}"] for key in ("fn", "fx", "fy", "mz")]
        assert found == pytest.approx(printed, abs=0.1, rel=2e-5), name
    assert basic["first.pmax"] == pytest.approx(675.4e6, abs=0.05e6)
    errors = [basic[f"{name}.error"] for name in PRINTED]
    assert errors == [0, 14, 0, 0]  # 14 elements in contact at the grid's edge


def spreads(x, y, c0, c1):
    return [[c0 * u * u + c1 * v * v for u in x] for v in y]


def patch(distance, size, load, creepage, spin, **more):
    return {
        "kind": "patch",
        "material": {"shear_modulus": 82e9, "poisson_ratio": 0.28},
        "geometry": {"undeformed_distance": distance},
        "load": load,
        "grid": {"element_size": size},
        "motion": {"creepage": creepage, "spin_creepage": spin, "rolling_speed": 24.0},
        "method": {"spin_offset": "sixth", "max_iterations": 999, **more.pop("method", {})},
        **more,
    }


def same_numbers(found, name, result, moved=(0.0, 0.0)):
    pairs = {
        "fn": result["normal_force"],
        "fx": result["creep_force"][0],
        "fy": result["creep_force"][1],
        # about the origin of the caller's grid, not its middle
        "mz": result["spin_moment"]
        + moved[0] * result["creep_force"][1]
        - moved[1] * result["creep_force"][0],
        "pmax": result["max_pressure"],
        "area": result["contact_area"],
        "pen": result["approach"],
        "stick": result["elements"]["stick"],
        "slipping": result["elements"]["slip"],
        "plastic": result["elements"]["plastic"],
    }
    for key, value in pairs.items():
        assert found[f"{name}.{key}"] == pytest.approx(value, rel=1e-9), f"{name}.{key}"


def test_basic_contacts_are_those_of_solve(basic):
    """The ellipse with its curvatures as the add-on says them; a grid off the origin, whose spin
    then turns about another point than the grid's middle."""
    a, b, scale = 0.00425, 0.007, 21 / 17
    size = [2 * scale * a / 21, 2 * scale * b / 33]
    x, y = (size[k] * (np.arange(n) - (n - 1) / 2) for k, n in ((0, 21), (1, 33)))
    c0, c1 = basic["first.hertz0"], basic["first.hertz1"]
    steel = {"friction": {"coefficient": 0.3}, "method": {"tolerance": 1e-4}}
    case = patch(spreads(x, y, c0, c1), size, {"approach": 5e-5}, [-1e-3, 0.0], -0.4, **steel)
    same_numbers(basic, "first", railpatch.solve(case).to_dict())
    ellipse = case | {"geometry": {"semi_axes": [a, b]}, "grid": {"element_size": size}}
    result = railpatch.solve(ellipse).to_dict()
    assert basic["first.fn"] == pytest.approx(result["normal_force"], rel=1e-5)
    assert basic["first.fx"] == pytest.approx(result["creep_force"][0], rel=1e-4)
    size = [5e-4, 5e-4]
    x, y = (-0.00725 + 5e-4 * (np.arange(n) + 0.5) for n in (23, 33))
    moved = (x[0] + x[-1]) / 2, (y[0] + y[-1]) / 2
    polach = {
        "friction": {
            "law": "slip_velocity",
            "kinetic": 0.18,
            "amplitude": 0.12,
            "halving_speed": 1.25,
            "memory_distance": 1e-6,
            "memory_speed": 0.01,
        },
        "layer": {"thickness": 1e-5, "shear_modulus": 1e8},
    }
    layer = {"thickness": 1e-5, "shear_modulus": 100e6}
    polach["layer"] = layer
    for name, force, spin in (("second", 42083.0, -0.4), ("third", 19563.0, 0.3)):
        creepage = [-1e-3 - spin * moved[1], spin * moved[0]]
        case = patch(
            spreads(x, y, 1.214, 0.5731), size, {"normal_force": force}, creepage, spin, **polach
        )
        same_numbers(basic, name, railpatch.solve(case).to_dict(), moved)


def test_wheels_are_those_of_solve(made, wheels):
    """Every third position, both sides: forces, places, moments about both markers."""
    _, files, _ = made
    for side in ("left", "right"):
        case = {
            "kind": "wheel_rail",
            "material": {"shear_modulus": 82e9, "poisson_ratio": 0.28},
            "wheelset": {
                "vertical_force": 1e4,
                "speed": 2.0,
                "nominal_radius": 0.46,
                "flange_back_distance": 1.36,
                "flange_back_position": -0.07,
            },
            "track": {"gauge": 1.435, "gauge_height": 0.014},
            "profiles": {
                "wheel": str(files["wheel"]),
                "rail": str(files["rail"]),
                "smoothing": 0.0,
            },
            "wheel": {"side": side},
            "grid": {"element_size": [2e-4, 2e-4]},
            "friction": {"coefficient": 0.3},
            "method": {
                "patch_rule": "contact",
                "spin_offset": "sixth",
                "standstill_speed": 0.0,
                "max_iterations": 999,
            },
        }
        rows = numbers("manchester_a22_right.csv")
        for k in range(0, 21, 3):
            row = rows[k]
            case["wheelset"] |= {
                "y": 1e-3 * row["y_ws_mm"],
                "roll": row["roll_rad"],
                "yaw": row["yaw_rad"],
                "pitch_rate": row["pitch_rate_rad_s"],
            }
            result = railpatch.solve(case).to_dict()
            compare_wheel(wheels, f"{side}{k}", result, case)


def compare_wheel(found, name, result, case):
    force, moment = np.array(result["force"]), np.array(result["moment"])
    on_rail = [found[f"{name}.force{i}"] for i in range(24)]
    bounds = {"rel": 1e-7, "abs": 1e-6 * 1e4}
    assert on_rail[:3] == pytest.approx(-force, **bounds)
    assert found[f"{name}.patches"] == len(result["patches"])
    place = [found[f"{name}.1.place{i}"] for i in range(38)]
    patch = result["patches"][0]
    assert place[:3] == pytest.approx(1e3 * np.array(patch["position"]), rel=1e-7, abs=1e-6)
    assert place[3] == pytest.approx(patch["contact_angle"], rel=1e-7)
    assert found[f"{name}.1.cksi"] == pytest.approx(-patch["creepage"][0], rel=1e-7)
    assert found[f"{name}.1.cphi"] == pytest.approx(-1e-3 * patch["spin_creepage"], rel=1e-7)
    assert found[f"{name}.1.fy"] == pytest.approx(-patch["creep_force"][1], rel=1e-7, abs=1e-3)
    # moment about a marker, from that about the wheelset's centre
    centre = np.array([0.0, case["wheelset"]["y"], result["z"] - 0.46])
    rail = np.array([0.0, 1e-3 * place[25], 1e-3 * place[26]])
    about_rail = -1e3 * (moment - np.cross(rail - centre, force))
    assert on_rail[3:6] == pytest.approx(about_rail, rel=1e-7, abs=1e-2)
    wheel = 1e-3 * np.array(place[20:23])
    turned = wheelset_axes(case["wheelset"]["roll"], case["wheelset"]["yaw"])
    about_wheel = -1e3 * turned.T @ (moment - np.cross(wheel - centre, force))
    assert on_rail[9:12] == pytest.approx(about_wheel, rel=1e-7, abs=1e-2)
    assert on_rail[6:9] == pytest.approx(-turned.T @ force, **bounds)


def wheelset_axes(roll, yaw):
    c, s, d, t = np.cos(roll), np.sin(roll), np.cos(yaw), np.sin(yaw)
    return np.array([[d, -t, 0], [c * t, c * d, -s], [s * t, s * d, c]])


def test_wheels_are_those_of_contact(wheels):
    """Published and printed numbers, both sides: forces within 0.03 % of the wheel's load where the
    contact is smooth (bounds as in published/test_manchester.py elsewhere)."""
    printed = {"left0": (0.3, -36.2), "left1": (887.1, -2582.0), "right1": (-880.0, -2015.0)}
    for name, pair in printed.items():
        assert [wheels[f"{name}.force{i}"] for i in (0, 1)] == pytest.approx(pair, abs=0.15)
    for k, row in enumerate(numbers("manchester_a22_right.csv")):
        close = 3.0 if row["y_ws_mm"] != 5.0 else 100.0  # there two areas touch
        found = wheels[f"right{k}.1.fn"], wheels[f"right{k}.1.fx"]
        assert found == pytest.approx((row["normal_force_N"], row["force_x_N"]), abs=5 * close)
        assert wheels[f"right{k}.1.pmax"] == pytest.approx(row["max_pressure_MPa"], rel=5e-3)


def test_only_the_interface_is_visible():
    header = (ADDON / "include" / "contact_addon.h").read_text()
    declared = set(re.findall(r"CNTC_API void (\w+)\(", header))
    shown = subprocess.run(
        ["nm", "-D", "--defined-only", LIBRARY], capture_output=True, text=True, check=True
    )
    assert {line.split()[-1] for line in shown.stdout.splitlines()} == declared
    assert len(declared) == 70
    used = subprocess.run(["readelf", "-d", LIBRARY], capture_output=True, text=True, check=True)
    needed = re.findall(r"NEEDED.*\[(.+)\]", used.stdout)
    assert all(re.match(r"lib(c|m|pthread|dl)\.so|ld-linux", name) for name in needed), needed


def test_fortran_module_is_the_header():
    sys.path.insert(0, str(ADDON / "include"))
    try:
        import fortran
    finally:
        sys.path.pop(0)
    header = (ADDON / "include" / "contact_addon.h").read_text()
    assert (ADDON / "include" / "contact_addon.f90").read_text() == fortran.module(header)


def integers(*values):
    return (ctypes.c_int * max(len(values), 1))(*values)


def reals(*values):
    return (ctypes.c_double * max(len(values), 1))(*values)


def profile_of(library, ire, path, role, smoothing, mirror_z=0):
    """Knots (y, z, arc length) in m as the add-on reads a file; None where it refuses it."""
    kind = 0 if role == "rail" else 1
    name = str(path).encode()
    length = 1e3 * smoothing
    library.cntc_setprofileinputfname(
        integers(ire), name, integers(len(name)), integers(6),
        integers(kind, 0, 0, mirror_z, 0, 2), integers(2), reals(1.0, length),
    )  # fmt: skip
    answer = reals(9.0, 9.0)

    def values(task, count):
        out = reals(*[0.0] * count)
        ints = integers(kind, 0)
        library.cntc_getprofilevalues(
            integers(ire), integers(task), integers(2), ints, integers(1), reals(0.0),
            integers(count), out,
        )  # fmt: skip
        return np.array(out[:])

    library.cntc_getprofilevalues(
        integers(ire), integers(-1), integers(2), integers(kind, 0), integers(1), reals(0.0),
        integers(2), answer,
    )  # fmt: skip
    if answer[0] != 0:
        return None
    count = int(values(0, 1)[0])
    both = 1e-3 * values(1, 2 * count)
    return both[:count], both[count:], 1e-3 * values(4, count)


def profile_cases(folder):
    """Files of every format, with their keys: role, path."""
    found = []
    for body, kind in (("wheel", "prw"), ("rail", "prr")):
        rows = read_numbers(MANCHESTER[body])
        y, z = (np.array([row[key] for row in rows]) for key in ("y_mm", "z_mm"))
        role = "wheel" if kind == "prw" else "rail"
        plain = folder / f"plain_{body}.txt"
        plain.write_text(
            "y, z\n# mm\n"
            + "\n".join(f"{u!r};{v!r}" for u, v in zip(y.tolist(), z.tolist(), strict=True))
        )
        turned = folder / f"turned_{body}.txt"
        turned.write_text(
            "\n".join(
                f"{u!r} {-v!r} 1.0" for u, v in zip(y[::-1].tolist(), z[::-1].tolist(), strict=True)
            )
        )
        mini = folder / f"mini_{body}.{'whl' if role == 'wheel' else 'ban'}"
        rows = "\n".join(f"{u!r},{-v!r}" for u, v in zip(y.tolist(), z.tolist(), strict=True))
        mini.write_text(f"ProfileType=x\nColumnDef=X,Y\nXYPoints={len(y)}\n{rows}\n")
        keys = {"units_len_f": "1.0E+03", "shift_y": 1.25, "shift_z": -0.5, "rotate": 0.01}
        keyed = folder / f"keyed_{body}.{kind}"
        keyed.write_text(simpack(columns(y, z), kind=int(role == "wheel"), **keys))
        found += [(role, path) for path in (plain, turned, mini, keyed)]
    return found


def test_profiles_are_read_as_in_python(tmp_path):
    """The add-on has a reader of its own, as its callers hand over names of files."""
    library = ctypes.CDLL(str(LIBRARY))
    for role, path in profile_cases(tmp_path):
        for smoothing in (0.0, 0.002):
            expected = load_profile(path, role, smoothing=smoothing, reading=Reading(unit=None))
            got = profile_of(library, 7, path, role, smoothing)
            assert got is not None, path
            wanted = expected.y, expected.z, expected.arc_length
            for mine, theirs in zip(got, wanted, strict=True):
                np.testing.assert_allclose(mine, theirs, rtol=0, atol=2e-15, err_msg=str(path))
    damaged = tmp_path / "damaged.prr"
    damaged.write_text("header.begin\n type = 0\nheader.end\nspline.begin\npoint.begin\n1 x\n")
    missing = tmp_path / "none.prr"
    for path in (damaged, missing):
        assert profile_of(library, 7, path, "rail", 0.0) is None
    library.cntc_finalizelast()
