"""[damage] and [subsurface] of a case: laws, balances, and every way to ask for them."""

from __future__ import annotations

import json
import math
from typing import Any

import numpy as np
import pytest
from railpatch import CaseError, Contact, solve, solve_many
from railpatch.case.asked import Damage
from railpatch.damage.distribution import Distribution
from railpatch.damage.laws import archard, fatigue_index, usfd, whole_life
from railpatch.damage.patch import damage_of

WHEELSET = {
    "kind": "wheelset",
    "wheelset": {"y": 0.003, "yaw": 3e-3, "vertical_force": 120e3, "roll": "balanced",
                 "speed": 20.0, "pitch_rate": -20 / 0.46, "nominal_radius": 0.46,
                 "flange_back_distance": 1.36, "flange_back_position": -0.07},
    "track": {"kind": "rail", "gauge": 1.435, "gauge_height": 0.014},
    "profiles": {"wheel": "S1002", "rail": "UIC60@1:40"},
    "friction": {"coefficient": 0.3},
}  # fmt: skip


def patch(**tables: Any) -> dict[str, Any]:
    """A rolling circle with slip and spin."""
    return {
        "kind": "patch",
        "geometry": {"semi_axes": [0.006, 0.006]},
        "material": {"poisson_ratio": 0.3},
        "load": {"normal_force": 8e4},
        "grid": {"elements": [24, 24]},
        "motion": {"creepage": [2e-3, -5e-4], "spin_creepage": 0.5, "rolling_speed": 10.0},
        "friction": {"coefficient": 0.3},
        **tables,
    }


def test_law_of_work_by_its_published_numbers() -> None:
    """Lewis and Dwyer-Joyce (2004), ug/(m mm^2) by N/mm^2; the last branch goes on from 55.0.

    1 ug/(m mm^2) is 1e-3 kg/m^3.
    """
    found = 1e3 * usfd(np.array([0.0, 5.0, 10.4, 10.5, 77.2, 78.2, 100.0]) * 1e6, Damage())
    wanted = [0.0, 26.5, 55.12, 55.0, 55.0, 55.0 + 61.9, 55.0 + 61.9 * 22.8]
    np.testing.assert_allclose(found, wanted, rtol=1e-12)


def test_law_of_pressure_and_slip() -> None:
    """k p s density/H in each region, and seizure above 0.8 H whatever the speed."""
    law = Damage()
    for slip, coefficient in ((0.01, 5.5e-4), (0.03, 3.5e-3), (0.1, 5.5e-4)):
        rate = archard(1e9, slip, 10.0, law)
        assert rate == pytest.approx(7850 * coefficient * 1e9 * slip / 2.6e9, rel=1e-12)
    assert archard(2.2e9, 0.1, 10.0, law) == pytest.approx(7850 * 3.5e-2 * 2.2e9 * 0.1 / 2.6e9)


def test_laws_of_fatigue() -> None:
    """FI_surf of Hertz's pressure is f - k/p0: by a, b and the load too; the whole-life points."""
    law = Damage()
    a, b, p0 = 6e-3, 4e-3, 1.5e9
    load = 2 / 3 * math.pi * a * b * p0
    wanted = 0.25 - 2 * math.pi * a * b * 300e6 / (3 * load)
    assert fatigue_index(0.25, p0, law) == pytest.approx(wanted, rel=1e-12)
    found = [whole_life(x, law) for x in (0, 15, 40, 65, 120, 175, 230)]
    np.testing.assert_allclose(found, [0, 0, 5e-6, 1e-5, 5e-6, 0, -5e-6], atol=1e-18)


@pytest.mark.parametrize("direction", [1, -1])
def test_work_of_elements(direction: int) -> None:
    """Sums to the friction power before it is scaled, better with finer elements, and after."""
    errors = []
    for count in (12, 24, 48):
        case = patch(grid={"elements": [count, count]}, damage={})
        case["motion"] = {**case["motion"], "direction": direction}
        result = solve(case, fields=True)
        found = result["damage"]
        errors.append(abs(found["work_scale"] - 1))
        area = np.diff(result["x"])[0] * np.diff(result["y"])[0]
        work = found["fields"]["work"].sum() * area
        assert work * 10.0 == pytest.approx(result["friction_power"], rel=1e-12)
        # mass: the law of each element's work, summed
        wear = usfd(found["fields"]["work"], Damage()).sum() * area
        assert found["wear_rate"] == pytest.approx(wear, rel=1e-12)
    assert errors[0] > errors[1] > errors[2]
    assert errors[1] < 0.02


