"""Phrases that are offered for the situation of a seat."""

from __future__ import annotations

from typing import Any

import pytest

from airhilt.phraseology import parse_call
from airhilt.station.phrases import Situation, offered

ON_FINAL = {"altitude_ft": 2_000.0, "height_ft": 1_700.0, "distance_nm": 6.0}


def phrases(**given: Any) -> dict[str, str]:
    """Return words by label."""
    return {one["label"]: one["text"] for one in offered(Situation(**given))}


@pytest.mark.parametrize(
    ("given", "label", "action"),
    [
        ({"runway": "01", **ON_FINAL}, "Cleared to land 01", "cleared_to_land"),
        ({"runway": "01", **ON_FINAL}, "Go around", "go_around"),
        ({"altitude_ft": 33_000.0, "style": "icao"}, "Climb FL340", "altitude"),
        ({"altitude_ft": 2_300.0}, "Descend 1,000 ft", "altitude"),
        ({"heading_deg": 10.0}, "Turn left 340", "heading"),
        ({"on_ground": True, "runway": "01"}, "Cleared for takeoff 01", "cleared_for_takeoff"),
        ({"category": "vehicle", "runway": "01"}, "Hold short of 01", "hold_short"),
        ({"category": "vehicle"}, "Hold position", "hold_position"),
    ],
)
def test_a_controller_is_offered_instructions_that_crews_understand(
    given: dict[str, Any], label: str, action: str
) -> None:
    text = phrases(speaker="unit", callsign="AAL123", **given)[label]
    meant = parse_call(text, ["AAL123", "DAL456"])
    assert (meant.callsign, [one.action for one in meant.instructions]) == ("AAL123", [action])


def test_who_is_on_the_ground_is_not_cleared_to_land() -> None:
    found = phrases(speaker="unit", callsign="AAL123", on_ground=True, runway="01")
    assert "Cleared to land 01" not in found


@pytest.mark.parametrize(
    "given",
    [
        pytest.param({"altitude_ft": 33_000.0, "height_ft": 32_700.0}, id="high above the airport"),
        pytest.param({"distance_nm": 40.0}, id="low, but far from it"),
        pytest.param({"height_ft": None, "distance_nm": None}, id="no airport is known"),
    ],
)
def test_nobody_goes_around_where_no_aircraft_lands(given: dict[str, Any]) -> None:
    elsewhere = {"callsign": "AAL123", "runway": "01", **ON_FINAL, **given}
    to_crew = phrases(speaker="unit", **elsewhere)
    assert not {"Go around", "Continue approach", "Cleared to land 01"} & set(to_crew)
    assert "Going around" not in phrases(speaker="aircraft", **elsewhere)


def test_a_crew_on_its_approach_can_say_that_it_goes_around() -> None:
    found = phrases(speaker="aircraft", callsign="AAL123", **ON_FINAL)
    assert found["Going around"].endswith(", going around.")
    assert "Going around" not in phrases(
        speaker="aircraft", callsign="AAL123", on_ground=True, **ON_FINAL
    )


def test_a_crew_is_offered_the_readback_of_what_it_has_heard() -> None:
    heard = "american one two three turn left heading two seven zero"
    found = phrases(speaker="aircraft", callsign="AAL123", heard=heard)
    (read,) = parse_call(found["Read back"], ["AAL123"]).instructions
    assert (read.action, read.heading_deg) == ("heading", 270.0)
    assert "Unable" in found


def test_a_crew_that_was_told_nothing_is_offered_no_readback() -> None:
    assert "Read back" not in phrases(speaker="vehicle", callsign="OPS1")
    assert phrases(speaker="unit", callsign=None) == {}
