"""Influence coefficients of the user's own: their file, what they must be, and with what they go.

A file has the displacement difference of the surfaces, in m, by 1 Pa on one element of the grid, at
the elements around it: `zz` normal by pressure, `xx` and `yy` along and across rolling by traction
the same way, `xy` along rolling by traction across. Arrays [lateral offset][offset along rolling]
of an odd number of rows and columns have the loaded element in the middle.
"""

from __future__ import annotations

import zipfile
import zlib
from functools import lru_cache
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from railpatch.case.common import check_whole_theory
from railpatch.case.gap import read_gap, read_rows
from railpatch.case.types import LEFT_OUT, Problems, relation
from railpatch.case.viscous import is_viscous
from railpatch.errors import CaseError

KEY = "material.influence_file"
NAMES = ("zz", "xx", "yy", "xy")
Array = NDArray[np.float64]

# of the greatest coefficient: what rounding leaves of symmetry
ROUNDING = 1e-9
# unknowns up to which all eigenvalues are found; beyond, the ends by Lanczos' method
DENSE = 600
# share of the greatest eigenvalue below which the least is none
SINGULAR = 1e-12
# Pa, as for material.shear_modulus: of a half-space with this zz of an element by itself, nu = 0.28
STIFFNESS = (1e8, 1e12)
# xx or yy of an element by itself over zz; of half-spaces 1 to 1.5 on squares
RATIO = (1e-2, 1e2)


def check_own_influence(case: Any) -> Problems:
    """Of any kind of case."""
    material = case.material
    if material.influence_file is None:
        return
    where = f"with {KEY}"
    if case.kind != "patch":
        yield relation("kind", repr(case.kind), f"'patch' {where}: grids of wheels follow them")
        return
    for name in ("shear_modulus", "poisson_ratio"):
        if name in material.model_fields_set:
            shown = str(getattr(material, name))
            yield relation(f"material.{name}", shown, f"{LEFT_OUT} {where}: it has the bodies")
    if is_viscous(material):
        shown = str(material.viscoelastic_ratio)
        yield relation("material.viscoelastic_ratio", shown, f"0 {where}")
    if case.geometry.undeformed_distance is None:
        allowed = f"given {where}: its rows and columns are the grid"
        yield relation("geometry.undeformed_distance", "missing", allowed)
    yield from _check_method(case, where)
    for name in ("layer", "fluid", "subsurface", "damage"):
        if getattr(case, name, None) is not None:
            yield relation(name, "given", f"{LEFT_OUT} {where}")


def _check_method(case: Any, where: str) -> Problems:
    motion = case.motion
    for regime in dict.fromkeys((motion.regime, *motion.of_steps)):
        if regime == "transient_rolling":
            allowed = f"'steady_rolling', 'shift' or 'none' {where}: steps are of whole elements"
            yield relation("motion.regime", repr(regime), allowed)
    if motion.changes:
        yield relation("motion.regimes", "given", f"{LEFT_OUT} {where}")
    yield from check_whole_theory(case, where)


def read_own_influence(path: Path, shape: tuple[int, int], *, tractions: bool) -> Array:
    """m/Pa, [4 or 1 without tractions][ny][nx + 1], of offsets from 0 on, as the core takes them.

    shape: (ny, nx) of the grid. Raises CaseError.
    """
    try:
        about = path.stat()
    except OSError as error:
        raise CaseError(f"{KEY}: {path} cannot be read: {error.strerror or error}") from None
    return _read(path, about.st_size, about.st_mtime_ns, shape, tractions)


@lru_cache(maxsize=4)
def _read(path: Path, _size: int, _changed: int, shape: tuple[int, int], tractions: bool) -> Array:
    names = NAMES if tractions else NAMES[:1]
    arrays = _from_csv(path, names, shape) if path.suffix == ".csv" else _from_npz(path, names)
    parts = [quadrant(f"{KEY}: {path}: {name}", arrays[name], name, shape) for name in names]
    found = np.stack(parts)
    check_positive(f"{KEY}: {path}", found)
    found.setflags(write=False)
    return found


def _from_npz(path: Path, names: tuple[str, ...]) -> dict[str, Array]:
    """Arrays by name."""
    try:
        opened = np.load(path, allow_pickle=False)
        if isinstance(opened, np.ndarray):
            raise ValueError("one array without a name, as .npy files have")
        with opened as file:
            unknown = sorted(set(file) - set(NAMES))
            read = {name: np.asarray(file[name]) for name in NAMES if name in file}
            if any(array.dtype.kind not in "fiu" for array in read.values()):
                raise ValueError("others than real ones")
            given = {name: np.asarray(array, float) for name, array in read.items()}
    except (OSError, ValueError, TypeError, EOFError, zipfile.BadZipFile, zlib.error) as error:
        raise CaseError(f"{KEY}: {path} is no .npz file of arrays of numbers: {error}") from None
    if unknown:
        raise CaseError(f"{KEY}: {path} has an array {unknown[0]!r}, allowed {', '.join(NAMES)}")
    return _completed(path, given, names)


