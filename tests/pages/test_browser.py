"""Pages in a browser: no error, no text over text, nothing too faint or too wide; light, dark, on a
phone, printed. `make pages` runs them; they need Chromium."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path

import pytest
import synthetic
import synthetic_vehicle as vehicle
from railpatch.page.browser import Browser
from railpatch.page.document import document
from railpatch.page.printing import write_figure
from railpatch.report import write_report

pytestmark = pytest.mark.browser
HERE = Path(__file__).resolve().parent
LOOK = (HERE / "look.js").read_text(encoding="utf-8")
# name: width in px, dark, printed
VIEWS = {
    "light": (1280, False, False),
    "dark": (1280, True, False),
    "phone": (390, False, False),
    "narrow": (500, True, False),
    "print": (688, False, True),
}
LARGEST = 2e6  # bytes
# made by tests/pages/make.py: what needs a solver, or minutes
MADE = {
    *("bench", "damage", "hunting", "match", "profile", "stress", "subsurface", "sweep", "wear"),
}


@pytest.fixture(scope="module")
def browser() -> Iterator[Browser]:
    with Browser() as found:
        yield found


@pytest.fixture(scope="module")
def pages(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Path]:
    folder = tmp_path_factory.mktemp("pages")
    rig = synthetic.write_rig_run(folder / "rig.mcap")
    runs = {
        "rig": rig,
        "wheelset": synthetic.write_wheelset_run(folder / "wheelset.mcap"),
        "vehicle": vehicle.write_run(folder / "vehicle.mcap"),
    }
    found = {name: write_report(run, folder / f"{name}.html") for name, run in runs.items()}
    found["beside"] = write_report(rig, folder / "beside.html", beside=rig)
    found |= {page.stem: page for page in sorted(Path("build/pages").glob("*.html"))}
    assert found.keys() >= MADE, "python tests/pages/make.py build/pages makes the others"
    return found


def test_every_page_is_small(pages: dict[str, Path]) -> None:
    large = {name: page.stat().st_size for name, page in pages.items()}
    assert {name: size for name, size in large.items() if size >= LARGEST} == {}


def seen(browser: Browser, view: str) -> list[str]:
    """What is wrong with the page as it is shown."""
    width, dark, printed = VIEWS[view]
    browser.size(width, 900)
    browser.media(dark=dark, printed=printed)
    browser.run("new Promise((done) => setTimeout(done, 250)).then(redrawn).then(() => 0)")
    return browser.run(LOOK) + browser.problems()


def test_every_page_in_every_view(browser: Browser, pages: dict[str, Path]) -> None:
    wrong = []
    for name, page in pages.items():
        browser.size(1280, 900)
        browser.media()
        browser.open(page)
        browser.run("document.querySelectorAll('details').forEach((e) => { e.open = true; })")
        for view in VIEWS:
            wrong += [f"{name}, {view}: {text}" for text in seen(browser, view)]
    assert not wrong, "\n".join(wrong)


def test_what_is_wrong_is_found(browser: Browser, tmp_path: Path) -> None:
    body = (
        "<h1>a</h1><div style='position:absolute;top:90px'>one text</div>"
        "<div style='position:absolute;top:92px'>other text</div>"
        "<table><tr><td style='max-width:60px;min-width:60px;width:60px;padding:0'>"
        "a sentence in a column of single words, one below the other</table>"
        "<p style='color:#999'>faint</p><div style='width:3000px'>wide</div>"
        "<script>window.redrawn = async () => 0; console.error('told')</script>"
    )
    page = tmp_path / "page.html"
    page.write_text(document("x", body), encoding="utf-8")
    browser.size(1280, 900)
    browser.media()
    browser.open(page)
    wrong = "\n".join(seen(browser, "light"))
    texts = ("lie over each other", '"faint": contrast', "wider than the page", "told", "in 60 px")
    for text in texts:
        assert text in wrong, wrong


def test_slider_and_pointer_tell_values(browser: Browser, pages: dict[str, Path]) -> None:
    browser.size(1280, 900)
    browser.media()
    browser.open(pages["beside"])
    hint = browser.run("document.querySelector('.viewer .hint').textContent")
    assert "Point at a patch" in hint
    texts = browser.run(
        """(() => {
        const found = [];
        const slider = document.querySelector(".viewer input[type=range]");
        for (let i = 0; i <= +slider.max; i += 1) {
          slider.value = i;
          slider.dispatchEvent(new Event("input"));
          const where = document.querySelector(".viewer .where").textContent;
          for (const canvas of document.querySelectorAll(".viewer canvas")) {
            const box = canvas.getBoundingClientRect();
            for (const share of [0.02, 0.3, 0.5, 0.98]) {
              const [x, y] = [box.left + share * box.width, box.top + 0.4 * box.height];
              const event = new PointerEvent("pointermove", { clientX: x, clientY: y });
              canvas.dispatchEvent(event);
              found.push(`${where}: ${document.querySelector(".viewer .hint").textContent}`);
            }
          }
        }
        return found;
        })()"""
    )
    assert not [text for text in texts if re.search("NaN|undefined|Infinity", text)]
    inside = [text for text in texts if "MPa" in text]
    assert len(inside) > len(texts) / 4
    # values of both logs, which are the same run
    own, other = inside[0].split("; ")
    assert own.split("pressure")[1] == other.split("pressure")[1]
    assert len({text.split(":")[0] for text in texts}) > 3


def test_figures_as_pictures(pages: dict[str, Path], tmp_path: Path) -> None:
    svg = write_figure(tmp_path / "a.svg", pages["rig"], "traction").read_text(encoding="utf-8")
    assert svg.count("<svg ") >= 3
    assert "yaw [mrad]" in svg
    # titles below their axes: over them where texts could not be measured
    titles = re.findall(r'<text class="xtitle" x="[\d.]+" y="([\d.]+)"', svg)
    labels = re.findall(r'class="xtick"><text text-anchor="middle" x="0" y="([\d.]+)"', svg)
    assert titles
    assert labels
    assert min(map(float, titles)) > max(map(float, labels))
    png = write_figure(tmp_path / "a.png", pages["rig"], "patch", width=600).read_bytes()
    assert png.startswith(b"\x89PNG")
    assert len(png) > 20_000


def test_report_as_pdf(tmp_path: Path) -> None:
    run = synthetic.write_rig_run(tmp_path / "rig.mcap")
    data = write_report(run, tmp_path / "page.pdf").read_bytes()
    assert data.startswith(b"%PDF")
    assert 3 < len(re.findall(rb"/Type\s*/Page\b", data)) < 40
