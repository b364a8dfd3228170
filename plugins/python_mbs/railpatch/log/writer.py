"""Writes the run log: MCAP with protobuf messages, attachments first.

A killed run keeps what was written: the writer finishes the chunk in progress and flushes the file
at most ``FLUSH_INTERVAL`` seconds of wall clock after a message went in, from ``write`` itself or
from a thread while the caller computes (the solver releases the GIL). There is no fsync: this
guards against the end of the process, not of the machine.
"""

from __future__ import annotations

import math
import mimetypes
import numbers
import threading
import time
from collections.abc import Mapping, Sequence
from importlib.metadata import PackageNotFoundError, version
from os import PathLike
from pathlib import Path
from typing import Any

from foxglove_schemas_protobuf.FrameTransforms_pb2 import FrameTransforms
from foxglove_schemas_protobuf.SceneUpdate_pb2 import SceneUpdate
from mcap.well_known import MessageEncoding, SchemaEncoding
from mcap.writer import Writer
from mcap_protobuf.schema import register_schema

from . import scene
from .channels import CHANNELS, CONVENTIONS, SIDES, WELL_KNOWN, Channel, channel, flat_fields, note
from .encode import encode, encode_fields
from .geometry import SceneGeometry
from .schema import PACKAGE, schema_data

# what a run may leave out
OPTIONAL = ("/rig/balance", "/wheelset/energy", "/solver/stats")
FLUSH_INTERVAL = 0.25  # s, wall clock
CASE_MEDIA_TYPE = "application/toml"
PROFILE_MEDIA_TYPE = "text/plain"
_LAST_TIME = 2**63 - 1  # ns; beyond, some readers' signed times overflow


