"""Traces of readsb and tar1090 (``trace_full_*.json``, gzipped or not): one aircraft a file.

The fields are those of readsb's README-json.md: seconds after ``timestamp``, latitude, longitude,
altitude in ft or ``"ground"``, ground speed in kt, track, flags, vertical rate, details.
"""

from __future__ import annotations

import gzip
import json
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from airhilt.host.files import read_file
from airhilt.world.tracks.record import MOST_BYTES, Format, Row, TracksError

GZIP = b"\x1f\x8b"


def _matches(path: Path, head: bytes) -> bool:
    names = path.name.lower()
    return head.lstrip()[:1] == b"{" or (head[:2] == GZIP and ".json" in names)


def _read(path: Path) -> Iterator[tuple[str, Row]]:
    data = read_file(path, MOST_BYTES)
    try:
        document = json.loads(gzip.decompress(data) if data[:2] == GZIP else data)
    except (ValueError, OSError, EOFError, RecursionError) as error:
        raise TracksError(f"{path}: no JSON of readsb: {error}") from None
    is_trace = isinstance(document, dict) and isinstance(document.get("trace"), list)
    if not is_trace or not isinstance(document.get("timestamp"), int | float):
        raise TracksError(
            f"{path}: no trace of readsb: expected an object with icao, timestamp and trace"
        )
    begin_s = float(document["timestamp"])
    said: dict[str, Any] = {}
    for number, point in enumerate(document["trace"]):
        where = f"trace/{number}"
        if not isinstance(point, list) or len(point) < 4:
            raise TracksError(f"{path}: {where}: expected a list of at least 4 values")
        if len(point) > 8 and isinstance(point[8], dict):
            said |= {key: point[8].get(key) for key in ("flight", "squawk", "category")}
        is_number = isinstance(point[0], int | float)
        yield (
            where,
            {
                "icao24": document.get("icao"),
                "t_s": begin_s + point[0] if is_number else point[0],
                "latitude_deg": point[1],
                "longitude_deg": point[2],
                "altitude_ft": point[3],
                "on_ground": point[3] == "ground",
                "ground_speed_kt": point[4] if len(point) > 4 else None,
                "callsign": said.get("flight"),
                "squawk": said.get("squawk"),
                "category": said.get("category"),
                "designator": document.get("t"),
            },
        )


FORMAT = Format(
    "readsb",
    "trace of readsb or tar1090, JSON or gzipped JSON",
    _matches,
    _read,
    {
        "icao24": "icao",
        "t_s": "0 (seconds after timestamp)",
        "latitude_deg": "1 (latitude)",
        "longitude_deg": "2 (longitude)",
        "altitude_ft": "3 (altitude)",
        "ground_speed_kt": "4 (ground speed)",
    },
)
