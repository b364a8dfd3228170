"""Which way points lie: turned where a rule is certain, asked for where none is."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
import railpatch
from case_samples import WHEELSET
from profile_files import columns
from railpatch.profiles import ProfileError, builtin_profile, read_profile
from railpatch.profiles.orientation import check_placed, lean
from railpatch.profiles.raw import Reading

Write = Callable[[str, str], Path]
WHEEL, RAIL = ("S1002", "wheel"), ("UIC60@1:40", "rail")


def points(name: str, role: str) -> tuple[np.ndarray, np.ndarray]:
    """mm, half a millimetre apart."""
    profile = builtin_profile(name, role)
    y, z = profile.evaluate(np.arange(profile.arc_length[0], profile.arc_length[-1], 5e-4))
    return 1e3 * y, 1e3 * z


@pytest.mark.parametrize("back", [False, True])
@pytest.mark.parametrize("up", [False, True])
@pytest.mark.parametrize("outwards", [False, True])
def test_a_flange_tells_all(write: Write, back: bool, up: bool, outwards: bool) -> None:
    y, z = points(*WHEEL)
    way = slice(None, None, -1 if back else 1)
    path = write("w.txt", columns((-y if outwards else y)[way], (-z if up else z)[way]))
    raw = read_profile(path, "wheel")
    np.testing.assert_allclose(1e3 * raw.y, y, atol=1e-7)
    np.testing.assert_allclose(1e3 * raw.z, z, atol=1e-7)
    notes = " ".join(raw.notes)
    assert ("flange lay at +y" in notes) == outwards
    assert ("flange pointed to -z" in notes) == up


def test_a_tread_without_a_flange_is_asked_for(write: Write) -> None:
    y, z = points(*WHEEL)
    tread = y > -25
    path = write("w.txt", columns(y[tread], z[tread]))
    with pytest.raises(ProfileError, match=r"shows no flange .* say mirror = 'none'"):
        read_profile(path, "wheel")
    for mirror, sign in (("none", (1, 1)), ("y", (-1, 1)), ("z", (1, -1)), ("yz", (-1, -1))):
        raw = read_profile(path, "wheel", Reading(mirror=mirror))
        way = slice(None, None, sign[0])
        np.testing.assert_allclose(1e3 * raw.y, sign[0] * y[tread][way], atol=1e-7)
        np.testing.assert_allclose(1e3 * raw.z, sign[1] * z[tread][way], atol=1e-7)


@pytest.mark.parametrize("pair", [WHEEL, RAIL])
def test_swapped_columns_are_asked_for(write: Write, pair: tuple[str, str]) -> None:
    y, z = points(*pair)
    path = write("p.txt", columns(z, y))
    with pytest.raises(ProfileError, match="seems to hold z, y in place of y, z"):
        read_profile(path, pair[1])
    raw = read_profile(path, pair[1], Reading(swap=True))
    np.testing.assert_allclose(1e3 * raw.y, y, atol=1e-7)
    assert "columns taken as z, y" in raw.notes


def test_an_inclined_rail_the_wrong_way_round_is_asked_for(write: Write) -> None:
    y, z = points(*RAIL)
    assert lean(1e-3 * y, 1e-3 * z) == pytest.approx(1 / 40, abs=1.1e-3)
    read_profile(write("r.txt", columns(y, z)), "rail")
    path = write("r.txt", columns(-y, z))
    with pytest.raises(ProfileError, match="leans by 1:40 away from the track"):
        read_profile(path, "rail")
    assert read_profile(path, "rail", Reading(mirror="none")).y[0] == pytest.approx(-1e-3 * y[-1])
    turned = read_profile(path, "rail", Reading(mirror="y"))
    np.testing.assert_allclose(1e3 * turned.z, z, atol=1e-7)


def test_an_upright_head_is_taken_as_it_stands(write: Write) -> None:
    for name in ("UIC60", "54E1"):
        y, z = points(name, "rail")
        for way in (1, -1):
            raw = read_profile(write("r.txt", columns(way * y, z)), "rail")
            assert "the gauge side is taken to lie at -y" in raw.notes


def test_crowns_tell_up_by_their_bend(write: Write) -> None:
    y = np.linspace(-20, 20, 81)
    z = y**2 / 600
    for sign in (1, -1):
        raw = read_profile(write("r.txt", columns(y, sign * z)), "rail")
        np.testing.assert_allclose(1e3 * raw.z, z, atol=1e-7)
    with pytest.raises(ProfileError, match="no side of a rail's head"):
        read_profile(write("r.txt", columns(y, 0 * z)), "rail")


def test_a_wheel_named_rail_and_a_rail_named_wheel(write: Write) -> None:
    with pytest.raises(ProfileError, match="has a flange: it seems to be a wheel's"):
        read_profile(write("r.ban", "ColumnDef=X,Y\n" + columns(*points(*WHEEL))))
    with pytest.raises(ProfileError, match=r"it seems to be a rail's|where no flange is"):
        read_profile(write("w.whl", "ColumnDef=X,Y\n" + columns(*points(*RAIL))))


def test_units_are_taken_as_asked(write: Write) -> None:
    y, z = points(*WHEEL)
    path = write("w.txt", columns(y / 25.4, z / 25.4))
    with pytest.raises(ProfileError, match="wrong unit of length"):
        read_profile(path, "wheel")
    raw = read_profile(path, "wheel", Reading(unit="in"))
    np.testing.assert_allclose(1e3 * raw.y, y, atol=1e-6)


@pytest.mark.parametrize(
    "row", ["{};{}", "{}\t{}", "{}  {}", " {} ; {} ;"], ids=["semicolon", "tab", "blanks", "ends"]
)
def test_decimal_commas(write: Write, row: str) -> None:
    y, z = points(*WHEEL)
    text = "".join(
        row.format(f"{a:.6f}".replace(".", ","), f"{b:.6f}".replace(".", ",")) + "\n"
        for a, b in zip(y, z, strict=True)
    )
    raw = read_profile(write("w.csv", "\ufeff" + text), "wheel")
    np.testing.assert_allclose(1e3 * raw.y, y, atol=1e-6)
    assert raw.notes[0] == "decimal commas"


def test_commas_that_may_be_either_are_asked_for(write: Write) -> None:
    text = "".join(f"{a},5,{a},25\n" for a in range(20))
    with pytest.raises(ProfileError, match="commas that may be decimal ones"):
        read_profile(write("w.csv", text), "wheel")


def test_a_wheel_far_from_its_origin_is_asked_for(write: Write) -> None:
    y, z = points(*WHEEL)
    for moved in (100.0, -40.0):
        raw = read_profile(write("w.txt", columns(y + moved, z)), "wheel")
        with pytest.raises(ProfileError, match="or of a file origin"):
            check_placed("w.txt", raw.y, raw.z, -0.07)
        reading = Reading(origin=(1e-3 * moved, 0.0))
        back = read_profile(write("w.txt", columns(y + moved, z)), "wheel", reading)
        check_placed("w.txt", back.y, back.z, -0.07)
        np.testing.assert_allclose(1e3 * back.y, y, atol=1e-7)
    with pytest.raises(ProfileError, match=r"lies 50\.?\d* mm below the nominal radius"):
        check_placed("w.txt", 1e-3 * y, 1e-3 * (z + 50), -0.07)
    check_placed("w.txt", 1e-3 * y, 1e-3 * z, -0.07)


def test_a_rail_cut_above_the_gauge_is_refused(write: Write) -> None:
    """At 7 mm beside its middle such a rail met the wheel with 2522 MPa in place of 1403."""
    y, z = points(*RAIL)
    case = {**WHEELSET, "profiles": {"wheel": "S1002", "rail": "rail.txt"}}
    for depth in (10.0, 15.0):
        kept = (z - z.min() <= depth) | (y > 0)
        path = write("rail.txt", columns(y[kept], z[kept]))
        if depth < 14:
            with pytest.raises(ProfileError, match=r"below its top .*track\.gauge_height, 14 mm"):
                railpatch.Contact(case, folder=path.parent)
        else:
            railpatch.Contact(case, folder=path.parent)
