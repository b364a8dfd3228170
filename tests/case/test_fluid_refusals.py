"""What a liquid, wear and stresses below are not asked for: refused by name in Python and in the
core, or warned of."""

from __future__ import annotations

import random
import re
from typing import Any

import pytest
import railpatch
from bits.combinations import COMMON, OF_PATCHES, OF_WHEELS, PATCH_BASE, WHEELSET_BASE
from case_samples import PATCH, WHEELSET, with_values
from click.testing import CliRunner
from railpatch import _core
from railpatch.case.load import load_scene
from railpatch.case.to_core import config_of, input_of
from railpatch.command.cli import cli
from railpatch.damage.distribution import Distribution

FILM = {"model": "film", "roughness": 1e-6, "boundary_friction": 0.2, "liquid": "water"}
OIL = {"model": "film", "roughness": 1e-6, "liquid": "oil", "viscosity": 0.1}
KNOTS = [[0.0, 1.0, 0.4, 0.55, 0.4, 0.6], [1e-6, 0.3, 0.1, 0.3, 0.4, 0.2]]
# keys of [fluid], and what is said
REFUSED: dict[str, tuple[dict[str, Any], str]] = {
    "Eyring's stress of water": (
        {**FILM, "eyring_stress": 5e6},
        "fluid.eyring_stress: value is 5000000.0, allowed 0 with liquid = 'water', whose own "
        "friction is 0",
    ),
    "asperities that could not bear the load": (
        {**FILM, "share": "load_sharing", "hardness": 5e8},
        "fluid.hardness: value is 500000000.0, allowed above mean_pressure, 6e+08 Pa, with "
        "load_sharing",
    ),
    "steam": (
        {**FILM, "temperature": 150.0},
        "fluid.temperature: value is 150.0, allowed 0 to 100 degrees C with liquid = 'water'",
    ),
    "ice": (
        {**FILM, "temperature": -20.0},
        "fluid.temperature: value is -20.0, allowed 0 to 100 degrees C with liquid = 'water'",
    ),
    "two supplies": (
        {**OIL, "oil_film": 1e-6, "water_rate": 1e-8},
        "fluid.oil_film: value is 1e-06, allowed none: it must be left out with water_rate: one of "
        "them says what arrives",
    ),
    "a table": (
        {**FILM, "recovery": {"coefficient": 1e-3}},
        "fluid.recovery: value is a table, allowed none: it must be left out with model = 'film'",
    ),
    "another table": (
        {"model": "regimes", "water_rate": 1e-8, "oxide": {"solid_content": 0.3}},
        "fluid.oxide: value is a table, allowed none: it must be left out with model = 'regimes'",
    ),
    "one knot": (
        {"model": "regimes", "water_rate": 1e-8, "knots": KNOTS[:1]},
        "fluid.knots: value is [[0.0, 1.0, 0.4, 0.55, 0.4, 0.6]], allowed 2 to 8 rows",
    ),
    "a short knot": (
        {"model": "regimes", "water_rate": 1e-8, "knots": [KNOTS[0], [1e-6, 0.3]]},
        "fluid.knots[1]: value is [1e-06, 0.3], allowed 6 values",
    ),
    "rows": (
        {"model": "regimes", "water_rate": 1e-8, "knots": KNOTS[::-1]},
        "fluid.knots: value is [[1e-06, 0.3, 0.1, 0.3, 0.4, 0.2], [0.0, 1.0, 0.4, 0.55, ..., "
        "allowed water rates that increase",
    ),
}


def test_regimes_have_friction_of_their_own() -> None:
    """A coefficient beside their knots would count for nothing; factors of a wheel's do."""
    fluid = {"model": "regimes", "water_rate": 1e-8}
    fast = {"normal": "hertz", "tangential": "polach"}
    rolls = with_values(WHEELSET_BASE, fluid=fluid, method=fast)
    message = (
        "friction.coefficient: value is 0.36, allowed none: it must be left out with fluid.model = "
        "'regimes', whose knots have friction of their own"
    )
    with pytest.raises(railpatch.CaseError, match=re.escape(message)):
        railpatch.solve({**rolls, "friction": {"coefficient": 0.36}})
    whole = railpatch.solve({**rolls, "friction": None})["right"]["patches"][0]
    half = railpatch.solve({**rolls, "friction": {"scale": [1.0, 0.5]}})["right"]["patches"][0]
    assert half["effective_friction"] == pytest.approx(0.5 * whole["effective_friction"], rel=1e-3)
    dry = "friction.coefficient: value is missing, allowed a number with law = 'coulomb'"
    with pytest.raises(railpatch.CaseError, match=re.escape(dry)):
        railpatch.solve({**rolls, "fluid": None, "friction": {"scale": [1.0, 0.5]}})


