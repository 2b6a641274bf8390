"""Logs of SBS-1 "BaseStation" lines, as ports 30003 of receivers give them out."""

from __future__ import annotations

from collections.abc import Iterator
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

from airhilt.host.files import read_file
from airhilt.world.tracks.record import MOST_BYTES, Format, Row

CALLSIGN, SURFACE, AIRBORNE, VELOCITY, SQUAWK = "1", "2", "3", "4", "6"
"""Types of transmission."""
FIELDS = 22
EMERGENCY = 19
"""Place of the flag of an emergency."""
SET = ("-1", "1")
"""Values of a flag that is set."""


class SbsLines:
    """Makes rows of lines; callsigns, speeds and squawks come on lines of their own."""

    def __init__(self) -> None:
        self._said: dict[str, dict[str, Any]] = {}

    def row(self, line: str) -> Row | None:
        """Return the values of a line with a position; None for all others."""
        cells = [cell.strip() for cell in line.split(",")]
        if len(cells) < FIELDS or cells[0] != "MSG":
            return None
        sort, address = cells[1], cells[4].lower()
        said = self._said.setdefault(address, {})
        said |= {
            name: cells[place]
            for name, place in (
                ("callsign", 10),
                ("ground_speed_kt", 12),
                ("track_deg", 13),
                ("vertical_rate_fpm", 16),
                ("squawk", 17),
            )
            if cells[place]
        }
        if cells[EMERGENCY]:
            said["emergency"] = "general" if cells[EMERGENCY] in SET else "none"
        if sort not in (SURFACE, AIRBORNE) or not (cells[14] and cells[15]):
            return None
        return said | {
            "icao24": address,
            "t_s": _seconds(cells[6], cells[7]),
            "latitude_deg": cells[14],
            "longitude_deg": cells[15],
            "altitude_ft": cells[11],
            "on_ground": sort == SURFACE or cells[21] in SET,
        }


def _seconds(date: str, clock: str) -> Any:
    """Return a date and a time of day in UTC as seconds since 1970; their text if they are none."""
    try:
        when = datetime.fromisoformat(f"{date.replace('/', '-')}T{clock}").replace(tzinfo=UTC)
    except ValueError:
        return f"{date} {clock}"
    return when.timestamp()


def _matches(path: Path, head: bytes) -> bool:  # noqa: ARG001
    return head.startswith(b"MSG,")


def _read(path: Path) -> Iterator[tuple[str, Row]]:
    lines = SbsLines()
    text = read_file(path, MOST_BYTES).decode(errors="replace")
    for number, line in enumerate(text.splitlines(), 1):
        row = lines.row(line)
        if row is not None:
            yield f"line {number}", row


FORMAT = Format(
    "sbs",
    "log of SBS-1 BaseStation lines",
    _matches,
    _read,
    {
        "icao24": "5 (address)",
        "t_s": "7 and 8 (date and time)",
        "latitude_deg": "15 (latitude)",
        "longitude_deg": "16 (longitude)",
        "altitude_ft": "12 (altitude)",
        "ground_speed_kt": "13 (ground speed)",
    },
)
