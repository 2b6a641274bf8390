"""The benchmarks measure what they say."""

from __future__ import annotations

from airhilt.world.checks import check
from benchmarks.traffic import fifty_scenario


def test_the_scenario_of_fifty_is_one_that_flies() -> None:
    scenario = fifty_scenario()
    check(scenario, "fifty")
    assert len(scenario.actors) == 50
