"""What a scene does not ask for holds no memory, gives no output and takes no iterations."""

from __future__ import annotations

from typing import Any

import pytest
import railpatch
from case_samples import PATCH, WHEELSET, with_values

WARM = {"wheel": 20.0, "rail": 20.0}
# what to add to the plain case, its stage, and an output that only then is there
FEATURES: dict[str, tuple[dict[str, Any], str, str | None]] = {
    "temperature": ({"temperature": WARM}, "temperature", "max_temperature"),
    "friction over temperature": (
        {
            "temperature": WARM,
            "friction": {
                "law": "temperature",
                "reference": 0.4,
                "change": -0.2,
                "reference_temperature": 50.0,
                "temperature_range": 200.0,
            },
        },
        "temperature",
        "max_temperature",
    ),
    "plastic layer": (
        {"layer": {"thickness": 0.0, "yield_stress": 2e8}},
        "plasticity",
        "plastic_power",
    ),
    "shift": ({"motion": {"regime": "shift", "creepage": [1e-5, 0.0]}}, "history", None),
    "transient rolling": (
        {"motion__regime": "transient_rolling", "motion__distance": 1e-3},
        "history",
        None,
    ),
    "unlike bodies": ({"material__shear_modulus": [82e9, 2e9]}, "coupling", None),
    "derivatives": ({"method__derivatives": True}, "derivatives", None),
}
# scenes that have none of the above
PLAIN: dict[str, dict[str, Any]] = {
    "Coulomb": {},
    "elastic layer": {"layer": {"thickness": 2e-5, "shear_modulus": 1e9}},
    "slip velocity": {
        "friction": {
            "law": "slip_velocity",
            "kinetic": 0.2,
            "amplitude": 0.2,
            "halving_speed": 0.1,
        }
    },
    "friction by rows": {"friction__factor": [[-0.003, 1.0], [0.003, 0.5]]},
    "force prescribed": {
        "motion": {"regime": "steady_rolling", "tangential_force": [-1e4, 0.0]},
    },
    "fitted rows": {"grid": {"fitted": [10, 10]}, "method__normal": "hertz"},
    "Hertz": {"method__normal": "hertz"},
    "frictionless": {"method__tangential": "none", "friction": None},
    "no motion": {"motion": {"regime": "none"}, "friction": None},
    "unlike, frictionless": {
        "material__shear_modulus": [82e9, 2e9],
        "method__tangential": "none",
        "friction": None,
    },
    **{
        theory: {"method": {"normal": "hertz", "tangential": theory}}
        for theory in railpatch._core.THEORIES
    },
}
OPTIONAL_STAGES = ("temperature", "plasticity", "history", "coupling", "derivatives")


def stages_of(contact: railpatch.Contact) -> dict[str, dict[str, Any]]:
    return {stage["name"]: stage for stage in contact.stages()}


def total(stages: dict[str, dict[str, Any]]) -> int:
    return sum(stage["bytes"] for stage in stages.values())


@pytest.mark.parametrize("name", FEATURES)
def test_feature_has_its_stage_and_others_do_not(name: str) -> None:
    changes, wanted, output = FEATURES[name]
    contact = railpatch.Contact(with_values(PATCH, **changes), timing=True)
    result = contact.step().to_dict()
    stages = stages_of(contact)
    assert [stage for stage in OPTIONAL_STAGES if stages[stage]["present"]] == [wanted]
    assert stages[wanted]["bytes"] > 0
    assert wanted in result["stages"]
    if output is not None:
        assert result[output] is not None


@pytest.mark.parametrize("name", PLAIN)
def test_scene_without_features_holds_and_gives_nothing(name: str) -> None:
    contact = railpatch.Contact(with_values(PATCH, **PLAIN[name]), timing=True)
    result = contact.step().to_dict()
    stages = stages_of(contact)
    for stage in OPTIONAL_STAGES:
        assert not stages[stage]["present"]
        assert stages[stage]["bytes"] == 0
        assert stages[stage]["seconds"] == 0
        assert stage not in result["stages"]
    for output in ("max_temperature", "plastic_power"):
        assert result[output] is None
    assert all(stage["reason"] for stage in stages.values())


