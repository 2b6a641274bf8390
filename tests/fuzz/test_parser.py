"""Whatever is said, the parser reads it; and it reads the same each time."""

from __future__ import annotations

from hypothesis import given
from hypothesis import strategies as st

from airhilt.phraseology import parse_call, tokens
from fuzzing import any_input

ROSTER = ("AAL123", "DAL456", "N172SP")
SPOKEN = (
    "american delta one two three four five six niner zero thousand hundred flight level point "
    "runway left right center cleared to land for takeoff climb descend and maintain turn heading "
    "cross hold short line up wait cancel negative correction say again go around via alfa "
    "bravo november ils approach squawk contact tower until at or above below 27l 36 118.7 FL330"
)

calls = st.lists(st.sampled_from(SPOKEN.split()), max_size=40).map(" ".join)
texts = calls | st.text(max_size=200) | st.lists(calls | st.text(max_size=5)).map("".join)


@any_input
@given(texts)
def test_any_text_is_read_without_an_error(text: str) -> None:
    call = parse_call(text, ROSTER)
    assert call == parse_call(text, ROSTER)
    assert all(0.0 <= each.confidence <= 1.0 for each in call.instructions)


@any_input
@given(texts, st.data())
def test_any_confidences_of_words_are_taken(text: str, data: st.DataObject) -> None:
    count = len(text.split())
    shares = data.draw(st.lists(st.floats(0.0, 1.0), min_size=count, max_size=count))
    call = parse_call(text, ROSTER, shares)
    assert all(0.0 <= each.confidence <= 1.0 for each in call.instructions)


@any_input
@given(texts)
def test_words_are_found_in_any_text(text: str) -> None:
    assert all(word and not word.isspace() for word in tokens(text))
