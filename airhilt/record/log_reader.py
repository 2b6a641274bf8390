"""Reads ``log.mcap``: every message whose checksum is right, and where others are missing.

Chunks (https://mcap.dev/spec) are found by their content, so that a damaged one costs no other.
Messages are numbered from 1 on, so that none is missing without being noticed.
"""

from __future__ import annotations

import mmap
import struct
import zlib
from collections.abc import Iterator, Sequence
from contextlib import suppress
from io import BytesIO
from pathlib import Path
from typing import IO, NamedTuple, cast

import zstandard
from mcap.data_stream import ReadDataStream
from mcap.exceptions import EndOfFile, McapError
from mcap.opcode import Opcode
from mcap.records import Channel, DataEnd, Footer, McapRecord, Message, MessageIndex, Statistics
from mcap.stream_reader import StreamReader

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
COMPRESSION = struct.pack("<I4s", 4, b"zstd")
"""Bytes that every chunk has, and by which it is found."""
LENGTH_BYTES = 8
"""Size of the length of a record, in front of its content."""
CHUNK_HEAD = struct.Struct("<16xQI8xQ")
"""Size and CRC-32 of the records of a chunk, and their size as they are compressed behind it."""
BEFORE_COMPRESSION = 28
"""Size of the fields of a chunk before its compression."""
FOOTER_BYTES = 20 + len(MAGIC)
"""Size of the content of the footer, and of the magic bytes behind it."""
LARGEST_CHUNK_BYTES = 1 << 28
"""Greatest size of the records in a chunk, in bytes: a larger one is damaged."""
MOST_EXPANSION = 1000
"""Number of bytes that are expanded in vain for each byte of a log, before reading ends; each
record counts as so many."""
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


class LogReader:
    """Reads one log, which may still be written, from its beginning to where it ends."""

    def __init__(self, path: Path) -> None:
        self.path = path
        self.gaps: list[Gap] = []
        """Places at which messages are missing, as far as the log has been read."""
        self.end_ns = 0
        """Time of the last message that was read."""
        self.is_closed = False
        """True if the log has its end: it neither breaks off nor goes on."""
        self._last = 0
        """Number of the last message that was read."""
        self._nameless = 0
        """Number of the last message whose channel is in a damaged chunk."""
        self._channels: dict[int, Channel] = {}
        self._left_bytes = 0
        """Number of bytes that may be expanded in vain before reading ends."""

    def messages(self) -> Iterator[Logged]:
        """Yield the messages in the order of writing; what cannot be read is left out.

        It raises `RunFolderError` if the file cannot be read, or is no log.
        """
        with self._content() as content:
            yield from self._messages(content)
            is_empty = self._last == 0 and not self.gaps and not self.is_closed
            if is_empty and content[: len(MAGIC)] != MAGIC:
                raise self._no_log()

    def is_faultless(self) -> bool:
        """Return whether no message is missing, and every checksum of the log is right."""
        try:
            with self._content() as content:
                for _ in _records(content, validate_crcs=True):
                    pass
                return _index(content) is not None and not self.gaps
        except (RunFolderError, *BROKEN):
            return False

    def _content(self) -> mmap.mmap:
        try:
            with open_inside(self.path.parent, self.path) as stream:
                return mmap.mmap(stream.fileno(), 0, access=mmap.ACCESS_READ)
        except OSError as error:
            raise RunFolderError(f"{self.path}: cannot be read: {error.strerror}") from None
        except ValueError:  # An empty file cannot be mapped.
            raise self._no_log() from None

    def _no_log(self) -> RunFolderError:
        return RunFolderError(f"{self.path}: not an MCAP log: it has not the magic bytes")

    def _messages(self, content: mmap.mmap) -> Iterator[Logged]:
        index = _index(content)
        self._channels, total = index or ({}, 0)
        self._left_bytes = LARGEST_CHUNK_BYTES + MOST_EXPANSION * len(content)
        is_end_damaged, place, end = False, 0, len(MAGIC)
        while self._left_bytes >= 0 and (place := content.find(COMPRESSION, place + 1)) >= 0:
            size = 0
            try:
                end_of_it, size, crc = _chunk_head(content, place)
                records = _expanded(content, place, end_of_it, size, crc)
            except EndOfFile:
                continue  # Whoever wrote it was killed, or is still writing.
            except BROKEN:
                is_end_damaged, self._left_bytes = True, self._left_bytes - size
                continue
            is_end_damaged, end, place = False, end_of_it, end_of_it - 1
            try:
                yield from self._of_chunk(records)
            except BROKEN:
                is_end_damaged = True
        if self._left_bytes < 0:
            self.gaps.append(Gap(self.end_ns, None, None))
            return
        self.is_closed = index is not None or _is_end_of_data(content, end)
        total = self._nameless if index is None else total
        if is_end_damaged and not self.is_closed:
            self.gaps.append(Gap(self.end_ns, None, None))
        elif total > self._last:
            self.gaps.append(Gap(self.end_ns, None, total - self._last))

    def _of_chunk(self, records: bytes) -> Iterator[Logged]:
        """Yield the messages among the records of a chunk, as far as these may be handled."""
        stream = ReadDataStream(BytesIO(records))
        while (begin := stream.count) < len(records) and self._left_bytes >= 0:
            opcode, length = stream.read1(), stream.read8()
            self._left_bytes -= MOST_EXPANSION
            if opcode == Opcode.MESSAGE:
                message = Message.read(stream, length)
                if message.sequence > self._last:
                    if (channel := self._channels.get(message.channel_id)) is not None:
                        yield self._logged(message, channel)
                        continue
                    self._nameless = message.sequence
            elif opcode == Opcode.CHANNEL:
                channel = Channel.read(stream)
                self._channels[channel.id] = channel
            else:
                stream.read(length)
            self._left_bytes -= stream.count - begin

    def _logged(self, message: Message, channel: Channel) -> Logged:
        """Return a message, and keep the gap before it if there is one."""
        t_ns, number = message.log_time, message.sequence
        if number > self._last + 1:
            self.gaps.append(Gap(self.end_ns, t_ns, number - self._last - 1))
        self._last = number
        self.end_ns = max(t_ns, self.end_ns)
        publisher = channel.metadata.get("publisher", "")
        return Logged(channel.topic, publisher, t_ns, message.data, number)


