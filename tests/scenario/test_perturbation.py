"""The same scenario and seed give the same realised scenario."""

from __future__ import annotations

import statistics
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from airhilt.host import library
from airhilt.scenario import Scenario
from airhilt.scenario.models import Normal, Perturbation, Uniform
from airhilt.scenario.perturbation import locate, realise, spreads
from airhilt.scenario.spreads import usual_spread
from airhilt.world.loading import load

HEAD_ON = load("s02a_headon")
CALLSIGN = HEAD_ON.actors[0].callsign
DISTANCE = f"actors/{CALLSIGN}/initial/position/distance_nm"
SPEED = f"actors/{CALLSIGN}/initial/cas_kt"

seeds = st.integers(0, 2**62)
distributions = st.builds(
    Normal, type=st.just("normal"), sigma=st.floats(0.01, 10.0), limit=st.floats(0.01, 5.0)
) | st.builds(Uniform, type=st.just("uniform"), limit=st.floats(0.01, 5.0))


def varied(**perturbations: Any) -> Scenario:
    """The head-on scenario with a perturbation of each path."""
    return HEAD_ON.model_copy(
        update={
            "perturbations": tuple(
                Perturbation(path=path, distribution=distribution)
                for path, distribution in perturbations.items()
            )
        }
    )


UNIFORM = Uniform(type="uniform", limit=1.0)
BOTH = varied(**{DISTANCE: UNIFORM, SPEED: UNIFORM})


@settings(deadline=None, max_examples=25)
@given(seeds)
def test_the_same_seed_draws_the_same_and_the_next_draws_something_else(seed: int) -> None:
    assert realise(BOTH, seed) == realise(BOTH, seed)
    draws, others = (realise(BOTH, s)[1] for s in (seed, seed + 1))
    assert all(a.realised != b.realised for a, b in zip(draws, others, strict=True))


@settings(deadline=None, max_examples=25)
@given(seeds)
def test_what_one_path_draws_does_not_depend_on_the_other_perturbations(seed: int) -> None:
    alone = realise(varied(**{SPEED: UNIFORM}), seed)[1]
    together = realise(BOTH, seed)[1]
    backwards = realise(varied(**{SPEED: UNIFORM, DISTANCE: UNIFORM}), seed)[1]
    assert alone[0] == together[1] == backwards[0]
    assert together[0] == backwards[1]
    assert together[0].realised - together[0].nominal != together[1].realised - together[1].nominal


@settings(deadline=None, max_examples=100)
@given(seeds, distributions)
def test_a_draw_stays_within_its_limits_and_is_what_the_scenario_gets(
    seed: int, distribution: Normal | Uniform
) -> None:
    realised, (draw,) = realise(varied(**{SPEED: distribution}), seed)
    assert abs(draw.realised - draw.nominal) <= distribution.limit + 1e-9
    assert draw.nominal == HEAD_ON.actors[0].initial.cas_kt
    assert realised.actors[0].initial.cas_kt == draw.realised
    assert draw.path == SPEED


def test_a_normal_draw_has_the_spread_that_it_says() -> None:
    scenario = varied(**{SPEED: Normal(type="normal", sigma=2.0, limit=100.0)})
    draws = [realise(scenario, seed)[1][0] for seed in range(300)]
    assert statistics.stdev(d.realised for d in draws) == pytest.approx(2.0, rel=0.15)
    assert statistics.mean(d.realised - d.nominal for d in draws) == pytest.approx(0.0, abs=0.4)


def test_what_is_declared_is_drawn_once_and_nothing_else_is_changed(
    subtests: pytest.Subtests,
) -> None:
    for name in library.names("scenarios"):
        with subtests.test(name):
            scenario = load(name)
            realised, draws = realise(scenario, 7)
            assert len({draw.path for draw in draws}) == len(draws) >= len(scenario.perturbations)
            assert realise(realised, 8) == (realised, [])
            document = realised.model_dump(mode="json")
            assert document["perturbations"] == []
            for draw in draws:
                container, key = locate(document, draw.path)
                assert container[key] == draw.realised
                container[key] = draw.nominal
            given = scenario.model_dump(mode="json")
            document |= {name: given[name] for name in ("perturbations", "nominal_twin")}
            assert Scenario.model_validate(document) == scenario


