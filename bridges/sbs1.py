"""Gives out the ADS-B reports of a run as an SBS-1 "BaseStation" feed.

    python bridges/sbs1.py --connect tcp/127.0.0.1:7447 --port 30003

Each report becomes one line, of type MSG,3 in the air and MSG,2 on the ground. Times are those of
the run, as if its first report came now. The feed listens on the loopback address and ends with the
run.
"""

from __future__ import annotations

from datetime import datetime

from airhilt.bus.bridge import WallClock, serve_reports
from airhilt.messages import AdsbReport
from airhilt.surveillance.transponders import EMERGENCY_CODES


def line(report: AdsbReport, when: datetime) -> str:
    """Return a report as one line of the feed (without its end).

    Type 3 is an airborne position, type 2 a surface position, which has no altitude. A flag is -1
    if it is set. The alert flag says that the squawk is that of an emergency.
    """
    date, clock = when.strftime("%Y/%m/%d"), when.strftime("%H:%M:%S.%f")[:-3]
    altitude = "" if report.altitude_ft is None else str(round(report.altitude_ft))
    return ",".join(
        [
            "MSG", "2" if report.on_ground else "3", "1", "1", report.icao24.upper(), "1",
            date, clock, date, clock, report.callsign or "", altitude,
            str(round(report.ground_speed_kt)), str(round(report.track_deg) % 360),
            _degrees(report.latitude_deg), _degrees(report.longitude_deg),
            str(round(report.vertical_rate_fpm)), report.squawk or "",
            _flag(report.squawk in EMERGENCY_CODES), _flag(report.emergency != "none"), "0",
            _flag(report.on_ground),
        ]
    )  # fmt: skip


def _degrees(angle_deg: float) -> str:
    return f"{round(angle_deg, 5) + 0.0:.5f}"  # Adding 0 leaves no -0.


def _flag(is_set: bool) -> str:
    return "-1" if is_set else "0"


def main() -> None:
    """Run the bridge until the run is over."""
    times = WallClock()

    def encode(report: AdsbReport) -> bytes:
        return f"{line(report, times.at(report.t_adsb_out_ns))}\r\n".encode()

    serve_reports(__doc__, 30003, encode)


if __name__ == "__main__":
    main()
