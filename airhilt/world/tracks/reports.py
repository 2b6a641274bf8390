"""Turns the rows of a receiver's feed into the reports that a run takes."""

from __future__ import annotations

from typing import get_args

from airhilt.messages import EmitterCategory, LiveReport
from airhilt.world.tracks.record import SQUAWK, BadRecord, Row, record_of

RECEIVER = "live"
"""Name of the receiver in the reports."""
CATEGORIES = get_args(EmitterCategory)


def report_of(row: Row) -> LiveReport | None:
    """Return a row as a report; None for one that cannot be right, or has no altitude.

    The run sets its times.
    """
    record = record_of("", row, {})
    if record is None or isinstance(record, BadRecord):
        return None
    track_deg = _number(row, "track_deg") % 360.0
    return LiveReport(
        icao24=record.icao24,
        callsign=record.callsign,
        latitude_deg=record.latitude_deg,
        longitude_deg=record.longitude_deg,
        altitude_ft=record.altitude_ft,
        on_ground=record.altitude_ft is None,
        emitter_category=record.category if record.category in CATEGORIES else None,
        ground_speed_kt=max(record.ground_speed_kt or 0.0, 0.0),
        track_deg=track_deg,
        vertical_rate_fpm=_number(row, "vertical_rate_fpm"),
        squawk=record.squawk if SQUAWK.fullmatch(record.squawk or "") else None,
        nic=row.get("nic", 0),
        sil=row.get("sil", 0),
        nacp=row.get("nacp", 0),
        nacv=row.get("nacv", 0),
        receiver=RECEIVER,
        t_adsb_in_ns=0,
        t_adsb_out_ns=0,
    )


def _number(row: Row, field: str) -> float:
    value = row.get(field)
    return 0.0 if value is None else float(value)
