"""What the instructions of a call order, and what they leave open."""

from __future__ import annotations

from typing import Any, get_args

import pytest

from airhilt.phraseology import Action, Instruction, parse_call
from airhilt.world.actors.orders import NOTHING_MOVES, orders_of


def order(*instructions: Instruction, runway: str | None = None, variation_deg: float = 0.0) -> Any:
    """Return the first order of some instructions."""
    return orders_of(instructions, runway, variation_deg, "AAL1")[0]


@pytest.mark.parametrize("action", get_args(Action))
def test_every_instruction_is_a_command_or_needs_none_or_is_refused_or_asked_about(
    action: Action,
) -> None:
    (made,) = orders_of([Instruction(action)], None, 0.0, "AAL1")
    outcomes = [made.command is not None, bool(made.unable), bool(made.question)]
    assert sum(outcomes) == (0 if action in {*NOTHING_MOVES, "report"} else 1)


def test_an_instruction_is_done_at_the_runway_and_with_the_numbers_that_it_names(
    subtests: pytest.Subtests,
) -> None:
    rows: list[Any] = [
        ({"action": "line_up", "runway": "19"}, {"action": "line_up", "runway": "19"}),
        ({"action": "line_up"}, {"action": "line_up", "runway": "01"}),
        ({"action": "circle", "runway": "33"}, {"action": "approach", "runway": "33"}),
        ({"action": "hold_short", "runway": "01"}, {"action": "hold_short", "runway": "01"}),
        ({"action": "cross", "runway": "01", "position": "D"}, {"runway": "01", "at": "D"}),
        ({"action": "altitude", "altitude_ft": 5000.0}, {"altitude_ft": 5000.0}),
        ({"action": "speed", "speed_kt": 180.0, "until": "until established"}, {"cas_kt": 180.0}),
        ({"action": "turn_by", "turn": "left", "turn_deg": 20.0}, {"degrees": -20.0}),
        (
            {"action": "taxi", "runway": "01", "via": ("J", "A")},
            {"runway": "01", "via": ("J", "A")},
        ),
    ]
    for instruction, command in rows:
        with subtests.test(str(instruction)):
            made = order(Instruction(**instruction), runway="01").command
            assert made.model_dump().items() >= command.items()


def test_a_level_with_a_takeoff_is_where_it_climbs_to() -> None:
    said = Instruction("cleared_for_takeoff", "01"), Instruction("altitude", altitude_ft=6000.0)
    takeoff, climb = orders_of(said, None, 0.0, "AAL1")
    assert takeoff.command is not None
    assert takeoff.command.model_dump()["climb_to_ft"] == 6000.0
    assert climb.command is None
    assert not climb.unable


def test_what_is_missing_is_asked_for() -> None:
    assert order(Instruction("cleared_to_land")).question == "say runway"
    assert order(Instruction("line_up", "01", condition="after passing LAM at 35")).question


def test_headings_that_are_said_are_magnetic() -> None:
    made = order(Instruction("heading", heading_deg=5.0), variation_deg=-10.7).command
    assert made.track_deg == pytest.approx(354.3)


def test_what_is_said_about_the_way_is_part_of_a_taxi_clearance() -> None:
    said = (
        Instruction("taxi", "19", via=("K",)),
        Instruction("cross", "15", position="J"),
        Instruction("hold_short", hold_short="N"),
    )
    taxi, cross, hold_short = orders_of(said, None, 0.0, "AAL1")
    assert taxi.command is not None
    assert taxi.command.model_dump() == {
        "action": "taxi_to", "runway": "19", "place": None, "via": ("K",),
        "cross": ("15",), "hold_short": ("N",),
    }  # fmt: skip
    for part in (cross, hold_short):
        assert part.command is None
        assert part.unable == part.question == ""


