"""Calls are spoken in the phraseology of the FAA and of ICAO, and read as what was meant."""

from __future__ import annotations

from dataclasses import replace
from typing import Any, get_args

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from airhilt.phraseology import TELEPHONY, Action, Instruction, Wind, parse_call, tokens
from airhilt.phraseology.numbers import Style
from airhilt.phraseology.say import (
    speak_abbreviated,
    speak_altitude,
    speak_callsign,
    speak_frequency,
    speak_heading,
    speak_instruction,
    speak_pressure,
    speak_readback,
    speak_runway,
    speak_say_again,
    speak_speed,
    speak_taxiway,
    speak_wind,
)

STYLES = ("faa", "icao")
ON_FREQUENCY = ("AAL123", "BAW38", "DLH4AB", "UAL1200", "N172SP", "G-ABCD", "OPS2", "FIRE3")


def test_flights_are_called_in_group_form_by_the_faa_and_digit_by_digit_by_icao(
    subtests: pytest.Subtests,
) -> None:
    for callsign, faa, icao in [
        ("AAL123", "American one twenty three", "American one two tree"),
        ("BAW38", "Speedbird thirty eight", "Speedbird tree eight"),
        ("UAL1200", "United twelve hundred", "United one two zero zero"),
        ("UAL100", "United one hundred", "United one zero zero"),
        ("FDX1602", "Fedex sixteen zero two", "Fedex one six zero two"),
        ("DLH4AB", "Lufthansa four alfa bravo", "Lufthansa fower alfa bravo"),
        ("SWA5", "Southwest five", "Southwest fife"),
        ("N172SP", *("November one seven two sierra papa",) * 2),
        ("G-ABCD", *("Golf alfa bravo charlie delta",) * 2),
        ("OPS2", "Ops two", "Ops two"),
        ("PLOW9", "Snow plow niner", "Snow plow niner"),
    ]:
        with subtests.test(callsign):
            assert speak_callsign(callsign, "faa") == faa
            assert speak_callsign(callsign, "icao") == icao


def test_only_registrations_are_abbreviated() -> None:
    assert speak_abbreviated("N172SP", "faa") == "November two sierra papa"
    assert speak_abbreviated("N172SP", "icao") == "November sierra papa"
    assert speak_abbreviated("G-ABCD", "icao") == "Golf charlie delta"
    assert speak_abbreviated("AAL123", "icao") == speak_callsign("AAL123", "icao")


def test_values_are_spoken_as_the_manuals_have_it(subtests: pytest.Subtests) -> None:
    table = [
        (speak_runway, "01", "runway one", "runway zero one"),
        (speak_runway, "19L", "runway one niner left", "runway one niner left"),
        (speak_runway, "35C", "runway three five center", "runway tree fife center"),
        (speak_taxiway, "B5", "bravo five", "bravo fife"),
        (speak_altitude, 900.0, "niner hundred feet", "niner hundred feet"),
        (speak_altitude, 4500.0, "four thousand five hundred", "fower thousand fife hundred"),
        (speak_altitude, 12_000.0, "one two thousand", "one two thousand"),
        (speak_altitude, 33_000.0, "flight level three three zero",
         "flight level tree tree zero"),
        (speak_heading, 5.0, "zero zero five", "zero zero fife"),
        (speak_heading, 360.0, "three six zero", "tree six zero"),
        (speak_heading, 0.0, "three six zero", "tree six zero"),
        (speak_speed, 180.0, "one eight zero knots", "one eight zero knots"),
        (speak_frequency, 118_000, "one one eight point zero", "one one eight decimal zero"),
        (speak_frequency, 121_900, "one two one point niner", "one two one decimal niner"),
        (speak_frequency, 134_325, "one three four point three two",
         "one tree fower decimal tree two fife"),
        (speak_frequency, 132_515, "one three two point five one five",
         "one tree two decimal fife one fife"),
        (speak_wind, Wind(350.0, 8.0), "wind three five zero at eight",
         "wind tree fife zero degrees eight knots"),
        (speak_wind, Wind(20.0, 15.0, 25.0), "wind zero two zero at one five gusts two five",
         "wind zero two zero degrees one fife knots gusting two fife"),
        (speak_wind, Wind(None, 0.0), "wind calm", "wind calm"),
        (speak_wind, Wind(None, 3.0), "wind variable at three", "wind variable tree knots"),
        (speak_pressure, 1013.25, "altimeter two niner niner two", "Q N H one zero one tree"),
    ]  # fmt: skip
    for speak, value, faa, icao in table:
        with subtests.test(str((speak, value, faa, icao))):
            assert speak(value, "faa") == faa
            assert speak(value, "icao") == icao


