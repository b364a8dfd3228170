"""What pages are made of: figures taken apart, key numbers, packed patches, colours."""

from __future__ import annotations

import base64
import json
import re
from importlib import resources

import numpy as np
import plotly.graph_objects as go
import pytest
from page_checks import data_of
from plotly.subplots import make_subplots
from railpatch.page.browser import BrowserError, find_browser
from railpatch.page.document import document
from railpatch.page.figures import BAD, COLORS, GREY, LINES, OTHER, plot, styled
from railpatch.page.panels import marked_up, packed, parts_of
from railpatch.page.parts import BAD as ABOVE
from railpatch.page.parts import DOUBT, GOOD, Key, against, folded, key_numbers, opening
from railpatch.page.tables import short
from railpatch.page.viewer import MOST_BYTES, few, patches_viewer

TEXT, LINE = 4.5, 3.0  # least contrast: WCAG 2.1, 1.4.3 and 1.4.11


def two_by_two() -> go.Figure:
    figure = make_subplots(
        2, 2, shared_xaxes=True, shared_yaxes=True, subplot_titles=("a", "b", "", "")
    )
    for row in (1, 2):
        for column in (1, 2):
            values = np.array([0.0, row * column])
            figure.add_scatter(
                x=[1.0, 2.0], y=values, name="one", legendgroup="one",
                showlegend=(row, column) == (1, 1), row=row, col=column,
            )  # fmt: skip
    figure.add_scatter(x=[1.0], y=[1.0], name="two", mode="markers", row=2, col=2)
    for row in (1, 2):
        figure.update_yaxes(title_text=f"force {row} [kN]", row=row, col=1)
    figure.update_xaxes(title_text="yaw [mrad]", row=2)
    return styled(figure, 610)


def test_a_figure_is_taken_apart_into_its_panels() -> None:
    parts = parts_of(two_by_two())
    assert parts.columns == 2
    titles = [panel.title for panel in parts.panels]
    assert titles == ["a · force 1 [kN]", "b · force 1 [kN]", "force 2 [kN]", "force 2 [kN]"]
    assert [panel.height for panel in parts.panels] == [250] * 4
    # over one quantity, they move together
    assert {panel.link for panel in parts.panels} == {"yaw [mrad]"}
    assert [len(panel.traces) for panel in parts.panels] == [1, 1, 1, 2]
    assert [(entry.name, entry.symbol) for entry in parts.legend] == [
        ("one", "line"),
        ("two", "circle"),
    ]


def test_panels_of_a_row_share_their_range() -> None:
    ranges = [panel.layout["yaxis"]["range"] for panel in parts_of(two_by_two()).panels]
    assert ranges[0] == ranges[1] == pytest.approx([-0.1, 2.1])
    assert ranges[2] == ranges[3] == pytest.approx([-0.2, 4.2])


def test_pointing_at_a_curve_tells_names_and_units() -> None:
    trace = parts_of(two_by_two()).panels[3].traces[0]
    assert trace["hovertemplate"] == (
        "<b>one</b><br>yaw %{x:.4g} mrad<br>force 2 %{y:.5g} kN<extra></extra>"
    )


def test_numbers_are_packed_and_what_is_none_is_null() -> None:
    values = np.array([1.5, np.nan, -2.0])
    found = packed({"y": values, "z": values.reshape(3, 1), "text": None, "few": [1.0, np.inf]})
    assert set(found) == {"y", "z", "few"}
    assert found["few"] == [1.0, None]
    decoded = np.frombuffer(base64.b64decode(found["y"]["bdata"]), dtype="<f4")
    assert np.array_equal(decoded, values.astype("f4"), equal_nan=True)
    assert found["z"]["shape"] == "3,1"


def test_texts_of_files_stay_texts() -> None:
    assert marked_up("F<sub>y</sub> <script>") == "F<sub>y</sub> &lt;script&gt;"
    html = opening("<b>", "<i>", "a < b", [Key("<u>", "1 & 2", "<s>", GOOD)])
    assert not re.search(r"<(b|i|u|s)>", html)
    figure = go.Figure(go.Scatter(x=[0, 1], y=[0, 1], name="</script><script>alert(1)"))
    page = document("x", plot(figure, "f"))
    assert "alert(1)" not in re.sub(r"<script.*?</script>", "", page, flags=re.S)
    assert data_of(page)["f"]["panels"][0]["traces"][0]["name"] == "</script><script>alert(1)"


def test_a_page_is_the_same_for_the_same_numbers() -> None:
    assert document("x", plot(two_by_two(), "f")) == document("x", plot(two_by_two(), "f"))


def test_long_names_break_between_their_words() -> None:
    html = key_numbers([Key("right.damage.wear_rate", "1 kg/m"), Key("at 0.5 mm", "2")])
    assert "<dt>right.<wbr>damage.<wbr>wear_<wbr>rate</dt>" in html
    assert "<dt>at 0.5 mm</dt>" in html


def test_a_number_beside_its_limit() -> None:
    assert against(0.5, 0.8, "0.8") == ("within 0.8", GOOD)
    assert against(0.75, 0.8, "0.8") == ("near 0.8", DOUBT)
    assert against(0.81, 0.8, "0.8") == ("above 0.8", ABOVE)
    assert folded("nothing", "") == ""


