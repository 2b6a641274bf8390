"""Seeded perturbation. The same scenario and seed give the same realised scenario."""

from __future__ import annotations

from collections.abc import Iterator

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


def _steps(document: Json, path: str) -> Iterator[tuple[Json, str | int]]:
    """Yield each container on the way to the value named by ``path``, and the key that leads on."""
    value = document
    for chunk in path.strip("/").split("/"):
        if isinstance(value, list):
            key: str | int = _index(value, chunk)
        elif isinstance(value, dict) and chunk in value:
            key = chunk
        else:
            raise PathError(chunk, sorted(value) if isinstance(value, dict) else [])
        yield value, key
        value = value[key]


def locate(document: Json, path: str) -> tuple[Json, str | int]:
    """Return the container that holds the value named by ``path``, and its key there.

    Raises
    ------
    PathError
        There is no such value.
    """
    return list(_steps(document, path))[-1]


def place_of(document: Json, path: str) -> tuple[str | int, ...]:
    """Return the keys that lead to a value, one for each spelling of its path.

    Raises
    ------
    PathError
        There is no such value.
    """
    return tuple(key for _, key in _steps(document, path))


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

    The realised scenario declares no perturbations, so realising it again changes nothing; nor does
    it have a twin, which draws its own.

    Raises
    ------
    pydantic.ValidationError
        A draw took a value out of the range that the scenario format allows.
    """
    document = scenario.model_dump(mode="json")
    draws = []
    for perturbation in scenario.perturbations:
        container, key = locate(document, perturbation.path)
        nominal = float(container[key])
        container[key] = nominal + _sample(perturbation, seed)
        draws.append(Draw(path=perturbation.path, nominal=nominal, realised=container[key]))
    document |= {"perturbations": [], "nominal_twin": None}
    return Scenario.model_validate(document), draws
