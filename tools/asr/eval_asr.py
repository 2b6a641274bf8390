"""Measures recognisers: words, callsigns, and what is made of calls, by lineage of voices and SNR.

    python tools/asr/eval_asr.py build/asr/test --engine embedded
    python tools/asr/eval_asr.py build/asr/exam --engine embedded --engine whisper:DIR

The folder holds shards of `asr_speech`. Each utterance goes through the channel "vhf" with a noise
of its own, the same for each engine. A callsign is right if the parser finds it among those on the
frequency: ten, or those that the call names itself. Of calls that say what they mean
(`tools/phraseology_judge`), the items are compared with what the parser reads in the transcript.
Confidence is compared with how often calls are wholly right.
"""

from __future__ import annotations

import argparse
import json
import random
import sys
import time
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import jiwer
import numpy as np
from numpy.typing import NDArray

from airhilt.audio.pcm import SAMPLE_RATE_HZ, Audio
from airhilt.engine_families import RECOGNISERS
from airhilt.metrics.words import in_words
from airhilt.phraseology import parse_call
from airhilt.scenario.radio_profiles import PROFILES
from airhilt.sensors.radio.channel import VhfChannel
from airhilt.sensors.radio.on_air import BackgroundNoise

sys.path.append(str(Path(__file__).parents[1]))

from phraseology_judge.score import Score as Meanings

RATIOS: tuple[float | None, ...] = (None, 20.0, 10.0, 5.0, 0.0, -3.0)
MISLEADING_DB = 10.0
SILENT_CALLS = 300


@dataclass(frozen=True)
class SpokenCall:
    """One utterance of a shard. Its samples stay on the disk until they are asked for."""

    about: dict[str, Any]
    """Its line: text, callsign, voice, lineage; of an exam its roster and items too."""
    pcm: NDArray[np.int16]

    @property
    def text(self) -> str:
        """Words that were said."""
        return str(self.about["text"])

    @property
    def callsign(self) -> str | None:
        """Callsign of the call; None if it names nobody."""
        callsign: str | None = self.about["callsign"]
        return callsign

    @property
    def voice(self) -> str:
        """Name of the voice that says it."""
        return str(self.about["voice"])

    @property
    def speech(self) -> Audio:
        """Clean speech, in [-1, 1]."""
        return np.asarray(self.pcm, np.float32) / np.float32(32767.0)


@dataclass
class Score:
    """Scores of an engine on a set of calls at one signal-to-noise ratio."""

    references: list[str]
    hypotheses: list[str]
    confidences: list[float]
    callsigns: list[bool]
    meanings: Meanings
    """Counts of the calls that say what they mean."""

    @property
    def word_error_rate(self) -> float:
        """Share of words."""
        return word_error_rate(self.references, self.hypotheses)


def word_error_rate(references: Sequence[str], hypotheses: Sequence[str]) -> float:
    """Return the share of wrong words, compared in the form of `airhilt.metrics.words.in_words`."""
    return float(jiwer.wer(_in_words(references), _in_words(hypotheses)))


def _in_words(texts: Iterable[str]) -> list[str]:
    return [" ".join(in_words(text)) for text in texts]


def spoken(path: Path) -> Iterator[SpokenCall]:
    """Yield the utterances of a shard."""
    samples = np.load(path.with_suffix(".npy"), mmap_mode="r")
    at = 0
    for line in path.read_text().splitlines():
        about = json.loads(line)
        pcm = samples[at : at + about["samples"]]
        at += about["samples"]
        yield SpokenCall(about, pcm)


def rosters_for(utterances: list[SpokenCall]) -> list[tuple[str, ...]]:
    """Return who is on the frequency of each call: its roster, or ten with its callsign among them.

    There are fewer if all calls together name fewer.
    """
    everybody = [each.callsign for each in utterances if each.callsign]
    others = min(9, len(everybody))
    rng = random.Random(0)
    return [
        tuple(
            each.about.get("roster")
            or filter(None, (each.callsign, *rng.sample(everybody, others)))
        )
        for each in utterances
    ]


