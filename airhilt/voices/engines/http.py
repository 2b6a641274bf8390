"""Voices of an HTTP service: OpenAI's API, or one that takes a text in JSON. Both answer WAV."""

from __future__ import annotations

import hashlib
from urllib.parse import urldefrag, urlsplit

from pydantic import BaseModel

from airhilt.audio.pcm import Audio
from airhilt.audio.wav import decode_speech
from airhilt.engines import Engine
from airhilt.errors import SpeechError
from airhilt.host.services import USAGE, HttpService, is_service, key_of
from airhilt.voices.engine import VoiceSpec
from airhilt.voices.service_messages import LineRequest, SpeechRequest

SPEECH_PATH = "/audio/speech"
"""End of the path of OpenAI's API."""
DEFAULT_MODEL = "tts-1"
"""Name of the model unless the fragment of the address names another."""
KEY_VARIABLE = "AIRHILT_TTS_KEY"
"""Environment variable with the key of the service; it is sent, and written nowhere."""
TIMEOUT_S = 30.0
MAXIMUM_BYTES = 20_000_000
"""Largest size of an answer: ten minutes of speech."""
PROBE = "Radio check."


class HttpTts:
    """Speaks with a service that answers WAV, mono, 16 bits, of any sample rate.

    A path that ends with `SPEECH_PATH` gets a `SpeechRequest`, any other a `LineRequest`. What
    follows ``#`` in the address is the name of the model and, after commas, the voices to choose
    from. Without them, the voice of a speaker has the speaker's name, and the service chooses what
    it sounds like. The same voice must sound the same every time.
    """

    name = "http"

    def __init__(self, url: str, timeout_s: float = TIMEOUT_S) -> None:
        address, names = urldefrag(url)
        key = key_of(KEY_VARIABLE, "voice http", SpeechError)
        self._service = HttpService(
            "voice http", address, timeout_s, MAXIMUM_BYTES, SpeechError, key
        )
        model, *self._voices = names.split(",")
        self._model = model or DEFAULT_MODEL
        self._is_openai = urlsplit(address).path.endswith(SPEECH_PATH)
        self.version = url

    def voice_of(self, speaker: str) -> VoiceSpec:
        """Return one of the voices of the address, drawn from the name; or a voice of that name."""
        if not self._voices:
            return VoiceSpec(speaker)
        digest = hashlib.sha256(speaker.encode()).digest()
        return VoiceSpec(self._voices[digest[0] % len(self._voices)])

    def synthesise(self, text: str, voice: VoiceSpec) -> Audio:
        """Return the text as the service speaks it."""
        request = self._request(text, voice).model_dump_json().encode()
        source = f"voice http: answer of {self._service.url}"
        with self._service.attempt():
            return decode_speech(self._service.post(request, "application/json"), source)

    def probe(self) -> None:
        """Let it say `PROBE`.

        Raises
        ------
        SpeechError
            There is no service, or its answer is no speech.
        """
        self.synthesise(PROBE, self.voice_of("TOWER"))

    def _request(self, text: str, voice: VoiceSpec) -> BaseModel:
        if self._is_openai:
            return SpeechRequest(model=self._model, input=text, voice=voice.name, speed=voice.rate)
        return LineRequest(text=text, voice=voice.name, rate=voice.rate, pitch=voice.pitch)


ENGINE = Engine(
    name="http",
    summary="service of OpenAI's API, or one that takes JSON; both answer WAV",
    create=HttpTts,
    takes=is_service,
    usage=USAGE,
    is_remote=True,
    probe=lambda url: HttpTts(url).probe(),
)
