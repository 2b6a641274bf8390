"""Seeded perturbation. The same scenario and seed give the same realised scenario."""

from __future__ import annotations

import copy

import numpy as np
from pydantic import BaseModel, ConfigDict

from airhilt.scenario.documents import Json
from airhilt.scenario.models import Normal, Perturbation, Scenario
from airhilt.sim.streams import stream

NAMING_FIELDS = ("callsign", "id", "name")
"""Fields by which a path names an entry of a list."""


class Draw(BaseModel):
    """Drawn value of one perturbation."""

    model_config = ConfigDict(frozen=True)
    path: str
    nominal: float
    realised: float


class PathError(ValueError):
    """A path leads to no value; ``known`` has the names that exist there."""

    def __init__(self, chunk: str, known: list[str]) -> None:
        super().__init__(chunk)
        self.chunk = chunk
        self.known = known


def locate(document: Json, path: str) -> tuple[Json, str | int]:
    """Return the container that holds the value named by ``path``, and its key there.

    Raises
    ------
    PathError
        There is no such value.
    """
    container: Json = None
    key: str | int = ""
    value = document
    for chunk in path.strip("/").split("/"):
        container = value
        if isinstance(container, dict):
            if chunk not in container:
                raise PathError(chunk, sorted(container))
            key = chunk
        elif isinstance(container, list):
            key = _index(container, chunk)
        else:
            raise PathError(chunk, [])
        value = container[key]
    return container, key


def place_of(document: Json, path: str) -> tuple[str | int, ...]:
    """Return the keys that lead to a value, one for each spelling of its path.

    Raises
    ------
    PathError
        There is no such value.
    """
    chunks = path.strip("/").split("/")
    return tuple(locate(document, "/".join(chunks[: end + 1]))[1] for end in range(len(chunks)))


def _index(entries: list[Json], chunk: str) -> int:
    named = {
        str(entry[field]): index
        for index, entry in enumerate(entries)
        if isinstance(entry, dict)
        for field in NAMING_FIELDS
        if field in entry
    }
    if chunk in named:
        return named[chunk]
    if chunk.isdecimal() and int(chunk) < len(entries):
        return int(chunk)
    raise PathError(chunk, sorted(named) or [str(index) for index in range(len(entries))])


def _sample(perturbation: Perturbation, seed: int) -> float:
    """Draw from a stream that depends on the seed and the path only."""
    generator = stream(seed, f"perturbation/{perturbation.path}")
    match perturbation.distribution:
        case Normal(sigma=sigma, limit=limit):
            return float(np.clip(generator.normal(0.0, sigma), -limit, limit))
        case uniform:
            return float(generator.uniform(-uniform.limit, uniform.limit))


def realise(scenario: Scenario, seed: int) -> tuple[Scenario, list[Draw]]:
    """Return the scenario with its perturbations drawn, and the draws.

    The realised scenario declares no perturbations, so realising it again changes nothing.

    Raises
    ------
    pydantic.ValidationError
        A draw took a value out of the range that the scenario format allows.
    """
    document = copy.deepcopy(scenario.model_dump(mode="json"))
    draws = []
    for perturbation in scenario.perturbations:
        container, key = locate(document, perturbation.path)
        nominal = float(container[key])
        container[key] = nominal + _sample(perturbation, seed)
        draws.append(Draw(path=perturbation.path, nominal=nominal, realised=container[key]))
    document["perturbations"] = []
    return Scenario.model_validate(document), draws
