"""The page of a benchmark: one HTML file that needs no network."""

from __future__ import annotations

from html import escape

import numpy as np

from railpatch.evidence.bench.curves import cost_curves, curves, frontier_curve
from railpatch.evidence.bench.features import SIZE
from railpatch.evidence.bench.figures import cost_over_elements, error_over_time
from railpatch.evidence.bench.machine import FFT_SIZE
from railpatch.evidence.bench.run import Report
from railpatch.evidence.bench.sets import SEED, SETS
from railpatch.evidence.bench.statistics import COVERED, FACTOR, WITHIN, Summary, fastest_within
from railpatch.evidence.bench.tail import BOUNDS, REPEATS, SHARES, quantile
from railpatch.evidence.bench.targets import rows
from railpatch.evidence.bench.truth import batches_of
from railpatch.page.document import document
from railpatch.page.figures import plot
from railpatch.page.parts import DOUBT, GOOD, Key, folded, opening
from railpatch.page.tables import number, table

# -, of mu Fn: for which the page opens with a time
ERRORS = (0.05, 0.01, 0.003)
# methods that give resultants and no fields
WITHOUT_FIELDS = ("linear", "polach", "table")
REACHED = {
    "aim": "better than hoped for",
    "must": "as wanted",
    "missed": "slower than wanted",
    "-": "not measured",
}
DEFINITIONS = (
    ("force", "length of the vector difference of creep forces over \u03bcF\u2099"),
    ("moment", "difference of spin moments over \u03bcF\u2099c, c\u00b2 = ab"),
    ("pressure", "relative difference of the greatest pressure"),
    (
        "power",
        "difference of frictional power over \u03bcF\u2099 times the root mean square of the rigid "
        "slip velocity, weighted with Hertz's pressure: V\u221a(\u03be\u00b2 + \u03b7\u00b2 + "
        "\u03c6\u00b2(a\u00b2 + b\u00b2)/5)",
    ),
    ("cold", "no earlier solution is known"),
    (
        "warm",
        "the step before had creepages and spin 1 % away; in sets C and W, the step before in the "
        "sequence",
    ),
    ("run time", "of the library's step on one core, without Python"),
)


def page(report: Report) -> str:
    """The HTML text."""
    parts = [opening_of(report), *figures(report), without_result(report), targets(report)]
    parts += [set_section(report, name) for name in report.plan.sets]
    parts += [features(report), wheel_evaluations(report), slowest_steps(report)]
    parts += [calibration(report), truth(report), administration(report)]
    return document("error against run time", "".join(parts))


def opening_of(report: Report) -> str:
    """How long a patch takes for an error."""
    first = report.outcome.of_set(report.plan.sets[0])
    fields = [s for s in first if s.method not in WITHOUT_FIELDS]
    keys, told = [], []
    for error in ERRORS:
        best = fastest_within(fields, error)
        name = f"with tractions, error of at most {100 * error:g} %"
        if best is None:
            keys.append(Key(name, "-", "no method is so exact"))
            continue
        time = f"{milliseconds(best.values['warm_median'])} ms"
        told.append(f"{time} for an error of at most {100 * error:g} %")
        keys.append(Key(name, time, best.label))
    for s in first:
        if s.method == "table":
            time = f"{number(1e6 * s.values['warm_median'])} µs"
            error = percent(s.values["force_error_p95"])
            keys.append(Key("forces alone, from the table", time, f"error {error} %"))
            told.append(f"{time} without tractions, from a table, with an error of {error} %")
    wheel = report.outcome.wheel
    keys.append(Key("one wheel of the rig", f"{milliseconds(wheel.wheel)} ms", "grid of 0.4 mm"))
    verdict = "No method of this run is as exact as was asked for."
    if told:
        verdict = f"A contact patch takes {', '.join(told)}."
    steps = sum(s.cases for s in report.outcome.summaries)
    kind = "a part of the benchmark" if report.plan.quick else "the whole benchmark"
    about = (
        f"{kind}: {len(report.plan.methods)} methods, {len(report.outcome.summaries)} combinations "
        f"of grid and set, {steps} cases; one core of {report.machine.processor}"
    )
    state = GOOD if told else DOUBT
    return opening("Error against run time", about, verdict, keys, state)


def without_result(report: Report) -> str:
    """Cases that are in no error."""
    lost = [s for s in report.outcome.summaries if s.not_converged]
    lines = [(s.problem_set, s.label, s.not_converged, s.cases) for s in lost]
    if not lines:
        return ""
    head = ("set", "method", "did not converge, or out of range", "of")
    return f"<h2>Cases without a result</h2><p>They are in no error.</p>{table(head, lines)}"


def administration(report: Report) -> str:
    """Machine and definitions."""
    text = (
        table((), report.machine.rows(), "summary")
        + "<p>To carry times over to another machine, scale them by its time for one real "
        f"{FFT_SIZE} x {FFT_SIZE} FFT. Seed {SEED}.</p>"
    )
    words = folded("What the words mean", table((), DEFINITIONS, "summary"), on_paper=True)
    return words + folded("The machine", text)


