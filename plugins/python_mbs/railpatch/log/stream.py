"""The MCAP file of a log: attachments first, then messages; flushed while the run goes on.

A killed run keeps what was written: the writer finishes the chunk in progress and flushes the file
at most ``FLUSH_INTERVAL`` seconds of wall clock after a message went in, from ``add`` itself or
from a thread while the caller computes (the solver releases the GIL). There is no fsync: this
guards against the end of the process, not of the machine.
"""

from __future__ import annotations

import io
import math
import mimetypes
import numbers
import threading
import time
from collections.abc import Mapping
from contextlib import AbstractContextManager
from functools import cache
from importlib.metadata import PackageNotFoundError, version
from os import PathLike
from pathlib import Path
from typing import Any, TypeVar

from foxglove_schemas_protobuf.FrameTransforms_pb2 import FrameTransforms
from foxglove_schemas_protobuf.SceneUpdate_pb2 import SceneUpdate
from mcap.well_known import MessageEncoding, SchemaEncoding
from mcap.writer import Writer
from mcap_protobuf.schema import register_schema

from railpatch.log.channels import CONVENTIONS, WELL_KNOWN, Channel, flat_fields, note
from railpatch.log.effective import EFFECTIVE, Effective
from railpatch.log.schema import PACKAGE, schema_data

FLUSH_INTERVAL = 0.25  # s, wall clock
SCENE_RATE = 30.0  # Hz of simulation time, of the 3D scene
CASE_MEDIA_TYPE = "application/toml"
EFFECTIVE_MEDIA_TYPE = "application/json"
PROFILE_MEDIA_TYPE = "text/plain"
_LAST_TIME = 2**63 - 1  # ns; beyond, some readers' signed times overflow
_FOXGLOVE = {"foxglove.FrameTransforms": FrameTransforms, "foxglove.SceneUpdate": SceneUpdate}


class _Named(io.FileIO):
    """A file whose errors in writing name it."""

    def write(self, data: Any) -> int:
        try:
            return super().write(data) or 0
        except OSError as error:
            raise OSError(error.errno, error.strerror, str(self.name)) from None


