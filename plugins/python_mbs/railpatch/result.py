"""The result of a solve: one form for the command line, solve() and step()."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import suppress
from html import escape
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from railpatch import _core
from railpatch.case.types import SIDES
from railpatch.errors import CaseError

# quantities that the core gives and the JSON result leaves out, and why; by struct
LEFT_OUT = {
    "patch": {
        "normal_iterations": "part of iterations",
        "newton_iterations": "part of iterations",
        "inner_iterations": "work of the tangential solver, for those who measure it in C",
        "direction": "of the case",
        "grid": "the shape of the fields",
        "grid_origin": "in the fields x and y",
        "element_size": "in the fields x and y",
        "reason_value": "in the text of reason",
    },
    "side": {
        "patch_count": "the length of patches",
        "alternative_count": "the length of alternatives",
        "reason_value": "in the text of reason",
    },
}
# what a patch given by itself has from its case
GIVEN = (
    *("share", "position", "contact_angle", "creepage", "spin_creepage", "rolling_speed"),
    *("wheel_profile_position", "rail_profile_position"),
)


def unit_of(struct: str, name: str) -> str:
    """Of a quantity of the core; none for a number without one."""
    unit = str(_core.QUANTITIES[struct][name]["unit"])
    return "" if unit == "-" else unit


def units_of(struct: str, added: dict[str, dict[str, str]]) -> dict[str, str]:
    """Units by name in the core's order; added: name -> units of what stands before it."""
    units: dict[str, str] = {}
    for name in _core.QUANTITIES[struct]:
        units |= added.get(name, {})
        if name not in LEFT_OUT[struct]:
            units[name] = unit_of(struct, name)
    return units


_PATCH = units_of("patch", {"normal_iterations": {"iterations": ""}})
# quantities of a patch in the order of the JSON result, with their units
PATCH_UNITS = {name: unit for name, unit in _PATCH.items() if name not in GIVEN}
# what a patch of a wheel has besides
PLACE_UNITS = {name: unit for name, unit in _PATCH.items() if name in GIVEN}
WHEEL_UNITS = units_of("side", {"rolling_radius": {"z": unit_of("result", "z")}})
# of the wheels together: what they have and the core's result has too
TOTAL_UNITS = {
    name: unit for name, unit in WHEEL_UNITS.items() if name in _core.QUANTITIES["result"]
}
# of a wheelset besides, given or found
WHEELSET_UNITS = {
    name: unit_of("result", name)
    for name in ("roll", "pitch_rate", "axle_torque", "rolling_radius_difference", "conicity")
}
# of a wheel alone, where a step finds how it turns
TURNING = ("pitch_rate", "axle_torque")
DIVISION: tuple[str, ...] = _core.CHOICES["element"]
# fields with their number of components
FIELDS = {
    "x": 0,
    "y": 0,
    "pressure": 1,
    "traction": 2,
    "micro_slip": 2,
    "element_division": 1,
    "temperature": 2,
    "friction": 1,
    "plastic_displacement": 2,
    "plastic_path": 1,
    "yield_stress": 1,
    "fluid_pressure": 1,
    "film_thickness": 1,
    "asperity_share": 1,
    "row_position": 2,
    "row_angle": 1,
}
# only where the scene has such a law
LAW_FIELDS = ("friction", "plastic_displacement", "plastic_path", "yield_stress")
ROW_FIELDS = ("row_position", "row_angle")  # of curved reference surfaces
FLUID_FIELDS = ("fluid_pressure", "film_thickness", "asperity_share")  # of a liquid by strips
GOOD = ("converged", "no_contact")
# whose numbers are a solution
SOLVED = (*GOOD, "accuracy_not_met", "work_spent")
# and that have contact
CARRIES = ("converged", "accuracy_not_met", "work_spent")
_INF = math.inf


# of a wheelset, that runs log beside its state
LOGGED = ("rolling_radius_difference", "conicity", "wear_number")


def logged(result: Any) -> dict[str, Any]:
    """Of a wheelset's result, what it has of these; None for what is left out."""
    return plain_json({name: result[name] for name in LOGGED if name in result})


