"""Gives out the ADS-B reports of a run as Mode S frames in Beast's binary format.

    python bridges/beast.py --connect tcp/127.0.0.1:7447 --port 30005

Each report becomes the frames that a receiver at 1090 MHz would have heard: extended squitters,
acquisition squitters and replies to a radar. A program that listens itself, as dump1090 does on
port 30004, is served with ``--to 127.0.0.1:30004``. The bridge ends with the run.
"""

from __future__ import annotations

from airhilt.bus.bridge import serve_reports
from airhilt.messages import AdsbReport
from airhilt.surveillance.mode_s_frames import FrameSource

ESCAPE = b"\x1a"
TICKS_PER_US = 12
"""Ticks of a Beast receiver's clock in a microsecond."""
SIGNAL_LEVEL = 0x80
"""Strength of every frame, of 255: AIRHILT does not model it."""


def packet(frame: bytes, t_ns: int) -> bytes:
    """Return a frame heard at a time as Beast sends it: a short one of type 2, a long one 3."""
    ticks = t_ns * TICKS_PER_US // 1000 % 2**48
    content = ticks.to_bytes(6) + bytes([SIGNAL_LEVEL]) + frame
    kind = b"2" if len(frame) == 7 else b"3"
    return ESCAPE + kind + content.replace(ESCAPE, ESCAPE * 2)


def main() -> None:
    """Run the bridge until the run is over."""
    source = FrameSource()

    def encode(report: AdsbReport) -> bytes:
        return b"".join(packet(frame, report.t_adsb_in_ns) for frame in source.frames(report))

    serve_reports(__doc__, 30005, encode)


if __name__ == "__main__":
    main()
