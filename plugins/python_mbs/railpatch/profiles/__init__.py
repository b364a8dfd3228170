"""Wheel and rail profiles: files, formulas, clean-up and smoothing.

Everything here is in metres, in right-hand orientation: from the flange or gauge side (-y) to the
field side (+y), z down. A left profile is stored and handled as a right one.
"""

from __future__ import annotations

from pathlib import Path

from railpatch.errors import ProfileError
from railpatch.profiles.builtin import builtin_profile
from railpatch.profiles.curve import Profile
from railpatch.profiles.raw import RawProfile, Reading, Role
from railpatch.profiles.read import read_profile
from railpatch.profiles.smooth import MEASURED_WAVELENGTH, fit_profile

__all__ = [
    "MEASURED_WAVELENGTH",
    "Profile",
    "ProfileError",
    "RawProfile",
    "Reading",
    "builtin_profile",
    "fit_profile",
    "load_profile",
    "read_profile",
]


def load_profile(
    source: str | Path,
    role: Role,
    *,
    folder: str | Path | None = None,
    smoothing: float | None = None,
    reading: Reading | None = None,
) -> Profile:
    """A profile by built-in name or file, ready for the core.

    source: built-in name ("S1002", "UIC60", "60E1", "54E1", "UIC60@1:40", "cone@1:20", "arc@0.3",
        "cylinder") or path; a relative path starts at ``folder``.
    role: "wheel" or "rail" (a roller's profile is a rail).
    smoothing: m, wave length of which half the amplitude is kept; 0 interpolates the points;
        default what the points' noise asks for, at least
        MEASURED_WAVELENGTH for MiniProf files. Not for built-in names.
    reading: what a file does not say of itself; not for built-in names.
    Raises ProfileError.
    """
    built_in = builtin_profile(str(source), role)
    if built_in is not None:
        if reading not in (None, Reading()):
            raise ProfileError(source, f"is a built-in profile: {reading} is for files only")
        return built_in
    path = Path(source)
    if folder is not None and not path.is_absolute():
        path = Path(folder) / path
    return fit_profile(read_profile(path, role, reading), smoothing)
