"""Shapes for the 3D scene of a vehicle."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np

from railpatch.log.geometry import SceneGeometry

# bodies' cuboids: centre and size (m) in the body's axes
Boxes = Sequence[tuple[Sequence[float], Sequence[float]]]


@dataclass(frozen=True)
class VehicleGeometry:
    """What the 3D scene of a vehicle shows.

    ``wheelset``: profiles of its wheels and rails. ``boxes``: cuboids by the name of a body, others
    are not drawn. ``own``: by a wheelset's number, of those with other profiles. ``centre_line``:
    m, [n, 3], of the track in start axes; left out: no line. Raises ValueError where a value has
    the wrong shape.
    """

    wheelset: SceneGeometry
    boxes: Mapping[str, Boxes]
    centre_line: np.ndarray | None = None
    own: Mapping[int, SceneGeometry] = field(default_factory=dict)

    def __post_init__(self) -> None:
        for one in (self.wheelset, *self.own.values()):
            if not isinstance(one, SceneGeometry) or one.kind != "rail":
                raise ValueError("geometry: wheelset must be a SceneGeometry of kind 'rail'")
        for name, boxes in self.boxes.items():
            for box in boxes:
                if [len(part) for part in box] != [3, 3] or not np.isfinite(box).all():
                    raise ValueError(
                        f"geometry: boxes[{name!r}] has {box!r}; it must be centre and size, m"
                    )
        line = self.centre_line
        if line is not None and (np.ndim(line) != 2 or np.shape(line)[1] != 3 or len(line) < 2):
            raise ValueError(f"geometry: centre_line has shape {np.shape(line)}; must be (n, 3)")
