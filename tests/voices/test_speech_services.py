"""Voices and recognisers behind an address, well and unwell."""

from __future__ import annotations

import io
import json
import wave
from http.server import BaseHTTPRequestHandler
from typing import get_args

import numpy as np
import pytest

from airhilt.assistant.asr.engines.http import HttpAsr
from airhilt.audio.pcm import to_pcm
from airhilt.audio.wav import decode_wav, encode_wav
from airhilt.errors import SpeechError
from airhilt.voices.engine import VoiceSpec
from airhilt.voices.engines.http import HttpTts
from services import (
    Slow,
    Slowness,
    answering,
    breaking_off,
    endless,
    nobody,
    redirecting,
    service,
)

TONE = np.sin(np.arange(16_000) / 9).astype(np.float32) * np.float32(0.5)
VOICE = VoiceSpec("AAL123", rate=1.1, pitch=0.9)


def speak(url: str, timeout_s: float = 5.0) -> np.ndarray:
    return HttpTts(url, timeout_s).synthesise("hello", VOICE)


def hear(url: str, timeout_s: float = 5.0) -> str:
    return HttpAsr(url, timeout_s).recognise(TONE, ["AAL123"]).text


def stereo() -> bytes:
    stream = io.BytesIO()
    with wave.open(stream, "wb") as file:
        file.setparams((2, 2, 16_000, 0, "NONE", ""))
        file.writeframes(bytes(4_000))
    return stream.getvalue()


def test_a_voice_is_asked_for_a_text_and_gives_a_sound() -> None:
    asked: list[dict[str, object]] = []

    def answer(handler: BaseHTTPRequestHandler, body: bytes) -> None:
        asked.append(json.loads(body))
        answering(encode_wav(TONE), kind="audio/wav")(handler, body)

    with service(answer) as url:
        heard = speak(url)
    assert asked == [{"text": "hello", "voice": "AAL123", "rate": 1.1, "pitch": 0.9}]
    assert np.abs(heard - TONE).max() < 1e-4


def wav(rate_hz: int, seconds: float = 1.0, size: int | None = None) -> bytes:
    """Return a tone of 440 Hz; with another size in its headers, as who streams it writes."""
    stream = io.BytesIO()
    with wave.open(stream, "wb") as file:
        file.setparams((1, 2, rate_hz, 0, "NONE", ""))
        file.writeframes(to_pcm(tone(rate_hz, seconds)))
    data = stream.getvalue()
    if size is None:
        return data
    sized = size.to_bytes(4, "little")
    return data[:4] + sized + data[8:40] + sized + data[44:]


def tone(rate_hz: int, seconds: float = 1.0) -> np.ndarray:
    times_s = np.arange(round(rate_hz * seconds)) / rate_hz
    return (0.5 * np.sin(2 * np.pi * 440.0 * times_s)).astype(np.float32)


@pytest.mark.parametrize("rate_hz", [8_000, 16_000, 22_050, 24_000, 44_100, 48_000])
def test_speech_of_any_rate_is_the_same_speech(rate_hz: int) -> None:
    with service(answering(wav(rate_hz), kind="audio/wav")) as url:
        heard = speak(url)
    assert len(heard) == 16_000
    assert np.abs(heard - tone(16_000))[400:-400].max() < 0.01


@pytest.mark.parametrize("size", [0x7FFF_FFFF, 0xFFFF_FFFF])
def test_speech_that_was_streamed_does_not_know_its_length(size: int) -> None:
    with service(answering(wav(24_000, size=size))) as url:
        assert len(speak(url)) == 16_000


@pytest.mark.parametrize("rate_hz", [1, 4_000, 2_000_000_000])
def test_a_rate_that_no_speech_has_is_refused(rate_hz: int) -> None:
    data = wav(16_000)
    lie = data[:24] + rate_hz.to_bytes(4, "little") + data[28:]
    with (
        service(answering(lie)) as url,
        pytest.raises(SpeechError, match=f"{rate_hz} Hz, mono.*expected 8000 to 96000 Hz"),
    ):
        speak(url)


def test_openais_form_has_the_model_and_a_voice_of_the_address() -> None:
    asked: list[dict[str, object]] = []

    def answer(handler: BaseHTTPRequestHandler, body: bytes) -> None:
        asked.append(json.loads(body))
        answering(wav(24_000))(handler, body)

    with service(answer) as url:
        address = url.replace("service", "v1/audio/speech")
        for names in ("", "#kokoro,adam,bella"):
            voices = HttpTts(address + names)
            voices.synthesise("hello", voices.voice_of("AAL123"))
        told = {voices.voice_of(f"AAL{number}").name for number in range(20)}
    assert asked == [
        {"model": "tts-1", "input": "hello", "voice": "AAL123", "response_format": "wav",
         "speed": 1.0},
        {"model": "kokoro", "input": "hello", "voice": voices.voice_of("AAL123").name,
         "response_format": "wav", "speed": 1.0},
    ]  # fmt: skip
    assert told == {"adam", "bella"}


