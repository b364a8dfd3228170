"""The log of a vehicle on several wheelsets."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from os import PathLike
from typing import Any

from railpatch.case.types import SIDES
from railpatch.log.channels import channel, vehicle_channels
from railpatch.log.effective import Effective
from railpatch.log.encode import encode
from railpatch.log.stream import SCENE_RATE, Log, LogStream, Pace, checked_attachments
from railpatch.log.vehicle import scene as vehicle_scene
from railpatch.log.vehicle.geometry import VehicleGeometry
from railpatch.log.writer import snapshots


class VehicleLog(Log):
    """The log of a vehicle's run; use it in a ``with`` statement. Arguments as of RunLog.

    ``wheelsets``: their number.
    """

    def __init__(
        self,
        path: str | PathLike[str],
        *,
        wheelsets: int,
        case_text: str | bytes,
        case_name: str,
        profiles: Mapping[str, bytes] | None = None,
        geometry: VehicleGeometry | None = None,
        scene_rate: float = SCENE_RATE,
        ran_with: Effective | None = None,
    ) -> None:
        if not isinstance(wheelsets, int) or isinstance(wheelsets, bool) or wheelsets < 1:
            raise ValueError(f"wheelsets is {wheelsets!r}; it must be a whole number >= 1")
        if geometry is not None and not isinstance(geometry, VehicleGeometry):
            raise ValueError(f"geometry is {geometry!r}; it must be a VehicleGeometry")
        attachments = checked_attachments(case_text, case_name, profiles or {}, ran_with)
        self._count, self._pace = wheelsets, Pace(scene_rate)
        about = {"scene": case_name, "track_kind": "rail", "wheelsets": str(wheelsets)}
        about |= ran_with.about if ran_with else {}
        self.stream = LogStream(path, vehicle_channels(wheelsets), about, attachments)
        if geometry is not None:
            with self.stream.counted():
                shapes = vehicle_scene.bodies(geometry, wheelsets)
                self.stream.first("/scene/bodies", shapes)

    def write(
        self,
        time_s: float,
        *,
        state: Mapping[str, Any],
        wheelsets: Sequence[Mapping[str, Any]],
        bodies: Sequence[Mapping[str, Any]],
        tracks: Sequence[tuple[Sequence[float], Sequence[float]]] | None = None,
        energy: Mapping[str, Any] | None = None,
        stats: Mapping[str, Any] | None = None,
    ) -> None:
        """Logs one time step; the fields of each dict stand in channels.py.

        ``wheelsets``: of each, from the front, ``state``, ``left``, ``right`` and, for a snapshot,
        ``fields``, as for RunLog.write, and ``support`` where it has a track below. ``bodies``: a
        dict each; wheelset N is called "wheelset_N", and turns with the pitch of its state where
        that has one. ``tracks``: of each wheelset the origin (m) and the quaternion of its track
        axes, in start axes; without them no rails and patches are shown.

        Raises ValueError for a bad value, and logs nothing of this step then.
        """
        with self.stream.counted():
            time_ns = self.stream.checked_time(time_s)
            given = {"/vehicle/state": state, "/vehicle/bodies": {"bodies": list(bodies)}}
            beside = {
                "/vehicle/energy": energy,
                "/solver/stats": stats,
            }
            given |= {topic: values for topic, values in beside.items() if values is not None}
            messages: dict[str, Any] = {}
            self._check_number("wheelsets", wheelsets)
            for number, wheelset in enumerate(wheelsets, start=1):
                above = f"/wheelset/{number}"
                given[f"{above}/state"] = wheelset["state"]
                for side in SIDES:
                    given[f"{above}/{side}/contact"] = wheelset[side]
                if "support" in wheelset:
                    given[f"{above}/support"] = wheelset["support"]
                messages |= snapshots(wheelset.get("fields") or {}, above)
            for topic, values in given.items():
                messages[topic] = encode(channel(topic).message, values, topic)
            if tracks is not None:
                self._check_number("tracks", tracks)
            if self._pace.due(time_s):
                messages["/tf"] = vehicle_scene.transforms(wheelsets, bodies, tracks, time_ns)
                if tracks is not None:
                    messages["/scene/contact"] = vehicle_scene.contact(wheelsets, time_ns)
            self.stream.add(messages, time_ns)

    def write_comfort(self, time_s: float, values: Mapping[str, Any]) -> None:
        """Continuous comfort of the 5 s that end at a time; fields stand in channels.py. Times may
        lie before the last step written. Raises ValueError for a bad value."""
        self._write_beside("/vehicle/comfort", time_s, values)

    def write_assessment(self, time_s: float, values: Mapping[str, Any]) -> None:
        """Percentiles and mean comfort of the whole run, likewise."""
        self._write_beside("/vehicle/assessment", time_s, values)

    def write_wear(self, time_s: float, wear: Mapping[tuple[int, str], Mapping[str, Any]]) -> None:
        """Of the whole run, by number of the wheelset and side, likewise."""
        for (number, side), values in wear.items():
            self._write_beside(f"/wheelset/{number}/{side}/wear", time_s, values)

    def _write_beside(self, topic: str, time_s: float, values: Mapping[str, Any]) -> None:
        with self.stream.counted():
            message = encode(channel(topic).message, values, topic)
            self.stream.beside({topic: message}, round(1e9 * time_s))

    def _check_number(self, name: str, values: Sequence[Any]) -> None:
        if len(values) != self._count:
            raise ValueError(f"{name} has {len(values)} entries; it must have {self._count}")
