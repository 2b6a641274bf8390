"""The embedded recogniser: a network that hears word pieces, and a language model of calls.

It is a connectionist temporal classification model (Graves et al., ICML 2006) in ONNX, trained
by ``tools/asr/train_asr.py``. Its pieces are words or parts of words. A search weighs what was
heard against what is usually said, and where its best guess is poor it says nothing.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache
from itertools import pairwise
from pathlib import Path
from typing import Annotated

import numpy as np
from numpy.typing import NDArray
from pydantic import BaseModel, ConfigDict, Field, ValidationError

from airhilt.assistant.asr.beam_search import BeamSearch, aligned
from airhilt.assistant.asr.confidences import (
    SILENCE,
    Gap,
    LossCurve,
    WordCurve,
    gaps,
    log_odds,
    log_odds_of,
    probability,
    same_units,
    with_same,
)
from airhilt.assistant.asr.engine import Recognised
from airhilt.assistant.asr.features import BINS, mel_power, normalised
from airhilt.assistant.asr.language import Language
from airhilt.assistant.asr.pieces import Pieces
from airhilt.assistant.asr.spotting import Odds, Spotted, Spotter, is_same
from airhilt.audio.pcm import Audio
from airhilt.engines import Engine
from airhilt.errors import SpeechError, first_line, first_problem
from airhilt.host.onnx import first_look, open_network
from airhilt.messages import Confidence

MODEL = Path(__file__).parents[1] / "model"
"""The model that ships with AIRHILT."""
FILES = ("ctc.onnx", "pieces.txt", "language.npz", "card.json")
"""Files of a model's folder."""
EXPECTED = "a network of tools/asr/train_asr.py: features [1, n, 64] to logits [1, n/3, pieces + 1]"
LEAST_SAMPLES = 1_600
"""Least number of samples that can hold a word: a tenth of a second."""
WINDOW_FRAMES = 3_000
"""Frames of features that the network computes at a time, half a minute.

A microphone that is stuck for ten minutes takes little memory then."""
CONTEXT_FRAMES = 1_080
"""Frames that the network sees on both sides of a window.

They are more than its convolutions and the means that weigh its channels reach."""
TRIAL_FRAMES = 12
"""Frames of a first look; the steps of the network must divide them."""


@dataclass(frozen=True)
class Calibration:
    """Probability by an estimate of it: a logistic curve over the log-odds of the estimate."""

    slope: float
    offset: float

    def __call__(self, estimate: float) -> float:
        """Return the probability by an estimate in [0, 1]."""
        return probability(self.slope * log_odds_of(estimate) + self.offset)


class Card(BaseModel):
    """The part of ``card.json`` that `Ctc` reads."""

    model_config = ConfigDict(extra="ignore", frozen=True, allow_inf_nan=False)
    word_curve: WordCurve
    """Probability that a word is right."""
    lost_words: LossCurve
    """Probability that a word was said where more was heard than is written."""
    callsign_odds: Odds
    """Odds of a callsign of the roster that may have been said in a call."""
    call_calibration: Calibration
    """Calibration of the product of the confidences of a call's words."""
    least_word_confidence: Confidence
    """Confidence below which words are left out."""
    best_word_threshold: Confidence
    """Confidence that the best word must have; below it nobody speaks in the transmission."""
    language_weight: Annotated[float, Field(ge=0.0, le=10.0)]
    """Weight of the language model against the network."""
    piece_reward: Annotated[float, Field(ge=-10.0, le=10.0)]
    """Log-likelihood added for each piece."""


@dataclass(frozen=True, slots=True)
class Emission:
    """One word of a call."""

    word: str
    posterior: float
    """Least of its pieces' highest posteriors, or of a callsign of the roster its confidence."""
    begin: int
    """Step at which it begins."""
    against: float = 0.0
    """Least log-odds of its pieces against what else may have been said there."""
    is_callsign: bool = False
    """True if it is of a callsign of the roster."""
    gaps: tuple[Gap, Gap] = (SILENCE, SILENCE)
    """Sounds right before and right behind it that are in no word."""


class Model:
    """The files of a recogniser, read and found to fit together.

    Parameters
    ----------
    where
        Folder with `FILES`.

    Raises
    ------
    SpeechError
        A file is missing, or the files do not fit together.
    """

    def __init__(self, where: Path) -> None:
        missing = [name for name in FILES if not (where / name).is_file()]
        if missing:
            raise SpeechError(
                f"recogniser {Ctc.name}: {where} lacks {', '.join(missing)}; expected "
                f"{', '.join(FILES)}, as tools/asr/train_asr.py writes them"
            )
        self.pieces = Pieces((where / "pieces.txt").read_text("utf-8", "replace").split())
        try:
            self.card = card = Card.model_validate_json((where / "card.json").read_bytes())
        except ValidationError as error:
            raise SpeechError(
                f"recogniser {Ctc.name}: {where / 'card.json'} is no model card: "
                f"{first_problem(error)}; expected it as tools/asr/train_asr.py writes it"
            ) from None
        self.same = same_units(self.pieces)
        network = where / "ctc.onnx"
        self.session = open_network(network, f"recogniser {Ctc.name}: {network}", EXPECTED)
        trial = {"features": np.zeros((1, TRIAL_FRAMES, BINS), np.float32)}
        try:
            _, steps, units = first_look(self.session, trial)[0].shape
        except Exception as error:  # onnxruntime raises classes of its own that share no base
            raise SpeechError(
                f"recogniser {Ctc.name}: {network} is of another kind: {first_line(error)}; "
                f"expected {EXPECTED}"
            ) from None
        self.step_frames = TRIAL_FRAMES // steps
        if units != len(self.pieces) + 1:
            raise SpeechError(
                f"recogniser {Ctc.name}: {where} does not fit together: ctc.onnx tells {units} "
                f"units apart, pieces.txt has {len(self.pieces)}; expected one unit more than "
                "pieces"
            )
        language = Language(where / "language.npz", units)
        self.search = BeamSearch(language, card.language_weight, card.piece_reward)


