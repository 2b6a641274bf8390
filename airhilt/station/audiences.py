"""Audiences of what a run publishes: who at the seats of people may see it."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Literal, NamedTuple

from airhilt.messages import (
    ActorCommand,
    AdsbReport,
    Advisory,
    AdvisoryAudio,
    Briefing,
    Clock,
    Detections,
    EquipmentAlert,
    Message,
    RadarInfo,
    RadarPlot,
    SeatState,
    SurfaceTrack,
    Transcript,
    Transmission,
    key_chunk,
)


class Audience(NamedTuple):
    """Persons at seats who may see something of a run with seats.

    Attributes
    ----------
    way
        What shows it: ADS-B, radars and surface surveillance, a frequency, the own receiver of a
        seat, an advisory to somebody, a camera, or the actor that got a command. Else everybody
        sees it, with a seat or without, or nobody does.
    of
        The icao24 of the sender, the frequency in kHz, the seat, the recipient, the carrier of the
        camera (None: the ground), or the actor as a part of keys, each by its way.
    """

    way: Literal[
        "everybody", "adsb", "surveillance", "frequency", "receiver", "advisory", "camera",
        "command", "nobody",
    ]  # fmt: skip
    of: str | int | None = None


EVERYBODY = Audience("everybody")
"""Audience of the clock and the airport."""
NOBODY = Audience("nobody")
"""Audience of the truth, of the states of workers, and of latencies, which name engines: they tell
a participant of an experiment which assistant there is. Its advisories, transcripts, voice and
boxes on pictures are seen where their own audiences see them."""
SURVEILLANCE = Audience("surveillance")
"""Audience of what radars and surface surveillance have found: units."""


def audience_of(key: str, message: Message) -> Audience:
    """Return the audience of a message with a key below that of the run."""
    match message:
        case Clock() | Briefing():
            return EVERYBODY
        case AdsbReport():
            return Audience("adsb", message.icao24)
        case SurfaceTrack() | RadarInfo() | RadarPlot():
            return SURVEILLANCE
        case Transmission() | Transcript():
            return Audience("frequency", message.frequency_khz)
        case ActorCommand():
            return Audience("command", key.partition("/")[2])
        case Advisory() | AdvisoryAudio():
            return Audience("advisory", message.recipient)
        case EquipmentAlert():
            return Audience("advisory", message.advisory.recipient)
        case Detections():
            return Audience("camera", message.view.carrier)
    return NOBODY


def heard_by(header: Mapping[str, Any]) -> Audience:
    """Return the audience of a piece of a transmission, by its header in JSON."""
    if "seat" in header:
        return Audience("receiver", header["seat"])
    return Audience("frequency", header["frequency_khz"])


def sees(state: SeatState, audience: Audience) -> bool:
    """Return whether the person at a seat may see something with an audience."""
    way, of = audience
    is_unit = state.category == "unit"
    match way:
        case "adsb":
            return is_unit or state.has_adsb_in or of == state.icao24
        case "surveillance":
            return is_unit
        case "frequency":
            return of in state.frequencies_khz
        case "advisory":
            return of in state.recipients
        case "camera":
            return of == (None if is_unit else state.seat)
        case "command":
            return of == key_chunk(state.seat)
    return False
