"""Whisper, by faster-whisper: any model that CTranslate2 has converted."""

from __future__ import annotations

import math
from collections.abc import Sequence
from pathlib import Path
from typing import Annotated, Any

import numpy as np
from pydantic import Field

from airhilt.assistant.asr.engine import Recognised
from airhilt.assistant.asr.whisper_models import EXPECTED, missing_package, require_model
from airhilt.audio.pcm import SAMPLE_RATE_HZ, Audio
from airhilt.configuration import Configuration, Seconds, Share
from airhilt.engines import Engine, Package
from airhilt.errors import SpeechError, first_line
from airhilt.phraseology.canonical import canonical
from airhilt.phraseology.telephony import TELEPHONY

LANGUAGE = "en"
SEED = 0
"""Seed of what is drawn at temperatures above 0."""

Temperature = Annotated[float, Field(ge=0.0, le=1.0)]


class WhisperSettings(Configuration):
    """Settings of the decoding of a call, and of what is rejected.

    Where openai/whisper is the source, the default is that of `transcribe` in its transcribe.py.
    """

    beam_size: int = Field(5, ge=1, le=100, description="beams at temperature 0")
    temperatures: tuple[Temperature, ...] = Field(
        (0.0, 0.2, 0.4, 0.6, 0.8, 1.0),
        min_length=1,
        max_length=10,
        description="tried in turn until a result is neither repetitive nor improbable "
        "(openai/whisper, temperature)",
    )
    compression_ratio_threshold: float = Field(
        2.4,
        gt=0.0,
        description="length of a text over that of its zlib compression, above which it repeats "
        "itself: the next temperature is tried, and the text of the last one is rejected "
        "(openai/whisper, compression_ratio_threshold)",
    )
    log_prob_threshold: float = Field(
        -1.0,
        le=0.0,
        description="mean log-probability of a token below which the next temperature is tried "
        "(openai/whisper, logprob_threshold)",
    )
    no_speech_threshold: Share = Field(
        0.6,
        description="probability of no speech above which an improbable text is silence "
        "(openai/whisper, no_speech_threshold)",
    )
    repetition_penalty: float = Field(
        1.0,
        ge=1.0,
        le=10.0,
        description="penalty on tokens that were said before; 1: none, because digits recur in "
        "right calls",
    )
    no_repeat_ngram_size: int = Field(
        16,
        ge=0,
        le=100,
        description="number of tokens in a row that are not said twice, so that a loop is short; "
        "0: no limit. What a call says again is shorter. A loop that is broken off after 16 tokens "
        "still has a compression ratio of more than 2.4, if its period is of up to 8 words; no "
        "text of the exams of recognition (tools/phraseology_judge) has more than 1.7",
    )
    least_speech_s: Seconds = Field(
        0.3, description="duration of speech, in s, below which nobody speaks: two syllables"
    )
    speech_threshold: Share = Field(
        0.35,
        description="threshold of the voice activity detector (Silero VAD, which comes with "
        "faster-whisper). It is below the usual 0.5: a lost call is worse than noise that the "
        "model looks at",
    )


DEFAULTS = WhisperSettings()


