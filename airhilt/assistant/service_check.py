"""Asks a service what a run would, and says in words what is wrong with it."""

from __future__ import annotations

import time
import warnings
from collections.abc import Callable, Iterator, Mapping
from typing import Any

import numpy as np

from airhilt.assistant.asr.engine import Call, recognised
from airhilt.assistant.reference import reference_worker
from airhilt.assistant.service_kinds import FAMILY, ServiceKind
from airhilt.assistant.vision.detector import DetectsShots, Shot
from airhilt.audio.pcm import SAMPLE_RATE_HZ
from airhilt.host.services import is_service
from airhilt.messages import ASSISTANT
from airhilt.voices.engines.espeak import Espeak
from airhilt.workers.checker import check_worker
from airhilt.workers.samples import CALLSIGNS

PATIENCE_S = 60.0
"""Longest wall time of one step, in s: longer than any service may take."""
SAID = "American one two three, climb and maintain flight level three five zero."
WORDS_PER_S = (1.0, 6.0)
"""Least and greatest rate of words of speech that can be right, in 1/s."""
LEAST_PEAK = 0.01
"""Peak of speech, in parts of full scale, below which nobody hears it."""


def check_service(kind: ServiceKind, url: str) -> list[str]:
    """Ask a service what a run would, and return hints on what a run would make of it.

    It is probed as before a run, then asked as the worker is that a run makes of it, with the
    samples of `check_worker`, and at last with what shows whether its answers make sense.

    Raises
    ------
    AirhiltError
        It is not there, or something is wrong; the message has a line for each problem.
    """
    family = FAMILY[kind]
    if not is_service(url):
        raise family.error(f"{url!r} is no address; expected one such as http://127.0.0.1:8000/v1")
    engine, argument = family.choose(url)
    engine.probe(argument)
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        check_worker(reference_worker(kind, url), patience_s=PATIENCE_S)
    return [*(str(each.message) for each in caught), *_HINTS[kind](family.make(engine, argument))]


def _asr(engine: Any) -> Iterator[str]:
    voice = Espeak()
    audio = voice.synthesise(SAID, voice.voice_of("TOWER"))
    call = Call("check-1", 118_300, 0, None, CALLSIGNS)
    begun = time.perf_counter()
    heard = recognised(engine, audio, call)
    took_s = time.perf_counter() - begun
    yield (
        f"heard {heard.text!r} of {SAID!r}, with confidence {heard.confidence:.2f}, in "
        f"{took_s:.2f} s for {len(audio) / SAMPLE_RATE_HZ:.1f} s of audio"
    )
    if heard.text and not heard.words:
        yield "the answer has no words: no word has a confidence of its own"
    sure = {confidence for _, confidence in heard.words} | {heard.confidence}
    if heard.text and sure == {1.0}:
        yield (
            "the answer has no confidence, so all counts as sure: an assistant acts upon every "
            "word and never asks again; expected words with probability, or segments with "
            "avg_logprob"
        )
    if recognised(engine, audio, call) != heard:
        yield "the second answer to the same call is another one: two runs will differ"
    if (silence := recognised(engine, np.zeros_like(audio), call)).text:
        yield f"heard {silence.text!r} in silence; expected no words"


def _tts(engine: Any) -> Iterator[str]:
    voice = engine.voice_of(ASSISTANT)
    begun = time.perf_counter()
    speech = engine.synthesise(SAID, voice)
    took_s = time.perf_counter() - begun
    seconds = len(speech) / SAMPLE_RATE_HZ
    yield f"spoke {len(SAID.split())} words in {seconds:.1f} s of audio, in {took_s:.2f} s"
    least, greatest = WORDS_PER_S
    if not least <= len(SAID.split()) / seconds <= greatest:
        yield f"that is no speech: expected {least:g} to {greatest:g} words a second"
    if np.abs(speech).max() < LEAST_PEAK:
        yield "the speech is silent"
    again = engine.synthesise(SAID, voice)
    if len(again) != len(speech) or not np.array_equal(again, speech):
        yield (
            "the second answer to the same text is another one: two runs will differ where the "
            "cache of voices is not shared"
        )


def _vision(engine: Any) -> Iterator[str]:
    picture = np.full((240, 320, 3), 128, np.uint8)
    mask = np.zeros(picture.shape[:2], dtype=bool)
    mask[200:] = True
    assert isinstance(engine, DetectsShots)
    begun = time.perf_counter()
    found = list(engine.detect_shot(picture, Shot("check", 0, own_aircraft=mask)))
    yield f"looked at a picture in {time.perf_counter() - begun:.2f} s"
    if found:
        labels = ", ".join(sorted({each.label for each in found}))
        yield f"found {labels} in a grey picture; expected nothing"


def _decision(engine: Any) -> Iterator[str]:  # noqa: ARG001 - the samples of a worker are enough
    yield "answered a sample situation"


_HINTS: Mapping[ServiceKind, Callable[[Any], Iterator[str]]] = {
    "asr": _asr,
    "tts": _tts,
    "vision": _vision,
    "decision": _decision,
}
