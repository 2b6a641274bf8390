"""Decodes Mode S frames with pyModeS, and gathers what an aircraft says in several of them."""

from __future__ import annotations

from typing import Any

from airhilt.messages import EMERGENCY_STATES
from airhilt.surveillance.mode_s import airborne_integrity
from airhilt.world.tracks.record import Row, TracksError

EXTENDED_SQUITTERS = (17, 18)
"""Downlink formats of ADS-B."""
IDENTIFICATION, SURFACE_POSITION, AIRBORNE_POSITION = "0,8", "0,6", "0,5"
"""Registers of the transponder that extended squitters have (DO-260B, 2.2.3.2)."""
CATEGORY_SETS = {4: "A", 3: "B", 2: "C", 1: "D"}
"""Sets of emitter categories by the type code of the identification (DO-260B, 2.2.3.2.5.2)."""


class FrameDecoder:
    """Makes rows of frames that have a position; callsign, speed and squawk come in others.

    ``surface_ref`` is a place (latitude and longitude in degrees) within 45 NM of positions on the
    ground, which are left out without one.
    """

    def __init__(self, surface_ref: tuple[float, float] | None = None) -> None:
        try:
            from pyModeS import DecodeError, PipeDecoder
        except ImportError:
            raise TracksError(
                "Mode S frames need pyModeS, which is not installed: pip install airhilt[decoders]"
            ) from None
        self._decoder: Any = PipeDecoder(surface_ref=surface_ref)
        self._error: Any = DecodeError
        self._said: dict[str, dict[str, Any]] = {}

    def row(self, frame: str, t_s: float) -> Row | None:
        """Return the values of a frame (hexadecimal) with a position; None for all others."""
        try:
            found = self._decoder.decode(frame, timestamp=t_s)
        except self._error:
            return None
        if found.get("crc_valid") is False or found.get("df") not in EXTENDED_SQUITTERS:
            return None
        address = str(found["icao"]).lower()
        said = self._said.setdefault(address, {})
        said |= {
            name: found[key]
            for name, key in (
                ("callsign", "callsign"),
                ("ground_speed_kt", "groundspeed"),
                ("track_deg", "track"),
                ("vertical_rate_fpm", "vertical_rate"),
                ("squawk", "squawk"),
                ("nacp", "nac_p"),
                ("nacv", "nac_v"),
                ("sil", "sil"),
                ("supplement_a", "nic_supplement_a"),
            )
            if found.get(key) is not None
        }
        if (state := found.get("emergency_state", len(EMERGENCY_STATES))) < len(EMERGENCY_STATES):
            said["emergency"] = EMERGENCY_STATES[state]
        if found.get("bds") == IDENTIFICATION:
            said["category"] = f"{CATEGORY_SETS[found['typecode']]}{found['category']}"
        if found.get("latitude") is None or found.get("longitude") is None:
            return None
        is_airborne = found.get("bds") == AIRBORNE_POSITION
        return said | {
            "icao24": address,
            "t_s": t_s,
            "latitude_deg": found["latitude"],
            "longitude_deg": found["longitude"],
            "altitude_ft": found.get("altitude"),
            "on_ground": found.get("bds") == SURFACE_POSITION,
            "nic": airborne_integrity(
                found["typecode"], said.get("supplement_a", 0), found["nic_b"]
            )
            if is_airborne
            else 0,
        }
