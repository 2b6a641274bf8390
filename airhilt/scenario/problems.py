"""Problems of a scenario file, described for people: where, what was found, what was expected."""

from __future__ import annotations

import json
import types
import typing
from collections.abc import Collection, Sequence
from dataclasses import dataclass
from typing import Any, TypeVar

from pydantic import BaseModel, Tag, ValidationError

from airhilt.errors import ScenarioError
from airhilt.host import library
from airhilt.host.text import readable

LONGEST_PATH = 100
"""Number of characters that an error shows of a path."""
LONGEST_TEXT = 400
"""Number of characters that an error shows of what is wrong there."""


M = TypeVar("M", bound=BaseModel)


@dataclass(frozen=True)
class Problem:
    """One mistake in a document: a JSON path, and a text."""

    path: str
    text: str

    def __str__(self) -> str:
        path = self.path or "(top)"
        if len(path) > LONGEST_PATH:
            path = f"{path[: LONGEST_PATH // 2]}…{path[-LONGEST_PATH // 2 :]}"
        return f"{readable(path)}: {readable(self.text, LONGEST_TEXT)}"


def unknown(path: str, sort: str, name: str, known: Collection[str], more: str = "") -> Problem:
    """Return the problem of a name that refers to nothing, with the nearest known name.

    ``sort`` is what the name should be of, such as ``radio line``.
    """
    return Problem(path, f"no {sort} {name!r}{library.nearest(name, list(known))}{more}")


def error_for(origin: str, problems: Sequence[Problem]) -> ScenarioError:
    """Return one error for all problems: its message names the first."""
    lines = tuple(f"{origin}: {problem}" for problem in problems)
    more = f" (and {len(lines) - 1} more: see airhilt validate)" if len(lines) > 1 else ""
    return ScenarioError(lines[0] + more, lines)


def validated(model: type[M], document: Any, origin: str) -> M:
    """Return the model of a document, whose name in errors is ``origin``.

    Raises
    ------
    ScenarioError
        The document is wrong; the error has a line for each mistake.
    """
    try:
        return model.model_validate(document)
    except ValidationError as error:
        raise error_for(origin, problems_of(error, model)) from None


def problems_of(error: ValidationError, model: type[BaseModel]) -> list[Problem]:
    """Return what pydantic found wrong, without the errors that only follow from others.

    A list whose entries are wrong counts as too short.
    """
    errors = error.errors()
    places = [one["loc"] for one in errors]
    return [
        _described(one, model)
        for one in errors
        if one["type"] != "too_short"
        or not any(place[:-1][: len(one["loc"])] == one["loc"] for place in places)
    ]


def _described(error: Any, model: type[BaseModel]) -> Problem:
    """Return one pydantic error as a path, what was found, and what was expected."""
    path, parent = _walk(model, error["loc"])
    found = short_json(error["input"])
    context = error.get("ctx", {})
    match error["type"]:
        case "extra_forbidden":
            of_parent = parent.model_fields if parent else {}
            known = sorted(field.alias or name for name, field in of_parent.items())
            tail = library.nearest(str(error["loc"][-1]), known)
            return Problem(path, f"unknown field{tail}")
        case "missing":
            return Problem(path, "missing; it is required")
        case "union_tag_not_found":
            return Problem(path, f"field {context['discriminator']} is missing in {found}")
        case "union_tag_invalid":
            known = [tag.strip(" '") for tag in str(context["expected_tags"]).split(",")]
            tail = library.nearest(str(context["tag"]), known)
            field = str(context["discriminator"]).strip("'")
            return Problem(
                f"{path}/{field}", f"found {context['tag']!r}, expected {', '.join(known)}{tail}"
            )
        case "model_type" | "model_attributes_type" | "dict_type":
            required = [name for name, field in model.model_fields.items() if field.is_required()]
            fields = f" with the fields {', '.join(required)}" if required and not path else ""
            return Problem(path, f"found {found}, expected a JSON object{fields}")
        case "tuple_type" | "list_type":
            return Problem(path, f"found {found}, expected a JSON list")
        case "value_error":
            return Problem(path, str(context["error"]))
        case "literal_error":
            return Problem(path, f"found {found}, expected {context['expected']}")
        case _:
            message = str(error["msg"])
            return Problem(path, f"found {found}: {message[0].lower()}{message[1:]}")


def short_json(value: Any) -> str:
    """Return a value as JSON, cut to 60 characters."""
    text = json.dumps(value, default=str)
    return text if len(text) <= 60 else text[:57] + "..."


def _walk(model: type[BaseModel], loc: Sequence[str | int]) -> tuple[str, type[BaseModel] | None]:
    """Return a pydantic location as a JSON path (without union tags) and its last model."""
    annotation: Any = model
    parent: type[BaseModel] | None = None
    chunks: list[str] = []
    for part in loc:
        tagged = _members(annotation)
        members = [member for _, member in tagged]
        chosen = [member for tag, member in tagged if tag == part]
        if len(members) > 1 and chosen:
            annotation = chosen[0]
            continue
        chunks.append(str(part))
        if isinstance(part, int):
            arguments = typing.get_args(annotation)
            annotation = arguments[0] if arguments else None
            continue
        parent = next((member for member in members if _is_model(member)), None)
        field = parent.model_fields.get(part) if parent else None
        annotation = field.annotation if field else None
    return "/".join(chunks), parent


def _members(annotation: Any) -> list[tuple[str | None, Any]]:
    """Return the members of a union with their tags, or the annotation alone, without None."""
    given: str | None = None
    while typing.get_origin(annotation) is typing.Annotated:
        annotation, *metadata = typing.get_args(annotation)
        given = next((each.tag for each in metadata if isinstance(each, Tag)), given)
    if typing.get_origin(annotation) in (typing.Union, types.UnionType):
        inner = [a for a in typing.get_args(annotation) if a is not type(None)]
        return [member for a in inner for member in _members(a)]
    return [(given or _tag(annotation), annotation)]


def _is_model(annotation: Any) -> bool:
    return isinstance(annotation, type) and issubclass(annotation, BaseModel)


def _tag(annotation: Any) -> str | None:
    """Return the literal by which a member of a discriminated union is known."""
    if _is_model(annotation):
        for field in ("type", "action"):
            if field in annotation.model_fields:
                literals = typing.get_args(annotation.model_fields[field].annotation)
                return str(literals[0]) if literals else None
    return None
