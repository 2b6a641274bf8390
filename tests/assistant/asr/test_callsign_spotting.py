"""A callsign of the roster that is half heard is found, and no other is made up."""

from __future__ import annotations

from typing import Any, cast

import numpy as np
import numpy.typing as npt
import pytest

from airhilt.assistant.asr.engines.embedded import Emission, with_callsign
from airhilt.assistant.asr.pieces import BEGIN, Pieces
from airhilt.assistant.asr.spotting import NAME_WEIGHT, Odds, Spotted, Spotter, spoken_forms

WORDS = [
    "american", "climb", "delta", "eight", "five", "four", "golf", "niner", "november", "one",
    "six", "sixty", "three", "twelve", "two", "united",
]  # fmt: skip
PIECES = Pieces([BEGIN + word for word in WORDS])
UNIT = {word: unit for unit, word in enumerate(WORDS, start=1)}
ODDS = Odds(offset=0.8, name=1.4, sign=1.1, loss=0.6)


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
    return Spotter(PIECES, callsigns, ODDS).spot(heard)


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


def probability(*log_odds: float) -> float:
    """Return the probability of the first of some callsigns, of which none may be said."""
    shares = np.exp([*log_odds, 0.0])
    return float(shares[0] / shares.sum())


def test_what_a_digit_loses_counts_more_than_what_a_name_does() -> None:
    lost = 4.0
    shares = {"american": np.exp(-lost), "delta": 1.0 - np.exp(-lost)}
    of_name = spotted(posteriors(shares, *clear("one", "two", "six")), "AAL126")
    shares = {"one": np.exp(-lost), "four": 1.0 - np.exp(-lost)}
    of_digit = spotted(posteriors(*clear("american"), shares, *clear("two", "six")), "AAL126")
    said = 0.8 + 1.4 + 3 * 1.1
    assert of_name.confidence == pytest.approx(
        probability(said - 0.6 * NAME_WEIGHT * lost), abs=0.01
    )
    assert of_digit.confidence == pytest.approx(probability(said - 0.6 * lost), abs=0.01)


def test_two_of_the_roster_at_one_place_share_the_probability() -> None:
    heard = posteriors(*clear("american", "one"), {"two": 0.6, "three": 0.35}, *clear("six"))
    said = 0.8 + 1.4 + 3 * 1.1
    alone, beside = spotted(heard, "AAL126"), spotted(heard, "AAL126", "AAL136")
    assert alone.confidence == pytest.approx(probability(said), abs=0.01)
    other = said - 0.6 * np.log(0.6 / 0.35)
    assert beside.confidence == pytest.approx(probability(said, other), abs=0.01)


def test_another_callsign_elsewhere_in_the_call_is_no_rival() -> None:
    heard = posteriors(*clear("american", "one", "two", "six", "climb", "delta", "niner"))
    alone, both = spotted(heard, "AAL126"), spotted(heard, "AAL126", "DAL9")
    assert (both.callsign, both.confidence) == (alone.callsign, alone.confidence)


def test_a_word_that_is_nearly_lost_is_found_again() -> None:
    heard = posteriors({"american": 0.1}, *clear("one", "two", "six", "climb"))
    path = likeliest(heard)
    assert text(path) == "one two six climb"
    found = spotted(heard, "AAL126", "UAL345")
    assert text(with_callsign(path, cast(Spotted, found))) == "american one two six climb"


@pytest.mark.parametrize("said", ["four", "eight"])
def test_another_number_that_is_clearly_said_is_not_overheard(said: str) -> None:
    heard = posteriors(*({word: 0.9999} for word in ("american", "one", said)))
    assert spotted(heard, "AAL12") is None


def test_a_value_is_no_short_registration_without_its_first_sign() -> None:
    heard = posteriors(*clear("climb", "five", "four"))
    assert spotted(heard, "N54", "N5", "N4") is None
    said = posteriors(*clear("november", "five", "four"))
    assert spotted(said, "N54", "N5", "N4").callsign == "N54"


def test_a_callsign_with_a_word_that_the_recogniser_does_not_know_is_left_out() -> None:
    assert spotted(posteriors(*clear("golf", "one", "two")), "GTI12") is None


@pytest.mark.parametrize(
    ("callsign", "forms"),
    [
        ("AAL1260", {"american one two six zero", "american twelve sixty"}),
        ("DAL9", {"delta niner"}),
        ("AAL12G", {"american one two golf", "american twelve golf"}),
        ("AAL905", {"american niner zero five"}),
        ("N54", {"november five four"}),
        ("N54G", {"november five four golf", "five four golf", "november four golf"}),
        (
            "N1254G",
            {
                "november one two five four golf",
                "one two five four golf",
                "november five four golf",
                "november four golf",
                "five four golf",
            },
        ),
        (
            "G-ABCD",
            {
                "golf alfa bravo charlie delta",
                "alfa bravo charlie delta",
                "golf bravo charlie delta",
                "golf charlie delta",
                "bravo charlie delta",
            },
        ),
        ("OPS1", set()),
    ],
)
def test_callsigns_are_looked_for_as_they_may_be_said(callsign: str, forms: set[Any]) -> None:
    said = {" ".join(form.name + form.signs) for form in spoken_forms(callsign)}
    assert said == forms


def test_what_is_clearly_said_is_left_as_it_is() -> None:
    heard = posteriors(*clear("climb", "american", "one"))
    path = likeliest(heard)
    found = with_callsign(path, cast(Spotted, spotted(heard, "AAL1")))
    assert [(each.word, each.begin) for each in found] == [(each.word, each.begin) for each in path]
    assert found[0] == Emission("climb", cast(Any, pytest.approx(0.99, abs=1e-3)), 0)


def test_the_words_of_a_callsign_of_the_roster_have_the_confidence_of_the_whole() -> None:
    heard = posteriors(*clear("climb", "american"), {"one": 0.6, "two": 0.2})
    spot = cast(Spotted, spotted(heard, "AAL1"))
    climb, *callsign = with_callsign(likeliest(heard), spot)
    assert not climb.is_callsign
    assert [(each.posterior, each.is_callsign) for each in callsign] == [
        (spot.confidence, True)
    ] * 2


def test_a_name_that_is_no_piece_is_spelled() -> None:
    pieces = Pieces(["_g", "i", "ant", "_one", "_two"])
    heard = np.full((10, len(pieces) + 1), 1e-6, np.float32)
    heard[1::2, 0] = 1.0
    for step, unit in enumerate((1, 2, 3, 4, 5)):
        heard[2 * step, unit] = 1.0
    found = cast(Spotted, Spotter(pieces, ("GTI12", "GTI21"), ODDS).spot(heard))
    assert (found.callsign, found.words) == ("GTI12", ("giant", "one", "two"))
    assert found.confidence > 0.98
