"""documentation/index.html and the notice of licences."""

from __future__ import annotations

from html import escape
from typing import Any

from railpatch.case.load import Case
from railpatch.fmu.description import Labels
from railpatch.fmu.frames import STYLE as PICTURE_STYLE
from railpatch.fmu.frames import pictures
from railpatch.fmu.table import Kind, Table, Variable, dependencies, first_item
from railpatch.fmu.this_scene import scene_table

STYLE = """
body { font: 15px/1.5 sans-serif; max-width: 75em; margin: 2em auto; padding: 0 1em; }
table { border-collapse: collapse; font-size: 13px; }
td, th { border: 1px solid #bbb; padding: 2px 6px; text-align: left; vertical-align: top; }
th { background: #eee; } td.number { text-align: right; } code { white-space: nowrap; }
"""
FRAMES = """
<p>Units are SI. All frames are right-handed. <b>Track frame</b>: x forward along the track's
centre line, y to the right, z down, origin in the plane on the rails' (rollers') tops; a
wheelset at z = 0 has its centre one nominal radius above that plane. Roll, yaw and pitch turn
about x, z and the axle by the right-hand rule: forward rolling is a wheelset pitch rate below 0
and a roller pitch rate above 0. <b>Contact frame</b>: origin on the rail at the contact
reference, x along rolling, s lateral along the surface, n down into the rail.</p>
<p><b>Signs</b>: forces and moments act on the wheel; moments are about the wheelset's centre.
Creepages are wheel minus rail over the rolling speed, so a positive creepage gives a negative
creep force. Vectors are counted from 1.</p>
"""
PATCH_FRAME = """
<p>Units are SI. <b>Contact frame</b>, right-handed: origin at the contact reference, x along
rolling, y lateral along the surface, n into the rail. <b>Signs</b>: forces and moments act on the
wheel. Creepages are wheel minus rail over the rolling speed, so a positive creepage gives a
negative creep force; the moment is that about the normal through the contact reference. Vectors
are counted from 1.</p>
"""
REFERENCE_POINTS = """
<p><b>Reference points</b>: position, force and moment are those at the wheelset's centre. The
offset of a wheel along y and z and its rotation about x move its profile in its meridian plane, the
rotation about the profile's origin; it still turns about the wheelset's axis. Its offset along x
and its rotation about z move that axis for this wheel, about the point of the axis in the plane of
the profile's origin. The same of a rail moves the rail; a roller's offset moves its axle, its
rotation about x turns its profile about the profile's origin.</p>
"""
MISSING = """
<p>Inputs without effect do not exist: the position along the track and the pitch angle are there
where something varies with them. Rails and rollers turn about x only in this version. Outputs
of a patch that is not there are 0, its status is no_contact.</p>
"""
REFERENCE = """
<p><code>documentation/reference.csv</code> has the outputs at the start values.
<code>reference_inputs.csv</code> and <code>reference_outputs.csv</code> are a series over time: the
outputs of a row are those after the step that ends at its time, with the inputs of the row before
set at its beginning (row 0: after initialization), steps of DefaultExperiment's stepSize. They were
solved by the contact's own core, not by this FMU: where it gives other numbers than rounding and
the solvers' tolerance explain, its library or the call of it is wrong.</p>
"""
RANGE = """
<p>The theory is that of elastic half-spaces in rolling with the scene's law of friction: patches
are small against the radii of wheel and rail; in steady rolling, motion changes little while the
wheel rolls one patch length. Lift-off is a valid result: status no_contact, all forces 0. A step
that does not converge, or in which contact leaves the profiles or needs more elements or patches
than the FMU was made with, ends with fmi2Discard: the time stays at that of the last good step,
outputs keep its values, and the message in the category logStatusDiscard says what to change. Go on
from a saved state, or reset. Values outside the ranges below are refused with fmi2Error, and
nothing is set. Why a call failed is told to the logger whatever logging is set to.</p>
"""
COUPLING = """
<p>Co-simulation lags: the forces after a step belong to the motion that was set before it, so a
master that exchanges values once a step delays the contact force by one communication step. A
delayed spring acts like one with a negative damper of stiffness times step: a wheel's contact of
about 1e9 N/m and steps of 0.1 ms take 1e5 N s/m of damping out of the system. Therefore:</p>
<ul>
<li>Choose steps so short that the rest of the model damps more than that, and halve them until
results stay.</li>
<li>Or iterate: save the state, step, correct the motion, restore, step again, with Newton's method
or one that mixes results; a plain fixed point bears no longer steps than held forces do. States can
be saved, restored and serialised at any time; a restored step gives the same bits.</li>
<li>Or let inputs move during the step: set their time derivatives (fmi2SetRealInputDerivatives,
orders 1 to 3) with their values before the step.</li>
<li>Or use directional derivatives, where the FMU has them, for a linearly implicit master.</li>
<li>Or take the model-exchange interface, where the FMU has it: no states, no lag.</li>
<li>Or give the vertical force instead of z, in the scene: z is then found inside, and only the
softer creep forces lag.</li>
</ul>
<p>The last solution is the start of the next one. It changes results only within the solver's
tolerance, and is part of the saved state. Steps may vary in length. In initialization mode, and in
model exchange, outputs follow the inputs at once.</p>
<p><b>Inputs in a step</b>: an input whose derivatives were set moves by them from the value it has
at the step's start, and afterwards is held where it came to; derivatives hold for one step. Outputs
are those at the step's end.</p>
"""
HISTORY = """
<p><b>Sub-steps</b>: this scene has a history. The parameter <code>substeps</code> divides every
communication step into that many steps of the contact, with inputs in between by their derivatives.
The contact's time step is that of a communication step over their number; at the start, where there
is no step yet, that of the scene. There is no model exchange, and there are no directional
derivatives, as both would ask the same step twice.</p>
"""
NO_HISTORY = """
<p><b>Model exchange</b>: without states and event indicators, as the scene has no history. A solve
that fails gives fmi2Discard when outputs are read: the master then takes a smaller step. Outputs
carry the solver's tolerance, so an integrator that finds its Jacobian by differences should take
the FMU's directional derivatives, or an FMU of a scene with a smaller method.tolerance.</p>
"""
AVERAGED = """
<p><b>Means</b>: mean_force and mean_moment are those over the last communication step. Where inputs
move by derivatives they are found by the trapezoidal rule, from the outputs at the last
communication point over <code>substeps</code> intervals, else as means of the sub-steps' ends.
An input that is set anew at a step's start, apart from where it came to, counts there with what it
was: the jump is spread over the first interval. Means have no directional derivatives.</p>
"""
LARGEST_STEP = """
<p><b>largest_step</b> is for masters that hold forces during a step. With K and C the negative
derivatives of force and moment by pose and velocity, and M the mass and inertia (parameters),
w<sup>2</sup> and c are the spectral norms of M<sup>-1/2</sup>KM<sup>-1/2</sup> and
M<sup>-1/2</sup>CM<sup>-1/2</sup>. It is the least of 0.1/w, where the lag takes 2.5 % of critical
damping from the contact's stiffest oscillation, of 1/c, above which creep forces overshoot, and of
1 s. The rest of the model, its damping and further elasticity, is not in it: one that damps the
bounce by less, and integrates exactly under held forces, needs shorter steps. 0: a derivative is
not known. It is found where it is read, and takes two to three steps' time; after a step that
failed it is that of the last good one.</p>
"""
DERIVATIVES = """
<p><b>Directional derivatives</b> of outputs by Real inputs are those of the outputs as they
are, at the inputs they were solved with: inputs set since then do not count in co-simulation before
the next step. They come from the contact's own derivatives, see the range of these there: elements
that stick, slip or are apart stay so. Those of residual are 0: it is the solver's own; so are those
of discrete outputs. Means and largest_step have none and are refused. Beside the inputs
friction.coefficient may be a known; other parameters are refused. After a failed step, or where the
derivative does not converge, the answer is fmi2Discard. State and outputs stay as they
are; after a restored state the first derivative solves once more, and agrees with the one before to
the solver's tolerance. One more entry for the same direction costs nothing.</p>
<p><b>Output derivatives</b>, of order 1, are these along the inputs' own derivatives at the last
step's end, 0 where inputs were held.</p>
"""
NOTICES = {
    "eigen": """Railpatch is under the Apache License 2.0. The library in this FMU also contains

- Eigen, Mozilla Public License 2.0, release 3.4, unchanged,
  source: https://gitlab.com/libeigen/eigen;
""",
    "fftw": """The library in this FMU contains FFTW and is as a whole under the GNU General Public
License, version 3 or later. It is made of

- Railpatch, Apache License 2.0;
- FFTW 3, GPL-2.0-or-later, source: https://www.fftw.org, unchanged;
""",
}
RUNTIME = """- parts of the GCC runtime library, GPL-3.0 with the GCC Runtime Library Exception.
"""
LAST = {
    "eigen": "",
    "fftw": "\nThe same scene can be packed without FFTW: `railpatch fmu --fft eigen`.\n",
}


