"""A scenario is checked when it is loaded, and again when its perturbations are drawn."""

from __future__ import annotations

from pathlib import Path

import pytest

from airhilt.errors import AirhiltError, ScenarioError
from airhilt.scenario import Scenario
from airhilt.scenario.models import Perturbation, Uniform
from airhilt.world.loading import draw, load

HEAD_ON = load("s02a_headon")
AIRSPEED = f"actors/{HEAD_ON.actors[0].callsign}/initial/cas_kt"


def perturbed(limit: float) -> Scenario:
    """The head-on scenario with an airspeed that is drawn within a limit."""
    uniform = Uniform(type="uniform", limit=limit)
    perturbation = Perturbation(path=AIRSPEED, distribution=uniform)
    return HEAD_ON.model_copy(update={"perturbations": (perturbation,)})


def refused(scenario: Scenario) -> list[str]:
    """The errors of the first 40 seeds whose draws are refused."""
    errors = []
    for seed in range(40):
        try:
            draw(scenario, seed)
        except ScenarioError as error:
            errors.append(str(error))
    return errors


def test_a_file_that_the_schema_allows_is_still_checked_against_the_world(tmp_path: Path) -> None:
    file = tmp_path / "unknown_type.json"
    file.write_text(HEAD_ON.model_dump_json().replace('"aircraft":"737"', '"aircraft":"707"', 1))
    with pytest.raises(ScenarioError, match=r"unknown_type\.json: actors/0/aircraft: .*'707'"):
        load(file)


def test_a_draw_within_the_envelope_is_a_scenario_without_perturbations() -> None:
    drawn, draws = draw(perturbed(1.0), 3)
    assert drawn.perturbations == ()
    assert [one.path for one in draws] == [AIRSPEED]


def test_a_draw_beyond_the_envelope_names_the_seed_and_the_place() -> None:
    errors = refused(perturbed(150.0))
    assert any("as drawn with seed" in error and "initial/cas_kt" in error for error in errors)


def test_a_draw_beyond_the_schema_names_the_seed_and_what_to_do() -> None:
    errors = refused(perturbed(900.0))
    assert any("perturbation goes too far" in error and "narrow" in error for error in errors)


@pytest.mark.parametrize("seed", [-1, 2**63])
def test_a_seed_out_of_range_is_refused(seed: int) -> None:
    with pytest.raises(AirhiltError, match=r"expected 0 or more, below 2\^63"):
        draw(HEAD_ON, seed)
