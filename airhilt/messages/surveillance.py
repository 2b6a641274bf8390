"""Messages of surveillance: ADS-B, radar, tracks on the ground and replies to TCAS."""

from __future__ import annotations

from typing import Literal, get_args

from pydantic import Field

from airhilt.messages.base import Limit, Message, Nanoseconds

EmitterCategory = Literal[
    "A0", "A1", "A2", "A3", "A4", "A5", "A6", "A7",
    "B0", "B1", "B2", "B3", "B4", "B6", "B7",
    "C0", "C1", "C2", "C3", "C4", "C5",
]  # fmt: skip
"""ADS-B emitter category (DO-260B, 2.2.3.2.5.2): A1 light, A2 small, A3 large, A5 heavy aircraft,
B6 unmanned aircraft, C1 emergency, C2 service surface vehicle; A0, B0, C0 no information."""
EmergencyState = Literal[
    "none", "general", "medical", "minimum_fuel", "no_communications", "unlawful_interference",
    "downed",
]  # fmt: skip
"""Emergency or priority status of ADS-B (DO-260B, 2.2.3.2.7.8.1.1)."""
EMERGENCY_STATES: tuple[EmergencyState, ...] = get_args(EmergencyState)
"""All of them, in the order of their codes."""


class StateVector(Message):
    """State vector from an ADS-B receiver, in the units of DO-260B."""

    icao24: str = Field(pattern=r"^[0-9a-f]{6}$")
    callsign: str | None = Field(description="null until an identification squitter came through")
    latitude_deg: float = Field(ge=-90.0, le=90.0)
    longitude_deg: float = Field(ge=-180.0, le=180.0)
    altitude_ft: float | None = Field(
        description="pressure altitude in steps of 25 ft; null on the ground"
    )
    on_ground: bool = Field(default=False, description="the squitter had the surface format")
    emitter_category: EmitterCategory | None = Field(
        default=None, description="null until an identification squitter came through"
    )
    ground_speed_kt: float = Field(
        default=0.0, ge=0.0, description="0 too where a feed gives none: the places tell then"
    )
    track_deg: float = Field(default=0.0, ge=0.0, lt=360.0)
    vertical_rate_fpm: float = Field(default=0.0, description="in steps of 64 ft/min")
    squawk: str | None = Field(
        default=None,
        pattern=r"^[0-7]{4}$",
        description="Mode A code, octal; null if the sender, such as a vehicle, has none",
    )
    emergency: EmergencyState = Field(default="none", description="emergency or priority status")
    nic: int = Field(
        default=0, ge=0, le=11, description="navigation integrity category; 0: unknown"
    )
    sil: int = Field(
        default=0,
        ge=0,
        le=3,
        description="source integrity level: how rarely the position is outside the bound of the "
        "NIC, 3 for 1e-7; 0: unknown",
    )
    nacp: int = Field(ge=0, le=11, description="navigation accuracy category for position")
    nacv: int = Field(ge=0, le=4, description="navigation accuracy category for velocity")
    receiver: str
    t_adsb_in_ns: Nanoseconds = Field(description="the squitter reached the receiver")
    t_adsb_out_ns: Nanoseconds = Field(description="the receiver gave out the report")


class AdsbReport(StateVector):
    """``adsb/<icao24>``: state vector from an ADS-B receiver, in the units of DO-260B."""


class LiveReport(StateVector):
    """``live/<icao24>``: target of a real receiver; the run gives it out on ``adsb/<icao24>``.

    The times are those at which the run gets it.
    """

    limit = Limit(size_bytes=2_000, rate_hz=1_000)


RadarKind = Literal["terminal", "en_route"]
PlotKind = Literal["primary", "secondary", "combined"]


class RadarInfo(Message):
    """``radar/<site>/info``: constant properties of a radar, published before its plots."""

    site: str
    kind: RadarKind
    latitude_deg: float = Field(ge=-90.0, le=90.0, description="of the antenna")
    longitude_deg: float = Field(ge=-180.0, le=180.0, description="of the antenna")
    altitude_m: float = Field(description="of the antenna, above WGS84 as all altitudes are")
    rotation_s: float = Field(gt=0.0, description="time of one turn of the antenna")
    primary_range_m: float = Field(gt=0.0, description="greatest slant range of primary plots")
    secondary_range_m: float = Field(gt=0.0, description="greatest slant range of replies")


