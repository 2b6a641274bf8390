"""A scenario has a response model by name, or one of its own; a wrong one is told in one line."""

from __future__ import annotations

from typing import Any

import pytest

from airhilt.errors import ScenarioError
from airhilt.host import library
from airhilt.scenario import Scenario
from airhilt.scenario.models import RESPONSE_MODELS
from airhilt.scenario.problems import validated
from airhilt.world.checks import check
from airhilt.world.loading import load

CALM = {"assistant": {"median_s": 5.0}}


def with_crews(crews: Any) -> Scenario:
    scenario = load(library.find("scenarios", "s02a_headon"))
    return validated(Scenario, scenario.model_dump(mode="json") | {"crews": crews}, "mine")


def own(**assistant: float) -> dict[str, Any]:
    wild = {"assistant": {"median_s": 5.0, **assistant}}
    return {"crews": wild, "drivers": CALM, "controllers": CALM["assistant"]}


def test_a_name_stands_for_the_model_of_the_table() -> None:
    assert with_crews("observed").response_model is RESPONSE_MODELS["observed"]


def test_a_model_of_its_own_has_the_shares_that_it_gives() -> None:
    model = with_crews(own(no_response=0.2)).response_model
    assert model.crews.of("ra").no_response == 0.2
    assert model.drivers.of("controller").median_s == 5.0


@pytest.mark.parametrize(
    ("crews", "problem"),
    [
        ("observd", "crews: found \"observd\", expected 'ideal', 'icao' or 'observed'"),
        (own(late=1.2), "crews/crews/assistant/late: found 1.2: input should be less than or eq"),
        (own(late=0.6, weak=0.5), "crews/crews/assistant: no_response, late, weak and opposite add"
                                  " up to 1.1; expected at most 1"),
        ({"crews": CALM, "drivers": CALM}, "crews/controllers: missing"),
        (7, "crews: found 7, expected 'ideal', 'icao' or 'observed'"),
        ({**own(), "controllers": CALM}, "crews/controllers/median_s: missing"),
    ],
)  # fmt: skip
def test_a_wrong_one_is_refused_in_one_line(crews: Any, problem: str) -> None:
    with pytest.raises(ScenarioError) as told:
        with_crews(crews)
    assert problem in str(told.value)
    assert "\n" not in str(told.value)


@pytest.mark.parametrize(
    ("given", "path"),
    [
        ({"drivers": {"assistant": {"median_s": 1.0, "weak": 0.1}}}, "drivers/assistant/weak"),
        ({"drivers": {**CALM, "ra": {"median_s": 1.0, "weak": 0.1}}}, "drivers/ra/weak"),
        ({"controllers": {"median_s": 1.0, "opposite": 0.1}}, "controllers/opposite"),
        ({"crews": {**CALM, "controller": {"median_s": 1.0, "weak": 0.1}}}, "crews/controller/w"),
    ],
)
def test_a_share_that_means_nothing_is_refused(given: dict[str, Any], path: str) -> None:
    with pytest.raises(ScenarioError) as told:
        check(with_crews(own() | given), "mine")
    assert f"crews/{path}" in str(told.value)
    assert "found 0.1; expected 0: only crews" in str(told.value)
    assert "\n" not in str(told.value)
