"""Raw Mode S frames in text lines, each with a time.

A line is ``@``, 12 hexadecimal digits of a clock of 12 MHz, a frame and ``;``, as ``dump1090
--mlat`` gives out; or a time in s, a comma, a semicolon or a space, and a frame.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path

from airhilt.host.files import read_file
from airhilt.world.tracks.mode_s import FrameDecoder
from airhilt.world.tracks.record import MOST_BYTES, Format, Row, TracksError

CLOCK_HZ = 12e6
"""Rate of the clock of receivers that stamp AVR lines, in Hz."""
STAMPED = re.compile(r"@([0-9A-Fa-f]{12})([0-9A-Fa-f]{14}|[0-9A-Fa-f]{28});")
TIMED = re.compile(r"([0-9]+(?:\.[0-9]+)?)[,;\s]+\*?([0-9A-Fa-f]{14}|[0-9A-Fa-f]{28});?")


def _matches(path: Path, head: bytes) -> bool:  # noqa: ARG001
    line = head.split(b"\n", 1)[0].decode(errors="replace").strip()
    return line[:1] in ("*", "@") or TIMED.fullmatch(line) is not None


def timed_frame(line: str) -> tuple[float, str] | None:
    """Return the time in s and the frame of a line; None if it is no line with both."""
    if (stamped := STAMPED.fullmatch(line)) is not None:
        return int(stamped[1], 16) / CLOCK_HZ, stamped[2]
    if (timed := TIMED.fullmatch(line)) is not None:
        return float(timed[1]), timed[2]
    return None


def _read(path: Path) -> Iterator[tuple[str, Row]]:
    decoder = FrameDecoder()
    text = read_file(path, MOST_BYTES).decode(errors="replace")
    for number, line in enumerate(text.splitlines(), 1):
        if not line.strip():
            continue
        frame = timed_frame(line.strip())
        if frame is None:
            raise TracksError(
                f"{path}: line {number}: no frame with a time; expected @, 12 hexadecimal digits "
                "of a 12 MHz clock, the frame and ; (dump1090 --mlat), or a time in s and the frame"
            )
        row = decoder.row(frame[1], frame[0])
        if row is not None:
            yield f"line {number}", row


FORMAT = Format(
    "avr",
    "raw Mode S frames in text lines with times",
    _matches,
    _read,
    {
        "t_s": "time",
        "latitude_deg": "position",
        "longitude_deg": "position",
        "altitude_ft": "altitude",
        "ground_speed_kt": "velocity",
    },
)
