"""Input files of CONTACT: cases that come of them, sequences, commands; damaged files."""

from __future__ import annotations

import json
import random
from pathlib import Path

import numpy as np
import pytest
import railpatch
from click.testing import CliRunner
from inp_parts import BASIC, WHEEL, tables_of, text_of, with_profiles
from railpatch.command.cli import cli
from railpatch.errors import CaseError
from railpatch.inp.files import convert, read_cases
from railpatch.inp.run import solve_file
from railpatch.inp.words import number_of
from scipy.io import loadmat


@pytest.fixture(scope="module")
def folder(tmp_path_factory) -> Path:
    return with_profiles(tmp_path_factory.mktemp("inp"))


def test_numbers_in_any_form():
    assert [number_of(text) for text in ("1e-5", "1d-5", "-.5", "+2.", "3D2")] == [
        1e-5,
        1e-5,
        -0.5,
        2.0,
        300.0,
    ]
    assert number_of("90d", angle=True) == pytest.approx(np.pi / 2)
    assert number_of("90d0", angle=True) == 90.0
    assert number_of("1.5radians", angle=True) == number_of("1.5r", angle=True) == 1.5
    assert [number_of(text) for text in ("90d", "x", "1e999", "1_0", "nan")] == [None] * 5


def test_modules_patches_and_what_is_kept(folder):
    """Two patches by turns, each with its own data; cases that are read but not computed."""
    one = text_of(BASIC, module="3 1 1", third="0000213", end="")
    other = text_of(BASIC, module="3 1 2", motion="900. 0 0 0", end="")
    again = "3 1 1\n203100\n100000\n0100211\n700. 0 0 0\n0\n"
    found = read_cases("x.inp", one + other + again)
    assert [(case.number, case.patch) for case in found] == [(2, (1, 2)), (3, (1, 1))]
    assert found[1].blocks["motion"]["FN"] == 700.0
    assert found[1].blocks["friction"] == found[1].blocks["friction"] | {"L": 0}
    tables = tables_of(folder, one + other + again, case=1)
    assert tables["friction"]["coefficient"] == 0.35


def test_a_case_that_does_not_end_its_module(folder):
    """R = 0: the next case has no line MODULE. Who writes one is told of R."""
    text = text_of(BASIC, third="0000210", end="") + text_of(BASIC)
    with pytest.raises(CaseError, match=r"x.inp, line \d+: .*HGIAOWR of the case before, R, has"):
        read_cases("x.inp", text)


def test_a_mark_of_byte_order_and_names_in_capitals(tmp_path):
    """As editors of Windows save files."""
    text = "\ufeff" + text_of(BASIC).replace("\n", "\r\n")
    (tmp_path / "A.INP").write_bytes(text.encode("utf-8"))
    listed = CliRunner().invoke(cli, ["convert", str(tmp_path), "--list"])
    assert listed.output.splitlines() == ["A.INP: case 1: patch"]


SHIFT = text_of(BASIC, first="201100", rolling="", motion="1000. -0.0004 0. 0.", end="")
ROLLS = "3 MODULE\n002100\n102000\n0130211\n1000. -0.0012 0. 0.\n"
ROLLS += "0d 0.6 15000.\n0.28 0.28 82000. 82000.\n"
GOES_ON = "3 MODULE\n001100\n100000\n0130211\n1000. -0.0008 0. 0.\n0 MODULE\n"


def test_a_sequence_is_one_contact(folder):
    path = folder / "shift.inp"
    path.write_text(SHIFT + GOES_ON)
    steps = solve_file(path)
    assert [one.converted.begins for one in steps] == [1, 1]
    out = folder / "shift"
    done = CliRunner().invoke(cli, ["convert", str(path), "-o", str(out)])
    assert done.exit_code == 0, done.output
    (written,) = done.output.split()
    whole = railpatch.solve(written).to_dict()
    second = steps[1].result.to_dict()
    assert whole["creep_force"] == second["creep_force"]
    assert abs(second["creep_force"][0]) > abs(steps[0].result.to_dict()["creep_force"][0])
    # a load that changes is no steps of one file, but is solved
    path.write_text(SHIFT + GOES_ON.replace("1000.", "1100."))
    done = CliRunner().invoke(cli, ["convert", str(path), "-o", str(folder / "none")])
    assert done.exit_code == 2
    assert "whose load changes" in done.output
    assert not (folder / "none").exists()
    assert len(solve_file(path)) == 2


