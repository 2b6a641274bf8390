"""Messages about the run itself: its clock, its briefing, the state of its modalities."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field

from airhilt.messages.base import Message, Part, VisibleClass

Phase = Literal["waiting", "running", "finished", "stopped"]


class Clock(Message):
    """``clock``: time and phase of the run, also answered to a query on that key. Not logged."""

    run: str
    phase: Phase
    pace: str
    behind_s: float = Field(
        default=0.0,
        ge=0.0,
        description="simulation time by which the run is later than its pace asks",
    )


Modality = Literal["adsb", "radio", "enhancement", "asr", "tts", "vision", "decision", "equipment"]
ModalityState = Literal["on", "off", "lost", "not evaluated"]


class Status(Message):
    """``status/<modality>``: a modality was switched on or off, or lost."""

    modality: Modality
    state: ModalityState
    cause: str = ""


GeodeticPoint = tuple[
    Annotated[float, Field(ge=-90.0, le=90.0)], Annotated[float, Field(ge=-180.0, le=180.0)]
]
"""Latitude and longitude, WGS84, in degrees."""


class RunwayBriefing(Part):
    """Direction of a runway, as charts publish it."""

    ident: str
    threshold: GeodeticPoint
    end: GeodeticPoint
    elevation_ft: float
    width_m: float
    protected_area: tuple[GeodeticPoint, ...] = Field(
        description="corners, in order, of the area that hold-short positions keep clear"
    )


class AirportBriefing(Part):
    """Airport, as charts publish it."""

    icao: str
    elevation_ft: float
    runways: tuple[RunwayBriefing, ...]


class RosterEntry(Part):
    """Aircraft or vehicle that the controller expects."""

    callsign: str
    category: Literal["aircraft", "vehicle"]
    type: str = Field(description="ICAO designator of an aircraft, kind of a vehicle")
    ceiling_ft: float | None = Field(
        default=None, gt=0.0, description="service ceiling of the aircraft type; null: not known"
    )


class Briefing(Message):
    """``briefing``: facts that all participants know before the run begins."""

    controller: str
    horizontal_separation_nm: float = Field(gt=0.0)
    vertical_separation_ft: float = Field(gt=0.0)
    roster: tuple[RosterEntry, ...] = Field(
        default=(), description="aircraft and vehicles that the controller expects"
    )
    airport: AirportBriefing | None = None
    animals: tuple[VisibleClass, ...] = Field(
        default=("bird", "coyote", "deer"), description="classes of pictures that are animals"
    )
    advisory_channel: Literal["cockpit", "frequency"] = Field(
        default="cockpit", description="where crews and drivers hear the voice of advisories"
    )
