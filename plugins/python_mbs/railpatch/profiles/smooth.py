"""From points to a smooth curve: clean-up, smoothing in arc length, cubic spline.

A smoothing spline minimises sum w_i (p_i - f(s_i))^2 + lambda integral f''^2 ds, separately for y
and z. With w_i the length that point i stands for, it passes a wave of length L with the factor
1 / (1 + lambda (2 pi / L)^4) whatever the spacing of the points, so lambda is stated as the wave
length of which half the amplitude is kept: lambda = (L / 2 pi)^4.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from railpatch.errors import ProfileError
from railpatch.profiles.curve import Profile, Scatter
from railpatch.profiles.elementary import GAUSS_5, hypot, weighted_sum
from railpatch.profiles.noise import noise_of, off_neighbours, outliers, wavelength_for
from railpatch.profiles.raw import RawProfile
from railpatch.profiles.spline import cubic_spline, slopes, smoothed_values

Array = NDArray[np.float64]

# m, wave length of which half the amplitude is kept in measured profiles: eight samples of 0.25 mm.
# Chosen by the vertical forces published for the NRC rig, which it meets within 0.3 %; without
# smoothing they are up to 1 % too high, with 2.5 mm up to 1 % and with 3.5 mm 4 % too low
MEASURED_WAVELENGTH = 2.0e-3
# m, noise below this is that of rounding, and shapes no curve
QUIET = 2e-7
# m, a smoothing that leaves the forces of S1002 on UIC60 within 1 % and the pressure within 10 %
MOST_SMOOTHED = 7e-3
# -, of the smoothing that noise asks for, what is near enough not to be spoken of
ENOUGH = 0.8
# 1/m, standard deviation of the curvature that noise may leave where the profile is even, and what
# it may of the profile's own curvature (as its share), where that is more: tried on 70 noisy pairs
# of new and worn profiles, whose greatest pressures it brought 20 % nearer on average than 1 1/m
# everywhere; and m, the longest smoothing that is chosen so
EVEN, SHARE, LONGEST = 0.3, 0.07, 9e-3
# m, points closer than this are one: their rounding would shape the curve
MIN_DISTANCE = 1e-5
# distances between points; m and times their median: longer ones of files of many are told
MANY, GAP, WIDE = 100, 4e-3, 10.0
# -, share of the points that may turn back before a file is refused
MAX_TURNING_BACK = 0.05


def fit_profile(raw: RawProfile, smoothing: float | None = None) -> Profile:
    """The smooth curve through (or near) the points.

    smoothing: m, wave length of which half the amplitude is kept, 0: interpolation. Default: what
        the points' noise asks for, at least MEASURED_WAVELENGTH for measurements, 0 for points
        without noise.
    Raises ProfileError, also where the noise asks for more smoothing than a profile's arcs bear.
    """
    if smoothing is not None and not 0.0 <= smoothing <= 0.1:
        raise ProfileError(raw.source, f"smoothing is {smoothing}, allowed 0 ... 0.1 m")
    keep, notes = clean(raw)
    y, z = raw.y[keep], raw.z[keep]
    s = chord_length(y, z)
    spacing = float(np.median(np.diff(s)))
    rounded = raw.rounding / 12**0.5
    found = noise_of(y, z, s)
    if apart := outliers(y, z, s, max(found, rounded)):
        notes += off_notes(y, z, s, apart)
        keep = np.delete(keep, apart)
        y, z = raw.y[keep], raw.z[keep]
        s = chord_length(y, z)
        found = noise_of(y, z, s)
    notes += gap_notes(y, s)
    noise = max(found, rounded)
    if rounded > QUIET:
        notes.append(
            f"heights rounded to {1e6 * raw.rounding:.3g} um, taken as noise of "
            f"{1e6 * rounded:.2g} um"
        )
    needed = wavelength_for(noise, spacing) if noise > QUIET else 0.0
    wavelength = smoothing
    if wavelength is None:
        wavelength = max(needed, MEASURED_WAVELENGTH if raw.measured else 0.0)
        if needed > MOST_SMOOTHED:
            what = f"has {1e6 * noise:.2g} um of noise"
            if rounded > found:
                what = f"has heights rounded to {1e6 * raw.rounding:.3g} um"
            raise ProfileError(
                raw.source,
                f"{what} at points {1e3 * spacing:.2g} mm apart, which "
                f"asks for smoothing over {1e3 * needed:.2g} mm: allowed up to "
                f"{1e3 * MOST_SMOOTHED:g} mm, more flattens the arcs of wheels and rails; measure "
                "again or closer, or say smoothing",
            )
    if noise > QUIET:
        if found >= rounded:
            points = f"points {1e3 * spacing:.2g} mm apart"
            notes.append(f"noise of {1e6 * noise:.2g} um found at {points}")
        if wavelength < ENOUGH * needed:
            notes.append(
                f"smoothing over {1e3 * wavelength:.3g} mm leaves noise in the curvature, and with "
                f"it in the pressure: {1e3 * needed:.2g} mm is asked for"
            )
    lengths = np.full(s.size, wavelength)
    if wavelength > 0:
        fitted = smoothed(s, y, z, raw.weight[keep], lengths)
        if smoothing is None and noise > QUIET:
            first = spline_profile(raw.source, s, *fitted, ())
            least = MEASURED_WAVELENGTH if raw.measured else 0.0
            lengths = np.maximum(local_wavelengths(first, needed, spacing), least)
            fitted = smoothed(s, y, z, raw.weight[keep], lengths)
        residual = hypot(fitted[0] - y, fitted[1] - z)
        y, z = fitted
        rms, most = float(np.sqrt(np.mean(residual * residual))), int(np.argmax(residual))
        notes.append(
            f"smoothed, half amplitude at {range_of(lengths)} mm; residual {1e6 * rms:.2g} um "
            f"(root mean square), at most {1e6 * residual[most]:.2g} um at y = {1e3 * y[most]:.3g} "
            "mm"
        )
        if wavelength > MOST_SMOOTHED:
            notes.append("smoothed over more than the arcs of wheels and rails bear")
    profile = spline_profile(raw.source, s, y, z, (*raw.notes, *notes))
    if noise <= QUIET:
        return profile
    flattened = flattening(profile, raw.weight[keep], lengths)
    return replace(profile, scatter=Scatter(noise, spacing, lengths, flattened))


def off_notes(y: Array, z: Array, s: Array, apart: list[int]) -> list[str]:
    """On single points that are left out."""
    across, _ = off_neighbours(y, z, s)
    return [
        f"a point left out at y = {1e3 * y[i]:.4g} mm: {1e6 * abs(across[i - 2]):.3g} um off its "
        "neighbours, which agree"
        for i in apart
    ]


def gap_notes(y: Array, s: Array) -> list[str]:
    """On stretches without points, where the others are close."""
    gaps = np.diff(s)
    if gaps.size < MANY:
        return []
    wide = np.flatnonzero(gaps > max(GAP, WIDE * float(np.median(gaps))))
    return [
        f"no points over {1e3 * gaps[i]:.3g} mm from y = {1e3 * y[i]:.4g} mm on: the curve there "
        "is that of its ends"
        for i in wide
    ]


def range_of(lengths: Array) -> str:
    """mm, of lengths in m."""
    low, high = (f"{1e3 * float(value):.3g}" for value in (lengths.min(), lengths.max()))
    return low if low == high else f"{low} to {high}"


def local_wavelengths(first: Profile, needed: float, spacing: float) -> Array:
    """m, [n], at which half the amplitude is kept: longer where the profile is even, shorter about
    its small radii, as far as the noise asks for.

    first: smoothed at the one length needed (m), which leaves 1 1/m (profiles.noise). spacing: m.
    """
    s = first.arc_length
    bend = np.abs(np.gradient(first.dz, s) * first.dy - np.gradient(first.dy, s) * first.dz)
    # also beside them, by half the length
    most = bend.copy()
    for k in range(1, min(int(0.5 * needed / spacing) + 2, s.size)):
        most[k:] = np.maximum(most[k:], bend[:-k])
        most[:-k] = np.maximum(most[:-k], bend[k:])
    rough = np.maximum(EVEN, SHARE * most)
    # what noise leaves goes by the length to the power -2.5; -8/3 in its place is all square roots
    root = np.sqrt(np.sqrt(rough))
    return np.minimum(needed / (root * np.sqrt(root)), LONGEST)


def flattening(profile: Profile, weight: Array, lengths: Array) -> Array:
    """m, [n], how far smoothing once more moves the knots across, z down."""
    if not lengths.all():
        return np.zeros(profile.y.size)
    y, z = smoothed(profile.arc_length, profile.y, profile.z, weight, lengths)
    across = (z - profile.z) * profile.dy - (y - profile.y) * profile.dz
    return np.asarray(across / hypot(profile.dy, profile.dz))


def chord_length(y: Array, z: Array) -> Array:
    """m, [n], running length along the polygon."""
    return np.concatenate([[0.0], np.cumsum(hypot(np.diff(y), np.diff(z)))])


def clean(raw: RawProfile) -> tuple[NDArray[np.intp], list[str]]:
    """Indices of the points to keep: no duplicates, no points at which the polygon turns back.

    A single outlier higher than half the spacing makes the polygon turn back as well.
    """
    count = raw.y.size
    kept: list[int] = []
    turned: list[int] = []
    duplicates = 0
    for i in range(count):
        if kept and same_place(raw, kept[-1], i):
            duplicates += 1
            continue
        while len(kept) > 1 and turns_back(raw, kept[-2], kept[-1], i):
            turned.append(kept.pop())
        # the way back of a profile measured there and back may have the points of the way there
        if kept and same_place(raw, kept[-1], i):
            duplicates += 1
            continue
        kept.append(i)
    if len(turned) > MAX_TURNING_BACK * count:
        first = min(turned)
        raise ProfileError(
            raw.source,
            f"the points turn back at {len(turned)} of {count} places, the first here; "
            "they must follow the profile from one end to the other",
            int(raw.line[first]),
        )
    if len(kept) < 5:
        raise ProfileError(raw.source, f"{len(kept)} distinct points are left, needs 5 or more")
    notes = []
    if duplicates:
        notes.append(f"{duplicates} duplicate points left out")
    if turned:
        notes.append(f"{len(turned)} points left out where the profile turned back")
    return np.array(kept), notes


def same_place(raw: RawProfile, a: int, b: int) -> bool:
    """Whether two points are one."""
    return bool(hypot(raw.y[b] - raw.y[a], raw.z[b] - raw.z[a]) < MIN_DISTANCE)


def turns_back(raw: RawProfile, a: int, b: int, c: int) -> bool:
    """True where the polygon a-b-c turns by more than a right angle at b."""
    forward = (raw.y[b] - raw.y[a]) * (raw.y[c] - raw.y[b])
    return bool(forward + (raw.z[b] - raw.z[a]) * (raw.z[c] - raw.z[b]) < 0)


def smoothed(s: Array, y: Array, z: Array, weight: Array, lengths: Array) -> tuple[Array, Array]:
    """The points moved onto the smoothing spline over the chord length s; lengths: m, [n], at which
    half the amplitude is kept, about each point."""
    ds = np.diff(s)
    share = 0.5 * (np.append(ds, 0.0) + np.insert(ds, 0, 0.0)) * weight
    square = (lengths / (2 * np.pi)) ** 2
    # one stiffness for all: where it is to be less, points count more
    stiffness = float((square * square).max())
    share = share * (stiffness / (square * square))
    return smoothed_values(s, y, share, stiffness), smoothed_values(s, z, share, stiffness)


def spline_profile(name: str, s: Array, y: Array, z: Array, notes: tuple[str, ...]) -> Profile:
    """C2 cubic spline through the points, over the arc length of the curve itself."""
    first_y, first_z = (cubic_spline(s, values, "natural") for values in (y, z))
    node, weight = GAUSS_5
    half = 0.5 * np.diff(s)
    at = s[:-1, None] + half[:, None] * (1 + np.array(node))
    length = half * weighted_sum(hypot(first_y(at, 1), first_z(at, 1)), weight)
    arc = np.concatenate([[0.0], np.cumsum(length)])
    dy, dz = (slopes(arc, values, "natural") for values in (y, z))
    return Profile(name, arc, y, z, dy, dz, notes)
