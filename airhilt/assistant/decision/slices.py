"""Slices of what a decision engine has received: the same moment in each modality."""

from __future__ import annotations

from collections import deque
from collections.abc import Mapping
from types import MappingProxyType
from typing import Any

from airhilt.assistant.decision.engine import ReceivedMessage
from airhilt.assistant.decision.input_checks import InputChecks
from airhilt.assistant.decision.service_messages import (
    AssistantRequest,
    CameraSlice,
    FlightContext,
    RadioTurn,
    TrackSlice,
)
from airhilt.assistant.decision.velocity_checks import VelocityChecks
from airhilt.messages import AdsbReport, Briefing, CameraInfo, Detections, Message, Part, Transcript
from airhilt.phraseology import parse_call
from airhilt.units import MILLISECOND_NS, SECOND_NS

RADIO_NS = 120 * SECOND_NS
"""Age up to which a call is given, from its end: two minutes, a clearance with its readback."""
CAMERAS_NS = SECOND_NS
"""Age up to which a picture is given."""
TRACKS_NS = 15 * SECOND_NS
"""Age up to which a report is given; `airhilt.assistant.decision.air_tracks` keeps it as long."""
READS: tuple[type[Message], ...] = (Briefing, AdsbReport, Transcript, Detections)
"""Messages that slices are made of."""
INPUTS: Mapping[str, object] = MappingProxyType({"camera/*/info": CameraInfo})
"""Further messages by which they are checked, by their keys."""
SECOND_MS = 1_000
"""Milliseconds in a second, the unit of `ts_ms`."""


class Slices:
    """Keeps the last minutes of what has arrived and can be right by its checks."""

    def __init__(self) -> None:
        self.checks = InputChecks()
        self._context: FlightContext | None = None
        self._radio: dict[str, Transcript] = {}
        self._cameras: deque[Detections] = deque()
        self._tracks: dict[str, AdsbReport] = {}
        self._velocities = VelocityChecks()

    def receive(self, received: ReceivedMessage) -> None:
        """Take in one message if it is believed; of two about one call, the first holds."""
        t_ns = received.t_ns
        match received.message:
            case CameraInfo() as info:
                self.checks.take_camera(info)
            case Briefing() as briefing:
                self._context = FlightContext(**_shared(briefing, FlightContext))
            case AdsbReport() as report if self.checks.believes_report(report, t_ns):
                last = self._tracks.get(report.icao24)
                if last is None or report.t_adsb_in_ns >= last.t_adsb_in_ns:
                    self._tracks[report.icao24] = self._velocities.checked(report)
            case Transcript() as transcript:
                for each in self.checks.in_order(transcript, t_ns):
                    self._radio[each.id] = each
            case Detections() as detections if self.checks.believes_detections(detections, t_ns):
                self._cameras.append(detections)

    def callsigns(self) -> tuple[str, ...]:
        """Return all callsigns that are known: of the roster, and of aircraft with ADS-B."""
        roster = self._context.roster if self._context else ()
        names = {each.callsign for each in roster}
        return tuple(
            sorted(names | {each.callsign for each in self._tracks.values() if each.callsign})
        )

    def request(self, t_ns: int) -> AssistantRequest:
        """Return the slices of now, and forget what is older."""
        self._radio = {
            name: each for name, each in self._radio.items() if t_ns - each.t_end_ns <= RADIO_NS
        }
        self._tracks = {
            name: each
            for name, each in self._tracks.items()
            if t_ns - each.t_adsb_in_ns <= TRACKS_NS
        }
        while self._cameras and t_ns - self._cameras[0].t_frame_ns > CAMERAS_NS:
            self._cameras.popleft()
        callsigns = self.callsigns()
        radio = sorted(self._radio.values(), key=lambda each: (each.t_tx_ns, each.id))
        return AssistantRequest(
            ts_ms=t_ns // MILLISECOND_NS,
            context=self._context,
            radio=tuple(_turn(each, callsigns) for each in radio),
            cameras=tuple(
                CameraSlice(
                    camera_id=each.camera,
                    ts_ms=each.t_frame_ns // MILLISECOND_NS,
                    **_shared(each, CameraSlice),
                )
                for each in self._cameras
            ),
            tracks=tuple(
                TrackSlice(ts_ms=each.t_adsb_in_ns // MILLISECOND_NS, **_shared(each, TrackSlice))
                for _, each in sorted(self._tracks.items())
            ),
        )


def _turn(transcript: Transcript, callsigns: tuple[str, ...]) -> RadioTurn:
    call = parse_call(transcript.text, callsigns)
    speaker = transcript.speaker or (None if call.addressed_first else call.callsign)
    return RadioTurn(
        **_shared(transcript, RadioTurn)
        | {
            "turn_id": transcript.id,
            "ts_ms": transcript.t_tx_ns // MILLISECOND_NS,
            "end_ms": transcript.t_end_ns // MILLISECOND_NS,
            "addressed_callsign": call.callsign if call.addressed_first else None,
            "speaker": speaker,
        }
    )


def _shared(message: Message, part: type[Part]) -> dict[str, Any]:
    """Return the values of a message under the names that a part of a request has as well."""
    names = part.model_fields.keys() & type(message).model_fields.keys()
    return {name: getattr(message, name) for name in names}
