"""Profiles of one rail along the track, with knots that belong together.

Between two sections the core interpolates knot by knot, so all get the same knots, equally spaced
in arc length: knot i of each lies at the same share of its length.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import scipy

from railpatch.profiles.curve import Profile

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
    ends = [((1, getattr(profile, d)[0]), (1, getattr(profile, d)[-1])) for d in ("dy", "dz")]
    fy = scipy.interpolate.CubicSpline(s, y, bc_type=ends[0])
    fz = scipy.interpolate.CubicSpline(s, z, bc_type=ends[1])
    return Profile(profile.name, s, y, z, fy(s, 1), fz(s, 1), profile.notes)
