"""The SURF-A baseline: which crew is alerted when, of what, and what it does."""

from __future__ import annotations

from typing import Any

import pytest

from airfield import (
    APPROACH_M_S,
    NORTH,
    SOUTHEAST,
    TOUCHDOWN_M,
    Airfield,
    Mover,
    lands,
    stands,
)
from airhilt.assistant.decision.engines import decision_engine
from airhilt.assistant.decision.worker import DecisionWorker
from airhilt.assistant.wording.engines.template import Template
from airhilt.errors import AirhiltError

THRESHOLD_S = 90.0
TOUCHDOWN_S = THRESHOLD_S + TOUCHDOWN_M / APPROACH_M_S


def arrival(**rest: Any) -> Mover:
    return Mover("AAL123", NORTH, lands(THRESHOLD_S), **rest)


def airfield(*movers: Mover, engine: str = "surf_a", seconds: float = 95.0) -> Airfield:
    worker = DecisionWorker(decision_engine(engine), Template())
    return Airfield(list(movers), worker=worker).run(seconds)


def times(field: Airfield) -> list[tuple[str, float]]:
    """Return the active alerts with the time that was left to the touchdown."""
    return [(told.severity.value, TOUCHDOWN_S - t_s) for t_s, told in field.told if told.active]


def test_the_crew_is_told_what_is_there_and_nobody_else_is_told() -> None:
    field = airfield(arrival(), Mover("OPS1", NORTH, stands(800.0), category="C2"))
    assert {told.recipient for _, told in field.told} == {"AAL123"}
    caution, warning = [told for _, told in field.told if told.active]
    assert caution.message.startswith("AAL123 OPS1 is on runway 01")
    assert warning.message.startswith("AAL123 go around, OPS1 is on runway 01")
    assert warning.evidence.sources == ("adsb",)
    assert len(warning.evidence.tracks) == 2


def test_the_crew_goes_around_on_the_warning_or_already_on_the_caution() -> None:
    for engine, severity in (("surf_a", "WARNING"), ("surf_a:caution", "CAUTION")):
        traffic = Mover("OPS1", NORTH, stands(800.0), category="C2")
        field = airfield(arrival(), traffic, engine=engine)
        told = next(told for _, told in field.told if told.recommendation is not None)
        assert told.severity == severity
        assert told.recommendation is not None
        assert told.recommendation.action == "go_around"


def test_an_arrival_to_a_crossing_runway_is_not_on_the_runway() -> None:
    other = Mover("DAL456", SOUTHEAST, lands(THRESHOLD_S))
    assert all(TOUCHDOWN_S - t_s < 1.0 for t_s, _ in airfield(arrival(), other).told)


def test_its_times_can_be_set_and_the_caution_is_never_the_later_one() -> None:
    engine = decision_engine("surf_a", configuration={"caution_s": 40.0})
    worker = DecisionWorker(engine, Template())
    field = Airfield(
        [arrival(), Mover("OPS1", NORTH, stands(1800.0), category="C2")], worker=worker
    ).run(95.0)
    assert times(field)[0] == ("CAUTION", pytest.approx(40.0, abs=1.5))
    with pytest.raises(AirhiltError, match="warning_s is 15; expected at most caution_s, 10"):
        decision_engine("surf_a", configuration={"caution_s": 10.0})


def test_a_severity_without_alerts_is_refused_by_name() -> None:
    with pytest.raises(AirhiltError, match="'surf_a:info': expected surf_a:caution or surf_a:warn"):
        decision_engine("surf_a:info")
