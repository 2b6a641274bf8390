"""Reads ``log.mcap``: every message whose checksum is right, and where others are missing.

A log is a row of chunks. Each has a CRC-32 of its records, and each message has a number, so that
nothing is missing without being noticed. A damaged chunk is left out, and the next one is found by
its content. The format is that of https://mcap.dev/spec, as `LogWriter` uses it.
"""

from __future__ import annotations

import io
import struct
import zlib
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import BinaryIO, NamedTuple

import zstandard
from mcap.data_stream import ReadDataStream
from mcap.exceptions import McapError
from mcap.opcode import Opcode
from mcap.records import Channel, Statistics

from airhilt.errors import RunFolderError
from airhilt.host.files import open_inside
from airhilt.units import SECOND_NS

BROKEN = (McapError, struct.error, zstandard.ZstdError, ValueError, LookupError, MemoryError)
"""Exceptions of bytes that are not what they should be."""
MAGIC = b"\x89MCAP0\r\n"
"""Bytes with which a log begins and ends."""
RECORD_HEAD = struct.Struct("<BQ")
"""Opcode of a record, and the length of its content."""
CHUNK_HEAD = struct.Struct("<QQQII4sQ")
"""First and last time of a chunk, size and CRC-32 of its records, compression, compressed size."""
MESSAGE_HEAD = struct.Struct("<HIQQ")
"""Channel, number, and both times of a message."""
FOOTER = struct.Struct("<BQQQI")
"""The last record: opcode, length, offsets of the summary and of its second part, CRC-32."""
DATA_END = struct.Struct("<BQI")
"""The record after the last chunk: opcode, length, CRC-32 of all that is before it."""
COMPRESSION = struct.pack("<I4s", 4, b"zstd")
"""Bytes that every chunk has, and by which it is found."""
COMPRESSION_AT = RECORD_HEAD.size + 28
"""Place of these bytes, from where a chunk begins."""
LARGEST_CHUNK_BYTES = 1 << 28
"""Greatest size of the records of a chunk, in bytes: a larger one is damaged."""
LARGEST_INDEX_BYTES = 1 << 28
"""Greatest size of the end of a log that repeats what is in it, in bytes."""
FRAME_HEAD_BYTES = 18
"""Greatest size of the head of a compressed chunk, which has the size of its records."""
MOST_EXPANSION = 1000
"""Number of bytes that are expanded and searched for each byte of a log: a run writes 3 to 5, and
more when a program floods it with one text."""
RECORD_COST_BYTES = 1000
"""Number of bytes that are expanded in the time in which one record is handled."""
BLOCK_BYTES = 1 << 20
"""Number of bytes that are read at a time where the whole file is gone through."""
MOST_GAPS = 3
"""Number of gaps that are told one by one."""
PASSED_OVER = (Opcode.HEADER, Opcode.MESSAGE_INDEX)
"""Records between chunks that no message needs."""


class Logged(NamedTuple):
    """One message of the log."""

    key: str
    publisher: str
    t_ns: int
    data: bytes
    sequence: int = 0
    """Number of the message in its log, from 1 on; 0 if it is of no log."""


class Gap(NamedTuple):
    """A place of a log at which messages are missing."""

    begin_ns: int
    """Time of the last message before it."""
    end_ns: int | None
    """Time of the first message after it, None if it goes to the end of the log."""
    messages: int | None
    """Number of missing messages, None if it is not known."""


@dataclass(frozen=True)
class _Index:
    """What the end of a log repeats of it."""

    channels: dict[int, Channel]
    messages: int
    """Number of messages in the log."""
    data_end: int
    """Place of the record after the last chunk."""


