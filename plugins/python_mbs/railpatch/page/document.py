"""A page: one HTML file that needs no network, with the style of all."""

from __future__ import annotations

from html import escape

from plotly.offline import get_plotlyjs

_STYLE = """
:root { color-scheme: light dark; --ink: #1d2126; --soft: #5d6672; --line: #d9dde2;
  --ground: #ffffff; --panel: #f5f7f9; --warn: #fff1d6; --warn-ink: #6b4500; }
@media (prefers-color-scheme: dark) { :root { --ink: #e4e7eb; --soft: #9aa3ae; --line: #353b43;
  --ground: #15181c; --panel: #1d2126; --warn: #42320f; --warn-ink: #ffdf9e; } }
* { box-sizing: border-box; }
body { margin: 0 auto; max-width: 1180px; padding: 24px 28px 60px; background: var(--ground);
  color: var(--ink); font: 15px/1.5 system-ui, sans-serif; }
h1 { font-size: 26px; margin: 0 0 4px; } h2 { font-size: 19px; margin: 40px 0 4px; }
h3 { font-size: 15px; margin: 22px 0 4px; }
p { max-width: 78ch; margin: 4px 0 10px; } p.sub { color: var(--soft); }
.warn { background: var(--warn); color: var(--warn-ink); padding: 10px 14px; border-radius: 6px;
  margin: 12px 0; max-width: none; }
.scroll { overflow-x: auto; }
table { border-collapse: collapse; font-size: 13.5px; margin: 8px 0; }
th, td { padding: 3px 14px 3px 0; text-align: left; border-bottom: 1px solid var(--line);
  vertical-align: top; }
th { color: var(--soft); font-weight: 600; white-space: nowrap; } th.n { text-align: right; }
td.n { text-align: right; font-variant-numeric: tabular-nums; white-space: nowrap; }
table.summary td:first-child { color: var(--soft); white-space: nowrap; padding-right: 28px; }
details { margin: 10px 0; } summary { cursor: pointer; color: var(--soft); }
pre { background: var(--panel); padding: 12px; overflow-x: auto; font-size: 12.5px; }
figure { margin: 0; }
@media (max-width: 600px) {
  body { padding: 14px 12px 40px; } .modebar { display: none !important; }
}
@media print {
  :root { --ink: #1d2126; --soft: #5d6672; --line: #d9dde2; --ground: #ffffff; --panel: #f5f7f9;
    --warn: #fff1d6; --warn-ink: #6b4500; }
  body { max-width: none; padding: 0; } .modebar { display: none !important; }
  figure, tr, p { break-inside: avoid; } h2, h3, h2 + p, h3 + p, p + p { break-after: avoid; }
  body > h2:first-of-type { break-before: page; }
  .scroll, pre { overflow: visible; } pre { white-space: pre-wrap; }
}
"""


def document(title: str, body: str) -> str:
    """A whole page with style and plotly, around the HTML of its body."""
    return (
        f'<!DOCTYPE html>\n<html lang="en"><head><meta charset="utf-8">'
        f'<meta name="viewport" content="width=device-width, initial-scale=1">'
        f"<title>Railpatch: {escape(title)}</title><style>{_STYLE}</style>"
        f"<script>{get_plotlyjs()}</script></head><body>{body}</body></html>\n"
    )
