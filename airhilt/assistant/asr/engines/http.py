"""A recogniser at an address: OpenAI's API, the server of whisper.cpp, or one that takes WAV."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from urllib.parse import urldefrag, urlsplit

import numpy as np

from airhilt.assistant.asr.engine import Call, Recognised
from airhilt.assistant.asr.engines.whisper import hot_words
from airhilt.assistant.asr.service_messages import (
    TranscribedWord,
    Transcription,
    TranscriptionForm,
)
from airhilt.audio.pcm import SAMPLE_RATE_HZ, Audio
from airhilt.audio.wav import encode_wav
from airhilt.engines import Engine
from airhilt.errors import SpeechError
from airhilt.host.forms import encoded_form
from airhilt.host.service_headers import ServiceHeaders
from airhilt.host.services import USAGE, HttpService, is_service, key_of
from airhilt.phraseology.canonical import WordConfidence, canonical
from airhilt.units import MILLISECOND_NS

FORM_PATHS = ("/audio/transcriptions", "/inference")
"""Ends of the paths of OpenAI's API and of the server of whisper.cpp."""
DEFAULT_MODEL = "whisper-1"
"""Name of the model unless the fragment of the address names another."""
KEY_VARIABLE = "AIRHILT_ASR_KEY"
"""Environment variable with the key of the service; it is sent, and written nowhere."""
TIMEOUT_S = 30.0
MAXIMUM_BYTES = 1_000_000
"""Size of the largest answer."""
WORDS_PER_S = 10.0
"""Largest number of words in a second of audio, and as many more in all: twice fast speech."""
LETTERS_PER_WORD = 20
"""Largest number of letters of a text for each word that it may have."""
EXPECTED = 'JSON such as {"text": "...", "words": [{"word": "...", "probability": 0.9}]}'
PROBE = np.zeros(SAMPLE_RATE_HZ, np.float32)
"""A second of silence."""


class HttpAsr:
    """Asks a service about each call, with `ServiceHeaders`.

    A path that ends with one of `FORM_PATHS` gets a `TranscriptionForm`, any other the call alone:
    16 kHz, mono, 16-bit WAV. The answer is a `Transcription`. What follows ``#`` in the address is
    the name of the model.

    Confidence is that of the answer; otherwise the mean of its words', and at most the mean
    probability of a token in the least sure segment, as for Whisper in the process. What the
    service does not tell is 1.
    """

    name = "http"

    def __init__(self, url: str, timeout_s: float = TIMEOUT_S) -> None:
        address, model = urldefrag(url)
        key = key_of(KEY_VARIABLE, "ASR http", SpeechError)
        self._service = HttpService("ASR http", address, timeout_s, MAXIMUM_BYTES, SpeechError, key)
        self._takes_forms = urlsplit(address).path.endswith(FORM_PATHS)
        self._model = model or DEFAULT_MODEL

    def recognise(self, audio: Audio, callsigns: Sequence[str]) -> Recognised:
        """Return what the service makes of audio of which nothing else is known."""
        return self._recognise(audio, callsigns, ServiceHeaders(callsigns=tuple(callsigns)))

    def recognise_call(self, audio: Audio, call: Call) -> Recognised:
        """Return what the service makes of a call, and tell it which that is."""
        headers = ServiceHeaders(
            ts_ms=call.t_tx_ns // MILLISECOND_NS,
            turn_id=call.id,
            frequency_khz=call.frequency_khz,
            speaker=call.speaker,
            callsigns=call.callsigns,
        )
        return self._recognise(audio, call.callsigns, headers)

    def probe(self) -> None:
        """Ask about a second of silence.

        Raises
        ------
        SpeechError
            There is no service, or its answer is none.
        """
        self.recognise(PROBE, ())

    def _recognise(
        self, audio: Audio, callsigns: Sequence[str], headers: ServiceHeaders
    ) -> Recognised:
        """Return what the service makes of audio; it is not asked about empty audio."""
        if not audio.size:
            return Recognised("", (), 1.0)
        body, content_type = encode_wav(audio), "audio/wav"
        if self._takes_forms:
            form = TranscriptionForm(file=body, model=self._model, prompt=hot_words(callsigns))
            body, content_type = encoded_form(form.fields())
        with self._service.attempt():
            data = self._service.post(body, content_type, headers.encoded())
            answer = self._service.parsed(data, Transcription, EXPECTED)
            self._require_sayable(answer, len(audio) / SAMPLE_RATE_HZ)
        return understood(answer)

    def _require_sayable(self, answer: Transcription, duration_s: float) -> None:
        most = int(WORDS_PER_S * (1.0 + duration_s))
        for text in (answer.text, " ".join(word.word for word in answer.all_words())):
            count = len(text.split())
            if count > most or len(text) > most * LETTERS_PER_WORD:
                raise self._service.error(
                    f"answered {count} words ({len(text)} letters) to {duration_s:.1f} s of audio",
                    f"at most {most} words, more than anybody says in that time",
                )


def understood(answer: Transcription) -> Recognised:
    """Return an answer in the form of transcripts."""
    given = list(_whole_words(answer))
    words = canonical(given or [(answer.text, 1.0)])
    by_model = [math.exp(each.avg_logprob) for each in answer.segments or () if each.avg_logprob]
    confidence = answer.confidence
    if confidence is None:
        by_word = float(np.mean([each for _, each in words])) if words else 1.0
        confidence = min((by_word, *by_model)) if words else 1.0
    return Recognised(" ".join(word for word, _ in words), words if given else (), confidence)


def _whole_words(answer: Transcription) -> Iterator[WordConfidence]:
    """Yield words with their confidences; pieces of one word are joined, and as sure as the least.

    Words have blanks before them, or none has.
    """
    words = answer.all_words()
    are_pieces = any(word.word.startswith(" ") for word in words)
    text, confidence = "", 1.0
    for word in words:
        sure = _confidence(word, answer)
        if text and are_pieces and not word.word.startswith(" "):
            text, confidence = text + word.word, min(confidence, sure)
            continue
        if text:
            yield text, confidence
        text, confidence = word.word, sure
    if text:
        yield text, confidence


def _confidence(word: TranscribedWord, answer: Transcription) -> float:
    """Return the confidence of a word, or that of the last segment which begins before it."""
    if word.probability is not None:
        return word.probability
    begin_s = 0.0 if word.start is None else word.start
    sure = [
        each.avg_logprob
        for each in answer.segments or ()
        if each.avg_logprob is not None and (each.start or 0.0) <= begin_s
    ]
    return math.exp(sure[-1]) if sure else 1.0


ENGINE = Engine(
    name="http",
    summary="service of OpenAI's API or whisper.cpp, or one that takes WAV and answers JSON",
    create=HttpAsr,
    takes=is_service,
    usage=USAGE,
    is_remote=True,
    probe=lambda url: HttpAsr(url).probe(),
)