def _records(content: mmap.mmap, **options: bool) -> Iterator[McapRecord]:
    """Yield the records from where the content has been read to, chunks as a whole."""
    return StreamReader(cast(IO[bytes], content), emit_chunks=True, **options).records


def _chunk_head(content: mmap.mmap, place: int) -> tuple[int, int, int]:
    """Return where the chunk ends whose compression is named at a place, and two of its fields.

    These are the size and the CRC-32 of its records. It raises EndOfFile if the file ends before
    it, and others of `BROKEN` if it is damaged. Nothing of it is copied: broken chunks may lie
    within each other.
    """
    begin = place - BEFORE_COMPRESSION
    if begin < LENGTH_BYTES:
        raise ValueError("no chunk")
    (length,) = struct.unpack_from("<Q", content, begin - LENGTH_BYTES)
    end = begin + length
    if end > len(content):
        raise EndOfFile
    size, crc, compressed = CHUNK_HEAD.unpack_from(content, begin)
    if length != CHUNK_HEAD.size + compressed or max(length, size) > LARGEST_CHUNK_BYTES:
        raise ValueError("no chunk, or too large")
    return end, size, crc


def _expanded(content: mmap.mmap, place: int, end: int, size: int, crc: int) -> bytes:
    """Return the records of a chunk by its head; it raises one of `BROKEN` if it is damaged."""
    begin = place - BEFORE_COMPRESSION + CHUNK_HEAD.size
    with memoryview(content) as whole, whole[begin:end] as part:
        if zstandard.frame_content_size(part) != size:
            raise ValueError("not what the head says")
        records = zstandard.decompress(part)
    if zlib.crc32(records) != crc:
        raise ValueError("not what the checksum says")
    return records


def _index(content: mmap.mmap) -> tuple[dict[int, Channel], int] | None:
    """Return the channels and the number of messages by the end of a log.

    It is None if that is not there or damaged. Chunks in it are not expanded.
    """
    channels: dict[int, Channel] = {}
    messages = 0
    try:
        footer = Footer.read(ReadDataStream(BytesIO(content[-FOOTER_BYTES:])))
        with memoryview(content) as whole, whole[footer.summary_start : -4 - len(MAGIC)] as part:
            if zlib.crc32(part) != footer.summary_crc:
                return None
        content.seek(footer.summary_start)
        for record in _records(content, skip_magic=True):
            if isinstance(record, Channel):
                channels[record.id] = record
            elif isinstance(record, Statistics):
                messages = record.message_count
            elif isinstance(record, Footer):
                break
    except BROKEN:
        return None
    return channels, messages


def _is_end_of_data(content: mmap.mmap, end: int) -> bool:
    """Return whether the end of the data follows a chunk, behind indexes of messages."""
    with suppress(*BROKEN):
        content.seek(end)
        for record in _records(content, skip_magic=True):
            if not isinstance(record, MessageIndex):
                return isinstance(record, DataEnd)
    return False


def read_log(path: Path) -> Iterator[Logged]:
    """Yield the messages of a log in the order of writing, up to where it breaks off.

    It raises `RunFolderError` if the file cannot be read or messages are missing in it.
    `airhilt.record.open_run` reads a damaged log too.
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
    end = "its end" if gap.end_ns is None else f"{gap.end_ns / SECOND_NS:.3f} s"
    return f"from {gap.begin_ns / SECOND_NS:.3f} s to {end}"