@pytest.mark.parametrize("name", REFUSED)
def test_fluids_are_refused_in_plain_words(name: str) -> None:
    fluid, said = REFUSED[name]
    method = {"tangential": "polach" if fluid["model"] == "regimes" else "full"}
    for case in (PATCH, WHEELSET):
        with pytest.raises(railpatch.CaseError) as error:
            railpatch.Contact({**case, "fluid": fluid, "method": method})
        assert said in error.value.problems


def test_no_refusal_shows_an_object_of_python() -> None:
    """Of pairs of tables and keys that exclude each other."""
    rng, told = random.Random(16), []
    for base, own in ((PATCH_BASE, OF_PATCHES), (WHEELSET_BASE, OF_WHEELS)):
        features = list({**COMMON, **OF_PATCHES, **OF_WHEELS, **own}.values())
        for _ in range(250):
            one, other = rng.sample(features, 2)
            try:
                load_scene(with_values(with_values(base, **one), **other))
            except TypeError:  # keys of a table that the other leaves out
                continue
            except railpatch.CaseError as error:
                told += error.problems
    assert len(told) > 300
    assert [text for text in told if re.search(r"\w\([a-z_]+=|<class|object at", text)] == []


def core_of(fluid: dict[str, Any], **changes: Any) -> Any:
    """The core's contact for a patch with a liquid, past the checks of Python."""
    scene = load_scene({**PATCH, "fluid": fluid})
    return _core.Contact({**config_of(scene), **changes}, False), input_of(scene.case)


@pytest.mark.parametrize(
    ("fluid", "changes", "said"),
    [
        (
            {**FILM, "share": "load_sharing"},
            {"fluid_hardness": 5e8},
            "fluid_hardness must be above fluid_mean_pressure",
        ),
        (FILM, {"fluid_eyring_stress": 5e6}, "fluid_eyring_stress must be 0 with fluid_liquid = w"),
        (FILM, {"fluid_temperature": 150.0}, r"fluid_temperature is 150, allowed is \[0, 100\]"),
        (FILM, {"fluid_temperature": -20.0}, r"fluid_temperature is -20, allowed is \[0, 100\]"),
        (
            {**OIL, "water_rate": 1e-8},
            {"fluid_oil_film": 1e-6},
            "fluid_oil_film must be NaN with fluid_water_rate",
        ),
    ],
)
def test_the_core_refuses_them_too(
    fluid: dict[str, Any], changes: dict[str, float], said: str
) -> None:
    core_of(fluid)
    with pytest.raises(railpatch.CaseError, match=said):
        core_of(fluid, **changes)


def test_steps_are_refused_as_cases_are() -> None:
    contact, values = core_of({**OIL, "water_rate": 1e-8})
    assert contact.step(values)["status"] == "converged"
    with pytest.raises(railpatch.CaseError, match="oil_film must be left NaN with water_rate"):
        contact.step({**values, "oil_film": 1e-6})
    wet = railpatch.Contact({**PATCH, "fluid": FILM})
    # by the name that a step has for the key
    with pytest.raises(railpatch.CaseError) as refused:
        wet.step(water_temperature=120.0)
    assert str(refused.value) == (
        "water_temperature (fluid.temperature): value is 120.0, allowed 0 to 100 degrees C with "
        "liquid = 'water'"
    )
    with pytest.raises(railpatch.CaseError, match=r"^friction_scale\[1\] \(friction\.scale"):
        wet.step(friction_scale=[1.0, -1.0])
    # a case that has one supply has no other to move; one that has none has both
    one = railpatch.Contact({**PATCH, "fluid": {**OIL, "water_rate": 1e-8}})
    with pytest.raises(railpatch.CaseError, match="oil_film: value is 1e-06, but this is no mov"):
        one.step(oil_film=1e-6)
    both = railpatch.Contact({**PATCH, "fluid": OIL})
    assert both.step(oil_film=1e-6).good
    with pytest.raises(railpatch.CaseError, match="water_rate: value is 1e-08, but this is no mov"):
        both.step(water_rate=1e-8)
    both = railpatch.Contact({**PATCH, "fluid": OIL})
    with pytest.raises(
        railpatch.CaseError, match="oil_film: value is 1e-06, allowed none: it must"
    ):
        both.step(water_rate=1e-8, oil_film=1e-6)
    assert both.step(water_rate=1e-8).good


def test_water_that_bodies_boil_or_freeze_is_warned_of() -> None:
    """Of both bodies' mean where the liquid has no temperature of its own."""
    for wheel, rail, warned in ((150.0, 20.0, 0), (150.0, 60.0, 1), (-20.0, 0.0, 1), (0.0, 0.0, 0)):
        case = {**PATCH, "fluid": FILM, "temperature": {"wheel": wheel, "rail": rail}}
        result = railpatch.solve(case)
        assert result["fluid_temperature"] == pytest.approx(0.5 * (wheel + rail))
        assert len(result.warnings) == warned
        assert all("water as a liquid is warmer than 100 or colder" in w for w in result.warnings)
    oil = {**PATCH, "fluid": OIL, "temperature": {"wheel": 150.0, "rail": 150.0}}
    assert railpatch.solve(oil).warnings == []


