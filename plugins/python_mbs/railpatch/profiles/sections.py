"""Profiles of one rail along the track, with knots that belong together.

Between two sections the core interpolates knot by knot, so all get the same knots, equally spaced
in arc length: knot i of each lies at the same share of its length.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from railpatch.profiles.curve import Profile
from railpatch.profiles.spline import slopes

SPACING = 1e-4  # m, at most, but for MOST_KNOTS
MOST_KNOTS = 3000


def matching_sections(profiles: Sequence[Profile]) -> list[Profile]:
    """The profiles as C2 cubic splines over equally spaced knots, as many for each."""
    lengths = [p.arc_length[-1] - p.arc_length[0] for p in profiles]
    most = max(p.arc_length.size for p in profiles)
    count = min(max(int(np.ceil(max(lengths) / SPACING)) + 1, most), MOST_KNOTS)
    return [resampled(p, count) for p in profiles]


def resampled(profile: Profile, count: int) -> Profile:
    """The same curve with other knots."""
    share = np.linspace(0.0, 1.0, count)
    begin, end = profile.arc_length[0], profile.arc_length[-1]
    at = begin + share * (end - begin)
    at[-1] = end
    y, z = profile.evaluate(at)
    s = at - begin
    dy = slopes(s, y, (float(profile.dy[0]), float(profile.dy[-1])))
    dz = slopes(s, z, (float(profile.dz[0]), float(profile.dz[-1])))
    return Profile(profile.name, s, y, z, dy, dz, profile.notes)
