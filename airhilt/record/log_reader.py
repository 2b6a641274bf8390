"""Reads ``log.mcap``: every message whose checksum is right, and where others are missing.

A log is a row of chunks (https://mcap.dev/spec), as `LogWriter` writes them. Each has a CRC-32 of
its records, and each message has a number, so that nothing is missing without being noticed. Chunks
are found by their content, so that a damaged one costs no other.
"""

from __future__ import annotations

import io
import struct
import zlib
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import BinaryIO, NamedTuple

import zstandard
from mcap.data_stream import ReadDataStream
from mcap.exceptions import McapError
from mcap.opcode import Opcode
from mcap.records import Channel, Chunk, Footer, Message, Statistics
from mcap.stream_reader import StreamReader, get_chunk_data_stream

from airhilt.errors import RunFolderError
from airhilt.host.files import open_inside
from airhilt.units import SECOND_NS

BROKEN = (
    McapError,
    struct.error,
    zstandard.ZstdError,
    ValueError,
    LookupError,
    OverflowError,
    MemoryError,
)
"""Exceptions of bytes that are not what they should be."""
MAGIC = b"\x89MCAP0\r\n"
"""Bytes with which a log begins and ends."""
RECORD_HEAD = struct.Struct("<BQ")
"""Opcode of a record, and the length of its content."""
TAIL_BYTES = RECORD_HEAD.size + 20 + len(MAGIC)
"""Size of the footer, which is the last record, and of the magic bytes."""
CHUNK_HEAD_BYTES = 44
"""Size of the fields of a chunk before its compressed records."""
COMPRESSION = struct.pack("<I4s", 4, b"zstd")
"""Bytes that every chunk has, and by which it is found."""
COMPRESSION_AT = RECORD_HEAD.size + 28
"""Place of these bytes, from where a chunk begins."""
LARGEST_CHUNK_BYTES = 1 << 28
"""Greatest size of a chunk, and of the records in it, in bytes: a larger one is damaged."""
LARGEST_INDEX_BYTES = 1 << 28
"""Greatest size of the end of a log that repeats what is in it, in bytes."""
MOST_EXPANSION = 1000
"""Number of bytes that are expanded in vain for each byte of a log, before reading ends."""
BLOCK_BYTES = 1 << 20
"""Number of bytes that are read at a time where the whole file is gone through."""
MOST_GAPS = 3
"""Number of gaps that are told one by one."""


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


