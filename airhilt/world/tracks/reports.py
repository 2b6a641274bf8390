"""Turns the rows of a receiver's feed into the reports that a run takes."""

from __future__ import annotations

import re
from typing import get_args

from airhilt.messages import EmergencyState, EmitterCategory, LiveReport
from airhilt.surveillance.transponders import EMERGENCY_CODES
from airhilt.world.tracks.record import SQUAWK, BadRecord, Row, record_of

RECEIVER = "live"
"""Name of the receiver in the reports."""
CATEGORIES = get_args(EmitterCategory)
CALLSIGN = re.compile("[A-Z0-9 ]{1,8}")
"""Characters that Mode S has for a flight identification (ICAO Annex 10, volume IV, table 3-8)."""
HIGHEST_NACP, HIGHEST_NACV = 11, 4
"""Highest categories of accuracy; those above are reserved (DO-260B, 2.2.3.2.7.2.7 and
2.2.3.2.6.1.5)."""


def report_of(row: Row) -> LiveReport | None:
    """Return a row as a report; None for one that cannot be right, or has no altitude.

    What is reserved in a field that may be unknown counts as unknown. The run sets the times.
    """
    record = record_of("", row, {})
    if record is None or isinstance(record, BadRecord):
        return None
    callsign = (record.callsign or "").upper()
    squawk = record.squawk if SQUAWK.fullmatch(record.squawk or "") else None
    try:
        return LiveReport(
            icao24=record.icao24,
            callsign=callsign if CALLSIGN.fullmatch(callsign) else None,
            latitude_deg=record.latitude_deg,
            longitude_deg=record.longitude_deg,
            altitude_ft=record.altitude_ft,
            on_ground=record.altitude_ft is None,
            emitter_category=record.category if record.category in CATEGORIES else None,
            ground_speed_kt=max(record.ground_speed_kt or 0.0, 0.0),
            track_deg=_number(row, "track_deg") % 360.0,
            vertical_rate_fpm=_number(row, "vertical_rate_fpm"),
            squawk=squawk,
            emergency=_emergency(row, squawk),
            nic=row.get("nic", 0),
            sil=row.get("sil", 0),
            nacp=_accuracy(row, "nacp", HIGHEST_NACP),
            nacv=_accuracy(row, "nacv", HIGHEST_NACV),
            receiver=RECEIVER,
            t_adsb_in_ns=0,
            t_adsb_out_ns=0,
        )
    except ValueError:
        return None


def _emergency(row: Row, squawk: str | None) -> EmergencyState:
    """Return the emergency that a feed gives; that of the squawk where it gives none in detail."""
    given: EmergencyState = row.get("emergency", "none")
    return EMERGENCY_CODES.get(squawk or "", given) if given in ("none", "general") else given


def _accuracy(row: Row, field: str, highest: int) -> int:
    value: int = row.get(field, 0)
    return value if value <= highest else 0


def _number(row: Row, field: str) -> float:
    value = row.get(field)
    return 0.0 if value is None else float(value)
