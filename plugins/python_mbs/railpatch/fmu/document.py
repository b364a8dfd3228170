"""documentation/index.html and the notice of licences."""

from __future__ import annotations

from html import escape

from railpatch.fmu.description import Labels
from railpatch.fmu.table import Kind, Table, Variable, dependencies

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
MISSING = """
<p>Inputs without effect do not exist: a wheel may be turned about its axle and a rail moved
along x without any change. Rails and rollers turn about x only in this version. Outputs
of a patch that is not there are 0, its status is no_contact.</p>
"""
RANGE = """
<p>The theory is that of elastic half-spaces in steady rolling with Coulomb friction: patches are
small against the radii of wheel and rail, and motion changes little while the wheel rolls one
patch length. Lift-off is a valid result: status no_contact, all forces 0. A step that does not
converge, or in which contact leaves the profiles or needs more elements or patches than the FMU
was made with, ends with fmi2Discard: the time stays at that of the last good step, outputs keep
its values, and the message in the category logStatusDiscard says what to change. Go on from a saved
state, or reset. Values outside
the ranges below are refused with fmi2Error, and nothing is set.</p>
"""
COUPLING = """
<p>Co-simulation lags: the forces after a step belong to the motion that was set before it, so a
master that exchanges values once a step delays the contact force by one communication step. A
delayed spring acts like one with a negative damper of stiffness times step: a wheel's contact of
about 1e9 N/m and steps of 0.1 ms take 1e5 N s/m of damping out of the system. Therefore:</p>
<ul>
<li>Choose steps so short that the rest of the model damps more than that, and halve them until
results stay.</li>
<li>Or iterate: save the state, step, correct the motion, restore, step again. States can be saved,
restored and serialised at any time; a restored step gives the same bits.</li>
<li>Or give the vertical force instead of z, in the scene: z is then found inside, and only the
softer creep forces lag.</li>
</ul>
<p>The last solution is the start of the next one. It changes results only within the solver's
tolerance, and is part of the saved state. Steps may vary in length; inputs are held during a step.
In initialization mode outputs follow the inputs at once.</p>
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
    labels: Labels, table: Table, kind: Kind, variables: list[Variable], guid: str
) -> str:
    """The page: needs no network."""
    known = [v for v in variables if v.causality != "output"]
    outputs = [v for v in variables if v.causality == "output"]
    title = escape(labels.name)
    return f"""<!DOCTYPE html>
<html lang="en"><head><meta charset="utf-8"><title>{title}</title>
<style>{STYLE}</style></head><body>
<h1>{title}</h1>
<p>{escape(labels.description)} Made by Railpatch {escape(labels.version)}; licence:
{escape(labels.licence)}; GUID <code>{escape(guid)}</code>.</p>
<h2>Frames and signs</h2>{FRAMES}
<h2>Inputs and parameters</h2>
<p>Start values are those of the scene: the FMU runs without any being set. Geometry, material and
method are fixed in the FMU; the parameter may be changed between steps.</p>
{variable_table(table, known, None, kind)}{MISSING}
<h2>Outputs</h2>
<p>"Acts on it" names the inputs that an output depends on: all, or those of the geometry
(pose), also of the speeds along the track (rolling), also of other speeds (sliding), also
friction.</p>
{variable_table(table, outputs, known, kind)}
<h2>Range of validity</h2>{RANGE}
<h2>Coupling</h2>{COUPLING}
</body></html>
"""


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
            cell = f"{v.start:g}"
        else:
            found = len(dependencies(v, known, kind))
            cell = "all" if found == len(known) else f"{v.level} ({found})"
        low, high = (f"{limit:g}" for limit in v.range)
        meaning = v.description
        if "items" in declared:
            items = ", ".join(f"{i} {item}" for i, item in enumerate(declared["items"]))
            meaning = f"{meaning} ({items})"
        cells = [f"<code>{escape(v.name)}</code>", str(v.reference), declared.get("unit", "")]
        cells += [escape(shown), low, high, cell, escape(meaning)]
        rows.append("<tr>" + "".join(f"<td>{text}</td>" for text in cells) + "</tr>")
    return "<table>\n" + "\n".join(rows) + "\n</table>"