@pytest.mark.parametrize("shape", [(1, 12), (12, 1), (2, 12), (12, 2), (1, 1), (2, 2)])
@pytest.mark.parametrize("wear", ["usfd", "archard"])
def test_work_of_narrow_grids(shape: tuple[int, int], wear: str) -> None:
    """Rows by columns; by the elements the work is the friction's there too, also where all stick:
    then friction works as material leaves the contact."""
    y, x = ((np.arange(n) - (n - 1) / 2) * 6e-4 for n in shape)
    gap = 1.0 * x**2 + 1.5 * y[:, None] ** 2
    case = patch(grid={"element_size": [6e-4, 6e-4]}, damage={"wear": wear})
    case |= {"geometry": {"undeformed_distance": gap.tolist()}, "load": {"normal_force": 1e3}}
    case["motion"] = {"creepage": [1e-4, 0.0], "rolling_speed": 10.0}
    result = solve(case, fields=True)
    work = result["damage"]["fields"]["work"]
    power = work.sum() * 6e-4**2 * 10.0
    assert power == pytest.approx(result["friction_power"], rel=1e-9)
    assert power > 0
    if shape == (2, 2):
        assert result["elements"]["slip"] == 0
        assert not work[:, 1].any()  # rolling to +x, material leaves on the other side


@pytest.mark.parametrize("tangential", ["fastsim", "fastrip"])
def test_work_of_fast_theories_is_what_their_forces_take(tangential: str) -> None:
    """In steady rolling nothing else supplies it: -(F . creepage + M spin) by metre rolled."""
    case = patch(method={"tangential": tangential}, damage={})
    case["motion"] = {**case["motion"], "creepage": [1e-3, 5e-4], "spin_creepage": 0.4}
    result = solve(case, fields=True)
    taken = np.dot(result["creep_force"], case["motion"]["creepage"])
    taken += result["spin_moment"] * case["motion"]["spin_creepage"]
    area = np.diff(result["x"])[0] * np.diff(result["y"])[0]
    work = result["damage"]["fields"]["work"].sum() * area
    assert work == pytest.approx(-taken, rel=1e-12)


def test_mild_wear_is_proportional_to_work() -> None:
    """With all work in the first branch both bases give 5.3e-9 kg/J of it, whatever the shape."""
    motion = {"creepage": [2e-4, 0.0], "rolling_speed": 10.0}
    for basis in ("elements", "patch"):
        result = solve(patch(motion=motion, damage={"basis": basis}))
        work = result["friction_power"] / 10.0
        assert result["damage"]["wear_rate"] == pytest.approx(5.3e-9 * work, rel=1e-6)


@pytest.mark.parametrize("basis", ["elements", "patch"])
@pytest.mark.parametrize("wear", ["usfd", "archard"])
def test_mass_over_the_profiles(wear: str, basis: str) -> None:
    """What is laid over wheel and rail is the patches' mass, to 1e-9, and where they are."""
    case = {**WHEELSET, "damage": {"wear": wear, "basis": basis}}
    contact = Contact(case)
    result = contact.step()
    way, wanted = 12.5, 0.0
    for side in ("left", "right"):
        found = Distribution()
        for share, rows in contact.wear_rows()[side]:
            found.add(rows, way, share)
        wanted = way * result[side]["damage"]["wear_rate"]
        for body in ("wheel", "rail"):
            assert found.mass(body) == pytest.approx(wanted, rel=1e-9)
            assert abs(found.outside[body]) < 1e-9 * wanted
            depth = found.depth(body, 7850.0, 2.0)
            laid = depth.sum() * (found.y[1] - found.y[0]) * 7850.0 * 2.0
            assert laid == pytest.approx(wanted, rel=1e-9)
            at = result[side]["patches"][0][f"{body}_profile_position"][0]
            assert found.y[depth.argmax()] == pytest.approx(at, abs=4e-3)


