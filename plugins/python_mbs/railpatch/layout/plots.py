"""What the viewers' layout plots: topics and fields of the log's table."""

from __future__ import annotations

from dataclasses import dataclass

from railpatch.case.types import SIDES
from railpatch.log.channels import unit

KINDS = ("rail", "roller", "vehicle")
_AXES = "xyz"


@dataclass(frozen=True)
class Curve:
    """One curve of a plot.

    topic: of the log. field: as viewers write it, with indices ("patches[0].creepage[1]"). name: in
    the legend; unit: of the table. Raises KeyError where the table has no such field.
    """

    topic: str
    field: str
    name: str

    def __post_init__(self) -> None:
        _ = self.unit

    @property
    def unit(self) -> str:
        """Of the table."""
        parts = []
        for part in self.field.split("."):
            head, bracket, _ = part.partition("[")
            parts.append((head, bool(bracket)))
        # a list of messages is written with brackets in the table, a list of numbers without
        last = parts.pop()[0]
        path = "".join(f"{head}{'[]' if listed else ''}." for head, listed in parts) + last
        found = unit(self.topic, path)
        # of a list whose numbers have units of their own: that of the one that is shown
        each = found.split(", ")
        return found if len(each) == 1 else each[int(self.field.rpartition("[")[2].rstrip("]"))]

    @property
    def path(self) -> str:
        """Of the message, as viewers write it."""
        return f"{self.topic}.{self.field}"

    @property
    def label(self) -> str:
        """Name and unit."""
        return self.name if self.unit == "-" else f"{self.name} [{self.unit}]"


@dataclass(frozen=True)
class Tab:
    """Plots, by their titles, that are shown together."""

    title: str
    plots: dict[str, list[Curve]]


def tabs_of(kind: str, wheelsets: int) -> list[Tab]:
    """All plots of a kind of run."""
    if kind == "vehicle":
        return _vehicle(wheelsets)
    rest = [_forces(), _contact()]
    if kind == "roller":
        return [_motion(rates=False), *rest, _balance(), _work()]
    return [_motion(), *rest, _energies("/wheelset"), _momenta(), _work()]


def _vectors(topic: str, field: str, name: str, count: int = 3) -> list[Curve]:
    return [Curve(topic, f"{field}[{k}]", f"{name} {_AXES[k]}") for k in range(count)]


def _both(field: str, name: str) -> list[Curve]:
    """Of the left and the right wheel."""
    return [Curve(f"/{side}/contact", field, f"{side} {name}") for side in SIDES]


def _motion(rates: bool = True) -> Tab:
    """rates: of positions that follow each other in time; a rig's are at rest."""
    state = "/wheelset/state"
    plots = {
        "position": [Curve(state, "y", "y"), Curve(state, "z", "z")],
        "angles": [Curve(state, "yaw", "yaw"), Curve(state, "roll", "roll")],
    }
    if rates:
        plots["lateral speed"] = [Curve(state, "vy", "vy")]
        plots["yaw rate"] = [Curve(state, "yaw_rate", "yaw rate")]
    return Tab("Motion", plots)


def _forces() -> Tab:
    return Tab(
        "Forces",
        {
            "vertical forces on the wheels": _both("force[2]", "Fz"),
            "lateral forces on the wheels": _both("force[1]", "Fy"),
            "longitudinal forces on the wheels": _both("force[0]", "Fx"),
        },
    )


def _contact() -> Tab:
    creepage = [*_both("patches[0].creepage[0]", "x"), *_both("patches[0].creepage[1]", "y")]
    return Tab(
        "Contact",
        {
            "creepages of the first patch": creepage,
            "spin creepage": _both("patches[0].spin_creepage", "spin"),
            "highest pressure": _both("patches[0].max_pressure", "pressure"),
            "elements that slip": _both("patches[0].elements.slip", "slip"),
        },
    )


def _balance() -> Tab:
    topic = "/rig/balance"
    return Tab(
        "Balance",
        {
            "open moments": [
                Curve(topic, "residuals[0]", "about the axle"),
                Curve(topic, "residuals[2]", "roll"),
            ],
            "open force": [Curve(topic, "residuals[1]", "vertical")],
            "evaluations": [Curve(topic, "evaluations", "evaluations")],
        },
    )


def _energies(above: str) -> Tab:
    topic = f"{above}/energy"
    works = ("friction_work", "damping_work", "drive_work")
    open_parts = ("mechanical_residual", "contact_residual")
    return Tab(
        "Energy",
        {
            "work since the start": [Curve(topic, f, f.replace("_", " ")) for f in works],
            "stored": [Curve(topic, f, f) for f in ("suspension", "elastic")],
            "open in the balance": [Curve(topic, f, f.replace("_", " ")) for f in open_parts],
        },
    )


def _momenta() -> Tab:
    topic = "/wheelset/momentum"
    return Tab(
        "Momentum",
        {
            "momentum": _vectors(topic, "momentum", "momentum"),
            "open in the balance": _vectors(topic, "residual", "momentum"),
            "about the centre, open": _vectors(topic, "turning_residual", "about"),
        },
    )


def _work() -> Tab:
    topic = "/solver/stats"
    return Tab(
        "Solver",
        {
            "wall time": [Curve(topic, "wall_time", "wall time")],
            "contacts solved": [Curve(topic, "contact_evaluations", "contacts")],
        },
    )


def _vehicle(wheelsets: int) -> list[Tab]:
    numbers = range(1, wheelsets + 1)

    # by side: eight curves in one plot are more than a viewer has colours for
    def wheels(title: str, field: str, name: str) -> dict[str, list[Curve]]:
        return {
            f"{title}, {side}": [
                Curve(f"/wheelset/{n}/{side}/contact", field, f"{n} {name}") for n in numbers
            ]
            for side in SIDES
        }

    def axles(field: str, name: str) -> list[Curve]:
        return [Curve(f"/wheelset/{n}/state", field, f"{n} {name}") for n in numbers]

    state, bodies = "/vehicle/state", "/vehicle/bodies"
    body = "bodies[0]."
    return [
        Tab(
            "Vehicle",
            {
                "wheelsets beside the centre line": axles("y", "y"),
                "car body, lateral": [Curve(bodies, f"{body}acceleration[1]", "ay")],
                "car body, vertical": [Curve(bodies, f"{body}acceleration[2]", "az")],
                "curvature of the track": [Curve(state, "curvature", "curvature")],
            },
        ),
        Tab(
            "Forces",
            {
                **wheels("vertical forces", "force[2]", "Fz"),
                **wheels("lateral forces", "force[1]", "Fy"),
            },
        ),
        Tab(
            "Contact",
            {
                **wheels("longitudinal creepages", "patches[0].creepage[0]", "x"),
                **wheels("lateral creepages", "patches[0].creepage[1]", "y"),
                "angles of attack": axles("yaw", "yaw"),
            },
        ),
        Tab(
            "Track",
            {
                "cant": [Curve(state, "cant", "cant")],
                "left rail of the first wheelset": [
                    Curve("/wheelset/1/state", f"left_rail[{k}]", name)
                    for k, name in enumerate(("lateral", "vertical"))
                ],
                "right rail of the first wheelset": [
                    Curve("/wheelset/1/state", f"right_rail[{k}]", name)
                    for k, name in enumerate(("lateral", "vertical"))
                ],
            },
        ),
        _energies("/vehicle"),
        _work(),
    ]
