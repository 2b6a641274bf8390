"""State vectors of the OpenSky Network, CSV or parquet, with the columns of its data sets.

They are in SI: altitudes in m, speeds in m/s. A position is of the time ``lastposupdate`` where
that is given: OpenSky repeats one in each second until the next.
"""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

from airhilt.units import FOOT, KNOT
from airhilt.world.tracks import table
from airhilt.world.tracks.record import Format, Row

COLUMNS = {"time", "icao24", "lat", "lon", "baroaltitude"}


def _read(path: Path) -> Iterator[tuple[str, Row]]:
    for where, row in table.rows(path):
        if row.get("lat") is None or row.get("lon") is None:
            continue
        time = row.get("lastposupdate")
        yield (
            where,
            {
                "icao24": row.get("icao24"),
                "t_s": table.seconds(row.get("time") if time is None else time),
                "latitude_deg": row["lat"],
                "longitude_deg": row["lon"],
                "altitude_ft": _in(row.get("baroaltitude"), FOOT),
                "on_ground": table.flag(row.get("onground")),
                "ground_speed_kt": _in(row.get("velocity"), KNOT),
                "callsign": row.get("callsign"),
                "squawk": row.get("squawk"),
            },
        )


def _in(value: Any, unit: float) -> Any:
    """Return a number in another unit; what is no number stays as it is."""
    try:
        return float(value) / unit
    except (TypeError, ValueError):
        return value


FORMAT = Format(
    "opensky",
    "state vectors of the OpenSky Network, CSV or parquet",
    lambda path, head: table.columns(path, head) >= COLUMNS,
    _read,
    {
        "t_s": "time",
        "latitude_deg": "lat",
        "longitude_deg": "lon",
        "altitude_ft": "baroaltitude",
        "ground_speed_kt": "velocity",
    },
)