def _from_csv(path: Path, names: tuple[str, ...], shape: tuple[int, int]) -> dict[str, Array]:
    """Rows of offsets in elements along and across rolling, zz and with tractions xx, yy, xy;
    those that the grid has."""
    many = (3, 6) if len(names) == 1 else (6,)
    ny, nx = shape
    found = np.full((len(names), 2 * ny - 1, 2 * nx + 1), np.nan)
    for line, row in read_rows(path, KEY):
        if len(row) in many and any(value != int(value) for value in row[:2]):
            raise CaseError(
                f"{KEY}: {path}:{line}: offsets are {row[0]:g}, {row[1]:g}, allowed whole numbers "
                "of elements, along rolling and across"
            )
        if len(row) not in many:
            allowed = " or ".join(map(str, many))
            raise CaseError(
                f"{KEY}: {path}:{line}: {len(row)} values, allowed {allowed}: two whole offsets in "
                "elements, along rolling and across, then zz and xx, yy, xy"
            )
        x, y = int(row[0]), int(row[1])
        if abs(x) > nx or abs(y) >= ny:
            continue
        at = (slice(None), y + ny - 1, x + nx)
        if not np.isnan(found[at]).all():
            raise CaseError(f"{KEY}: {path}:{line}: offset {x}, {y} is given twice")
        found[at] = row[2 : 2 + len(names)]
    if np.isnan(found).all():
        raise CaseError(f"{KEY}: {path} has no rows of offsets that the grid has, {nx} by {ny}")
    # of offsets that have none, those of their mirror images
    for k, name in enumerate(names):
        for axis in (0, 1):
            sign = -1.0 if name == "xy" else 1.0
            found[k] = np.where(np.isnan(found[k]), sign * np.flip(found[k], axis), found[k])
    return dict(zip(names, found, strict=True))


def _completed(path: Path, given: dict[str, Array], names: tuple[str, ...]) -> dict[str, Array]:
    """Without coefficients across there are none of them."""
    if "xy" in names and "xy" not in given and "xx" in given:
        given["xy"] = np.zeros_like(given["xx"])
    missing = [name for name in names if name not in given]
    if missing:
        raise CaseError(f"{KEY}: {path} has no array {missing[0]!r}, allowed {', '.join(names)}")
    return given


def quadrant(what: str, values: Array, name: str, shape: tuple[int, int]) -> Array:
    """Coefficients at offsets from 0 on, of a full array that has all signs. Raises CaseError."""
    ny, nx = shape
    needed = (2 * ny - 1, 2 * nx + 1)
    if values.ndim != 2 or any(n % 2 == 0 for n in values.shape):
        raise CaseError(f"{what} has the shape {values.shape}, allowed two odd numbers")
    if values.shape[0] < needed[0] or values.shape[1] < needed[1]:
        raise CaseError(
            f"{what} has the shape {values.shape}, allowed at least {needed}: offsets of the "
            f"grid's {ny} rows of {nx} elements, and one more along rolling"
        )
    my, mx = values.shape[0] // 2, values.shape[1] // 2
    values = values[my - ny + 1 : my + ny, mx - nx : mx + nx + 1]
    if not np.isfinite(values).all():
        y, x = np.argwhere(~np.isfinite(values))[-1] - (ny - 1, nx)
        raise CaseError(f"{what} has no finite number at {x} elements along rolling and {y} across")
    sign = -1.0 if name == "xy" else 1.0
    for axis, along in ((1, "along rolling"), (0, "across")):
        apart = np.abs(values - sign * np.flip(values, axis)).max()
        if apart > ROUNDING * np.abs(values).max():
            even = "odd" if name == "xy" else "even"
            raise CaseError(
                f"{what} is not {even} {along}, by {apart:.3g} m/Pa: allowed those of bodies that "
                "are the same on either side of a load"
            )
    return np.ascontiguousarray(values[ny - 1 :, nx:])


def check_positive(what: str, values: Array) -> None:
    """Whether all pressures and tractions store energy. values: [4 or 1][ny][nx + 1]. Raises
    CaseError.

    Tractions on one element more along rolling: v . (2 A - S A - A S^T) v = (D v) . A (D v), with S
    a shift by an element and D the difference along rolling, so the operator of steady rolling is
    positive as well.
    """
    parts = {"pressures": values[:1, :, :-1], "tractions": values[1:]}
    for name, part in parts.items():
        if len(part) == 0 or surely_positive(part):
            continue
        least, most = extremes(part)
        if not least > SINGULAR * most:
            raise CaseError(
                f"{what}: some {name} would store no energy (least eigenvalue {least:.3g} of "
                f"{most:.3g} m/Pa), allowed coefficients of a positive definite operator"
            )


