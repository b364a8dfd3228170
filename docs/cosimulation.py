"""Largest stable steps of all masters over speed: draws docs/cosimulation.svg, prints its tables.

python docs/cosimulation.py docs/cosimulation.svg
"""

from __future__ import annotations

import sys
import time
from pathlib import Path

from wheelset_demo.cosimulation_command import ELEMENTS, NAMES, SCENE, SPEEDS
from wheelset_demo.coupling.report import markdown_of, write
from wheelset_demo.coupling.study import study, with_elements
from wheelset_demo.scene import load_wheelset_scene, scene_file


def main() -> None:
    begin = time.perf_counter()
    scene = with_elements(load_wheelset_scene(scene_file(SCENE)), ELEMENTS)
    found = study(scene, SPEEDS, NAMES)
    path = Path(sys.argv[1] if len(sys.argv) > 1 else Path(__file__).with_suffix(".svg"))
    write(found, path)
    print(markdown_of(found))
    for form in found.speeds:
        print(form)
    print(f"{path}, {time.perf_counter() - begin:.0f} s")


if __name__ == "__main__":
    main()