def notice(backend: str, runtime: str | None = None) -> str:
    """Whose code the library holds. runtime: what the compiler added; None: that of GCC."""
    return NOTICES[backend] + (RUNTIME if runtime is None else runtime) + LAST[backend]


def index_html(
    labels: Labels,
    table: Table,
    kind: Kind,
    variables: list[Variable],
    guid: str,
    case: Case,
    config: dict[str, Any],
) -> str:
    """The page: needs no network. config: of the core, for its profiles."""
    known = [v for v in variables if v.causality in ("input", "parameter")]
    outputs = [v for v in variables if v.causality == "output"]
    title = escape(labels.name)
    return f"""<!DOCTYPE html>
<html lang="en"><head><meta charset="utf-8"><title>{title}</title>
<style>{STYLE}{PICTURE_STYLE}</style></head><body>
<h1>{title}</h1>
<p>{escape(labels.description)} Made by Railpatch {escape(labels.version)}; licence:
{escape(labels.licence)}; GUID <code>{escape(guid)}</code>.</p>
<h2>This scene</h2>
<p>What the FMU was made of, as the keys of its case; inputs and parameters are not among them, they
are listed below with their start values. What a key says beyond its default is in the FMU itself
too, as a constant (causality local) of the same name.</p>
{scene_table(case, names_of(known))}
<h2>Frames and signs</h2>{FRAMES + REFERENCE_POINTS if kind.kind != "patch" else PATCH_FRAME}
{pictures(kind, config)}
<h2>Inputs and parameters</h2>{apart(labels)}
<p>Start values are those of the scene: the FMU runs without any being set. Geometry, material and
method are fixed in the FMU; parameters may be changed between steps{fixed(known)}.</p>
{variable_table(table, known, None, kind)}{MISSING if kind.kind != "patch" else ""}
<h2>Outputs</h2>
<p>"Acts on it" names the inputs that an output depends on: all, or those of the geometry
(pose), also of the speeds along the track (rolling), also of other speeds (sliding), also
friction.</p>
{variable_table(table, outputs, known, kind)}
<h2>Reference</h2>{REFERENCE}
<h2>Range of validity</h2>{RANGE}
<h2>Coupling</h2>{COUPLING}
<p><b>Length of a step</b>: {labels.step.sentence()}</p>{interfaces(labels, kind)}
</body></html>
"""