def test_the_programs_own_test(folder):
    """The ellipse of CONTACT's test of its library, by a file: what that prints."""
    ellipse = text_of(
        BASIC,
        first="203000",
        motion="0.05 0.001 0. 0.0004",
        friction="0.3 0.3",
        rolling="0. 0.5 24000.",
        potcon="-3",
        grid=f"21 33 4.25 7. {21 / 17!r}",
        distance="",
    )
    path = folder / "ellipse.inp"
    path.write_text(ellipse)
    (found,) = solve_file(path)
    theirs = found.in_contact()
    # of body 1, in mm; the library's test prints those of body 2, in m
    values = theirs["FN"], -theirs["FX"], -theirs["FY"], -1e-3 * theirs["MZ"]
    assert values == pytest.approx((42083.1, 4883.3, 4617.4, 23.7), abs=0.06, rel=1e-5)
    assert theirs["PMAX"] == pytest.approx(675.4, abs=0.05)
    assert (theirs["CKSI"], theirs["CPHI"]) == pytest.approx((0.001, 0.0004))


def test_a_shift_is_told_in_mm(folder: Path, tmp_path: Path) -> None:
    """What the file gives is what is told: CKSI, CETA in mm, CPHI in rad; slip of elements too: of
    a shift far beyond friction all elements slip by it, less what the elastic bodies take."""
    path = folder / "far.inp"
    path.write_text(
        text_of(BASIC, first="201100", rolling="", motion="1000. 0.1 0.04 0.002", end="0 MODULE")
    )
    (found,) = solve_file(path, fields=True)
    theirs = found.in_contact()
    told = theirs["CKSI"], theirs["CETA"], theirs["CPHI"]
    assert told == pytest.approx((0.1, 0.04, 0.002), rel=1e-12)
    assert theirs["VELOC"] is None
    slip = np.array(theirs["sx"])[np.array(theirs["pn"]) > 0]
    assert 0.05 < np.abs(slip).mean() < 0.11
    # and as a file of ours, also of a history, of its last step
    out = tmp_path / "shift"
    done = CliRunner().invoke(cli, ["convert", str(path), "-o", str(out)])
    assert done.exit_code == 0, done.output
    file = done.output.split()[0]
    ran = CliRunner().invoke(cli, ["solve", file, "--signs", "contact"])
    (ours,) = json.loads(ran.stdout)
    told = ours["CKSI"], ours["CETA"], ours["CPHI"]
    assert told == pytest.approx((0.1, 0.04, 0.002), rel=1e-12)
    path.write_text(SHIFT + ROLLS + ROLLS + "0 MODULE\n")
    done = CliRunner().invoke(cli, ["convert", str(path), "-o", str(tmp_path / "rolls")])
    ran = CliRunner().invoke(cli, ["solve", done.output.split()[0], "--signs", "contact"])
    assert ran.exit_code == 0, ran.output
    (ours,) = json.loads(ran.stdout)
    assert (ours["CKSI"], ours["VELOC"]) == pytest.approx((-0.0012, 15000.0), rel=1e-12)
    last = solve_file(path)[-1].in_contact()
    assert last.pop("MZ") == pytest.approx(ours.pop("MZ"), abs=1e-12)
    assert {**ours, "case": 3} == last


def test_a_list_tells_steps_of_one_contact(folder: Path) -> None:
    """And why no file has them all, as `convert` does."""
    path = folder / "steps.inp"
    path.write_text(SHIFT + ROLLS + "0 MODULE\n")
    listed = CliRunner().invoke(cli, ["convert", str(path), "--list"])
    assert listed.exit_code == 0
    assert listed.output.splitlines() == [
        f"steps.inp: case {k}: patch, step {k} of 2 of the contact of case 1" for k in (1, 2)
    ]
    path.write_text(SHIFT + ROLLS.replace("1000. -0.0012", "1100. -0.0012") + "0 MODULE\n")
    listed = CliRunner().invoke(cli, ["convert", str(path), "--list"])
    made = CliRunner().invoke(cli, ["convert", str(path), "-o", str(folder / "steps")])
    assert listed.exit_code == made.exit_code == 2
    said = "a sequence whose load changes has no counterpart in a file"
    assert said in listed.output.splitlines()[0]
    assert said in made.output


def test_an_own_grid_off_the_origin(folder):
    """Spin and moment are about the file's origin: the same contact on a grid that reaches further
    on one side has the same moment."""
    both = []
    for grid in ("24 20 -7.2 -4.8 0.6 0.48", "30 20 -10.8 -4.8 0.6 0.48"):
        path = folder / "grid.inp"
        path.write_text(text_of(BASIC, grid=grid))
        (found,) = solve_file(path)
        both.append(found.in_contact())
    for key in ("FX", "FY", "MZ", "CKSI", "CETA"):
        assert both[0][key] == pytest.approx(both[1][key], rel=1e-4, abs=1e-9), key


