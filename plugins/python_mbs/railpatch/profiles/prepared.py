"""Prepared profiles: the arrays that the core takes, by themselves, for FMUs to read at run time.

plugins/fmu/src/profile_file.hpp tells the form.
"""

from __future__ import annotations

import zlib
from pathlib import Path
from typing import Literal
from urllib.parse import quote

from railpatch.profiles.curve import Profile
from railpatch.writing import write_whole

SUFFIX = ".profile"
ARRAYS = ("arc_length", "y", "z", "dy", "dz")


def prepared_text(profile: Profile, body: Literal["wheel", "rail"], name: str) -> str:
    """The file's content. name: what the profile is called."""
    lines = ["railpatch-profile 1", f"body {body}", f"name {quote(name, safe='') or '%00'}"]
    for key in ARRAYS:
        values = getattr(profile, key).tolist()
        lines.append(f"{key} {len(values)} {' '.join(map(repr, values))}")
    text = "\n".join([*lines, ""])
    return f"{text}end {zlib.crc32(text.encode('ascii')):08x}\n"


def write_prepared(
    profile: Profile, body: Literal["wheel", "rail"], name: str, output: Path
) -> Path:
    """Writes the file; gives its path. Raises OSError."""
    return write_whole(output, prepared_text(profile, body, name).encode("ascii"))