class Source(Protocol):
    """What a result is read from as it is asked for."""

    def whole(self) -> dict[str, Any]:
        """All quantities."""

    def quantity(self, key: str) -> Any:
        """One of them; KeyError where it takes all."""


class Result(Mapping[str, Any]):
    """What a solve gives. Signs: forces act on the wheel, creepages are wheel minus rail.

    A mapping of the quantities of the JSON result (SI units), as is ``data``; fields are numpy
    arrays there: x [nx] (fitted rows: [ny, nx]) and y [ny] in m, pressure [ny, nx] in Pa, traction
    [2, ny, nx] in Pa, micro_slip [2, ny, nx] relative to the rolling speed, element_division
    [ny, nx] as 0 exterior, 1 stick, 2 slip, 3 plastic, temperature [2, ny, nx] of wheel and rail in
    degrees C. Curved reference surfaces have row_position [2, ny], y and z of each row of elements
    in track axes (m), and row_angle [ny], its contact angle (rad). A liquid by strips has
    fluid_pressure (Pa), film_thickness (m) and asperity_share (-), [ny, nx]. ``iterations`` is the
    sum of conjugate-gradient steps of the normal and Newton steps of the tangential problem.
    ``error_estimate`` holds what 95 % of the errors of creep_force (N, length of the vector),
    spin_moment (N m) and max_pressure (Pa) stay below. A wheel's ``alternatives`` are solutions of
    its contact areas divided into other patches than ``patches``: where patches join or part, both
    count, each with its ``share`` (1 elsewhere) in the force, moment and rolling radius. Powers and
    elastic energy of a wheel and of a wheelset are the sums by share, temperature and residual the
    greatest; ``contact_power`` is what its force and moment give the wheelset. What the scene left
    out is NaN or None.
    """

    def __init__(self, data: dict[str, Any] | Source) -> None:
        self._data, self._source = (data, None) if isinstance(data, dict) else (None, data)

    @property
    def data(self) -> dict[str, Any]:
        """All quantities, by name."""
        if self._data is None:
            self._data, self._source = self._source.whole(), None
        return self._data

    def __getitem__(self, key: str) -> Any:
        if self._source is not None:
            with suppress(KeyError):
                return self._source.quantity(key)
        return self.data[key]

    def __contains__(self, key: object) -> bool:
        return key in self.data

    def __iter__(self) -> Iterator[str]:
        return iter(self.data)

    def __len__(self) -> int:
        return len(self.data)

    # arrays have no truth: one result is itself alone
    __eq__ = object.__eq__
    __hash__ = object.__hash__

    def __reduce__(self) -> tuple[Any, ...]:
        return Result, (self.data,)

    def keys(self) -> list[str]:
        """Names of the quantities."""
        return list(self.data)

    def __repr__(self) -> str:
        return f"Result(status={self.status!r}, keys={list(self.data)})"

    def plot(self) -> Any:
        """A plotly.graph_objects.Figure of all patches side by side: pressure, traction with its
        arrows, stick and slip. Needs fields: ``step(fields=True)``. Raises CaseError."""
        from railpatch.page.patch_figure import patches_figure  # plotly: half a second

        patches = self._patches()
        grids = {name: grid_of(patch) for name, patch in patches.items() if "pressure" in patch}
        if not grids:
            told = "has no contact" if not patches else f"is {self.status} and has no fields"
            raise CaseError(f"plot: the result {told}, allowed a contact with fields=True")
        return patches_figure(grids)

    def _patches(self) -> dict[str, dict[str, Any]]:
        """Those in contact, by a title."""
        if "patches" not in self.data and not any(side in self.data for side in SIDES):
            return {"": self.data} if self.status != "no_contact" else {}
        found: dict[str, dict[str, Any]] = {}
        for side in ("", *SIDES):
            wheel = self.data if not side else self.data.get(side)
            patches = wheel.get("patches", ()) if isinstance(wheel, dict) else ()
            for i, patch in enumerate(patches, start=1):
                found[f"{side} patch {i}".strip()] = patch
        return found

    def _repr_html_(self) -> str:
        """A table for a notebook: numbers with units, of each wheel and patch."""
        parts = [_html_table(str(self.data.get("status")), self.data)]
        for side in ("left", "right"):
            if isinstance(self.data.get(side), dict):
                parts.append(_html_table(f"{side} wheel", self.data[side]))
        wheels = [self.data, *(self.data.get(side) for side in ("left", "right"))]
        for wheel in wheels:
            patches = wheel.get("patches", ()) if isinstance(wheel, dict) else ()
            parts += [_html_table(f"patch {i}", patch) for i, patch in enumerate(patches)]
        return "".join(parts)

    @property
    def status(self) -> str:
        """One of "converged", "no_contact", "not_converged", "out_of_range", "accuracy_not_met"
        and "work_spent"."""
        return str(self["status"])

    @property
    def reason(self) -> str | None:
        """Why the status is not good: which condition, by what number, and what to change."""
        return self.data.get("reason")

    @property
    def warnings(self) -> list[str]:
        """What can hardly be meant, though it was solved: a unit, a sign, a grid."""
        return list(self.data.get("warnings", ()) if self._source is None else self["warnings"])

    @property
    def good(self) -> bool:
        """Whether the solve ended well; no contact is a valid result."""
        return self.status in GOOD

    @property
    def solved(self) -> bool:
        """Whether the numbers are a solution, be it as accurate as asked for or not."""
        return self.status in SOLVED

    def to_dict(self) -> dict[str, Any]:
        """The JSON result: plain numbers and lists, None for what is left out."""
        return plain_json(self.data)


