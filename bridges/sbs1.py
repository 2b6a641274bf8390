"""Gives out the ADS-B reports of a run as an SBS-1 "BaseStation" feed.

    python bridges/sbs1.py --connect tcp/127.0.0.1:7447 --port 30003

Each report becomes a line for each type of transmission that would carry it: MSG,1 has the
callsign, MSG,2 position and speed on the ground, MSG,3 position and altitude in the air, MSG,4 the
velocity, MSG,6 the squawk. Times are those of the run, as if its first report came now. The feed
ends with the run.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from datetime import datetime

from airhilt.bus.bridge import WallClock, serve_reports
from airhilt.messages import AdsbReport
from airhilt.surveillance.transponders import EMERGENCY_CODES
from airhilt.world.tracks.sbs import AIRBORNE, CALLSIGN, FIELDS, SQUAWK, SURFACE, VELOCITY


def lines(report: AdsbReport, when: datetime) -> Iterator[str]:
    """Yield the lines of a report, without their ends; a line has the fields of its type alone.

    A flag is -1 if it is set. The alert flag says that the squawk is that of an emergency.
    """
    place = {14: _degrees(report.latitude_deg), 15: _degrees(report.longitude_deg)}
    motion = {12: str(round(report.ground_speed_kt)), 13: str(round(report.track_deg) % 360)}
    altitude = {} if report.altitude_ft is None else {11: str(round(report.altitude_ft))}
    flags = {
        18: _flag(report.squawk in EMERGENCY_CODES),
        19: _flag(report.emergency != "none"),
        20: _flag(is_set=False),
        21: _flag(report.on_ground),
    }
    if report.callsign is not None:
        yield _line(CALLSIGN, report, when, {10: report.callsign})
    if report.squawk is not None:
        yield _line(SQUAWK, report, when, altitude | {17: report.squawk} | flags)
    if report.on_ground:
        yield _line(SURFACE, report, when, motion | place | {21: flags[21]})
    else:
        rate = {16: str(round(report.vertical_rate_fpm))}
        yield _line(VELOCITY, report, when, motion | rate)
        yield _line(AIRBORNE, report, when, altitude | place | flags)


def _line(kind: str, report: AdsbReport, when: datetime, cells: Mapping[int, str]) -> str:
    """Return a line of a type, with cells by their places from 0."""
    date, clock = when.strftime("%Y/%m/%d"), when.strftime("%H:%M:%S.%f")[:-3]
    head = ["MSG", kind, "1", "1", report.icao24.upper(), "1", date, clock, date, clock]
    return ",".join([*head, *(cells.get(place, "") for place in range(len(head), FIELDS))])


def _degrees(angle_deg: float) -> str:
    return f"{round(angle_deg, 5) + 0.0:.5f}"  # Adding 0 leaves no -0.


def _flag(is_set: bool) -> str:
    return "-1" if is_set else "0"


def main() -> None:
    """Run the bridge until the run is over."""
    times = WallClock()

    def encode(report: AdsbReport) -> bytes:
        when = times.at(report.t_adsb_out_ns)
        return "".join(f"{line}\r\n" for line in lines(report, when)).encode()

    serve_reports(__doc__, 30003, encode)


if __name__ == "__main__":
    main()