@pytest.mark.parametrize(
    ("condition", "whom", "traffic"),
    [
        ("behind the landing cessna", "landing cessna", "landing"),
        ("after the departing Delta 737 has passed", "departing Delta 737", "departing"),
        ("behind traffic on final", "traffic on final", "landing"),
        ("behind delta 456", "delta 456", "passing"),
    ],
)
def test_behind_other_traffic_is_done_once_that_has_passed(
    condition: str, whom: str, traffic: str
) -> None:
    made = order(Instruction("line_up", "01", condition=condition)).command.model_dump()
    assert (made["action"], made["whom"], made["traffic"]) == ("behind", whom, traffic)
    assert made["command"] == {"action": "line_up", "runway": "01"}


def test_when_ready_is_now_and_other_conditions_are_asked_about() -> None:
    assert order(Instruction("cross", "01", condition="when ready")).command.action == "cross"
    others: list[tuple[Action, str]] = [
        ("cross", "after departure"),
        ("line_up", "once the runway is clear"),
        ("heading", "behind the landing cessna"),
    ]
    for action, condition in others:
        asked = order(Instruction(action, "01", heading_deg=90.0, condition=condition))
        assert asked.question == f"say again, {condition}"


@pytest.mark.parametrize(
    ("condition", "expected"),
    [
        ("when airborne", {"type": "height_above", "height_ft": 400.0}),
        ("after departure", {"type": "height_above", "height_ft": 400.0}),
        ("after passing 3 thousand", {"type": "altitude_reached", "altitude_ft": 3000.0}),
        ("leaving flight level 120", {"type": "altitude_reached", "altitude_ft": 12_000.0}),
        ("at 4 thousand 500 feet", {"type": "altitude_reached", "altitude_ft": 4500.0}),
        ("after lam", {"type": "fix_passed", "fix": "lam"}),
        ("over lima alfa mike", {"type": "fix_passed", "fix": "LAM"}),
        ("over casanova", {"type": "fix_passed", "fix": "casanova"}),
        ("when clear of the runway", {"type": "off_runways", "has_been_on": False}),
        ("once you have vacated runway 01", {"type": "off_runways", "has_been_on": False}),
        ("after landing", {"type": "off_runways", "has_been_on": False}),
        ("when established on the localizer", {"type": "in_phase"}),
    ],
)
def test_a_condition_on_the_flight_is_waited_for(condition: str, expected: dict[str, Any]) -> None:
    told = Instruction("contact", position="ground", condition=condition)
    waits = order(told).when
    assert waits is not None
    assert waits.model_dump().items() >= ({"actor": "AAL1"} | expected).items()


@pytest.mark.parametrize(
    ("event", "expected"),
    [
        ("vacated", {"type": "off_runways"}),
        ("passing 2 thousand", {"type": "altitude_reached", "altitude_ft": 2000.0}),
        ("2 mile final", {"type": "on_leg", "leg": "final", "within_nm": 2.0}),
        ("left base", {"type": "on_leg", "leg": "base"}),
        ("established", {"type": "in_phase"}),
        ("over lam", {"type": "fix_passed", "fix": "lam"}),
    ],
)
def test_a_report_is_made_when_its_event_comes(event: str, expected: dict[str, Any]) -> None:
    told = order(Instruction("report", position=event))
    assert told.command.model_dump() == {"action": "report", "words": event}
    assert told.when.model_dump().items() >= expected.items()


def test_nobody_promises_a_report_of_what_it_never_sees() -> None:
    told = order(Instruction("report", position="the bridge in sight"))
    assert (told.command, told.unable, told.question) == (None, "", "")


def test_who_leaves_a_runway_contacts_another_unit_when_off_it() -> None:
    leave = Instruction("vacate", position="M")
    call = Instruction("contact", position="ground", frequency_khz=121_700)
    waits = [each.when for each in orders_of([leave, call], "01", 0.0, "AAL1")]
    assert [each and each.type for each in waits] == [None, "off_runways"]


def test_what_follows_then_waits_for_the_end_of_what_is_before_it() -> None:
    slow = Instruction("speed", speed_kt=210.0)
    down = Instruction("altitude", altitude_ft=6000.0, condition="then")
    call = Instruction("contact", position="tower", condition="then")
    waits = [each.when for each in orders_of([slow, down, call], None, 0.0, "AAL1")]
    assert [each and each.type for each in waits] == [None, "airspeed_reached", "altitude_reached"]


