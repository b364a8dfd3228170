"""Files of slices, .slcs along the track and .slcw round the wheel, of input files."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from inp_parts import WHEEL, tables_of, text_of, with_profiles
from railpatch import CaseError, Contact
from railpatch.inp.files import convert
from railpatch.inp.profiles import read_slices
from railpatch.inp.run import solve_file
from railpatch.inp.written import plan, write_cases
from railpatch.profiles.turnout import crossing, write_slices

SLICED = {
    "rail": "'nose/crossing.slcs' 0 1. 0. -1",
    "track": "-1. 717.5 0. 0.",
    "position": "240. 0. 80000. 0 0. 0",
}


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Profiles, and a crossing by slices in a folder of its own."""
    place = with_profiles(tmp_path_factory.mktemp("slices"))
    slices = crossing()
    write_slices("crossing", slices, place / "nose")
    (place / "nose" / "crossing.slcs").write_text(file_of(slices))
    return place


def file_of(slices: list, *, scale: float = 1.0) -> str:
    """By the grammar; u in mm over scale."""
    count = len(slices[0].features)
    lines = ["% a crossing", f"50. {scale} % U_OFFSET U_SCALE"]
    lines += [f"{len(slices)}", f"{count} 0 0", "1"]
    us = [(1e3 * part.position - 50.0) / scale for part in slices]
    lines += [f"{u!r} 'crossing_{k:02d}.txt'" for k, u in enumerate(us)]
    for u, part in zip(us, slices, strict=True):
        lines.append(f"{u!r} {' '.join(repr(1e3 * s) for s in part.features)}")
    return "\n".join(lines) + "\n"


def test_slices_are_sections(folder: Path) -> None:
    tables = tables_of(folder, text_of(WHEEL, **SLICED))
    sections = tables["track"]["right"]["sections"]
    expected = crossing()
    for found, part in zip(sections, expected, strict=True):
        assert found["position"] == pytest.approx(part.position, abs=1e-12)
        assert found["features"] == pytest.approx(part.features, abs=1e-12)
    assert tables["track"]["right"]["origin"] == [0.7175, 0.0]
    assert tables["track"]["section_blend"] == "cubic"
    assert "rail" not in tables["profiles"]


def test_solved_as_it_is_and_converted(folder: Path, tmp_path: Path) -> None:
    path = folder / "case.inp"
    path.write_text(text_of(WHEEL, **SLICED))
    (solved,) = solve_file(path)
    assert solved.result.status == "converged"
    # on the way from the wing rail to the nose
    assert len(solved.result["patches"]) == 2
    (written,) = write_cases(plan(convert(path), path), path, tmp_path / "out")
    alone = Contact(written)
    assert alone.step()["force"] == solved.result["force"]
    files = plan(convert(path), path)
    gone = (folder / "nose" / "crossing_03.txt").rename(folder / "nose" / "gone.txt")
    with pytest.raises(CaseError, match="is not there"):
        write_cases(files, path, tmp_path / "again")
    gone.rename(folder / "nose" / "crossing_03.txt")


def test_another_scale_is_the_same_track(folder: Path) -> None:
    place = folder / "nose" / "backwards.slcs"
    place.write_text(file_of(crossing(), scale=-2.0))
    found = read_slices(place, "rail")
    expected = read_slices(folder / "nose" / "crossing.slcs", "rail")
    assert [one.file for one in found] == [one.file for one in expected]
    assert [one.place for one in found] == pytest.approx([one.place for one in expected])


def test_a_wheel_by_slices(folder: Path) -> None:
    rows = np.loadtxt(folder / "wheel.txt")
    for k, radius in enumerate((0.0, 0.1, 0.25)):
        np.savetxt(folder / f"round_{k}.txt", rows + np.array([0.0, radius]), fmt="%.9f")
    text = "0 1.\n3\n1\n1\n-90d 'round_2.txt'\n0. 'round_0.txt'\n1.r 'round_1.txt'\n"
    (folder / "round.slcw").write_text(text)
    tables = tables_of(folder, text_of(WHEEL, wheel="'round.slcw' 0 1. 0. -1"))
    sections = tables["wheelset"]["right"]["sections"]
    angles = [section["angle"] for section in sections]
    assert angles == pytest.approx([0.0, 1.0, 1.5 * np.pi])
    assert [section["profile"] for section in sections] == [f"round_{k}.txt" for k in range(3)]
    contact = Contact(tables, folder=folder)
    radius = [contact.step(pitch=angle)["rolling_radius"] for angle in angles]
    assert np.diff(radius) == pytest.approx([1e-4, 1.5e-4], abs=2e-7)


GOOD = "0 1.\n2\n1\n1\n0. 'rail.txt'\n100. 'rail.txt'\n"


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (GOOD.replace("0 1.", "0 0."), "line 1: U_SCALE is 0|U_SCALE is 0"),
        (GOOD.replace("\n2\n", "\n0\n"), "NSLC is 0, allowed 1"),
        (GOOD.replace("\n2\n", "\n3\n"), "ends where u is needed"),
        (GOOD.replace("\n1\n1\n", "\n101\n1\n"), "NFEAT is 101"),
        (GOOD.replace("\n1\n1\n", "\n1 1 0\n1\n"), "NKINK has no counterpart"),
        (GOOD.replace("\n1\n1\n", "\n1 0 2\n1\n"), "NACCEL has no counterpart"),
        (GOOD.replace("\n1\n1\n", "\n1\n2\n"), "U_INTPOL = 2 has no counterpart"),
        (GOOD.replace("\n1\n1\n", "\n2\n1\n") + "0. 1. 2.\n50. 1. 2.\n", "other slices"),
        (GOOD.replace("\n1\n1\n", "\n2\n1\n") + "0. -1. 2.\n100. 1. 2.\n", "S_F is below 0"),
        (GOOD.replace("100. 'rail.txt'", "100. rail.txt"), "expected a name"),
        (GOOD.replace("100. ", "0. "), "positions that increase"),
    ],
)
def test_what_is_refused(folder: Path, text: str, message: str) -> None:
    (folder / "bad.slcs").write_text(text)
    with pytest.raises(CaseError, match=message):
        tables_of(folder, text_of(WHEEL, rail="'bad.slcs' 0 1. 0. -1"))


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"rail": "'none.slcs' 0 1. 0. -1"}, "none.slcs"),
        ({"rail": "'nose/crossing.slcw' 0 1. 0. -1"}, "as a rail has no counterpart"),
        ({"wheel": "'nose/crossing.slcs' 0 1. 0. -1"}, "as a wheel has no counterpart"),
    ],
)
def test_which_files(folder: Path, changes: dict[str, str], message: str) -> None:
    with pytest.raises(CaseError, match=message):
        tables_of(folder, text_of(WHEEL, **changes))