def test_distributions_take_numbers_alone() -> None:
    """By name."""
    contact = Contact({**WHEELSET, "damage": {}})
    contact.step()
    ((share, rows), *_) = contact.wear_rows()["left"]
    found = Distribution()
    for way in (np.nan, np.inf, -1.0):
        with pytest.raises(CaseError, match=r"way: value is .*, allowed >= 0 and finite"):
            found.add(rows, way, share)
    for wrong in (np.nan, -0.1, 1.1):
        with pytest.raises(CaseError, match=r"share: value is .*, allowed 0 to 1"):
            found.add(rows, 1.0, wrong)
    assert found.mass("wheel") == 0
    with pytest.raises(CaseError, match="body: value is 'roller', allowed 'wheel', 'rail'"):
        found.mass("roller")
    for density, length in ((np.nan, 1.0), (7850.0, 0.0), (-7850.0, 1.0)):
        with pytest.raises(CaseError, match=r"(density|length): value is .*, allowed > 0"):
            found.depth("wheel", density, length)


def test_wear_does_not_depend_on_the_number_of_sub_steps() -> None:
    """A wheelset that moves from 2 to 3 mm: mass by 8 and by 16 steps within 2 % (0.1 % here)."""
    masses = []
    for count in (8, 16):
        contact = Contact({**WHEELSET, "damage": {}})
        mass = 0.0
        for y in 2e-3 + 1e-3 * (np.arange(count) + 0.5) / count:
            mass += contact.step(y=float(y))["damage"]["wear_rate"] / count
        masses.append(mass)
    assert masses[1] == pytest.approx(masses[0], rel=1e-3)


def test_left_and_right_wear_alike() -> None:
    """The mirror image lays the same wear over the profiles of the other side."""
    mirrored = {**WHEELSET["wheelset"], "y": -0.003, "yaw": -3e-3}
    contacts = [Contact({**WHEELSET, "damage": {}}) for _ in range(2)]
    contacts[0].step()
    contacts[1].step(**{key: mirrored[key] for key in ("y", "yaw")})
    for one, other in (("left", "right"), ("right", "left")):
        found = [Distribution(), Distribution()]
        for k, side in enumerate((one, other)):
            for share, rows in contacts[k].wear_rows()[side]:
                found[k].add(rows, 1.0, share)
        np.testing.assert_allclose(
            found[0].wheel, found[1].wheel, atol=1e-12 * found[0].wheel.max()
        )
        np.testing.assert_allclose(found[0].rail, found[1].rail, atol=1e-12 * found[0].rail.max())


def test_stresses_of_a_case() -> None:
    """Circle without friction, nu = 0.3: 0.310 p0 at 0.48 a (Johnson 1985, section 4.2)."""
    case = patch(grid={"elements": [64, 64]}, subsurface={"depths": [1e-3, 0.48 * 6e-3, 5e-3]})
    case["motion"] = {"regime": "none"}
    del case["friction"]
    found = solve(case)
    below = found["subsurface"]
    assert below["depth"] == [1e-3, 0.48 * 6e-3, 5e-3]
    assert below["max_shear"][1] == pytest.approx(0.310 * found["max_pressure"], rel=5e-3)
    assert max(below["max_shear"]) == below["max_shear"][1]


@pytest.mark.parametrize("fitted", [False, True])
def test_stresses_with_fields_and_points(fitted: bool) -> None:
    """Lists are the greatest of the fields; points are the fields' own elements."""
    grid = {"fitted": [12, 12]} if fitted else {"elements": [12, 12]}
    result = solve(patch(grid=grid, subsurface={"depths": [5e-4, 2e-3], "body": "wheel"}), True)
    below = result["subsurface"]
    fields = below["fields"]
    assert fields["stress"].shape == (6, 2, len(fields["y"]), len(fields["x"]))
    np.testing.assert_allclose(below["von_mises"], fields["von_mises"].max(axis=(1, 2)))
    np.testing.assert_allclose(below["max_shear"], fields["greatest_shear"].max(axis=(1, 2)))
    j, i = 5, 7
    at = [fields["x"][i], fields["y"][j], 2e-3]
    case = patch(grid=grid, subsurface={"depths": [2e-3], "body": "wheel", "points": [at]})
    stress = solve(case)["subsurface"]["points"]["stress"][0]
    scale = np.abs(fields["stress"]).max()
    # fitted rows: fields are laid on a uniform grid, points take the rows' nodes themselves
    bound = 2e-2 if fitted else 1e-6
    wanted = fields["stress"][:, 1, j, i]
    np.testing.assert_allclose(stress, wanted, rtol=0, atol=bound * scale)