@pytest.mark.parametrize(
    ("value", "text"),
    [
        (0.0020484, "0.00205"),
        (3.52e8, "3.52\u00d710\u2078"),
        (-2.4e-6, "\u22122.4\u00d710\u207b\u2076"),
        (0.0, "0"),
    ],
)
def test_three_digits(value: float, text: str) -> None:
    assert short(value) == text


def luminance(color: str) -> float:
    """Relative, WCAG 2.1."""
    channels = [int(color[i : i + 2], 16) / 255 for i in (1, 3, 5)]
    linear = [c / 12.92 if c <= 0.04045 else ((c + 0.055) / 1.055) ** 2.4 for c in channels]
    return float(np.dot([0.2126, 0.7152, 0.0722], linear))


def contrast(one: str, other: str) -> float:
    low, high = sorted((luminance(one), luminance(other)))
    return (high + 0.05) / (low + 0.05)


def schemes() -> list[dict[str, str]]:
    """Colours of a light, a dark and a printed page."""
    style = (resources.files("railpatch.page") / "page.css").read_text(encoding="utf-8")
    blocks = re.findall(r":root \{(.*?)\}", style, re.S)
    return [dict(re.findall(r"--([\w-]+): (#\w{6});", block)) for block in blocks]


@pytest.mark.parametrize("scheme", range(3))
def test_texts_and_lines_stand_out(scheme: int) -> None:
    colors = schemes()[scheme]
    for ground in ("ground", "panel"):
        for ink in ("ink", "soft", "good", "bad", "doubt", "link"):
            assert contrast(colors[ink], colors[ground]) >= TEXT, (ink, ground)
        for line in {*COLORS.values(), *LINES, GREY, BAD, OTHER}:
            assert contrast(line, colors[ground]) >= LINE, (line, ground)
    assert contrast(colors["warn-ink"], colors["warn"]) >= TEXT


def patch(columns: int = 9, rows: int = 7) -> dict[str, object]:
    """Fields with an edge of elements that are not in contact."""
    x, y = np.meshgrid(np.linspace(-4e-3, 4e-3, columns), np.linspace(-3e-3, 3e-3, rows))
    pressure = 1e9 * np.sqrt(np.clip(1 - (x / 3.5e-3) ** 2 - (y / 2.5e-3) ** 2, 0, None))
    traction = np.stack([-0.3 * pressure, 0.1 * pressure], axis=-1)
    division = np.where(pressure > 0, np.where(x > 0, 1, 2), 0)
    return {
        "patch": 0, "x": x, "y": y, "pressure": pressure, "traction": traction,
        "element_division": division, "temperature": 20 + 1e-8 * pressure,
    }  # fmt: skip


def shown_by(html: str) -> dict[str, object]:
    return json.loads(re.search(r"<script[^>]*>(.*?)</script>", html, re.S)[1])["data"]


def test_fields_of_a_patch_are_what_was_logged() -> None:
    own = patch()
    data = shown_by(patches_viewer("p", ["left"], [0.5], ["here"], [[[own]]], 0))
    assert set(data["kinds"]) == {"pressure", "traction", "states", "temperature"}
    assert [name for name, _, _ in data["states"]] == ["stick", "slip"]
    found = data["patches"][0]
    inside = own["pressure"] > 0
    rows, columns = np.flatnonzero(inside.any(axis=1)), np.flatnonzero(inside.any(axis=0))
    box = np.ix_(rows, columns)
    for name, values, scale in (
        ("pressure", own["pressure"], 1e-6),
        ("tx", own["traction"][..., 0], 1e-6),
        ("ty", own["traction"][..., 1], 1e-6),
        ("temperature", own["temperature"], 1.0),
    ):
        low, step, text = found[name]
        got = low + step * np.frombuffer(base64.b64decode(text), dtype="<u2")
        wanted = scale * values[box].ravel()
        assert got == pytest.approx(wanted, abs=1.01 * np.ptp(wanted) / 65534), name
        if name != "temperature":
            assert (np.abs(got[~inside[box].ravel()]) < 1e-9).all(), name
    states = np.frombuffer(base64.b64decode(found["states"]), dtype=np.uint8)
    assert np.array_equal(states, own["element_division"][box].ravel())


def test_long_runs_keep_some_positions_and_the_first_one_shown() -> None:
    frames = [[[patch(60, 50)]]] * 400
    kept = few(frames, 333)
    assert 333 in kept
    assert 7 * 3000 * len(kept) <= 1.05 * MOST_BYTES
    assert few(frames[:10], 3) == list(range(10))


def test_what_is_said_without_a_browser(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("RAILPATCH_BROWSER", "no-such-browser")
    with pytest.raises(BrowserError, match="RAILPATCH_BROWSER: value is 'no-such-browser'"):
        find_browser()
    monkeypatch.delenv("RAILPATCH_BROWSER")
    monkeypatch.setenv("PATH", "")
    with pytest.raises(BrowserError, match=r"no browser was found.*chromium"):
        find_browser()
