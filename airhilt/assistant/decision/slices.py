"""Slices of what a decision engine has received: the same moment in each modality."""

from __future__ import annotations

from collections import deque
from collections.abc import Mapping
from types import MappingProxyType

from airhilt.assistant.decision.engine import ReceivedMessage
from airhilt.assistant.decision.input_checks import InputChecks
from airhilt.assistant.decision.service_messages import (
    AssistantRequest,
    CameraSlice,
    FlightContext,
    RadioTurn,
    TrackSlice,
)
from airhilt.messages import AdsbReport, Briefing, CameraInfo, Detections, Message, Transcript
from airhilt.phraseology import parse_call
from airhilt.units import SECOND_NS

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
MS_NS = 1_000_000
"""Nanoseconds in a millisecond."""
SECOND_MS = 1_000
"""Milliseconds in a second, the unit of `ts_ms`."""


class Slices:
    """Keeps the last minutes of what has arrived and can be right.

    Attributes
    ----------
    checks
        Checks of what arrives, which know what was wrong.
    """

    def __init__(self) -> None:
        self.checks = InputChecks()
        self._context: FlightContext | None = None
        self._radio: dict[str, Transcript] = {}
        self._cameras: deque[Detections] = deque()
        self._tracks: dict[str, AdsbReport] = {}

    def receive(self, received: ReceivedMessage) -> None:
        """Take in one message if it is believed; of two about one call, the first holds."""
        t_ns = received.t_ns
        match received.message:
            case CameraInfo() as info:
                self.checks.take_camera(info)
            case Briefing() as briefing:
                self._context = FlightContext(
                    controller=briefing.controller,
                    horizontal_separation_nm=briefing.horizontal_separation_nm,
                    vertical_separation_ft=briefing.vertical_separation_ft,
                    roster=briefing.roster,
                    airport=briefing.airport,
                    animals=briefing.animals,
                )
            case AdsbReport() as report if self.checks.believes_report(report, t_ns):
                last = self._tracks.get(report.icao24)
                if last is None or report.t_adsb_in_ns >= last.t_adsb_in_ns:
                    self._tracks[report.icao24] = report
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
        self._forget(t_ns)
        callsigns = self.callsigns()
        radio = sorted(self._radio.values(), key=lambda each: (each.t_tx_ns, each.id))
        return AssistantRequest(
            ts_ms=t_ns // MS_NS,
            context=self._context,
            radio=tuple(_turn(each, callsigns) for each in radio),
            cameras=tuple(_camera(each) for each in self._cameras),
            tracks=tuple(_track(each) for _, each in sorted(self._tracks.items())),
        )

    def _forget(self, t_ns: int) -> None:
        """Forget what is older than its age."""
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


def _turn(transcript: Transcript, callsigns: tuple[str, ...]) -> RadioTurn:
    call = parse_call(transcript.text, callsigns)
    return RadioTurn(
        turn_id=transcript.id,
        ts_ms=transcript.t_tx_ns // MS_NS,
        end_ms=transcript.t_end_ns // MS_NS,
        frequency_khz=transcript.frequency_khz,
        text=transcript.text,
        words=transcript.words,
        confidence=transcript.confidence,
        addressed_callsign=call.callsign if call.addressed_first else None,
        speaker=transcript.speaker or (None if call.addressed_first else call.callsign),
        overheard=transcript.overheard,
    )


def _camera(detections: Detections) -> CameraSlice:
    return CameraSlice(
        camera_id=detections.camera,
        ts_ms=detections.t_frame_ns // MS_NS,
        view=detections.view,
        detections=detections.detections,
    )


def _track(report: AdsbReport) -> TrackSlice:
    return TrackSlice(
        icao24=report.icao24,
        callsign=report.callsign,
        ts_ms=report.t_adsb_in_ns // MS_NS,
        latitude_deg=report.latitude_deg,
        longitude_deg=report.longitude_deg,
        altitude_ft=report.altitude_ft,
        on_ground=report.on_ground,
        emitter_category=report.emitter_category,
        ground_speed_kt=report.ground_speed_kt,
        track_deg=report.track_deg,
        vertical_rate_fpm=report.vertical_rate_fpm,
        nacp=report.nacp,
    )
