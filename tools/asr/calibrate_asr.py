"""Weighs the embedded recogniser's language model, and makes its confidence mean what it says.

    python tools/asr/calibrate_asr.py build/asr/dev airhilt/assistant/asr/model
    python tools/asr/calibrate_asr.py build/asr/dev airhilt/assistant/asr/model --callsigns-only

The calls of the folder (not those of training, nor those that scores are given of) go through the
channel at many ratios. First the weight of the language model and the reward of a piece are chosen
with which the fewest words of some of the calls are wrong. Then three logistic curves are fitted by
maximum likelihood (Platt, 1999) to how often something is right: from the posterior of a word, from
the likelihood that a callsign of the roster loses, and from the product of a call's confidences.
Words below the threshold that costs least errors are left out of transcripts, and transmissions
whose best word is no better than in noise alone are empty.
"""

from __future__ import annotations

import argparse
import itertools
import json
import math
import random
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any, NamedTuple

import jiwer
import numpy as np
from numpy.typing import NDArray
from scipy.optimize import minimize

from airhilt.assistant.asr.beam_search import BeamSearch
from airhilt.assistant.asr.engines.embedded import Ctc, Emission
from airhilt.assistant.asr.language import Language
from airhilt.assistant.asr.pieces import Pieces
from airhilt.metrics.words import in_words
from airhilt.scenario.radio_profiles import PROFILES
from airhilt.sensors.radio.channel import VhfChannel
from eval_asr import (
    SpokenCall,
    noise_alone,
    one_digit_off,
    rosters_for,
    spoken,
    word_error_rate,
)

MOST_TALKATIVE = 0.005
"""Largest share of transmissions without speech that may give words."""
SILENT_CALLS = 600
WEIGHTS, REWARDS = (0.0, 0.2, 0.4, 0.6, 0.8), (0.0, 1.0, 2.0, 3.0)
"""Weights of the language model and rewards of a piece that are tried."""
WEIGHED_CALLS, WEIGHED_RATIOS = 60, (None, 10.0, 3.0)
"""Calls, and ratios, that they are tried with."""
RATIOS = (None, 20.0, 10.0, 6.0, 3.0, 0.0, -3.0)
MISLEADING_SHARE = 0.1
"""Share of the rosters that have a callsign one digit off instead of the one that is said."""


class HeardCall(NamedTuple):
    """Recognised call: words, their posteriors, and which words are right."""

    reference: str
    path: list[Emission]
    right: list[bool]
    """True for each word of the path that was said there."""

    def text(self, kept: NDArray[np.bool_]) -> str:
        """Return the words that are kept."""
        return " ".join(each.word for each, is_kept in zip(self.path, kept, strict=True) if is_kept)


class Curves(NamedTuple):
    """Curves of a word, and of a callsign that was found."""

    word: dict[str, float]
    callsign: dict[str, float]

    def __call__(self, path: Sequence[Emission]) -> NDArray[np.float64]:
        """Return the confidence of each word."""
        posteriors = np.array([each.posterior for each in path])
        return np.where(
            [each.is_callsign for each in path],
            logistic(self.callsign, posteriors),
            logistic(self.word, posteriors),
        )


def fit(posteriors: NDArray[np.float64], right: NDArray[np.bool_]) -> dict[str, float]:
    """Return slope and offset of the logistic curve over log-odds."""
    bounded = np.clip(posteriors, 1e-6, 1 - 1e-6)
    log_odds = np.log(bounded / (1 - bounded))

    def loss(parameters: NDArray[np.float64]) -> float:
        z = parameters[0] * log_odds + parameters[1]
        return float(np.mean(np.logaddexp(0.0, np.where(right, -z, z))))

    slope, offset = minimize(loss, np.array([1.0, 0.0])).x
    return {"slope": round(float(slope), 4), "offset": round(float(offset), 4)}


