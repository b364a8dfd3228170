"""What engineers read of a run, over the run: wear number, Y, Q, Y/Q, utilised friction, size of
the patches, greatest traction, where wheel and rail touch, rolling radius difference, conicity."""

from __future__ import annotations

import numpy as np
import plotly.graph_objects as go
from plotly.subplots import make_subplots

from railpatch.case.types import SIDES
from railpatch.log.reader import Series
from railpatch.page.figures import COLORS, GREY, LINES, plot, styled
from railpatch.page.tables import short
from railpatch.report.data import SHOWN, Positions, scaled
from railpatch.report.figures import Adder
from railpatch.report.vehicle.data import VehicleRun

TEXT = (
    "Y and Q are on the {body}, Y outward; T\u03b3 is the sum of |Fx ξ|, |Fy η| and |M "
    "φ|. The traction coefficient is the creep force over the normal force, utilised friction "
    "the same over what friction could carry. Where they touch is the y of each profile in its "
    "own axes."
)
OF_WHEEL = {
    "wear_number": "wear number T\u03b3",
    "derailment_quotient": "Y/Q",
    "guiding_force": "guiding force Y",
    "wheel_load": "wheel load Q",
    "fluid_power": "power of the liquid's shear",
    "oxide_water": "water left in the paste",
}
# of each patch: name, component, label
OF_PATCH = (
    ("traction_coefficient", None, "traction coefficient"),
    ("utilised_friction", None, "utilised friction"),
    ("max_traction", None, "greatest traction"),
    ("contact_size", 0, "extent along x"),
    ("contact_size", 1, "extent across"),
    ("wheel_profile_position", 0, "y on the wheel's profile"),
    ("rail_profile_position", 0, "y on the {body}'s profile"),
    ("effective_friction", None, "friction with the liquid"),
    ("mean_asperity_share", None, "load on asperities"),
    ("central_film_thickness", None, "film"),
)
# of the rail where the wheel is, in vehicle runs over wet stretches
OF_RAIL = ("water_rate", "rail_work")
# shown in other units than others of their kind: factor from the log's, unit
OWN_UNIT = {
    "wear_number": (1.0, "N"),
    "central_film_thickness": (1e6, "µm"),
    "water_rate": (1e9, "µl/s"),
}
# of a vehicle's figure where they are known
WHERE_WET = (
    ("effective_friction", "friction with the liquid"),
    ("mean_asperity_share", "load on asperities"),
    ("central_film_thickness", "film [µm]"),
    ("fluid_power", "power of the liquid's shear [W]"),
    ("oxide_water", "water left in the paste"),
    ("water_rate", "water rate [µl/s]"),
    ("rail_work", "work of wheels ahead [J/m]"),
)
OF_WHEELSET = {
    "rolling_radius_difference": "rolling radius difference",
    "conicity": "radius difference over 2 y",
}
COLUMNS, HEIGHT = 2, 215


def section(data: Positions) -> list[str]:
    """HTML; nothing of logs without these numbers."""
    shown = figure(data)
    if shown is None:
        return []
    text = TEXT.format(body=data.counterpart)
    return [f"<h2>What engineers read</h2><p>{text}</p>", plot(shown, "quantities")]


