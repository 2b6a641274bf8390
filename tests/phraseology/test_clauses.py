"""Each clause of a call has its own words, slots and condition."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Sequence
from itertools import permutations

import pytest

from airhilt.phraseology import Instruction, Style, parse_call
from airhilt.phraseology.say import speak_instruction, speak_readback

I = Instruction  # noqa: E741
Speak = Callable[[str, Sequence[Instruction], Style], str]
KNOWN = ("AAL123", "AFR100", "N172SP", "OPS2", "TRUCK1")


def told(text: str) -> tuple[Instruction, ...]:
    return parse_call(f"American 123, {text}", KNOWN).instructions


def test_a_report_is_an_instruction_of_its_own_and_no_condition_of_another(
    subtests: pytest.Subtests,
) -> None:
    orders = [
        ("go around", I("go_around")),
        ("hold position", I("hold_position")),
        ("turn left heading 270", I("heading", turn="left", heading_deg=270.0)),
        ("cleared to land runway 24", I("cleared_to_land", "24")),
        ("cross runway 15 at mike", I("cross", "15", "M")),
        ("push back approved", I("push_back")),
        ("orbit left", I("orbit", turn="left")),
    ]
    events = ["on downwind", "ready", "established", "vacated", "clear of the runway", "final"]
    for words, order in orders:
        for event in events:
            for text in (
                f"{words}, report {event}",
                f"{words}, report when {event}",
                f"{words}, when {event}, report",
            ):
                with subtests.test(text):
                    assert told(text) == (order, I("report", position=event))


def test_a_condition_on_traffic_is_that_of_the_clearance_on_to_a_runway(
    subtests: pytest.Subtests,
) -> None:
    entering = [
        ("cross runway 04", I("cross", "04")),
        ("line up runway 01", I("line_up", "01")),
    ]
    others = [
        ("hold short of runway 15", I("hold_short", "15")),
        ("taxi via kilo", I("taxi", via=("K",))),
        ("contact tower 119.1", I("contact", position="tower", frequency_khz=119_100)),
    ]
    for words, order in entering:
        for more, other in others:
            for condition in ("after the cessna", "behind the landing airbus"):
                for text in (f"{words} {condition}, {more}", f"{words} {condition}, then {more}"):
                    with subtests.test(text):
                        first, second = told(text)
                        assert first == dataclasses.replace(order, condition=condition)
                        assert second.action == other.action
                        assert second.condition in (None, "then")


@pytest.mark.parametrize("place", ["at 3000", "passing 3000", "at lam", "leaving flight level 90"])
@pytest.mark.parametrize("words", ["turn left heading 270", "reduce speed 210", "descend 2000"])
def test_the_place_behind_an_order_is_its_condition(words: str, place: str) -> None:
    (order,) = told(f"{words} {place}")
    assert order.condition == place


def test_who_leaves_the_frequency_when_airborne_takes_off_first() -> None:
    contact, takeoff = told("contact departure 125.65 when airborne, runway 01 cleared for takeoff")
    assert (contact.condition, takeoff.condition) == ("when airborne", None)


@pytest.mark.parametrize(
    ("text", "place"),
    [("taxi to gate C28 via K", "gate C28"), ("taxi to stand b12", "stand B12"),
     ("taxi to stand bravo one two", "stand B12"), ("taxi to runway 01 at delta", "D")],
)  # fmt: skip
def test_where_to_taxi_has_its_letter(text: str, place: str) -> None:
    assert told(text)[0].position == place


def test_a_condition_belongs_to_the_clause_that_it_begins_or_ends(
    subtests: pytest.Subtests,
) -> None:
    hold = I("hold_position")
    ground = I("contact", position="ground", frequency_khz=121_700, condition="when clear")
    table = [
        ("hold position, when clear, contact ground 121.7", (hold, ground)),
        ("contact ground 121.7 when clear", (ground,)),
        (
            "go around, when passing 2000 turn left heading 090",
            (
                I("go_around"),
                I("heading", turn="left", heading_deg=90.0, condition="when passing 2000"),
            ),
        ),
        (
            "if unable to vacate at delta, vacate at echo",
            (I("vacate", position="E", condition="if unable to vacate at delta"),),
        ),
        ("direct dixie when able", (I("direct", position="dixie", condition="when able"),)),
        ("unable, hold position", (hold,)),
        ("cancel crossing clearance, hold position", (hold,)),
        ("cancel clearance, hold position", (hold,)),
        (
            "hold short of runway 15, cross after the landing traffic",
            (I("hold_short", "15"),),
        ),
    ]
    for text, meant in table:
        with subtests.test(text):
            assert told(text) == meant


def test_a_clearance_inside_an_event_is_none(subtests: pytest.Subtests) -> None:
    for text in (
        "report when cleared to land runway 24",
        "once you are cleared to land runway 24, contact ground 121.7",
        "hold short until cleared to cross runway 24",
        "when you have been cleared for takeoff runway 24, squawk 1234",
    ):
        with subtests.test(text):
            actions = {each.action for each in told(text)}
            assert actions.isdisjoint({"cleared_to_land", "cleared_for_takeoff", "cross"})


def test_the_slots_of_a_clause_are_those_of_its_own_words(subtests: pytest.Subtests) -> None:
    table = [
        ("circle to runway 33, cleared to land", (I("circle", "33"), I("cleared_to_land", "33"))),
        (
            "side step to runway 01 left, cleared to land",
            (I("side_step", "01L"), I("cleared_to_land", "01L")),
        ),
        (
            "continue approach, wind 240 degrees 8 knots, runway 24 cleared to land",
            (I("continue_approach"), I("cleared_to_land", "24")),
        ),
        (
            "taxi to runway 01 via Juliet, Alpha, hold short runway 04",
            (I("taxi", "01", via=("J", "A")), I("hold_short", "04")),
        ),
        (
            "exit right at Echo, contact ground point seven",
            (
                I("vacate", position="E", turn="right"),
                I("contact", position="ground", frequency_khz=121_700),
            ),
        ),
        ("hold short November Papa 1", (I("hold_short", hold_short="NP1"),)),
        (
            "taxi via N1, hold short NP1",
            (I("taxi", via=("N1",)), I("hold_short", hold_short="NP1")),
        ),
        ("squawk number 2446", (I("squawk", squawk="2446"),)),
        ("climb at 1200 fpm", (I("vertical_rate", sense="climb", rate_fpm=1200.0),)),
        ("climb immediately", (I("altitude", sense="climb", immediate=True),)),
        ("taxi to holding point N1, runway 01", (I("taxi", "01", "N1"),)),
        ("continue downwind, number two", (I("extend", position="downwind"),)),
        ("return for landing runway 01", (I("return_to_field", "01"),)),
    ]
    for text, meant in table:
        with subtests.test(text):
            assert told(text) == meant


def test_proceed_means_what_its_own_words_name(subtests: pytest.Subtests) -> None:
    table = [
        ("proceed to LAM", I("direct", position="lam")),
        ("proceed to deer park", I("direct", position="deer park")),
        ("proceed via Alpha, Bravo", I("taxi", via=("A", "B"))),
        ("proceed to stand 12", I("taxi", position="stand 12")),
        ("proceed to holding point A1", I("taxi", position="A1")),
        ("proceed to runway 24 via Alpha", I("taxi", "24", via=("A",))),
        ("proceed to the ramp", I("taxi", position="ramp")),
        ("proceed onto runway 24", I("proceed", "24")),
    ]
    for text, meant in table:
        with subtests.test(text):
            assert told(text) == (meant,)
            assert parse_call(f"Ops 2, {text}", KNOWN).instructions == (meant,)


def test_a_call_of_names_alone_is_a_hail(subtests: pytest.Subtests) -> None:
    for text, kind in (
        ("Tower, American 123", "hail"),
        ("National tower, American 123", "hail"),
        ("American 123, Washington tower", "hail"),
        ("American 123, good day", "unknown"),
        ("Tower, American 123, going around", "report"),
        ("American 123, contact tower", "instruction"),
    ):
        with subtests.test(text):
            assert parse_call(text, KNOWN).kind == kind


def test_a_callsign_that_is_asked_for_is_asked_again(subtests: pytest.Subtests) -> None:
    for text in ("American 123, say again your callsign", "American 123, say callsign"):
        with subtests.test(text):
            assert parse_call(text, KNOWN).asks_again


BESIDE = (
    I("cleared_to_land", "19"),
    I("line_up", "19"),
    I("hold_short", "15"),
    I("hold_position"),
    I("cross", "15", "M"),
    I("proceed", "15"),
    I("go_around"),
    I("cleared_approach", "19", approach="ils"),
    I("continue_approach"),
    I("vacate", position="E", turn="left"),
    I("taxi", position="stand 12", via=("A",)),
    I("push_back"),
    I("follow", position="cessna"),
    I("altitude", sense="climb", altitude_ft=3000.0),
    I("heading", turn="left", heading_deg=270.0),
    I("direct", position="dixie"),
    I("squawk", squawk="4213"),
    I("contact", position="ground", frequency_khz=121_700),
    I("stand_by"),
    I("report", position="on downwind"),
    I("circle", "33"),
    I("orbit", turn="left"),
    I("extend", position="downwind"),
    I("short_approach"),
    I("join", "19", "downwind", turn="left"),
    I("return_to_field"),
    I("say", position="altitude"),
)


@pytest.mark.parametrize("speak", [speak_instruction, speak_readback])
def test_a_clause_means_the_same_beside_any_other(speak: Speak) -> None:
    misread = {}
    for pair in permutations(BESIDE, 2):
        if (pair[0].action, pair[1].action) == ("continue_approach", "line_up"):
            continue  # Nobody is told both.
        if pair[0].action == "return_to_field" and pair[1].runway:
            continue  # The runway behind it is that of the return.
        text = speak("AAL123", pair, "faa")
        read = parse_call(text, KNOWN).instructions
        if sorted(read, key=str) != sorted(pair, key=str):
            misread[text] = read
    assert misread == {}


def test_a_condition_that_begins_with_if_holds_for_the_rest_of_the_call() -> None:
    turn, climb = "turn left heading 270", "climb and maintain 3000"
    for event in (
        "if you go around", "if you have to go around", "in case you go around",
        "in case of a go around", "in the event of a missed approach", "should you go around",
        "on the go around", "for the missed approach", "if you cancel takeoff",
    ):  # fmt: skip
        given = [(each.action, each.condition) for each in told(f"{event}, {turn}, {climb}")]
        assert given == [("heading", event), ("altitude", event)]


def test_what_is_only_talked_about_is_no_order(subtests: pytest.Subtests) -> None:
    for words in (
        "you may have to go around", "you might have to hold short", "you may have to descend",
        "thank you for the go around", "thanks for holding short", "stand by for a go around",
        "the go around was because of traffic", "report the go around",
    ):  # fmt: skip
        with subtests.test(words):
            assert told(words) == ()
    assert {each.action for each in told("say reason for go around")} == {"say"}
    assert told("I need you to go around") == told("you have to go around") == (I("go_around"),)


def test_continue_alone_goes_on_with_the_taxi(subtests: pytest.Subtests) -> None:
    for words in ("continue", "continue taxi", "continue taxiing", "proceed", "you may continue"):
        with subtests.test(words):
            assert told(words) == (I("taxi"),)
    assert told("continue approach") == (I("continue_approach"),)


def test_a_place_to_return_to_is_read(subtests: pytest.Subtests) -> None:
    for words, place in (
        ("taxi back to gate bravo one two", "gate B12"),
        ("return to the fire station", "fire station"),
        ("taxi into the run-up area", "run up area"),
        ("continue to the ramp", "ramp"),
    ):
        with subtests.test(words):
            assert told(words) == (I("taxi", position=place),)


def test_a_runway_or_a_level_that_is_to_be_left_is_read() -> None:
    assert told("leave runway 01 to the left") == (I("vacate", "01", turn="left"),)
    assert told("leave eight thousand for five thousand") == (
        I("altitude", sense="descend", altitude_ft=5000.0),
    )
    assert told("do one three sixty to the left") == (I("orbit", turn="left"),)


def test_an_order_that_cannot_be_made_out_is_noticed(subtests: pytest.Subtests) -> None:
    for words, unread in (
        ("make s-turns for spacing", True), ("slow down", True),
        ("runway 19 cleared for takeoff, make left turnout", True),
        ("wait for the Cessna", True), ("taxi around the Cessna", True),
        ("roger", False), ("good day", False), ("have a nice flight", False), ("go ahead", False),
        ("braking action good", False), ("information kilo is current", False),
        ("stay on this frequency", False), ("proceed direct LANDER", False),
    ):  # fmt: skip
        with subtests.test(words):
            assert parse_call(f"American 123, {words}", KNOWN).unread is unread