def misled(utterances: list[SpokenCall], engine_name: str, snr_db: float) -> float:
    """Return the share of calls taken for a roster's callsign that is one digit off theirs."""
    engine = RECOGNISERS.create(engine_name)
    channel = VhfChannel(PROFILES["vhf"])
    rng = random.Random(1)
    everybody = [each.callsign for each in utterances if each.callsign]
    others = min(9, len(everybody))
    taken = []
    for index, each in enumerate(utterances):
        if each.callsign is None or not any(sign.isdigit() for sign in each.callsign):
            continue
        other = one_digit_off(each.callsign, rng)
        roster = [other, *(name for name in rng.sample(everybody, others) if name != each.callsign)]
        noise = np.random.default_rng([index, int(snr_db) + 100])
        audio = channel.transmit(each.speech, snr_db, noise, (), "cockpit")
        text = engine.recognise(audio, roster).text
        taken.append(parse_call(text, roster).callsign == other)
    return float(np.mean(taken))


def noise_alone(count: int, seed: int) -> Iterator[Audio]:
    """Yield transmissions in which nobody speaks, of all profiles and with all noises."""
    for index in range(count):
        rng = np.random.default_rng([index, seed])
        channel = VhfChannel(PROFILES[rng.choice(list(PROFILES))])
        silence = np.zeros(SAMPLE_RATE_HZ * int(rng.integers(1, 12)), np.float32)
        background: BackgroundNoise = "cockpit" if index % 2 else "none"
        yield channel.transmit(silence, float(rng.uniform(-3, 30)), rng, (), background)


def talkative(engine_name: str) -> float:
    """Return the share of transmissions without speech that give words."""
    engine = RECOGNISERS.create(engine_name)
    roster = ("AAL123", "DAL456", "N54G")
    noises = noise_alone(SILENT_CALLS, seed=5)
    return float(np.mean([bool(engine.recognise(audio, roster).text) for audio in noises]))


def one_digit_off(callsign: str, rng: random.Random) -> str:
    """Return a callsign with another digit in one place."""
    at = rng.choice([index for index, sign in enumerate(callsign) if sign.isdigit()])
    digit = rng.choice([sign for sign in "123456789" if sign != callsign[at]])
    return callsign[:at] + digit + callsign[at + 1 :]


def score(
    utterances: list[SpokenCall], engine_name: str, snr_db: float | None
) -> tuple[Score, float]:
    """Return the score of an engine, and its real-time factor (CPU)."""
    engine = RECOGNISERS.create(engine_name)
    channel = VhfChannel(PROFILES["vhf"])
    rosters = rosters_for(utterances)
    result = Score([], [], [], [], Meanings())
    spent = heard_s = 0.0
    for index, each in enumerate(utterances):
        noise = np.random.default_rng([index, 1 if snr_db is None else int(snr_db) + 100])
        audio = channel.transmit(each.speech, snr_db, noise, (), "cockpit")
        begun = time.process_time()
        recognised = engine.recognise(audio, rosters[index])
        spent += time.process_time() - begun
        heard_s += len(audio) / SAMPLE_RATE_HZ
        result.references.append(each.text)
        result.hypotheses.append(recognised.text)
        result.confidences.append(recognised.confidence)
        if each.callsign is not None:
            named = parse_call(recognised.text, rosters[index]).callsign
            result.callsigns.append(named == each.callsign)
        if "items" in each.about:
            words = {
                "text": recognised.text,
                "word_confidences": [confidence for _, confidence in recognised.words],
            }
            result.meanings.take(each.about | words)
    return result, spent / heard_s


def reliability(scores: list[Score]) -> list[tuple[str, int, float, float]]:
    """Return confidence bins: label, calls, mean confidence, share that is wholly right."""
    confidences = np.array([c for s in scores for c in s.confidences])
    right = np.array(
        [
            reference == heard
            for each in scores
            for reference, heard in zip(
                _in_words(each.references), _in_words(each.hypotheses), strict=True
            )
        ]
    )
    rows = []
    for low in np.arange(0.0, 1.0, 0.1):
        chosen = (confidences >= low) & (confidences < low + 0.1 + (low > 0.85))
        if chosen.any():
            label = f"{low:.1f} to {low + 0.1:.1f}"
            rows.append(
                (
                    label,
                    int(chosen.sum()),
                    float(confidences[chosen].mean()),
                    float(right[chosen].mean()),
                )
            )
    return rows


