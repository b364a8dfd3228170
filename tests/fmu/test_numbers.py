"""The FMU gives Python's numbers: to 1e-12 with the same FFT library, else to the tolerance."""

from __future__ import annotations

import math
import re
from collections.abc import Callable
from typing import Any

import pytest
import railpatch
from fmu_scenes import MOTIONS, OWN, SCENES, STEP
from slave import DISCARD, OK, Fmu, Slave

TOLERANCE = 1e-5  # of the scenes' solvers
STATUSES = [
    "converged",
    "no_contact",
    "not_converged",
    "out_of_range",
    "accuracy_not_met",
    "work_spent",
]


def changes_of(contact: railpatch.Contact, values: dict[str, float]) -> dict[str, Any]:
    """The same motion as keys of step()."""
    case = contact.case.model_dump()
    changed: dict[str, Any] = {}
    for name, value in values.items():
        path = re.sub(r"\[\d+\]", "", name).split(".")
        index = re.search(r"\[(\d+)\]", name)
        if case["kind"] == "patch" and path[0] != "temperature":
            path.insert(0, "load" if path[0] in ("normal_force", "approach") else "motion")
        table: Any = case
        for part in path[:-1]:
            table = table[part]
        if index:
            table[path[-1]][int(index[1]) - 1] = value
        else:
            table[path[-1]] = value
        if path[0] == "temperature":
            changed[path[0]] = {body: case[path[0]][body] for body in ("wheel", "rail")}
        elif path[0] != "track":
            changed[path[1]] = case[path[0]][path[1]]
        elif path[1] == "roller_pitch_rate":
            changed[path[1]] = value
        else:
            changed["track"] = {side: case["track"][side] for side in ("left", "right")}
    return changed


def solutions(wheel: dict[str, Any]) -> list[dict[str, Any]]:
    """All that count in a wheel's force."""
    return wheel["patches"] + wheel["alternatives"]


def summed(patches: list[dict[str, Any]], key: str) -> float:
    """Of a wheel's patches by their shares; the greatest residual."""
    values = [(p[key] or 0, p["share"]) for p in patches]
    if key == "residual":
        return max((value for value, _ in values), default=0.0)
    return sum(value * share for value, share in values)


SUMS = "creep_power|friction_power|elastic_energy|residual|plastic_power|max_temperature"


def expected(result: dict[str, Any], name: str, bulk: float) -> float:
    """The JSON result's number behind an output; 0 for what is not there. bulk: degrees C, of the
    warmer body."""
    sums = re.fullmatch(rf"((?:left|right)\.)?({SUMS})", name)
    if sums and "left" in result:
        sides = [sums[1][:-1]] if sums[1] else ["left", "right"]
        found = [p for side in sides for p in solutions(result[side])]
        if sums[2] == "max_temperature":
            return max((p[sums[2]] or bulk for p in found), default=bulk)
        return summed(found, sums[2])
    if sums and "patches" in result:
        return summed(solutions(result), sums[2])
    value: Any = result
    for part in re.findall(r"[a-z_]+|\d+", name.replace("patch[", "patches[")):
        if part == "patch_count":
            value = len(value["patches"])
        elif part.isdigit():
            value = value[int(part) - 1] if value and int(part) <= len(value) else None
        else:
            # a patch that is not there
            value = value[part] if value else ("no_contact" if part == "status" else None)
    if name.endswith("max_temperature"):
        return bulk if value is None else value
    return STATUSES.index(value) if isinstance(value, str) else (value or 0)


def warmer(contact: railpatch.Contact) -> float:
    """degrees C, bulk temperature of the warmer body; 0: the scene has none."""
    heat = contact.case.temperature
    return 0.0 if heat is None else max(heat.wheel, heat.rail)


def scale_of(name: str, found: dict[str, float]) -> float:
    """Size of the quantity an output belongs to: that of the whole vector, or of its like."""
    stem = re.sub(r"(left\.|right\.|patch\[\d+\]\.)", "", name)
    stem = re.sub(r"\[\d+\]$", "", stem)
    like = [abs(v) for key, v in found.items() if stem in key]
    if stem == "spin_moment":
        # a force at the edge of the patch
        areas = [v for key, v in found.items() if key.endswith("contact_area")]
        forces = [abs(v) for key, v in found.items() if "force" in key]
        like.append(max(forces) * math.sqrt(max(areas)))
    return max(like) or 1.0


