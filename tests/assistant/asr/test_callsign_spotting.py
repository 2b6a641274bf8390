"""A callsign of the roster that is half heard is found, and no other is made up."""

from __future__ import annotations

from typing import Any, cast

import numpy as np
import numpy.typing as npt
import pytest

from airhilt.assistant.asr.engines.embedded import Emission, with_callsign
from airhilt.assistant.asr.pieces import BEGIN, Pieces
from airhilt.assistant.asr.spotting import Spotted, Spotter, spoken_forms

WORDS = [
    "american", "climb", "delta", "eight", "five", "four", "golf", "niner", "november", "one",
    "six", "sixty", "three", "twelve", "two", "united",
]  # fmt: skip
PIECES = Pieces([BEGIN + word for word in WORDS])
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
    return Spotter(PIECES, callsigns).spot(heard)


def likeliest(heard: npt.NDArray[np.floating[Any]]) -> list[Emission]:
    """Return the word of each step whose likeliest unit is one."""
    units = heard.argmax(axis=1)
    return [
        Emission(WORDS[unit - 1], float(heard[step, unit]), step)
        for step, unit in enumerate(units)
        if unit
    ]


def text(path: list[Emission]) -> str:
    return " ".join(each.word for each in path)


def test_a_callsign_that_is_clearly_said_costs_nothing() -> None:
    found = spotted(posteriors(*clear("american", "one", "two", "climb")), "AAL12", "DAL12")
    assert found.callsign == "AAL12"
    assert found.loss == pytest.approx(0.0, abs=1e-3)


def test_a_word_that_is_nearly_lost_is_found_again() -> None:
    heard = posteriors({"american": 0.1}, *clear("one", "two", "six", "climb"))
    path = likeliest(heard)
    assert text(path) == "one two six climb"
    found = spotted(heard, "AAL126", "UAL345")
    assert text(with_callsign(path, cast(Spotted, found))) == "american one two six climb"


def test_words_of_a_callsign_are_less_sure_where_it_fits_less() -> None:
    heard = posteriors({"american": 0.1}, *clear("one", "two"))
    sure = with_callsign(likeliest(heard), cast(Spotted, spotted(heard, "AAL12")))
    assert all(each.posterior < 0.9 for each in sure)
    plain = posteriors(*clear("american", "one", "two"))
    assert all(each.posterior > 0.9 for each in likeliest(plain))


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
    assert spotted(posteriors(*clear("american", "one")), "AAL11") is None


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
    pieces = Pieces([*(BEGIN + word for word in WORDS), BEGIN + "nine"])
    heard = np.full((4, len(pieces) + 1), 1e-6, np.float32)
    heard[0, UNIT["delta"]] = heard[2, len(pieces)] = 1.0
    heard[[1, 3], 0] = 1.0
    found = Spotter(pieces, ("DAL9",)).spot(heard)
    assert found.loss == pytest.approx(0.0, abs=1e-3)


def test_what_is_clearly_said_is_left_as_it_is() -> None:
    heard = posteriors(*clear("climb", "american", "one"))
    path = likeliest(heard)
    found = with_callsign(path, cast(Spotted, spotted(heard, "AAL1")))
    assert [(each.word, each.begin) for each in found] == [(each.word, each.begin) for each in path]
    assert found[0] == Emission("climb", cast(Any, pytest.approx(0.99, abs=1e-3)), 0)


def test_the_words_of_a_callsign_of_the_roster_have_the_likelihood_of_the_whole() -> None:
    heard = posteriors(*clear("climb", "american"), {"one": 0.6, "two": 0.2})
    spot = cast(Spotted, spotted(heard, "AAL1"))
    climb, *callsign = with_callsign(likeliest(heard), spot)
    assert not climb.is_callsign
    assert [(each.posterior, each.is_callsign) for each in callsign] == [
        (np.exp(-spot.loss), True)
    ] * 2


def test_a_name_that_is_no_piece_is_spelled() -> None:
    pieces = Pieces(["_g", "i", "ant", "_one", "_two"])
    heard = np.full((10, len(pieces) + 1), 1e-6, np.float32)
    heard[1::2, 0] = 1.0
    for step, unit in enumerate((1, 2, 3, 4, 5)):
        heard[2 * step, unit] = 1.0
    found = cast(Spotted, Spotter(pieces, ("GTI12", "GTI21")).spot(heard))
    assert (found.callsign, found.words) == ("GTI12", ("giant", "one", "two"))
    assert found.loss == pytest.approx(0.0, abs=1e-3)