def test_calls_begin_with_the_callsign_and_readbacks_end_with_it() -> None:
    told = [Instruction("cross", "15"), Instruction("hold_short", "01")]
    assert speak_instruction("OPS2", told, "icao") == (
        "Ops two, cross runway one fife, hold short of runway zero one."
    )
    assert speak_readback("OPS2", told, "icao") == (
        "Cross runway one fife, hold short of runway zero one, Ops two."
    )
    assert speak_readback("OPS2", [], "faa") == "Roger, Ops two."
    assert speak_say_again("AAL123") == "Say again, American one twenty three."


# --- there and back --------------------------------------------------------------------------

runways = st.builds("{:02d}{}".format, st.integers(1, 36), st.sampled_from(["", "L", "R", "C"]))
taxiways = st.builds("{}{}".format, st.sampled_from("ABCDEFGHJKLMNPQRSTUVWXYZ"),
                     st.sampled_from(["", "1", "5", "12"]))  # fmt: skip
maybe_runway = st.none() | runways
maybe_taxiway = st.none() | taxiways
headings = st.integers(1, 360).map(float)
turns = st.sampled_from(["left", "right"])
levels = st.integers(5, 179).map(lambda n: n * 100.0) | st.integers(180, 600).map(
    lambda n: n * 100.0
)
channels = st.integers(4720, 5479).map(lambda n: n * 25) | st.sampled_from(
    [118_005, 118_010, 132_515]
)
bounds = st.sampled_from([None, "or_more", "or_less"])
fixes = st.sampled_from(["dixie", "deer park", "2 rivers", "cross city", "9 mile", "line creek"])
stations = st.sampled_from(["tower", "ground", "washington centre", "potomac approach"])


def made(action: Action, **slots: st.SearchStrategy[object]) -> st.SearchStrategy[Instruction]:
    return st.builds(Instruction, st.just(action), **slots)