def grid_of(patch: dict[str, Any]) -> dict[str, Any]:
    """The fields of a patch as a figure takes them: x and y of each element, vectors last."""
    pressure = np.asarray(patch["pressure"])
    traction = patch.get("traction")
    return {
        "x": np.broadcast_to(patch["x"], pressure.shape),
        "y": np.broadcast_to(np.asarray(patch["y"])[:, None], pressure.shape),
        "pressure": pressure,
        "traction": None if traction is None else np.moveaxis(traction, 0, -1),
        "element_division": patch.get("element_division"),
    }


# of the greatest component beside it, and of a patch's normal force (over a metre for moments):
# less is what the solver's tolerance leaves where 0 is meant, by symmetry for instance
NOISE = 1e-7
NOISE_OF_LOAD = {"N": 1e-9, "N m": 1e-11}


def noise_of(unit: str, load: float | None) -> float:
    """What is printed as 0 below, in the unit, beside a load (N)."""
    return NOISE_OF_LOAD.get(unit, 0.0) * abs(load or 0.0)


def six_digits(values: Sequence[float], least: float = 0.0) -> list[str]:
    """Numbers of one quantity for people: 0 for what is least or less, or noise beside the others.
    Empty for NaN."""
    size = max((abs(v) for v in values if math.isfinite(v)), default=0.0)
    least = max(least, NOISE * size if len(values) > 1 else 0.0)
    shown = (0.0 if abs(v) <= least else v + 0.0 for v in values)
    return ["" if math.isnan(v) else f"{v:.6g}" for v in shown]


def _html_table(title: str, quantities: dict[str, Any]) -> str:
    """What is a number, some numbers or a text."""
    units = {**PATCH_UNITS, **PLACE_UNITS, **WHEEL_UNITS, **WHEELSET_UNITS}
    rows = []
    for name, value in quantities.items():
        values = value if isinstance(value, list | tuple) else [value]
        if name in FIELDS or value is None or not values:
            continue
        if not all(isinstance(v, str | int | float) for v in values):
            continue
        unit = units.get(name, "")
        floats = [v for v in values if isinstance(v, float)]
        if len(floats) == len(values):
            texts = six_digits(floats, noise_of(unit, quantities.get("normal_force")))
        else:
            texts = [f"{v:.6g}" if isinstance(v, float) else str(v) for v in values]
        cells = (name, ", ".join(texts), unit)
        rows.append("".join(f"<td>{escape(cell)}</td>" for cell in cells))
    body = "".join(f"<tr>{row}</tr>" for row in rows)
    return f"<table><caption>{escape(title)}</caption>{body}</table>"


