"""The embedded recogniser: a network that knows the words of aviation and no others.

It is a connectionist temporal classification model (Graves et al., ICML 2006) in ONNX, trained
by ``tools/train_asr.py``. Its words are those that a call can have, so that noise does not become
fluent sentences; and where its best guess is poor it says nothing.
"""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import dataclass
from importlib import resources
from importlib.resources.abc import Traversable
from itertools import pairwise
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from airhilt.errors import SpeechError
from airhilt.radio.voices.engine import Audio
from airhilt.workers.asr.engine import Recognised
from airhilt.workers.asr.features import mel_power, normalised

FILES = ("ctc.onnx", "words.txt", "card.json")
LEAST_SAMPLES = 1_600
"""A tenth of a second: less holds no word."""


@dataclass(frozen=True)
class Calibration:
    """From a posterior to how often it is right: a logistic curve over its log-odds."""

    slope: float
    offset: float

    def __call__(self, posterior: float) -> float:
        """Return the share of guesses with this posterior that are right."""
        bounded = min(max(posterior, 1e-6), 1.0 - 1e-6)
        log_odds = float(np.log(bounded / (1.0 - bounded)))
        return float(1.0 / (1.0 + np.exp(-(self.slope * log_odds + self.offset))))


class Ctc:
    """Recognises with the embedded model, or another of its kind.

    Parameters
    ----------
    folder
        Holds ``ctc.onnx``, ``words.txt`` (a word a line) and ``card.json``; None is the model
        that ships with AIRHILT.

    Raises
    ------
    SpeechError
        A file is missing, or they do not fit together.
    """

    name = "embedded"

    def __init__(self, folder: Path | None = None) -> None:
        where: Traversable = folder or resources.files("airhilt.workers.asr") / "model"
        missing = [name for name in FILES if not (where / name).is_file()]
        if missing:
            raise SpeechError(
                f"recogniser {self.name}: {where} lacks {', '.join(missing)}; expected "
                f"{', '.join(FILES)}, as tools/train_asr.py writes them"
            )
        self._words = (where / "words.txt").read_text(encoding="utf-8").split()
        try:
            card = json.loads((where / "card.json").read_text(encoding="utf-8"))
            self._word = Calibration(**card["word_calibration"])
            self._call = Calibration(**card["call_calibration"])
            self._least = float(card["least_word_confidence"])
        except (ValueError, KeyError, TypeError) as error:
            raise SpeechError(
                f"recogniser {self.name}: {where / 'card.json'} is no model card: {error!r}"
            ) from None
        self._session = _session(self.name, (where / "ctc.onnx").read_bytes())
        outputs = self._session.get_outputs()[0].shape[-1]
        if outputs != len(self._words) + 1:
            raise SpeechError(
                f"recogniser {self.name}: {where} does not fit together: ctc.onnx tells {outputs} "
                f"units apart, words.txt has {len(self._words)}; expected one unit more than words"
            )

    def recognise(self, audio: Audio, callsigns: Sequence[str]) -> Recognised:  # noqa: ARG002
        """Return the words of a call; see `AsrEngine.recognise`."""
        if len(audio) < LEAST_SAMPLES:
            return Recognised("", (), 0.0)
        if not np.isfinite(audio).all():
            raise SpeechError(f"recogniser {self.name}: the audio has samples that are no numbers")
        posteriors = self.posteriors(audio)
        words = [
            (self._words[unit - 1], self._word(posterior))
            for unit, posterior in best_path(posteriors)
        ]
        kept = tuple(each for each in words if each[1] >= self._least)
        if not kept:
            return Recognised("", (), 0.0)
        whole = float(np.prod([confidence for _, confidence in words]))
        return Recognised(" ".join(word for word, _ in kept), kept, self._call(whole))

    def posteriors(self, audio: Audio) -> NDArray[np.float32]:
        """Return the posterior of the blank and of each word, shape (steps of 60 ms, units)."""
        features = normalised(mel_power(audio))[None]
        logits = self._session.run(None, {"features": features})[0][0]
        weights = np.exp(logits - logits.max(axis=1, keepdims=True))
        return np.asarray(weights / weights.sum(axis=1, keepdims=True), np.float32)


def best_path(posteriors: NDArray[np.float32]) -> list[tuple[int, float]]:
    """Return the units of the likeliest path without blanks, each with its highest posterior."""
    units = posteriors.argmax(axis=1)
    peaks = posteriors.max(axis=1)
    changes = np.flatnonzero(np.diff(units)) + 1
    bounds = [0, *changes.tolist(), len(units)]
    return [
        (int(units[begin]), float(peaks[begin:end].max()))
        for begin, end in pairwise(bounds)
        if units[begin] != 0
    ]


def _session(name: str, model: bytes):  # type: ignore[no-untyped-def]  # noqa: ANN202
    import onnxruntime

    options = onnxruntime.SessionOptions()
    options.intra_op_num_threads = 1
    options.inter_op_num_threads = 1
    options.log_severity_level = 3
    try:
        return onnxruntime.InferenceSession(model, options, providers=["CPUExecutionProvider"])
    except Exception as error:  # onnxruntime raises classes of its own that share no base
        raise SpeechError(
            f"recogniser {name}: ctc.onnx is no model that onnxruntime can run: {error}"
        ) from None