def test_a_wheelset_has_the_greatest_of_its_patches() -> None:
    """As JSON, by wheel and in all."""
    case = {**WHEELSET, "subsurface": {"depths": [1e-4, 2e-4, 5e-4]}, "damage": {}}
    result = json.loads(json.dumps(solve(case).to_dict()))
    sides = [result[side] for side in ("left", "right")]
    for name in ("max_shear", "von_mises", "dang_van"):
        lists = [patch["subsurface"][name] for side in sides for patch in side["patches"]]
        np.testing.assert_allclose(result["subsurface"][name], np.max(lists, axis=0))
    assert result["damage"]["wear_rate"] == pytest.approx(
        sum(side["damage"]["wear_rate"] for side in sides)
    )
    assert "pressure" not in sides[0]["patches"][0]


def test_nothing_touches() -> None:
    """No contact: null, not zero."""
    case = patch(load={"normal_force": 0.0}, subsurface={"depths": [1e-3]}, damage={})
    found = solve(case).to_dict()
    assert found["subsurface"] is None
    assert found["damage"] is None


@pytest.mark.parametrize(
    ("tables", "text"),
    [
        ({"subsurface": {"depths": [-1e-3]}}, "subsurface.depths"),
        ({"subsurface": {"depths": []}}, "subsurface.depths"),
        ({"subsurface": {"depths": [1e-3]}, "method": {"tangential": "polach"}}, "subsurface"),
        ({"damage": {}, "method": {"tangential": "polach"}}, "damage.basis"),
        ({"damage": {}, "grid": {"fitted": [8, 8]}}, "damage.basis"),
        ({"damage": {"wear": "krause"}}, "damage.wear"),
        ({"damage": {"usfd_limits": [80.0, 10.0]}}, "damage.usfd_limits"),
        ({"damage": {"archard_map": [[0.1, 1e-3]]}}, "damage.archard_map"),
        ({"damage": {}, "motion": {"regime": "shift", "creepage": [1e-6, 0.0]}}, "damage"),
    ],
    ids=str,
)
def test_refused_by_name(tables: dict[str, Any], text: str) -> None:
    """The error names the key."""
    with pytest.raises(CaseError, match=text):
        solve(patch(**tables))


def test_slip_of_each_element_wears() -> None:
    """As the creepage that it stands for; what goes by the wear number, which has creepages alone,
    is refused or not there."""
    x = (np.arange(16) - 7.5) * 6e-4
    gap = 1.0 * x**2 + 1.5 * x[:, None] ** 2
    plain = patch(grid={"element_size": [6e-4, 6e-4]}, damage={})
    plain |= {"geometry": {"undeformed_distance": gap.tolist()}, "load": {"normal_force": 5e3}}
    plain["motion"] = {"creepage": [1e-3, 0.0], "rolling_speed": 10.0}
    field = {**plain, "motion": {"creepage": [0.0, 0.0], "rolling_speed": 10.0}}
    field["motion"]["slip_field"] = [[[1e-3] * 16] * 16, [[0.0] * 16] * 16]
    wanted, found = (solve(case)["damage"] for case in (plain, field))
    assert found["wear_rate"] == pytest.approx(wanted["wear_rate"], rel=1e-9)
    assert wanted["whole_life_damage"] is not None
    assert found["whole_life_damage"] is None
    with pytest.raises(CaseError, match=r"damage.basis: value is 'patch', allowed 'elements'"):
        solve({**field, "damage": {"basis": "patch"}})


def test_refused_where_results_are_not_of_a_contact() -> None:
    """Many states at once have no such tables."""
    with pytest.raises(CaseError, match="damage"):
        solve_many(patch(damage={}), {"spin_creepage": [0.1, 0.2]})