class LogReader:
    """Reads one log from its beginning to where it ends.

    Parameters
    ----------
    path
        The file, which may still be written.

    Attributes
    ----------
    gaps
        Places at which messages are missing, as far as the log has been read.
    end_ns
        Time of the last message that was read.
    is_closed
        True if the log has its end: it neither breaks off nor goes on.
    is_faultless
        True if every checksum is right. Known when the log has been read to its end.
    """

    def __init__(self, path: Path) -> None:
        self.path = path
        self.gaps: list[Gap] = []
        self.end_ns = 0
        self.is_closed = False
        self.is_faultless = True
        self._size = 0
        self._left_bytes = 0
        """Number of bytes that may still be expanded and searched; below 0, reading ends."""
        self._channels: dict[int, Channel] = {}
        self._last = 0
        """Number of the last message that was read."""
        self._nameless = 0
        """Number of the last message whose channel is in a damaged chunk."""

    def messages(self) -> Iterator[Logged]:
        """Yield the messages in the order of writing; what cannot be read is left out.

        Raises
        ------
        RunFolderError
            The file cannot be opened or read, or holds no message that anybody could read.
        """
        try:
            with open_inside(self.path.parent, self.path) as stream:
                yield from self._messages(stream)
        except OSError as error:
            raise RunFolderError(f"{self.path}: cannot be read: {error.strerror}") from None

    def _messages(self, stream: BinaryIO) -> Iterator[Logged]:
        self._size = stream.seek(0, io.SEEK_END)
        self._left_bytes = LARGEST_CHUNK_BYTES + MOST_EXPANSION * self._size
        is_mcap = _read(stream, 0, len(MAGIC)) == MAGIC
        index = self._index(stream)
        if index is not None:
            self._channels = dict(index.channels)
        self.is_closed = index is not None
        self.is_faultless = (
            is_mcap and index is not None and _is_data_intact(stream, index.data_end)
        )
        broken_at: int | None = None
        position = len(MAGIC)
        while self._may_read(0):
            chunk, position, broken_at = self._next_chunk(stream, position)
            if chunk is None:
                break
            yield from self._of_chunk(chunk)
        self._close_gap(index, broken_at)
        if self._last == 0 and not self.gaps and not self.is_closed and not is_mcap:
            raise RunFolderError(f"{self.path}: not an MCAP log: it has not the magic bytes")

    def _of_chunk(self, chunk: bytes) -> Iterator[Logged]:
        """Yield the messages of a chunk.

        Raises
        ------
        RunFolderError
            Its checksum is right, and its content is none of AIRHILT.
        """
        try:
            for opcode, begin, end in _records(chunk):
                if not self._may_read(RECORD_COST_BYTES):
                    return
                if opcode == Opcode.CHANNEL:
                    channel = Channel.read(ReadDataStream(io.BytesIO(chunk[begin:end])))
                    self._channels[channel.id] = channel
                elif opcode == Opcode.MESSAGE:
                    channel_id, sequence, t_ns, _ = MESSAGE_HEAD.unpack_from(chunk, begin)
                    known = self._channels.get(channel_id)
                    if known is None:
                        self._nameless = sequence
                        continue
                    if sequence <= self._last:  # Its chunk is there twice, or out of order.
                        self.is_faultless = False
                        continue
                    self._count(sequence, t_ns)
                    publisher = known.metadata.get("publisher", "")
                    data = chunk[begin + MESSAGE_HEAD.size : end]
                    yield Logged(known.topic, publisher, t_ns, data, sequence)
        except BROKEN as error:
            raise RunFolderError(f"{self.path}: not a log of AIRHILT: {error}") from None

    def _count(self, sequence: int, t_ns: int) -> None:
        """Take in the number of a message, and keep the gap before it if there is one."""
        if sequence > self._last + 1:
            self.is_faultless = False
            self.gaps.append(Gap(self.end_ns, t_ns, sequence - self._last - 1))
        self._last = sequence
        self.end_ns = max(t_ns, self.end_ns)

    def _close_gap(self, index: _Index | None, broken_at: int | None) -> None:
        """Keep the gap after the last message, if there is one."""
        total = self._nameless if index is None else index.messages
        if not self._may_read(0) or (index is None and broken_at is not None):
            self.gaps.append(Gap(self.end_ns, None, None))
        elif total > self._last:
            self.gaps.append(Gap(self.end_ns, None, total - self._last))
        self.is_faultless = self.is_faultless and not self.gaps

    def _may_read(self, size: int) -> bool:
        """Return true if so many bytes more may be expanded or searched, and count them.

        Without a limit a small log could hold its reader for hours: chunks within each other, and
        records of nothing, of which a billion take up a few kilobytes.
        """
        self._left_bytes -= size
        return self._left_bytes >= 0

    # --- records --------------------------------------------------------------------------------

    def _next_chunk(self, stream: BinaryIO, position: int) -> tuple[bytes | None, int, int | None]:
        """Return the records of the next chunk, where it ends, and where a broken one begins.

        A chunk that the file ends in is none: whoever wrote it was killed, or is still writing.
        """
        begin = position
        broken_at: int | None = None
        while self._may_read(RECORD_COST_BYTES):
            head = _read(stream, begin, RECORD_HEAD.size)
            if len(head) < RECORD_HEAD.size:
                break
            opcode, length = RECORD_HEAD.unpack(head)
            end = begin + RECORD_HEAD.size + length
            if opcode == Opcode.DATA_END and end == begin + DATA_END.size:
                self.is_closed = True
                return None, begin, None
            if end > self._size:
                break
            if opcode == Opcode.CHUNK:
                chunk = self._chunk(stream, begin)
                if chunk is not None:
                    return chunk, end, None
                broken_at = begin
                break
            if opcode not in PASSED_OVER:
                broken_at = begin
                break
            begin = end
        return self._search(stream, position, broken_at)

    def _search(
        self, stream: BinaryIO, position: int, broken_at: int | None
    ) -> tuple[bytes | None, int, int | None]:
        """Return the same as `_next_chunk` for a chunk that is found by its content."""
        for place in _places(stream, COMPRESSION, position + COMPRESSION_AT):
            if not self._may_read(0):
                break
            begin = place - COMPRESSION_AT
            chunk = self._chunk(stream, begin, is_found=True)
            if chunk is not None:
                self.is_faultless = False
                _, length = RECORD_HEAD.unpack(_read(stream, begin, RECORD_HEAD.size))
                return chunk, begin + RECORD_HEAD.size + length, None
        return None, position, broken_at

    def _chunk(self, stream: BinaryIO, begin: int, *, is_found: bool = False) -> bytes | None:
        """Return the records of the chunk that begins there, None if it is damaged or none.

        Chunks that were found by their content may lie within each other: their size counts. Those
        that follow each other are expanded once.
        """
        head = _read(stream, begin, RECORD_HEAD.size + CHUNK_HEAD.size)
        if len(head) < RECORD_HEAD.size + CHUNK_HEAD.size:
            return None
        opcode, length = RECORD_HEAD.unpack_from(head)
        *_, size, crc, name_size, name, compressed_size = CHUNK_HEAD.unpack_from(
            head, RECORD_HEAD.size
        )
        if opcode != Opcode.CHUNK or struct.pack("<I4s", name_size, name) != COMPRESSION:
            return None
        if length != CHUNK_HEAD.size + compressed_size:
            return None
        if max(size, compressed_size) > LARGEST_CHUNK_BYTES:
            return None
        if begin + RECORD_HEAD.size + length > self._size:
            return None
        start = _read(stream, begin + len(head), min(FRAME_HEAD_BYTES, compressed_size))
        try:
            if zstandard.frame_content_size(start) != size:
                return None
            if is_found and not self._may_read(compressed_size + size):
                return None
            compressed = _read(stream, begin + len(head), compressed_size)
            chunk = zstandard.decompress(compressed, size)
        except BROKEN:
            return None
        return chunk if zlib.crc32(chunk) == crc else None

    def _index(self, stream: BinaryIO) -> _Index | None:
        """Return what the end of the file repeats, None if it is not there or damaged."""
        tail_size = FOOTER.size + len(MAGIC)
        tail = _read(stream, max(self._size - tail_size, 0), tail_size)
        if len(tail) < tail_size or not tail.endswith(MAGIC):
            return None
        _, _, begin, _, crc = FOOTER.unpack_from(tail)
        if not 0 < begin <= self._size - tail_size:
            return None
        if self._size - begin > LARGEST_INDEX_BYTES:
            return None
        summary = _read(stream, begin, self._size - tail_size - begin)
        if zlib.crc32(summary + tail[: FOOTER.size - 4]) != crc:
            return None
        channels: dict[int, Channel] = {}
        messages = 0
        try:
            for opcode, start, end in _records(summary):
                content = ReadDataStream(io.BytesIO(summary[start:end]))
                if opcode == Opcode.CHANNEL:
                    channel = Channel.read(content)
                    channels[channel.id] = channel
                elif opcode == Opcode.STATISTICS:
                    messages = Statistics.read(content).message_count
        except BROKEN:
            return None
        return _Index(channels, messages, begin - DATA_END.size)


