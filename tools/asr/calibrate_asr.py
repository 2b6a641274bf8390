"""Weighs the embedded recogniser's language model, and makes its confidence mean what it says.

    python tools/asr/calibrate_asr.py build/asr/dev airhilt/assistant/asr/model
    python tools/asr/calibrate_asr.py build/asr/dev airhilt/assistant/asr/model --callsigns-only

The calls of the folder (not those of training, nor those that scores are given of) go through the
channel at many ratios. First the weight of the language model and the reward of a piece are chosen
with which the fewest words of some of the calls are wrong, and by maximum likelihood the odds that
a callsign of the roster was said. Then logistic curves are fitted (Platt, 1999): to how often a
word is right, from its posterior and from what else may have been said there; to how often one is
lost beside it, from what was heard there and not written; and to how often a call is right, from
the product of its words' confidences.
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
from dataclasses import asdict
from itertools import pairwise
from pathlib import Path
from typing import Any, NamedTuple

import jiwer
import numpy as np
from numpy.typing import NDArray
from scipy.optimize import minimize

from airhilt.assistant.asr.beam_search import BeamSearch
from airhilt.assistant.asr.confidences import LossCurve, WordCurve, log_heard, log_odds_of
from airhilt.assistant.asr.engines.embedded import Ctc, Emission, confidence_of
from airhilt.assistant.asr.language import Language
from airhilt.assistant.asr.pieces import Pieces
from airhilt.assistant.asr.spotting import Aligned, Odds, Spotter
from airhilt.audio.pcm import Audio
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
BEGIN_ODDS = Odds(offset=1.0, name=1.0, sign=1.0, loss=0.5)
"""Odds that a fit begins with."""
MOST_LOSS = 1e3
"""Loss of a form that is longer than the call."""


class HeardCall(NamedTuple):
    """Recognised call: words, their posteriors, and which words are right."""

    reference: str
    path: list[Emission]
    right: list[bool]
    """True for each word of the path that was said there."""
    lost: list[bool]
    """True for each word of the path, and for its end, right before which a word was said that the
    path lacks."""

    def text(self, kept: NDArray[np.bool_]) -> str:
        """Return the words that are kept."""
        return " ".join(each.word for each, is_kept in zip(self.path, kept, strict=True) if is_kept)


class Curves(NamedTuple):
    """Curves that the confidence of a word follows from."""

    word: WordCurve
    lost: LossCurve


def confidences_of(curves: Curves, path: Sequence[Emission]) -> NDArray[np.float64]:
    """Return the confidence of each word."""
    return np.array([confidence_of(each, *curves) for each in path])


def fit(x: NDArray[np.float64], happened: Sequence[bool]) -> NDArray[np.float64]:
    """Return the slopes, and the offset, of the logistic curve of how often something happens.

    Parameters
    ----------
    x
        Numbers that it depends on, shape (trials, numbers).
    """
    inputs = np.column_stack([x, np.ones(len(x))])

    def loss(parameters: NDArray[np.float64]) -> float:
        z = inputs @ parameters
        return float(np.mean(np.logaddexp(0.0, np.where(happened, -z, z))))

    begin = np.array([*np.ones(inputs.shape[1] - 1), 0.0])
    return np.asarray(np.round(minimize(loss, begin).x, 4))


def main() -> None:
    """Fit and write."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folder", type=Path)
    parser.add_argument("model", type=Path)
    parser.add_argument(
        "--callsigns-only",
        action="store_true",
        help="fit the odds of callsigns alone, and leave the rest of the card as it is",
    )
    given = parser.parse_args()
    utterances = [each for path in sorted(given.folder.glob("*.jsonl")) for each in spoken(path)]
    rosters = misleading(utterances, rosters_for(utterances))
    if not given.callsigns_only:
        weigh(given.model, utterances)
    aligned = list(aligned_calls(given.model, utterances, rosters))
    write_into_card(given.model, {"callsign_odds": fit_odds(aligned)})
    if not given.callsigns_only:
        engine = Ctc(given.model)
        calls = list(heard_calls(engine, utterances, rosters))
        write_into_card(given.model, thresholds(engine, calls, rosters[0]))
    print((given.model / "card.json").read_text())


