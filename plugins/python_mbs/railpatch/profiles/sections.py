"""Profiles of one rail along the track, or of a wheel round it, with knots that belong together.

Between two sections the core interpolates knot by knot. Without features all get the same knots,
equally spaced in arc length: knot i of each lies at the same share of its length. With features,
places that belong together from section to section (edges of a blade or a nose), each stretch
between two of them has as many knots in every section, equally spaced there.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from railpatch.errors import ProfileError
from railpatch.profiles.curve import Profile
from railpatch.profiles.spline import slopes

Array = NDArray[np.float64]
SPACING = 1e-4  # m, at most, but for MOST_KNOTS
MOST_KNOTS = 3000
FEWEST = 4  # intervals between two features
# m, that a part of the profile keeps where it is missing: its knots must lie apart
MISSING = 1e-6
# least dy/ds of flanks inside of a profile: the core's surfaces end at 0.02, and rails lean
STEEPEST = 0.1
RIPPLE = 2e-4  # m
SLACK = 1e-4  # m, of a feature at the end


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
    return with_knots(profile, at)


def with_knots(profile: Profile, at: Array) -> Profile:
    """The C2 cubic spline through the curve's points at arc lengths."""
    y, z = profile.evaluate(at)
    s = at - profile.arc_length[0]
    dy = slopes(s, y, (float(profile.dy[0]), float(profile.dy[-1])))
    dz = slopes(s, z, (float(profile.dz[0]), float(profile.dz[-1])))
    return Profile(profile.name, s, y, z, dy, dz, profile.notes)


def matching_features(
    profiles: Sequence[Profile], features: Sequence[Sequence[float]]
) -> list[Profile]:
    """The profiles with knots that go with their features.

    features: m, of each profile the arc lengths from its begin on, as many for each, that do not
    fall; where two are equal the part between them is missing. Flanks between surfaces that a wheel
    can touch are seen from above: those steeper than STEEPEST are laid back to it.
    Raises ProfileError.
    """
    edges = [edges_of(p, own) for p, own in zip(profiles, features, strict=True)]
    lengths = np.max([np.diff(own) for own in edges], axis=0)
    spacing = max(SPACING, float(lengths.sum()) / MOST_KNOTS)
    counts = [max(FEWEST, int(np.ceil(length / spacing))) for length in lengths]
    return [
        seen_from_above(with_knots(p, p.arc_length[0] + knots_between(own, counts)))
        for p, own in zip(profiles, edges, strict=True)
    ]


def edges_of(profile: Profile, features: Sequence[float]) -> Array:
    """m, begin, features and end, each beyond the one before."""
    length = float(profile.arc_length[-1] - profile.arc_length[0])
    for before, feature in zip([0.0, *features], features, strict=False):
        # the end may be said by the chords' length or to few digits
        if not before <= feature <= length + SLACK:
            raise ProfileError(
                profile.name,
                f"has a feature at {feature:g} m, allowed {before:g} ... {length:g}: arc lengths "
                "along the profile that do not fall",
            )
    least = MISSING * np.arange(len(features) + 2)
    edges = np.array([0.0, *features, length]) - least
    edges = np.maximum.accumulate(edges) + least
    # not beyond the end either
    back = least[::-1]
    return np.minimum.accumulate((np.minimum(edges, length) + back)[::-1])[::-1] - back


def knots_between(edges: Array, counts: Sequence[int]) -> Array:
    """m, the edges and equally spaced knots between them."""
    parts = [
        a + (b - a) * np.arange(count) / count
        for a, b, count in zip(edges[:-1], edges[1:], counts, strict=True)
    ]
    return np.append(np.concatenate(parts), edges[-1])


def falling(z: Array) -> NDArray[np.bool_]:
    """Of each step from knot to knot whether it is on the way down into a gap, or over an edge;
    what turns by less than RIPPLE does not count."""
    falls = np.ones(z.size - 1, dtype=bool)
    down, last = True, 0
    for i in range(1, z.size):
        if (z[i] >= z[last]) == down:
            last = i
        elif abs(z[i] - z[last]) > RIPPLE:
            down = not down
            falls[last:] = down
            last = i
    return falls


def seen_from_above(profile: Profile) -> Profile:
    """The curve with its inner flanks no steeper than STEEPEST. Raises ProfileError where a gap is
    too narrow for that."""
    s, z = profile.arc_length, profile.z
    least = STEEPEST * np.diff(s)
    open_ = np.flatnonzero(np.diff(profile.y) > least)
    if not open_.size:
        raise ProfileError(profile.name, "has no surface that can be seen from above")
    inside = slice(open_[0], open_[-1] + 1)
    if (np.diff(profile.y)[inside] >= least[inside]).all():
        return profile
    y, falls = profile.y.copy(), falling(z)
    for i in range(inside.start, inside.stop):
        if falls[i]:
            y[i + 1] = max(y[i + 1], y[i] + least[i])
    # on the way up from the other side, and what of the gap's bottom that pushes along
    level = np.diff(profile.y) >= least
    for i in range(inside.stop - 1, inside.start - 1, -1):
        if not falls[i] or level[i]:
            y[i] = min(y[i], y[i + 1] - least[i])
    tight = np.flatnonzero(np.diff(y)[inside] < 0.5 * least[inside])
    if tight.size:
        at = profile.y[inside][tight[0]]
        raise ProfileError(
            profile.name,
            f"turns back at y = {at:g} m: a gap that narrows downwards must be cut off above",
        )
    way = np.concatenate([[0.0], np.cumsum(np.hypot(np.diff(y), np.diff(z)))])
    dy = slopes(way, y, (float(profile.dy[0]), float(profile.dy[-1])))
    dz = slopes(way, z, (float(profile.dz[0]), float(profile.dz[-1])))
    note = f"flanks inside laid back to {90 - np.degrees(STEEPEST):.0f} degrees"
    return Profile(profile.name, way, y, z, dy, dz, (*profile.notes, note))
