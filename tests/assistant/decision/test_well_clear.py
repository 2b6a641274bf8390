"""Detect and avoid by DO-365B as an assistant: alerts by ADS-B, and turns."""

from __future__ import annotations

import itertools

import pytest

from airhilt.assistant.decision.engines.well_clear import RESPONSE_S, _stays_clear, smallest_turn
from airhilt.assistant.decision.worker import DecisionWorker
from airhilt.assistant.wording.engines.template import Template
from airhilt.engine_families import ASSISTANTS
from airhilt.geodesy.relative_motion import Relative
from airhilt.messages import Advisory, Turn
from airhilt.surveillance.well_clear import CORRECTIVE, Gap, time_to_violation_s
from encounters import Encounter, head_on


def well_clear() -> DecisionWorker:
    return DecisionWorker(ASSISTANTS.create("well_clear"), Template())


MEETS_S = 30.7 * 3600.0 / 480.0
"""Time at which the two of `head_on` meet."""


def flown(encounter: Encounter) -> Encounter:
    encounter.worker = well_clear()
    return encounter.fly()


def first_s(encounter: Encounter, severity: str) -> float | None:
    return next(
        (MEETS_S - t for t, advisory in encounter.told if str(advisory.severity) == severity), None
    )


def test_it_alerts_both_crews_when_daidalus_does() -> None:
    encounter = flown(head_on(250.0))
    assert first_s(encounter, "CAUTION") == pytest.approx(89.0, abs=2.0)
    assert first_s(encounter, "WARNING") == pytest.approx(59.0, abs=2.0)
    assert {advisory.recipient for _, advisory in encounter.told} == {"AAL123", "DAL456"}
    assert not encounter.told[-1][1].active


def test_an_alert_ends_5_s_after_the_two_are_well_clear_again() -> None:
    past_dmod_s = 0.66 / 960.0 * 3600.0
    ended_s, last = flown(head_on(250.0)).told[-1]
    assert not last.active
    assert ended_s - MEETS_S == pytest.approx(past_dmod_s + 5.0, abs=1.5)


def test_traffic_600_ft_above_is_only_monitored() -> None:
    encounter = flown(head_on(250.0, altitude_ft=35_600.0))
    assert set(encounter.severities("AAL123")) == {"ADVISORY"}
    assert encounter.told[0][1].message == "traffic, monitor"
    assert all(advisory.recommendation is None for _, advisory in encounter.told)


def test_crews_that_meet_head_on_are_told_to_turn_right() -> None:
    advisories: list[Advisory] = [each for _, each in flown(head_on(200.0)).told]
    first = advisories[:2]
    assert {str(each.severity) for each in first} == {"CAUTION"}
    turns = [each.recommendation for each in first]
    assert all(isinstance(turn, Turn) and 0.0 < turn.degrees <= 40.0 for turn in turns)
    assert all(each.message.startswith("traffic, avoid, turn right") for each in first)


def test_an_alert_stays_open_until_the_two_are_past_each_other() -> None:
    """A silent track is carried on, so an alert does not end because reports stop."""
    encounter = head_on(235.0)
    encounter.silent_after_s = 150.0
    told = flown(encounter).told
    assert told
    assert all(advisory.active for t, advisory in told if t < MEETS_S)


def test_who_flies_on_is_told_again_after_the_time_to_respond_and_to_the_same_side() -> None:
    told = flown(head_on(200.0)).told
    for severity in ("CAUTION", "WARNING"):
        turns = {
            t: each.recommendation
            for t, each in told
            if each.recipient == "AAL123" and each.severity == severity
        }
        assert all(isinstance(turn, Turn) and turn.degrees > 0.0 for turn in turns.values())
        between_s = {later - t for t, later in itertools.pairwise(turns)}
        assert between_s == {RESPONSE_S}


@pytest.mark.parametrize(("after_s", "is_clear"), [(179.5, False), (180.5, True)])
def test_a_turn_is_to_stay_well_clear_for_three_minutes(after_s: float, is_clear: bool) -> None:
    """Two meet head-on at 400 m/s; the violation begins some time after the response."""

    def motion(distance_m: float) -> Relative:
        return Relative(distance_m, 0.0, -400.0, 0.0)

    def violation_s(distance_m: float) -> float:
        found = time_to_violation_s(motion(distance_m), Gap(0.0, 0.0), CORRECTIVE.volume)
        assert found is not None
        return found

    distance_m = 100_000.0 + 400.0 * (after_s + RESPONSE_S - violation_s(100_000.0))
    assert violation_s(distance_m) == pytest.approx(after_s + RESPONSE_S)
    assert _stays_clear(motion(distance_m), (200.0, 0.0), Gap(0.0, 0.0), 0.0) is is_clear


@pytest.mark.parametrize(("aside_m", "degrees"), [(0.0, 10.0), (4.7, -10.0), (-4.7, 10.0)])
def test_the_smallest_turn_is_away_from_the_other_and_to_the_right_where_either_will_do(
    aside_m: float, degrees: float
) -> None:
    """They meet in two minutes and a half; 10 degrees are 4.7 km to the side then."""
    apart = Relative(60_000.0, aside_m * 1_000.0, -400.0, 0.0)
    told = smallest_turn(apart, (200.0, 0.0), Gap(0.0, 0.0))
    assert told is not None
    assert told.degrees == degrees
    for side in (-10.0, 10.0):
        again = smallest_turn(apart, (200.0, 0.0), Gap(0.0, 0.0), Turn(degrees=side))
        assert again is not None
        assert again.degrees * side > 0.0
