"""Laws of wear and of rolling contact fatigue, as functions of what a contact gives.

Wear by work (USFD: Lewis and Dwyer-Joyce 2004; Braghin et al. 2006): mass that each body loses, by
metre rolled and by area of the contact, over the work of friction by metre rolled and area. Archard
(1953): volume k p s/H by area of pressure p and way of slip s. Both hold for each of the bodies.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from railpatch.case.asked import Damage

Array = NDArray[np.float64]


def usfd(work: ArrayLike, law: Damage) -> Array:
    """kg/m^3: mass by metre rolled and m^2. work: N/m^2, of friction by metre rolled and m^2.

    5.3 x up to x = 10.4 N/mm^2, 55.0 up to 77.2, then 55.0 + 61.9 (x - 77.2) ug/(m mm^2), with
    the law's own constants.
    """
    x = np.asarray(work, dtype=float)
    mild, last = law.usfd_limits
    beyond = law.usfd_plateau + law.usfd_slope * (x - last)
    return np.where(x <= mild, law.usfd_rate * x, np.where(x <= last, law.usfd_plateau, beyond))


def archard(pressure: ArrayLike, slip: ArrayLike, speed: float, law: Damage) -> Array:
    """kg/m^3, as usfd. pressure: Pa. slip: -, way of slip by metre rolled. speed: m/s, rolled."""
    p, s = np.asarray(pressure, dtype=float), np.asarray(slip, dtype=float)
    points = np.asarray(law.archard_map)
    region = np.searchsorted(points[:, 0], speed * s, side="right") - 1
    coefficient = np.where(
        p > law.seizure_pressure * law.hardness, law.seizure_coefficient, points[region, 1]
    )
    return law.worn_density * coefficient * p * s / law.hardness


def fatigue_index(traction_coefficient: float, max_pressure: float, law: Damage) -> float:
    """-, FI_surf: above 0 beyond the surface's shakedown limit (Ekberg, Kabo and Andersson 2002).

    f - 2 pi a b k/(3 Fz), which of Hertz's pressure is f - k/p0.
    """
    if not max_pressure > 0:
        return float("nan")
    return float(traction_coefficient - law.shear_yield / max_pressure)


def whole_life(wear_number: float, law: Damage) -> float:
    """-, damage of one passage by the whole-life function of T gamma; below 0 wear takes more of
    the cracks than they grow."""
    points = np.asarray(law.whole_life)
    if wear_number <= points[-1, 0] or len(points) < 2:
        return float(np.interp(wear_number, points[:, 0], points[:, 1]))
    slope = (points[-1, 1] - points[-2, 1]) / (points[-1, 0] - points[-2, 0])
    return float(points[-1, 1] + slope * (wear_number - points[-1, 0]))
