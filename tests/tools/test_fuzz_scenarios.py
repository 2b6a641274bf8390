"""Mutated scenarios are accepted and run, or refused with a named error; nothing else happens."""

from __future__ import annotations

import itertools
import json

import pytest

from fuzz_scenarios import Mutator, judge, shipped

EN_ROUTE = ("s02a_headon", "s02a_vertical", "s02b_engine_out_driftdown", "s02c_nominal")
AIRPORTS = ("s01a_bad_readback", "s01b_nominal", "s01c_flock_on_final")


@pytest.mark.parametrize(
    ("names", "count", "run_every"), [(EN_ROUTE, 440, 40), (AIRPORTS, 60, 0)], ids=["air", "ground"]
)
def test_a_mutated_scenario_is_accepted_or_refused_by_name(
    names: tuple[str, ...], count: int, run_every: int
) -> None:
    mutants = itertools.islice(Mutator(shipped(names), seed=20).mutants(), count)
    outcomes = [
        judge(text, runs=run_every > 0 and number % run_every == 0)
        for number, text in enumerate(mutants)
    ]
    assert [outcome.message for outcome in outcomes if outcome.kind == "failed"] == []
    assert {outcome.kind for outcome in outcomes} == {"accepted", "refused"}


def test_a_seed_gives_the_same_mutants_again() -> None:
    documents = shipped(EN_ROUTE)
    first, again, other = (
        list(itertools.islice(Mutator(documents, seed).mutants(), 20)) for seed in (1, 1, 2)
    )
    assert first == again != other


def test_a_scenario_that_ships_is_accepted_and_runs() -> None:
    (document,) = shipped(["s02a_headon"])
    assert judge(json.dumps(document), runs=True).kind == "accepted"
