"""The messages of a recorded run that its debrief shows, read once from the log."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from airhilt.messages import (
    ActorTruth,
    Advisory,
    AdvisoryAudio,
    CameraFrame,
    CameraInfo,
    CameraTruth,
    Detections,
    EquipmentAlert,
    SeatAudioClosed,
    bus_message,
    decode,
    key_chunk,
)
from airhilt.metrics.calls import CallRecords
from airhilt.record import Logged
from airhilt.report.sections import Content
from airhilt.station.advisories import AdvisoryRows
from airhilt.station.calls import call_as_json, spoken_as_json
from airhilt.station.cameras import CameraRecord
from airhilt.station.latencies import LatencyBars
from airhilt.station.redrawing import StateRow, state_row

if TYPE_CHECKING:
    from airhilt.record import RunFolder
    from airhilt.report.data import RunData

STATE = "truth/state/"
KEYS = (
    STATE, "adsb/", "advisory/", "asr/", "camera/", "equipment/", "radio/", "seat/",
    "truth/camera/", "truth/hearing/", "truth/radio/", "tts/", "vision/",
)  # fmt: skip
"""Beginnings of the keys of the messages that are read."""


class RecordedMessages(Content):
    """Keeps what the page of a recorded run shows.

    Attributes
    ----------
    states
        True states of the actors, in the order of their times.
    spoken
        Advisories that the assistant spoke.
    cameras
        Pictures of each camera.
    heard_at_seats
        Transmissions with sound at the receivers of seats, by frequency and seat, such as
        ``119100@AAL123``.
    """

    def __init__(self, folder: RunFolder) -> None:
        super().__init__(folder)
        self.states: dict[str, list[StateRow]] = {}
        self.spoken: list[AdvisoryAudio] = []
        self.cameras: dict[str, CameraRecord] = {}
        self.heard_at_seats: dict[str, list[SeatAudioClosed]] = {}
        self._calls = CallRecords()
        self._advisories = AdvisoryRows()
        self._bars = LatencyBars()
        self._latencies: list[Any] = []

    @property
    def frequencies_khz(self) -> list[int]:
        """Frequencies on which something was heard."""
        received = (call.received for call in self._calls)
        return sorted({one.frequency_khz for one in received if one and one.samples})

    def take(self, logged: Logged) -> None:
        """Receive a message."""
        if logged.key.startswith(STATE):
            state = ActorTruth.model_validate_json(logged.data)
            self.states.setdefault(state.actor, []).append(state_row(state))
        elif logged.key.startswith("seat/") and logged.key.endswith("/audio"):
            audio = decode(logged.key, logged.data)
            if isinstance(audio, SeatAudioClosed) and audio.samples:
                name = f"{audio.frequency_khz}@{key_chunk(audio.seat)}"
                self.heard_at_seats.setdefault(name, []).append(audio)
        elif (model := bus_message(logged.key)) is not None:
            message = model.model_validate_json(logged.data)
            self._calls.take(message)
            if (bar := self._bars.bar(message)) is not None:
                self._latencies.append(bar)
            match message:
                case AdvisoryAudio():
                    self.spoken.append(message)
                case Advisory() | EquipmentAlert():
                    self._advisories.add(message)
                case CameraInfo():
                    self.cameras[message.camera] = CameraRecord(message)
                case CameraFrame() | CameraTruth() | Detections() if message.camera in self.cameras:
                    self.cameras[message.camera].take(message)

    def as_json(self, run: RunData) -> dict[str, Any]:  # noqa: ARG002
        """Return the parts of the document of a debrief that come from these messages."""
        calls = [row for call in self._calls if (row := call_as_json(call)) is not None]
        return {
            "calls": sorted(calls, key=lambda call: call["from"]),
            "spoken": [spoken_as_json(audio) for audio in self.spoken],
            "advisories": self._advisories.as_json(),
            "cameras": [one.summary() for one in self.cameras.values() if one.exposures],
            "latencies": self._latencies,
        }
