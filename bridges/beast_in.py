"""Gives the targets of a real receiver to a run as further ADS-B traffic, from its Beast feed.

    pip install airhilt[decoders]
    python bridges/beast_in.py --connect tcp/127.0.0.1:7447 --from 192.168.1.20 --port 30005

pyModeS decodes the frames. Each position becomes a report at the time at which it comes, with the
velocity, the identification, the emergency and the accuracy that the aircraft last sent. Aircraft
on the ground are left out. The bridge connects again whenever the receiver goes, and ends with the
run.
"""

from __future__ import annotations

import re
import sys
import time
from collections.abc import Iterator

from airhilt.bus.bridge import feed_reports, tell
from airhilt.messages import LiveReport
from airhilt.world.tracks.mode_s import FrameDecoder
from airhilt.world.tracks.record import TracksError
from airhilt.world.tracks.reports import report_of

ESCAPE = b"\x1a"
PACKET = re.compile(rb"\x1a(?P<kind>[\x00-\x19\x1b-\xff])(?P<content>(?:[^\x1a]|\x1a\x1a)*)", re.S)
"""A packet: the escape, its type, and its content, in which an escape is doubled."""
LONG = b"3"
"""Type of a packet with a long frame of Mode S, as ADS-B has it."""
CLOCK_AND_LEVEL = 7
"""Bytes of the clock and of the signal level before the frame."""
LONG_BYTES = 14
KINDS = b"1234"
"""Types of packets: Mode A/C, a short frame, a long frame, and the state of the receiver."""
LONGEST_BYTES = 2 + 2 * (CLOCK_AND_LEVEL + LONG_BYTES)
"""Size of the longest packet, with every byte of its content escaped."""
STRANGE_BYTES = 10_000
"""Bytes without a packet after which a feed cannot be one of Beast."""


class BeastFeed:
    """Makes reports of the bytes of a feed; a packet may come in several pieces."""

    def __init__(self) -> None:
        self._rest = b""
        self._strange_bytes = 0
        self._decoder = FrameDecoder()

    def frames(self, data: bytes) -> Iterator[bytes]:
        """Yield the long frames in the next bytes.

        A packet ends where the next one begins, or with its last byte.
        """
        self._rest += data
        self._check(data)
        end = 0
        for packet in PACKET.finditer(self._rest):
            content = packet["content"].replace(ESCAPE * 2, ESCAPE)
            is_whole = len(content) >= CLOCK_AND_LEVEL + LONG_BYTES
            if packet.end() == len(self._rest) and not is_whole:
                break
            end = packet.end()
            if packet["kind"] in KINDS:
                self._strange_bytes = 0
            if packet["kind"] == LONG and is_whole:
                yield content[CLOCK_AND_LEVEL : CLOCK_AND_LEVEL + LONG_BYTES]
        self._rest = self._rest[end:][-LONGEST_BYTES:]

    def _check(self, data: bytes) -> None:
        """Tell once if the bytes so far cannot be those of a Beast receiver."""
        before = self._strange_bytes
        self._strange_bytes += len(data)
        if before <= STRANGE_BYTES < self._strange_bytes:
            tell(
                f"no Beast feed: no packet in {STRANGE_BYTES} bytes; expected Beast binary, as "
                "port 30005 of receivers gives it out (bridges/sbs_in.py reads SBS-1)"
            )

    def reports(self, data: bytes) -> Iterator[LiveReport]:
        """Yield the reports in the next bytes."""
        for frame in self.frames(data):
            row = self._decoder.row(frame.hex(), time.monotonic())
            report = None if row is None else report_of(row)
            if report is not None:
                yield report


def main() -> None:
    """Run the bridge until the run is over."""
    try:
        feed = BeastFeed()
    except TracksError as error:
        sys.stderr.write(f"error: {error}\n")
        sys.exit(error.exit_code)
    feed_reports(__doc__, 30005, feed.reports)


if __name__ == "__main__":
    main()