class Warned:
    """Warnings of a run: in how many of its steps, and when first."""

    def __init__(self) -> None:
        self.found: dict[str, tuple[int, str]] = {}

    def add(self, when: str, texts: Iterable[str]) -> None:
        """Those of a step. when: its time or place, with the unit."""
        for text in texts:
            count, first = self.found.get(text, (0, when))
            self.found[text] = count + 1, first

    def lines(self) -> list[str]:
        """One for each."""
        return [
            f"{text}; in {count} step{'s' if count > 1 else ''}, first at {first}"
            for text, (count, first) in self.found.items()
        ]


def plain_json(value: Any) -> Any:
    """NaN and infinity as None, arrays as lists."""
    if isinstance(value, dict):
        # the many finite numbers of a result need no call of their own
        return {
            key: item if type(item) is float and -_INF < item < _INF else plain_json(item)
            for key, item in value.items()
        }
    if isinstance(value, list):
        return [
            item if type(item) is float and -_INF < item < _INF else plain_json(item)
            for item in value
        ]
    if isinstance(value, float):
        return value if math.isfinite(value) else None
    if isinstance(value, np.ndarray):
        # fields of a contact: all finite but where a curved surface has none
        if value.dtype.kind in "iu" or (value.dtype.kind == "f" and np.isfinite(value).all()):
            return value.tolist()
        return plain_json(value.tolist())
    return value


def wheel_json(side: dict[str, Any]) -> dict[str, Any]:
    """Of one side of a result: the JSON result without the fields of its patches."""
    found = dict(side)
    for name in ("patches", "alternatives"):
        found[name] = [
            {key: value for key, value in patch.items() if key not in FIELDS}
            for patch in side[name]
        ]
    return plain_json(found)


def patch_data(
    patch: dict[str, Any], *, of_wheel: bool, creepage_found: bool = False
) -> dict[str, Any]:
    """The quantities of one patch, from the core's rp_patch_result.

    creepage_found: the case prescribes a tangential force.
    """
    elements = dict(zip(DIVISION, patch["elements"], strict=True))
    creep_force = patch["creep_force"]
    if math.isnan(creep_force[0]):
        # no tangential problem: nothing is known of stick and slip
        creep_force = None
        elements.update(stick=None, slip=None, plastic=None)
    data = {
        **patch,
        "creep_force": creep_force,
        "elements": elements,
        "iterations": patch["normal_iterations"] + patch["newton_iterations"],
    }
    names = [*PATCH_UNITS, *(PLACE_UNITS if of_wheel else ["creepage"] if creepage_found else [])]
    return {name: data[name] for name in names}


def known(values: list[float]) -> list[float] | None:
    """None for what the scene does not have."""
    return None if all(map(math.isnan, values)) else values


def wheel_data(side: dict[str, Any], z: float) -> dict[str, Any]:
    """The quantities of one wheel, from the core's rp_side_result."""
    found = {name: z if name == "z" else side[name] for name in WHEEL_UNITS}
    for name in ("rail_deflection", "rail_deflection_rate"):
        found[name] = known(side[name])
    for name in ("patches", "alternatives"):
        found[name] = [patch_data(patch, of_wheel=True) for patch in side[name]]
    return found


def field_shape(name: str, grid: list[int]) -> tuple[int, ...]:
    """Shape of a field on a grid [nx, ny]; x runs fastest."""
    nx, ny = grid
    components = FIELDS[name]
    if name in ("x", "y"):
        return (nx,) if name == "x" else (ny,)
    if name in ROW_FIELDS:
        return (ny,) if components == 1 else (components, ny)
    return (ny, nx) if components == 1 else (components, ny, nx)


def shaped_field(name: str, values: NDArray[np.float64] | None, grid: list[int]) -> Any:
    """A field in its shape; None where the scene has none."""
    if values is None:
        return None
    # nodes of fitted rows have their own x in each row
    by_row = name == "x" and values.size != grid[0]
    field = values.reshape((grid[1], grid[0]) if by_row else field_shape(name, grid))
    return field.astype(np.int64) if name == "element_division" else field