def write_into_card(model: Path, fitted: dict[str, Any]) -> None:
    """Replace values of a model's card."""
    card = json.loads((model / "card.json").read_text()) | fitted
    (model / "card.json").write_text(json.dumps(card, indent=2) + "\n")


def thresholds(engine: Ctc, calls: Sequence[HeardCall], roster: Sequence[str]) -> dict[str, Any]:
    """Return the curves of words and calls for the card, and the thresholds that they give."""
    curves = curves_of(calls)
    silent = [
        engine.path(engine.posteriors(audio), roster) for audio in noise_alone(SILENT_CALLS, seed=6)
    ]
    threshold, talkative = quietest_threshold(curves, silent)
    least, errors = best_threshold(curves, calls)
    return {
        "word_curve": asdict(curves.word),
        "lost_words": asdict(curves.lost),
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
    write_into_card(model, {"language_weight": weight, "piece_reward": reward})


class Trial(NamedTuple):
    """Call with the callsign that is said in it, and where those of its roster fit best."""

    said: str | None
    """None: none of the roster."""
    aligned: list[Aligned]


def aligned_calls(
    model: Path, utterances: Sequence[SpokenCall], rosters: Sequence[tuple[str, ...]]
) -> Iterator[Trial]:
    """Yield the trials of each utterance at each ratio."""
    engine = Ctc(model)
    pieces = Pieces((model / "pieces.txt").read_text(encoding="utf-8").split())
    for index, each in enumerate(utterances):
        spotter = Spotter(pieces, rosters[index], BEGIN_ODDS)
        said = each.callsign if each.callsign in rosters[index] else None
        for audio in at_ratios(each, index):
            yield Trial(said, spotter.aligned(engine.posteriors(audio)))


def fit_odds(trials: Sequence[Trial]) -> dict[str, float]:
    """Return the odds with which what was said is likeliest: one callsign of the roster, or none.

    Trials whose callsign has no form that the recogniser can write are left out.
    """
    features: list[tuple[float, ...]] = []
    of_callsign: list[int] = []
    of_trial: list[int] = []
    said: list[int] = []
    for trial in trials:
        forms: dict[str, list[tuple[float, ...]]] = {}
        for callsign, form, _, _, loss in trial.aligned:
            row = (1.0, len(form.name), len(form.signs), -min(loss, MOST_LOSS))
            forms.setdefault(callsign, []).append(row)
        if not forms or (trial.said and trial.said not in forms):
            continue
        said.append(len(of_callsign) + list(forms).index(trial.said) if trial.said else -1)
        of_trial.append(len(of_callsign))
        for rows in forms.values():
            of_callsign.append(len(features))
            features += rows
    matrix, chosen = np.array(features), np.array(said)

    def loss_of(odds: NDArray[np.float64]) -> float:
        likeliest = np.maximum.reduceat(matrix @ odds, of_callsign)
        all_of_them = np.logaddexp(np.logaddexp.reduceat(likeliest, of_trial), 0.0)
        return float(np.mean(all_of_them - np.where(chosen >= 0, likeliest[chosen], 0.0)))

    begin = np.array(list(asdict(BEGIN_ODDS).values()))
    found = minimize(loss_of, begin, method="Nelder-Mead").x
    return {
        name: round(float(value), 4) for name, value in zip(asdict(BEGIN_ODDS), found, strict=True)
    }


def heard_calls(
    engine: Ctc,
    utterances: Sequence[SpokenCall],
    rosters: Sequence[tuple[str, ...]],
) -> Iterator[HeardCall]:
    """Yield what the recogniser makes of each utterance at each ratio."""
    for index, each in enumerate(utterances):
        for audio in at_ratios(each, index):
            path = engine.path(engine.posteriors(audio), rosters[index])
            words = [word.word for word in path]
            yield HeardCall(
                each.text, path, right_words(each.text, words), lost_before(each.text, words)
            )


def at_ratios(call: SpokenCall, seed: int) -> Iterator[Audio]:
    """Yield a call as it is received at each ratio."""
    channel = VhfChannel(PROFILES["vhf"])
    for snr_db in RATIOS:
        rng = np.random.default_rng([seed, 77 if snr_db is None else int(snr_db) + 10])
        yield channel.transmit(call.speech, snr_db, rng, (), "cockpit")


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
    for chunk in _chunks(reference, hypothesis):
        if chunk.type == "equal":
            for at in range(chunk.hyp_start_idx, chunk.hyp_end_idx):
                right[at] = True
    return right


def lost_before(reference: str, hypothesis: Sequence[str]) -> list[bool]:
    """Return for each recognised word, and for the end, whether one was lost right before it."""
    lost = [False] * (len(hypothesis) + 1)
    for chunk in _chunks(reference, hypothesis):
        if chunk.type == "delete":
            lost[chunk.hyp_start_idx] = True
    return lost


def _chunks(reference: str, hypothesis: Sequence[str]) -> list[jiwer.AlignmentChunk]:
    if not hypothesis:
        return []
    said, heard = (" ".join(map(_spelled, words)) for words in (reference.split(), hypothesis))
    return jiwer.process_words(said, heard).alignments[0]


def _spelled(word: str) -> str:
    """Return a word as one token, in the spelling in which words are compared."""
    return "_".join(in_words(word)) or word


def curves_of(calls: Sequence[HeardCall]) -> Curves:
    """Fit the curves of words, but those of callsigns of the roster."""
    words, gaps = [], []
    for call in calls:
        for each, is_right, lost in zip(call.path, call.right, pairwise(call.lost), strict=True):
            if not each.is_callsign:
                words.append((log_odds_of(each.posterior), each.against, is_right))
                gaps += [
                    (log_heard(gap.heard), gap.inserted, is_lost)
                    for gap, is_lost in zip(each.gaps, lost, strict=True)
                ]
    return Curves(WordCurve(*_plane(words)), LossCurve(*_plane(gaps)))


def _plane(trials: Sequence[tuple[float, float, bool]]) -> tuple[float, ...]:
    """Return the slopes, and the offset, of how often something happens by two numbers."""
    x = np.array([each[:2] for each in trials])
    return tuple(map(float, fit(x, [happened for *_, happened in trials])))


def call_calibration(curves: Curves, calls: Sequence[HeardCall], least: float) -> dict[str, float]:
    """Return the curve of whole calls, of which words below the least confidence are left out."""
    confidences, whole = [], []
    for call in calls:
        if not call.path:
            continue
        trust = confidences_of(curves, call.path)
        confidences.append(float(np.prod(trust)))
        whole.append(in_words(call.text(trust >= least)) == in_words(call.reference))
    slope, offset = map(float, fit(np.array(list(map(log_odds_of, confidences))), whole))
    return {"slope": slope, "offset": offset}


def quietest_threshold(curves: Curves, silent: Sequence[Sequence[Emission]]) -> tuple[float, float]:
    """Return the confidence that the best word must have, and the share of silence that passes.

    The result is the least at which `MOST_TALKATIVE` of them do.
    """
    best = np.array([confidences_of(curves, path).max(initial=0.0) for path in silent])
    least = math.ceil(100.0 * float(np.quantile(best, 1.0 - MOST_TALKATIVE))) / 100.0
    has_words = np.array([bool(path) for path in silent])
    return least, float(np.mean(has_words & (best >= least)))


def best_threshold(curves: Curves, calls: Sequence[HeardCall]) -> tuple[float, float]:
    """Return the least confidence of a word that is kept, and the word error rate with it."""
    references = [call.reference for call in calls]
    trusts = [confidences_of(curves, call.path) for call in calls]
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
