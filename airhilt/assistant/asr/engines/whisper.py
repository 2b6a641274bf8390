"""Whisper, by faster-whisper: any model that CTranslate2 has converted."""

from __future__ import annotations

import math
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from airhilt.assistant.asr.engine import Recognised
from airhilt.audio.pcm import SAMPLE_RATE_HZ, Audio
from airhilt.engines import Engine, Package
from airhilt.errors import SpeechError, first_line
from airhilt.phraseology.canonical import canonical
from airhilt.phraseology.telephony import TELEPHONY

MODEL_FILES = ("config.json", "model.bin", "tokenizer.json")
"""Files of a folder that CTranslate2's converter made from Whisper.

It was called with ``--copy_files tokenizer.json preprocessor_config.json``: without tokenizer.json,
faster-whisper would look for one on the network."""
LANGUAGE = "en"
LEAST_SPEECH_S = 0.3
"""Least duration of speech in a call, in s: two syllables."""
SPEECH_PROBABILITY = 0.35
"""Threshold of the voice activity detector (Silero VAD, which comes with faster-whisper).

It is below the usual 0.5: a lost call is worse than noise that the model looks at."""
NO_SPEECH_PROBABILITY = 0.6
"""Probability of no speech by Whisper itself (openai/whisper, `no_speech_threshold`)."""
LEAST_LOG_PROBABILITY = -1.0
"""Mean log-probability of a segment below which that counts (openai/whisper,
`logprob_threshold`)."""
BEAMS = 5


class Whisper:
    """Recognises with a Whisper model, offline if it is a folder.

    Noise alone gives nothing: a detector of voice activity is asked first, then the model itself
    whether there is speech. It begins with the roster's callsigns as hot words. Confidence is the
    mean of the words', and no better than the model's.

    Parameters
    ----------
    model
        A folder, or the name of a model of the Hugging Face hub.

    Raises
    ------
    SpeechError
        The package or files of the model are missing, or do not load.
    """

    def __init__(self, model: str) -> None:
        folder = Path(model)
        if folder.is_dir():
            _require_files(folder)
        elif folder.exists() or folder.is_absolute() or model.startswith("."):
            raise SpeechError(f"ASR whisper: {model}: no folder; expected {_expected()}")
        self.name = f"whisper:{folder.resolve().name if folder.is_dir() else model}"
        try:
            from faster_whisper import WhisperModel
            from faster_whisper.vad import get_speech_timestamps
        except ImportError as error:
            raise SpeechError(
                "ASR whisper: the package faster-whisper is missing or does not load "
                f"({first_line(error)}); install it with `pip install airhilt[whisper]`"
            ) from None
        self._speech_of: Any = get_speech_timestamps
        try:
            self._model: Any = WhisperModel(model, compute_type="auto")
        except Exception as error:  # the network's, the disk's, CTranslate2's
            raise SpeechError(
                f"ASR whisper: {model}: does not load: {first_line(error)}; expected "
                f"{_expected()}, or the name of a model that can be downloaded"
            ) from None
        _require_features(model, self._model)
        # faster-whisper 1.2 pads every window to the 3000 frames of Whisper's own models.
        encode, frames = self._model.encode, self._model.feature_extractor.nb_max_frames
        self._model.encode = lambda features: encode(features[..., :frames])

    def recognise(self, audio: Audio, callsigns: Sequence[str]) -> Recognised:
        """Return what was said; nothing if nobody speaks."""
        if audio.size < LEAST_SPEECH_S * SAMPLE_RATE_HZ:
            return Recognised("", (), 1.0)
        speech = self._speech_of(audio, threshold=SPEECH_PROBABILITY, speech_pad_ms=0)
        samples = sum(each["end"] - each["start"] for each in speech)
        if samples < LEAST_SPEECH_S * SAMPLE_RATE_HZ:
            return Recognised("", (), 1.0)
        try:
            segments, _ = self._model.transcribe(
                audio,
                language=LANGUAGE,
                beam_size=BEAMS,
                temperature=0.0,
                condition_on_previous_text=False,
                no_speech_threshold=NO_SPEECH_PROBABILITY,
                log_prob_threshold=LEAST_LOG_PROBABILITY,
                word_timestamps=True,
                hotwords=hot_words(callsigns) or None,
            )
            found = list(segments)
        except (RuntimeError, ValueError) as error:
            raise SpeechError(f"ASR whisper: {self.name} failed: {first_line(error)}") from None
        words = canonical(
            (word.word, _probability(word.probability))
            for segment in found
            for word in segment.words or ()
        )
        if not words:
            return Recognised("", (), 1.0)
        by_word = float(np.mean([confidence for _, confidence in words]))
        by_model = min(_probability(math.exp(segment.avg_logprob)) for segment in found)
        return Recognised(" ".join(word for word, _ in words), words, min(by_word, by_model))


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


def _expected() -> str:
    return f"a folder with {', '.join(MODEL_FILES)}"


def _require_files(folder: Path) -> None:
    if missing := [name for name in MODEL_FILES if not (folder / name).is_file()]:
        raise SpeechError(
            f"ASR whisper: {folder}: without {', '.join(missing)}; expected {_expected()}, as "
            "`ct2-transformers-converter --copy_files tokenizer.json preprocessor_config.json` "
            "makes it"
        )


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
    summary="Whisper by faster-whisper, from a folder or the Hugging Face hub",
    create=Whisper,
    argument="FOLDER_OR_NAME",
    is_argument_required=True,
    takes=lambda text: (Path(text) / "model.bin").is_file(),
    requires=(Package("faster-whisper", extra="whisper"),),
)