def figure(data: Positions) -> go.Figure | None:
    """A panel for each quantity that the log has."""
    panels = [(name, None, text) for name, text in OF_WHEEL.items() if known(data, name)]
    panels += [
        (name, part, text.format(body=data.counterpart))
        for name, part, text in OF_PATCH
        if any(values_of(data.contact[side], name, part)[0].size for side in SIDES)
    ]
    panels += [(n, None, t) for n, t in OF_WHEELSET.items() if np.isfinite(data.state[n]).any()]
    if not panels:
        return None
    rows = -(-len(panels) // COLUMNS)
    shown = make_subplots(
        rows, COLUMNS, shared_xaxes=True, horizontal_spacing=0.12, vertical_spacing=0.24 / rows
    )
    for place, (name, part, text) in enumerate(panels):
        row, column = place // COLUMNS + 1, place % COLUMNS + 1
        if name in OF_WHEELSET:
            factor, label = scaled("/wheelset/state", name, text)
            Adder(shown, data, row, column).line(
                data.along, factor * data.state[name], text, GREY, legend=False
            )
        else:
            label = wheels(shown, data, name, part, text, (row, column))
        shown.update_yaxes(title_text=label, row=row, col=column)
    for column in range(1, COLUMNS + 1):
        last = rows - (column > len(panels) - COLUMNS * (rows - 1))
        shown.update_xaxes(title_text=data.along_label, showticklabels=True, row=last, col=column)
    return styled(shown, HEIGHT * rows)


def known(data: Positions, name: str) -> bool:
    """Whether a wheel has a number of this name."""
    return any(np.isfinite(data.contact[side][name]).any() for side in SIDES)


def wheels(
    shown: go.Figure,
    data: Positions,
    name: str,
    part: int | None,
    text: str,
    place: tuple[int, int],
) -> str:
    """Both wheels' lines, or points of their patches. Gives the axis label."""
    path = name if name in OF_WHEEL else f"patches[].{name}"
    # kN are too coarse for the wear number, by which laws of wear go, and mm for films
    if name in OWN_UNIT:
        factor, own = OWN_UNIT[name]
        label = f"{text} [{own}]"
    else:
        factor, label = scaled("/left/contact", path, text)
    for side in SIDES:
        add = Adder(shown, data, *place)
        if name in OF_WHEEL:
            add.line(data.along, factor * data.contact[side][name], side, COLORS[side])
        else:
            index, values = values_of(data.contact[side], name, part)
            add.dots(data.along[index], factor * values, side, COLORS[side])
    return label


def values_of(contact: Series, name: str, part: int | None) -> tuple[np.ndarray, np.ndarray]:
    """Index of the step and value of every patch. part: of a list."""
    index, values = [], []
    for number, message in enumerate(contact.messages):
        for patch in message["patches"]:
            value = patch.get(name)
            if part is not None:
                value = value[part] if value else None
            if value is not None:
                index.append(number)
                values.append(value)
    return np.array(index, dtype=int), np.array(values, dtype=float)


# --- of a vehicle: its wheels' courses, and greatest numbers beside them

VEHICLE_TEXT = (
    "Of each wheel, at the logged steps: wear number T\u03b3, |Fx ξ| + |Fy η| + |M φ|, "
    "of the patch that carries most the creep force over its normal force and over what friction "
    "could carry, and the y of the wheel's and of the rail's profile where that patch is; of each "
    "wheelset the difference of rolling radii. Q, Y/Q and the sum of Y stand above."
)


def vehicle_section(data: VehicleRun) -> list[str]:
    """HTML; nothing of logs without these numbers."""
    if not any(np.isfinite(contact["wear_number"]).any() for contact in data.contact.values()):
        return []
    return [
        f"<h2>Wear number, friction, places of contact</h2><p>{VEHICLE_TEXT}</p>",
        plot(vehicle_figure(data), "quantities"),
    ]


def vehicle_figure(data: VehicleRun) -> go.Figure:
    """Rows of quantities, left wheels beside right ones, a line for each wheelset."""
    rows: tuple[tuple[str, int | None, str], ...] = (
        ("wear_number", None, "T\u03b3 [N]"),
        ("traction_coefficient", None, "traction coefficient"),
        ("utilised_friction", None, "utilised friction"),
        ("wheel_profile_position", 0, "y on the wheel's profile [mm]"),
        ("rail_profile_position", 0, "y on the rail's profile [mm]"),
    )
    rows += tuple(
        (name, None, label)
        for name, label in WHERE_WET
        if any(np.isfinite(course(one, name, None)).any() for one in data.contact.values())
    )
    shown = make_subplots(
        len(rows) + 1,
        2,
        shared_xaxes=True,
        horizontal_spacing=0.1,
        vertical_spacing=0.05,
    )
    for row, (name, part, label) in enumerate(rows, start=1):
        for column, side in enumerate(SIDES, start=1):
            for number in data.wheelsets:
                line = course(data.contact[number, side], name, part)
                Adder(shown, data, row, column).line(
                    data.along, line, f"wheelset {number}", _color(number)
                )
            shown.update_yaxes(title_text=f"{side} wheels: {label}", row=row, col=column)
    for column, (name, text) in enumerate(OF_WHEELSET.items(), start=1):
        factor, label = scaled("/wheelset/1/state", name, text)
        for number, series in data.wheelsets.items():
            Adder(shown, data, len(rows) + 1, column).line(
                data.along, factor * series[name], f"wheelset {number}", _color(number)
            )
        shown.update_yaxes(title_text=label, row=len(rows) + 1, col=column)
    shown.update_xaxes(title_text=data.along_label, row=len(rows) + 1)
    return styled(shown, 230 * (len(rows) + 1))


def course(contact: Series, name: str, part: int | None) -> np.ndarray:
    """[n]: of the wheel, or of the patch that carries most; mm of lengths, µm of films."""
    if name in OF_WHEEL:
        return contact[name]
    if name in OF_RAIL:
        told = [message.get(name) for message in contact.messages]
        known = np.array([np.nan if value is None else value for value in told])
        return OWN_UNIT.get(name, (1.0, ""))[0] * known
    found = np.full(len(contact), np.nan)
    for index, message in enumerate(contact.messages):
        patches = [p for p in message.get("patches", []) if p.get("normal_force") is not None]
        if patches:
            value = max(patches, key=lambda p: p["normal_force"]).get(name)
            value = value[part] if value and part is not None else value
            found[index] = np.nan if value is None else value
    if part is not None:
        return SHOWN["m"][0] * found
    return OWN_UNIT.get(name, (1.0, ""))[0] * found


def greatest(contact: Series) -> list[str]:
    """Of a wheel's table: wear number (N), utilised friction, traction (MPa), extents (mm)."""
    size = [values_of(contact, "contact_size", part)[1] for part in (0, 1)]
    parts = (
        (contact["wear_number"], 1.0),
        (values_of(contact, "utilised_friction", None)[1], 1.0),
        (values_of(contact, "max_traction", None)[1], SHOWN["Pa"][0]),
    )
    found = [short(factor * most(values)) for values, factor in parts]
    return [*found, " x ".join(short(SHOWN["m"][0] * most(values)) for values in size)]


HEAD = ("T\u03b3 most [N]", "utilised friction most", "traction most [MPa]", "patch most [mm]")


def most(values: np.ndarray) -> float:
    """The greatest; NaN of none."""
    kept = values[np.isfinite(values)]
    return float(kept.max()) if kept.size else float("nan")


def _color(number: int) -> str:
    return LINES[(number - 1) % len(LINES)]
