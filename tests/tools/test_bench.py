"""The benchmarks measure what they say."""

from __future__ import annotations

import runpy

from airhilt.world.checks import check
from paths import TOOLS

BENCH = TOOLS / "bench.py"


def test_the_scenario_of_fifty_is_one_that_flies() -> None:
    scenario = runpy.run_path(str(BENCH))["fifty_scenario"]()
    check(scenario, "fifty")
    assert len(scenario.actors) == 50