SPEAKABLE: dict[Action, st.SearchStrategy[Instruction]] = {
    "cleared_to_land": made("cleared_to_land", runway=maybe_runway),
    "cleared_for_takeoff": made("cleared_for_takeoff", runway=maybe_runway,
                                position=maybe_taxiway, immediate=st.booleans()),
    "line_up": made("line_up", runway=runways, position=maybe_taxiway,
                    condition=st.none() | st.just("behind the landing cessna")),
    "touch_and_go": made("touch_and_go", runway=maybe_runway),
    "low_approach": made("low_approach", runway=maybe_runway),
    "cleared_option": made("cleared_option", runway=maybe_runway),
    "hold_short": made("hold_short", runway=runways, position=maybe_taxiway)
    | made("hold_short", hold_short=taxiways),
    "cross": made("cross", runway=runways, position=maybe_taxiway, immediate=st.booleans()),
    "proceed": made("proceed", runway=runways, position=maybe_taxiway, immediate=st.booleans()),
    "backtrack": made("backtrack", runway=runways, position=maybe_taxiway),
    "go_around": made("go_around", runway=maybe_runway),
    "continue_approach": made("continue_approach", runway=maybe_runway),
    "cleared_approach": made("cleared_approach", runway=runways, approach=st.sampled_from(
        ["ils", "visual", "rnav", "rnp", "vor", "localizer", "gps", "ndb"]),
        variant=st.none() | st.sampled_from("XYZ")),
    "vacate": made("vacate", runway=maybe_runway, position=maybe_taxiway,
                   turn=st.none() | turns, immediate=st.booleans()),
    "taxi": made("taxi", runway=runways, via=st.lists(taxiways, max_size=3).map(tuple))
    | made("taxi", position=st.sampled_from(["gate 12", "apron", "B", "A5"]),
           via=st.lists(taxiways, max_size=2).map(tuple)),
    "follow": made("follow", position=st.sampled_from(["airbus on final", "company 737"])),
    "give_way": made("give_way", position=st.sampled_from(["airbus", "snow plow"])),
    "altitude": made("altitude", sense=st.sampled_from(["climb", "descend", "maintain"]),
                     altitude_ft=levels, bound=bounds, immediate=st.booleans()),
    "heading": made("heading", heading_deg=headings, turn=st.none() | turns,
                    immediate=st.booleans())
    | made("heading", position=st.sampled_from(["present heading", "runway heading"]))
    | made("heading", turn=turns, position=maybe_taxiway),
    "speed": made("speed", speed_kt=st.integers(60, 400).map(float), bound=bounds,
                  until=st.none() | st.just("until 4 mile final"))
    | made("speed", named=st.sampled_from(["minimum clean", "final approach"])),
    "mach": made("mach", mach=st.integers(70, 89).map(lambda n: n / 100.0), bound=bounds),
    "resume_speed": made("resume_speed", named=st.sampled_from(["normal", "published"])),
    "turn_by": made("turn_by", turn=turns, turn_deg=st.integers(1, 9).map(lambda n: n * 10.0)),
    "direct": made("direct", position=fixes, turn=st.none() | turns),
    "hold_at": made("hold_at", position=fixes, turn=st.none() | turns),
    "cross_fix": made("cross_fix", position=fixes, altitude_ft=levels, bound=bounds,
                      speed_kt=st.none() | st.just(250.0))
    | made("cross_fix", position=fixes, speed_kt=st.just(210.0)),
    "climb_via": made("climb_via", position=st.sampled_from(["glen rose 3", "gopher 1"])),
    "descend_via": made("descend_via", position=st.sampled_from(["deer park 4", "hasty 2"])),
    "vertical_rate": made("vertical_rate", rate_fpm=st.integers(5, 40).map(lambda n: n * 100.0),
                          bound=bounds),
    "circle": made("circle", runway=runways),
    "stop_and_go": made("stop_and_go", runway=maybe_runway),
    "squawk": made("squawk", squawk=st.from_regex(r"\A[0-7]{4}\Z")),
    "contact": made("contact", position=stations, frequency_khz=channels),
    "monitor": made("monitor", position=stations, frequency_khz=channels),
    "report": made("report", position=st.sampled_from(["ready", "final", "field in sight"])),
    "orbit": made("orbit", turn=st.none() | turns),
    "extend": made("extend", position=st.sampled_from(["downwind", "upwind", "base"])),
    "join": made("join", runway=maybe_runway, turn=st.none() | turns, position=st.sampled_from(
        ["downwind", "base", "final", "crosswind", "straight in"])),
    "side_step": made("side_step", runway=runways),
    "say": made("say", position=st.sampled_from(["altitude", "heading", "intentions"])),
    "wildlife": made("wildlife", runway=runways, position=maybe_taxiway),
    "wildlife_gone": made("wildlife_gone", runway=runways, position=maybe_taxiway),
}  # fmt: skip
SPEAKABLE |= {each: made(each) for each in get_args(Action) if each not in SPEAKABLE}


@settings(deadline=None, max_examples=8)
@given(data=st.data(), style=st.sampled_from(STYLES), callsign=st.sampled_from(ON_FREQUENCY))
@pytest.mark.parametrize("action", get_args(Action))
def test_what_is_spoken_is_read_as_what_was_meant(
    action: Action, data: st.DataObject, style: Style, callsign: str
) -> None:
    meant = data.draw(SPEAKABLE[action])
    call = parse_call(speak_instruction(callsign, meant, style), ON_FREQUENCY)
    assert (call.callsign, call.instructions) == (callsign, (meant,))
    assert call.kind in ("instruction", "report")
    readback = parse_call(speak_readback(callsign, meant, style), ON_FREQUENCY)
    assert (readback.callsign, readback.instructions) == (callsign, (meant,))
    assert readback.kind in ("readback", "report")


