"""Voices of a service: JSON ``{text, voice, rate, pitch}`` goes there, a WAV file comes back."""

from __future__ import annotations

import json

from airhilt.audio.pcm import Audio
from airhilt.audio.wav import decode_wav
from airhilt.engines import Engine
from airhilt.errors import SpeechError
from airhilt.services import USAGE, HttpService, is_service
from airhilt.voices.engine import VoiceSpec

TIMEOUT_S = 30.0
MAXIMUM_BYTES = 20_000_000
"""Of one answer: ten minutes of speech."""


class HttpTts:
    """Speaks with a service that answers POST requests with 16 kHz, mono, 16-bit WAV.

    A speaker's voice has the speaker's name, and the service makes of it what it likes, but the
    same every time.

    Parameters
    ----------
    version
        Of the service's model: another one has its lines synthesised anew.
    """

    name = "http"

    def __init__(self, url: str, timeout_s: float = TIMEOUT_S, version: str = "1") -> None:
        self._service = HttpService("voice http", url, timeout_s, MAXIMUM_BYTES, SpeechError)
        self.version = f"{url} {version}"

    def voice_of(self, speaker: str) -> VoiceSpec:
        """Return a voice with the speaker's name."""
        return VoiceSpec(speaker)

    def synthesise(self, text: str, voice: VoiceSpec) -> Audio:
        """Return the text as the service speaks it."""
        asked = {"text": text, "voice": voice.name, "rate": voice.rate, "pitch": voice.pitch}
        answer = self._service.post(json.dumps(asked).encode(), "application/json")
        return decode_wav(answer, f"voice http: answer of {self._service.url}")


ENGINE = Engine(
    name="http",
    summary="service that takes JSON and answers WAV",
    create=HttpTts,
    takes=is_service,
    usage=USAGE,
)
