"""Reads a run log, whole or cut off, into numpy arrays.

The messages are decoded with the schemas in the file, so logs of other versions can be read too.
"""

from __future__ import annotations

import difflib
import struct
from collections import Counter
from collections.abc import Iterable, Iterator, MutableSequence, Sequence
from dataclasses import dataclass, field
from os import PathLike
from pathlib import Path
from typing import Any

import numpy as np
from google.protobuf.message import DecodeError
from mcap.exceptions import EndOfFile, InvalidMagic, McapError, RecordLengthLimitExceeded
from mcap.records import Attachment as AttachmentRecord
from mcap.records import Channel, Message, Metadata, Schema
from mcap.stream_reader import CRCValidationError, StreamReader
from mcap_protobuf.decoder import DecoderFactory
from zstandard import ZstdError

from railpatch.log.channels import WELL_KNOWN
from railpatch.log.channels import channel as known_channel
from railpatch.log.table import TIME, LogTable, log_table

# what a file that ends within a record can make the mcap library raise
_CUT_OFF = (
    EndOfFile,
    InvalidMagic,
    RecordLengthLimitExceeded,
    CRCValidationError,
    ZstdError,
    struct.error,
    UnicodeDecodeError,
)


class RunFileError(ValueError):
    """The file is not a run log."""


@dataclass(frozen=True)
class Attachment:
    """A file that the log carries."""

    data: bytes
    media_type: str


@dataclass
class Series:
    """The messages of one channel: ``time`` (s, shape (n,)) and ``messages``, n dicts.

    In the dicts a field that is absent is None, and a list that is absent is empty.
    ``series["z"]`` makes an array of shape (n,) of a number (NaN where absent), an array of texts
    ("" where absent), or one of shape (n, k) of a list of k numbers (a row of NaN where absent);
    "elements.stick" reaches into a message, "patches[0].approach" into a list of them.
    """

    time: np.ndarray = field(default_factory=lambda: np.empty(0))
    messages: list[dict[str, Any]] = field(default_factory=list)

    def __len__(self) -> int:
        return len(self.messages)

    def __getitem__(self, path: str) -> np.ndarray:
        values = [_reach(message, path) for message in self.messages]
        present = [v for v in values if v is not None and not (isinstance(v, list) and not v)]
        if not present:
            self._check_name(path)
            return np.full(len(values), np.nan)
        if isinstance(present[0], str):
            return np.array([v or "" for v in values], dtype=object)
        if isinstance(present[0], list):
            gap = [np.nan] * len(present[0])
            return np.array([v or gap for v in values], dtype=float)
        return np.array([np.nan if v is None else v for v in values], dtype=float)

    def _check_name(self, path: str) -> None:
        head = path.split(".")[0].split("[")[0]
        if self.messages and head not in self.messages[0]:
            names = ", ".join(self.messages[0])
            raise KeyError(
                f"no field {head!r}; the fields are {names}{near(head, self.messages[0])}"
            )


def near(name: str, names: Iterable[str]) -> str:
    """A hint at the name that was perhaps meant."""
    found = difflib.get_close_matches(name, list(names), 1)
    return f"; did you mean {found[0]!r}?" if found else ""


@dataclass
class Run:
    """A run log in memory.

    ``channels``: by topic, the log's own channels; a topic that the run did not write is an empty
    series. ``counts``: messages of every topic, the 3D scene's too. ``attachments`` and
    ``metadata``: by name. ``truncated``: whether the file ends before the log does; ``problem``
    then says where. ``stopped_by``: the error that ended the run before its end, "" where none did.
    """

    path: Path
    channels: dict[str, Series]
    counts: dict[str, int]
    attachments: dict[str, Attachment]
    metadata: dict[str, dict[str, str]]
    truncated: bool = False
    problem: str = ""

    @property
    def stopped_by(self) -> str:
        return self.metadata.get("railpatch.end", {}).get("stopped_by", "")

    def __getitem__(self, topic: str) -> Series:
        """The channel's series, empty where the run did not write it; KeyError where no run does,
        which names those that this one wrote."""
        if topic not in self.channels:
            try:
                known_channel(topic)
            except KeyError:
                wrote = ", ".join(sorted(self.channels)) or "none"
                said = f"no channel {topic!r}; this log has {wrote}{near(topic, self.channels)}"
                raise KeyError(said) from None
        return self.channels.get(topic) or Series()

    def table(self, channels: Sequence[str] = (), signals: Sequence[str] = ()) -> LogTable:
        """The log as one table: a row for each moment, a column for each number or text.

        channels: topics, signals: names of columns or fields; * and ? stand for any characters.
        Without them all that have a value; fields of the patches only where their channel is named.
        Raises CaseError where one of them matches nothing.
        """
        return log_table(self.channels, channels, signals)

    def to_pandas(self, channels: Sequence[str] = (), signals: Sequence[str] = ()) -> Any:
        """The table as a pandas.DataFrame over the time (s), with NaN for what is absent.

        ``frame.attrs["units"]`` and ``frame.attrs["meanings"]`` hold both by column. Channels and
        signals as for ``table``. Raises CaseError where one of them matches nothing, ImportError
        that says what to install without pandas.
        """
        try:
            import pandas
        except ImportError:
            raise ImportError(
                "to_pandas needs pandas, which is not installed; pip install 'railpatch[export]'"
            ) from None
        table = self.table(channels, signals)
        columns = {column.name: column.values for column in table.columns[1:]}
        frame = pandas.DataFrame(columns, index=pandas.Index(table.time, name=TIME))
        frame.attrs["units"] = {column.name: column.unit for column in table.columns}
        frame.attrs["meanings"] = {column.name: column.text for column in table.columns}
        return frame

    def __repr__(self) -> str:
        messages = sum(map(len, self.channels.values()))
        cut = ", truncated" if self.truncated else ""
        return f"Run({str(self.path)!r}: {len(self.channels)} channels, {messages} messages{cut})"