def targets(report: Report) -> str:
    """What was measured beside what this project wants."""
    lines = [(r.title, r.measured, r.must, r.aim, REACHED[r.verdict]) for r in rows(report.outcome)]
    return (
        "<h2>Beside what was wanted</h2><p>Set A, medians. What this project wants at most, and "
        "what it hopes for, on a machine with an FFT time of 8.8 us. Wheel and position: "
        f"{escape(report.outcome.wheel.scene)}.</p>"
        + table(("", "measured", "wanted, at most", "hoped for", ""), lines)
    )


def figures(report: Report) -> list[str]:
    """Error against run time, cost over elements."""
    name = report.plan.sets[0]
    found = curves(report.outcome.of_set(name))
    best = frontier_curve(found)
    lines = [
        (label, milliseconds(time), percent(error))
        for label, time, error in zip(best.labels, best.time, best.error, strict=True)
    ]
    return [
        f"<h2>Error against run time</h2><p>Set {name}: {SETS[name].title}. Points further left "
        "and further down are better; the broad line joins those that no other beats. The "
        "diamonds are published results of the program CONTACT, measured on another machine, cold, "
        "and against its own extrapolation.</p>",
        plot(error_over_time(found), "frontier"),
        table(("on the frontier", "warm [ms]", "force error, 95th percentile [%]"), lines),
        "<h2>Cost over the number of elements</h2><p>Circular contact, partial slip. Powers of N "
        "are fitted to all points of a line.</p>",
        plot(cost_over_elements(cost_curves(report.outcome.costs)), "cost"),
    ]


def set_section(report: Report, name: str) -> str:
    """Errors, run times and work of every method on one set."""
    summaries = report.outcome.of_set(name)
    count = sum(map(len, batches_of(name)))
    known = name in report.truth.names
    errors = (
        table(
            ("method", "cases", "force", "moment", "pressure", "power"),
            [error_row(s) for s in summaries],
        )
        if known
        else "<p>No truth of this set is stored: run times alone are measured.</p>"
    )
    return (
        f"<h2>Set {name}: {SETS[name].title}</h2><p>{count} cases in all."
        f"{' Errors in %, as median / 95th percentile / greatest.' if known else ''}</p>"
        + errors
        + "<p>Run times in ms, median / 99th percentile; iterations of the normal and Newton steps "
        "of the tangential problem, and products with the tangential operator, as median / most; "
        "start: greatest difference of the force over \u03bcF\u2099 of cold and warm starts.</p>"
        + table(
            ("method", "cold", "warm", "iterations cold", "warm", "products cold", "warm",
             "start", "memory [kB]", "not converged"),
            [work_row(s) for s in summaries],
        )
    )  # fmt: skip


def error_row(summary: Summary) -> list[object]:
    """Errors of one method and grid."""
    values = summary.values
    cells: list[object] = [summary.label, summary.cases]
    for name in ("force", "moment", "pressure", "power"):
        numbers = (values[f"{name}_error_{key}"] for key in ("median", "p95", "max"))
        cells.append(" / ".join(percent(value) for value in numbers))
    return cells


def work_row(summary: Summary) -> list[object]:
    """Run times and work of one method and grid."""
    values = summary.values
    times = [
        " / ".join(milliseconds(values[f"{name}_{key}"]) for key in ("median", "p99"))
        for name in ("cold", "warm")
    ]
    work = [
        " / ".join(number(values[f"{name}_{kind}_{key}"]) for key in ("median", "max"))
        for kind in ("iterations", "products")
        for name in ("cold", "warm")
    ]
    start = f"{values['start_difference_max']:.1e}"
    return [
        summary.label, *times, *work, start, number(values["bytes"] / 1024), summary.not_converged,
    ]  # fmt: skip


def features(report: Report) -> str:
    """Cost of each piece of physics beside a plain scene."""
    lines = [
        [
            f.name,
            milliseconds(f.cold),
            milliseconds(f.warm),
            f"{f.cold_ratio:.2f}",
            f"{f.warm_ratio:.2f}",
            number(f.bytes / 1024),
            "" if f.good else "not converged",
        ]
        for f in report.features
    ]
    return (
        "<h2>Physics</h2><p>A step with one thing more (the last ones with several) than a plain "
        f"scene: {SIZE} x {SIZE} elements on the half-space, circular contact, partial slip. "
        "Ratios are medians of the times over those of the plain scene in the same pass.</p>"
        + table(
            ("scene", "cold [ms]", "warm [ms]", "cold, ratio", "warm, ratio", "memory [kB]", ""),
            lines,
        )
    )


