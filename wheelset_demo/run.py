"""``python wheelset_demo/run.py``: the same as ``railpatch wheelset``, with this checkout's code.

The package railpatch itself must be installed.
"""

from __future__ import annotations

import sys
from pathlib import Path

if __name__ == "__main__":
    # the folder above in place of this one, so that the package is found under its own name
    sys.path[0] = str(Path(__file__).resolve().parents[1])
    from railpatch.command.group import with_common_options

    from wheelset_demo.command import wheelset

    with_common_options(wheelset)(prog_name="run.py")
