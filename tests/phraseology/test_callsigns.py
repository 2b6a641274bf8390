"""Whose callsign a call says, among those on the frequency, and how sure that is."""

from __future__ import annotations

from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from airhilt.phraseology import AIRLINES, TAU_ASR, TELEPHONY, parse_call, tokens
from airhilt.phraseology.callsign_repair import INTRODUCING, VALUED, similarity
from airhilt.phraseology.hits import STATIONS
from airhilt.phraseology.hits import is_spoken_of as spoken_of
from airhilt.phraseology.spoken_forms import joined

KNOWN = ("AAL123", "DAL456", "AFR7", "ACA88", "N12")
AIRPORT = ("AAL123", "AAL132", "DAL456", "N172SP", "OPS1", "TUG2", "FIRE3", "PLOW4")


def test_an_instruction_begins_with_the_callsign_and_a_readback_ends_with_it(
    subtests: pytest.Subtests,
) -> None:
    for text, callsign, addressed_first in [
        ("American one two three, climb and maintain FL330.", "AAL123", True),
        ("Climb and maintain FL330, American one two three.", "AAL123", False),
        ("Okay, American one two three, climb FL330", "AAL123", True),
        ("AAL123 climb FL330", "AAL123", True),
        ("climb FL330 AAL123", "AAL123", False),
        ("American one twenty three heavy, climb FL330", "AAL123", True),
        ("American won two tree, climb FL330", "AAL123", True),
        ("Air Canada eight eight, descend flight level two zero zero", "ACA88", True),
        ("Air Canada eighty eight, descend flight level two zero zero", "ACA88", True),
        ("Air France seven, climb FL200", "AFR7", True),
        ("Airfrans seven, climb FL200", "AFR7", True),
        ("November one two, climb FL200", "N12", True),
        ("November one three, climb FL200", None, False),
        ("N12, climb FL200", "N12", True),
        ("Delta four, climb FL200", None, False),
        ("United five five, climb FL330", None, False),
        ("Delta four five six, traffic American one two three", "DAL456", True),
        ("climb flight level three three zero", None, False),
    ]:
        with subtests.test(text):
            call = parse_call(text, KNOWN)
            assert (call.callsign, call.addressed_first) == (callsign, addressed_first)


def test_vehicles_and_registrations_are_heard_as_they_are_spoken(subtests: pytest.Subtests) -> None:
    for spoken, callsign in [
        ("ops one", "OPS1"),
        ("operations one", "OPS1"),
        ("OPS 1", "OPS1"),
        ("tug two", "TUG2"),
        ("fire three", "FIRE3"),
        ("fire truck three", "FIRE3"),
        ("snow plow four", "PLOW4"),
        ("plow fower", "PLOW4"),
        ("Cessna one seven two sierra papa", "N172SP"),
        ("november 172 sierra papa", "N172SP"),
        ("Skyhawk one seven two s p", "N172SP"),
        ("American one three two", "AAL132"),
    ]:
        with subtests.test(spoken):
            call = parse_call(f"{spoken}, hold position", AIRPORT)
            assert (call.callsign, call.addressed_first) == (callsign, True)
            call = parse_call(f"holding position, {spoken}", AIRPORT)
            assert (call.callsign, call.addressed_first) == (callsign, False)


def test_registrations_are_abbreviated_to_their_first_sign_and_last_ones(
    subtests: pytest.Subtests,
) -> None:
    for spoken, callsign in [
        ("Cessna two sierra papa", "N172SP"),
        ("November sierra papa", "N172SP"),
        ("Golf charlie delta", "G-ABCD"),
        ("Golf alfa bravo charlie delta", "G-ABCD"),
        ("Speedbird eight", None),
    ]:
        with subtests.test(spoken):
            known = ("N172SP", "G-ABCD", "BAW38")
            assert parse_call(f"{spoken}, hold position", known).callsign == callsign


def test_an_abbreviation_that_two_could_have_is_ambiguous() -> None:
    call = parse_call("November two sierra papa, hold position", ("N172SP", "N552SP"))
    assert call.callsign is None
    assert call.match.ambiguous
    assert {each.callsign for each in call.match.candidates} == {"N172SP", "N552SP"}
    assert call.confidence <= 0.5
    full = parse_call("November one seven two sierra papa, hold position", ("N172SP", "N552SP"))
    assert (full.callsign, full.match.ambiguous) == ("N172SP", False)


