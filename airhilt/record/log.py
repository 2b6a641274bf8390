"""``log.mcap``: every message of a run, by simulation time.

A key has one schema; that of ``audio`` allows each of its three kinds of pieces. The file depends
on nothing but the messages, so two equal runs give equal bytes. It is flushed once a simulated
second. Everything in it has a CRC-32, and the messages are numbered from 1 on.
"""

from __future__ import annotations

import functools
import json
from pathlib import Path

from mcap.writer import CompressionType, Writer
from pydantic import BaseModel

from airhilt.errors import writing_to_run
from airhilt.messages import Pieces, pieces_of

CHUNK_BYTES = 4_000_000
"""Size of a chunk of the file, in bytes: more than one second of any run."""


class LogWriter:
    """Writes messages with their JSON Schemas; one channel for each key and publisher."""

    def __init__(self, path: Path) -> None:
        self._stream = path.open("wb")
        self._writer = Writer(
            self._stream,
            chunk_size=CHUNK_BYTES,
            compression=CompressionType.ZSTD,
            enable_data_crcs=True,
        )
        self._writer.start(profile="airhilt", library="airhilt")
        self._schemas: dict[str, int] = {}
        """Numbers of the schemas, by their names."""
        self._channels: dict[tuple[str, str], int] = {}
        self._sequence = 0

    def write(
        self, key: str, publisher: str, model: type[BaseModel], t_ns: int, data: bytes
    ) -> None:
        """Write one message, which is JSON already."""
        name = key, publisher
        if name not in self._channels:
            self._channels[name] = self._writer.register_channel(
                key, "json", self._schema(key, model), {"publisher": publisher}
            )
        self._sequence += 1
        self._writer.add_message(self._channels[name], t_ns, data, t_ns, self._sequence)

    def _schema(self, key: str, model: type[BaseModel]) -> int:
        pieces = pieces_of(key)
        name = f"airhilt.{model.__name__ if pieces is None else pieces.name}"
        if name not in self._schemas:
            schema = _json_schema(model if pieces is None else pieces)
            self._schemas[name] = self._writer.register_schema(name, "jsonschema", schema)
        return self._schemas[name]

    def flush(self) -> None:
        """Hand all messages to the operating system, so that they outlive this process.

        It raises `RunFolderError` if the disk is full or gone.
        """
        with writing_to_run(self._stream.name):
            self._writer.flush()  # type: ignore[no-untyped-call]

    def close(self) -> None:
        """Write the index and close the file, unless it is closed already; else as `flush`."""
        if self._stream.closed:
            return
        with writing_to_run(self._stream.name), self._stream:
            self._writer.finish()  # type: ignore[no-untyped-call]


@functools.cache
def _json_schema(kind: type[BaseModel] | Pieces) -> bytes:
    """Return a JSON Schema, whose root is an object, as programs that read MCAP expect."""
    if isinstance(kind, Pieces):
        schema = {"title": kind.name, "type": "object", **kind.type.json_schema()}
    else:
        schema = kind.model_json_schema()
    return json.dumps(schema, sort_keys=True).encode()
