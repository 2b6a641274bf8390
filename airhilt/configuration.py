"""Configurations of engines: pydantic models, read from JSON files, whose errors help.

A configuration is a `Configuration` whose fields have a default, limits, and in their description
the unit and the source. An `airhilt.engines.Engine` names the model of its own.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from itertools import pairwise
from pathlib import Path
from typing import Annotated, Any, TypeVar

from pydantic import BaseModel, ConfigDict, Field, ValidationError
from pydantic.fields import FieldInfo

from airhilt.errors import AirhiltError, shown
from airhilt.host import bounded_json
from airhilt.host.files import read_file
from airhilt.host.library import nearest

Seconds = Annotated[float, Field(ge=0.0, le=3600.0)]
"""Time in s; an hour at most."""
Share = Annotated[float, Field(ge=0.0, le=1.0)]
"""Probability, belief, confidence or weight."""


class Configuration(BaseModel):
    """Base class of configurations: immutable, and strict about names and numbers."""

    model_config = ConfigDict(extra="forbid", frozen=True, allow_inf_nan=False)


C = TypeVar("C", bound=BaseModel)


def read_configuration(path: Path) -> dict[str, Any]:
    """Return what a JSON file holds: an object.

    Raises
    ------
    AirhiltError
        It cannot be read, or holds something else.
    """
    try:
        document = bounded_json.parse(read_file(path, bounded_json.MOST_BYTES))
    except OSError as error:
        raise AirhiltError(f"{path}: cannot be read: {error.strerror}") from None
    except ValueError as error:
        raise AirhiltError(f"{path}: no JSON: {error}; expected a JSON object") from None
    if not isinstance(document, dict):
        raise AirhiltError(f"{path}: found {shown(document)}; expected a JSON object")
    return document


def configured(model: type[C], given: Mapping[str, Any], what: str) -> C:
    """Return the configuration that has some values, and the defaults for the others.

    Parameters
    ----------
    what
        Begins an error message.

    Raises
    ------
    AirhiltError
        A name is unknown, and the message gives the nearest; or a value is beyond its limit.
    """
    try:
        return model.model_validate(given)
    except ValidationError as error:
        first = error.errors()[0]
        place = tuple(str(part) for part in first["loc"])
        if first["type"] == "extra_forbidden":
            raise AirhiltError(f"{what}: {_unknown(model, place)}") from None
        where = ": ".join([what, *(["/".join(place)] if place else [])])
        found = "" if first["type"] == "value_error" else f", found {shown(first['input'])}"
        message = str(first["msg"]).removeprefix("Value error, ")
        raise AirhiltError(f"{where}: {message[0].lower()}{message[1:]}{found}") from None


def require_order(configuration: BaseModel, *names: str) -> None:
    """Complain about values of which one is greater than the next.

    Raises
    ------
    ValueError
        The message names both.
    """
    for lower, upper in pairwise(names):
        low, high = getattr(configuration, lower), getattr(configuration, upper)
        if low > high:
            raise ValueError(f"{lower} is {low:g}; expected at most {upper}, {high:g}")


def _unknown(model: type[BaseModel], place: tuple[str, ...]) -> str:
    """Return what is wrong with a name that a model does not have."""
    names = [place for place, _ in settings(model)]
    level, name = place[:-1], place[-1]
    beside = [each[-1] for each in names if each[:-1] == level]
    hint = nearest(name, beside)
    elsewhere = ["/".join(each) for each in names if each[-1] == name]
    if "did you mean" not in hint and elsewhere:
        hint = f"; did you mean {' or '.join(map(repr, elsewhere))}?"
    return f"{'/'.join(place)}: there is nothing of that name{hint}"


def settings(
    model: type[BaseModel], above: tuple[str, ...] = ()
) -> Iterator[tuple[tuple[str, ...], FieldInfo]]:
    """Yield the path and the field of each setting of a model, nested models included."""
    for name, field in model.model_fields.items():
        place = (*above, name)
        yield place, field
        if isinstance(field.annotation, type) and issubclass(field.annotation, BaseModel):
            yield from settings(field.annotation, place)
