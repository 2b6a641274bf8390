"""Words of a call: spellings, numbers and fillers, and the confidence of what they become."""

from __future__ import annotations

import time

import pytest

from airhilt.phraseology import parse_call, tokens
from airhilt.phraseology.run_together import split_numbers
from airhilt.phraseology.words import Words, words_of
from listed_forms import KNOWN, forms


def test_numbers_that_follow_each_other_are_one(subtests: pytest.Subtests) -> None:
    for text, words in [
        ("twenty five hundred", "2500"),
        ("one two hundred", "1200"),
        ("one hundred twenty five", "125"),
        ("one hundred twenty", "120"),
        ("one hundred fifteen", "115"),
        ("one hundred five", "100 5"),
        ("two hundred", "200"),
        ("two hundred knots", "200 knots"),
        ("hundred", "hundred"),
        ("double seven", "77"),
        ("triple four", "444"),
        ("double bravo", "double bravo"),
        ("triple", "triple"),
        ("twenty twenty five", "2025"),
        ("twenty zero", "200"),
        ("twenty", "20"),
        ("fifteen", "15"),
        ("one fifteen six", "1156"),
        ("123 456", "123 456"),
        ("12 34", "1234"),
        ("12 345", "12 345"),
        ("123 4", "123 4"),
        ("1 2 3", "123"),
        ("one 2 three", "123"),
        ("5,000 feet", "5000 feet"),
        ("118.35", "118 decimal 35"),
        ("0.78", "0 decimal 78"),
        ("three; four. five, six", "3 4 5 6"),
    ]:
        with subtests.test(text):
            assert tokens(text) == words.split()


def test_to_and_for_are_digits_where_a_number_goes_on(subtests: pytest.Subtests) -> None:
    """Not before a unit, where a speed ends at a distance, or between a point and its runway."""
    for text, words in [
        ("speed one eighty to four miles", "speed 180 to 4 miles"),
        ("one seventy to five", "170 to 5"),
        ("one seventy too five", "170 too 5"),
        ("one seventy to five zero", "170250"),
        ("one thirty to five", "13025"),
        ("heading three to zero", "heading 320"),
        ("heading to one zero", "heading 210"),
        ("heading to one", "heading 21"),
        ("heading to one zero zero", "heading to 100"),
        ("heading to", "heading to"),
        ("runway to five", "runway 25"),
        ("runway to seven left", "runway 27 left"),
        ("runway to two seven", "runway to 27"),
        ("level for one zero", "level 410"),
        ("decimal for", "decimal for"),
        ("climb to thousand", "climb to thousand"),
        ("climb for thousand", "climb 4 thousand"),
        ("one to thousand", "12 thousand"),
        ("oh five", "05"),
        ("one oh", "10"),
        ("oh my", "oh my"),
        ("won five", "15"),
        ("ate", "ate"),
        ("squawk ate five", "squawk 85"),
        ("runway oh nine", "runway 09"),
        ("two to miles", "2 to miles"),
        ("two for d m e", "2 for d m e"),
        ("two to one d m e", "2 to 1 d m e"),
        ("two to one dme", "2 to 1 dme"),
        ("two for five miles", "2 for 5 miles"),
        ("two for five", "245"),
        ("mike three for zero eight right", "mike 3 for 08 right"),
        ("mike three to zero eight right", "mike 3 to 08 right"),
        ("mike three to zero eight", "mike 3208"),
        ("november three for zero eight golf", "november 3408 golf"),
        ("delta three for five", "delta 345"),
    ]:
        with subtests.test(text):
            assert tokens(text) == words.split()


def test_hesitations_are_left_out_with_their_and_but_not_between_two_numbers(
    subtests: pytest.Subtests,
) -> None:
    for text, words in [
        ("climb uh three", "climb 3"),
        ("climb and uh maintain", "climb maintain"),
        ("climb and maintain", "climb and maintain"),
        ("heading two seven zero and uh one two", "heading 270 and 12"),
        ("heading two seven and uh zero one", "heading 2701"),
        ("heading two seventy and uh fifteen", "heading 270 and 15"),
        ("sixteen and uh twelve", "1612"),
        ("one sixty to four and uh eighteen three", "160 to 4 and 183"),
        ("please taxi", "taxi"),
        ("and", "and"),
    ]:
        with subtests.test(text):
            assert tokens(text) == words.split()