class LogStream:
    """An MCAP file that is being written; what was added is serialised when it is flushed.

    ``channels``: those of the run. ``about``: metadata beside version and conventions.
    ``attachments``: name, media type and bytes. Raises OSError where ``path`` cannot be written.
    """

    def __init__(
        self,
        path: str | PathLike[str],
        channels: tuple[Channel, ...],
        about: Mapping[str, str],
        attachments: list[tuple[str, str, bytes]],
    ) -> None:
        self._opened = time.perf_counter()
        self._ended: float | None = None
        self._count, self._beside = _Counted(), 0.0
        self.path = Path(path)
        self._last_ns = -1
        self._lock = threading.Lock()
        # serialised many at a time: caches are warm then
        self._pending: list[tuple[int, Mapping[str, Any]]] = []
        self._flushed_at = time.monotonic()
        self._stop = threading.Event()
        with self.counted():
            self._stream = io.BufferedWriter(_Named(self.path, "wb"))
            self._writer = Writer(self._stream)
            self._writer.start(library=f"railpatch {railpatch_version()}")
            for name, media_type, data in attachments:
                self._writer.add_attachment(0, 0, name, media_type, data)
            self._describe(channels, about)
            self._channels = self._register(channels)
            self._writer.flush()
        self._thread = threading.Thread(target=self._keep_flushed, daemon=True)
        self._thread.start()

    @property
    def closed(self) -> bool:
        """Whether close() was called."""
        return self._stream.closed

    @property
    def share(self) -> float:
        """Of the wall-clock time since the file was opened, the part that the log took; -.

        What runs within counted() counts, the log's own methods, and its thread's flushes.
        """
        now = time.perf_counter() if self._ended is None else self._ended
        return (self._count.seconds + self._beside) / (now - self._opened)

    def counted(self) -> AbstractContextManager[Any]:
        """What runs within counts as logging: making the messages, for example."""
        return self._count

    def add(self, messages: Mapping[str, Any], time_ns: int) -> None:
        """Messages of one moment, by topic."""
        with self._lock:
            self._pending.append((time_ns, messages))
            self._last_ns = max(self._last_ns, time_ns)
            if time.monotonic() - self._flushed_at >= FLUSH_INTERVAL:
                self._flush()

    def beside(self, messages: Mapping[str, Any], time_ns: int) -> None:
        """The same of what is no step: the next one may come at the same moment or before."""
        with self._lock:
            self._pending.append((time_ns, messages))

    def first(self, topic: str, message: Any) -> None:
        """A message before the first moment, at time 0."""
        last = self._last_ns
        self.add({topic: message}, 0)
        with self._lock:
            self._last_ns = last
            self._flush()

    def close(self, stopped_by: str = "") -> None:
        """Writes the index and closes the file; a second call does nothing.

        ``stopped_by`` names what ended the run before its end; the log then says so.
        """
        if self._stream.closed:
            return
        self._stop.set()
        self._thread.join()
        with self._stream, self.counted():
            self._flush()
            seconds = self._count.until_now() + self._beside
            end = {
                "stopped_by": stopped_by,
                "wall_time": f"{time.perf_counter() - self._opened:.6g}",
                "logging_time": f"{seconds:.6g}",
            }
            self._writer.add_metadata(f"{PACKAGE}.end", end)
            self._writer.finish()
        self._ended = time.perf_counter()

    def checked_time(self, time_s: float) -> int:
        """ns of a moment later than the last. Raises ValueError."""
        if self._stream.closed:
            raise ValueError(f"{self.path}: the run log is closed")
        if type(time_s) is not float and (
            isinstance(time_s, bool) or not isinstance(time_s, numbers.Real)
        ):
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

    def _flush(self) -> None:
        for time_ns, messages in self._pending:
            for topic, message in messages.items():
                data = message.SerializeToString()
                self._writer.add_message(self._channels[topic], time_ns, data, time_ns)
        self._pending.clear()
        self._writer.flush()
        self._flushed_at = time.monotonic()

    def _keep_flushed(self) -> None:
        while not self._stop.wait(FLUSH_INTERVAL):
            with self._lock:
                if self._pending:
                    begin = time.perf_counter()
                    try:
                        self._flush()
                    except OSError:
                        return  # as on a full disk: who adds the next step is told
                    self._beside += time.perf_counter() - begin

    def _describe(self, channels: tuple[Channel, ...], about: Mapping[str, str]) -> None:
        head = {"version": railpatch_version()} | dict(about) | CONVENTIONS
        self._writer.add_metadata(PACKAGE, head)
        self._writer.add_metadata(
            f"{PACKAGE}.channels",
            {
                f"{entry.topic}.{path}": note(field)
                for entry in channels
                for path, field in flat_fields(entry.message)
            },
        )

    def _register(self, channels: tuple[Channel, ...]) -> dict[str, int]:
        ids = {}
        schemas: dict[str, int] = {}
        for entry in channels:
            name = f"{PACKAGE}.{entry.message.name}"
            if name not in schemas:
                schemas[name] = self._writer.register_schema(
                    name, SchemaEncoding.Protobuf, schema_data(entry.message)
                )
            ids[entry.topic] = self._writer.register_channel(
                entry.topic, MessageEncoding.Protobuf, schemas[name], _channel_metadata(entry)
            )
        for topic, (name, text) in WELL_KNOWN.items():
            if name not in schemas:
                schemas[name] = register_schema(self._writer, _FOXGLOVE[name])
            ids[topic] = self._writer.register_channel(
                topic, MessageEncoding.Protobuf, schemas[name], {"description": text}
            )
        return ids


AnyLog = TypeVar("AnyLog", bound="Log")


