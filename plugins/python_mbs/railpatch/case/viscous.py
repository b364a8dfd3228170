"""Viscoelastic bodies: what a case with them needs, and what they are not solved with."""

from __future__ import annotations

from typing import Any

from railpatch.case.common import Material, check_whole_theory, couples
from railpatch.case.types import LEFT_OUT, Problems, relation

RATIO, TIME = "material.viscoelastic_ratio", "material.relaxation_time"


def is_viscous(material: Material) -> bool:
    """Whether a body yields in time."""
    return any(ratio > 0 for ratio in material.viscoelastic_ratio)


def yields_unlike(material: Material) -> bool:
    """Whether what the bodies yield in time moves the surfaces along each other: (1 - 2 nu) f/G of
    bodies with unlike times, or unlike in it."""
    parts = [
        (1 - 2 * nu) * ratio / modulus
        for nu, ratio, modulus in zip(
            material.poisson_ratio,
            material.viscoelastic_ratio,
            material.shear_modulus,
            strict=True,
        )
    ]
    limit = 1e-12 * sum(1 / modulus for modulus in material.shear_modulus)
    times = material.relaxation_time
    return abs(parts[0] - parts[1]) > limit if times[0] == times[1] else max(parts) > limit


def check_viscous(case: Any) -> Problems:
    """Of any kind of case."""
    material = case.material
    pairs = list(zip(material.viscoelastic_ratio, material.relaxation_time, strict=True))
    alike = pairs[0] == pairs[1]
    for k, (ratio, time) in enumerate(pairs[: 1 if alike else 2]):
        body = "" if alike else f"[{k}]"
        if ratio > 0 and not time > 0:
            yield relation(f"{TIME}{body}", time, f"> 0 s with {RATIO}{body} > 0")
        if time > 0 and not ratio > 0:
            which = "elastic bodies" if alike else "an elastic body"
            yield relation(f"{TIME}{body}", time, f"0 with {RATIO}{body} = 0: {which}")
    if not is_viscous(material):
        return
    where = f"with {RATIO}"
    if case.kind != "patch":
        yield relation("kind", repr(case.kind), f"'patch' {where}")
        return
    if case.geometry.semi_axes is not None:
        allowed = f"{LEFT_OUT} {where}, they are those of elastic bodies: give curvatures"
        yield relation("geometry.semi_axes", str(case.geometry.semi_axes), allowed)
    yield from _check_method(case, where)
    for name in ("layer", "temperature", "fluid", "subsurface", "damage"):
        if getattr(case, name, None) is not None:
            yield relation(name, "given", f"{LEFT_OUT} {where}")
    if case.friction is not None and case.friction.law != "coulomb":
        yield relation("friction.law", repr(case.friction.law), f"'coulomb' {where}")
    if case.motion.slip_field is not None:
        yield relation("motion.slip_field", "given", f"{LEFT_OUT} {where}")
    if case.has_tangential and (couples(material) or yields_unlike(material)):
        yield relation(
            RATIO,
            str(material.viscoelastic_ratio),
            "with tangential = 'full': bodies with equal (1-2nu)/G, and of equal ratio and time "
            "but where poisson_ratio is 0.5",
        )


def _check_method(case: Any, where: str) -> Problems:
    method, motion = case.method, case.motion
    rule = f"'steady_rolling' for all steps {where}: the history is the line ahead"
    if motion.changes:
        yield relation("motion.regimes", str(motion.regimes), f"{LEFT_OUT}; {rule}")
    elif motion.regime != "steady_rolling":
        yield relation("motion.regime", repr(motion.regime), rule)
    if "rolling_speed" not in motion.model_fields_set:
        allowed = f"a number in m/s {where}: how far the bodies yield in the contact depends on it"
        yield relation("motion.rolling_speed", "missing", allowed)
    yield from check_whole_theory(case, where)
    if method.accuracy is not None:
        shown = f"{LEFT_OUT} {where}, which has no error estimate: give 'grid'"
        yield relation("method.accuracy", method.accuracy, shown)
