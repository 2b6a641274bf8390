"""Records of flights, and the files in which receivers and archives would have them."""

from __future__ import annotations

import csv
import json
import math
from collections.abc import Callable, Iterator, Sequence
from datetime import UTC, datetime
from pathlib import Path
from typing import NamedTuple

import pandas as pd

from airhilt.geodesy.wgs84 import onward
from airhilt.messages import AdsbReport
from airhilt.surveillance.mode_s_frames import FrameSource
from airhilt.units import DEGREE, FOOT, KNOT, SECOND_NS

BEGIN_S = 1_700_000_000.0
"""Time of the first position, in s since 1970."""
ADDRESS, CALLSIGN = "3c6444", "DLH9X"


class Position(NamedTuple):
    """Position of a flight, as an aircraft sends it."""

    t_s: float
    latitude_deg: float
    longitude_deg: float
    altitude_ft: float
    ground_speed_kt: float
    track_deg: float


def turning_climb(length_s: float = 120.0, step_s: float = 1.0) -> list[Position]:
    """Return a climb at 440 kt that turns to the right by a degree a second for half a minute."""
    place, track_deg, found = (47.0 * DEGREE, 8.0 * DEGREE), 60.0, []
    for step in range(round(length_s / step_s) + 1):
        t_s = step * step_s
        latitude, longitude = (angle / DEGREE for angle in place)
        altitude_ft = 25.0 * round((20_000.0 + 20.0 * t_s) / 25.0)
        found.append(
            Position(t_s, round(latitude, 6), round(longitude, 6), altitude_ft, 440.0, track_deg)
        )
        turned = step_s if 40.0 <= t_s < 70.0 else 0.0
        place = onward(place, (track_deg + turned / 2.0) * DEGREE, 440.0 * KNOT * step_s)
        track_deg += turned
    return found


def write_readsb(path: Path, flight: Sequence[Position]) -> None:
    details = {"flight": f"{CALLSIGN}  ", "squawk": "1000", "category": "A3"}
    trace = [
        [t_s, lat, lon, feet, kt, track, 0, 0, details if t_s == 0.0 else None]
        for t_s, lat, lon, feet, kt, track in flight
    ]
    document = {"icao": ADDRESS, "t": "B737", "timestamp": BEGIN_S, "trace": trace}
    path.write_text(json.dumps(document))


def states(flight: Sequence[Position]) -> pd.DataFrame:
    return pd.DataFrame(
        {
            "time": [math.floor(BEGIN_S + each.t_s) for each in flight],
            "icao24": ADDRESS,
            "lat": [each.latitude_deg for each in flight],
            "lon": [each.longitude_deg for each in flight],
            "velocity": [each.ground_speed_kt * KNOT for each in flight],
            "heading": [each.track_deg for each in flight],
            "callsign": CALLSIGN,
            "onground": False,
            "squawk": "1000",
            "baroaltitude": [each.altitude_ft * FOOT for each in flight],
            "lastposupdate": [BEGIN_S + each.t_s for each in flight],
        }
    )


def frame(flight: Sequence[Position]) -> pd.DataFrame:
    return pd.DataFrame(
        {
            "timestamp": [pd.Timestamp(BEGIN_S + each.t_s, unit="s", tz="UTC") for each in flight],
            "icao24": ADDRESS,
            "callsign": CALLSIGN,
            "latitude": [each.latitude_deg for each in flight],
            "longitude": [each.longitude_deg for each in flight],
            "altitude": [each.altitude_ft for each in flight],
            "groundspeed": [each.ground_speed_kt for each in flight],
            "squawk": "1000",
        }
    )


def sbs_lines(flight: Sequence[Position]) -> Iterator[str]:
    for each in flight:
        when = datetime.fromtimestamp(BEGIN_S + each.t_s, UTC)
        date, clock = when.strftime("%Y/%m/%d"), when.strftime("%H:%M:%S.%f")[:-3]
        head = [ADDRESS.upper(), "1", date, clock, date, clock]
        place = [str(each.latitude_deg), str(each.longitude_deg)]
        yield ",".join(["MSG", "1", "1", "1", *head, CALLSIGN, *[""] * 11])
        yield ",".join(
            ["MSG", "3", "1", "1", *head, "", f"{each.altitude_ft:.0f}", "", "", *place, "", "1000",
             "0", "0", "0", "0"]
        )  # fmt: skip
        yield ",".join(
            ["MSG", "4", "1", "1", *head, "", "", f"{each.ground_speed_kt:.0f}",
             f"{each.track_deg:.0f}", "", "", "1200", "", "", "", "", "0"]
        )  # fmt: skip


def reports(flight: Sequence[Position]) -> Iterator[AdsbReport]:
    for each in flight:
        yield AdsbReport(
            icao24=ADDRESS, callsign=CALLSIGN, latitude_deg=each.latitude_deg,
            longitude_deg=each.longitude_deg, altitude_ft=each.altitude_ft,
            ground_speed_kt=each.ground_speed_kt, track_deg=each.track_deg % 360.0,
            emitter_category="A3", squawk="1000", nic=8, sil=3, nacp=9, nacv=2, receiver="r",
            t_adsb_in_ns=round(each.t_s * SECOND_NS), t_adsb_out_ns=0,
        )  # fmt: skip


def avr_lines(flight: Sequence[Position]) -> Iterator[str]:
    source = FrameSource()
    for report in reports(flight):
        ticks = report.t_adsb_in_ns * 12 // 1000
        for each in source.frames(report):
            yield f"@{ticks:012X}{each.hex().upper()};"


def _write_lines(path: Path, lines: Iterator[str]) -> None:
    path.write_text("\n".join(lines) + "\n")


WRITERS: dict[str, tuple[str, Callable[[Path, Sequence[Position]], object]]] = {
    "readsb": ("trace_full_3c6444.json", write_readsb),
    "opensky": ("states.csv", lambda path, flight: states(flight).to_csv(path, index=False)),
    "opensky parquet": (
        "states.parquet",
        lambda path, flight: states(flight).to_parquet(path),
    ),
    "sbs": ("log.txt", lambda path, flight: _write_lines(path, sbs_lines(flight))),
    "avr": ("frames.txt", lambda path, flight: _write_lines(path, avr_lines(flight))),
    "traffic": ("frame.csv", lambda path, flight: frame(flight).to_csv(path, index=False)),
    "traffic parquet": (
        "frame.parquet",
        lambda path, flight: frame(flight).to_parquet(path),
    ),
}
"""Names of the files of each format, and what writes them."""


def rewrite_line(path: Path, number: int, change: Callable[[list[str]], list[str]]) -> None:
    """Change the cells of a line of a file of comma-separated values, counted from 1."""
    lines = path.read_text().splitlines()
    (cells,) = csv.reader([lines[number - 1]])
    lines[number - 1] = ",".join(change(cells))
    path.write_text("\n".join(lines) + "\n")