class _Index(NamedTuple):
    """What the end of a log repeats of it."""

    channels: dict[int, Channel]
    messages: int
    """Number of messages in the log."""


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
    """

    def __init__(self, path: Path) -> None:
        self.path = path
        self.gaps: list[Gap] = []
        self.end_ns = 0
        self.is_closed = False
        self._channels: dict[int, Channel] = {}
        self._last = 0
        """Number of the last message that was read."""
        self._nameless = 0
        """Number of the last message whose channel is in a damaged chunk."""
        self._end = len(MAGIC)
        """Place at which the last chunk that was read ends."""
        self._is_end_damaged = False
        """True if a damaged chunk follows the last one that was read."""

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

    def is_faultless(self) -> bool:
        """Return whether no message is missing, and every checksum of the log is right."""
        try:
            with open_inside(self.path.parent, self.path) as stream:
                index = _index(stream, stream.seek(0, io.SEEK_END))
                stream.seek(0)
                for _ in StreamReader(stream, emit_chunks=True, validate_crcs=True).records:
                    pass
        except (OSError, *BROKEN):
            return False
        return index is not None and not self.gaps

    def _messages(self, stream: BinaryIO) -> Iterator[Logged]:
        size = stream.seek(0, io.SEEK_END)
        index = _index(stream, size)
        if index is not None:
            self._channels = index.channels
        for records, length in self._chunks(stream, size):
            yield from self._of_chunk(records, length)
        self.is_closed = index is not None or _is_end_of_data(stream, size, self._end)
        total = self._nameless if index is None else index.messages
        if self._is_end_damaged and not self.is_closed:
            self.gaps.append(Gap(self.end_ns, None, None))
        elif total > self._last:
            self.gaps.append(Gap(self.end_ns, None, total - self._last))
        is_empty = self._last == 0 and not self.gaps and not self.is_closed
        if is_empty and _read(stream, 0, len(MAGIC)) != MAGIC:
            raise RunFolderError(f"{self.path}: not an MCAP log: it has not the magic bytes")

    def _of_chunk(self, records: ReadDataStream, size: int) -> Iterator[Logged]:
        """Yield the messages among the records of a chunk.

        Raises
        ------
        RunFolderError
            Its checksum is right, and its content is none of AIRHILT.
        """
        try:
            while records.count < size:
                opcode, length = records.read1(), records.read8()
                if opcode == Opcode.CHANNEL:
                    channel = Channel.read(records)
                    self._channels[channel.id] = channel
                elif opcode == Opcode.MESSAGE:
                    message = Message.read(records, length)
                    if message.sequence <= self._last:
                        continue  # Its chunk is there twice, or out of order.
                    known = self._channels.get(message.channel_id)
                    if known is None:
                        self._nameless = message.sequence
                        continue
                    self._count(message)
                    publisher = known.metadata.get("publisher", "")
                    yield Logged(
                        known.topic, publisher, message.log_time, message.data, message.sequence
                    )
                else:
                    records.read(length)
        except BROKEN as error:
            raise RunFolderError(f"{self.path}: not a log of AIRHILT: {error}") from None

    def _count(self, message: Message) -> None:
        """Take in the number of a message, and keep the gap before it if there is one."""
        if message.sequence > self._last + 1:
            self.gaps.append(Gap(self.end_ns, message.log_time, message.sequence - self._last - 1))
        self._last = message.sequence
        self.end_ns = max(message.log_time, self.end_ns)

    def _chunks(self, stream: BinaryIO, size: int) -> Iterator[tuple[ReadDataStream, int]]:
        """Yield the records of each chunk whose checksum is right, and their size.

        Chunks that are broken may lie within each other, so that what is expanded in vain counts:
        without a limit a small log could hold its reader for hours.
        """
        left_bytes = LARGEST_CHUNK_BYTES + MOST_EXPANSION * size
        for place in _places(stream, COMPRESSION):
            begin = place - COMPRESSION_AT
            if begin < self._end:
                continue
            opcode, length = RECORD_HEAD.unpack(_read(stream, begin, RECORD_HEAD.size))
            end = begin + RECORD_HEAD.size + length
            if end > size:
                continue  # Whoever wrote it was killed, or is still writing.
            wasted_bytes = length
            try:
                chunk = _chunk(stream, opcode, length)
                wasted_bytes += chunk.uncompressed_size
                records = get_chunk_data_stream(chunk, validate_crc=True)
            except BROKEN:
                left_bytes -= wasted_bytes
                self._is_end_damaged = True
                if left_bytes < 0:
                    break
                continue
            self._is_end_damaged = False
            self._end = end
            yield records


def _chunk(stream: BinaryIO, opcode: int, length: int) -> Chunk:
    """Return the chunk whose head has been read.

    Raises
    ------
    ValueError
        It is none, or too large.
    """
    if opcode != Opcode.CHUNK or length > LARGEST_CHUNK_BYTES:
        raise ValueError("no chunk")
    chunk: Chunk = Chunk.read(ReadDataStream(io.BytesIO(stream.read(length))))
    if length != CHUNK_HEAD_BYTES + len(chunk.data):
        raise ValueError("no chunk")
    size = zstandard.frame_content_size(chunk.data)
    if size != chunk.uncompressed_size or size > LARGEST_CHUNK_BYTES:
        raise ValueError("no chunk")
    return chunk


def _index(stream: BinaryIO, size: int) -> _Index | None:
    """Return what the end of a log repeats, None if it is not there or damaged."""
    tail = _read(stream, max(size - TAIL_BYTES, 0), TAIL_BYTES)
    index = _Index({}, 0)
    try:
        footer = Footer.read(ReadDataStream(io.BytesIO(tail[RECORD_HEAD.size :])))
        if not 0 < size - footer.summary_start <= LARGEST_INDEX_BYTES:
            return None
        summary = _read(stream, footer.summary_start, size - footer.summary_start)
        if zlib.crc32(summary[: -4 - len(MAGIC)]) != footer.summary_crc:
            return None
        for record in StreamReader(io.BytesIO(summary), skip_magic=True).records:
            if isinstance(record, Channel):
                index.channels[record.id] = record
            elif isinstance(record, Statistics):
                index = index._replace(messages=record.message_count)
    except BROKEN:
        return None
    return index


def _is_end_of_data(stream: BinaryIO, size: int, position: int) -> bool:
    """Return whether the record after the last chunk follows, behind indexes of messages."""
    while position + RECORD_HEAD.size <= size:
        opcode, length = RECORD_HEAD.unpack(_read(stream, position, RECORD_HEAD.size))
        if opcode != Opcode.MESSAGE_INDEX:
            return (opcode, length) == (Opcode.DATA_END, 4)
        position += RECORD_HEAD.size + length
    return False


def _read(stream: BinaryIO, position: int, size: int) -> bytes:
    stream.seek(position)
    return stream.read(size)


def _places(stream: BinaryIO, wanted: bytes) -> Iterator[int]:
    """Yield each place at which these bytes are."""
    position = 0
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