def test_temperature_adds_its_own_bytes_alone() -> None:
    plain = stages_of(railpatch.Contact(PATCH))
    heated = stages_of(railpatch.Contact(with_values(PATCH, temperature=WARM)))
    assert total(heated) - total(plain) == heated["temperature"]["bytes"]


def test_derivatives_add_their_own_bytes_alone() -> None:
    plain = stages_of(railpatch.Contact(PATCH))
    asked = stages_of(railpatch.Contact(with_values(PATCH, method__derivatives=True)))
    assert total(asked) - total(plain) == asked["derivatives"]["bytes"] > 0


def test_yield_stress_adds_its_own_bytes_alone() -> None:
    """Against a friction law beyond Coulomb's, which has the same solver."""
    slip_law = with_values(PATCH, **PLAIN["slip velocity"])
    layer = {"thickness": 0.0, "yield_stress": 2e8}
    plain = stages_of(railpatch.Contact(slip_law))
    plastic = stages_of(railpatch.Contact(with_values(slip_law, layer=layer)))
    assert total(plastic) - total(plain) == plastic["plasticity"]["bytes"] > 0


@pytest.mark.parametrize("name", ["frictionless", "no motion"])
def test_frictionless_scene_has_no_tangential_stage(name: str) -> None:
    contact = railpatch.Contact(with_values(PATCH, **PLAIN[name]))
    result = contact.step(fields=True).to_dict()
    stages = stages_of(contact)
    full = stages_of(railpatch.Contact(PATCH))
    assert not stages["tangential"]["present"]
    assert stages["tangential"]["bytes"] == 0
    assert stages["influence"]["bytes"] < full["influence"]["bytes"]
    for output in ("creep_force", "spin_moment", "friction_power", "traction", "micro_slip"):
        assert result[output] is None


def test_patches_hold_memory_one_by_one() -> None:
    def held(patches: int) -> dict[str, int]:
        case = with_values(WHEELSET, method__normal="hertz", wheelset__max_patches=patches)
        return {name: s["bytes"] for name, s in stages_of(railpatch.Contact(case)).items()}

    one, two, three = (held(n) for n in (1, 2, 3))
    # pressure is all that Hertz's theory keeps
    assert two["normal"] == 2 * one["normal"] > 0
    for name in ("geometry", "tangential"):
        assert three[name] - two[name] == two[name] - one[name] > 0


def iterations_of(case: dict[str, Any]) -> dict[str, int]:
    """Iterations of a step from a cold start, and of the same step again."""
    from railpatch.case.to_core import input_of

    contact = railpatch.Contact(case)
    raw = contact._core.step(input_of(contact.case))
    patch = raw["right"]["patches"][0]
    return {
        name: patch[f"{name}_iterations"] for name in ("normal", "newton", "inner", "outer")
    } | {"slip": patch["elements"][2], "stick": patch["elements"][1]}


RUN_TIME = {
    "plain": {},
    "fine grid": {"grid__elements": [64, 64]},
    "fitted rows": PLAIN["fitted rows"],
    "slip velocity": PLAIN["slip velocity"],
    **{name: FEATURES[name][0] for name in ("plastic layer", "shift", "transient rolling")},
}


@pytest.mark.parametrize("name", RUN_TIME)
def test_no_creepage_is_free(name: str) -> None:
    case = with_values(with_values(PATCH, **RUN_TIME[name]), motion__creepage=[0.0, 0.0])
    counts = iterations_of(case)
    assert counts["stick"] > 0
    assert counts["slip"] == counts["newton"] == counts["inner"] == counts["outer"] == 0


