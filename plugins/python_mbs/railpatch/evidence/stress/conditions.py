"""The conditions of contact, checked again in numpy; shares nothing with the solver.

Kalker 1990, Three-dimensional elastic bodies in rolling contact, chapter 1: pressure and gap are
not negative and not both positive; the tangential traction is within its bound, with its bound
against the inelastic slip where there is any. Bound: friction coefficient times pressure, or the
yield stress of a plastic layer where that is less.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from railpatch.case.patch import PatchCase
from railpatch.evidence.stress.fitted_rows import fitted_findings, rectangle_findings
from railpatch.evidence.stress.half_space import Array
from railpatch.evidence.stress.inelastic import (
    bound_of,
    friction_of,
    inelastic_findings,
)
from railpatch.evidence.stress.liquids import greatest_of, liquid_findings
from railpatch.evidence.stress.shift import beyond_the_mean, rubbed_in_shift
from railpatch.evidence.stress.step import Finding, Step, curvatures_of

# a solver measures its residual in its own way: over all elements together, by its own scale
IMPOSED = 10.0
# of numbers that follow from others by sums
SUMS = 1e-9
OVER_BOUND = 1e-9
# of displacements that cancel each other, by the products' own rounding
ROUNDING = 1e-13
STICK, SLIP, PLASTIC = 1, 2, 3


def findings(step: Step, thorough: bool = True) -> list[Finding]:
    """What can be said of a converged step. thorough: also what takes much longer than a solve."""
    found = [*result_findings(step), *liquid_findings(step)]
    absent = absent_fields(step)
    if absent:
        return [*found, *(Finding(f"field {name} is absent", np.inf, 0.0) for name in absent)]
    if not step.has("pressure"):
        return found
    if step.fitted:
        if step.has("traction") and not line_of(step):
            found += [*fitted_findings(step)]
            if thorough:
                found += [*rectangle_findings(step)]
        return found
    found += [*normal_findings(step)]
    if step.has("traction") and step.case.method.tangential != "none":
        found += [*traction_findings(step)]
        if step.case.method.tangential == "full":
            found += [*slip_findings(step), *inelastic_findings(step)]
    return found


def absent_fields(step: Step) -> list[str]:
    """Fields that the scene should have."""
    case = step.case
    if case.method.tangential != "full" or step.regime == "none" or case.friction is None:
        return []
    wanted = ["pressure", "traction", "micro_slip", "element_division"]
    if case.friction.law != "coulomb":
        wanted.append("friction")
    if case.layer is not None and case.layer.is_plastic:
        wanted += ["plastic_displacement", "plastic_path", "yield_stress"]
    if case.temperature is not None:
        wanted.append("temperature")
    return [name for name in wanted if not step.has(name)]


def greatest_friction(step: Step) -> float:
    """N, the most that friction carries."""
    if step.case.friction is None:
        return 0.0
    if step.case.fluid is not None:
        return greatest_of(step) * step.patch["normal_force"]
    factor = max((value for _, value in step.case.friction.factor or ()), default=1.0)
    return step.case.friction.greatest * factor * step.patch["normal_force"]


def result_findings(step: Step) -> Iterator[Finding]:
    """The numbers of the result alone."""
    patch = step.patch
    yield Finding("pressure of contact", -patch["max_pressure"], 0.0)
    if isinstance(step.case, PatchCase) and step.case.load.normal_force is not None:
        wanted = step.values["normal_force"]
        # the area of fitted rows and of approximate theories is a quadrature
        yield Finding("normal force", abs(patch["normal_force"] / wanted - 1), 1e-6)
    if step.regime == "none" or step.case.method.tangential == "none":
        return
    most = greatest_friction(step)
    force = np.hypot(*patch["creep_force"])
    yield Finding("creep force over friction", force - most, max(OVER_BOUND * most, 1e-300))
    if isinstance(step.case, PatchCase):
        for component, given in enumerate(step.case.motion.prescribed):
            if given:
                miss = patch["creep_force"][component] - step.values["tangential_force"][component]
                yield Finding("prescribed force", abs(miss), IMPOSED * step.tolerance * most)
    yield from power_findings(step, most)


def power_findings(step: Step, most: float) -> Iterator[Finding]:
    """Friction takes power; in steady rolling all of what the rigid motion supplies."""
    size = power_scale(step, most)
    if size == 0:
        return
    limit = IMPOSED * step.tolerance
    # of shift the way within the step counts, which the forces at its ends do not tell: see
    # energy_balance
    if step.history_known and step.regime != "shift":
        miss = abs(step.patch["creep_power"] - supplied_power(step))
        yield Finding("creep power", miss / size, SUMS)
    if step.regime == "steady_rolling" or (step.regime == "shift" and any(step.motion)):
        yield Finding("friction takes power", -step.patch["friction_power"] / size, limit)
    if np.isfinite(step.patch["plastic_power"]):
        yield Finding("plastic work", -step.patch["plastic_power"] / size, limit)
    # FASTSIM's foundation keeps energy in the traction at the trailing edge; Polach's power is
    # without spin
    whole = step.case.method.tangential not in ("fastsim", "polach")
    if step.regime == "steady_rolling" and whole:
        plastic = step.patch["plastic_power"]
        taken = step.patch["friction_power"] + (plastic if np.isfinite(plastic) else 0.0)
        yield Finding("power supplied", abs(taken - supplied_power(step)) / size, limit)


def supplied_power(step: Step) -> float:
    """W, of the creepages (shift: J); the wheel's forces act against them, in shift and transient
    rolling the means of those at both ends of the step."""
    xi, eta, phi = step.motion
    force, moment = np.array(step.patch["creep_force"]), step.patch["spin_moment"]
    if step.regime in ("shift", "transient_rolling"):
        before = step.history
        force, moment = 0.5 * force, 0.5 * moment
        if before is not None:
            force = force + 0.5 * np.array(before.patch["creep_force"])
            moment += 0.5 * before.patch["spin_moment"]
    work = force[0] * xi + force[1] * eta + moment * phi
    speed = 1.0 if step.regime == "shift" else step.patch["rolling_speed"]
    return float(-speed * work)


def power_scale(step: Step, most: float) -> float:
    """W: friction times the greatest speed of the rigid slip."""
    xi, eta, phi = step.motion
    reach = float(np.sqrt(max(step.patch["contact_area"], 0.0)))
    if step.has("pressure") and step.has("x"):
        reach = float(np.abs(step["x"]).max() + np.abs(step["y"]).max())
    speed = 1.0 if step.regime == "shift" else step.patch["rolling_speed"]
    return most * speed * (float(np.hypot(xi, eta)) + abs(phi) * reach)


def normal_findings(step: Step) -> Iterator[Finding]:
    """Pressure and gap."""
    pressure = step["pressure"]
    highest = float(pressure.max())
    yield Finding("negative pressure", -float(pressure.min()) / highest, 0.0)
    total = float(pressure.sum()) * step.area
    yield Finding("sum of pressure", abs(total / step.patch["normal_force"] - 1), SUMS)
    if step.case.method.normal != "half_space":
        return
    yield from gap_findings(step)


def gap_findings(step: Step) -> Iterator[Finding]:
    """No gap in contact, no interpenetration beside it."""
    # parts of a patch of wheels influence each other by less: not half-space theory
    if not isinstance(step.case, PatchCase) and separate_rows(step):
        return
    curvatures = curvatures_of(step)
    x, y = step.places
    if curvatures is None:
        distance = step["undeformed_distance"]
    else:
        distance = curvatures[0] * x**2 + curvatures[1] * y**2
    displacement = step.half_space.normal(step["pressure"])
    size = float(np.abs(displacement).max())
    gap = distance + displacement
    approach = step.patch["approach"]
    line = line_of(step)
    if line or not isinstance(step.case, PatchCase):
        # a line's reference is a convention, and wheels count from their own: the gap is the same
        # everywhere in contact
        approach = float(gap[step.contact].mean())
    if line:
        size = float(np.ptp(displacement))
    gap = (gap - approach) / size
    limit = IMPOSED * step.tolerance
    yield Finding("gap in contact", float(np.abs(gap[step.contact]).max()), limit)
    if not step.contact.all():
        yield Finding("interpenetration", -float(gap[~step.contact].min()), limit)


def line_of(step: Step) -> bool:
    """Whether this is a line contact."""
    case = step.case
    return isinstance(case, PatchCase) and case.geometry.line_contact_radius is not None


def separate_rows(step: Step) -> bool:
    """Whether a row without contact lies between rows with it, or the distance has two valleys."""
    lowest = step["undeformed_distance"].min(axis=1)
    slopes = np.sign(np.diff(lowest))
    return bool((np.diff(slopes[slopes != 0]) < 0).any())


def traction_findings(step: Step) -> Iterator[Finding]:
    """Sums and bound of the tractions, division of the elements."""
    traction, contact = step["traction"], step.contact
    yield Finding("traction outside", float(np.abs(traction[:, ~contact]).max(initial=0)), 0.0)
    x, y = step.places
    most = greatest_friction(step)
    force = traction.sum(axis=(1, 2)) * step.area
    moment = float((x * traction[1] - y * traction[0]).sum()) * step.area
    reach = float(np.abs(step["x"]).max() + np.abs(step["y"]).max())
    miss = float(np.hypot(*(force - step.patch["creep_force"])))
    limit = max(SUMS * most, 1e-300)
    yield Finding("sum of tractions", miss, limit)
    yield Finding("moment of tractions", abs(moment - step.patch["spin_moment"]), limit * reach)
    if step.case.method.tangential == "fastsim" and step.case.method.traction_bound != "elliptic":
        return  # its own bound is not the pressure's
    size = np.hypot(*traction)
    bound = bound_of(step)
    excess = size[contact] - bound[contact] * (1 + OVER_BOUND)
    yield Finding("traction over its bound", float(excess.max()), max(1e-12 * bound.max(), 1e-300))


def natural_residual(traction: Array, slip: Array, bound: Array, stiffness: float) -> Array:
    """Pa, [2, ...]: p less the projection of p - r s on |p| <= bound; zero for the solution."""
    q = traction - stiffness * slip
    size = np.hypot(*q)
    factor = np.where(size > bound, bound / np.where(size > 0, size, 1.0), 1.0)
    return traction - factor * q


def slip_findings(step: Step) -> Iterator[Finding]:
    """Stick has no slip; slip is against the traction, which then has its bound."""
    if not step.history_known:
        return
    contact = step.contact
    bound = bound_of(step)[contact]
    traction, slip = step["traction"][:, contact], step.slip[:, contact]
    stiffness = step.stiffness
    asked = step.steepness * np.hypot(*step.asked_slip[:, contact])
    scale = float(np.linalg.norm(np.minimum(bound, asked)))
    # sums of displacements much greater than what they leave
    moved = stiffness * np.abs(step.displacement).max() / step.rolled * np.sqrt(contact.sum())
    limit = IMPOSED * step.tolerance * scale + ROUNDING * moved * max(step["pressure"].shape)
    size = limit if limit > 0 else 1.0
    residual = natural_residual(traction, slip, bound, stiffness)
    yield Finding("stick and slip", float(np.linalg.norm(residual)) / size, 1.0)
    given = step["micro_slip"][:, contact]
    division = step["element_division"][contact]
    if step.patch["elements"][PLASTIC] == 0 and not step.has("plastic_displacement"):
        difference = np.where(division == SLIP, stiffness * (given - slip), 0.0)
        # tractions that slide are known to the tolerance, whatever their slip
        known = IMPOSED * step.tolerance * stiffness * float(np.linalg.norm(slip))
        yield Finding("micro-slip", float(np.linalg.norm(difference)) / max(size, known), 1.0)
    # a plastic element may slip too: state S* of the report
    still = np.abs(given[:, (division != SLIP) & (division != PLASTIC)]).max(initial=0.0)
    yield Finding("micro-slip outside slip", float(still), 0.0)
    friction = (friction_of(step) * step["pressure"])[contact]
    short = np.minimum(friction - np.hypot(*traction), stiffness * np.hypot(*given))
    yield Finding("slip below friction", float(np.linalg.norm(np.maximum(short, 0))) / size, 1.0)
    along = (traction * given).sum(axis=0)
    worst = float((along / np.maximum(bound, 1e-300)).max(initial=0.0))
    yield Finding("micro-slip along the traction", worst * stiffness / size, 1.0)
    counts = np.bincount(step["element_division"].astype(int).ravel(), minlength=4)
    differ = np.abs(counts[:4] - np.array(step.patch["elements"])).max()
    yield Finding("count of elements", float(differ), 0.0)


def energy_balance(step: Step) -> float:
    """-, what is left of the step's energies over the greatest of them; NaN where there is none.

    The work of the creepages, by the tractions at both ends of the step, is what friction and
    plastic displacement take as the result says, and what the bodies store or lose: the change of
    the tractions' energy by their displacements, which are computed again. Friction's part is also
    the work of its elements by the solver's own slip, where material moves by whole ones. Of shift
    the way within the step counts (shift.py).
    """
    if not step.good or not step.has("traction") or not step.has("pressure") or step.fitted:
        return float("nan")
    if step.case.method.tangential != "full" or step.regime == "none" or not step.history_known:
        return float("nan")
    # pressure has its part in the energy of unlike bodies
    if step.unlike:
        return float("nan")
    speed = 1.0 if step.regime == "shift" else step.patch["rolling_speed"]
    if not speed > 0:
        return float("nan")
    time = step.rolled / speed
    work = supplied_power(step) * time
    if step.regime == "shift":
        work += beyond_the_mean(step)
    plastic = step.patch["plastic_power"]
    taken = (step.patch["friction_power"] + (plastic if np.isfinite(plastic) else 0.0)) * time
    stored = 0.0
    if step.regime != "steady_rolling":
        before = step.history
        stored = stored_energy(step) - (stored_energy(before) if before is not None else 0.0)
    # energy that could be turned over: traction by the greatest slip asked for
    size = float((np.hypot(*step["traction"]) * np.hypot(*step.asked_slip)).sum())
    size = max(size * step.rolled * step.area, abs(work), abs(taken), abs(stored))
    if size == 0:
        return 0.0
    missing = abs(work - taken - stored)
    if step.regime == "shift":
        missing = max(missing, abs(step.patch["creep_power"] - work))
    if whole_elements(step) and not step.has("plastic_displacement"):
        missing = max(missing, abs(rubbed(step) - taken))
    return missing / size


def stored_energy(step: Step) -> float:
    """J, of the tractions and the displacement they cause."""
    displacement = step.half_space.tangential(step["traction"])
    return 0.5 * float((step["traction"] * displacement).sum()) * step.area


def whole_elements(step: Step) -> bool:
    """Whether material moves by whole elements, all of it within the grid: then the work of its
    elements is that of the whole."""
    elements = step.ahead / step.half_space.dx
    carried = step if step.regime == "steady_rolling" else step.history
    if carried is None:
        return True
    lost = np.abs(carried["traction"]).sum() - np.abs(step.traction_before).sum()
    size = np.abs(carried["traction"]).sum()
    return abs(elements - round(elements)) < 1e-9 and lost <= 1e-12 * size


def rubbed(step: Step) -> float:
    """J, what friction takes in the elements. Force and moment, which supply it, are summed at the
    elements' places at both ends of the step, while the spin acts where its term is read."""
    now, before = (p[1].sum() * step.area for p in (step["traction"], step.traction_before))
    if step.regime == "shift" and any(step.motion):
        return rubbed_in_shift(step)
    # N m, of both ends about the place of the spin term
    moment = 0.5 * ((now + before) * step.spin_offset - before * step.ahead)
    return float(step.friction_work.sum() * step.area + moment * step.motion[2] * step.rolled)