def test_commands(folder, tmp_path):
    good, bad = folder / "good", folder / "bad"
    for place in (good, bad):
        place.mkdir()
    (good / "a.inp").write_text(text_of(BASIC))
    (bad / "a.inp").write_text(text_of(BASIC))
    (bad / "b.inp").write_text(text_of(BASIC, first="243100"))
    (bad / "c.inp").write_text("3 MODULE\nx")
    (bad / "d.inp").write_text(text_of(WHEEL))
    run = CliRunner()
    listed = run.invoke(cli, ["convert", str(bad), "--list"])
    assert listed.exit_code == 2
    lines = listed.output.splitlines()
    assert lines[0] == "a.inp: case 1: patch"
    assert "b.inp, line 2, case 1: B = 4 (SDEC) has no counterpart" in lines[1]
    assert "c.inp, line 2" in lines[2]
    assert "d.inp: case 1: d.inp: the profile 'wheel.txt' is not there: " in lines[3]
    assert run.invoke(cli, ["convert", str(good), "--list"]).exit_code == 0
    refused = run.invoke(cli, ["convert", str(bad / "b.inp"), "-o", str(tmp_path / "out")])
    assert refused.exit_code == 2
    assert not (tmp_path / "out").exists()
    assert run.invoke(cli, ["convert", str(good / "a.inp")]).exit_code == 2
    mat = tmp_path / "a.mat"
    solved = run.invoke(
        cli, ["solve", str(good / "a.inp"), "--signs", "contact", "--mat", str(mat)]
    )
    assert solved.exit_code == 0, solved.output
    (case,) = json.loads(solved.output)
    assert "pn" not in case
    stored = loadmat(mat, simplify_cells=True)["case1"]
    assert stored["FN"] == case["FN"]
    assert stored["pn"].shape == (20, 24)
    area = 0.6 * 0.48
    assert area * stored["pn"].sum() == pytest.approx(case["FN"], rel=1e-6)
    assert area * stored["px"].sum() == pytest.approx(case["FX"], rel=1e-6)
    plain = run.invoke(cli, ["solve", str(good / "a.inp"), "--json"])
    (ours,) = json.loads(plain.output)
    assert -ours["creep_force"][0] == case["FX"]


def test_a_wheel_is_solved(folder):
    path = folder / "wheel.inp"
    path.write_text(text_of(WHEEL))
    (found,) = solve_file(path, fields=True)
    theirs = found.in_contact()
    assert theirs["status"] == "converged"
    assert theirs["FZ_TR"] == pytest.approx(60000.0, rel=1e-4)
    out = folder / "wheel"
    done = CliRunner().invoke(cli, ["convert", str(path), "-o", str(out)])
    assert done.exit_code == 0, done.output
    again = railpatch.solve(out / "case_001.toml").to_dict()
    assert again["force"] == found.result.to_dict()["force"]
    assert (out / "wheel.txt").is_file()


def damaged(rng: random.Random, texts: list[str]) -> str:
    """A file with some letters changed, lost, doubled, or its end missing."""
    letters = list(rng.choice(texts))
    for _ in range(rng.choice((1, 1, 2, 4, 10))):
        at, how = rng.randrange(len(letters)), rng.random()
        if how < 0.3:
            letters[at] = rng.choice("0123456789.-+eEdr'%=, \n\tx*")
        elif how < 0.5:
            del letters[at : at + rng.randrange(1, 30)]
        elif how < 0.7:
            letters.insert(at, rng.choice("0123456789.-' \n") * rng.randrange(1, 6))
        elif how < 0.85:
            letters[at:at] = letters[: rng.randrange(20)]
        else:
            letters = letters[:at]
        letters = letters or ["0"]
    return "".join(letters)


def try_damaged(folder: Path, seed: int, count: int) -> tuple[int, int]:
    """Files read, and refused."""
    rng = random.Random(seed)
    texts = [text_of(BASIC), text_of(WHEEL), SHIFT + GOES_ON]
    read = refused = 0
    path = folder / "damaged.inp"
    for _ in range(count):
        text = damaged(rng, texts)
        path.write_text(text)
        try:
            found = convert(path)
        except CaseError:
            refused += 1
            continue
        assert all((one.tables is None) != (one.refused is None) for one in found), text
        read += 1
    return read, refused


def test_damaged_files_are_read_or_refused(folder):
    read, refused = try_damaged(folder, 11, 300)
    assert min(read, refused) > 20


@pytest.mark.long
def test_ten_thousand_damaged_files(folder):
    read, refused = try_damaged(folder, 12, 10_000)
    print(f"\n{read} read, {refused} refused")
    assert read + refused == 10_000


def test_signs_of_a_case_without_friction(tmp_path: Path) -> None:
    """T = 0: the normal problem alone has no creep force and no spin moment."""
    case = tmp_path / "normal.inp"
    case.write_text(text_of(BASIC, first="200100", rolling="", motion="1000. 0. 0. 0."))
    ran = CliRunner().invoke(cli, ["solve", str(case), "--signs", "contact"])
    assert ran.exit_code == 0, ran.output
    (found,) = json.loads(ran.stdout)
    assert found["FN"] == pytest.approx(1000.0, rel=1e-9)
    assert found["FX"] is found["FY"] is found["MZ"] is None
