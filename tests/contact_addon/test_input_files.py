"""Input files that the add-on reads itself, cntc_readinpfile, and profiles by slices: its numbers
are those of `railpatch solve` of the same file."""

from __future__ import annotations

import ctypes
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
from inp_parts import WHEEL, text_of, with_profiles
from railpatch.inp.run import solve_file
from railpatch.profiles.turnout import crossing, write_slices

ROOT = Path(__file__).resolve().parents[2]
# `make test-python` builds it
LIBRARY = ROOT / "build" / "release" / "plugins" / "contact_addon" / "contact_addon_linux64.so"


def integers(*values: int):
    return (ctypes.c_int * max(len(values), 1))(*values)


def reals(*values: float):
    return (ctypes.c_double * max(len(values), 1))(*values)


class Addon:
    """The library; messages go to a file."""

    def __init__(self, folder: Path) -> None:
        self.library = ctypes.CDLL(str(LIBRARY))
        self.folder = folder
        version, error = integers(0), integers(-9)
        where = str(folder).encode()
        self.library.cntc_initializefirst(
            version, error, integers(0), where, b" ", b"said",
            integers(len(where)), integers(1), integers(4),
        )  # fmt: skip
        assert error[0] == 0

    def said(self) -> str:
        path = self.folder / "said.out"
        return path.read_text() if path.exists() else ""

    def read(self, ire: int, name: str, kind: int = 1988) -> int:
        error = integers(-9)
        text = name.encode()
        self.library.cntc_readinpfile(
            integers(ire), integers(kind), text, integers(len(text)), error
        )
        return error[0]

    def flags(self, ire: int, **values: int) -> None:
        codes = [int(name[1:]) for name in values]
        count = integers(len(codes))
        self.library.cntc_setflags(
            integers(ire), integers(-1), count, integers(*codes), integers(*values.values())
        )

    def calculate(self, ire: int) -> int:
        error = integers(-9)
        self.library.cntc_calculate(integers(ire), integers(-1), error)
        return error[0]

    def forces(self, ire: int) -> np.ndarray:
        """Force and moment about the rail's marker, on body 2 in SI."""
        self.flags(ire, _1933=1935)
        out = reals(*[0.0] * 24)
        self.library.cntc_getglobalforces(integers(ire), integers(-1), integers(24), out)
        return np.array(out[:])

    def location(self, ire: int, icp: int = 1) -> np.ndarray:
        out = reals(*[0.0] * 38)
        self.library.cntc_getcontactlocation(integers(ire), integers(icp), integers(38), out)
        return np.array(out[:])


