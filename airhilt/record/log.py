"""``log.mcap``: every message of a run, by simulation time.

The file depends on nothing but the messages, so two equal runs give equal bytes. It is flushed
once a simulated second; a run that is killed leaves all but the last of them.
"""

from __future__ import annotations

import functools
import json
import struct
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

import zstandard
from mcap.exceptions import McapError
from mcap.records import Channel, Message
from mcap.stream_reader import StreamReader
from mcap.writer import CompressionType, Writer
from pydantic import BaseModel

from airhilt.errors import RunFolderError, disk_failed

BROKEN = (McapError, struct.error, zstandard.ZstdError, KeyError, UnicodeDecodeError)
"""Exceptions of a log that breaks off or is damaged."""
CHUNK_BYTES = 4_000_000
"""Size of a chunk of the file, in bytes: more than one second of any run."""


class Logged(NamedTuple):
    """One message of the log."""

    key: str
    publisher: str
    t_ns: int
    data: bytes


class LogWriter:
    """Writes messages with their JSON Schemas; one channel for each key, publisher and schema."""

    def __init__(self, path: Path) -> None:
        self._stream = path.open("wb")
        self._writer = Writer(
            self._stream, chunk_size=CHUNK_BYTES, compression=CompressionType.ZSTD
        )
        self._writer.start(profile="airhilt", library="airhilt")
        self._schemas: dict[type[BaseModel], int] = {}
        self._channels: dict[tuple[str, str, type[BaseModel]], int] = {}
        self._sequence = 0

    def write(
        self, key: str, publisher: str, model: type[BaseModel], t_ns: int, data: bytes
    ) -> None:
        """Write one message, which is JSON already."""
        channel = self._channels.get((key, publisher, model))
        if channel is None:
            channel = self._register(key, publisher, model)
        self._sequence += 1
        self._writer.add_message(channel, t_ns, data, t_ns, self._sequence)

    def _register(self, key: str, publisher: str, model: type[BaseModel]) -> int:
        schema = self._schemas.get(model)
        if schema is None:
            schema = self._writer.register_schema(
                f"airhilt.{model.__name__}", "jsonschema", _json_schema(model)
            )
            self._schemas[model] = schema
        channel = self._writer.register_channel(key, "json", schema, {"publisher": publisher})
        self._channels[(key, publisher, model)] = channel
        return channel

    def flush(self) -> None:
        """Hand all messages to the operating system, so that they outlive this process.

        Raises
        ------
        RunFolderError
            The disk is full or gone.
        """
        try:
            self._writer.flush()  # type: ignore[no-untyped-call]
        except OSError as error:
            raise disk_failed(self._stream.name, error) from None

    def close(self) -> None:
        """Write the index and close the file, unless it is closed already.

        Raises
        ------
        RunFolderError
            The disk is full or gone; what was flushed before stays readable.
        """
        if self._stream.closed:
            return
        try:
            with self._stream:
                self._writer.finish()  # type: ignore[no-untyped-call]
        except OSError as error:
            raise disk_failed(self._stream.name, error) from None


@functools.cache
def _json_schema(model: type[BaseModel]) -> bytes:
    """Return the JSON Schema of a model; a process makes it once for all its logs."""
    return json.dumps(model.model_json_schema(), sort_keys=True).encode()


def read_log(path: Path) -> Iterator[Logged]:
    """Yield the messages of a log in the order of writing, up to where it breaks off.

    Raises
    ------
    RunFolderError
        The file cannot be read, or is no MCAP file.
    """
    channels: dict[int, Channel] = {}
    try:
        with path.open("rb") as stream:
            for record in StreamReader(stream).records:
                if isinstance(record, Channel):
                    channels[record.id] = record
                elif isinstance(record, Message):
                    channel = channels[record.channel_id]
                    yield Logged(
                        channel.topic,
                        channel.metadata.get("publisher", ""),
                        record.log_time,
                        record.data,
                    )
    except OSError as error:
        raise RunFolderError(f"{path}: cannot be read: {error.strerror}") from None
    except BROKEN as error:
        if not channels:
            reason = str(error) or "it ends before its first message"
            raise RunFolderError(f"{path}: not an MCAP log: {reason}") from None
