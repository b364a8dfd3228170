"""A page: one HTML file that needs no network, with the style of all.

What figures and viewers show is collected into one compressed part at the page's end, beside the
library that draws it.
"""

from __future__ import annotations

import base64
import gzip
import json
import re
from functools import cache
from html import escape
from importlib import resources
from typing import Any

SCRIPTS = ("viewer.js", "parallel.js", "page.js")
LIBRARY = "plotly-cartesian.min.js.gz"
_DATA = re.compile(r'<script type="application/json" data-of="([\w.-]+)">(.*?)</script>', re.S)


@cache
def _file(name: str) -> bytes:
    return (resources.files("railpatch.page") / name).read_bytes()


def data_of(name: str, value: Any) -> str:
    """What page.js draws under a name that is unique on its page, until document() packs it."""
    # no end of a script inside it
    text = json.dumps(value, separators=(",", ":"), allow_nan=False).replace("</", "<\\/")
    return f'<script type="application/json" data-of="{escape(name)}">{text}</script>'


def document(title: str, body: str) -> str:
    """A whole page around the HTML of its body."""
    found = {name: json.loads(text) for name, text in _DATA.findall(body)}
    body = _DATA.sub("", body)
    parts = [
        '<!DOCTYPE html>\n<html lang="en"><head><meta charset="utf-8">'
        '<meta name="viewport" content="width=device-width, initial-scale=1">'
        f"<title>Railpatch: {escape(title)}</title><style>{_file('page.css').decode()}</style>"
        f"</head><body>{body}",
    ]
    if found:
        text = json.dumps(found, separators=(",", ":"), sort_keys=True)
        # the same page for the same numbers: no time in it
        data = gzip.compress(text.encode(), 9, mtime=0)
        parts += [
            f'<script type="application/gzip" id="library">{_encoded(_file(LIBRARY))}</script>',
            f'<script type="application/gzip" id="data">{_encoded(data)}</script>',
            *(f"<script>{_file(name).decode()}</script>" for name in SCRIPTS),
        ]
    return "".join([*parts, "</body></html>\n"])


def _encoded(data: bytes) -> str:
    return base64.b64encode(data).decode()
