"""From values at the nodes to the coefficients of core/fast/creep_table.hpp."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from railpatch.evidence.table.recipe import MIRROR, REVERSAL, Recipe

FORCES = ((0, 0), (1, 1), (1, 2), (2, 1), (2, 2))  # entries of A that the symmetries leave
INT16 = 32767


@dataclass(frozen=True)
class Coefficients:
    """scale [poisson, ratio, 3], linear [poisson, ratio, t, 8], remainder [poisson, ratio, psi,
    theta, t, 3] in units of remainder_scale [3]."""

    scale: np.ndarray
    linear: np.ndarray
    remainder: np.ndarray
    remainder_scale: np.ndarray


def fit(values: np.ndarray, axis: int) -> np.ndarray:
    """Coefficients of the uniform cubic B-spline through equidistant values, two more than there
    are; the third derivative has no jump at the last node but one (not-a-knot, de Boor 1978)."""
    count = values.shape[axis]
    matrix = np.zeros((count + 2, count + 2))
    for i in range(count):
        matrix[i + 1, i : i + 3] = np.array([1.0, 4.0, 1.0]) / 6.0
    matrix[0, :5] = matrix[-1, -5:] = [1.0, -4.0, 6.0, -4.0, 1.0]
    right = np.moveaxis(values, axis, 0)
    padded = np.zeros((count + 2, *right.shape[1:]))
    padded[1:-1] = right
    solved = np.linalg.solve(matrix, padded.reshape(count + 2, -1)).reshape(padded.shape)
    return np.moveaxis(solved, 0, axis)


def fit_periodic(values: np.ndarray, axis: int) -> np.ndarray:
    """The same for one period; as many coefficients as values."""
    count = values.shape[axis]
    matrix = (4.0 * np.eye(count) + np.eye(count, k=1) + np.eye(count, k=-1)) / 6.0
    matrix[0, -1] = matrix[-1, 0] = 1.0 / 6.0
    right = np.moveaxis(values, axis, 0)
    solved = np.linalg.solve(matrix, right.reshape(count, -1)).reshape(right.shape)
    return np.moveaxis(solved, 0, axis)


def linear_part(recipe: Recipe, f: np.ndarray) -> np.ndarray:
    """A [..., t, 3, 3] from F/t = f [..., psi, theta, t, 3]: its value at pure spin and its first
    harmonics in theta next to it."""
    pole, ring = recipe.psi, recipe.psi - 1
    theta, psi = recipe.theta_nodes, recipe.psi_nodes[ring]
    a = np.zeros((*f.shape[:-4], f.shape[-2], 3, 3))
    a[..., :, 1:, 2] = f[..., pole, 0, :, 1:]
    weight = np.full(theta.size, 2.0 / recipe.theta)  # half of the circle stands for all
    weight[[0, -1]] *= 0.5
    rest = f[..., ring, :, :, :] - a[..., None, :, :, 2] * np.sin(psi)
    harmonics = {0: np.cos(theta), 1: np.sin(theta)}
    for i, k in FORCES:
        if k < 2:
            harmonic = weight * harmonics[k] / np.cos(psi)
            a[..., i, k] = np.einsum("j,...jt->...t", harmonic, rest[..., i])
    return a


def remainder_part(recipe: Recipe, f: np.ndarray, a: np.ndarray) -> np.ndarray:
    """h [..., psi, theta, t, 3] at the nodes, extrapolated to pure spin."""
    count = range(recipe.psi + 1), range(recipe.theta + 1)
    n = np.array([[recipe.direction(j, k) for k in count[1]] for j in count[0]])
    h = f - np.einsum("...tij,pqj->...pqti", a, n)
    level = np.cos(recipe.psi_nodes[:-1]) ** 2
    h[..., :-1, :, :, :] /= level[:, None, None, None]
    inner = [h[..., -1 - k, :, :, :] for k in (1, 2, 3)]
    h[..., -1, :, :, :] = 3.0 * inner[0] - 3.0 * inner[1] + inner[2]
    h[..., 0, :] = 0.0
    return h


def fit_directions(recipe: Recipe, h: np.ndarray) -> np.ndarray:
    """Coefficients along psi and theta of h [..., psi, theta, t, 3], one beyond either end."""
    beyond = (REVERSAL * h[..., 1:-1, :, :])[..., ::-1, :, :]
    circle = np.concatenate([h, beyond], axis=-3)
    circle = fit_periodic(circle, circle.ndim - 3)
    count = recipe.theta
    # psi < 0 is the mirror image at -theta
    turned = (count - np.arange(2 * count)) % (2 * count)
    below = (MIRROR * circle[..., 1:, :, :, :])[..., ::-1, :, :, :][..., turned, :, :]
    whole = np.concatenate([below, circle], axis=-4)
    whole = fit(whole, whole.ndim - 4)
    theta = np.arange(-1, count + 2) % (2 * count)
    # of the coefficients from -psi - 1 to psi + 1 those from -1 on
    return whole[..., recipe.psi :, :, :, :][..., theta, :, :]


def quantise(h: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """int16 and their unit; symmetric exactly, and zero at t = 0 exactly."""
    unit = np.abs(h).reshape(-1, 3).max(axis=0) / (INT16 - 8)
    q = np.rint(h / unit).astype(np.int64)
    # along t: (c[-1] + 4 c[0] + c[1])/6 = 0
    q[..., 0, :] = -4 * q[..., 1, :] - q[..., 2, :]
    reversal, mirror = REVERSAL.astype(int), MIRROR.astype(int)
    for end, step in ((1, 1), (-2, -1)):
        q[..., end, :, 0] = 0
        q[..., end - step, :, :] = reversal * q[..., end + step, :, :]
    middle = q.shape[-3] // 2
    plane = q[..., 1, :, :, :]
    plane[..., :middle, :, :] = mirror * plane[..., :middle:-1, :, :]
    plane[..., middle, :, 1:] = 0
    q[..., 0, :, :, :] = mirror * q[..., 2, ::-1, :, :]
    if np.abs(q).max() > INT16:
        raise OverflowError("a coefficient does not fit into 16 bits")
    return q.astype("<i2"), unit


def coefficients(
    recipe: Recipe, forces: np.ndarray, slope: np.ndarray, scale: np.ndarray
) -> Coefficients:
    """From (Fx, Fy, Mz/c)/B at the nodes, [poisson, ratio, psi, theta, t, 3]."""
    t = recipe.t_nodes
    f = np.zeros_like(forces)
    f[..., 1:, :] = forces[..., 1:, :] / t[1:, None]
    a = linear_part(recipe, f)
    # at vanishing creepage |v| = R t
    a[..., 0, :, :] = recipe.radius * slope / scale[..., None, :]
    h = remainder_part(recipe, f, a)
    h = fit(fit(fit_directions(recipe, h), h.ndim - 2), 1)
    linear = np.zeros((3, recipe.ratios + 3, recipe.t + 3, 8), "<f4")
    entries = np.stack([a[..., i, k] for i, k in FORCES], axis=-1)
    linear[..., :5] = fit(fit(entries, 2), 1)
    remainder, unit = quantise(h)
    return Coefficients(fit(scale, 1), linear, remainder, unit)