def _is_data_intact(stream: BinaryIO, data_end: int) -> bool:
    """Return whether the CRC-32 of everything before the index is right, if there is one."""
    opcode, length, expected = DATA_END.unpack(_read(stream, max(data_end, 0), DATA_END.size))
    if (opcode, length) != (Opcode.DATA_END, 4):
        return False
    if expected == 0:
        return True  # Version 0.5 wrote none.
    crc = 0
    for begin in range(0, data_end, BLOCK_BYTES):
        crc = zlib.crc32(_read(stream, begin, min(BLOCK_BYTES, data_end - begin)), crc)
    return crc == int(expected)


def _read(stream: BinaryIO, position: int, size: int) -> bytes:
    stream.seek(position)
    return stream.read(size)


def _records(data: bytes) -> Iterator[tuple[int, int, int]]:
    """Yield opcode, begin and end of the content of each record."""
    at = 0
    while at < len(data):
        opcode, length = RECORD_HEAD.unpack_from(data, at)
        begin = at + RECORD_HEAD.size
        at = begin + length
        if at > len(data):
            raise ValueError("a record is longer than what holds it")
        yield opcode, begin, at


def _places(stream: BinaryIO, wanted: bytes, position: int) -> Iterator[int]:
    """Yield each place from a position on at which these bytes are."""
    while block := _read(stream, position, BLOCK_BYTES):
        at = block.find(wanted)
        while at >= 0:
            yield position + at
            at = block.find(wanted, at + 1)
        if len(block) < len(wanted):
            return
        position += len(block) - len(wanted) + 1


