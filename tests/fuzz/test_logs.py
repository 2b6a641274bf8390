"""Any bytes are a log, or refused by name; nothing that is read was not written.

`tests/record/test_damaged_logs.py` damages the log of a run. Here the checksums are right.
"""

from __future__ import annotations

import struct
import tempfile
import zlib
from contextlib import suppress
from pathlib import Path

import zstandard
from hypothesis import given
from hypothesis import strategies as st
from mcap.data_stream import RecordBuilder
from mcap.opcode import Opcode
from mcap.records import Chunk

from airhilt.errors import RunFolderError
from airhilt.record.log_reader import MAGIC, LogReader
from fuzzing import any_input

counts = st.sampled_from([0, 1, 2, 2**31, 2**32 - 1]) | st.integers(0, 2**16 - 1)
times = st.integers(0, 2**64 - 1) | st.integers(0, 10**10)


def text(value: str) -> bytes:
    data = value.encode()
    return struct.pack("<I", len(data)) + data


def record(opcode: int, content: bytes, length: int | None = None) -> bytes:
    return struct.pack("<BQ", opcode, len(content) if length is None else length) + content


messages = st.builds(
    lambda channel, number, t_ns, data: record(
        Opcode.MESSAGE, struct.pack("<HIQQ", channel, number, t_ns, t_ns) + data
    ),
    st.integers(0, 3), counts, times, st.binary(max_size=20),
)  # fmt: skip
channels = st.builds(
    lambda number, topic: record(
        Opcode.CHANNEL, struct.pack("<HH", number, 0) + text(topic) + text("json") + bytes(4)
    ),
    st.integers(0, 3), st.text(max_size=10),
)  # fmt: skip
anything = st.builds(
    record, st.integers(0, 255), st.binary(max_size=40), st.none() | st.integers(0, 2**64 - 1)
)
records = st.lists(messages | channels | anything, max_size=12).map(b"".join)


def chunk(content: bytes) -> bytes:
    """Return a chunk with the right checksum, whatever its records are."""
    compressed = zstandard.compress(content)
    builder = RecordBuilder()
    Chunk("zstd", compressed, 1, 0, zlib.crc32(content), len(content)).write(builder)
    written: bytes = builder.end()  # type: ignore[no-untyped-call]
    return written


@any_input
@given(st.lists(records.map(chunk) | records | st.binary(max_size=50), max_size=6))
def test_a_log_of_any_records_is_read_in_order_or_refused_by_name(parts: list[bytes]) -> None:
    assert_read(MAGIC + b"".join(parts))


@any_input
@given(st.binary(max_size=200))
def test_any_bytes_are_no_log_or_an_empty_one(data: bytes) -> None:
    assert_read(data)


def assert_read(data: bytes) -> None:
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "log.mcap"
        path.write_bytes(data)
        with suppress(RunFolderError):
            numbers = [each.sequence for each in LogReader(path).messages()]
            assert numbers == sorted(set(numbers))
