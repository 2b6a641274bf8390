"""The sounds that receivers of seats gave out in a recorded run."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

from pydantic import TypeAdapter

from airhilt.messages import SeatAudio, SeatAudioClosed, key_chunk
from airhilt.record import Logged, RunFolder
from airhilt.report.sections import Content

if TYPE_CHECKING:
    from airhilt.report.data import RunData

KEYS = ("seat/",)
"""Beginnings of the keys of the messages about seats."""
_AUDIO = TypeAdapter[SeatAudio](SeatAudio)


class SeatSounds(Content):
    """Sound that receivers of seats gave out, by frequency and seat."""

    def __init__(self, folder: RunFolder) -> None:
        super().__init__(folder)
        self._heard: dict[str, list[SeatAudioClosed]] = {}

    @property
    def heard(self) -> Mapping[str, list[SeatAudioClosed]]:
        """The transmissions with sound, by frequency and seat, such as ``119100@AAL123``."""
        return self._heard

    def take(self, logged: Logged) -> None:
        """Receive a message about a seat."""
        if not logged.key.endswith("/audio"):
            return
        message = _AUDIO.validate_json(logged.data)
        if isinstance(message, SeatAudioClosed) and message.samples:
            name = f"{message.frequency_khz}@{key_chunk(message.seat)}"
            self._heard.setdefault(name, []).append(message)

    def as_json(self, run: RunData) -> list[str]:  # noqa: ARG002
        """Return the names of the sounds."""
        return list(self._heard)
