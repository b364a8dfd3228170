"""Links of pages: by places in the checkout where they are written, in the site by its own."""

from __future__ import annotations

import re
from pathlib import Path
from posixpath import normpath, relpath

from making import tutorials

# files of the checkout that are pages or stand beside them, by what links name
PROJECT = {
    "CHANGELOG.md": "project/changelog.md",
    "CONTRIBUTING.md": "project/contributing.md",
    "core/README.md": "project/core.md",
    "plugins/python_mbs/README.md": "project/python.md",
    "LICENSE": "project/LICENSE.txt",
    "NOTICE": "project/NOTICE.txt",
    "core/include/railpatch.h": "reference/c_header.md",
    "examples/README.md": "index.md",
    # what reference is made from
    "plugins/fmu/variables.toml": "reference/fmu_variables.md",
    "rig_model/tables.py": "reference/keys/rig.md",
    "wheelset_demo/vehicle/scene.py": "reference/keys/vehicle.md",
    "plugins/python_mbs/railpatch/command/cli.py": "reference/commands.md",
    **{f"examples/{script.name}": f"tutorials/{script.stem}.md" for script in tutorials.scripts()},
}
LINK = re.compile(r"(?<!!)\[([^\]]*)\]\(([^)#\s]+)(#[^)\s]*)?\)")


def led(markdown: str, here: str) -> str:
    """The text of a page with links as the site has them. here: the page, by its place there.

    A target that is no page becomes its name."""
    made = ("project/", "tutorials/")
    own = (s for s, target in PROJECT.items() if target == here and target.startswith(made))
    source = next(own, f"docs/{here}")

    def one(match: re.Match[str]) -> str:
        text, target, anchor = match[1], match[2], match[3] or ""
        if "://" in target or target.startswith("mailto:"):
            return match[0]
        place = normpath(f"{Path(source).parent.as_posix()}/{target}")
        inside = place.removeprefix("docs/") if place.startswith("docs/") else PROJECT.get(place)
        if inside is None:
            return f"`{place}`" if text.strip("`") == target else f"{text} (`{place}`)"
        return f"[{text}]({relpath(inside, Path(here).parent.as_posix())}{anchor})"

    return LINK.sub(one, markdown)
