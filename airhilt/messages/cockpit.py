"""Messages of the instruments on board an aircraft or a vehicle."""

from __future__ import annotations

from typing import Literal

from pydantic import Field

from airhilt.messages.advisories import Advisory
from airhilt.messages.base import Limit, Message


class CockpitInstruments(Message):
    """``cockpit/<callsign>``: what the instruments of an aircraft show its own crew.

    Values are those of the aircraft's own state, rounded finer than a crew can read; errors of the
    instruments are not simulated. The air is the standard atmosphere and altimeters are set to
    1013.25 hPa, so the altitude is the pressure altitude.
    """

    callsign: str
    airspeed_kt: float = Field(ge=0.0, description="calibrated, in steps of 0.1 kt")
    mach: float = Field(ge=0.0)
    altitude_ft: int
    vertical_speed_fpm: int
    north: Literal["magnetic", "true"] = Field(
        description="of heading and track; true where the magnetic variation is not known"
    )
    heading_deg: float = Field(ge=0.0, lt=360.0)
    track_deg: float = Field(ge=0.0, lt=360.0, description="over the ground")
    ground_speed_kt: float = Field(ge=0.0)
    pitch_deg: float = Field(description="positive nose up")
    roll_deg: float = Field(description="positive right wing down")
    gear: float = Field(ge=0.0, le=1.0, description="position: 0 up, 1 down and locked")
    flaps: float = Field(ge=0.0, le=1.0, description="position: 0 up, 1 fully extended")
    on_ground: bool = Field(description="a main wheel carries weight")
    mode: str = Field(
        description="what autopilot and guidance do",
        examples=["en_route", "glide", "go_around", "takeoff_roll"],
    )
    radio_height_ft: int | None = Field(
        default=None,
        description="height of the wheels above the ground by the radio altimeter; null above "
        "2,500 ft, where it shows none",
    )
    selected_altitude_ft: int = Field(description="altitude that is flown to, or held")
    selected_airspeed_kt: int = Field(description="calibrated airspeed that is flown to, or held")


class VehiclePosition(Message):
    """``cockpit/<callsign>/position``: where a vehicle is, by its own moving map.

    Errors of the receiver are not simulated.
    """

    callsign: str
    latitude_deg: float = Field(ge=-90.0, le=90.0)
    longitude_deg: float = Field(ge=-180.0, le=180.0)
    heading_deg: float = Field(ge=0.0, lt=360.0, description="true")
    ground_speed_kt: float = Field(ge=0.0)


class EquipmentAlert(Message):
    """``equipment/<equipment>/<recipient>``: alert of equipment that is in the world.

    It is no advice of the assistant under test. Its recipient hears it at once, by a voice or a
    light of the equipment's own.
    """

    limit = Limit(size_bytes=32_000, rate_hz=50)
    equipment: str = Field(
        pattern=r"^[a-z0-9_-]{1,40}$", description="its name", examples=["tcas", "conflict_alert"]
    )
    advisory: Advisory