def spectra_of(part: Array) -> list[Array]:
    """Of zz, or of xx, yy and xy, m/Pa, which are real. part: [1 or 3][ny][nx], offsets from 0 on.

    On a period of twice as many elements either way, whose middle stands for the last offset: the
    operator on the grid is a part of the periodic one.
    """
    kinds, ny, nx = part.shape
    y, x = np.arange(2 * ny), np.arange(2 * nx)
    near = [np.minimum(np.minimum(k, 2 * n - k), n - 1) for k, n in ((y, ny), (x, nx))]
    whole = [values[np.ix_(*near)] for values in part]
    if kinds > 1:
        whole[2] = np.outer((y > 0) * np.sign(ny - y), (x > 0) * np.sign(nx - x)) * whole[2]
    return [np.fft.rfft2(values).real for values in whole]


def surely_positive(part: Array) -> bool:
    """Whether the periodic operator is positive definite: then so is any part of it. True of
    half-spaces."""
    one, *others = spectra_of(part)
    least = most = one
    if others:
        two, across = others
        mean, apart = (one + two) / 2, np.hypot((one - two) / 2, across)
        least, most = mean - apart, mean + apart
    return bool(least.min() > SINGULAR * most.max())


def operator_of(part: Array) -> tuple[int, Any]:
    """Number of unknowns, and the product with zz, or with xx, yy and xy. part: [1 or 3][ny][nx],
    offsets from 0 on."""
    kinds, ny, nx = part.shape
    size = (2 * ny, 2 * nx)
    spectra = spectra_of(part)

    def product(v: Array) -> Array:
        fields = v.reshape(-1, ny, nx)
        waves = [np.fft.rfft2(field, size) for field in fields]
        if kinds == 1:
            sums = [spectra[0] * waves[0]]
        else:
            sums = [
                spectra[0] * waves[0] + spectra[2] * waves[1],
                spectra[2] * waves[0] + spectra[1] * waves[1],
            ]
        return np.stack([np.fft.irfft2(s, size)[:ny, :nx] for s in sums]).ravel()

    return (1 if kinds == 1 else 2) * ny * nx, product


def extremes(part: Array) -> tuple[float, float]:
    """The least and the greatest eigenvalue, m/Pa; nan where an iteration does not find it."""
    from scipy.sparse.linalg import ArpackNoConvergence, LinearOperator, eigsh

    count, product = operator_of(part)
    if count <= DENSE:
        matrix = np.stack([product(row) for row in np.eye(count)])
        found = np.linalg.eigvalsh((matrix + matrix.T) / 2)
        return float(found[0]), float(found[-1])
    operator = LinearOperator((count, count), matvec=product, dtype=float)
    start = np.random.default_rng(0).standard_normal(count)

    def end(which: str) -> float:
        try:
            found = eigsh(
                operator, k=1, which=which, v0=start, ncv=60, maxiter=200, tol=1e-6,
                return_eigenvectors=False,
            )  # fmt: skip
        except ArpackNoConvergence:
            return float("nan")
        return float(found[0])

    return end("SA"), end("LA")


def own_of_square(nu: float) -> float:
    """-, G/width times zz of a half-space's square element by itself (Kalker 1990, appendix C)."""
    return 4 * (1 - nu) * np.arcsinh(1.0) / np.pi


def influence_doubts(case: Any, folder: Path) -> list[str]:
    """Warnings of coefficients that can hardly be meant, of any kind of case."""
    file = case.material.influence_file
    if file is None:
        return []
    shape = read_gap(case.geometry.undeformed_distance, folder).shape
    values = read_own_influence((folder / file).resolve(), shape, tractions=case.has_tangential)
    dx, dy = case.grid.element_size
    found = []
    own = values[:, 0, 0]
    stiffness = own_of_square(0.28) * (dx * dy) ** 0.5 / own[0]
    low, high = STIFFNESS
    if not low <= stiffness <= high:
        found.append(
            f"{KEY}: an element by itself is as soft as that of a half-space with a shear modulus "
            f"of {stiffness:.3g} Pa, outside {low:g} to {high:g} Pa: coefficients in another unit "
            "than m/Pa?"
        )
    for name, one in zip(NAMES[1:3], own[1:3], strict=False):
        least, most = RATIO
        if not least <= one / own[0] <= most:
            found.append(
                f"{KEY}: {name} of an element by itself is {one / own[0]:.3g} times zz, outside "
                f"{least:g} to {most:g}: in another unit?"
            )
    if (values[0] < 0).any():
        found.append(f"{KEY}: pressure on an element lifts others: zz is negative there")
    return found
