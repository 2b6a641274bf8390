"""Audiences of what a run publishes, and what a person at a seat may see of it."""

from __future__ import annotations

from collections.abc import Collection, Mapping
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


class SeatView:
    """View of a run at a seat, besides what everybody sees.

    A unit sees what receivers, radars and cameras of the ground give. A crew or a driver sees
    ADS-B with a receiver of its own, else its own position alone, and the cameras that it carries.
    Each hears its frequencies, and gets advisories to itself.
    """

    def __init__(self, state: SeatState) -> None:
        self._state = state

    @property
    def tuned_khz(self) -> frozenset[int]:
        """Frequencies to which the person at the seat listens."""
        return frozenset(self._state.tuned_khz)

    def hears(self, audience: Audience) -> bool:
        """Return true if a piece of a transmission with this audience is heard at the seat.

        It comes from the own receiver of the seat, or where it has none from the units' site.
        """
        if self._state.has_own_receiver:
            return audience == Audience("receiver", self._state.seat)
        return audience.way == "frequency" and self.sees(audience)

    def sees(self, audience: Audience) -> bool:
        """Return true if something with this audience is seen at the seat."""
        state, (way, of) = self._state, audience
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


class SeatViews:
    """Views of the seats of a run, each known once the run has told of the seat.

    Parameters
    ----------
    seats
        Names of the seats; without any, everything is seen.
    """

    def __init__(self, seats: Collection[str] = ()) -> None:
        self._has_seats = bool(seats)
        self._states: dict[str, SeatState] = {}
        self._cameras: dict[str, Audience] = {}

    def learn(self, state: SeatState) -> None:
        """Take in what a run says of a seat."""
        self._states[state.seat] = state

    def of(self, seat: str | None) -> SeatView | None:
        """Return the view of a seat; None without a seat, or if it is not known yet."""
        state = self._states.get(seat or "")
        return None if state is None else SeatView(state)

    def holder(self, seat: str) -> str | None:
        """Return the name of the holder's token of a seat, None if nobody has it."""
        return self._states[seat].holder if seat in self._states else None

    def records_voices(self, seat: str) -> bool:
        """Return whether what is spoken at a seat is recorded; true if it is not known yet."""
        return seat not in self._states or self._states[seat].voice_is_recorded

    def learn_camera(self, name: str, audience: Audience) -> None:
        """Take in who may see the pictures of a camera."""
        self._cameras[name] = audience

    def sees(self, seat: str | None, audience: Audience) -> bool:
        """Return true if something with this audience is seen at a seat; None: without one."""
        if not self._has_seats or audience == EVERYBODY:
            return True
        view = self.of(seat)
        return view is not None and view.sees(audience)

    def shows_camera(self, seat: str | None, name: str) -> bool:
        """Return true if the pictures of a camera are seen at a seat."""
        return self.sees(seat, self._cameras.get(name, NOBODY))