def test_every_constant_counts() -> None:
    """Each key changes a number of the law that reads it."""
    plain = {law: solve(patch(damage={"wear": law}))["damage"] for law in ("usfd", "archard")}
    for law, keys in {
        "usfd": {"usfd_rate": 5e-9, "usfd_limits": [1e6, 2e6],
                 "worn_density": 7800.0, "shear_yield": 250e6, "basis": "patch",
                 "whole_life": [[1.0, 0.0], [100.0, 1e-5]]},
        "archard": {"hardness": 2.5e9, "archard_map": [[0.0, 1e-4]], "seizure_pressure": 0.1,
                    "worn_density": 7800.0},
    }.items():  # fmt: skip
        for key, value in keys.items():
            found = solve(patch(damage={"wear": law, key: value}))["damage"]
            assert found != plain[law], key
    low = {"usfd_limits": [1e5, 2e5]}
    assert (
        solve(patch(damage={**low, "usfd_slope": 5e-8}))["damage"]
        != (solve(patch(damage=low))["damage"])
    )
    assert (
        solve(patch(damage={**low, "usfd_plateau": 0.05}))["damage"]
        != (solve(patch(damage=low))["damage"])
    )
    hot = {"wear": "archard", "seizure_pressure": 0.1}
    assert (
        solve(patch(damage={**hot, "seizure_coefficient": 1e-2}))["damage"]
        != (solve(patch(damage=hot))["damage"])
    )


def test_a_left_wheel_by_hand() -> None:
    """Rows of a left patch go against its s, of a right one along it."""
    result = solve(WHEELSET, fields=True)
    law = Damage(basis="patch")
    for side in ("left", "right"):
        one = result[side]["patches"][0]
        _, rows = damage_of(one, law, 0.46, left=side == "left", direction=1, speed=20.0)
        slope = np.diff(rows["wheel"])[0] / np.diff(rows["s"])[0]
        sign = -1 if side == "left" else 1
        assert slope == pytest.approx(sign * math.cos(one["contact_angle"]), rel=1e-9)


@pytest.mark.parametrize("creepage", [0.05, -0.05])
def test_a_line_in_full_slip_against_its_closed_form(creepage: float) -> None:
    """Johnson (1985), section 4.2 and 7.1: elliptic pressure and traction q = +-mu p, moving.

    200 elements; stresses within 1e-4 of p0 (what is imposed: full slip to 1e-6 of the force).
    """
    case = patch(
        geometry={"line_contact_radius": 0.5, "width": 1.0},
        load={"normal_force": 2e6},
        grid={"elements": [200, 1]},
        motion={"creepage": [creepage, 0.0], "rolling_speed": 10.0},
        subsurface={"depths": [1e-3, 3e-3, 6e-3]},
    )
    result = solve(case, fields=True)
    assert result["elements"]["stick"] == 0
    peak = result["max_pressure"]
    a = 2 * 2e6 / (math.pi * peak)
    fields = result["subsurface"]["fields"]
    x, z = fields["x"][None, :], np.array(fields["depth"])[:, None]
    root = np.sqrt((a**2 - x**2 + z**2) ** 2 + 4 * x**2 * z**2)
    m = np.sqrt((root + a**2 - x**2 + z**2) / 2)
    n = np.sign(x) * np.sqrt((root - a**2 + x**2 - z**2) / 2)
    k = (z**2 + n**2) / (m**2 + n**2)
    along = -peak / a * (m * (1 + k) - 2 * z)
    down = -peak / a * m * (1 - k)
    shear = -peak / a * n * (m**2 - z**2) / (m**2 + n**2)
    # the rail is pushed where the wheel slips to
    mu = 0.3 * np.sign(creepage)
    along_by_traction = mu * peak / a * (n * (2 - (z**2 - m**2) / (m**2 + n**2)) - 2 * x)
    stress = fields["stress"][:, :, 0, :]
    for found, wanted in (
        (stress[0], along + along_by_traction),
        (stress[2], down + mu * shear),
        (stress[5], shear + mu * along),
    ):
        np.testing.assert_allclose(found, wanted, rtol=0, atol=1e-4 * peak)


@pytest.mark.parametrize(
    ("keys", "words"),
    [
        ({"usfd_limits": [10.4, 77.2]}, "0 or >= 1000 Pa: 10.4 N/mm^2 are 10.4e6"),
        ({"usfd_rate": 5.3}, "damage.usfd_rate: value is 5.3, allowed <= 0.0001"),
        ({"usfd_plateau": 55.0}, "damage.usfd_plateau: value is 55.0, allowed <= 5"),
    ],
)
def test_constants_in_other_units_are_refused(keys: dict[str, Any], words: str) -> None:
    with pytest.raises(CaseError) as caught:
        solve(patch(damage=keys))
    assert words in str(caught.value)
