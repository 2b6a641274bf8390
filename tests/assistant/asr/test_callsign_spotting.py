"""A callsign of the roster that is half heard is found, and no other is made up."""

from __future__ import annotations

from typing import Any, cast

import numpy as np
import numpy.typing as npt
import pytest

from airhilt.assistant.asr.engines.embedded import Emission, best_path, with_callsign
from airhilt.assistant.asr.spotting import Spotted, Spotter, spoken_forms

WORDS = [
    "american", "climb", "delta", "eight", "five", "four", "golf", "niner", "november", "one",
    "six", "sixty", "three", "twelve", "two", "united",
]  # fmt: skip
UNIT = {word: unit for unit, word in enumerate(WORDS, start=1)}


def posteriors(*steps: dict[Any, Any]) -> npt.NDArray[np.floating[Any]]:
    """Return posteriors: for each step the share of some words, the rest being the blank's."""
    made = np.full((2 * len(steps), len(WORDS) + 1), 1e-6, np.float32)
    made[:, 0] = 1.0
    for index, shares in enumerate(steps):
        row = made[2 * index]
        for word, share in shares.items():
            row[UNIT[word]] = share
        row[0] = max(1.0 - sum(shares.values()), 1e-6)
    made /= made.sum(axis=1, keepdims=True)
    return made


def clear(*words: str) -> list[dict[str, float]]:
    return [{word: 0.99} for word in words]


def spotted(heard: npt.NDArray[np.floating[Any]], *callsigns: str) -> Any:
    return Spotter(WORDS, callsigns).spot(heard)


def text(path: list[Emission]) -> str:
    return " ".join(WORDS[each.unit - 1] for each in path)


def test_a_callsign_that_is_clearly_said_costs_nothing() -> None:
    found = spotted(posteriors(*clear("american", "one", "two", "climb")), "AAL12", "DAL12")
    assert found.callsign == "AAL12"
    assert found.loss == pytest.approx(0.0, abs=1e-3)


def test_a_word_that_is_nearly_lost_is_found_again() -> None:
    heard = posteriors({"american": 0.1}, *clear("one", "two", "six", "climb"))
    path = best_path(heard)
    assert text(path) == "one two six climb"
    found = spotted(heard, "AAL126", "UAL345")
    assert text(with_callsign(path, cast(Spotted, found))) == "american one two six climb"


def test_words_of_a_callsign_are_less_sure_where_it_fits_less() -> None:
    heard = posteriors({"american": 0.1}, *clear("one", "two"))
    sure = with_callsign(best_path(heard), cast(Spotted, spotted(heard, "AAL12")))
    assert all(each.posterior < 0.9 for each in sure)
    plain = posteriors(*clear("american", "one", "two"))
    assert all(each.posterior > 0.9 for each in best_path(plain))


@pytest.mark.parametrize("said", ["four", "eight"])
def test_another_number_that_is_clearly_said_is_not_overheard(said: str) -> None:
    heard = posteriors(*({word: 0.9999} for word in ("american", "one", said)))
    assert spotted(heard, "AAL12") is None


def test_of_two_that_fit_alike_none_is_taken() -> None:
    heard = posteriors({"american": 0.1}, *clear("one"), {"two": 0.3, "three": 0.3}, *clear("six"))
    assert spotted(heard, "AAL126", "AAL136") is None
    assert spotted(heard, "AAL126", "UAL136").callsign == "AAL126"


def test_noise_is_nobody() -> None:
    assert spotted(posteriors(*[{}] * 30), "AAL12", "N54") is None


def test_nothing_is_found_without_a_roster_or_without_audio() -> None:
    assert spotted(posteriors(*clear("american", "one"))) is None
    assert spotted(np.zeros((0, len(WORDS) + 1), np.float32), "AAL1") is None


def test_a_callsign_with_a_word_that_the_recogniser_does_not_know_is_left_out() -> None:
    assert spotted(posteriors(*clear("golf", "one", "two")), "GTI12") is None


def test_the_same_digit_twice_needs_a_gap_between() -> None:
    said = posteriors(*clear("american", "one", "one"))
    assert spotted(said, "AAL11").loss == pytest.approx(0.0, abs=1e-3)
    once = best_path(posteriors(*clear("american", "one")))
    assert len(once) == 2


@pytest.mark.parametrize(
    ("callsign", "forms"),
    [
        ("AAL1260", {"american one two six zero", "american twelve sixty"}),
        ("DAL9", {"delta niner"}),
        ("N54G", {"november five four golf", "five four golf"}),
        ("OPS1", set()),
    ],
)
def test_callsigns_are_looked_for_as_they_may_be_said(callsign: str, forms: set[Any]) -> None:
    assert {" ".join(form) for form in spoken_forms(callsign)} == forms


def test_any_word_for_a_digit_will_do() -> None:
    words = [*WORDS, "nine"]
    heard = np.full((4, len(words) + 1), 1e-6, np.float32)
    heard[0, UNIT["delta"]] = heard[2, len(words)] = 1.0
    heard[[1, 3], 0] = 1.0
    found = Spotter(words, ("DAL9",)).spot(heard)
    assert found.loss == pytest.approx(0.0, abs=1e-3)


def test_what_is_clearly_said_is_left_as_it_is() -> None:
    heard = posteriors(*clear("climb", "american", "one"))
    path = best_path(heard)
    assert with_callsign(path, cast(Spotted, spotted(heard, "AAL1"))) == path
    assert path[0] == Emission(UNIT["climb"], cast(Any, pytest.approx(0.99, abs=1e-3)), 0)
