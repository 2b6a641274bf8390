"""Mutated files are accepted and run, or refused with a named error; nothing else happens."""

from __future__ import annotations

import itertools
import json
import math

import pytest

import fuzz_files
import fuzz_scenarios
from breadth import mostly_slow
from mutants import Mutator, Read, judge, judge_many, shipped

EN_ROUTE = ("s02a_headon", "s02a_vertical", "s02b_engine_out_driftdown", "s02c_nominal")
AIRPORTS = ("s01a_bad_readback", "s01b_nominal", "s01c_flock_on_final")


def require_accepted_or_refused(
    kind: str, names: tuple[str, ...] | None, read: Read, count: int, run_every: int
) -> None:
    """Times are for the tools to judge: those of a busy machine are not the project's."""
    documents = shipped(kind, names)
    judged = judge_many(documents, read, 20, count, run_every, longest_check_s=math.inf)
    outcomes = [outcome for _, outcome in judged]
    assert [outcome.message for outcome in outcomes if outcome.kind == "failed"] == []
    assert {outcome.kind for outcome in outcomes} == {"accepted", "refused"}
    assert any(outcome.ran for outcome in outcomes) == (run_every > 0)


@pytest.mark.parametrize(
    ("names", "count", "run_every"),
    mostly_slow(
        [(EN_ROUTE, 440, 10), (EN_ROUTE, 120, 10), (AIRPORTS, 60, 0), (AIRPORTS, 20, 0)],
        (EN_ROUTE, 120, 10), (AIRPORTS, 20, 0),
    ),
    ids=["air", "a little in the air", "ground", "a little on the ground"],
)  # fmt: skip
def test_a_mutated_scenario_is_accepted_or_refused_by_name(
    names: tuple[str, ...], count: int, run_every: int
) -> None:
    require_accepted_or_refused("scenarios", names, fuzz_scenarios.read, count, run_every)


@pytest.mark.parametrize(
    ("kind", "count", "run_every"),
    mostly_slow(
        [("airports", 200, 0), ("airports", 60, 0), ("aircraft", 200, 10), ("aircraft", 60, 5)],
        ("airports", 60, 0), ("aircraft", 60, 5),
    ),
)  # fmt: skip
def test_a_mutated_airport_or_aircraft_type_is_accepted_or_refused_by_name(
    kind: str, count: int, run_every: int
) -> None:
    require_accepted_or_refused(kind, None, fuzz_files.READERS[kind], count, run_every)


def test_a_seed_gives_the_same_mutants_again() -> None:
    documents = shipped("scenarios", EN_ROUTE)
    first, again, other = (
        list(itertools.islice(Mutator(documents, seed).mutants(), 20)) for seed in (1, 1, 2)
    )
    assert first == again != other


def test_a_scenario_that_ships_is_accepted_and_runs() -> None:
    (document,) = shipped("scenarios", ["s02a_headon"])
    assert judge(json.dumps(document), fuzz_scenarios.read, runs=True).kind == "accepted"


@pytest.mark.parametrize(("kind", "name"), [("airports", "kdca"), ("aircraft", "c310")])
def test_an_airport_or_aircraft_type_that_ships_is_accepted_and_runs(kind: str, name: str) -> None:
    (document,) = shipped(kind, [name])
    assert judge(json.dumps(document), fuzz_files.READERS[kind], runs=True).kind == "accepted"