@settings(deadline=None, max_examples=100)
@given(
    st.sampled_from(STYLES),
    st.lists(st.sampled_from([
        Instruction("cleared_for_takeoff", "19"),
        Instruction("cross", "15", "M"),
        Instruction("hold_short", "01"),
        Instruction("altitude", sense="climb", altitude_ft=6000.0),
        Instruction("heading", turn="right", heading_deg=90.0),
        Instruction("speed", speed_kt=210.0),
        Instruction("contact", position="tower", frequency_khz=119_100),
        Instruction("squawk", squawk="4512"),
        Instruction("go_around"),
        Instruction("vacate", position="E"),
    ]), unique_by=lambda each: each.action, max_size=4),
)  # fmt: skip
def test_several_instructions_of_one_call_are_all_read(style: Style, meant: list[Any]) -> None:
    is_takeoff = any(each.action == "cleared_for_takeoff" for each in meant)
    read = tuple(
        replace(each, condition="when airborne")
        if is_takeoff and each.action == "heading"
        else each
        for each in meant
    )
    call = parse_call(speak_instruction("AAL123", meant, style), ON_FREQUENCY)
    assert call.instructions == read
    readback = parse_call(speak_readback("AAL123", meant, style), ON_FREQUENCY)
    assert readback.instructions == read


@settings(deadline=None)
@given(
    st.sampled_from(STYLES),
    st.integers(1, 72).map(lambda n: n * 5.0),
    st.integers(3, 40),
    st.none() | st.integers(41, 60),
)
def test_a_wind_is_read_as_it_is_spoken(
    style: Style, direction: float, speed: int, gust: int | None
) -> None:
    wind = Wind(direction, float(speed), gust and float(gust))
    text = f"American one two three, {speak_wind(wind, style)}, runway one niner, cleared to land."
    call = parse_call(text, ON_FREQUENCY)
    assert call.wind == wind
    assert call.instructions == (Instruction("cleared_to_land", "19"),)


@settings(deadline=None)
@given(st.sampled_from(STYLES), st.integers(950, 1050))
def test_a_pressure_is_read_as_it_is_spoken(style: Style, hpa: int) -> None:
    call = parse_call(f"American one two three, {speak_pressure(hpa, style)}", ON_FREQUENCY)
    assert call.pressure_hpa == pytest.approx(hpa, abs=0.2)


@settings(deadline=None, max_examples=80)
@given(
    st.sampled_from(STYLES),
    st.builds("{}{}".format, st.sampled_from(sorted(TELEPHONY)), st.integers(1, 9999))
    | st.from_regex(r"\AN[1-9][0-9]{1,2}[A-HJ-NP-Z]{2}\Z")
    | st.from_regex(r"\A(?:G|F|I)-[A-Z]{4}\Z")
    | st.builds("{}{}".format, st.sampled_from(["OPS", "TUG", "FIRE", "PLOW"]), st.integers(1, 30)),
)
def test_any_callsign_is_read_as_it_is_spoken(style: Style, callsign: str) -> None:
    for spoken in (speak_callsign(callsign, style), speak_abbreviated(callsign, style)):
        call = parse_call(f"{spoken}, climb and maintain flight level three three zero", [callsign])
        assert (call.callsign, call.addressed_first) == (callsign, True)
        assert call.altitude_ft == 33_000
        call = parse_call(f"Hold position, {spoken}", [callsign])
        assert (call.callsign, call.addressed_first) == (callsign, False)


def test_styles_differ_in_the_words_and_not_in_what_is_read() -> None:
    told = Instruction("contact", position="tower", frequency_khz=134_325)
    said = [tokens(speak_instruction("AAL123", told, style)) for style in get_args(Style)]
    assert said[0] != said[1]
