"""Voices of an HTTP service: the request is JSON, the answer a WAV file."""

from __future__ import annotations

import json

from airhilt.audio.pcm import Audio
from airhilt.audio.wav import decode_wav
from airhilt.engines import Engine
from airhilt.errors import SpeechError
from airhilt.host.services import USAGE, HttpService, is_service
from airhilt.voices.engine import VoiceSpec

TIMEOUT_S = 30.0
MAXIMUM_BYTES = 20_000_000
"""Largest size of an answer: ten minutes of speech."""


class HttpTts:
    """Speaks with a service that answers POST requests with 16 kHz, mono, 16-bit WAV.

    The voice of a speaker has the speaker's name. The service chooses what it sounds like, and
    must choose the same every time.
    """

    name = "http"

    def __init__(self, url: str, timeout_s: float = TIMEOUT_S) -> None:
        self._service = HttpService("voice http", url, timeout_s, MAXIMUM_BYTES, SpeechError)
        self.version = url

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
    is_remote=True,
)