def read_log(path: Path) -> Iterator[Logged]:
    """Yield the messages of a log in the order of writing, up to where it breaks off.

    `airhilt.record.open_run` reads a damaged log too, and the rest of its run.

    Raises
    ------
    RunFolderError
        The file cannot be read, is no MCAP file, or messages are missing in it.
    """
    reader = LogReader(path)
    for logged in reader.messages():
        if reader.gaps:
            break
        yield logged
    if reader.gaps:
        raise RunFolderError(f"{path}: {gaps_text(reader.gaps)}")


def gaps_text(gaps: Sequence[Gap]) -> str:
    """Return in words from when to when messages are missing, and how many."""
    spans = [_span(gap) for gap in gaps]
    if len(gaps) > MOST_GAPS:
        whole = _span(Gap(gaps[0].begin_ns, gaps[-1].end_ns, None))
        spans = [f"in {len(gaps)} places {whole}"]
    counts = [gap.messages for gap in gaps]
    known = sum(count for count in counts if count is not None)
    if None in counts:
        lost = f"{known} messages and those at its end are" if known else "messages are"
    else:
        lost = "1 message is" if known == 1 else f"{known} messages are"
    return f"damaged {' and '.join(spans)}: {lost} missing"


def _span(gap: Gap) -> str:
    begin = f"from {gap.begin_ns / SECOND_NS:.3f} s"
    return (
        f"{begin} to its end"
        if gap.end_ns is None
        else f"{begin} to {gap.end_ns / SECOND_NS:.3f} s"
    )
