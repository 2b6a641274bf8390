"""Values that are said: what makes sense as one, at both sides of each limit."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from airhilt.phraseology.call import Wind
from airhilt.phraseology.numbers import speak_digits, speak_thousands
from airhilt.phraseology.slots import (
    LEVEL,
    designator,
    feet_confidence,
    frequency_khz,
    hpa_of,
    level_confidence,
    level_ft,
    pressure_of,
    runway_confidence,
    speed_confidence,
    taxiway,
    wind_of,
)
from airhilt.phraseology.sounds import alike, likeness
from airhilt.phraseology.spoken_values import (
    speak_altitude,
    speak_frequency,
    speak_heading,
    speak_mach,
    speak_pressure,
    speak_runway,
    speak_wind,
)


def test_a_frequency_is_a_channel_of_the_aeronautical_band(subtests: pytest.Subtests) -> None:
    for mhz, fraction, khz in [
        ("118", "0", 118_000),  # The aeronautical band is from 117.975 to 137 MHz.
        ("117", "95", None),
        ("136", "975", 136_975),
        ("137", "0", None),
        ("121", "9", 121_900),
        ("121", "92", 121_925),  # A 5 was left out (FAA Order JO 7110.65, 2-4-17 i).
        ("121", "97", 121_975),
        ("121", "95", 121_950),
        ("121", "725", 121_725),
        ("132", "01", 132_010),
        ("132", "010", 132_010),
        ("132", "011", None),  # Channels are 5 kHz apart at least.
    ]:
        with subtests.test(str((mhz, fraction, khz))):
            assert frequency_khz(mhz, fraction) == khz


def test_a_setting_is_one_of_the_pressures_that_the_air_has(subtests: pytest.Subtests) -> None:
    """29.92 inches of mercury are 1013.21 hPa, each 33.8639."""
    table = [
        ("2992", 1013.21), ("2700", 914.3), ("2699", None), ("3150", 1066.7), ("3151", None),
        ("1013", 1013.0), ("0998", 998.0), ("900", 900.0), ("899", None), ("1060", 1060.0),
        ("1061", None),
    ]  # fmt: skip
    for digits, hpa in table:
        with subtests.test(digits):
            assert hpa_of(digits) == (None if hpa is None else pytest.approx(hpa, abs=0.05))


def test_a_setting_has_its_word_before_it(subtests: pytest.Subtests) -> None:
    for text, hpa in [
        ("altimeter 2992", 1013.21),
        ("altimeter is 29 decimal 92", 1013.21),
        ("qnh 1009", 1009.0),
        ("q n h now 987", 987.0),
        ("squawk 2992", None),
    ]:
        with subtests.test(text):
            assert pressure_of(text) == (None if hpa is None else pytest.approx(hpa, abs=0.05))


def test_a_level_is_sure_if_nothing_can_be_missing(subtests: pytest.Subtests) -> None:
    for text, feet, is_sure in [
        ("flight level 330", 33_000.0, True),
        ("flight level 80", 8_000.0, False),  # It may have been 180.
        ("flight level 81", None, False),
        ("level 600", 60_000.0, True),
        ("level 0", None, False),
        ("4 thousand", 4_000.0, True),
        ("4 thousand 500", 4_500.0, True),
        ("17 thousand", 17_000.0, True),
        ("19 thousand", 19_000.0, False),  # Above the transition altitude levels are said.
    ]:
        with subtests.test(text):
            found = LEVEL.search(text)
            assert (found and level_ft(found)) == feet
            if found and feet is not None:
                assert (level_confidence(found) == 1.0) is is_sure


def test_feet_come_in_hundreds_below_the_transition_altitude(subtests: pytest.Subtests) -> None:
    for feet, is_sure in [
        (3_500.0, True),
        (3_510.0, False),
        (17_900.0, True),
        (18_000.0, False),
        (100.0, True),
    ]:
        with subtests.test(str((feet, is_sure))):
            assert (feet_confidence(feet) == 1.0) is is_sure


def test_a_speed_is_a_multiple_of_the_step_and_has_three_digits(subtests: pytest.Subtests) -> None:
    for kt, is_sure in [
        (250.0, True),
        (100.0, True),
        (90.0, False),
        (183.0, False),
        (999.0, False),
    ]:
        with subtests.test(str((kt, is_sure))):
            assert (speed_confidence(kt) == 1.0) is is_sure


def test_a_runway_has_two_digits_and_the_letter_of_its_side(subtests: pytest.Subtests) -> None:
    for number, side, runway in [
        ("1", None, "01"),
        ("19", "left", "19L"),
        ("27", "right", "27R"),
        ("09", "centre", "09C"),
    ]:
        with subtests.test(number):
            assert designator(number, side) == runway
            assert (runway_confidence(number) == 1.0) is (len(number) == 2)


def test_a_taxiway_is_named_by_its_letter_and_number(subtests: pytest.Subtests) -> None:
    for words, name in [("alfa", "A"), ("bravo 5", "B5"), ("kilo", "K"), ("zulu 12", "Z12")]:
        with subtests.test(words):
            assert taxiway(words) == name


def test_a_wind_is_read_with_its_word_or_beside_a_clearance(subtests: pytest.Subtests) -> None:
    for text, wind in [
        ("wind calm", Wind(None, 0.0)),
        ("wind 360 at 8", Wind(360.0, 8.0)),
        ("wind 361 at 8", None),
        ("wind 280 degrees 12 knots gusting 20", Wind(280.0, 12.0, 20.0)),
        ("wind variable at 3", Wind(None, 3.0)),
        ("280 at 8 runway 27 cleared to land", Wind(280.0, 8.0)),
        ("280 at 8 runway 27 taxi", None),
    ]:
        with subtests.test(text):
            assert wind_of(text) == wind


# --- as they are spoken ---------------------------------------------------------------------


def test_altitudes_are_spoken_in_thousands_and_from_18_000_ft_as_levels(
    subtests: pytest.Subtests,
) -> None:
    """FAA Order JO 7110.65, 2-4-17 a and b; the transition altitude is that of 14 CFR 91.121."""
    for feet, words in [
        (17_900.0, "one seven thousand niner hundred"),
        (18_000.0, "flight level one eight zero"),
        (1_000.0, "one thousand"),
        (900.0, "niner hundred feet"),
    ]:
        with subtests.test(words):
            assert speak_altitude(feet, "faa") == words


def test_a_heading_has_three_digits_and_north_is_360(subtests: pytest.Subtests) -> None:
    """FAA Order JO 7110.65, 2-4-17 e."""
    table = [(0.0, "three six zero"), (360.0, "three six zero"), (5.4, "zero zero five"),
     (359.6, "three six zero"), (90.0, "zero niner zero")]  # fmt: skip
    for degrees, words in table:
        with subtests.test(str((degrees, words))):
            assert speak_heading(degrees, "faa") == words


def test_a_frequency_is_spoken_with_two_digits_or_three(subtests: pytest.Subtests) -> None:
    """FAA Order JO 7110.65, 2-4-17 i; ICAO Annex 10 volume II, 5.2.1.7.3.4.3."""
    for khz, faa, icao in [
        (121_900, "one two one point niner", "one two one decimal niner"),
        (121_000, "one two one point zero", "one two one decimal zero"),
        (118_025, "one one eight point zero two", "one one eight decimal zero two fife"),
        (132_010, "one three two point zero one zero", "one three two decimal zero one zero"),
        (126_550, "one two six point five five", "one two six decimal fife fife zero"),
    ]:
        with subtests.test(faa):
            assert speak_frequency(khz, "faa") == faa
            spoken = speak_frequency(khz, "icao")
            assert spoken == icao.replace("one three two", "one tree two")


@pytest.mark.parametrize(
    ("runway", "faa", "icao"),
    [("09L", "runway niner left", "runway zero niner left"), ("27", "runway two seven", None),
     ("36C", "runway three six center", "runway tree six center")],
)  # fmt: skip
def test_the_faa_leaves_out_the_zero_of_a_runway(runway: str, faa: str, icao: str | None) -> None:
    """FAA Order JO 7110.65, 2-4-17 k."""
    assert speak_runway(runway, "faa") == faa
    assert speak_runway(runway, "icao") == (icao or faa)


def test_a_wind_is_spoken_with_its_gusts_and_calm_without_numbers() -> None:
    assert speak_wind(Wind(280.0, 12.0, 20.0), "faa") == (
        "wind two eight zero at one two gusts two zero"
    )
    assert speak_wind(Wind(None, 0.0), "faa") == "wind calm"
    assert speak_wind(Wind(None, 3.0), "faa") == "wind variable at three"
    assert speak_wind(Wind(90.0, 6.0), "icao") == "wind zero niner zero degrees six knots"
    assert speak_wind(Wind(None, 3.0), "icao") == "wind variable tree knots"


def test_pressures_and_mach_numbers_are_spoken_by_their_digits() -> None:
    assert speak_pressure(1013.25, "faa") == "altimeter two niner niner two"
    assert speak_pressure(1013.25, "icao") == "Q N H one zero one tree"
    assert speak_mach(0.8, "faa") == "mach point eight zero"
    assert speak_mach(0.785, "icao") == f"mach decimal {speak_digits('78', 'icao')}"


def test_thousands_and_hundreds_have_their_words(subtests: pytest.Subtests) -> None:
    for feet, words in [
        (0, "zero"),
        (500, "five hundred"),
        (1_000, "one thousand"),
        (2_500, "two thousand five hundred"),
        (10_000, "one zero thousand"),
    ]:
        with subtests.test(words):
            assert speak_thousands(feet, "faa") == words


# --- sounds ---------------------------------------------------------------------------------

words = st.text("abcdefghiklmnoprstuvwyz", min_size=1, max_size=8)


@given(words, words)
def test_likeness_is_the_same_both_ways_and_full_with_itself(first: str, second: str) -> None:
    for like in (likeness, alike):
        assert like(first, first) == 1.0
        assert like(first, second) == pytest.approx(like(second, first))
        assert 0.0 <= like(first, second) <= 1.0
