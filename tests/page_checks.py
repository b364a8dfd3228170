"""What holds of every page, read from its file: it answers first, is small, and fetches nothing."""

from __future__ import annotations

import base64
import gzip
import json
import re
from html import unescape
from html.parser import HTMLParser
from pathlib import Path
from typing import Any

MOST = 2_000_000  # bytes
KEYS = (4, 7)
_VOID = {"meta", "br", "input", "img", "path", "circle", "rect", "link", "hr", "wbr"}


def data_of(page: str) -> dict[str, Any]:
    """What the page's figures and viewers show, by name."""
    found = re.search(r'<script type="application/gzip" id="data">(.*?)</script>', page)
    return json.loads(gzip.decompress(base64.b64decode(found[1]))) if found else {}


class Order(HTMLParser):
    """Order of what a reader meets, and whether every tag is closed."""

    def __init__(self) -> None:
        super().__init__()
        self.open: list[str] = []
        self.met: list[str] = []
        self.folded = 0
        self.keys = 0

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        kind = dict(attrs).get("class") or ""
        if tag == "details":
            self.folded += 1
        if not self.folded:
            if tag in ("h1", "h2", "figure", "table"):
                self.met.append(tag)
            self.met += [name for name in ("verdict", "keys", "viewer") if name in kind.split()]
        self.keys += "key" in kind.split()
        if tag not in _VOID:
            self.open.append(tag)

    def handle_endtag(self, tag: str) -> None:
        if tag in _VOID:
            return
        last = self.open.pop()
        assert last == tag, f"</{tag}> closes <{last}>"
        self.folded -= tag == "details"


def check_page(path: Path, *, keys: tuple[int, int] = KEYS) -> dict[str, Any]:
    """Raises AssertionError; gives what its figures show."""
    page = path.read_text(encoding="utf-8")
    size = path.stat().st_size
    assert size < MOST, f"{path.name}: {size} bytes"
    body = re.sub(r"<(script|style).*?</\1>", "", page, flags=re.S)
    assert not re.search(r"(src|href)=[\"']?(http|//)", body), path.name
    assert not re.search(r"\b(nan|NaN|inf|None)\b", re.sub(r"<[^>]+>", " ", body)), path.name
    order = Order()
    order.feed(body)
    assert not order.open, order.open
    assert order.met[:3] == ["h1", "verdict", "keys"], order.met[:5]
    assert keys[0] <= order.keys <= keys[1], f"{order.keys} key numbers"
    # the figure comes before any table
    shown = [name for name in order.met if name in ("figure", "table", "viewer")]
    assert shown[0] != "table", order.met[:8]
    # what is too wide for a phone can be moved sideways, and sentences have room
    for table in re.finditer(r"(.{0,24})<table", body):
        assert table[1].endswith('<div class="scroll">'), f"{path.name}: {table[0]}"
    long = [cell for cell in re.findall(r"<td>([^<]+)</td>", body) if len(unescape(cell)) > 30]
    assert not long, f"{path.name}: cells that may become columns of single words: {long[:3]}"
    data = data_of(page)
    for name, figure in data.items():
        assert body.count(f'id="{name}"') == 1, name
        for panel in figure.get("panels", ()):
            _check_panel(name, panel)
    return data


def _check_panel(name: str, panel: dict[str, Any]) -> None:
    """Values have names when they are pointed at, and none is told as NaN."""
    for trace in panel["traces"]:
        if trace.get("hoverinfo") == "skip":
            continue
        if trace["type"] == "heatmap":
            assert trace["hoverongaps"] is False, name
            continue
        if trace["type"] == "contour":
            continue
        told = trace["hovertemplate"]
        x = panel["layout"]["xaxis"]["title"]["text"]
        assert re.sub(r"\s*\[.*\]$", "", x) in told, f"{name}: {told} has no {x!r}"
        assert re.search(r"[\w/].*%\{y", told.split("<br>")[-1]), f"{name}: {told}"
