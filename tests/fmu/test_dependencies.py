"""Each input that an output is said to depend on changes it, and no other input ever does."""

from __future__ import annotations

from collections.abc import Callable

import pytest
from slave import OK, Fmu, Slave

Unpack = Callable[..., Fmu]
# a state in which every quantity is something, with both wheels in contact
PLACE: dict[str, float] = {
    "wheelset.y": 2e-5,
    "wheelset.roll": 1e-5,
    "wheelset.yaw": 1e-3,
    "wheelset.x": 0.5,
    "wheelset.pitch": 0.01,
    "wheelset.vy": 0.01,
    "wheelset.vz": 0.01,
    "wheelset.roll_rate": 0.01,
    "wheelset.yaw_rate": 0.01,
    "creepage[1]": 2e-4,
    "creepage[2]": 1e-4,
    "spin_creepage": 0.1,
}
# what is added, by the end of the name; in turn until the output changes
CHANGES: dict[str, tuple[float, ...]] = {
    "vertical_force": (200.0, 2000.0),
    "normal_force": (200.0, 2e4),
    "approach": (1e-6, 2e-5),
    "creepage[1]": (1e-5, 1e-3),
    "creepage[2]": (1e-5, 1e-3),
    "spin_creepage": (0.1, 1.0),
    "rolling_speed": (-1.0, -10.0),
    "direction": (-2,),
    "substeps": (1,),
    "pitch_rate": (0.1, 0.4),
    "speed": (0.01, 0.1),
    "velocity[1]": (0.01, 0.1),
    "velocity[2]": (0.01, 0.1),
    "velocity[3]": (0.01, 0.1),
    "wheelset.x": (0.1, -0.02),
    "coefficient": (0.01, -0.25),
    "temperature.wheel": (5.0, 50.0),
    "temperature.rail": (5.0, 50.0),
}
LENGTHS = (2e-5, -2e-5, 1e-4, 3e-4)
# a wheel that is not there, a number of something, or bits of the solver's way
SILENT = ("status", "patch_count", "share", "elements.", "iterations", "residual", "contact_area")
# of whole elements; where it is greatest the patch slips, and friction and pressure alone count
SILENT += ("contact_size", "max_traction")


def listed(fmu: Fmu, tag: str) -> dict[str, set[str]]:
    """Output -> inputs that the description names."""
    names = list(fmu.variables)
    return {
        names[int(unknown.attrib["index"]) - 1]: {
            names[int(number) - 1] for number in unknown.attrib["dependencies"].split()
        }
        for unknown in fmu.root.find(f"ModelStructure/{tag}")
    }


def place_of(fmu: Fmu) -> dict[str, float]:
    """Values of all inputs and parameters around which they are changed."""
    values = {}
    for causality in ("input", "parameter"):
        for name in fmu.names(causality):
            number = int if fmu.variables[name][0].tag == "Integer" else float
            values[name] = PLACE.get(name, number(fmu.variables[name][0].attrib["start"]))
    if "direction" in values:
        values["direction"] = 1
    if "temperature.wheel" in values and "creepage[1]" in values:
        values["creepage[1]"] = 0.05  # friction makes it warmer than both bodies
    return values


def solved(slave: Slave, values: dict[str, float]) -> dict[str, float]:
    """Outputs at the start of a run, after a reset: they depend on nothing but the values."""
    assert slave.call("Reset") == OK
    assert slave.setup() == OK
    assert slave.set(values) == OK, slave.log
    assert slave.call("EnterInitializationMode") == OK
    return slave.outputs()


def other_side(output: str) -> str:
    """ ".right." of an output of the left wheel, and so on."""
    side = output.split(".")[0]
    return {"left": ".right.", "right": ".left."}.get(side, "none")


SOLVED = ("patch", "patch_approach", "patch_normal", "line", "fast", "rail", "roller", "loaded")
SOLVED += (
    "plastic",
    "falling",
    "hot",
    "warm",
    "frictionless",
    "transient",
    "supported",
    "sections",
    "along",
    "flat",
)


@pytest.mark.parametrize("name", SOLVED)
def test_dependencies_are_those_found_by_perturbation(name: str, unpacked: Unpack) -> None:
    fmu = unpacked(name)
    place = place_of(fmu)
    with Slave(fmu) as slave:
        base = solved(slave, place)
        changing: dict[str, set[str]] = {output: set() for output in base}
        for known in place:
            key = next((key for key in CHANGES if known.endswith(key)), "")
            for change in CHANGES.get(key, LENGTHS):
                moved = solved(slave, place | {known: place[known] + change})
                for output, value in moved.items():
                    if value != base[output]:
                        changing[output].add(known)
        assert solved(slave, place) == base
    initial, steps = listed(fmu, "InitialUnknowns"), listed(fmu, "Outputs")
    assert initial.keys() == steps.keys() == base.keys()
    if "left.max_temperature" in changing:  # that of one wheel at a time
        for side in ("left", "right"):
            changing["max_temperature"] |= changing[f"{side}.max_temperature"]
    for output, found in changing.items():
        assert found <= initial[output], (output, found - initial[output])
        absent = any(f"patch[{number}]" in output for number in range(2, 7))
        if not absent and not any(word in output for word in SILENT):
            # rails that give way: the other side's come in by the common iteration only
            iterated = {k for k in place if name == "supported" and other_side(output) in k}
            assert initial[output] <= found | iterated, (output, initial[output] - found)
        assert steps[output] == initial[output] - {"friction.coefficient", "substeps"}