class Log:
    """What the logs of all runs have: a stream, which ends with the ``with`` statement."""

    stream: LogStream

    @property
    def path(self) -> Path:
        """Of the file."""
        return self.stream.path

    @property
    def share(self) -> float:
        """Part of the wall-clock time since the file was opened that the log took; -."""
        return self.stream.share

    def close(self, stopped_by: str = "") -> None:
        """Writes the index and closes the file; a second call does nothing.

        ``stopped_by`` names what ended the run before its end; the log then says so.
        """
        self.stream.close(stopped_by)

    def __enter__(self: AnyLog) -> AnyLog:
        return self

    def __exit__(self, kind: type[BaseException] | None, *error: object) -> None:
        self.close(kind.__name__ if kind else "")


class _Counted:
    """Adds up the time inside of it; may be entered again inside."""

    def __init__(self) -> None:
        self.seconds, self._depth, self._begin = 0.0, 0, 0.0

    def until_now(self) -> float:
        """s, with what the one that is entered has taken."""
        return self.seconds + (time.perf_counter() - self._begin if self._depth else 0.0)

    def __enter__(self) -> None:
        if self._depth == 0:
            self._begin = time.perf_counter()
        self._depth += 1

    def __exit__(self, *error: object) -> None:
        self._depth -= 1
        if self._depth == 0:
            self.seconds += time.perf_counter() - self._begin


class Pace:
    """Which moments are shown, by simulation time: the first one in each 1/rate seconds.

    rate: Hz; 0: none. The same times always give the same moments.
    """

    def __init__(self, rate: float) -> None:
        real = isinstance(rate, numbers.Real) and not isinstance(rate, bool)
        if not real or not 0 <= rate <= 1e9:
            raise ValueError(f"scene_rate is {rate!r}; it must be 0 to 1e9 (Hz)")
        self._rate = rate
        self._last = -1

    def due(self, time_s: float) -> bool:
        """Whether a moment is shown; to be asked once of each."""
        # times are sums of steps: a little early counts
        number = math.floor(time_s * self._rate + 1e-6)
        if self._rate == 0 or number <= self._last:
            return False
        self._last = number
        return True


@cache
def railpatch_version() -> str:
    """The installed version, or "unknown" in a checkout that is not installed."""
    try:
        return version("railpatch")
    except PackageNotFoundError:
        return "unknown"


def _channel_metadata(entry: Channel) -> dict[str, str]:
    """Description of a channel; for each field unit, frame and meaning, where it has them."""
    metadata = {"description": entry.text}
    for path, field in flat_fields(entry.message):
        notes = {"unit": field.unit, "frame": field.frame, "description": field.text}
        metadata |= {f"{path}.{name}": value for name, value in notes.items() if value}
    return metadata


def checked_attachments(
    case_text: str | bytes,
    case_name: str,
    profiles: Mapping[str, bytes],
    ran_with: Effective | None = None,
) -> list[tuple[str, str, bytes]]:
    """Name, media type and bytes of every attachment. Raises ValueError."""
    if not isinstance(case_name, str) or not case_name:
        raise ValueError(f"case_name is {case_name!r}; it must be a text that is not empty")
    if not isinstance(case_text, (str, bytes)):
        raise ValueError(f"case_text is of type {type(case_text).__name__}; it must be text")
    data = case_text.encode() if isinstance(case_text, str) else case_text
    attachments = [(case_name, CASE_MEDIA_TYPE, data)]
    taken = {case_name}
    if ran_with is not None:
        attachments.append((EFFECTIVE, EFFECTIVE_MEDIA_TYPE, ran_with.data))
        taken.add(EFFECTIVE)
    for name, content in profiles.items():
        if not isinstance(name, str) or not name or name in taken:
            raise ValueError(f"profiles: {name!r} is not a name of its own")
        if not isinstance(content, bytes):
            raise ValueError(
                f"profiles: {name} is of type {type(content).__name__}; it must be the file's bytes"
            )
        attachments.append((name, mimetypes.guess_type(name)[0] or PROFILE_MEDIA_TYPE, content))
    return attachments
