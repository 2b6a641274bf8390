"""Reading JSON from untrusted files: size, depth and content are bounded."""

from __future__ import annotations

import json
import math
import re
from collections import Counter
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from airhilt.errors import ScenarioError
from airhilt.host import bounded_json
from airhilt.host.files import read_file
from airhilt.scenario.problems import Problem, error_for

MOST_BYTES = 5_000_000
"""Size of the largest file that is read."""
GREATEST_DEPTH = 24
"""Greatest number of lists and objects within each other; conditions nest by two a level."""
LONGEST_TEXT = 20_000
"""Greatest number of characters in a text."""
CONTROL_CHARACTER = re.compile(r"[\x00-\x08\x0b\x0c\x0e-\x1f]")
"""Control characters but tabulators and ends of lines."""
SURROGATE = re.compile("[\ud800-\udfff]")

Json = Any
"""JSON document, as `json.load` returns it."""


def read(path: Path) -> Json:
    """Return the document in a JSON file.

    Raises
    ------
    ScenarioError
        The file cannot be read, is too large, or is not UTF-8; or as `parse`.
    """
    try:
        text = read_file(path, MOST_BYTES).decode("utf-8-sig")
    except OSError as error:
        raise ScenarioError(f"{path}: cannot be read: {error.strerror}") from None
    except UnicodeDecodeError as error:
        raise ScenarioError(f"{path}: not UTF-8 text (byte {error.start})") from None
    return parse(text, str(path))


def parse(text: str, origin: str) -> Json:
    """Return the document in a JSON text, whose name in errors is ``origin``.

    Raises
    ------
    ScenarioError
        The text is not JSON, repeats a field, has too many values, or exceeds a limit of this
        module.
    """
    try:
        bounded_json.require_few_values(text.encode(errors="surrogatepass"))
        document = json.loads(text, object_pairs_hook=_object)
    except json.JSONDecodeError as error:
        raise ScenarioError(
            f"{origin}:{error.lineno}:{error.colno}: not valid JSON: {error.msg}"
        ) from None
    except RecursionError:
        raise error_for(origin, [_too_deep("")]) from None
    except ValueError as error:
        raise ScenarioError(f"{origin}: {error}") from None
    require_bounded(document, origin)
    return document


def require_bounded(document: Json, origin: str) -> None:
    """Check depth, numbers and texts of a document, whose name in errors is ``origin``.

    Raises
    ------
    ScenarioError
        The document is beyond a limit of this module.
    """
    if problems := list(_problems("", document, 0)):
        raise error_for(origin, problems)


class _Repeated(dict[str, Json]):
    """Object of which a field was given twice."""

    field = ""


def _object(pairs: list[tuple[str, Json]]) -> dict[str, Json]:
    found = dict(pairs)
    if len(found) == len(pairs):
        return found
    repeated = _Repeated(found)
    repeated.field = Counter(name for name, _ in pairs).most_common(1)[0][0]
    return repeated


def _problems(path: str, value: Json, depth: int) -> Iterator[Problem]:
    inner: dict[Any, Json] = {}
    match value:
        case dict() | list() | tuple() if depth == GREATEST_DEPTH:
            yield _too_deep(path)
        case dict():
            inner = value
        case list() | tuple():
            inner = dict(enumerate(value))
        case float() if not math.isfinite(value):
            yield Problem(path, "found a number that is not finite")
        case str():
            yield from _text_problems(path, value)
    if isinstance(value, _Repeated):
        yield Problem(path, f"found field {value.field!r} twice; expected it once")
    for name, each in inner.items():
        yield from _text_problems(path, str(name))
        yield from _problems(f"{path}/{name}" if path else str(name), each, depth + 1)


def _text_problems(path: str, text: str) -> Iterator[Problem]:
    if len(text) > LONGEST_TEXT:
        yield Problem(path, f"found a text of {len(text):,} characters; expected fewer")
    elif CONTROL_CHARACTER.search(text):
        yield Problem(path, "found a control character; expected a text without")
    elif SURROGATE.search(text):
        yield Problem(path, "found half of a surrogate pair; expected Unicode text")


def _too_deep(path: str) -> Problem:
    return Problem(
        path,
        f"nested too deeply; expected at most {GREATEST_DEPTH} lists and objects within each other",
    )
