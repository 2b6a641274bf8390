"""Actions of people comply with an advisory in its sense, not by their name alone."""

from __future__ import annotations

from typing import Any

import pytest
from pydantic import TypeAdapter

from airhilt.commands import Command
from airhilt.messages import Recommendation
from airhilt.metrics.compliance import complies

RECOMMENDATION = TypeAdapter[Recommendation](Recommendation)
COMMAND = TypeAdapter[Command](Command)
DESCEND = {"action": "altitude", "sense": "descend", "altitude_ft": 34_400, "vertical_rate_fpm": 1}
CLIMB = {**DESCEND, "sense": "climb"}
MAINTAIN = {"action": "maintain", "altitude_ft": 34_400}


def with_command(advised: dict[str, Any], **command: Any) -> bool:
    """Return whether a command on a track of 350 degrees does what is advised."""
    return complies(
        RECOMMENDATION.validate_python(advised), COMMAND.validate_python(command), 350.0
    )


@pytest.mark.parametrize(
    ("advised", "altitude_ft", "is_complied"),
    [
        (DESCEND, 34_400, True),
        (DESCEND, 33_000, True),
        (DESCEND, 35_000, False),
        (DESCEND, 60_000, False),
        (CLIMB, 34_400, True),
        (CLIMB, 36_000, True),
        (CLIMB, 34_000, False),
        (MAINTAIN, 34_400, True),
        (MAINTAIN, 35_000, False),
        (MAINTAIN, 34_000, False),
    ],
)
def test_a_level_complies_from_the_recommended_one_on_in_the_recommended_sense(
    advised: dict[str, Any], altitude_ft: float, is_complied: bool
) -> None:
    assert with_command(advised, action="altitude", altitude_ft=altitude_ft) is is_complied


def test_the_hundred_that_a_selector_has_next_to_an_odd_level_is_that_level() -> None:
    odd = {**DESCEND, "altitude_ft": 34_360}
    assert with_command(odd, action="altitude", altitude_ft=34_400)


@pytest.mark.parametrize(
    ("command", "side"),
    [
        ({"action": "turn", "degrees": 10.0}, 1),
        ({"action": "turn", "degrees": -10.0}, -1),
        ({"action": "turn", "degrees": 0.0}, 0),
        ({"action": "track", "track_deg": 20.0}, 1),
        ({"action": "track", "track_deg": 340.0}, -1),
        ({"action": "altitude", "altitude_ft": 34_400}, 0),
    ],
)
def test_a_turn_or_a_track_complies_with_a_turn_to_its_side(
    command: dict[str, Any], side: int
) -> None:
    for advised_deg in (30.0, -30.0):
        advised = {"action": "turn", "degrees": advised_deg}
        assert with_command(advised, **command) is (advised_deg * side > 0.0)


def test_a_track_has_no_side_where_the_present_one_is_not_known() -> None:
    advised = RECOMMENDATION.validate_python({"action": "turn", "degrees": 30.0})
    command = COMMAND.validate_python({"action": "track", "track_deg": 20.0})
    assert not complies(advised, command, None)


@pytest.mark.parametrize("advised", ["hold_position", "cancel_takeoff", "go_around"])
@pytest.mark.parametrize("done", ["hold_position", "cancel_takeoff", "go_around", "continue"])
def test_who_is_to_stop_stops_and_who_is_to_go_around_goes_around(advised: str, done: str) -> None:
    stops = {"hold_position", "cancel_takeoff"}
    is_complied = done == advised or {advised, done} <= stops
    assert with_command({"action": advised, "runway": "01"}, action=done) is is_complied


def test_a_call_complies_with_the_advice_to_confirm_alone() -> None:
    confirm = {"action": "confirm", "callsign": "AAL1", "slot": "runway"}
    advice = [RECOMMENDATION.validate_python(one) for one in (confirm, DESCEND)]
    assert [complies(one, None, None) for one in advice] == [True, False]
    assert not with_command(confirm, action="go_around", climb_to_ft=3000)
