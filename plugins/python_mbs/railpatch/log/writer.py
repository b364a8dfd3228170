"""The log of a run of one wheelset, on track or on the roller rig."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from os import PathLike
from typing import Any

from railpatch.case.types import SIDES
from railpatch.log import scene
from railpatch.log.channels import CHANNELS, channel
from railpatch.log.effective import Effective
from railpatch.log.encode import encode, encode_fields
from railpatch.log.geometry import SceneGeometry
from railpatch.log.stream import SCENE_RATE, Log, LogStream, Pace, checked_attachments

# what a run may leave out
OPTIONAL = (
    "/rig/balance",
    "/rig/measured",
    "/rig/frame",
    "/left/conditioning",
    "/right/conditioning",
    "/wheelset/energy",
    "/wheelset/momentum",
    "/solver/stats",
)


class RunLog(Log):
    """The log of one run; use it in a ``with`` statement.

    ``path`` is overwritten. ``case_text`` is the case file as it was read (str or bytes),
    ``case_name`` its file name and the scene's name; ``profiles`` holds the profile files' bytes by
    name. All of them are attached before the first message. ``geometry`` is for the 3D scene;
    without it only patches and forces are shown. ``scene_rate``: Hz, scenes a second of simulation
    time at most, 0: none. ``ran_with``: the tables as they ran, where options have replaced some of
    the case file's.

    Raises ValueError for a bad argument, before any file is made, and OSError where ``path`` cannot
    be written.
    """

    def __init__(
        self,
        path: str | PathLike[str],
        *,
        case_text: str | bytes,
        case_name: str,
        profiles: Mapping[str, bytes] | None = None,
        geometry: SceneGeometry | None = None,
        scene_rate: float = SCENE_RATE,
        ran_with: Effective | None = None,
    ) -> None:
        attachments = checked_attachments(case_text, case_name, profiles or {}, ran_with)
        if geometry is not None and not isinstance(geometry, SceneGeometry):
            raise ValueError(f"geometry is {geometry!r}; it must be a SceneGeometry")
        self._pace = Pace(scene_rate)
        self._geometry = geometry
        about = {"scene": case_name, "track_kind": geometry.kind if geometry else ""}
        about |= ran_with.about if ran_with else {}
        self.stream = LogStream(path, CHANNELS, about, attachments)
        if geometry:
            with self.stream.counted():
                self.stream.first("/scene/bodies", scene.bodies(geometry))

    def write(
        self,
        time_s: float,
        *,
        state: Mapping[str, Any],
        left: Mapping[str, Any],
        right: Mapping[str, Any],
        balance: Mapping[str, Any] | None = None,
        measured: Mapping[str, Any] | None = None,
        frame: Mapping[str, Any] | None = None,
        conditioning: Mapping[str, Mapping[str, Any]] | None = None,
        stats: Mapping[str, Any] | None = None,
        energy: Mapping[str, Any] | None = None,
        momentum: Mapping[str, Any] | None = None,
        fields: Mapping[str, Sequence[Mapping[str, Any]]] | None = None,
    ) -> None:
        """Logs one position or time step; the fields of each dict stand in channels.py.

        ``time_s``: s of simulation time, later than the last. ``left``, ``right``: these parts of a
        wheelset result's ``to_dict()``. ``fields``: by side, patches with their fields (those of
        the same ``to_dict()`` will do), to log a snapshot. ``conditioning``: by side.

        Raises ValueError for a bad value, and logs nothing of this step then.
        """
        given = {
            "/wheelset/state": state,
            "/left/contact": left,
            "/right/contact": right,
            "/rig/balance": balance,
            "/rig/measured": measured,
            "/rig/frame": frame,
            **{f"/{side}/conditioning": (conditioning or {}).get(side) for side in SIDES},
            "/wheelset/energy": energy,
            "/wheelset/momentum": momentum,
            "/solver/stats": stats,
        }
        with self.stream.counted():
            time_ns = self.stream.checked_time(time_s)
            messages = {
                topic: encode(channel(topic).message, values, topic)
                for topic, values in given.items()
                if values is not None or topic not in OPTIONAL
            }
            messages |= snapshots(fields or {})
            if self._pace.due(time_s):
                messages["/tf"] = scene.transforms(state, self._geometry, time_ns)
                sides = {"left": left, "right": right}
                messages["/scene/contact"] = scene.contact(sides, time_ns)
            self.stream.add(messages, time_ns)

    def write_wear(self, time_s: float, wear: Mapping[str, Mapping[str, Any]]) -> None:
        """What the whole run has worn off, by side; once, at its end. Raises ValueError for a bad
        value."""
        with self.stream.counted():
            messages = {
                f"/{side}/wear": encode(channel(f"/{side}/wear").message, values, f"/{side}/wear")
                for side, values in wear.items()
            }
            self.stream.beside(messages, round(1e9 * time_s))


def snapshots(fields: Mapping[str, Sequence[Mapping[str, Any]]], above: str = "") -> dict[str, Any]:
    """The fields' messages of a wheelset by topic. above: topic that its sides' are below."""
    messages = {}
    for side in fields:
        if side not in SIDES:
            raise ValueError(f"fields: {side!r} is not a side; the sides are {', '.join(SIDES)}")
        topic = f"{above}/{side}/fields"
        snapshot = encode_fields(fields[side], topic)
        if snapshot is not None:
            messages[topic] = snapshot
    return messages
