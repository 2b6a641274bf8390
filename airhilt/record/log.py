"""``log.mcap``: every message of a run, by simulation time.

The file depends on nothing but the messages, so two equal runs give equal bytes. It is flushed once
a simulated second. Everything in it has a CRC-32, and the messages are numbered from 1 on.
"""

from __future__ import annotations

import functools
import json
from pathlib import Path

from mcap.writer import CompressionType, Writer
from pydantic import BaseModel

from airhilt.errors import writing_to_run

CHUNK_BYTES = 4_000_000
"""Size of a chunk of the file, in bytes: more than one second of any run."""


class LogWriter:
    """Writes messages with their JSON Schemas; one channel for each key, publisher and schema."""

    def __init__(self, path: Path) -> None:
        self._stream = path.open("wb")
        self._writer = Writer(
            self._stream,
            chunk_size=CHUNK_BYTES,
            compression=CompressionType.ZSTD,
            enable_data_crcs=True,
        )
        self._writer.start(profile="airhilt", library="airhilt")
        self._schemas: dict[type[BaseModel], int] = {}
        self._channels: dict[tuple[str, str, type[BaseModel]], int] = {}
        self._sequence = 0

    def write(
        self, key: str, publisher: str, model: type[BaseModel], t_ns: int, data: bytes
    ) -> None:
        """Write one message, which is JSON already."""
        name = key, publisher, model
        if name not in self._channels:
            self._channels[name] = self._writer.register_channel(
                key, "json", self._schema(model), {"publisher": publisher}
            )
        self._sequence += 1
        self._writer.add_message(self._channels[name], t_ns, data, t_ns, self._sequence)

    def _schema(self, model: type[BaseModel]) -> int:
        if model not in self._schemas:
            self._schemas[model] = self._writer.register_schema(
                f"airhilt.{model.__name__}", "jsonschema", _json_schema(model)
            )
        return self._schemas[model]

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
def _json_schema(model: type[BaseModel]) -> bytes:
    return json.dumps(model.model_json_schema(), sort_keys=True).encode()
