"""Where a wheel's flange says that it lies: S1002's dimensions of EN 13715, moved."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
import railpatch
from case_samples import WHEELSET, with_values
from railpatch.profiles import load_profile
from railpatch.profiles.pairing.contact_points import Dimensions, pair_case
from railpatch.profiles.placement import flange_of, gauge_note

Write = Callable[[str, str], Path]


def wheel(write: Write, dy: float, dz: float, *, back: bool = True) -> Path:
    """S1002 moved by m, with or without the back of its flange."""
    profile = load_profile("S1002", "wheel")
    keep = np.ones(profile.y.size, bool) if back else profile.arc_length > 0.02
    rows = zip(profile.y[keep] + dy, profile.z[keep] + dz, strict=True)
    return write("own.csv", "".join(f"{1e3 * y:.7f} {1e3 * z:.7f}\n" for y, z in rows))


def solved(path: Path) -> railpatch.Result:
    case = pair_case(path, "UIC60@1:40", Dimensions(), None, {})
    case["wheelset"]["vertical_force"] = 8e4
    case["grid"] = {"elements": [10, 10]}
    return railpatch.solve(case)


def test_dimensions_of_s1002() -> None:
    profile = load_profile("S1002", "wheel")
    flange = flange_of(profile.y, profile.z, -0.07)
    assert flange is not None
    # EN 13715, S1002 with a flange 28 mm high
    assert flange.thickness == pytest.approx(32.5e-3, abs=2e-5)
    assert flange.height == pytest.approx(28e-3, abs=2e-5)
    assert flange.back == pytest.approx(-0.07, abs=2e-5)
    assert flange.tread == pytest.approx(0.0, abs=1e-6)
    assert flange.doubts(-0.07) == []
    cone = load_profile("cone@1:20", "wheel")
    assert flange_of(cone.y, cone.z, -0.07) is None


@pytest.mark.parametrize(
    ("dy", "dz", "back", "words"),
    [
        (0.0, 0.0, True, None),
        (1e-3, 1e-3, True, None),
        (3e-3, 0.0, True, "flange back lies at y = -66.99 mm of the points"),
        (-4e-3, 0.0, True, "flange back lies at y = -74 mm of the points"),
        (6e-3, 0.0, False, "flange is 38."),
        (0.0, 6e-3, True, "tread datum, 70 mm from the flange back, lies 6 mm below"),
        (0.0, -5e-3, False, "lies -5 mm below wheelset.nominal_radius"),
    ],
)
def test_a_wheel_moved_is_doubted(
    dy: float, dz: float, back: bool, words: str | None, write: Write
) -> None:
    result = solved(wheel(write, dy, dz, back=back))
    if words is None:
        assert result.warnings == []
    else:
        assert any(words in text for text in result.warnings), result.warnings
        assert all(text.startswith("own.csv: ") for text in result.warnings)
    [note] = [text for text in result["profiles"]["own.csv"] if "origin" in text]
    assert "flange back at y = -70.0 mm" in note
    if back:
        assert f"both {1360 + 2e3 * dy:.1f} mm apart" in note
    assert f"tread datum {1e3 * dz:.0f}." in note or dy != 0.0 or dz < 0


def test_a_rail_says_where_it_is_held(write: Write) -> None:
    profile = load_profile("UIC60", "rail")
    moved = profile.y + 4e-3
    # UIC 861-3: a head 72 mm wide
    assert "gauge side, at y = -32.0 mm" in gauge_note(moved, profile.z - 6e-3, 0.014)
    text = "".join(f"{1e3 * y:.6f} {1e3 * z:.6f}\n" for y, z in zip(moved, profile.z, strict=True))
    case = pair_case("S1002", write("r.dat", text), Dimensions(), None, {})
    notes = railpatch.solve(case)["profiles"]["r.dat"]
    assert any("its gauge side, at y = -32.0 mm" in note for note in notes), notes


@pytest.mark.parametrize(
    ("drop", "origin", "said"), [(2e-3, False, 1), (2e-3, True, 0), (4e-4, False, 0)]
)
def test_heights_of_slices_that_are_not_read(
    drop: float, origin: bool, said: int, write: Write
) -> None:
    """Of two slices along the rail, one lower, whose origin is not said."""
    rail = load_profile("UIC60@1:40", "rail")
    sections = []
    for k, z in enumerate((rail.z, rail.z + drop)):
        text = "".join(f"{1e3 * a:.7f} {1e3 * b:.7f}\n" for a, b in zip(rail.y, z, strict=True))
        sections.append({"position": float(k), "profile": str(write(f"slice_{k}.txt", text))})
    case = with_values(
        WHEELSET,
        kind="wheel_rail",
        profiles={"wheel": "S1002"},
        track__right={"sections": sections, **({"origin": [0.7505, 0.0]} if origin else {})},
        wheelset__z=None,
        wheelset__vertical_force=6e4,
        grid={"element_size": [1e-3, 1e-3]},
    )
    warnings = railpatch.solve(case).warnings
    found = [text for text in warnings if text.startswith("track.right.sections: ")]
    assert len(found) == said, warnings
    for text in found:
        assert "z = 0.00 to 2.00 mm of their files" in text
        assert "track.right.origin" in text
