"""One record of a file of traffic, and how its values are read from text or numbers."""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Iterator, Mapping
from pathlib import Path
from typing import Any, NamedTuple

from airhilt.errors import AirhiltError

MOST_BYTES = 500_000_000
"""Size of the largest file that is read."""
ADDRESS = re.compile(r"[0-9a-f]{6}")
SQUAWK = re.compile(r"[0-7]{4}")


class TracksError(AirhiltError):
    """A file of traffic cannot be read, or has a record that cannot be right."""


class Record(NamedTuple):
    """Position of one aircraft at one time, with what else the file says of it there."""

    where: str
    """Place in the file, such as ``line 12``."""
    icao24: str
    t_s: float
    """Time in s, from any instant."""
    latitude_deg: float
    longitude_deg: float
    altitude_ft: float | None
    """Pressure altitude; None on the ground."""
    ground_speed_kt: float | None = None
    callsign: str | None = None
    squawk: str | None = None
    designator: str | None = None
    """Type designator of ICAO Doc 8643."""
    category: str | None = None
    """ADS-B emitter category, such as A3."""


class BadRecord(NamedTuple):
    """Record of a file that cannot be right."""

    where: str
    field: str
    text: str

    def __str__(self) -> str:
        return f"{self.where}: {self.field}: {self.text}"


Row = Mapping[str, Any]
"""Values of one record by the names of the fields of `Record`, and ``on_ground``; in ft and kt."""
Read = Callable[[Path], Iterator[tuple[str, Row]]]
"""Yields the place and the values of each record of a file that has a position."""


class Format(NamedTuple):
    """One format of files."""

    name: str
    description: str
    matches: Callable[[Path, bytes], bool]
    """Returns whether a file, of which it gets the path and the beginning, is one."""
    read: Read
    fields: Mapping[str, str]
    """Names in the file of the fields of `Record`."""


def record_of(where: str, row: Row, fields: Mapping[str, str]) -> Record | BadRecord | None:
    """Return a record with its values checked; None for one in the air without an altitude."""

    def bad(field: str, text: str) -> BadRecord:
        return BadRecord(where, fields.get(field, field), text)

    numbers: dict[str, float] = {}
    for field, low, high in (
        ("t_s", -math.inf, math.inf),
        ("latitude_deg", -90.0, 90.0),
        ("longitude_deg", -180.0, 180.0),
    ):
        number = _number(row.get(field))
        if number is None or not low <= number <= high:
            wanted = "a time in s" if field == "t_s" else f"degrees from {low:g} to {high:g}"
            return bad(field, f"found {row.get(field)!r}; expected {wanted}")
        numbers[field] = number
    address = str(row.get("icao24") or "").strip().lower().lstrip("~")
    if not ADDRESS.fullmatch(address):
        return bad("icao24", f"found {row.get('icao24')!r}; expected six hexadecimal digits")
    altitude_ft = None
    if not row.get("on_ground"):
        if _is_missing(row.get("altitude_ft")):
            return None
        altitude_ft = _number(row["altitude_ft"])
        if altitude_ft is None or not -1500.0 <= altitude_ft <= 60_000.0:
            return bad("altitude_ft", f"found {row['altitude_ft']!r}; expected -1500 to 60000 ft")
    return Record(
        where,
        address,
        **numbers,
        altitude_ft=altitude_ft,
        ground_speed_kt=_number(row.get("ground_speed_kt")),
        callsign=_text(row.get("callsign")),
        squawk=_text(row.get("squawk")),
        designator=_text(row.get("designator")),
        category=_text(row.get("category")),
    )


def _is_missing(value: Any) -> bool:
    return value is None or value == "" or (isinstance(value, float) and math.isnan(value))


def _number(value: Any) -> float | None:
    if isinstance(value, bool) or _is_missing(value):
        return None
    try:
        number = float(value)
    except (TypeError, ValueError):
        return None
    return number if math.isfinite(number) else None


def _text(value: Any) -> str | None:
    return None if _is_missing(value) else str(value).strip() or None
