"""Which reader a profile file needs, by content and extension."""

from __future__ import annotations

import re
from pathlib import Path

from railpatch.delimited import read_text
from railpatch.errors import ProfileError
from railpatch.profiles.columns import read_columns
from railpatch.profiles.miniprof import read_miniprof
from railpatch.profiles.orientation import orient
from railpatch.profiles.raw import RawProfile, Reading, Role, check_points
from railpatch.profiles.simpack import read_simpack

# extension -> what the file is said to be
EXTENSION_ROLE: dict[str, Role] = {".prw": "wheel", ".prr": "rail", ".whl": "wheel", ".ban": "rail"}
SIMPACK_EXTENSIONS = (".prr", ".prw")
MAX_BYTES = 20_000_000


def read_profile(
    path: str | Path, role: Role | None = None, reading: Reading | None = None
) -> RawProfile:
    """Reads SIMPACK (.prr, .prw), MiniProf (.ban, .whl) or two plain columns.

    role: "wheel" or "rail"; may be left out where extension or header tell. reading: what the file
    does not say of itself.
    Returns points in metres, right-hand orientation, z down. Raises ProfileError.
    """
    path, reading = Path(path), reading or Reading()
    absent = "file not found, and not the name of a built-in profile"
    text = read_text(path, ProfileError, absent, MAX_BYTES)
    role = agreed_role(path, role)
    if re.search(r"^\s*(header|spline|point)\.begin", text, re.MULTILINE):
        raw = read_simpack(path, text, role, reading)
    elif path.suffix.lower() in SIMPACK_EXTENSIONS:
        raise ProfileError(path, "is no SIMPACK profile: 'point.begin' is missing")
    elif re.search(r"^\s*[A-Za-z]\w*\s*=", text, re.MULTILINE):
        raw = read_miniprof(path, text, role, reading)
    else:
        raw = read_columns(path, text, role, reading)
    check_points(raw)
    orient(raw, reading)
    return raw


def agreed_role(path: Path, role: Role | None) -> Role | None:
    """The role asked for, checked against the extension."""
    said = EXTENSION_ROLE.get(path.suffix.lower())
    if role is not None and said is not None and said != role:
        raise ProfileError(path, f"is a {said} profile by its extension, a {role} is needed")
    return role or said