class RunLog:
    """The log of one run; use it in a ``with`` statement.

    ``path`` is overwritten. ``case_text`` is the case file as it was read (str or bytes),
    ``case_name`` its file name and the scene's name; ``profiles`` holds the profile files' bytes by
    name. All of them are attached before the first message. ``geometry`` is for the 3D scene;
    without it only patches and forces are shown.

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
    ) -> None:
        attachments = _checked_attachments(case_text, case_name, profiles or {})
        if geometry is not None and not isinstance(geometry, SceneGeometry):
            raise ValueError(f"geometry is {geometry!r}; it must be a SceneGeometry")
        first_scene = scene.bodies(geometry) if geometry else None
        self.path = Path(path)
        self._geometry = geometry
        self._last_ns = -1
        self._lock = threading.Lock()
        self._dirty = False
        self._flushed_at = time.monotonic()
        self._stop = threading.Event()
        self._stream = open(self.path, "wb")  # noqa: SIM115 - closed by close()
        self._writer = Writer(self._stream)
        self._writer.start(library=f"railpatch {railpatch_version()}")
        for name, media_type, data in attachments:
            self._writer.add_attachment(0, 0, name, media_type, data)
        self._describe(case_name)
        self._channels = self._register()
        if first_scene is not None:
            self._add("/scene/bodies", first_scene, 0)
        self._writer.flush()
        self._thread = threading.Thread(target=self._keep_flushed, daemon=True)
        self._thread.start()

    def write(
        self,
        time_s: float,
        *,
        state: Mapping[str, Any],
        left: Mapping[str, Any],
        right: Mapping[str, Any],
        balance: Mapping[str, Any] | None = None,
        stats: Mapping[str, Any] | None = None,
        energy: Mapping[str, Any] | None = None,
        fields: Mapping[str, Sequence[Mapping[str, Any]]] | None = None,
    ) -> None:
        """Logs one position or time step; the fields of each dict stand in channels.py.

        ``time_s``: s of simulation time, later than the last. ``left``, ``right``: these parts of a
        wheelset result's ``to_dict()``. ``fields``: by side, patches with their fields (those of
        the same ``to_dict()`` will do), to log a snapshot.

        Raises ValueError for a bad value, and logs nothing of this step then.
        """
        if self._stream.closed:
            raise ValueError(f"{self.path}: the run log is closed")
        time_ns = self._checked_time(time_s)
        messages = _encoded(state, left, right, balance, stats, energy, fields or {})
        messages["/tf"] = scene.transforms(state, self._geometry, time_ns)
        messages["/scene/contact"] = scene.contact({"left": left, "right": right}, time_ns)
        with self._lock:
            for topic, message in messages.items():
                self._add(topic, message, time_ns)
            self._last_ns = time_ns
            self._dirty = True
            if time.monotonic() - self._flushed_at >= FLUSH_INTERVAL:
                self._flush()

    def close(self, stopped_by: str = "") -> None:
        """Writes the index and closes the file; a second call does nothing.

        ``stopped_by`` names what ended the run before its end; the log then says so.
        """
        if self._stream.closed:
            return
        self._stop.set()
        self._thread.join()
        with self._stream:
            self._writer.add_metadata(f"{PACKAGE}.end", {"stopped_by": stopped_by})
            self._writer.finish()

    def __enter__(self) -> RunLog:
        return self

    def __exit__(self, kind: type[BaseException] | None, *error: object) -> None:
        self.close(kind.__name__ if kind else "")

    def _add(self, topic: str, message: Any, time_ns: int) -> None:
        self._writer.add_message(
            self._channels[topic], time_ns, message.SerializeToString(), time_ns
        )

    def _flush(self) -> None:
        self._writer.flush()
        self._dirty = False
        self._flushed_at = time.monotonic()

    def _keep_flushed(self) -> None:
        while not self._stop.wait(FLUSH_INTERVAL):
            with self._lock:
                if self._dirty:
                    self._flush()

    def _checked_time(self, time_s: float) -> int:
        if isinstance(time_s, bool) or not isinstance(time_s, numbers.Real):
            raise ValueError(f"time_s is {time_s!r}; it must be a number (s)")
        if not math.isfinite(time_s) or time_s < 0 or time_s * 1e9 > _LAST_TIME:
            raise ValueError(f"time_s is {time_s!r}; it must be finite and >= 0 (s)")
        time_ns = round(time_s * 1e9)
        if time_ns <= self._last_ns:
            raise ValueError(
                f"time_s is {time_s!r}; it must be later than the last step's "
                f"{self._last_ns / 1e9} s"
            )
        return time_ns

    def _describe(self, case_name: str) -> None:
        self._writer.add_metadata(
            PACKAGE,
            {
                "version": railpatch_version(),
                "scene": case_name,
                "track_kind": self._geometry.kind if self._geometry else "",
            }
            | CONVENTIONS,
        )
        self._writer.add_metadata(
            f"{PACKAGE}.channels",
            {
                f"{entry.topic}.{path}": note(field)
                for entry in CHANNELS
                for path, field in flat_fields(entry.message)
            },
        )

    def _register(self) -> dict[str, int]:
        ids = {}
        schemas: dict[str, int] = {}
        for entry in CHANNELS:
            name = f"{PACKAGE}.{entry.message.name}"
            if name not in schemas:
                schemas[name] = self._writer.register_schema(
                    name, SchemaEncoding.Protobuf, schema_data(entry.message)
                )
            ids[entry.topic] = self._writer.register_channel(
                entry.topic, MessageEncoding.Protobuf, schemas[name], _channel_metadata(entry)
            )
        classes = {"foxglove.FrameTransforms": FrameTransforms, "foxglove.SceneUpdate": SceneUpdate}
        for topic, (name, text) in WELL_KNOWN.items():
            if name not in schemas:
                schemas[name] = register_schema(self._writer, classes[name])
            ids[topic] = self._writer.register_channel(
                topic, MessageEncoding.Protobuf, schemas[name], {"description": text}
            )
        return ids


def railpatch_version() -> str:
    """The installed version, or "unknown" in a checkout that is not installed."""
    try:
        return version("railpatch")
    except PackageNotFoundError:
        return "unknown"


def _encoded(
    state: Any,
    left: Any,
    right: Any,
    balance: Any,
    stats: Any,
    energy: Any,
    fields: Mapping[str, Sequence[Mapping[str, Any]]],
) -> dict[str, Any]:
    """The messages of one step by topic, all checked before any is written."""
    given = {
        "/wheelset/state": state,
        "/left/contact": left,
        "/right/contact": right,
        "/rig/balance": balance,
        "/wheelset/energy": energy,
        "/solver/stats": stats,
    }
    messages = {
        topic: encode(channel(topic).message, values, topic)
        for topic, values in given.items()
        if values is not None or topic not in OPTIONAL
    }
    for side in fields:
        if side not in SIDES:
            raise ValueError(f"fields: {side!r} is not a side; the sides are {', '.join(SIDES)}")
        topic = f"/{side}/fields"
        snapshot = encode_fields(fields[side], topic)
        if snapshot is not None:
            messages[topic] = snapshot
    return messages


def _channel_metadata(entry: Channel) -> dict[str, str]:
    """Description of a channel, and for each field its unit, frame and meaning."""
    metadata = {"description": entry.text}
    for path, field in flat_fields(entry.message):
        metadata[f"{path}.unit"] = field.unit
        metadata[f"{path}.frame"] = field.frame
        metadata[f"{path}.description"] = field.text
    return metadata


def _checked_attachments(
    case_text: str | bytes, case_name: str, profiles: Mapping[str, bytes]
) -> list[tuple[str, str, bytes]]:
    """Name, media type and bytes of every attachment."""
    if not isinstance(case_name, str) or not case_name:
        raise ValueError(f"case_name is {case_name!r}; it must be a text that is not empty")
    if not isinstance(case_text, (str, bytes)):
        raise ValueError(f"case_text is of type {type(case_text).__name__}; it must be text")
    data = case_text.encode() if isinstance(case_text, str) else case_text
    attachments = [(case_name, CASE_MEDIA_TYPE, data)]
    for name, content in profiles.items():
        if not isinstance(name, str) or not name or name == case_name:
            raise ValueError(f"profiles: {name!r} is not a name of its own")
        if not isinstance(content, bytes):
            raise ValueError(
                f"profiles: {name} is of type {type(content).__name__}; it must be the file's bytes"
            )
        attachments.append((name, mimetypes.guess_type(name)[0] or PROFILE_MEDIA_TYPE, content))
    return attachments