def test_misspelt_airlines_are_known_by_their_number(subtests: pytest.Subtests) -> None:
    for spoken, callsign in [
        ("amercan one two three", "AAL123"),
        ("americans one two three", "AAL123"),
        ("speed bird three eight", "BAW38"),
        ("lufthanza four alfa bravo", "DLH4AB"),
        ("fed ex sixteen oh two", "FDX1602"),
        ("southwests five", "SWA5"),
        ("united one two three", None),
    ]:
        with subtests.test(spoken):
            known = ("AAL123", "BAW38", "DLH4AB", "FDX1602", "SWA5")
            call = parse_call(f"{spoken}, hold position", known)
            assert call.callsign == callsign
            assert 0.8 <= call.match.score <= 1.0 or callsign is None


def test_what_fits_only_one_names_it_but_not_for_certain(subtests: pytest.Subtests) -> None:
    for said, callsign in [
        ("one two three, hold position", "AAL123"),
        ("banana one two three, hold position", "AAL123"),
        ("hold position, banana one twenty three", "AAL123"),
        ("tower, banana one two three, ready", "AAL123"),
        ("Delta four five, hold position", "DAL456"),
        ("Delta four five niner, hold position", "DAL456"),
        ("Delta four five six six, hold position", "DAL456"),
        ("two sierra papa, hold position", "N172SP"),
        ("hold position, two sierra papa", "N172SP"),
        ("Maintaining flight level three six zero two sierra papa", "N172SP"),
        ("november one seven two zero papa, hold position", "N172SP"),
        ("november one heaven two sierra papa, hold position", "N172SP"),
        ("november one seven two sierra and uh papa, hold position", "N172SP"),
    ]:
        with subtests.test(said):
            known = ("AAL123", "DAL456", "AFR7", "N172SP")
            call = parse_call(said, known)
            assert call.callsign == callsign
            is_full = said.startswith("november one seven two sierra and")
            assert (call.match.score >= TAU_ASR) == is_full
            assert call.confidence < TAU_ASR or is_full


def test_anothers_name_and_other_numbers_name_nobody(subtests: pytest.Subtests) -> None:
    for said in [
        "united one two three, hold position",
        "Cessna one two three, hold position",
        "Speedbird seven, hold position",
        "hold position, follow banana one two three",
        "climb flight level one two three",
        "turn left one two three",
        "reduce one two three knots",
        "contact tower one one eight decimal one two three",
        "hold position via alfa seven",
    ]:
        with subtests.test(said):
            assert parse_call(said, ("AAL123", "AFR7", "DAL456")).callsign is None


def test_a_number_that_two_have_names_neither() -> None:
    match = parse_call("banana one two three, hold position", ("AAL123", "BAW123")).match
    assert (match.ambiguous, len(match.candidates)) == (True, 2)


def test_callsigns_of_all_kinds_are_heard_where_they_stand(subtests: pytest.Subtests) -> None:
    for said, callsign in [
        ("Cleveland approach, Delta four five six, ready", "DAL456"),
        ("Phenom one seven two sierra papa, hold position", "N172SP"),
        ("Diamond star two sierra papa, hold position", "N172SP"),
        ("Oscar echo whiskey zulu zulu, hold position", "OEWZZ"),
        ("Juliett alfa eight zero eight niner, hold position", "JA8089"),
        ("Five alfa charlie bravo, hold position", None),
        ("Four xray alfa bravo charlie, hold position", "4XABC"),
        ("Robin zulu zulu, hold position", "OEWZZ"),
        ("K L M six eight romeo, hold position", "KLM68R"),
        ("Hold position, K L M sixty eight romeo heavy", "KLM68R"),
        ("Unlisted three nine victor, hold position", "XZQ39V"),
        ("Request flight following, Delta four five six", "DAL456"),
        ("Behind the landing traffic line up behind Delta four five six", "DAL456"),
        ("Caution wake turbulence departing Delta four five six, cleared for takeoff", None),
    ]:
        with subtests.test(said):
            known = ("DAL456", "N172SP", "OEWZZ", "JA8089", "4XABC", "KLM68R", "XZQ39V")
            assert parse_call(said, known).callsign == callsign


def test_who_ends_a_call_is_its_speaker_whoever_else_is_named() -> None:
    call = parse_call("Behind American 123, line up runway 01, Delta 456", AIRPORT)
    assert (call.callsign, call.addressed_first) == ("DAL456", False)


@pytest.mark.parametrize(
    "text",
    [
        "American 123, hold position, Delta 456, runway 01, cleared to land",
        "American 123, hold position, Delta four five seven, runway 01, cleared to land",
        "American 123, hold position, Delta 456, cross runway 01",
    ],
)
def test_what_is_told_to_somebody_else_in_the_same_call_is_not_for_the_first(text: str) -> None:
    call = parse_call(text, AIRPORT)
    assert call.callsign == "AAL123"
    assert [each.action for each in call.instructions] == ["hold_position"]


