"""Data frames of the Python library ``traffic``, CSV or parquet, by the names of its columns.

Altitudes are in ft, speeds in kt, times are dates or seconds since 1970.
"""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

from airhilt.world.tracks import table
from airhilt.world.tracks.record import Format, Row

COLUMNS = {"timestamp", "icao24", "latitude", "longitude", "altitude"}


def _read(path: Path) -> Iterator[tuple[str, Row]]:
    for where, row in table.rows(path):
        if row.get("latitude") is None or row.get("longitude") is None:
            continue
        yield (
            where,
            {
                "icao24": row.get("icao24"),
                "t_s": table.seconds(row.get("timestamp")),
                "latitude_deg": row["latitude"],
                "longitude_deg": row["longitude"],
                "altitude_ft": row.get("altitude"),
                "on_ground": table.flag(row.get("onground")),
                "ground_speed_kt": row.get("groundspeed"),
                "callsign": row.get("callsign"),
                "squawk": row.get("squawk"),
                "designator": row.get("typecode"),
            },
        )


FORMAT = Format(
    "traffic",
    "data frame of the library traffic, CSV or parquet",
    lambda path, head: table.columns(path, head) >= COLUMNS,
    _read,
    {
        "t_s": "timestamp",
        "latitude_deg": "latitude",
        "longitude_deg": "longitude",
        "altitude_ft": "altitude",
        "ground_speed_kt": "groundspeed",
    },
)
