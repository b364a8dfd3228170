"""What of a scene an FMU shows: outputs to keep, inputs that are asked for, number of patches."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from fnmatch import fnmatchcase

from railpatch.case.load import Scene
from railpatch.case.patch import PatchCase
from railpatch.errors import CaseError
from railpatch.fmu.table import MAX_PATCHES, Kind, Variable

# patterns of names without the side and the patch
OUTPUT_GROUPS = {
    "forces": ("force", "moment", "mean_force", "mean_moment", "z"),
    "wheels": ("left.*", "right.*", "rolling_radius", "patch_count"),
    "patches": ("patch[[]*", "*.patch[[]*"),
    "power": ("*power", "*energy"),
}
INPUTS = ("friction",)


def with_patches(scene: Scene, patches: int | None) -> Scene:
    """The scene with another greatest number of patches of a wheel. Raises CaseError."""
    if patches is None:
        return scene
    if isinstance(scene.case, PatchCase):
        raise CaseError("--patches: given, allowed with wheels only")
    if not 1 <= patches <= MAX_PATCHES:
        raise CaseError(f"--patches: value is {patches}, allowed 1 ... {MAX_PATCHES}")
    wheelset = scene.case.wheelset.model_copy(update={"max_patches": patches})
    return replace(scene, case=scene.case.model_copy(update={"wheelset": wheelset}))


def input_conditions(inputs: Sequence[str], kind: Kind) -> set[str]:
    """What the variables depend on besides. Raises CaseError."""
    for name in inputs:
        if name not in INPUTS:
            raise CaseError(f"--inputs: value is {name!r}, allowed {', '.join(INPUTS)}")
    if "friction" not in inputs:
        return set()
    if "tangential" not in kind.conditions:
        raise CaseError(
            "--inputs: value is 'friction', allowed where there is a tangential problem"
        )
    if "coulomb" not in kind.conditions or "fluid" in kind.conditions:
        return {"friction scale"}
    return {"friction sides" if kind.kind == "wheelset" else "friction input"}


def chosen(variables: list[Variable], outputs: Sequence[str]) -> list[Variable]:
    """All that is no output, the status, and the outputs that are asked for. Raises CaseError."""
    if not outputs:
        return variables
    found: set[int] = set()
    for asked in outputs:
        patterns = OUTPUT_GROUPS.get(asked, (asked,))
        # as for names, so that "[1]" is that component and no set of letters
        matching = {
            v.reference
            for v in variables
            if v.causality == "output" and any(matches(v, pattern) for pattern in patterns)
        }
        if not matching:
            groups = ", ".join(OUTPUT_GROUPS)
            raise CaseError(
                f"--outputs: value is {asked!r}, which no output of this scene is, allowed names, "
                f"patterns with *, and {groups}"
            )
        found |= matching
    # a mean is made of what it is the mean of
    found |= {v.mean_of for v in variables if v.reference in found and v.mean_of}
    return [
        v
        for v in variables
        if v.causality != "output" or v.reference in found or v.name == "status"
    ]


def matches(variable: Variable, pattern: str) -> bool:
    """Whether a name, or the vector that it belongs to, is of that pattern."""
    names = {variable.name}
    if variable.component:
        names.add(variable.name.rpartition("[")[0])
    escaped = pattern if "[[]" in pattern else pattern.replace("[", "[[]")
    return any(fnmatchcase(name, escaped) for name in names)
