"""The pair that the conflict of a scenario is between."""

from __future__ import annotations

from airhilt.scenario.conflict_pair import pair_of
from airhilt.world.loading import load

SCENARIO = load("s02a_headon")
FIRST, SECOND = (actor.callsign for actor in SCENARIO.actors[:2])


def test_the_pair_is_named_in_the_order_of_the_actors() -> None:
    assert pair_of(SCENARIO) == (FIRST, SECOND)
    assert SCENARIO.conflict is not None
    turned = SCENARIO.conflict.model_copy(update={"actors": (SECOND, FIRST)})
    assert pair_of(SCENARIO.model_copy(update={"conflict": turned})) == (FIRST, SECOND)


def test_a_scenario_without_a_conflict_has_no_pair() -> None:
    assert pair_of(SCENARIO.model_copy(update={"conflict": None})) is None