def wheel_evaluations(report: Report) -> str:
    """One wheel's contact search, evaluation and derivatives."""
    lines = [
        [
            e.name,
            milliseconds(e.evaluation),
            milliseconds(e.matrix),
            f"{e.ratio:.2f}",
            number(e.bytes / 1024),
            "" if e.good else "not converged",
        ]
        for e in report.evaluations
    ]
    return (
        "<h2>One wheel</h2><p>S1002 on UIC60, one patch: a warm evaluation of the force at a new "
        "position, and its derivatives by pose and velocity (6 x 12). Contact search with "
        f"placement, profiles sampled every 0.2 mm: {number(1e6 * report.search)} µs (median).</p>"
        + table(("grid", "force [ms]", "derivatives [ms]", "ratio", "their memory [kB]", ""), lines)
    )


def slowest_steps(report: Report) -> str:
    """How far the slowest steps of a moving wheel are from the usual ones."""
    lines, bins = [], []
    for one in report.tails:
        head = [one.name, one.prescribed]
        times = [quantile(one.seconds, share) for share in SHARES]
        work = [quantile(one.evaluations, share) for share in SHARES[::3]]
        work += [quantile(one.work, share) for share in SHARES[::3]]
        ratios = [f"{times[k] / times[0]:.1f}" for k in (2, 3)]
        lines.append(
            [
                *head,
                *(number(1e6 * t) for t in times),
                *ratios,
                *(f"{w:.0f}" for w in work),
                one.lifted,
                one.bad,
            ]
        )
        bins.append([*head, *one.histogram()])
    percentiles = [f"{share:g} % [µs]" for share in SHARES]
    ranges = [f"to {bound:g}" for bound in BOUNDS] + ["beyond"]
    return (
        "<h2>The slowest steps</h2><p>S1002 on UIC60, steps as at 1 ms: a random walk over tread, "
        "root and flange; where the position is prescribed, off the rail and back too. Each step "
        f"is made {REPEATS} times from the same state, and its least processor time counts. Times "
        "that so many steps are not above, and their ratio to the median. Evaluations and "
        "operator products of a step: median and most; they do not depend on the machine.</p>"
        + table(
            ("method", "prescribed", *percentiles, "99.99 %, ratio", "100 %, ratio",
             "evaluations", "most", "products", "most", "no contact", "bad"),
            lines,
        )
        + "<p>Histogram: steps by their time in medians.</p>"
        + table(("method", "prescribed", *ranges), bins)
    )  # fmt: skip


def calibration(report: Report) -> str:
    """How the results' own error estimates compare with the errors."""
    lines = []
    for s in report.outcome.summaries:
        shares = [
            s.values[f"{name}_estimate_{kind}"]
            for name in ("force", "moment", "pressure")
            for kind in ("covers", "within")
        ]
        if np.isfinite(shares).any():
            lines.append([s.problem_set, s.label, *(percent(share) for share in shares)])
    head = "<h2>Error estimates</h2>"
    if not lines:
        return f"{head}<p>No result of this version carries an error estimate.</p>"
    return (
        f"{head}<p>Share of cases [%] whose error is at most the estimate (wanted: "
        f"{100 * COVERED:.0f}), and whose estimate is at most {FACTOR:g} times the error (wanted: "
        f"{100 * WITHIN:.0f}).</p>"
        + table(
            ("set", "method", "force: covers", "within", "moment: covers", "within",
             "pressure: covers", "within"),
            lines,
        )
    )  # fmt: skip


def truth(report: Report) -> str:
    """Recipes of the truth, and how far they agree."""
    recipes = [
        (
            r["name"],
            r["sets"],
            r["method"],
            f"{r['unit']} {', '.join(map(str, r['grids']))}",
            r["order"],
        )
        for r in report.truth.recipes
    ]
    lines = []
    for name in report.truth.names:
        others = report.truth.recipes_of(name)[1:]
        for recipe, agreement in zip(others, report.truth.agreement(name), strict=True):
            taken = agreement[np.isfinite(agreement[:, 0])]
            for column, quantity in enumerate(("force", "moment", "pressure")):
                shares = [np.percentile(taken[:, column], share) for share in (50, 95, 100)]
                lines.append(
                    [name, recipe["name"], len(taken), quantity, *(percent(v) for v in shares)]
                )
    return (
        "<h2>Truth</h2><p>Each recipe is extrapolated over its grids to elements of size zero; the "
        "first one of a set is its truth, the differences of the others from it say how far it can "
        "be trusted. Differences in %.</p>"
        + table(("recipe", "sets", "method", "grids", "order"), recipes)
        + table(
            ("set", "other recipe", "cases", "quantity", "median", "95th percentile", "greatest"),
            lines,
        )
    )


def percent(value: float) -> str:
    """Three digits."""
    return f"{100 * value:.3g}" if np.isfinite(value) else "-"


def milliseconds(value: float) -> str:
    """Three digits."""
    return f"{1e3 * value:.3g}" if np.isfinite(value) else "-"
