"""The nominal twin of a scenario: the same traffic, in which nobody comes into conflict."""

from __future__ import annotations

from pathlib import Path

import pytest

from airhilt import AirhiltError, run
from airhilt.host import library
from airhilt.scenario.models import Scenario
from airhilt.scenario.twin import twin_of
from airhilt.world.checks import check
from airhilt.world.loading import load

WITH_CONFLICT = [name for name in library.names("scenarios") if load(name).conflict]


@pytest.mark.parametrize("name", WITH_CONFLICT)
def test_each_shipped_conflict_has_a_twin_with_the_same_actors(name: str) -> None:
    scenario = load(name)
    twin = twin_of(scenario)
    assert (twin.conflict, twin.failures) == (None, ())
    assert [one.callsign for one in twin.actors] == [one.callsign for one in scenario.actors]


@pytest.mark.slow
@pytest.mark.parametrize("name", WITH_CONFLICT)
def test_in_a_twin_nobody_comes_to_harm_without_an_assistant(name: str, tmp_path: Path) -> None:
    for seed in range(3):
        summary = run(
            name, twin=True, seed=seed, assistant="none", cameras=False, speech=False,
            report=False, out=tmp_path / str(seed),
        ).summary  # fmt: skip
        assert summary.conflict_outcome == "no_conflict"
        assert not summary.loss_of_separation
        assert not summary.runway_incursions


def changed(**fields: object) -> Scenario:
    document = load("s02a_headon").model_dump(mode="json")
    return Scenario.model_validate(document | fields)


@pytest.mark.parametrize(
    ("fields", "text"),
    [
        ({"nominal_twin": {"actors/DAL465/initial/altitude_ft": 36000}}, "no 'DAL465' there"),
        ({"nominal_twin": {"actors/DAL456/initial/altitude_ft": "high"}}, "altitude_ft"),
        ({"nominal_twin": {"actors/DAL456/initial/altitude_ft": 59000}}, "in the twin"),
    ],
)
def test_a_twin_that_cannot_be_is_told_of_when_the_scenario_is_read(
    fields: dict[str, object], text: str
) -> None:
    with pytest.raises(AirhiltError, match=text):
        check(changed(**fields), "mine.json")


def test_a_scenario_without_a_twin_has_none_to_run() -> None:
    with pytest.raises(AirhiltError, match="has no nominal twin"):
        run("s02a_nominal", twin=True)