def test_there_are_the_airlines_that_a_user_meets() -> None:
    assert len(AIRLINES) >= 150
    assert all(TELEPHONY[each] == airline.telephony for each, airline in AIRLINES.items())
    assert all(tokens(name) for name in TELEPHONY.values())


@settings(deadline=None)
@given(st.sampled_from(sorted(TELEPHONY)), st.integers(1, 9999))
def test_a_flight_is_heard_by_its_designator_and_by_its_airlines_telephony(
    airline: str, number: int
) -> None:
    callsign = f"{airline}{number}"
    for form in (callsign, f"{TELEPHONY[airline]} {' '.join(str(number))}"):
        call = parse_call(f"{form}, climb FL330", [callsign])
        assert (call.callsign, call.addressed_first) == (callsign, True)
        assert (call.sense, call.altitude_ft) == ("climb", 33_000)


@settings(deadline=None)
@given(
    st.lists(st.sampled_from([*KNOWN, *AIRPORT]), unique=True),
    st.lists(st.sampled_from(["american", "delta", "one", "two", "three", "four", "five", "six",
                              "november", "sierra", "papa", "hold", "position", "ops"]),
             max_size=10),
)  # fmt: skip
def test_nobody_is_named_who_is_not_on_the_frequency(
    callsigns: list[Any], words: list[Any]
) -> None:
    call = parse_call(" ".join(words), callsigns)
    assert call.callsign is None or call.callsign in callsigns
    assert {each.callsign for each in call.match.candidates} <= set(callsigns)
    assert all(0.0 <= each.score <= 1.0 for each in call.match.candidates)


def test_no_name_of_an_operator_is_a_word_that_introduces_a_value() -> None:
    others = INTRODUCING | VALUED | STATIONS
    assert {name for name in TELEPHONY.values() if joined(name) in others} == set()
    assert len(TELEPHONY) >= 600


SAID = {
    "AAL123": "american one two three",
    "AAL132": "american one thirty two",
    "DAL456": "delta four fifty six",
    "BAW38R": "speedbird three eight romeo",
    "N172SP": "november one seven two sierra papa",
    "G-ABCD": "golf alfa bravo charlie delta",
}
"""Callsigns of a frequency, in the words that name them."""
HEARD_FOR = {
    "one": ("won", "run"), "two": ("to", "too", "you"), "three": ("tree", "free"),
    "four": ("for", "floor"), "eight": ("ate", "wait"), "seven": ("heaven",),
    "american": ("americans", "marathon"), "delta": ("dealt", "felt"), "golf": ("gulf",),
    "speedbird": ("feed bird", "speed"), "november": ("remember",), "sierra": ("sarah",),
    "papa": ("pepper",), "charlie": ("charley",), "romeo": ("remember",), "six": ("fix", "sex"),
    "fifty": ("fifteen",), "thirty": ("thirteen",), "alfa": ("alpha", "half"),
}  # fmt: skip
"""Words that recognisers write for others."""


@settings(deadline=None, max_examples=400)
@given(
    st.sampled_from(sorted(SAID)),
    st.integers(0, 9),
    st.integers(-1, 2),
    st.booleans(),
)
def test_an_error_never_makes_another_callsign_for_certain(
    callsign: str, at: int, choice: int, is_first: bool
) -> None:
    """One word lost or misheard: only what is another's own callsign, word for word, names it."""
    words = SAID[callsign].split()
    at %= len(words)
    heard = HEARD_FOR.get(words[at], ())
    words[at] = heard[choice % len(heard)] if choice >= 0 and heard else ""
    name = " ".join(filter(None, words))
    text = f"{name} hold position" if is_first else f"holding position {name}"
    call = parse_call(text, tuple(SAID))
    assert call.match.score < TAU_ASR or call.callsign in (None, callsign), text


@settings(deadline=None, max_examples=300)
@given(
    st.lists(st.sampled_from(["climb", "descend", "heading", "level", "knots", "runway", "maintain",
                              "left", "one", "two", "three", "four", "five", "six", "thousand",
                              "wind", "at", "turn", "squawk", "decimal", "hundred"]), max_size=12),
)  # fmt: skip
def test_values_alone_never_name_anybody_for_certain(words: list[Any]) -> None:
    match = parse_call(" ".join(words), tuple(SAID)).match
    assert match.callsign is None or match.score < TAU_ASR