class Whisper:
    """Recognises with a Whisper model that is on this machine.

    Noise alone gives nothing: a detector of voice activity is asked first, then the model itself
    whether there is speech. It begins with the roster's callsigns as hot words.

    Confidence is the mean of the words', and no better than the model's. Text that repeats itself
    at every temperature is rejected: the confidence is then that nobody spoke.

    Parameters
    ----------
    model
        A folder, or the name of a model that was downloaded (`whisper_models`).

    Raises
    ------
    SpeechError
        The package or files of the model are missing, or do not load.
    """

    def __init__(self, model: str, settings: WhisperSettings = DEFAULTS) -> None:
        folder = require_model(model)
        self.name = f"whisper:{folder.resolve().name if Path(model).is_dir() else model}"
        self._settings = settings
        try:
            from ctranslate2 import set_random_seed
            from faster_whisper import WhisperModel
            from faster_whisper.vad import get_speech_timestamps
        except ImportError as error:
            raise SpeechError(missing_package(error)) from None
        self._speech_of: Any = get_speech_timestamps
        set_random_seed(SEED)  # A model draws in a thread of its own, which begins with this.
        try:
            self._model: Any = WhisperModel(str(folder), compute_type="auto")
        except Exception as error:  # the disk's, CTranslate2's
            raise SpeechError(
                f"ASR whisper: {folder}: does not load: {first_line(error)}; expected {EXPECTED}"
            ) from None
        _require_features(model, self._model)
        # faster-whisper 1.2 pads every window to the 3000 frames of Whisper's own models.
        encode, frames = self._model.encode, self._model.feature_extractor.nb_max_frames
        self._model.encode = lambda features: encode(features[..., :frames])

    def recognise(self, audio: Audio, callsigns: Sequence[str]) -> Recognised:
        """Return what was said; nothing if nobody speaks."""
        settings = self._settings
        least_samples = settings.least_speech_s * SAMPLE_RATE_HZ
        if audio.size < least_samples:
            return Recognised("", (), 1.0)
        speech = self._speech_of(audio, threshold=settings.speech_threshold, speech_pad_ms=0)
        if sum(each["end"] - each["start"] for each in speech) < least_samples:
            return Recognised("", (), 1.0)
        try:
            segments, _ = self._model.transcribe(
                audio,
                language=LANGUAGE,
                beam_size=settings.beam_size,
                temperature=settings.temperatures,
                compression_ratio_threshold=settings.compression_ratio_threshold,
                log_prob_threshold=settings.log_prob_threshold,
                no_speech_threshold=settings.no_speech_threshold,
                repetition_penalty=settings.repetition_penalty,
                no_repeat_ngram_size=settings.no_repeat_ngram_size,
                condition_on_previous_text=False,
                word_timestamps=True,
                hotwords=hot_words(callsigns) or None,
            )
            found = list(segments)
        except (RuntimeError, ValueError) as error:
            raise SpeechError(f"ASR whisper: {self.name} failed: {first_line(error)}") from None
        return understood(found, settings.compression_ratio_threshold)


def understood(segments: Sequence[Any], compression_ratio_threshold: float) -> Recognised:
    """Return segments of faster-whisper in the form of transcripts, without those that loop.

    What was said in a segment that loops is lost. So the confidence is at most the probability that
    nothing was said there.
    """
    kept = [each for each in segments if each.compression_ratio <= compression_ratio_threshold]
    loops = [each for each in segments if each.compression_ratio > compression_ratio_threshold]
    words = canonical(
        (word.word, _probability(word.probability))
        for segment in kept
        for word in segment.words or ()
    )
    limits = [_probability(each.no_speech_prob) for each in loops]
    if not words:
        return Recognised("", (), min(limits, default=1.0))
    limits += [_probability(math.exp(each.avg_logprob)) for each in kept]
    by_word = float(np.mean([confidence for _, confidence in words]))
    return Recognised(" ".join(word for word, _ in words), words, min(by_word, *limits))


def hot_words(callsigns: Sequence[str]) -> str:
    """Return the text that stands before each window, in Whisper's own spelling.

    It is given as hot words and not as an initial prompt: faster-whisper puts both in the same
    place, but the initial prompt before the first window only.
    """
    return ", ".join(map(_as_written, callsigns))


def _as_written(callsign: str) -> str:
    """Return a callsign as Whisper writes it: American 123."""
    designator, flight = callsign[:3], callsign[3:]
    if designator in TELEPHONY and flight[:1].isdigit():
        return f"{TELEPHONY[designator].title()} {flight}"
    return callsign


def _probability(number: float) -> float:
    return min(max(float(number), 0.0), 1.0)


def _require_features(name: str, model: Any) -> None:
    """Check that the model takes the mel bands that are computed for it."""
    bands = len(model.feature_extractor.mel_filters)
    if bands != model.model.n_mels:
        raise SpeechError(
            f"ASR whisper: {name}: the model takes {model.model.n_mels} mel bands, and not the "
            f"{bands} of its preprocessor_config.json; expected that file as it came with the "
            "model (without it, 80)"
        )


ENGINE = Engine(
    name="whisper",
    summary="Whisper by faster-whisper, from a folder or by the name of a downloaded model",
    create=Whisper,
    argument="FOLDER_OR_NAME",
    is_argument_required=True,
    takes=lambda text: (Path(text) / "model.bin").is_file(),
    requires=(Package("faster-whisper", extra="whisper"),),
    files=require_model,
    configuration=WhisperSettings,
)