def test_ehl_of_wheels_is_refused_by_name() -> None:
    for kind in ("wheel_rail", "wheelset"):
        said = (
            "fluid.model: value is 'ehl', allowed 'film', 'strip' or 'regimes' with kind = "
            f"'{kind}': 'ehl' is of kind = 'patch'"
        )
        with pytest.raises(railpatch.CaseError) as error:
            railpatch.Contact({**WHEELSET, "kind": kind, "fluid": {**FILM, "model": "ehl"}})
        assert error.value.problems == [said]


# --- wear ----------------------------------------------------------------------------------------

OF_OTHERS = {
    "usfd": {
        "hardness": 3e9,
        "archard_map": [[0.0, 1e-4]],
        "seizure_pressure": 0.7,
        "seizure_coefficient": 1e-2,
    },
    "archard": {
        "usfd_rate": 5e-9,
        "usfd_plateau": 0.05,
        "usfd_slope": 6e-8,
        "usfd_limits": [1e7, 7e7],
    },
}


@pytest.mark.parametrize("wear", OF_OTHERS)
def test_keys_of_the_other_law_of_wear_are_refused(wear: str) -> None:
    """Each of them changes what its own law gives."""
    (other,) = OF_OTHERS.keys() - {wear}
    # all three branches of USFD, and seizure, are reached by one of them
    load = 8e5 if other == "archard" else 1.5e5
    cases = [
        with_values(PATCH, load__normal_force=load, motion__creepage=[slip, 0.0])
        for slip in (3e-3, 0.3)
    ]

    def worn(**keys: Any) -> list[float]:
        damage = {"damage": {"wear": other, **keys}}
        return [railpatch.solve({**case, **damage})["damage"]["wear_rate"] for case in cases]

    plain = worn()
    for name, value in OF_OTHERS[wear].items():
        with pytest.raises(railpatch.CaseError) as error:
            railpatch.Contact({**PATCH, "damage": {"wear": wear, name: value}})
        assert error.value.problems == [
            f"damage.{name}: value is {value!r}, allowed none: it must be left out with wear = "
            f"'{wear}'"
        ]
        assert worn(**{name: value}) != plain, name


def test_numbers_that_a_patch_has_not_are_null() -> None:
    """None in Python and in JSON, on the terminal no row."""
    for method, known in (({}, True), ({"tangential": "polach"}, False)):
        case = {**PATCH, "method": method, "damage": {"basis": "patch"}}
        contact = railpatch.Contact(case)
        result = contact.step()
        damage = result["damage"]
        assert damage["work_scale"] is None
        assert damage["wheel_depth_rate"] is None
        if known:
            # the greatest traction of an element, as by elements
            by_elements = railpatch.solve({**case, "damage": {}})["damage"]
            assert damage["stress_index"] == pytest.approx(by_elements["stress_index"], rel=1e-12)
        else:
            assert damage["stress_index"] is None
        assert result.to_dict()["damage"] == damage
        ((_, rows),) = contact.wear_rows()["right"]
        assert rows.keys() == {"s", "height", "wear"}
        with pytest.raises(railpatch.CaseError, match="of a patch without profiles"):
            Distribution().add(rows, 1.0)


def test_explain_says_what_was_asked_for(tmp_path: Any) -> None:
    case = tmp_path / "case.toml"
    text = """kind = "patch"
[geometry]
semi_axes = [0.006, 0.005]
[load]
normal_force = 8e4
[grid]
elements = [10, 10]
[motion]
creepage = [1e-3, 0.0]
[friction]
coefficient = 0.3
"""
    case.write_text(text, encoding="utf-8")
    said = " ".join(CliRunner().invoke(cli, ["explain", str(case)]).output.split())
    assert "subsurface no no table subsurface in the case" in said
    assert "damage no no table damage in the case" in said
    case.write_text(f"{text}[subsurface]\ndepths = [1e-3]\n[damage]\n", encoding="utf-8")
    said = " ".join(CliRunner().invoke(cli, ["explain", str(case)]).output.split())
    assert "% asked for: stresses at 1 depth below the rail" in said
    assert "% asked for: wear = usfd, basis = elements" in said


def test_oil_in_kelvin_is_refused() -> None:
    case = with_values(PATCH, fluid={**OIL, "temperature": 293.15})
    with pytest.raises(railpatch.CaseError, match="allowed <= 250 degrees C with liquid = 'oil'"):
        railpatch.solve(case)