@cache
def _shipped() -> Model:
    """Return the model that ships with AIRHILT, which takes longer to open than a call to hear."""
    return Model(MODEL)


class Ctc:
    """Recognises with the embedded model, or another of its kind.

    Parameters
    ----------
    folder
        Folder of a `Model`, whose errors are those of this; None: the model that ships with
        AIRHILT.
    """

    name = "embedded"

    def __init__(self, folder: Path | None = None) -> None:
        self._model = _shipped() if folder is None else Model(folder)
        self._roster: tuple[tuple[str, ...], Spotter] | None = None

    def recognise(self, audio: Audio, callsigns: Sequence[str]) -> Recognised:
        """Return the words of a call; see `AsrEngine.recognise`."""
        if len(audio) < LEAST_SAMPLES:
            return Recognised("", (), 1.0)
        card = self._model.card
        words = [
            (each.word, confidence_of(each, card.word_curve, card.lost_words))
            for each in self.path(self.posteriors(audio), callsigns)
        ]
        best = max((confidence for _, confidence in words), default=0.0)
        kept = tuple(each for each in words if each[1] >= card.least_word_confidence)
        if not kept or best < card.best_word_threshold:
            return Recognised("", (), 1.0 - best)
        whole = float(np.prod([confidence for _, confidence in words]))
        confidence = card.call_calibration(whole)
        return Recognised(" ".join(word for word, _ in kept), kept, confidence)

    def path(self, posteriors: NDArray[np.float32], callsigns: Sequence[str]) -> list[Emission]:
        """Return the likeliest words, with the callsign of the roster that is among them."""
        path = self._likeliest(posteriors)
        spotted = self._spotter(tuple(callsigns)).spot(posteriors)
        return path if spotted is None else with_callsign(path, spotted)

    def _likeliest(self, posteriors: NDArray[np.float32]) -> list[Emission]:
        units = self._model.search.units(posteriors)
        posteriors, heard = with_same(posteriors, aligned(posteriors, units), self._model.same)
        prior, order = self._model.search.prior(), self._model.search.language.order
        against = log_odds(posteriors, heard, prior, order)
        places = self._model.pieces.words(units)
        words = [heard[first:after] for first, after in places]
        return [
            Emission(
                self._model.pieces.text(units[first:after]),
                min(unit.posterior for unit in word),
                word[0].begin,
                min(against[first:after]),
                gaps=beside,
            )
            for (first, after), word, beside in zip(
                places, words, pairwise(gaps(posteriors, words, prior, order)), strict=True
            )
        ]

    def _spotter(self, callsigns: tuple[str, ...]) -> Spotter:
        if self._roster is None or self._roster[0] != callsigns:
            spotter = Spotter(self._model.pieces, callsigns, self._model.card.callsign_odds)
            self._roster = (callsigns, spotter)
        return self._roster[1]

    def posteriors(self, audio: Audio) -> NDArray[np.float32]:
        """Return the posterior of the blank and of each piece, shape (steps, units)."""
        features = normalised(mel_power(audio))
        windows = [
            self._window(features, begin) for begin in range(0, len(features), WINDOW_FRAMES)
        ]
        return np.concatenate(windows)

    def _window(self, features: NDArray[np.float32], begin: int) -> NDArray[np.float32]:
        first = max(begin - CONTEXT_FRAMES, 0)
        seen = features[first : begin + WINDOW_FRAMES + CONTEXT_FRAMES]
        logits = self._model.session.run(None, {"features": seen[None]})[0][0]
        logits = logits[(begin - first) // self._model.step_frames :][
            : WINDOW_FRAMES // self._model.step_frames
        ]
        weights = np.exp(logits - logits.max(axis=1, keepdims=True))
        return np.asarray(weights / weights.sum(axis=1, keepdims=True), np.float32)


def confidence_of(heard: Emission, word: WordCurve, lost: LossCurve) -> float:
    """Return the confidence that a word is right, or, if it is less, that none beside it is lost.

    A callsign of the roster has its own.
    """
    if heard.is_callsign:
        return heard.posterior
    return min(word(heard.posterior, heard.against), *(1.0 - lost(gap) for gap in heard.gaps))


def with_callsign(path: Sequence[Emission], spotted: Spotted) -> list[Emission]:
    """Return words in which a callsign is at its place, instead of others or as it was heard."""
    there = [(each.word, each.begin) for each in path if spotted.begin <= each.begin < spotted.end]
    if not is_same([word for word, _ in there], spotted.words):
        there = [(word, spotted.begin) for word in spotted.words]
    words = [Emission(word, spotted.confidence, begin, is_callsign=True) for word, begin in there]
    return [
        *(each for each in path if each.begin < spotted.begin),
        *words,
        *(each for each in path if each.begin >= spotted.end),
    ]


ENGINE = Engine(
    name="embedded",
    summary="network and language model of aviation; ships with AIRHILT",
    create=lambda folder: Ctc(Path(folder) if folder else None),
    argument="FOLDER",
    takes=lambda text: (Path(text) / FILES[0]).is_file(),
)