@pytest.fixture
def addon(tmp_path: Path) -> Iterator[Addon]:
    found = Addon(tmp_path)
    yield found
    found.library.cntc_finalizelast()


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Profiles, a crossing by slices with features, a wheel out of round."""
    place = with_profiles(tmp_path_factory.mktemp("files"))
    slices = crossing()
    write_slices("crossing", slices, place / "nose")
    rows = [f"{1e3 * part.position!r} 'crossing_{k:02d}.txt'" for k, part in enumerate(slices)]
    rows += [
        f"{1e3 * part.position!r} " + " ".join(repr(1e3 * s) for s in part.features)
        for part in slices
    ]
    head = f"0. 1. % a crossing\n{len(slices)}\n{len(slices[0].features)} 0 0\n1\n"
    (place / "nose" / "crossing.slcs").write_text(head + "\n".join(rows) + "\n")
    points = np.loadtxt(place / "wheel.txt")
    for k, radius in enumerate((0.0, 0.1, 0.25)):
        np.savetxt(place / f"round_{k}.txt", points + np.array([0.0, radius]), fmt="%.9f")
    text = "0 1.\n3\n1\n1\n-90d 'round_2.txt'\n0. 'round_0.txt'\n1.r 'round_1.txt'\n"
    (place / "round.slcw").write_text(text)
    return place


NOSE = {
    "rail": "'nose/crossing.slcs' 0 1. 0. -1",
    "track": "-1. 717.5 0. 0.",
    "position": "240. 0. 80000. 0 0. 0",
}
# changes of one case, each with a block or digit of its own
CASES = {
    "as it is": {},
    "left": {"first": "0203100"},
    "by position": {"first": "1203000", "position": "0 2. 0.4 0 0.1d 0"},
    "force along the track": {"first": "1203110", "velocity": "20000. 0 0 0 0 3000."},
    "torque": {"first": "1203120", "velocity": "20000. 0 0 0 0 -1.2e6"},
    "massless rail": {"first": "1203130", "support": "1000. 50. 0. 0."},
    "roller": {"first": "5203100", "track": "14. 0 1435. 500.", "velocity": "40. 0 0 0 0 -43.48"},
    "deviations": {
        "second": "0022035",
        "deviation": "0.5 -0.2 0.1d 10. 0. 0.",
        "flexibility": "0 1. 0 0.05d 0.02r 0\n0 20. 0 0 0 0",
    },
    "falling friction": {"second": "0422033", "friction": "0.18 0.12 1250. 0. 0. 1e-3 10."},
    "friction by angle": {
        "second": "1022033",
        "friction": "2\n-20d 0.2 0.2\n10d 0.4 0.4",
    },
    "fastsim": {"second": "0022333", "material": "0.28 0.28 82000. 82000. 1 1 1"},
    "layer": {"second": "0022433", "material": "0.28 0.28 82000. 82000. 100. 0.02 0 0"},
    "temperature": {
        "third": "3000211",
        "heat": "20 450 0.05 7.85e-6\n20 450 0.05 7.85e-6",
    },
    "curved surface": {"second": "0042033", "patches": "0.8 0.8 1. 90d 8. 4."},
    "own digits": {"third": "0200211", "solver": "500 60 30 1 1e-5\n1 1 0 1"},
    "rail placed": {"track": "0. 753. 0.1 0.02"},
    "nose": NOSE,
    "wheel by slices": {"wheel": "'round.slcw' 0 1. 0. -1", "position": "0 2. 60000. 0 0 0.7"},
    "both by slices": NOSE
    | {"wheel": "'round.slcw' 0 1. 0. -1", "position": "230. 0. 80000. 0 0. -0.4"},
}


@pytest.mark.parametrize("name", CASES)
def test_files_are_read_as_by_solve(addon: Addon, folder: Path, name: str) -> None:
    path = folder / "case.inp"
    path.write_text(text_of(WHEEL, **CASES[name]))
    (expected,) = solve_file(path)
    assert addon.read(1, str(path)) == 0, addon.said()
    assert addon.calculate(1) == 0, addon.said()
    found = addon.forces(1)
    load = np.linalg.norm(expected.result["force"])
    assert load > 1e4
    assert found[:3] == pytest.approx(expected.result["force"], abs=1e-9 * load)
    patches = expected.result["patches"]
    for k, patch in enumerate(patches):
        place = addon.location(1, k + 1)
        assert place[:3] == pytest.approx(patch["position"], abs=1e-10)
        # the same place by the rail's own axes and marker
        y, z, roll = place[25:28]
        turned = np.array([[np.cos(roll), -np.sin(roll)], [np.sin(roll), np.cos(roll)]])
        assert np.array([y, z]) + turned @ place[5:7] == pytest.approx(place[1:3], abs=1e-9)


def test_files_as_editors_of_windows_save_them(addon: Addon, folder: Path) -> None:
    """A mark of byte order and ends of lines of two characters change nothing."""
    path = folder / "case.inp"
    forces = []
    for mark, end in (("", "\n"), ("\ufeff", "\r\n")):
        path.write_bytes((mark + text_of(WHEEL)).replace("\n", end).encode("utf-8"))
        assert addon.read(1, str(path)) == 0, addon.said()
        assert addon.calculate(1) == 0, addon.said()
        forces.append(addon.forces(1)[:6])
    assert list(forces[0]) == list(forces[1])


def test_arc_lengths_are_those_of_the_slice_that_is_met(addon: Addon, folder: Path) -> None:
    """A place found by the core lies on the profile that the add-on tells."""
    path = folder / "case.inp"
    path.write_text(text_of(WHEEL, **CASES["both by slices"]))
    assert addon.read(1, str(path)) == 0
    assert addon.calculate(1) == 0
    place = addon.location(1)
    for rail, at in ((True, 4), (False, 9)):
        ints = integers(0 if rail else 1, 2)
        count = reals(0.0)
        addon.library.cntc_getprofilevalues(
            integers(1), integers(0), integers(2), ints, integers(1), reals(0.0), integers(1), count
        )
        n = int(count[0])
        values = reals(*[0.0] * (2 * n))
        arcs = reals(*[0.0] * n)
        for task, out in ((1, values), (4, arcs)):
            addon.library.cntc_getprofilevalues(
                integers(1), integers(task), integers(2), ints, integers(1), reals(0.0),
                integers(len(out)), out,
            )  # fmt: skip
        found = [np.interp(place[at + 3], arcs[:], own) for own in (values[:n], values[n:])]
        # the wheel's place is the rail's, which it is pressed into
        assert found == pytest.approx(place[at + 1 : at + 3], abs=0.01 if rail else 0.2)


def test_simpacks_variant_leaves_what_is_the_callers(addon: Addon, folder: Path) -> None:
    """Module 0 or 11: no deviations, position, velocity; C1, P, N, F, H, S, I stay."""
    path = folder / "case.inp"
    path.write_text(text_of(WHEEL))
    assert addon.read(1, str(path)) == 0
    assert addon.calculate(1) == 0
    expected = addon.forces(1)
    short = {"module": "11 MODULE", "deviation": "", "position": "", "velocity": "", "end": "0"}
    (folder / "simpack.inp").write_text(text_of(WHEEL, **short))
    assert addon.read(2, "nothing.inp", 1990) == -39
    assert addon.read(2, str(folder / "simpack.inp"), 1988) == -39
    addon.flags(2, _1933=1935, _1967=1, _1973=1)
    assert addon.read(2, str(folder / "simpack.inp"), 1990) == 0, addon.said()
    six = integers(6)
    addon.library.cntc_setverticalforce(integers(2), reals(6e4))
    addon.library.cntc_setwheelsetposition(
        integers(2), integers(1), six, reals(0, 2e-3, 0, 0, np.radians(0.1), 0)
    )
    addon.library.cntc_setwheelsetvelocity(
        integers(2), integers(2), six, reals(20.0, 0, 0, 0, 0, -43.48)
    )
    assert addon.calculate(2) == 0, addon.said()
    assert addon.forces(2) == pytest.approx(expected, rel=1e-12)


REFUSED = {
    "no such file": (None, "file not found"),
    "module 3": ({"module": "3 MODULE"}, "module 3: allowed 1"),
    "digits": ({"first": "12031000"}, "has too many digits"),
    "a digit": ({"first": "1207100"}, "T = 7: allowed 0 ... 3"),
    "a word": ({"friction": "0.3 none"}, "line 6: FKIN: expected a number, found 'none'"),
    "in its line": (
        {"friction": "0.3 none"},
        "found 'none', in FSTAT FKIN; before it line 5 was read",
    ),
    "a line too few": (
        {"friction": ""},
        "line 9: G2: expected a number, found '90d', in NU1 NU2 G1 G2; before it line 7 was read "
        "as FSTAT FKIN",
    ),
    "kept of nothing": ({"second": "0122033", "friction": ""}, "L = 1 keeps what was"),
    "search kept": ({"second": "0002033", "patches": ""}, "D = 0 keeps what was"),
    "points kept": ({"first": "1203101"}, "S = 1 keeps what was"),
    "track": ({"second": "0022043"}, "Z = 4: allowed 0 ... 3"),
    "blocks": ({"first": "1203103"}, "subs_addblock"),
    "gap weighting": ({"second": "0022033 11"}, "gap weighting"),
    "damping": ({"second": "0022033 2", "heat": "1 1 1 1"}, "M2 = 2"),
    "solver": ({"third": "0700211"}, "G = 7: allowed 0 ... 5"),
    "tolerance": ({"solver": "500 60 30 1 0."}, "MAXGS and EPS are 500 and 0, allowed"),
    "law": ({"second": "0522033"}, "L = 5: allowed"),
    "places": (
        {"second": "1022033", "friction": "2\n1d .3 .3\n0d .3 .3"},
        "angle or s of friction is 0, allowed more than",
    ),
    "two coefficients": ({"friction": "0.3 0.2"}, "FSTAT is 0.3, allowed FKIN (0.2)"),
    "viscoelastic": (
        {"second": "0022133", "material": "0.28 0.28 82000. 82000. 1 1 1 1"},
        "M = 1",
    ),
    "search": ({"second": "0072033"}, "D = 7"),
    "steep": ({"patches": "0.4 0.4 1. 20d 8. 4."}, "A_SEP below 90 degrees"),
    "roller": ({"first": "5203100", "track": "0. 700. 0. 500."}, "GAUGHT <= 0"),
    "tape": ({"wheelset": "1360. -70. 460. 70."}, "YTAPE"),
    "profile": ({"rail": "'none.txt' 0 1. 0."}, "none.txt: file not found"),
    "slices": ({"rail": "'none.slcs' 0 1. 0."}, "none.slcs: file not found"),
    "slices of a wheel": ({"rail": "'round.slcw' 0 1. 0."}, "is read as a rail"),
    "smoothing": ({"rail": "'rail.txt' 0 1. 1."}, "smoothing 0"),
    "ends": (
        {"velocity": "20000. 0", "end": ""},
        "ends where VZ is needed, in VS VY VZ VROLL VYAW VPITCH; before it line",
    ),
}


@pytest.mark.parametrize("name", REFUSED)
def test_what_is_refused_changes_nothing(addon: Addon, folder: Path, name: str) -> None:
    good, bad = folder / "good.inp", folder / "bad.inp"
    good.write_text(text_of(WHEEL))
    assert addon.read(1, str(good)) == 0
    assert addon.calculate(1) == 0
    before = addon.forces(1)
    changes, message = REFUSED[name]
    if changes is None:
        bad.unlink(missing_ok=True)
    else:
        bad.write_text(text_of(WHEEL, **changes))
    assert addon.read(1, str(bad)) == -39
    assert message in addon.said()
    assert addon.calculate(1) == 0
    assert (addon.forces(1) == before).all()
    assert addon.read(1, str(good), 1984) == -39
    assert "type 1984" in addon.said()


GOOD = "0 1.\n2\n1\n1\n0. 'rail.txt'\n100. 'rail.txt'\n"
BAD_SLICES = [
    (GOOD.replace("0 1.", "0 0."), "U_SCALE is 0"),
    (GOOD.replace("\n2\n", "\n0\n"), "NSLC is 0"),
    (GOOD.replace("\n2\n", "\n3\n"), "ends where u is needed"),
    (GOOD.replace("\n1\n1\n", "\n101\n1\n"), "NFEAT is 101"),
    (GOOD.replace("\n1\n1\n", "\n1 1 0\n1\n"), "NKINK has no counterpart"),
    (GOOD.replace("\n1\n1\n", "\n1\n2\n"), "U_INTPOL = 2"),
    (GOOD.replace("\n1\n1\n", "\n2\n1\n") + "0. 1. 2.\n50. 1. 2.\n", "other slices"),
    (GOOD.replace("\n1\n1\n", "\n2\n1\n") + "0. -1. 2.\n100. 1. 2.\n", "S_F is below 0"),
    (GOOD.replace("\n1\n1\n", "\n2\n1\n") + "0. 2. 1.\n100. 1. 2.\n", "that do not fall"),
    (GOOD.replace("100. ", "0. "), "two slices lie at one place"),
    (GOOD.replace("100. 'rail.txt'", "100. rail.txt"), "expected a name"),
    (GOOD.replace("100. 'rail.txt'", "100. 'none.txt'"), "none.txt: file not found"),
]


@pytest.mark.parametrize(("text", "message"), BAD_SLICES)
def test_slices_that_are_refused(addon: Addon, folder: Path, text: str, message: str) -> None:
    (folder / "bad.slcs").write_text(text)
    (folder / "bad.inp").write_text(text_of(WHEEL, rail="'bad.slcs' 0 1. 0. -1"))
    assert addon.read(1, str(folder / "bad.inp")) == -39
    assert message in addon.said()


def damaged(text: bytes, rng: np.random.Generator) -> bytes:
    """With some bytes changed, perhaps cut off."""
    found = bytearray(text)
    for _ in range(rng.integers(1, 4)):
        found[int(rng.integers(len(found)))] = int(rng.integers(256))
    return bytes(found[: int(rng.integers(len(found)))] if rng.random() < 0.3 else found)


def test_damaged_files_have_an_answer(addon: Addon, folder: Path) -> None:
    """Bytes changed at chance: 0 or -39, and the process goes on."""
    rng = np.random.default_rng(22)
    case, slices = folder / "damaged.inp", folder / "damaged.slcw"
    answers = set()
    for _ in range(300):
        case.write_bytes(damaged(text_of(WHEEL, **CASES["deviations"]).encode(), rng))
        answers.add(addon.read(3, str(case)))
    case.write_text(text_of(WHEEL, wheel="'damaged.slcw' 0 1. 0. -1"))
    for _ in range(60):
        slices.write_bytes(damaged((folder / "round.slcw").read_bytes(), rng))
        answers.add(addon.read(3, str(case)))
    assert answers == {0, -39}