class RadarPlot(Message):
    """``radar/<site>``: one target as one turn of a surveillance radar's antenna found it.

    ``t_ns`` is the end of the sector (1/32 of a turn) in which the beam passed the target. A plot
    does not say what it is of: one aircraft's plots of two turns are connected by nothing but their
    places and, if it has a transponder, its code. The range is a slant range, so the place on the
    ground needs an altitude: that of Mode C, or an assumed one for a primary plot.
    """

    site: str
    kind: PlotKind = Field(
        description="primary: an echo of the skin; secondary: a transponder's reply; combined: "
        "both, at the place of the reply, which is more exact"
    )
    t_plot_ns: Nanoseconds = Field(description="the beam passed the target")
    range_m: float = Field(ge=0.0, description="slant range from the antenna")
    azimuth_deg: float = Field(ge=0.0, lt=360.0, description="from true north at the antenna")
    mode_a: str | None = Field(
        default=None,
        pattern=r"^[0-7]{4}$",
        description="Mode A code (squawk), octal; null in a primary plot, or if it was not valid",
    )
    mode_c_ft: int | None = Field(
        default=None,
        description="pressure altitude in steps of 100 ft; null in a primary plot, or if it was "
        "not valid",
    )


class SurfaceTrack(Message):
    """``surface/<airport>``: one target of an airport's surface surveillance, once a second.

    Radar and multilateration are fused. Only a transponder gives a target a name, tells whether it
    is in the air, and how high.
    """

    airport: str = Field(description="ICAO designator")
    track: int = Field(ge=1, description="number of the track; the same until the target is lost")
    kind: PlotKind = Field(
        description="primary: detected by radar alone; secondary: by multilateration alone; "
        "combined: by both"
    )
    t_track_ns: Nanoseconds = Field(description="the target was measured")
    latitude_deg: float = Field(ge=-90.0, le=90.0)
    longitude_deg: float = Field(ge=-180.0, le=180.0)
    accuracy_m: float = Field(gt=0.0, description="95 % position error")
    altitude_ft: float | None = Field(
        default=None,
        description="pressure altitude in steps of 25 ft; null on the ground, or without a "
        "transponder",
    )
    on_ground: bool | None = Field(default=None, description="null without a transponder")
    ground_speed_kt: float = Field(
        default=0.0, ge=0.0, description="0 at a standstill, or where a feed gives none"
    )
    track_deg: float | None = Field(
        default=None, ge=0.0, lt=360.0, description="over the ground; null at a standstill"
    )
    icao24: str | None = Field(
        default=None, pattern=r"^[0-9a-f]{6}$", description="null without a transponder"
    )
    callsign: str | None = Field(default=None, description="null without a transponder")


TransponderMode = Literal["S", "C"]
"""Mode S, or Modes A and C alone."""


class TcasReply(Message):
    """``tcas/<callsign>``: reply of one transponder to the TCAS II of an aircraft.

    There is one a second from each transponder in reach, unless it is lost. A Mode C reply does not
    say whose it is: two of them are connected by nothing but range and altitude.
    """

    callsign: str = Field(description="of the aircraft that interrogates")
    own_icao24: str = Field(
        pattern=r"^[0-9a-f]{6}$", description="of the aircraft that interrogates"
    )
    mode: TransponderMode
    icao24: str | None = Field(
        default=None,
        pattern=r"^[0-9a-f]{6}$",
        description="of the aircraft that replies; null in a Mode C reply",
    )
    range_m: float = Field(ge=0.0, description="slant range")
    bearing_deg: float = Field(
        ge=0.0, lt=360.0, description="from the own nose, clockwise; its error is large"
    )
    altitude_ft: int = Field(
        description="pressure altitude in steps of 25 ft, of 100 ft in a Mode C reply"
    )
    on_ground: bool = Field(default=False, description="vertical status of a Mode S reply")
    has_tcas: bool = Field(
        default=False,
        description="it has TCAS II as well, and coordinates (field RI of a Mode S reply)",
    )
