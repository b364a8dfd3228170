"""``python rig_model/replay.py``: the same as ``railpatch rig``, with the code of this checkout.

The package railpatch itself must be installed.
"""

from __future__ import annotations

import sys
from pathlib import Path

if __name__ == "__main__":
    # the folder above in place of this one, so that the package is found under its own name
    sys.path[0] = str(Path(__file__).resolve().parents[1])
    from railpatch.command.group import with_common_options

    from rig_model.command import rig

    with_common_options(rig)(prog_name="replay.py")
