"""What of a record does not go with its scene, or one wheel's numbers with the other's."""

from __future__ import annotations

import numpy as np

from railpatch.record.quantities import BY_NAME, SIDES
from railpatch.record.read import Record
from railpatch.record.units import UNITS

# beyond this factor of what is to be expected a number is hardly meant in its unit, and within this
# one another unit would fit
HARDLY, FITS = 2.0, 1.4
# rows from which on signs are compared; L/V, by which each wheel's has to change (90 % of rows)
LEAST_ROWS, LEAST_CHANGE = 5, 0.05
# correlation of both wheels' L/V below which one of them has the other sign
OPPOSITE = -0.5


def force_doubts(record: Record, load: float) -> list[str]:
    """Forces that do not fit the load on both wheels (N), with the unit that would fit."""
    signals, found = record.signals, []
    expected = load
    if "vertical_load" in signals:
        own = float(np.nanmedian(signals["vertical_load"]))
        found += off_by(record, "vertical_load", own, load, "wheelset.vertical_force")
        expected = own
    sides = [f"{side}_vertical" for side in ("left", "right") if f"{side}_vertical" in signals]
    if sides:
        # of both together the load is known, of one that it carries some part
        total = sum(float(np.nanmedian(signals[name])) for name in sides) * 2 / len(sides)
        found += off_by(record, sides[0], total, expected, "the vertical load")
    for side in ("left", "right"):
        lateral, vertical = signals.get(f"{side}_lateral"), signals.get(f"{side}_vertical")
        if lateral is None or vertical is None:
            continue
        ratio = float(np.nanmax(np.abs(lateral)) / abs(np.nanmedian(vertical)))
        if not 1e-3 < ratio < 2.0:
            found.append(
                f"{side}_lateral: is up to {ratio:.3g} of {side}_vertical, which is hardly meant: "
                f"units {record.units[f'{side}_lateral']!r}, {record.units[f'{side}_vertical']!r}"
            )
    return found


def speed_doubts(record: Record, roller_rate: float, roller_radius: float) -> list[str]:
    """Speeds of a record that are not those of the scene's rollers (rad/s, m)."""
    expected = {"speed": roller_rate * roller_radius, "roller_pitch_rate": roller_rate}
    what = {"speed": "track.roller_pitch_rate times track.roller_radius"}
    return [
        line
        for name, value in expected.items()
        if name in record.signals and value != 0.0
        for line in off_by(
            record,
            name,
            float(np.nanmedian(np.abs(record.signals[name]))),
            abs(value),
            what.get(name, f"track.{name}"),
        )
    ]


def sign_doubts(record: Record) -> list[str]:
    """Of L/V of both wheels that change against each other: yaw and lateral position move both the
    same way, to the right > 0, whatever the load."""
    ratios = []
    for side in SIDES:
        own = record.signals.get(f"{side}_ratio")
        lateral, vertical = (record.signals.get(f"{side}_{k}") for k in ("lateral", "vertical"))
        if own is None and lateral is not None and vertical is not None:
            with np.errstate(divide="ignore", invalid="ignore"):
                own = lateral / np.abs(vertical)
        ratios.append(own)
    if any(values is None for values in ratios):
        return []
    both = np.array(ratios)
    both = both[:, np.isfinite(both).all(axis=0)]
    if both.shape[1] < LEAST_ROWS:
        return []
    low, high = np.quantile(both, [0.05, 0.95], axis=1)
    if (high - low).min() < LEAST_CHANGE:
        return []
    found = float(np.corrcoef(both)[0, 1])
    if found > OPPOSITE:
        return []
    names = ["left_ratio", "right_ratio"] if "left_ratio" in record.signals else []
    names = names or ["left_lateral", "right_lateral"]
    return [
        f"{names[0]} and {names[1]}: L/V of the wheels change against each other (correlation "
        f"{found:.2g}), which is hardly meant: both are > 0 to the right; has one the other sign?"
    ]


def off_by(record: Record, name: str, value: float, expected: float, what: str) -> list[str]:
    """A number that differs by a factor, with the units whose ratio explains it."""
    factor = value / expected
    if 1 / HARDLY < factor < HARDLY:
        return []
    known = UNITS[BY_NAME[name].dimension]
    si, used = next(iter(known)), known[record.units[name]].factor
    fitting = [
        repr(unit)
        for unit, other in known.items()
        if 1 / FITS < factor * other.factor / used < FITS
    ]
    hint = f"; is its unit {' or '.join(fitting)}?" if fitting else ""
    return [
        f"{name}: its median of {value:.6g} {si} (unit {record.units[name]!r}) is {factor:.3g} of "
        f"{what}, {expected:.6g} {si}{hint}"
    ]
