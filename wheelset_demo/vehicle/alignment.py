"""Where the track is: centre line in plan, cant, and the track frame at an arc length.

The centre line lies in the plane z = 0 of the world (x forward at the start, y right, z down): a
straight, a transition, a circular arc, a transition, a straight, or the sections of a list, see
sections.py. On a transition curvature and cant follow Bloss (3 u^2 - 2 u^3, u from 0 to 1), whose
slopes are zero at both ends, so that wheels at 300 km/h are not thrown up by a corner. The track
frame at arc length s: x along the
centre line, turned from the world's axes by the heading about z, then by the cant angle about x:
in a right-hand curve (curvature > 0) the left rail is the higher one. Cant turns about the centre
line.
"""

from __future__ import annotations

import math
from typing import Annotated

import numpy as np
import scipy
from numpy.typing import ArrayLike, NDArray
from pydantic import Field, model_validator
from railpatch.case.types import Number, Positive, Table, relation

from wheelset_demo.vehicle.sections import CANT_BASE, SectionTable, Sequence, check_sections

Vector = NDArray[np.float64]
# m, between the nodes at which the centre line is kept: splines between them are off by 1e-9 m
SPACING = 1.0
# Gauss-Legendre points of the way from node to node
POINTS, WEIGHTS = np.polynomial.legendre.leggauss(4)
# from centimetres away: the second leaves some 1e-12 m
NEWTON_STEPS = 2


class AlignmentTable(Table):
    """The track in plan and its cant; a track without radius is straight."""

    straight: Annotated[float, Field(ge=0, le=1e6)] = Field(
        default=0.0, description="m, before the first transition"
    )
    transition: Annotated[float, Field(gt=0, le=1e5)] = Field(
        default=100.0, description="m, length of each transition (Bloss)"
    )
    arc: Annotated[float, Field(ge=0, le=1e6)] = Field(
        default=1e6, description="m, length of the circular arc"
    )
    radius: Number | None = Field(
        default=None, description="m, of the arc, a right-hand curve > 0; left out: straight track"
    )
    cant: Annotated[float, Field(ge=-0.3, le=0.3)] = Field(
        default=0.0, description="m, in the arc, of the outer rail above the inner one"
    )

    section: Annotated[list[SectionTable], Field(min_length=1, max_length=1000)] | None = Field(
        default=None,
        description="sections one after the other, in place of the other keys; left out: one curve",
    )

    @model_validator(mode="after")
    def _possible(self) -> AlignmentTable:
        if self.section is not None:
            for name in ("straight", "transition", "arc", "radius", "cant"):
                if name in self.model_fields_set:
                    raise relation(name, getattr(self, name), "to be left out beside 'section'")
            check_sections(self.section)
        if self.radius is not None and abs(self.radius) < 100:
            raise relation("radius", self.radius, "at least 100 m to either side")
        if self.radius is None and self.cant != 0:
            raise relation("cant", self.cant, "0 without a radius")
        return self

    @property
    def start(self) -> tuple[str, float]:
        """Key and length (m) of the straight that the first curve follows; none: infinite."""
        if self.section is None:
            return "straight", math.inf if self.radius is None else self.straight
        length = 0.0
        for section in self.section:
            if section.kind != "straight":
                return "section[0].length", length
            length += section.length
        return "section[0].length", math.inf


class Curve:
    """Curvature, cant and heading of one curve, by arc length (m) from the start."""

    def __init__(self, table: AlignmentTable) -> None:
        self._table = table
        self._curvature = 0.0 if table.radius is None else 1.0 / table.radius
        self._cant = math.copysign(1.0, self._curvature) * math.asin(table.cant / CANT_BASE)
        a = table.straight
        b = a + table.transition
        c = b + table.arc
        self._corners = np.array([a, b, c, c + table.transition])

    def curvature(self, s: Vector) -> Vector:
        """1/m."""
        return self._curvature * self._share(s)

    def cant_angle(self, s: Vector) -> Vector:
        """rad."""
        return self._cant * self._share(s)

    def heading(self, s: Vector) -> Vector:
        """rad."""
        a, b, c, _ = self._corners
        length = self._table.transition
        u = np.clip((s - a) / length, 0.0, 1.0)
        w = np.clip((s - c) / length, 0.0, 1.0)
        rising = length * (u**3 - 0.5 * u**4)
        falling = length * (w - w**3 + 0.5 * w**4)
        return self._curvature * (rising + np.clip(s - b, 0.0, c - b) + falling)

    def cant_rates(self, s: Vector) -> tuple[Vector, Vector]:
        """1/m, 1/m^2, first and second derivative of the cant angle."""
        slope, bend = self._rates_of_share(s)
        return self._cant * slope, self._cant * bend

    def _share(self, s: Vector) -> Vector:
        """-, of curvature and cant of the arc."""
        a, _, c, _ = self._corners
        length = self._table.transition
        u = np.clip((s - a) / length, 0.0, 1.0)
        w = np.clip((s - c) / length, 0.0, 1.0)
        return u * u * (3.0 - 2.0 * u) - w * w * (3.0 - 2.0 * w)

    def _rates_of_share(self, s: Vector) -> tuple[Vector, Vector]:
        """1/m, 1/m^2, first and second derivative of _share."""
        a, _, c, _ = self._corners
        length = self._table.transition
        slope, bend = np.zeros_like(s), np.zeros_like(s)
        for sign, u in ((1.0, (s - a) / length), (-1.0, (s - c) / length)):
            inside = sign * ((u > 0) & (u < 1))
            slope += inside * 6.0 * u * (1.0 - u) / length
            bend += inside * (6.0 - 12.0 * u) / length**2
        return slope, bend


