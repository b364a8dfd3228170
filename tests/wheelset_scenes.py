"""Scenes that the tests of wheelset/ share."""

from __future__ import annotations

import re
from pathlib import Path

from wheelset_demo.scene import WheelsetScene, load_wheelset_scene, scene_file


def text_of(name: str, **values: object) -> str:
    """A scene of the package with some keys' values replaced: the first line with that key."""
    text = scene_file(name).read_text(encoding="utf-8")
    for key, value in values.items():
        shown = f'"{value}"' if isinstance(value, str) else repr(value)
        text, count = re.subn(rf"(?m)^{key} = \S+", f"{key} = {shown}", text, count=1)
        assert count == 1, f"the scene has no key {key}"
    return text


def scene(folder: Path, name: str, **values: object) -> WheelsetScene:
    """The same, loaded."""
    file = folder / "scene.toml"
    file.write_text(text_of(name, **values), encoding="utf-8")
    return load_wheelset_scene(file)