@settings(deadline=None, max_examples=200)
@given(
    st.text("0123456789", min_size=3, max_size=4).filter(lambda text: text[0] != "0"),
    st.integers(0, 3),
    st.integers(0, 3),
    st.sampled_from("0123456789"),
    st.sampled_from("0123456789"),
)
def test_a_misheard_digit_never_names_another_for_certain_unless_it_is_its_whole_number(
    number: str, at: int, wrong_at: int, other_digit: str, heard_digit: str
) -> None:
    """Two callsigns that differ by one digit are told apart by their words alone."""
    at, wrong_at = at % len(number), wrong_at % len(number)
    other = number[:at] + other_digit + number[at + 1 :]
    heard = number[:wrong_at] + heard_digit + number[wrong_at + 1 :]
    text = f"delta {' '.join(heard)} descend and maintain six thousand"
    match = parse_call(text, (f"DAL{number}", f"DAL{other}")).match
    named = match.callsign if match.score >= TAU_ASR and not match.ambiguous else None
    assert named in (None, f"DAL{heard}")


def test_zeros_may_fill_a_flight_number_to_three_digits(subtests: pytest.Subtests) -> None:
    for spoken, callsign in [
        ("emirates zero zero three", "UAE3"),
        ("emirates zero three zero", "UAE30"),
        ("emirates three", "UAE3"),
        ("gulf air zero zero six", "GFA6"),
        ("gulf air five zero six", "GFA506"),
    ]:
        with subtests.test(spoken):
            known = ("UAE3", "UAE30", "GFA6", "GFA506")
            assert parse_call(f"{spoken} hold position", known).callsign == callsign


def test_the_speaker_may_correct_the_callsign_by_no() -> None:
    call = parse_call("delta no united nine one four runway two eight cleared to land", ("UAL914",))
    assert call.callsign == "UAL914"
    assert [each.action for each in call.instructions] == ["cleared_to_land"]


# --- scores ---------------------------------------------------------------------------------

ON_FREQUENCY = (
    "AAL123", "DAL456", "AFR7", "N172SP", "KLM68R", "G-ABCD", "BAW1602", "UAE3", "SWA5",
)  # fmt: skip


def test_the_score_says_what_of_a_callsign_was_said(subtests: pytest.Subtests) -> None:
    """As the table of docs/parser-accuracy.md has it."""
    for said, callsign, score in [
        ("american one two three", "AAL123", 1.0),
        ("american one two three heavy", "AAL123", 1.0),
        ("air france seven", "AFR7", 1.0),
        ("speedbird sixteen zero two", "BAW1602", 1.0),
        ("speed bird sixteen zero two", "BAW1602", 1.0),
        ("november one seven two sierra papa", "N172SP", 1.0),
        ("cessna one seven two sierra papa", "N172SP", 1.0),
        ("golf alfa bravo charlie delta", "G-ABCD", 1.0),
        ("k l m six eight romeo", "KLM68R", 1.0),
        ("emirates three", "UAE3", 1.0),
        # Abbreviated by the rules, filled with zeros, in full without "november".
        ("emirates zero zero three", "UAE3", 0.9),
        ("emirates zero three", "UAE3", 0.9),
        ("cessna two sierra papa", "N172SP", 0.9),
        ("november two sierra papa", "N172SP", 0.9),
        ("november sierra papa", "N172SP", 0.9),
        ("golf charlie delta", "G-ABCD", 0.9),
        ("golf bravo charlie delta", "G-ABCD", 0.9),
        ("one seven two sierra papa", "N172SP", 0.9),
        ("banana one seven two sierra papa", "N172SP", 0.9),
        ("speedbird sixteen oh two", "BAW1602", 0.9),  # "Oh" was corrected.
        # A misspelt airline: 0.95 of the likeness of eight letters of which one is lost.
        ("amercan one two three", "AAL123", 0.95 * 7 / 8),
        # A right number without a name, the last three signs of a registration.
        ("one two three", "AAL123", 0.75),
        ("sixteen zero two", "BAW1602", 0.75),
        ("six eight romeo", "KLM68R", 0.75),
        ("two sierra papa", "N172SP", 0.75),
        ("banana two sierra papa", "N172SP", 0.75),
        ("alfa bravo charlie delta", "G-ABCD", 0.75),
        # Another word before it, one digit, other digits behind it.
        ("banana one two three", "AAL123", 0.63),
        ("banana seven", "AFR7", 0.63),
        ("american one two three four", "AAL123", 0.63),
        ("banana one two three four", "AAL123", 0.63),
        ("one two three four", "AAL123", 0.63),
        # One sign of three wrong, missing or added.
        ("american one two four", "AAL123", 0.62),
        ("american one three", "AAL123", 0.62),
        ("speedbird sixteen zero three", "BAW1602", 0.62),
        ("speedbird sixteen zero", "BAW1602", 0.62),
        ("november one seven two sierra quebec", "N172SP", 0.62),
        ("november one seven two sierra", "N172SP", 0.62),
        ("golf alfa bravo charlie echo", "G-ABCD", 0.62),
        ("k l m six eight", "KLM68R", 0.62),
        # A letter behind it may belong to another callsign; digits, to a distance or a runway.
        ("american one two three alfa", "AAL123", 0.7),
        ("american one two three five miles", "AAL123", 0.9),
        ("american one two three three six right cleared to land", "AAL123", 0.9),
        ("american one two three three six left line up", "AAL123", 0.9),
        ("american one two three three seven right cleared to land", "AAL123", 0.63),
        ("american one two three three six right turn", "AAL123", 0.63),
        # Another's name, or a number that fits none.
        ("united one two three", None, 0.5),
        ("cessna one two three", None, 0.5),
        ("banana one two four", None, 0.5),
        ("seven", None, 0.5),
        ("united one two three five", None, 0.0),
        ("air france eight", None, 0.3),
        ("sierra papa", None, 0.0),
        ("maintain one two three knots", None, 0.0),
        ("one two three knots", None, 0.0),
        ("heading one two three", None, 0.0),
        ("climb flight level one two three", None, 0.0),
    ]:
        with subtests.test(said):
            match = parse_call(f"{said}, hold position", ON_FREQUENCY).match
            assert (match.callsign, match.score) == (callsign, pytest.approx(score))


