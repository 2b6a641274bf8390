"""How well people hear: the less noise, the better, and the same in each run."""

from __future__ import annotations

from collections import Counter

import pytest

from airhilt.sensors.radio.hearing import (
    CONFUSED_WITH,
    MISHEARD_SHARE,
    HearingModel,
    _misheard,
    probability_noticed,
    probability_understood,
)

TEXT = "American one two three, climb and maintain flight level three three zero."


def outcomes(snr_db: float, calls: int = 2000) -> Counter[str]:
    model = HearingModel(seed=1)
    heard = (model.listen(f"call{n}", "AAL123", TEXT, snr_db) for n in range(calls))
    return Counter(one.outcome for one in heard)


def test_without_noise_everybody_understands_every_word() -> None:
    heard = HearingModel(seed=3).listen("a", "AAL123", TEXT, None)
    assert (heard.outcome, heard.text) == ("understood", TEXT)


@pytest.mark.parametrize("snr_db", [-8.0, -3.0, 2.0, 10.0])
def test_as_many_calls_are_understood_as_the_curve_says(snr_db: float) -> None:
    share = outcomes(snr_db)["understood"] / 2000
    assert share == pytest.approx(probability_understood(snr_db), abs=0.04)


@pytest.mark.parametrize("snr_db", [-1000.0, -30.0, 0.0, 60.0, 1000.0])
def test_what_is_understood_was_noticed(snr_db: float) -> None:
    assert 0.0 <= probability_understood(snr_db) <= probability_noticed(snr_db) <= 1.0


def test_what_is_misheard_differs_in_one_word_that_sounds_alike() -> None:
    model = HearingModel(seed=1)
    heard = [model.listen(f"call{n}", "AAL123", TEXT, -2.0) for n in range(2000)]
    misheard = [one.text.lower().split() for one in heard if one.outcome == "misheard"]
    assert misheard
    for words in misheard:
        pairs = [
            (a.strip(".,"), b.strip(".,"))
            for a, b in zip(TEXT.lower().split(), words, strict=True)
            if a != b
        ]
        assert len(pairs) == 1
        assert CONFUSED_WITH[pairs[0][0]] == pairs[0][1]


def test_one_in_ten_of_the_calls_that_are_not_understood_is_taken_for_something_else() -> None:
    counts = outcomes(-2.0)
    noticed = counts["misheard"] + counts["unsure"]
    assert counts["misheard"] / noticed == pytest.approx(MISHEARD_SHARE, abs=0.03)


def test_each_call_and_listener_is_drawn_by_itself_and_again_the_same() -> None:
    def drawn(seed: int, listener: str) -> list[str]:
        model = HearingModel(seed)
        return [model.listen(f"call{n}", listener, TEXT, 0.0).outcome for n in range(50)]

    assert drawn(1, "AAL123") == drawn(1, "AAL123")
    assert drawn(1, "AAL123") != drawn(1, "DAL456")
    assert drawn(1, "AAL123") != drawn(2, "AAL123")


@pytest.mark.parametrize(
    ("draw", "heard"),
    [
        (0.0, "Climb nine left, then two"),
        (0.33, "Climb nine left, then two"),
        (0.34, "Climb five right, then two"),
        (0.67, "Climb five left, then three"),
        (0.999, "Climb five left, then three"),
        (1.0, "Climb five left, then three"),
    ],
)
def test_each_word_that_sounds_like_another_is_as_likely_to_be_misheard(
    draw: float, heard: str
) -> None:
    assert _misheard("Climb five left, then two", draw) == heard


def test_words_that_sound_like_no_others_are_not_misheard() -> None:
    assert _misheard("Good morning", 0.5) is None


def test_the_curves_are_as_steep_as_those_of_plomp_and_mimpen() -> None:
    """18 % a decibel at the middle; 6 dB lower, as many calls are noticed as are understood."""
    steep = probability_understood(0.5) - probability_understood(-0.5)
    assert steep == pytest.approx(0.18, abs=0.005)
    for snr_db in (-8.0, -3.0, 0.0, 4.0):
        assert probability_noticed(snr_db - 6.0) == pytest.approx(probability_understood(snr_db))
        below = probability_understood(-snr_db)
        assert below == pytest.approx(1.0 - probability_understood(snr_db))