def test_words_have_one_spelling(subtests: pytest.Subtests) -> None:
    table = [
        ("take off", "takeoff"), ("run way", "runway"), ("x ray", "xray"), ("o clock", "o clock"),
        ("go round", "go around"), ("push back", "pushback"), ("re cleared", "recleared"),
        ("run to", "run to"), ("take", "take"), ("whole short", "hold short"),
        ("old position", "hold position"), ("cleared too land", "cleared to land"),
        ("clear two land", "clear to land"), ("fly level", "flight level"), ("lie nup", "line up"),
        ("won't", "will not"), ("hasn't", "has not"), ("do n't", "do not"), ("o'clock", "oclock"),
        ("you'll", "you"),
        ("you’re", "you"), ("fox", "fox"), ("fox trot", "foxtrot"), ("fox alpha", "foxtrot alfa"),
        ("via fox", "via foxtrot"), ("taxiway fox hold", "taxiway foxtrot hold"),
        ("the fox ran", "the fox ran"), ("kilo fox", "kilo foxtrot"),
        ("FL180", "flight level 180"), ("rwy 19", "runway 19"), ("canceled", "cancelled"),
        ("squack", "squawk"), ("wright", "right"), ("mayday's", "mayday"),
    ]  # fmt: skip
    for text, words in table:
        with subtests.test(text):
            assert tokens(text) == words.replace("o clock", "oclock").split()


def test_a_word_is_as_sure_as_the_least_sure_of_those_that_it_is_made_of(
    subtests: pytest.Subtests,
) -> None:
    for text, heard, expected in [
        ("level three five zero", (0.9, 0.8, 0.6, 0.7), (0.9, 0.6)),
        ("twenty five", (0.9, 0.5), (0.5,)),
        ("twenty five", (0.5, 0.9), (0.5,)),
        ("twenty zero", (0.9, 0.5), (0.5,)),
        ("double seven", (0.9, 0.5), (0.5,)),
        ("triple seven", (0.5, 0.9), (0.5,)),
        ("two hundred", (0.9, 0.5), (0.5,)),
        ("two hundred fifteen", (0.9, 0.8, 0.5), (0.5,)),
        ("two hundred twenty five", (0.9, 0.8, 0.5, 0.7), (0.5,)),
        ("take off now", (0.9, 0.5, 0.8), (0.5, 0.8)),  # Only spelled apart.
        ("whole short now", (0.8, 0.9, 1.0), (0.72, 0.72, 1.0)),  # Misheard: 0.9 of it.
        ("whole short now", (0.9, 0.8, 1.0), (0.72, 0.72, 1.0)),
        ("FL180 now", (0.7, 0.9), (0.7, 0.7, 0.7, 0.9)),
        ("write now", (0.8, 1.0), (0.72, 1.0)),
        ("didn't cross", (0.8, 1.0), (0.8, 0.8, 1.0)),
        ("won't cross", (0.8, 1.0), (0.8, 0.8, 1.0)),
        ("uh cross", (0.1, 0.9), (0.9,)),
        ("heading to one zero", (1.0, 0.8, 1.0, 1.0), (1.0, 0.72)),  # "To" sounds like 2.
        ("118.35 now", (0.6, 1.0), (0.6, 0.6, 0.6, 1.0)),
        ("via fox", (1.0, 0.8), (1.0, 0.8)),
    ]:
        with subtests.test(str((text, heard, expected))):
            assert words_of(text, heard).confidences == pytest.approx(list(expected))


def test_where_all_words_were_heard_alike_no_instruction_is_surer_than_they_or_much_less() -> None:
    """Over all forms: by the factor of what it lacks at most."""
    for text, _, _ in forms():
        heard = parse_call(text, KNOWN, [0.5] * len(text.split())).instructions
        for told, dim in zip(parse_call(text, KNOWN).instructions, heard, strict=True):
            assert dim == told
            assert 0.5 * told.confidence - 1e-9 <= dim.confidence <= min(0.5, told.confidence)
            assert dim.action_heard == pytest.approx(0.5 * told.action_heard)
            assert dim.details_heard in (pytest.approx(0.5 * told.details_heard), 1.0)