def test_who_crosses_a_runway_has_to_be_on_it_before_it_is_clear_of_it() -> None:
    call = Instruction("contact", position="ground", condition="when clear of the runway")
    _, told = orders_of([Instruction("cross", "01"), call], None, 0.0, "OPS1")
    assert told.when is not None
    assert told.when.model_dump()["has_been_on"]


def test_a_clearance_behind_an_approach_is_for_the_runway_of_the_approach() -> None:
    said = Instruction("circle", "33"), Instruction("cleared_to_land")
    circle, land = orders_of(said, "01", 0.0, "AAL1")
    assert circle.command is not None
    assert land.command is not None
    assert land.command.model_dump().items() >= {"action": "land", "runway": "33"}.items()


def test_a_heading_with_a_takeoff_is_flown_after_it() -> None:
    for condition in (None, "when airborne"):
        turn = Instruction("heading", heading_deg=40.0, condition=condition)
        heading, takeoff = orders_of(
            [turn, Instruction("cleared_for_takeoff", "01")], None, -10.0, "AAL1"
        )
        assert (heading.command, heading.unable, heading.question) == (None, "", "")
        assert takeoff.command is not None
        assert takeoff.command.model_dump()["track_deg"] == pytest.approx(30.0)


def test_speeds_rates_and_levels_at_fixes_are_orders_too(subtests: pytest.Subtests) -> None:
    rows: list[Any] = [
        ({"action": "mach", "mach": 0.78}, {"mach": 0.78}),
        ({"action": "vertical_rate", "rate_fpm": 2000.0}, {"vertical_rate_fpm": 2000.0}),
        ({"action": "resume_speed"}, {"action": "resume_speed"}),
        ({"action": "speed", "speed_kt": 170.0, "bound": "or_more"}, {"cas_kt": 170.0}),
        (
            {"action": "cross_fix", "position": "LAM", "altitude_ft": 12_000.0},
            {"fix": "LAM", "altitude_ft": 12_000.0},
        ),
        ({"action": "join", "position": "straight in", "runway": "01"}, {"leg": "final"}),
    ]
    for instruction, command in rows:
        with subtests.test(str(instruction)):
            made = order(Instruction(**instruction)).command
            assert made.model_dump().items() >= command.items()


SAID: list[tuple[str, list[dict[str, Any] | None]]] = [
    ("cleared to land, turn left at Foxtrot",
     [{"action": "land"}, {"action": "turn_at", "taxiway": "F", "side": "left"}]),
    ("fly present heading", [{"action": "turn", "degrees": 0.0}]),
    ("right at the high speed", [{"action": "vacate", "exit": None, "side": "right"}]),
    ("cleared to land, hold short of runway one five",
     [{"action": "land", "hold_short": "15"}, None]),
    ("cleared low approach at or above five hundred feet",
     [{"action": "land", "then": "low_approach", "not_below_ft": 500.0}, None]),
    ("proceed via Kilo and Juliett, hold short of runway one five",
     [{"action": "taxi_to", "via": ("K", "J"), "hold_short": ("15",)}, None]),
    ("follow the Boeing, hold short of runway four",
     [{"action": "follow", "hold_short": ("04",)}, None]),
    ("turn base now", [{"action": "join", "leg": "base", "side": None}]),
    ("cleared direct Lima Alpha Mike", [{"action": "direct", "to": "LAM"}]),
    ("cleared to land runway three three, make left base",
     [{"action": "land", "runway": "33"}, {"action": "join", "leg": "base", "runway": "33"}]),
    ("make left base, cleared to land runway three three",
     [{"action": "join", "leg": "base", "runway": "33"}, {"action": "land", "runway": "33"}]),
    ("cleared touch and go, make left traffic runway three three",
     [{"action": "land", "runway": "01"}, {"action": "join", "runway": "33"}]),
    ("continue approach", [None]),
    ("continue approach runway one", [None]),
    ("continue approach runway four", [{"action": "approach", "runway": "04"}]),
    ("cancel landing clearance, continue approach", [{"action": "cancel_landing"}, None]),
    ("cancel landing clearance", [{"action": "go_around"}]),
    ("cleared ILS runway one approach, maintain two thousand until established",
     [{"action": "approach", "level_ft": 2000.0}, {"action": "altitude", "altitude_ft": 2000.0}]),
    ("cross LAM at or above six thousand",
     [{"action": "cross_fix", "altitude_ft": 6000.0, "bound": "or_more"}]),
    ("take off immediately or vacate runway", [{"action": "take_off"}, {"action": "vacate"}]),
]  # fmt: skip
"""Words to an aircraft that is going to use runway 01, and the commands of their instructions."""


