"""Pages as PDF, and their figures as PNG or SVG, drawn by a browser without a window."""

from __future__ import annotations

import tempfile
from html.parser import HTMLParser
from importlib import resources
from os import PathLike
from pathlib import Path

from railpatch.page.browser import Browser
from railpatch.writing import write_whole

PDF = ".pdf"
PICTURES = (".png", ".svg")
# px: A4 between the margins of the style
PAPER = (688, 1000)
SCALE = 2.0  # pixels of a PNG for a px of the page
HEIGHT = 900


def write_page(output: str | PathLike[str], page: str) -> Path:
    """Writes a page as HTML, or as PDF where the name ends so; returns ``output``.

    Raises BrowserError where a PDF is asked for and no browser can make it, OSError.
    """
    output = Path(output)
    if output.suffix.lower() != PDF:
        return write_whole(output, page.encode())
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "page.html"
        path.write_text(page, encoding="utf-8")
        with Browser() as browser:
            browser.size(*PAPER)
            browser.media(printed=True)
            browser.open(path)
            return write_whole(output, browser.pdf())


def figure_names(page: Path) -> dict[str, bool]:
    """Of a page's figures and patch viewers, in their order, and whether they are made of lines, as
    SVG has them. Raises OSError, UnicodeDecodeError."""
    names = _Names()
    names.feed(page.read_text(encoding="utf-8"))
    return names.found


def write_figure(
    output: Path, page: Path, name: str, *, width: int = 900, dark: bool = False
) -> Path:
    """Writes a figure of a page as PNG or SVG, by the name's ending; returns ``output``.

    width: px. A patch viewer, which is drawn point by point, gives PNG alone. Raises BrowserError,
    OSError.
    """
    script = (resources.files("railpatch.page") / "picture.js").read_text(encoding="utf-8")
    with Browser() as browser:
        browser.size(width, HEIGHT, scale=SCALE)
        browser.media(dark=dark)
        browser.open(page)
        browser.run(script)
        if output.suffix.lower() == ".svg":
            return write_whole(output, browser.run(f"figureAsSvg({name!r})").encode())
        clip = browser.run(f"figureAlone({name!r})")
        return write_whole(output, browser.picture(clip=clip))


class _Names(HTMLParser):
    """Of what is drawn."""

    def __init__(self) -> None:
        super().__init__()
        self.found: dict[str, bool] = {}

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        known = dict(attrs)
        kind, name = (known.get("class") or "").split(), known.get("id")
        if name and (tag == "figure" or {"viewer", "parallel"} & set(kind)):
            self.found[name] = tag == "figure"