def read_run(path: str | PathLike[str]) -> Run:
    """Reads a run log; what is left of one that was cut off is read up to its last whole chunk.

    Raises RunFileError where the file is not a run log, OSError where it cannot be read.
    """
    path = Path(path)
    run = Run(path, {}, {}, {}, {})
    times: dict[str, list[float]] = {}
    counts: Counter[str] = Counter()
    for kind, name, content in _contents(path, run):
        if kind == "attachment":
            run.attachments[name] = content
        elif kind == "metadata":
            run.metadata[name] = content
        else:
            counts[name] += 1
            if name not in WELL_KNOWN:
                run.channels.setdefault(name, Series()).messages.append(_to_dict(content[1]))
                times.setdefault(name, []).append(content[0] / 1e9)
    for topic, series in run.channels.items():
        series.time = np.array(times[topic])
    run.counts = dict(counts)
    if "railpatch" not in run.metadata:
        raise RunFileError(
            f"{path} is an MCAP file, but not a run log of railpatch"
            + (f" ({run.problem})" if run.problem else "")
        )
    return run


def _contents(path: Path, run: Run) -> Iterator[tuple[str, str, Any]]:
    """Kind, name and content of every record; marks the run where the file is cut off."""
    with open(path, "rb") as stream:
        if stream.read(5) != b"\x89MCAP":
            raise RunFileError(f"{path} is not an MCAP file")
        stream.seek(0)
        records = StreamReader(stream, validate_crcs=True).records
        decoders = DecoderFactory()
        schemas: dict[int, Schema] = {}
        channels: dict[int, Channel] = {}
        try:
            for record in records:
                if isinstance(record, Schema):
                    schemas[record.id] = record
                elif isinstance(record, Channel):
                    channels[record.id] = record
                elif isinstance(record, AttachmentRecord):
                    content = Attachment(record.data, record.media_type)
                    yield "attachment", record.name, content
                elif isinstance(record, Metadata):
                    yield "metadata", record.name, record.metadata
                elif isinstance(record, Message):
                    channel = channels[record.channel_id]
                    message = _decoded(decoders, channel, schemas, record)
                    yield "message", channel.topic, (record.log_time, message)
        except _CUT_OFF as error:
            run.truncated = True
            run.problem = (
                f"the file ends, or is damaged, near byte {stream.tell()} ({type(error).__name__})"
            )


def _decoded(
    decoders: DecoderFactory, channel: Channel, schemas: dict[int, Schema], record: Message
) -> Any:
    if channel.topic in WELL_KNOWN:
        return None
    try:
        decode = decoders.decoder_for(channel.message_encoding, schemas.get(channel.schema_id))
        if decode is None:
            raise RunFileError(f"channel {channel.topic} is not in protobuf")
        return decode(record.data)
    except (DecodeError, McapError) as error:
        raise RunFileError(f"channel {channel.topic}: {error}") from None


def _to_dict(message: Any) -> dict[str, Any]:
    """A message as plain Python values; None for what is absent."""
    values: dict[str, Any] = {}
    for entry in message.DESCRIPTOR.fields:
        value = getattr(message, entry.name)
        if isinstance(value, MutableSequence):
            nested = entry.message_type is not None
            values[entry.name] = [_to_dict(v) for v in value] if nested else list(value)
        elif entry.has_presence and not message.HasField(entry.name):
            values[entry.name] = None
        else:
            values[entry.name] = _to_dict(value) if entry.message_type else value
    return values


def _reach(message: dict[str, Any] | None, path: str) -> Any:
    """The value at a dotted path, or None."""
    value: Any = message
    for part in path.split("."):
        name, _, index = part.partition("[")
        value = value.get(name) if isinstance(value, dict) else None
        if index and value is not None:
            position = int(index.rstrip("]"))
            value = value[position] if position < len(value) else None
    return value
