"""Loading, drawing and checking of scenarios."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from pydantic import ValidationError

from airhilt.errors import AirhiltError, ScenarioError, first_problem
from airhilt.scenario import loading
from airhilt.scenario.models import Scenario
from airhilt.scenario.perturbation import Draw, realise
from airhilt.world.checks import check


def load(name_or_file: str | Path, allowed: Sequence[Path] = ()) -> Scenario:
    """Return a scenario that ships with AIRHILT, by name, or one from a file; it is checked.

    Parameters
    ----------
    allowed
        Folders besides that of the file in which it may name files.

    Raises
    ------
    ScenarioError
        There is none of that name, or it is not valid.
    """
    path = loading.find(name_or_file)
    scenario = loading.read(path, allowed)
    check(scenario, str(path), is_whole=True)
    return scenario


def load_text(text: str, origin: str) -> Scenario:
    """Return the scenario in a JSON text; it is checked.

    ``origin`` is its name in errors.

    Raises
    ------
    ScenarioError
        The text is not JSON, or not a valid scenario.
    """
    scenario = loading.parse(text, origin)
    check(scenario, origin, is_whole=True)
    return scenario


def draw(scenario: Scenario, seed: int) -> tuple[Scenario, list[Draw]]:
    """Return a scenario with its perturbations drawn, and the draws; it is checked again.

    Raises
    ------
    ScenarioError
        A draw takes a value out of its range, or makes a scenario that is not valid.
    AirhiltError
        The seed is out of range.
    """
    if not 0 <= seed < 2**63:
        raise AirhiltError(f"seed {seed}: expected 0 or more, below 2^63")
    try:
        realised, draws = realise(scenario, seed)
    except ValidationError as error:
        raise ScenarioError(
            f"{scenario.name}: with seed {seed} a perturbation goes too far: "
            f"{first_problem(error)}; narrow its distribution"
        ) from None
    check(realised, f"{scenario.name}, as drawn with seed {seed}")
    return realised, draws
