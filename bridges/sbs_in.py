"""Gives the targets of a real receiver to a run as further ADS-B traffic, from its SBS-1 feed.

    python bridges/sbs_in.py --connect tcp/127.0.0.1:7447 --from 192.168.1.20 --port 30003

Each line with a position becomes a report at the time at which it comes; one that cannot be read is
left out. The feed tells no accuracy: NIC, NACp, NACv and SIL are 0, unknown. The bridge connects
again whenever the receiver goes, and ends with the run.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import suppress

from airhilt.bus.bridge import feed_reports
from airhilt.messages import LiveReport
from airhilt.world.tracks.reports import report_of
from airhilt.world.tracks.sbs import SbsLines

LONGEST_LINE = 1000
"""Bytes of a line that are kept until it ends."""


class SbsFeed:
    """Makes reports of the bytes of a feed; a line may come in several pieces."""

    def __init__(self) -> None:
        self._rest = b""
        self._lines = SbsLines()

    def reports(self, data: bytes) -> Iterator[LiveReport]:
        """Yield the reports in the next bytes."""
        *lines, rest = (self._rest + data).split(b"\n")
        self._rest = rest[:LONGEST_LINE]
        for line in lines:
            with suppress(ValueError):
                row = self._lines.row(line.decode(errors="replace").strip())
                report = None if row is None else report_of({**row, "t_s": 0.0})
                if report is not None:
                    yield report


def main() -> None:
    """Run the bridge until the run is over."""
    feed_reports(__doc__, 30003, SbsFeed().reports)


if __name__ == "__main__":
    main()