SHIPPED = [load(name) for name in library.names("scenarios")]


@settings(deadline=None, max_examples=100)
@given(seeds, st.sampled_from(SHIPPED))
def test_every_draw_of_a_shipped_scenario_is_within_its_bounds(
    seed: int, scenario: Scenario
) -> None:
    bounds = spreads(scenario.model_dump(mode="json"))
    for draw in realise(scenario, seed)[1]:
        spread = bounds[draw.path]
        least = getattr(spread, "least", None)
        moved = draw.realised - draw.nominal
        if draw.path.endswith("from_deg"):
            moved = (moved + 180.0) % 360.0 - 180.0
        assert (-spread.limit if least is None else least) - 1e-6 <= moved <= spread.limit + 1e-6


@settings(deadline=None, max_examples=25)
@given(seeds, st.sampled_from(SHIPPED))
def test_two_seeds_are_two_variants_of_a_shipped_scenario(seed: int, scenario: Scenario) -> None:
    draws, others = (realise(scenario, s)[1] for s in (seed, seed + 1))
    assert draws == realise(scenario, seed)[1]
    assert all(a.realised != b.realised for a, b in zip(draws, others, strict=True))


def test_a_star_reaches_every_number_of_that_name_and_each_has_its_own_draw() -> None:
    speeds = varied(**{"actors/*/initial/cas_kt": UNIFORM})
    draws = realise(speeds, 3)[1]
    assert [draw.path for draw in draws] == [
        f"actors/{actor.callsign}/initial/cas_kt" for actor in HEAD_ON.actors
    ]
    assert draws[0] == realise(varied(**{SPEED: UNIFORM}), 3)[1][0]
    assert draws[0].realised - draws[0].nominal != draws[1].realised - draws[1].nominal


def test_of_two_entries_for_a_number_the_later_one_counts() -> None:
    wide = Uniform(type="uniform", limit=8.0)
    every = "actors/*/initial/cas_kt"
    bounds = spreads(varied(**{every: wide, SPEED: UNIFORM}).model_dump(mode="json"))
    assert [spread.limit for spread in bounds.values()] == [1.0, 8.0]
    bounds = spreads(varied(**{SPEED: UNIFORM, every: wide}).model_dump(mode="json"))
    assert [spread.limit for spread in bounds.values()] == [8.0, 8.0]


def test_without_a_distribution_a_number_has_the_usual_spread_of_its_kind() -> None:
    (spread,) = spreads(varied(**{SPEED: None}).model_dump(mode="json")).values()
    assert spread == usual_spread("actors/ANY1/initial/cas_kt")


def test_a_bearing_goes_on_at_zero_after_360() -> None:
    wind = varied(**{"weather/wind/from_deg": Uniform(type="uniform", limit=180.0)})
    north = wind.model_copy(
        update={
            "weather": wind.weather.model_copy(
                update={"wind": wind.weather.wind.model_copy(update={"from_deg": 0.0})}
            )
        }
    )
    drawn = [realise(north, seed)[0].weather.wind.from_deg for seed in range(20)]
    assert min(drawn) < 90.0 < 270.0 < max(drawn)


def test_a_list_entry_is_named_by_callsign_id_or_name_or_by_its_index() -> None:
    document = {"a": [{"callsign": "X1", "v": 1}, {"id": "line", "v": 2}, {"name": "c", "v": 3}]}
    for path, value in (("a/X1/v", 1), ("a/line/v", 2), ("a/c/v", 3), ("a/1/v", 2), ("/a/0/v/", 1)):
        container, key = locate(document, path)
        assert container[key] == value