def test_a_recogniser_is_given_a_wav_and_gives_words() -> None:
    given: list[np.ndarray] = []

    def answer(handler: BaseHTTPRequestHandler, body: bytes) -> None:
        given.append(decode_wav(body, "the request"))
        words = [{"text": "Run", "confidence": 0.9}, {"text": "way", "confidence": 0.8},
                 {"text": "1L.", "confidence": 0.7}]  # fmt: skip
        answering(json.dumps({"text": "Run way 1L.", "words": words}).encode())(handler, body)

    with service(answer) as url:
        recognised = HttpAsr(url).recognise(TONE, [])
    assert np.abs(given[0] - TONE).max() < 1e-4
    assert recognised.text == "runway one left"
    assert recognised.words == (("runway", 0.8), ("one", 0.7), ("left", 0.7))
    assert recognised.confidence == pytest.approx((0.8 + 0.7 + 0.7) / 3)


@pytest.mark.parametrize("use", [speak, hear])
class TestServiceThat:
    def test_is_down(self, use: object) -> None:
        url = nobody()
        with pytest.raises(SpeechError, match=f"{url} is not there: .*refused"):
            use(url)

    def test_has_no_address(self, use: object) -> None:
        for url in (
            "tower",
            "file:///etc/passwd",
            "http://",
            "http://[::1",
            "http://a:b/",
            "http://a/ b",
        ):
            with pytest.raises(SpeechError, match="is no address"):
                use(url)

    @pytest.mark.parametrize("how", get_args(Slowness))
    def test_is_slow(self, use: object, how: Slowness) -> None:
        slow = Slow(how, encode_wav(TONE) if use is speak else b'{"text": "too late"}')
        with service(slow) as url:
            with pytest.raises(SpeechError, match=r"has not answered for 0\.3 s"):
                use(url, 0.3)
            slow.released.set()

    def test_sends_elsewhere(self, use: object) -> None:
        asked: list[str] = []

        def elsewhere(handler: BaseHTTPRequestHandler, _body: bytes) -> None:
            asked.append(handler.path)

        with (
            service(elsewhere) as other,
            service(redirecting(other)) as url,
            pytest.raises(SpeechError, match=r"303 \(go to 'http://.*redirects are not followed"),
        ):
            use(url)
        assert asked == []

    def test_a_proxy_would_be_between(self, use: object, monkeypatch: pytest.MonkeyPatch) -> None:
        for name in ("http_proxy", "HTTP_PROXY", "all_proxy"):
            monkeypatch.setenv(name, nobody())
        monkeypatch.setenv("no_proxy", "")
        with (
            service(answering(b"here I am", 500)) as url,
            pytest.raises(SpeechError, match="here I am"),
        ):
            use(url)

    def test_fails(self, use: object) -> None:
        with (
            service(answering(b"out of memory", 500)) as url,
            pytest.raises(SpeechError, match="HTTP status 500: 'out of memory'"),
        ):
            use(url)

    def test_answers_without_an_end(self, use: object) -> None:
        with service(endless) as url, pytest.raises(SpeechError, match=r"more than [0-9]+ bytes"):
            use(url)

    def test_breaks_off(self, use: object) -> None:
        with service(breaking_off) as url, pytest.raises(SpeechError, match="broke off"):
            use(url)


@pytest.mark.parametrize(
    ("data", "said"),
    [
        (b"", "no WAV file"),
        (b'{"error": "no"}', "no WAV file"),
        (encode_wav(TONE)[:1_000], "truncated"),
        (stereo(), "2 channels"),
    ],
)
def test_a_voice_that_answers_no_speech_is_refused(data: bytes, said: str) -> None:
    with service(answering(data)) as url, pytest.raises(SpeechError) as refused:
        speak(url)
    assert url in str(refused.value)
    assert said in str(refused.value)


@pytest.mark.parametrize(
    "data",
    [
        b'{"text": "a", "confidence": 1.5}',
        b"\xff\xfe\x00",
    ],
)
def test_a_recogniser_that_answers_nonsense_is_refused(data: bytes) -> None:
    with service(answering(data)) as url, pytest.raises(SpeechError) as refused:
        hear(url)
    assert url in str(refused.value)
    assert 'expected JSON such as {"text"' in str(refused.value)


@pytest.mark.parametrize(
    "said",
    [
        {"text": "hello " * 21},
        {"text": "h" * 401},
        {"text": "hello", "words": [{"text": "hello", "confidence": 1.0}] * 21},
    ],
)
def test_a_recogniser_that_hears_more_than_anybody_says_is_refused(
    said: dict[str, object],
) -> None:
    with (
        service(answering(json.dumps(said).encode())) as url,
        pytest.raises(SpeechError, match=r"to 1\.0 s of audio; expected at most 20 words"),
    ):
        hear(url)


def test_a_recogniser_may_hear_as_much_as_a_fast_talker_says() -> None:
    with service(answering(json.dumps({"text": "hello " * 20}).encode())) as url:
        assert hear(url).split() == ["hello"] * 20
