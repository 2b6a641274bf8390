"""The nominal twin of a scenario: the same traffic, in which nobody comes into conflict."""

from __future__ import annotations

from pydantic import ValidationError

from airhilt.errors import ScenarioError, first_problem
from airhilt.host.library import nearest
from airhilt.scenario.documents import Json
from airhilt.scenario.models import Scenario
from airhilt.scenario.perturbation import PathError, locate, numbers


def twin_of(scenario: Scenario) -> Scenario:
    """Return the nominal twin: without failures and conflict, and with the values of its own.

    Raises
    ------
    ScenarioError
        The scenario has none, or what it says of it leads nowhere or is not valid.
    """
    if scenario.nominal_twin is None:
        raise ScenarioError(f"{scenario.name} has no nominal twin; expected one with nominal_twin")
    document = scenario.model_dump(mode="json")
    for path, value in scenario.nominal_twin.items():
        try:
            container, key = locate(document, path)
        except PathError as error:
            raise ScenarioError(
                f"{path!r} leads nowhere: no {error.chunk!r} there"
                f"{nearest(error.chunk, error.known)}"
            ) from None
        container[key] = value
    document |= {
        "title": f"{scenario.title} (nominal twin)",
        "failures": [],
        "conflict": None,
        "nominal_twin": None,
    }
    document["perturbations"] = [
        one for one in document["perturbations"] if _leads_somewhere(document, one["path"])
    ]
    try:
        return Scenario.model_validate(document)
    except ValidationError as error:
        raise ScenarioError(first_problem(error)) from None


def _leads_somewhere(document: Json, path: str) -> bool:
    """Return whether the twin has what a perturbation of the scenario is of."""
    try:
        for found in numbers(document, path):
            locate(document, found)
    except PathError:
        return False
    return True