def logistic(curve: dict[str, float], posteriors: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the curve's values."""
    bounded = np.clip(posteriors, 1e-6, 1 - 1e-6)
    z = curve["slope"] * np.log(bounded / (1 - bounded)) + curve["offset"]
    return np.asarray(1 / (1 + np.exp(-z)))


def main() -> None:
    """Fit and write."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folder", type=Path)
    parser.add_argument("model", type=Path)
    parser.add_argument(
        "--callsigns-only",
        action="store_true",
        help="fit the curve of callsigns alone, and leave the rest of the card as it is",
    )
    given = parser.parse_args()
    utterances = [each for path in sorted(given.folder.glob("*.jsonl")) for each in spoken(path)]
    rosters = misleading(utterances, rosters_for(utterances))
    if not given.callsigns_only:
        weigh(given.model, utterances)
    engine = Ctc(given.model)
    calls = list(heard_calls(engine, utterances, rosters))
    curves = curves_of(calls)
    fitted: dict[str, Any] = {"callsign_calibration": curves.callsign}
    if not given.callsigns_only:
        fitted |= thresholds(engine, curves, calls, rosters[0])
    card = json.loads((given.model / "card.json").read_text()) | fitted
    (given.model / "card.json").write_text(json.dumps(card, indent=2) + "\n")
    print(json.dumps(card, indent=2))


def thresholds(
    engine: Ctc, curves: Curves, calls: Sequence[HeardCall], roster: Sequence[str]
) -> dict[str, Any]:
    """Return the curves of words and calls for the card, and the thresholds that they give."""
    silent = [
        engine.path(engine.posteriors(audio), roster) for audio in noise_alone(SILENT_CALLS, seed=6)
    ]
    threshold, talkative = quietest_threshold(curves, silent)
    least, errors = best_threshold(curves, calls)
    return {
        "word_calibration": curves.word,
        "call_calibration": call_calibration(curves, calls, least),
        "least_word_confidence": least,
        "best_word_threshold": threshold,
        "calibrated_on": {
            "calls": len(calls),
            "word_error_rate": round(errors, 4),
            "transmissions_without_speech": len(silent),
            "of_those_with_words": round(talkative, 4),
        },
    }


def weigh(model: Path, utterances: Sequence[SpokenCall]) -> None:
    """Write into the card of a model how much its language model counts."""
    engine = Ctc(model)
    pieces = Pieces((model / "pieces.txt").read_text(encoding="utf-8").split())
    language = Language(model / "language.npz", len(pieces) + 1)
    some = utterances[:: max(1, len(utterances) // WEIGHED_CALLS)]
    channel = VhfChannel(PROFILES["vhf"])
    calls = [
        (each.text, engine.posteriors(channel.transmit(each.speech, snr_db, rng, (), "cockpit")))
        for index, each in enumerate(some)
        for snr_db, rng in zip(
            WEIGHED_RATIOS,
            np.random.default_rng([index, 78]).spawn(len(WEIGHED_RATIOS)),
            strict=True,
        )
    ]
    tried = []
    for weight, reward in itertools.product(WEIGHTS, REWARDS):
        search = BeamSearch(language, weight, reward)
        found = [pieces.text(search.units(posteriors)) for _, posteriors in calls]
        tried.append((word_error_rate([text for text, _ in calls], found), weight, reward))
    _, weight, reward = min(tried)
    card = json.loads((model / "card.json").read_text())
    card |= {"language_weight": weight, "piece_reward": reward}
    (model / "card.json").write_text(json.dumps(card, indent=2) + "\n")


def heard_calls(
    engine: Ctc,
    utterances: Sequence[SpokenCall],
    rosters: Sequence[tuple[str, ...]],
) -> Iterator[HeardCall]:
    """Yield what the recogniser makes of each utterance at each ratio."""
    channel = VhfChannel(PROFILES["vhf"])
    for index, each in enumerate(utterances):
        for snr_db in RATIOS:
            rng = np.random.default_rng([index, 77 if snr_db is None else int(snr_db) + 10])
            heard = channel.transmit(each.speech, snr_db, rng, (), "cockpit")
            path = engine.path(engine.posteriors(heard), rosters[index])
            yield HeardCall(each.text, path, right_words(each.text, [word.word for word in path]))


def misleading(
    utterances: Sequence[SpokenCall], rosters: Sequence[tuple[str, ...]]
) -> list[tuple[str, ...]]:
    """Return rosters of which `MISLEADING_SHARE` have a callsign one digit off the right one."""
    rng = random.Random(79)
    changed = []
    for each, roster in zip(utterances, rosters, strict=True):
        said = each.callsign
        if said and any(map(str.isdigit, said)) and rng.random() < MISLEADING_SHARE:
            other = one_digit_off(said, rng)
            roster = tuple(other if name == said else name for name in roster)
        changed.append(roster)
    return changed


def right_words(reference: str, hypothesis: Sequence[str]) -> list[bool]:
    """Return for each recognised word whether it was said there, in this or another spelling."""
    right = [False] * len(hypothesis)
    if hypothesis:
        said, heard = (" ".join(map(_spelled, words)) for words in (reference.split(), hypothesis))
        for chunk in jiwer.process_words(said, heard).alignments[0]:
            if chunk.type == "equal":
                for at in range(chunk.hyp_start_idx, chunk.hyp_end_idx):
                    right[at] = True
    return right


def _spelled(word: str) -> str:
    """Return a word as one token, in the spelling in which words are compared."""
    return "_".join(in_words(word)) or word


def curves_of(calls: Sequence[HeardCall]) -> Curves:
    """Fit the curve of words, and that of callsigns; one is right if all its words are."""
    words, callsigns = [], []
    for call in calls:
        pairs = list(zip(call.path, call.right, strict=True))
        words += [(each.posterior, right) for each, right in pairs if not each.is_callsign]
        found = [(each.posterior, right) for each, right in pairs if each.is_callsign]
        if found:
            callsigns.append((found[0][0], all(right for _, right in found)))
    return Curves(*(fit(*map(np.array, zip(*each, strict=True))) for each in (words, callsigns)))


def call_calibration(curves: Curves, calls: Sequence[HeardCall], least: float) -> dict[str, float]:
    """Return the curve of whole calls, of which words below the least confidence are left out."""
    confidences, whole = [], []
    for call in calls:
        if not call.path:
            continue
        trust = curves(call.path)
        confidences.append(float(np.prod(trust)))
        whole.append(in_words(call.text(trust >= least)) == in_words(call.reference))
    return fit(np.array(confidences), np.array(whole))


def quietest_threshold(curves: Curves, silent: Sequence[Sequence[Emission]]) -> tuple[float, float]:
    """Return the confidence that the best word must have, and the share of silence that passes.

    The result is the least at which `MOST_TALKATIVE` of them do.
    """
    best = np.array([curves(path).max(initial=0.0) for path in silent])
    least = math.ceil(100.0 * float(np.quantile(best, 1.0 - MOST_TALKATIVE))) / 100.0
    has_words = np.array([bool(path) for path in silent])
    return least, float(np.mean(has_words & (best >= least)))


def best_threshold(curves: Curves, calls: Sequence[HeardCall]) -> tuple[float, float]:
    """Return the least confidence of a word that is kept, and the word error rate with it."""
    references = [call.reference for call in calls]
    trusts = [curves(call.path) for call in calls]
    rates = [
        (
            word_error_rate(
                references,
                [call.text(trust >= least) for call, trust in zip(calls, trusts, strict=True)],
            ),
            float(least),
        )
        for least in np.arange(0.0, 0.8, 0.05)
    ]
    errors, least = min(rates)
    return round(least, 2), errors


if __name__ == "__main__":
    main()
