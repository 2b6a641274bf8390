"""Gives out the ADS-B reports of a run as Mode S frames in the text format AVR ("raw").

    python bridges/avr.py --connect tcp/127.0.0.1:7447 --port 30002

Each report becomes the frames that a receiver at 1090 MHz would have heard, a line each: ``*``, the
frame in hexadecimal, and ``;``. A program that listens itself, as dump1090 does on port 30001, is
served with ``--to 127.0.0.1:30001``. The bridge ends with the run.
"""

from __future__ import annotations

from airhilt.bus.bridge import serve_reports
from airhilt.messages import AdsbReport
from airhilt.surveillance.mode_s_frames import FrameSource


def line(frame: bytes) -> str:
    """Return a frame as a line, without its end."""
    return f"*{frame.hex().upper()};"


def main() -> None:
    """Run the bridge until the run is over."""
    source = FrameSource()

    def encode(report: AdsbReport) -> bytes:
        return "".join(f"{line(frame)}\n" for frame in source.frames(report)).encode()

    serve_reports(__doc__, 30002, encode)


if __name__ == "__main__":
    main()