@pytest.mark.parametrize("name", SCENES)
def test_same_numbers_as_python(name: str, unpacked: Callable[..., Fmu]) -> None:
    contact = railpatch.Contact(SCENES[name])
    with Slave(unpacked(name, OWN)).initialize() as slave:
        results = [contact.step().to_dict()]
        found, bulk = [slave.outputs()], [warmer(contact)]
        for k, values in enumerate(MOTIONS[name]):
            assert slave.set(values) == OK, slave.log
            assert slave.step(k * STEP, STEP) == OK, slave.log
            found.append(slave.outputs())
            results.append(contact.step(**changes_of(contact, values)).to_dict())
            bulk.append(warmer(contact))
    for k, (outputs, result) in enumerate(zip(found, results, strict=True)):
        for key, value in outputs.items():
            # the same name would mean another power than those of the patches
            wanted = expected(result, re.sub(r"\bpower$", "contact_power", key), bulk[k])
            bound = 1e-12 * max(abs(wanted), scale_of(key, outputs))
            assert abs(value - wanted) <= bound, (name, k, key, value, wanted, bound)


@pytest.mark.parametrize("name", SCENES)
def test_both_fft_libraries_agree(name: str, unpacked: Callable[..., Fmu]) -> None:
    slaves = [Slave(unpacked(name, backend)).initialize() for backend in ("eigen", "fftw")]
    for k, values in enumerate([{}, *MOTIONS[name]]):
        one, two = ({}, {})
        for slave, outputs in zip(slaves, (one, two), strict=True):
            assert slave.set(values) == OK, slave.log
            assert slave.step(k * STEP, STEP) == OK, slave.log
            outputs |= slave.outputs()
        for key in one:
            if re.search("elements|iterations|residual|contact_area|contact_size", key):
                continue  # whole elements, and the way of the solver
            bound = 10 * TOLERANCE * scale_of(key, one)
            assert abs(one[key] - two[key]) <= bound, (name, k, key, one[key], two[key], bound)
    for slave in slaves:
        slave.free()


def test_several_patches_and_lift_off_are_among_them(unpacked: Callable[..., Fmu]) -> None:
    with Slave(unpacked("patches")).initialize() as slave:
        counts = []
        for k, values in enumerate(MOTIONS["patches"]):
            assert slave.set(values) == OK
            assert slave.step(k * STEP, STEP) == OK, slave.log
            counts += slave.get("patch_count")
    assert {1, 2} <= set(counts), counts
    with Slave(unpacked("rail")).initialize() as slave:
        assert slave.set({"wheelset.z": -1e-3}) == OK
        assert slave.step(0, STEP) == OK
        outputs = slave.outputs()
        assert slave.log == []
    assert outputs["status"] == outputs["left.patch[1].status"] == 1
    assert outputs["force[3]"] == outputs["left.patch[1].max_pressure"] == 0


def test_friction_acts_from_the_next_step(unpacked: Callable[..., Fmu]) -> None:
    case = {**SCENES["patch"], "friction": {"coefficient": 0.5}}
    with Slave(unpacked("patch", OWN)).initialize() as slave:
        assert slave.set({"friction.coefficient": 0.5, "creepage[1]": 0.1}) == OK
        assert slave.step(0, STEP) == OK
        [force] = slave.get("creep_force[1]")
        solved = railpatch.Contact(case).step(creepage=[0.1, 0.0])["creep_force"][0]
        assert force == pytest.approx(solved, rel=10 * TOLERANCE)


def test_out_of_range_is_discarded_and_says_what_to_change(unpacked: Callable[..., Fmu]) -> None:
    with Slave(unpacked("rail")).initialize() as slave:
        before, state = slave.outputs(), slave.save()
        assert slave.set({"wheelset.z": 0.02}) == OK
        assert slave.step(0, STEP) == DISCARD
        assert slave.outputs() == before
        [(status, category, text)] = slave.log
        assert (status, category) == (DISCARD, "logStatusDiscard")
        assert "smaller step" in text
        assert "grid.max_elements" in text
        assert slave.restore(state) == OK
        assert slave.step(0, STEP / 2) == OK