class Alignment:
    """The track frame along the track. length: m, to which it is asked for."""

    def __init__(self, table: AlignmentTable, length: Positive) -> None:
        sections = table.section
        self._plan: Curve | Sequence = Curve(table) if sections is None else Sequence(sections)
        nodes = SPACING * np.arange(-1, math.ceil(length / SPACING) + 2)
        steps = self._way(nodes[:-1], np.full(len(nodes) - 1, SPACING))
        places = np.vstack([np.zeros(2), np.cumsum(steps, axis=0)])
        # the start is at the origin: one node lies before it
        self._spline = scipy.interpolate.CubicSpline(
            nodes, np.hstack([places - places[1], self._angles(nodes)])
        )

    @property
    def pieces(self) -> tuple[Vector, Vector]:
        """Arc lengths [n] (m) and coefficients [4, n - 1, 7], as scipy's, of x, y (m), heading,
        cant angle, curvature, first and second derivative of the cant angle."""
        return self._spline.x, np.ascontiguousarray(self._spline.c)

    def _angles(self, s: Vector) -> Vector:
        """[n, 5]: heading, cant angle, curvature, cant angle's derivatives, first and second."""
        heading, cant, curvature = self.heading(s), self.cant_angle(s), self.curvature(s)
        slope, bend = self._plan.cant_rates(s)
        return np.stack([heading, cant, curvature, slope, bend], axis=1)

    def curvature(self, s: ArrayLike) -> Vector:
        """1/m, at arc lengths (m)."""
        return self._plan.curvature(np.asarray(s, dtype=float))

    def cant_angle(self, s: ArrayLike) -> Vector:
        """rad, at arc lengths (m)."""
        return self._plan.cant_angle(np.asarray(s, dtype=float))

    def heading(self, s: ArrayLike) -> Vector:
        """rad, about z, at arc lengths (m)."""
        return self._plan.heading(np.asarray(s, dtype=float))

    def frames(self, s: Vector) -> tuple[Vector, Vector]:
        """Of the track in the world at arc lengths [n]: rotations [n, 3, 3], origins (m) [n, 3]."""
        rotations, origins, _ = self.frames_and_bends(s)
        return rotations, origins

    def frames_and_bends(self, s: Vector) -> tuple[Vector, Vector, Vector]:
        """The same, and [n, 4]: cant angle (rad), curvature (1/m), first and second derivative of
        the cant angle (1/m, 1/m^2)."""
        found = self._spline(s)
        (c, cc), (t, sc) = np.cos(found[:, 2:4].T), np.sin(found[:, 2:4].T)
        rotations = np.zeros((len(s), 3, 3))
        rotations[:, 0, 0], rotations[:, 1, 0] = c, t
        rotations[:, 0, 1], rotations[:, 1, 1], rotations[:, 2, 1] = -t * cc, c * cc, sc
        rotations[:, 0, 2], rotations[:, 1, 2], rotations[:, 2, 2] = t * sc, -c * sc, cc
        origins = np.zeros((len(s), 3))
        origins[:, :2] = found[:, :2]
        return rotations, origins, found[:, 3:]

    def foot(self, places: Vector, near: Vector) -> Vector:
        """m, [n]: arc lengths at whose frames x = 0 for places [n, 3] (m) in the world.

        near: [n], within some metres. Newton's method; x does not depend on the cant.
        """
        s = near
        for _ in range(NEWTON_STEPS):
            found = self._spline(s)
            along, across = np.cos(found[:, 2]), np.sin(found[:, 2])
            away = places[:, :2] - found[:, :2]
            # the frame turns on by its curvature: less than a metre matters
            s = s + along * away[:, 0] + across * away[:, 1]
        return s

    def _way(self, start: Vector, length: Vector) -> Vector:
        """m, [n, 2], from places at arc lengths ``start`` over ``length``."""
        s = start[:, None] + 0.5 * length[:, None] * (1.0 + POINTS)
        heading = self.heading(s)
        half = 0.5 * length
        return np.stack([half * (np.cos(heading) @ WEIGHTS), half * (np.sin(heading) @ WEIGHTS)], 1)