def test_each_instruction_counts_the_words_of_its_action_and_of_its_details(
    subtests: pytest.Subtests,
) -> None:
    for unsure, actions, details in [
        ("american", (1.0, 1.0), (1.0, 1.0)),
        ("climb", (0.4, 1.0), (1.0, 1.0)),
        ("level", (1.0, 1.0), (0.4, 1.0)),
        ("five", (1.0, 1.0), (0.4, 1.0)),
        ("left", (1.0, 0.4), (1.0, 1.0)),
        ("thanks", (1.0, 1.0), (1.0, 1.0)),
    ]:
        with subtests.test(unsure):
            text = "american one two three climb flight level three five zero thanks"
            text += " turn left heading one zero zero"
            heard = [0.4 if word == unsure else 1.0 for word in text.split()]
            told = parse_call(text, ("AAL123",), heard).instructions
            assert tuple(each.action_heard for each in told) == actions
            assert tuple(each.details_heard for each in told) == details


# --- numbers that run into each other -----------------------------------------------------------


def test_a_number_with_more_digits_than_its_word_allows_is_two(subtests: pytest.Subtests) -> None:
    for text, split in [
        ("level 34010", "level 340 10"),
        ("level 3401", "level 3401"),  # A single digit may be a slip.
        ("level 340", "level 340"),
        ("heading 27012", "heading 270 12"),
        ("squawk 421312", "squawk 4213 12"),
        ("squawk 42131", "squawk 42131"),
        ("altimeter 299212", "altimeter 2992 12"),
        ("altimeter 998120", "altimeter 9981 20"),
        ("qnh 101320", "qnh 1013 20"),
        ("qnh 99820", "qnh 998 20"),  # Below 1000 hPa it has three digits.
        ("qnh 9982", "qnh 9982"),
        ("q n h 99820", "q n h 998 20"),
        ("left 2704 thousand", "left 270 4 thousand"),
        ("right 27010 thousand", "right 270 10 thousand"),
        ("to 2704 thousand", "to 270 4 thousand"),
        ("left 270123 thousand", "left 270123 thousand"),
        ("left 270 thousand", "left 270 thousand"),
        ("climb 2704 thousand", "climb 2704 thousand"),
        ("check 299224 right cleared", "check 2992 24 right cleared"),
        ("check 299224 left line", "check 2992 24 left line"),
        ("check 299224 centre cleared", "check 2992 24 centre cleared"),
        ("check 299224 right taxi", "check 299224 right taxi"),
        ("runway 0124 right cleared", "runway 0124 right cleared"),
        ("heading 27024 right cleared", "heading 270 24 right cleared"),
        ("heading 2704 right cleared", "heading 270 4 right cleared"),
        ("24 right cleared", "24 right cleared"),
        ("270 cleared", "270 cleared"),
    ]:
        with subtests.test(text):
            words = split_numbers(Words(text.split(), [1.0] * len(text.split())))
            assert words.texts == split.split()


def test_nobody_knows_where_the_first_of_two_numbers_ends() -> None:
    words = split_numbers(Words(["level", "34010", "minutes"], [1.0, 0.8, 0.9]))
    assert words.confidences == pytest.approx([1.0, 0.6, 0.8, 0.9])
    runway = split_numbers(Words(["check", "299224", "right", "cleared"], [1.0, 0.8, 1.0, 1.0]))
    assert runway.confidences == pytest.approx([1.0, 0.6, 0.6, 1.0, 1.0])


@pytest.mark.parametrize("piece", ["1", "1.", "1,", "1,000", "a'", "one "])
def test_the_time_to_read_a_text_grows_no_faster_than_its_length(piece: str) -> None:
    """Sixteen times the length takes a little more than as much time, and not its square."""

    def least_s(times: int) -> float:
        text, taken_s = piece * times, []
        for _ in range(3):
            begun_s = time.process_time()
            tokens(text)
            taken_s.append(time.process_time() - begun_s)
        return min(taken_s)

    assert least_s(16_000) < 100.0 * least_s(1_000)
