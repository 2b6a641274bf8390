"""Checks of perturbations: whether each leads to a number."""

from __future__ import annotations

from collections.abc import Iterator

from airhilt.host import library
from airhilt.scenario.models import Scenario
from airhilt.scenario.perturbation import PathError, locate
from airhilt.scenario.problems import Problem, short_json
from airhilt.world.checks.duplicates import duplicates


def misplaced_perturbations(scenario: Scenario) -> Iterator[Problem]:
    """Yield perturbations whose path leads to no number, or that share a path."""
    document = scenario.model_dump(mode="json")
    for index, perturbation in enumerate(scenario.perturbations):
        path = f"perturbations/{index}/path"
        try:
            container, key = locate(document, perturbation.path)
        except PathError as error:
            tail = library.nearest(error.chunk, error.known)
            yield Problem(
                path, f"{perturbation.path!r} leads nowhere: no {error.chunk!r} there{tail}"
            )
            continue
        value = container[key]
        if not isinstance(value, float):
            yield Problem(
                path,
                f"{perturbation.path!r} is {short_json(value)}; expected the path of a number that "
                "may have a fraction",
            )
    yield from duplicates(
        "perturbations", "path", [perturbation.path for perturbation in scenario.perturbations]
    )
