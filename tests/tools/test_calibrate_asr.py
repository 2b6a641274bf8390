"""Curves of confidence: which words are right, and whose callsigns the rosters have."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import calibrate_asr
from airhilt.assistant.asr.confidences import SILENCE, Gap
from airhilt.assistant.asr.engines.embedded import Emission
from airhilt.assistant.asr.spotting import Aligned, Odds, SpokenForm
from eval_asr import SpokenCall

SAID = "american one two three climb alfa"
END = ""


def call(heard: str, posteriors: list[float], callsign: range) -> calibrate_asr.HeardCall:
    path = [
        Emission(word, posterior, at, is_callsign=at in callsign)
        for at, (word, posterior) in enumerate(zip(heard.split(), posteriors, strict=True))
    ]
    words = [each.word for each in path]
    right = calibrate_asr.right_words(SAID, words)
    return calibrate_asr.HeardCall(SAID, path, right, calibrate_asr.lost_before(SAID, words))


@pytest.mark.parametrize(
    ("heard", "right"),
    [
        ("american one two tree climb alpha", [True] * 6),
        ("american one two four climb alfa", [True, True, True, False, True, True]),
        ("american two three climb bravo", [True, True, True, True, False]),
        ("", []),
    ],
)
def test_a_word_is_right_where_it_was_said_in_whatever_spelling(
    heard: str, right: list[bool]
) -> None:
    assert calibrate_asr.right_words(SAID, heard.split()) == right


@pytest.mark.parametrize(
    ("heard", "before"),
    [
        (SAID, []),
        ("american one two three alfa", ["alfa"]),
        ("one two three climb alfa", ["one"]),
        ("american one two three climb", [END]),
        ("american one two tree turn alpha", []),
    ],
)
def test_a_word_is_lost_before_another_or_before_the_end(heard: str, before: list[str]) -> None:
    words = heard.split()
    lost = calibrate_asr.lost_before(SAID, words)
    found = [word for word, is_lost in zip([*words, END], lost, strict=True) if is_lost]
    assert found == before


def test_a_word_is_trusted_less_where_more_was_heard_before_or_behind_it() -> None:
    loud = Gap(4.0, 2.0)
    whole = call(SAID, [0.9] * 6, range(0))
    lossy = call("american one two three alfa", [0.9] * 5, range(0))
    *before, three, alfa = lossy.path
    lossy = lossy._replace(
        path=[
            *before, replace(three, gaps=(SILENCE, loud)), replace(alfa, gaps=(loud, SILENCE)),
        ]
    )  # fmt: skip
    curves = calibrate_asr.curves_of([whole, lossy] * 4)
    quiet, *beside = calibrate_asr.confidences_of(
        curves,
        [
            Emission("climb", 0.99, 0),
            Emission("climb", 0.99, 0, gaps=(loud, SILENCE)),
            Emission("climb", 0.99, 0, gaps=(SILENCE, loud)),
        ],
    )
    assert quiet > 0.9
    assert max(beside) < 0.1


def test_the_curve_of_words_leaves_callsigns_of_the_roster_out() -> None:
    """Words of callsigns are wrong whatever their confidence; others are right where likely."""
    calls = [
        call("delta four four four climb alfa", [0.99] * 4 + [0.9, 0.9], range(4)),
        call("american one two three turn alfa", [0.9] * 4 + [0.1, 0.9], range(0)),
    ] * 4
    curves = calibrate_asr.curves_of(calls)
    of_callsign, of_word = calibrate_asr.confidences_of(
        curves, [Emission("one", 0.7, 0, is_callsign=True), Emission("climb", 0.9, 1)]
    )
    assert of_callsign == 0.7
    assert of_word > 0.9


def test_a_word_that_makes_sense_is_trusted_more_where_those_that_make_none_are_wrong() -> None:
    """All were heard alike; what else may have been said tells them apart."""
    calls = [
        call(SAID, [0.9] * 6, range(0)),
        call("american one two three turn bravo", [0.9] * 6, range(0)),
    ] * 4
    calls = [
        each._replace(
            path=[
                replace(word, against=4.0 if right else -1.0)
                for word, right in zip(each.path, each.right, strict=True)
            ]
        )
        for each in calls
    ]
    curves = calibrate_asr.curves_of(calls)
    sense, nonsense = calibrate_asr.confidences_of(
        curves, [Emission("climb", 0.9, 0, against=4.0), Emission("climb", 0.9, 0, against=-1.0)]
    )
    assert sense > 0.9
    assert nonsense < 0.1


def aligned(callsign: str, loss: float) -> Aligned:
    form = SpokenForm(("american",), ("one", "two", "three"))
    return Aligned(callsign, form, 0, 20, loss)


def trials(seed: int, count: int) -> list[calibrate_asr.Trial]:
    """Return calls in which the callsign that was said loses little, and others much; a fifth
    calls nobody of the roster."""
    rng = np.random.default_rng(seed)
    made = []
    for _ in range(count):
        losses = {"AAL123": rng.exponential(9.0), "AAL124": rng.exponential(9.0)}
        said = str(rng.choice(["AAL123", "AAL124"])) if rng.random() < 0.8 else None
        if said:
            losses[said] = rng.exponential(2.0)
        made.append(calibrate_asr.Trial(said, [aligned(*each) for each in losses.items()]))
    return made


def test_the_odds_of_callsigns_give_the_share_that_is_right() -> None:
    odds = Odds(**calibrate_asr.fit_odds(trials(1, 600)))
    sure, right = [], []
    for said, (one, other) in trials(2, 600):
        log_odds = np.array([odds(one), odds(other), 0.0])
        sure.append(float(np.exp(log_odds[0] - np.logaddexp.reduce(log_odds))))
        right.append(said == one.callsign)
    for low, high in ((0.0, 0.2), (0.2, 0.8), (0.8, 1.0)):
        chosen = [low <= each <= high for each in sure]
        share = np.mean(np.array(right)[chosen])
        assert share == pytest.approx(np.mean(np.array(sure)[chosen]), abs=0.08)


def test_calls_to_somebody_who_cannot_be_written_tell_nothing_of_odds() -> None:
    some = trials(1, 200)
    unknown = [calibrate_asr.Trial("OPS1", [aligned("AAL123", 0.0)])] * 50
    without_forms = [calibrate_asr.Trial(None, [])] * 50
    assert calibrate_asr.fit_odds([*some, *unknown, *without_forms]) == calibrate_asr.fit_odds(some)


def test_some_rosters_have_a_callsign_one_digit_off_instead() -> None:
    pcm = np.zeros(1, np.int16)
    calls = [SpokenCall({"callsign": f"AAL{number}"}, pcm) for number in range(100, 300)]
    rosters = [(str(each.callsign), "N54G") for each in calls]
    found = calibrate_asr.misleading(calls, rosters)
    changed = [
        (name, other) for (name, _), (other, _) in zip(rosters, found, strict=True) if other != name
    ]
    assert 0.05 < len(changed) / len(calls) < 0.15
    assert all(sum(map(str.__ne__, name, other)) == 1 for name, other in changed)
    assert all(roster[1] == "N54G" for roster in found)