@pytest.mark.parametrize(("words", "commands"), SAID, ids=[words for words, _ in SAID])
def test_the_words_of_a_call_are_these_orders(
    words: str, commands: list[dict[str, Any] | None]
) -> None:
    call = parse_call(f"American one two three, {words}", ["AAL123"])
    made = [each.command for each in orders_of(call.instructions, "01", 0.0, "AAL1")]
    assert [each is None for each in made] == [each is None for each in commands]
    for each, command in zip(made, commands, strict=True):
        if each is not None and command is not None:
            assert each.model_dump().items() >= command.items()


def orders_in(words: str) -> list[Any]:
    """Return the orders of a call to an aircraft that is going to use runway 01."""
    call = parse_call(f"American one two three, {words}", ["AAL123"])
    return list(orders_of(call.instructions, "01", 0.0, "AAL123"))


@pytest.mark.parametrize(
    ("words", "actions"),
    [
        ("exit at Bravo, cancel takeoff clearance", ["cancel_takeoff", "vacate"]),
        ("cleared ILS runway one approach, maintain two thousand", ["altitude", "approach"]),
        ("cleared ILS runway one approach, fly heading three three zero", ["track", "approach"]),
        ("cross LAM at six thousand, descend and maintain four thousand",
         ["altitude", "cross_fix"]),
        ("reduce speed to one eight zero, cleared ILS runway one approach", ["approach", "speed"]),
        ("fly heading two seven zero, go around", ["go_around", "track"]),
        ("hold position, hold short of runway four", ["hold_short", "hold_position"]),
    ],
)  # fmt: skip
def test_in_either_order_of_words_nothing_undoes_what_is_said_beside_it(
    words: str, actions: list[str]
) -> None:
    turned = ", ".join(reversed(words.split(", ")))
    for said in (words, turned):
        does = [each for each in orders_in(said) if each.command is not None]
        assert [each.command.action for each in sorted(does, key=lambda o: o.rank)] == actions


@pytest.mark.parametrize(
    ("words", "waits"),
    [
        ("fly heading three three zero, cleared ILS runway one approach", "track_reached"),
        ("proceed direct LAM, cleared ILS runway one approach", "fix_passed"),
        ("cleared to land, then taxi to the ramp", "off_runways"),
        ("exit at Echo, taxi to the ramp", "off_runways"),
    ],
)
def test_what_follows_from_something_in_the_call_waits_for_it(words: str, waits: str) -> None:
    _, last = orders_in(words)
    assert last.when is not None
    assert last.when.type == waits


def test_a_stop_beside_a_clearance_can_be_done_alone_and_a_crossing_cannot() -> None:
    stop, follow = orders_in("hold short of Juliett, follow the Cessna")
    assert stop.part_of is follow.instruction
    assert stop.alone.action == "hold_short"
    taxi, cross = orders_in("taxi to runway one via Kilo, cross runway four")
    assert cross.part_of is taxi.instruction
    assert cross.alone is None


@pytest.mark.parametrize(
    ("words", "reason"),
    [
        ("not below one thousand until the shoreline, cleared to land",
         "unable to keep a level until the shoreline"),
        ("reduce to minimum approach speed", "unable minimum approach speed, say speed in knots"),
        ("cleared ILS runway one approach, hold at LAM", "unable approach, told to hold"),
    ],
)  # fmt: skip
def test_what_cannot_be_kept_beside_the_rest_is_refused_with_its_reason(
    words: str, reason: str
) -> None:
    assert [each.unable for each in orders_in(words) if each.unable] == [reason]
