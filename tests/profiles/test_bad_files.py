"""Broken profile files: the error names file, line and what is wrong."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest
from railpatch.profiles import ProfileError, load_profile, read_profile

Write = Callable[[str, str], Path]
GOOD = "".join(f"{y} {0.02 * y * y}\n" for y in range(-30, 31))
LINES = GOOD.splitlines()
# a stylus that goes over the profile there and back, over the same points
THERE_AND_BACK = "\n".join(LINES + LINES[::-1])
TIMED = "".join(f"{0.9 * y:g} {0.02 * y * y} {0.1 * (y + 30):g}\n" for y in range(-30, 31))
SIMPACK = f"header.begin\ntype=0\nheader.end\nspline.begin\nunits.len.f=1e3\npoint.begin\n{GOOD}"


@pytest.mark.parametrize(
    ("name", "text", "line", "words"),
    [
        ("a.txt", "", None, "is empty"),
        ("a.txt", " \n\n", None, "is empty"),
        ("a.txt", "# only a comment\n", None, "holds no points"),
        ("a.txt", GOOD + "1.0 nan\n", 62, "value nan is not finite"),
        ("a.txt", GOOD + "inf 1.0\n", 62, "value inf is not finite"),
        ("a.txt", GOOD + "31\n", 62, "expected 2 numbers, found '31'"),
        ("a.txt", "0 0\n" + "\x01\x02garbage\n", 2, "expected numbers"),
        ("a.txt", "Wheel 3; 12.03.2024\ny;z\n" + GOOD, 1, "before them one line of titles"),
        ("a.txt", "y [m];z [m]\n" + GOOD, None, "60 m wide"),
        ("a.txt", THERE_AND_BACK, 2, "the points turn back at"),
        ("a.txt", TIMED, None, "a third column that goes from 0 to 6 without a turn"),
        ("a.txt", "0 0\n1 1\n2 2\n", None, "holds 3 points, needs 5"),
        ("a.txt", "0 0\n" * 9, None, "0 m wide"),
        ("a.txt", GOOD.replace("-30 18.0", "-3000 18.0"), None, "3.03 m wide"),
        ("a.txt", GOOD.replace("1 0.02\n", "1 0.02 -1\n", 1), 30, "weight -1.0 is negative"),
        ("a.ban", GOOD, 1, ""),
        ("a.ban", "ColumnDef=X,Y\nXYPoints=62\n" + GOOD, None, "61 points, its header says"),
        ("a.ban", "ColumnDef=A,B\n" + GOOD, None, "names no columns X and Y"),
        ("a.ban", "ColumnDef=X,Y\n" + GOOD + "Key=1\n", 63, "among the points"),
        ("a.prr", GOOD, None, "is no SIMPACK profile"),
        ("a.prr", SIMPACK, None, "is cut off: 'point.end' is missing"),
        ("a.prr", SIMPACK.replace("type=0", "type=1"), None, "is a wheel profile by its header"),
        ("a.prr", SIMPACK.replace("type=0", "type"), 2, "expected 'key = value'"),
        ("a.prr", SIMPACK.replace("1e3", "-1") + "point.end\nspline.end", 5, "allowed > 0"),
        ("a.prr", SIMPACK.replace("1e3", "mm") + "point.end\nspline.end", 5, "expected numbers"),
        ("a.whl", GOOD, None, "is a wheel profile by its extension"),
    ],
)
def test_broken_files(write: Write, name: str, text: str, line: int | None, words: str) -> None:
    path = write(name, text)
    if name == "a.ban" and text == GOOD:
        # content decides: columns without a header are read as columns
        assert read_profile(path).y.size == 61
        return
    if name == "a.prr" and "type=1" in text:
        text += "point.end\nspline.end\n"
        path.write_text(text)
    with pytest.raises(ProfileError) as caught:
        load_profile(str(path), "rail")
    assert words in str(caught.value)
    where = str(path) if line is None else f"{path}:{line}"
    assert str(caught.value).startswith(f"{where}: ")
    assert caught.value.line == line


def test_missing_and_binary_files(tmp_path: Path) -> None:
    with pytest.raises(ProfileError, match="file not found"):
        load_profile("absent.txt", "rail", folder=tmp_path)
    with pytest.raises(ProfileError, match="file not found"):
        load_profile(".", "rail", folder=tmp_path)
    (tmp_path / "b.ban").write_bytes(bytes(range(256)))
    with pytest.raises(ProfileError, match="is not a text file"):
        load_profile("b.ban", "rail", folder=tmp_path)


def test_columns_need_a_role(write: Write) -> None:
    with pytest.raises(ProfileError, match="say whether"):
        read_profile(write("a.txt", GOOD))
