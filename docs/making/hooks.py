"""Hooks of mkdocs: adds the pages that are made, leads links out of docs/ to where they stand."""

from __future__ import annotations

import re
import sys
from pathlib import Path
from typing import Any

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

from mkdocs.structure.files import File, Files, InclusionLevel

from making import ROOT, book, links, reference, tutorials

STYLE = """
.md-grid { max-width: 78rem; }
.md-typeset table:not([class]) { font-size: .68rem; }
.md-typeset table:not([class]) th,
.md-typeset table:not([class]) td { padding: .45em .8em; min-width: 0; }
.md-typeset table:not([class]) th { min-width: 3rem; }
.md-typeset td code { word-break: normal; overflow-wrap: break-word; }
.md-typeset td:first-child code { white-space: nowrap; }
[data-md-color-scheme="slate"] img[src$=".svg"] { background: #fff; }
.figure { background: #fff; }
"""
FETCHED = re.compile(r'src="https://unpkg\.com/iframe-worker/[^"]*"')


def on_files(files: Files, config: Any) -> Files:
    """Adds what is made."""
    made = reference.pages() | reference.index() | tutorials.pages() | book.pages()
    for source, target in links.PROJECT.items():
        if target.startswith("project/"):
            made[target] = (ROOT / source).read_text(encoding="utf-8")
    made["making_style.css"] = STYLE
    made["assets/worker.js"] = Path(__file__).with_name("worker.js").read_text(encoding="utf-8")
    for path, text in made.items():
        files.append(File.generated(config, path, content=text, inclusion=InclusionLevel.INCLUDED))
    import plotly

    library = Path(plotly.__file__).parent / "package_data" / "plotly.min.js"
    files.append(File.generated(config, "assets/plotly.min.js", abs_src_path=str(library)))
    return files


def on_page_markdown(markdown: str, page: Any, config: Any, files: Files) -> str:
    """Links by the places in the checkout become links in the site."""
    return links.led(markdown, page.file.src_uri)


def on_post_page(output: str, page: Any, config: Any) -> str:
    """The one script that the theme would fetch stands in the site."""
    up = "../" * page.file.dest_uri.count("/")
    found, count = FETCHED.subn(f'src="{up}assets/worker.js"', output)
    if count > 1 or "//unpkg.com" in found:
        raise ValueError(f"{page.file.src_uri}: fetches a script that is not known")
    return found
