"""The page that `make demo` ends with: python -m railpatch.fmu.demo_page DIR FRONTIER.svg

DIR holds what the demo has made: run.mcap, wheelset.mcap, railpatch.fmu and their reports.
"""

from __future__ import annotations

import contextlib
import io
import sys
import zipfile
from html import escape
from pathlib import Path

import numpy as np
import plotly.graph_objects as go

from railpatch.case.types import SIDES
from railpatch.log import read_run
from railpatch.page.document import document
from railpatch.page.figures import COLORS, plot, styled
from railpatch.page.parts import GOOD, Key, opening
from railpatch.page.tables import short
from railpatch.report import answers, balance_figures, figures, reference
from railpatch.report.data import Positions, positions
from railpatch.report.reference import Match
from railpatch.writing import write_whole

PAGE = "index.html"
# inputs of the FMU of a wheelset on rollers, by the fields of a log
INPUTS = {
    "wheelset.y": "y",
    "wheelset.z": "z",
    "wheelset.roll": "roll",
    "wheelset.yaw": "yaw",
    "wheelset.pitch_rate": "pitch_rate",
    "track.roller_pitch_rate": "roller_pitch_rate",
}


def main() -> None:
    """Writes DIR/index.html and prints its name."""
    folder, frontier = map(Path, sys.argv[1:3])
    print(write_demo_page(folder, frontier))


def write_demo_page(folder: Path, frontier: Path) -> Path:
    """Four pictures, each with a sentence and a link; returns the page.

    frontier: the picture of errors against run times, SVG; it and the FMU's documentation are put
    beside the page. Raises OSError, RunFileError, ReportError.
    """
    with zipfile.ZipFile(folder / "railpatch.fmu") as packed:
        write_whole(folder / "railpatch.html", packed.read("documentation/index.html"))
    write_whole(folder / "frontier.svg", frontier.read_bytes())
    rig = positions(read_run(folder / "run.mcap"))
    wheelset = positions(read_run(folder / "wheelset.mcap"))
    matches = reference.match(reference.load(reference.find() or Path()), rig)
    driven = fmu_ratios(folder / "railpatch.fmu", rig)
    off = np.concatenate([driven[side] - rig.ratio[side] for side in SIDES])
    largest = float(np.nanmax(np.abs(off)))
    waves = answers.waves_of(wheelset)
    cards = [
        card(
            "Roller rig",
            f"{answers.agreement_text(rig, matches)} The points are forces that the program "
            "CONTACT computed for the same test.",
            plot(figures.traction_curves(rig, matches), "rig"),
            [("report.html", "the whole report"), ("run.mcap", "its log")],
        ),
        card(
            "Wheelset on track",
            answers.wave_text(wheelset),
            plot(balance_figures.waves(wheelset), "wheelset"),
            [("wheelset.html", "the whole report"), ("wheelset.mcap", "its log")],
        ),
        card(
            "FMU",
            f"The FMU, driven by fmpy through the {rig.count} positions of the rig, gives L/V "
            f"within {short(largest)} of the run.",
            plot(fmu_figure(rig, driven), "fmu"),
            [("railpatch.fmu", "the FMU"), ("railpatch.html", "its variables and what they mean")],
        ),
        card(
            "Error against run time",
            "Every method against the exact theory, as the whole benchmark measured it; "
            "railpatch bench measures it on this machine.",
            svg_of(frontier),
            [("frontier.svg", "the picture by itself")],
        ),
    ]
    keys = [
        Key("L/V off the reference", short(rms_of(rig, matches)), "root mean square"),
        Key("wave length", f"{short(waves.length)} m", f"Klingel {short(waves.klingel)} m"),
        Key("FMU off the run, L/V", short(largest), "largest"),
        Key("positions and steps solved", str(rig.count + wheelset.count)),
    ]
    verdict = "Railpatch is built; rig, wheelset and FMU ran on this machine."
    body = opening("Railpatch: the demo", "", verdict, keys, GOOD)
    body += f"<div class=cards>{''.join(cards)}</div>"
    return write_whole(folder / PAGE, document("demo", body).encode())


def card(title: str, sentence: str, picture: str, links: list[tuple[str, str]]) -> str:
    """A picture, a sentence and links to files beside the page. picture: HTML."""
    shown = ", ".join(f'<a href="{escape(name)}">{escape(text)}</a>' for name, text in links)
    return f"<div class=card><h2>{title}</h2><p>{escape(sentence)}</p>{picture}<p>{shown}</p></div>"


def svg_of(path: Path) -> str:
    """As HTML, as wide as its place."""
    text = path.read_text(encoding="utf-8")
    return f'<div class="drawn">{text[text.index("<svg") :]}</div>'


def rms_of(data: Positions, matches: list[Match]) -> float:
    """-, of the differences of L/V; NaN without a reference."""
    off = reference.differences(matches, data)["ratio"] if matches else np.empty(0)
    off = off[np.isfinite(off)]
    return float(np.sqrt((off**2).mean())) if off.size else float("nan")


def fmu_ratios(path: Path, data: Positions) -> dict[str, np.ndarray]:
    """L/V by side at the run's positions, [n], of an FMU of its scene that is led through them."""
    from fmpy import simulate_fmu

    # inputs hold through a step, after which the outputs are theirs
    count, step = data.count, 1.0
    times = step * np.arange(count + 1)
    names = list(INPUTS)
    signals = np.zeros(count + 1, dtype=[("time", float), *((name, float) for name in names)])
    signals["time"] = times
    for name in names:
        values = data.state[INPUTS[name]]
        signals[name] = np.r_[values, values[-1]]
    outputs = [f"{side}.force[{axis}]" for side in SIDES for axis in (2, 3)]
    # it tells of every input that keeps its start value
    with contextlib.redirect_stdout(io.StringIO()):
        rows = simulate_fmu(
            str(path),
            stop_time=times[-1],
            step_size=step,
            output_interval=step,
            input=signals,
            output=outputs,
            set_stop_time=False,
        )
    return {side: rows[f"{side}.force[2]"][1:] / rows[f"{side}.force[3]"][1:] for side in SIDES}


def fmu_figure(data: Positions, driven: dict[str, np.ndarray]) -> go.Figure:
    """L/V of the run, and of the FMU at its positions."""
    figure, yaw = go.Figure(), 1e3 * data.state["yaw"]
    for side in SIDES:
        style = {"color": COLORS[side]}
        figure.add_scatter(x=yaw, y=data.ratio[side], name=f"run, {side}", mode="lines", line=style)
        marker = {**style, "symbol": "circle-open", "size": 9}
        figure.add_scatter(
            x=yaw, y=driven[side], name=f"FMU, {side}", mode="markers", marker=marker
        )
    figure.update_xaxes(title_text="yaw [mrad]")
    figure.update_yaxes(title_text="L/V = F<sub>y</sub>/F<sub>z</sub>")
    return styled(figure, 400)


if __name__ == "__main__":
    main()