def test_who_calls_a_unit_by_a_name_of_up_to_four_words_is_named_behind_it(
    subtests: pytest.Subtests,
) -> None:
    """Otherwise the speaker is who is named at the end."""
    for unit, callsign in [
        ("Tower", "DAL456"),
        ("Lake City Tower", "DAL456"),
        ("Salt Lake City Tower", "DAL456"),
        ("The Salt Lake City Tower", "AAL123"),
    ]:
        with subtests.test(unit):
            call = parse_call(
                f"{unit}, Delta four five six, good day American one two three", KNOWN
            )
            assert call.callsign == callsign


def test_who_is_named_beside_another_is_ambiguous(subtests: pytest.Subtests) -> None:
    for said, is_ambiguous in [
        ("american one two three", False),
        ("american one two three or one two four", True),
        ("american one two three or delta four five six", True),
        ("american one two three or two four", True),
        ("american one two three or one", False),
        ("american one two three and delta four five six", False),
        ("cessna one two three", True),
    ]:
        with subtests.test(said):
            match = parse_call(f"{said}, hold position", ON_FREQUENCY).match
            assert match.ambiguous is is_ambiguous
            scores = [each.score for each in match.candidates]
            assert scores == sorted(scores, reverse=True)


def test_words_before_a_callsign_show_whether_somebody_else_is_meant(
    subtests: pytest.Subtests,
) -> None:
    for words, is_spoken_of in [
        ("follow | via", True),
        ("we follow |", False),
        ("will following |", False),
        ("who follow |", True),
        ("behind the landing |", True),
        ("behind a cessna |", True),
        ("behind the big |", False),
        ("behind traffic behind |", False),
        ("after traffic after |", False),
        ("behind traffic after |", True),
        ("flight following |", False),
        ("request flight following | climb", False),
        ("traffic departing |", False),
        ("traffic departing | climb", True),
        ("aircraft departing |", True),
        ("wake turbulence from |", True),
        ("passing | climb", True),
        ("the |", False),
        ("heavy heavy | climb", False),
        ("| climb", False),
    ]:
        with subtests.test(words):
            texts = words.split()
            at = texts.index("|")
            assert spoken_of(texts, at, at + 1) is is_spoken_of


def test_similarity_is_the_part_that_need_not_be_edited(subtests: pytest.Subtests) -> None:
    """By the distance of Levenshtein: three edits make a sitting of a kitten."""
    table = [
        ("", "", 1.0), ("a", "", 0.0), ("abc", "abc", 1.0), ("abc", "abd", 2 / 3),
        ("abc", "ab", 2 / 3), ("abc", "xabc", 0.75), ("abc", "acb", 1 / 3), ("abcd", "wxyz", 0.0),
        ("kitten", "sitting", 4 / 7),
    ]  # fmt: skip
    for first, second, expected in table:
        with subtests.test(str((first, second, expected))):
            assert similarity(first, second) == pytest.approx(expected)
            assert similarity(second, first) == pytest.approx(expected)