def names_of(variables: list[Variable]) -> set[str]:
    """Of vectors without the component."""
    return {v.name.partition("[")[0] for v in variables}


def apart(labels: Labels) -> str:
    """What touches nothing at the start."""
    return "".join(f"<p><b>Warning</b>: {escape(text)}</p>" for text in labels.warnings)


def fixed(known: list[Variable]) -> str:
    """Parameters that are no longer settable after initialization."""
    names = [f"<code>{escape(v.name)}</code>" for v in known if v.fixed]
    return f"; {' and '.join(names)} before the end of initialization only" if names else ""


def interfaces(labels: Labels, kind: Kind) -> str:
    """What this FMU offers to masters."""
    parts = [HISTORY if kind.has_history else NO_HISTORY]
    if "averaged" in kind.conditions:
        parts.append(AVERAGED)
    if "largest step" in kind.conditions:
        parts.append(LARGEST_STEP)
    if labels.derivatives:
        parts.append(DERIVATIVES)
    return "".join(parts)


def variable_table(
    table: Table, variables: list[Variable], known: list[Variable] | None, kind: Kind
) -> str:
    """One row for each variable. known: what may act on it, for outputs."""
    last = "start" if known is None else "acts on it"
    heads = ("name", "reference", "unit", "shown in", "from", "to", last, "meaning")
    rows = ["<tr>" + "".join(f"<th>{head}</th>" for head in heads) + "</tr>"]
    for v in variables:
        declared = table.types[v.type]
        shown = declared["display"][0] if "display" in declared else ""
        if known is None:
            cell = f"{v.start:g}" if not isinstance(v.start, str) else v.start
        else:
            found = len(dependencies(v, known, kind))
            cell = "all" if found == len(known) else f"{v.level} ({found})"
        low, high = (f"{limit:g}" for limit in v.range)
        if v.base == "String":
            low = high = ""
        meaning = v.description
        if "items" in declared:
            numbered = enumerate(declared["items"], first_item(declared))
            items = ", ".join(f"{i} {item}" for i, item in numbered)
            meaning = f"{meaning} ({items})"
        cells = [f"<code>{escape(v.name)}</code>", str(v.reference), declared.get("unit", "")]
        cells += [escape(shown), low, high, cell, escape(meaning)]
        rows.append("<tr>" + "".join(f"<td>{text}</td>" for text in cells) + "</tr>")
    return "<table>\n" + "\n".join(rows) + "\n</table>"