def sets_of(folder: Path, limit: int) -> Iterator[tuple[str, list[SpokenCall]]]:
    """Yield the lineages of voices, and the first calls of each."""
    of_lineage: dict[str, list[SpokenCall]] = {}
    for path in sorted(folder.glob("*.jsonl")):
        for each in spoken(path):
            of_lineage.setdefault(each.about["lineage"], []).append(each)
    for lineage, utterances in sorted(of_lineage.items()):
        yield lineage, utterances[:limit]


def evaluate(
    engine: str, folder: Path, limit: int, lineages: tuple[str, ...] = ()
) -> list[dict[str, Any]]:
    """Print the tables of an engine, and return the numbers of the first."""
    print(f"\n### {engine}\n\n| lineage | SNR | WER % | callsigns right % | items right % "
          "| acted upon % | of these wrong % |\n|---|---|---|---|---|---|---|")  # fmt: skip
    numbers = []
    scores: list[Score] = []
    factors = []
    all_utterances: list[SpokenCall] = []
    for lineage, utterances in sets_of(folder, limit):
        if lineages and lineage not in lineages:
            continue
        all_utterances += utterances
        for snr in RATIOS:
            got, factor = score(utterances, engine, snr)
            scores.append(got)
            factors.append(factor)
            numbers.append({"engine": engine, "lineage": lineage, "snr_db": snr} | measures(got))
            print(row_of(numbers[-1]))
            sys.stdout.flush()
    if not scores:
        print(f"\nNo calls of {', '.join(lineages) or 'any lineage'} in {folder}.")
        return numbers
    if any(each.callsign for each in all_utterances):
        print_mistakes(engine, all_utterances)
    print(f"\nReal-time factor {np.mean(factors):.4f}, one core.\n")
    print_reliability(scores)
    return numbers


def measures(got: Score) -> dict[str, Any]:
    """Return the numbers of a score: shares in percent, None where there is nothing to count."""
    meant = got.meanings

    def percent(part: float, whole: float) -> float | None:
        return 100.0 * part / whole if whole else None

    return {
        "calls": len(got.references),
        "wer": 100.0 * got.word_error_rate,
        "callsigns": percent(sum(got.callsigns), len(got.callsigns)),
        "items": percent(meant.items_right, meant.items),
        "acted_upon": percent(meant.acted_upon, meant.calls),
        "acted_upon_wrongly": percent(meant.acted_upon_wrongly, meant.acted_upon),
    }


def row_of(numbers: dict[str, Any]) -> str:
    """Return a row of the table."""
    snr = "clean" if numbers["snr_db"] is None else f"{numbers['snr_db']:g} dB"
    shares = [
        "" if numbers[name] is None else f"{numbers[name]:.1f}"
        for name in ("wer", "callsigns", "items", "acted_upon", "acted_upon_wrongly")
    ]
    return f"| {numbers['lineage']}, {numbers['calls']} calls | {snr} | {' | '.join(shares)} |"


def print_mistakes(engine: str, utterances: list[SpokenCall]) -> None:
    """Print how often wrong callsigns are taken, and words heard where nobody speaks."""
    wrong = misled([each for each in utterances if each.callsign], engine, MISLEADING_DB)
    print(
        f"\nWith a callsign one digit off on the roster instead of the right one, that one is "
        f"taken in {100 * wrong:.1f} % of calls at {MISLEADING_DB:g} dB."
    )
    print(
        f"\nOf {SILENT_CALLS} transmissions without speech {100 * talkative(engine):.1f} % "
        "give words."
    )


def print_reliability(scores: list[Score]) -> None:
    """Print how often calls are wholly right, by confidence."""
    print("| confidence | calls | mean confidence | wholly right |\n|---|---|---|---|")
    for label, count, mean, share in reliability(scores):
        print(f"| {label} | {count} | {mean:.2f} | {share:.2f} |")


def main() -> None:
    """Print the tables."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folder", type=Path)
    parser.add_argument("--engine", action="append", required=True)
    parser.add_argument("--limit", type=int, default=10_000, help="utterances of a lineage")
    parser.add_argument(
        "--lineage", action="append", default=[], help="lineage of voices; all if not given"
    )
    parser.add_argument("--json", type=Path, help="write all numbers here too")
    given = parser.parse_args()
    numbers = [
        row
        for engine in given.engine
        for row in evaluate(engine, given.folder, given.limit, tuple(given.lineage))
    ]
    if given.json:
        given.json.write_text(json.dumps(numbers, indent=1) + "\n")


if __name__ == "__main__":
    main()