@pytest.mark.parametrize("name", ["plain", "fine grid", "fitted rows", "shift"])
@pytest.mark.parametrize("creepage", [0.1, 1.0])
def test_full_sliding_needs_no_newton_step(name: str, creepage: float) -> None:
    case = with_values(with_values(PATCH, **RUN_TIME[name]), motion__creepage=[creepage, 0.0])
    counts = iterations_of(case)
    assert counts["slip"] > 0
    assert counts["stick"] == counts["newton"] == 0
    assert counts["inner"] <= 6


@pytest.mark.parametrize("name", RUN_TIME)
def test_no_contact_ends_early(name: str) -> None:
    case = with_values(PATCH, **RUN_TIME[name])
    case["load"] = {"approach": -1e-6}
    assert not any(iterations_of(case).values())


@pytest.mark.parametrize(
    ("case", "stage", "part"),
    [
        (with_values(PATCH, **PLAIN["no motion"]), "tangential", "regime = none"),
        (with_values(PATCH, **PLAIN["frictionless"]), "tangential", "tangential = none"),
        (
            with_values(WHEELSET, method__tangential="none", friction=None),
            "tangential",
            "tangential = none",
        ),
        (with_values(PATCH, **PLAIN["table"]), "influence", "neither"),
        (with_values(PATCH, **PLAIN["Hertz"]), "influence", "tangential = full"),
        (with_values(PATCH, **PLAIN["frictionless"]), "influence", "normal = half_space"),
        (PATCH, "plasticity", "no third-body layer"),
        (with_values(PATCH, **PLAIN["elastic layer"]), "plasticity", "no yield stress"),
        (with_values(PATCH, **PLAIN["unlike, frictionless"]), "coupling", "no tangential problem"),
        (PATCH, "history", "steady rolling"),
        (with_values(PATCH, **FEATURES["shift"][0]), "history", "regime = shift"),
        (with_values(PATCH, **PLAIN["slip velocity"]), "tangential", "slip-velocity law"),
        (PATCH, "temperature", "no surface temperature"),
    ],
)
def test_reasons_name_what_decides(case: dict[str, Any], stage: str, part: str) -> None:
    assert part in stages_of(railpatch.Contact(case))[stage]["reason"]


def test_rails_on_springs_and_profiles_along_the_track_add_their_own_bytes_alone() -> None:
    plain = stages_of(railpatch.Contact(WHEELSET))
    assert not plain["rail_support"]["present"]
    assert plain["rail_support"]["bytes"] == 0
    rails = {"track__rail_support": {"stiffness": [2e7, 5e7]}}
    supported = stages_of(railpatch.Contact(with_values(WHEELSET, **rails)))
    assert total(supported) - total(plain) == supported["rail_support"]["bytes"] > 0
    uic = [{"position": x, "profile": "UIC60@1:40"} for x in (0.0, 1.0)]
    along = {"track__right": {"sections": uic}, "track__left": {"sections": uic}}
    varying = stages_of(railpatch.Contact(with_values(WHEELSET, **along, profiles__rail=None)))
    changed = [name for name in plain if varying[name]["bytes"] != plain[name]["bytes"]]
    assert changed == ["geometry"]
    assert varying["geometry"]["bytes"] > plain["geometry"]["bytes"]


def test_plane_reference_holds_nothing_of_the_curved_one() -> None:
    case = with_values(WHEELSET, grid__element_size=[1e-3, 1e-3])
    plain = stages_of(railpatch.Contact(case))
    curved_case = with_values(case, method__reference_surface="curved")
    curved = stages_of(railpatch.Contact(curved_case))
    assert not plain["coupling"]["present"]
    assert plain["coupling"]["bytes"] == 0
    assert curved["coupling"]["present"]
    assert curved["coupling"]["reason"] == "reference_surface = curved: outer loop"
    for stage in ("influence", "coupling", "geometry"):
        assert curved[stage]["bytes"] > plain[stage]["bytes"], stage
    # without friction there is nothing to go round
    calm = with_values(curved_case, method__tangential="none", friction=None)
    normal = stages_of(railpatch.Contact(calm))
    assert not normal["coupling"]["present"]
