"""Seeded perturbation. The same scenario and seed give the same realised scenario."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from pydantic import BaseModel, ConfigDict

from airhilt.scenario.documents import Json
from airhilt.scenario.models import Distribution, Normal, Perturbation, Scenario, Uniform
from airhilt.scenario.spreads import usual_spread
from airhilt.sim.streams import stream

NAMING_FIELDS = ("callsign", "id", "name")
"""Fields by which a path names an entry of a list."""
ANY = "*"
"""Part of a path that stands for every name."""
BEARINGS = frozenset({"azimuth_deg", "bearing_deg", "from_deg", "heading_deg", "track_deg"})
"""Fields that begin again at 0 after 360."""


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


def numbers(document: Json, path: str) -> list[str]:
    """Return the paths of the numbers that a path with `ANY` reaches, or a path without it alone.

    Raises
    ------
    PathError
        There is no such number.
    """
    chunks = path.strip("/").split("/")
    if ANY not in chunks:
        return [path]
    found = [each for each, value in _reached(document, chunks) if isinstance(value, float)]
    if not found:
        raise PathError(path, [])
    return found


def _reached(value: Json, chunks: list[str]) -> Iterator[tuple[str, Json]]:
    """Yield the path and the value of all that a path with `ANY` leads to from here."""
    if not chunks:
        yield "", value
        return
    first, *rest = chunks
    for name, each in _children(value):
        if first in (ANY, name):
            for path, reached in _reached(each, rest):
                yield f"{name}/{path}".rstrip("/"), reached


def _children(value: Json) -> Iterator[tuple[str, Json]]:
    """Yield what is in a container, by the names that a path has for it."""
    if isinstance(value, dict):
        yield from value.items()
    elif isinstance(value, list):
        for index, entry in enumerate(value):
            fields = entry if isinstance(entry, dict) else {}
            name = next((str(fields[each]) for each in NAMING_FIELDS if each in fields), index)
            yield str(name), entry


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


def spreads(document: Json) -> dict[str, Distribution]:
    """Return the distribution of each number that a scenario's document perturbs, by its path.

    Raises
    ------
    PathError
        A path leads to no value.
    """
    found: dict[tuple[str | int, ...], tuple[str, Distribution]] = {}
    for each in map(Perturbation.model_validate, document["perturbations"]):
        for path in numbers(document, each.path):
            if (spread := each.distribution or usual_spread(path)) is not None:
                found[place_of(document, path)] = path, spread
    return dict(found.values())


def _sample(path: str, distribution: Distribution, seed: int) -> float:
    """Draw from a stream that depends on the seed and the path only."""
    generator = stream(seed, f"perturbation/{path}")
    limit = distribution.limit
    match distribution:
        case Normal(sigma=sigma):
            return float(np.clip(generator.normal(0.0, sigma), -limit, limit))
        case Uniform(least=least):
            return float(generator.uniform(-limit if least is None else least, limit))


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
    for path, distribution in spreads(document).items():
        container, key = locate(document, path)
        nominal = float(container[key])
        realised = nominal + _sample(path, distribution, seed)
        container[key] = realised % 360.0 if key in BEARINGS else realised
        draws.append(Draw(path=path, nominal=nominal, realised=container[key]))
    document |= {"perturbations": [], "nominal_twin": None}
    return Scenario.model_validate(document), draws
