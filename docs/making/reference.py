"""The reference: every page is made from the one source of what it lists."""

from __future__ import annotations

from making import Pages, c_header, commands, fmu_variables, keys, python_api


def pages() -> Pages:
    """All pages of the reference by path."""
    parts = (keys, commands, python_api, c_header, fmu_variables)
    return {path: text for part in parts for path, text in part.pages().items()}


def index() -> Pages:
    """The first page of the reference."""
    lines = [
        "# Reference",
        "",
        "Each page is made from the one source of what it lists, when the site is built.",
        "",
        "| page | made from |",
        "|---|---|",
        "| [Keys of scenes](keys/patch.md), a page for each kind | the schema that checks them |",
        "| [Commands](commands.md) | the parser |",
        "| [Python](python/railpatch.md), a page for each module | signatures and docstrings |",
        "| [C header](c_header.md) | `railpatch.h` and its lists |",
        "| [Variables of an FMU](fmu_variables.md) | the list of `modelDescription.xml` |",
        "| [Log channels](../log_channels.md) | the table that writes logs |",
        "| [Errors, reasons, warnings](messages.md) | the core's lists |",
    ]
    return {"reference/index.md": "\n".join(lines) + "\n"}
