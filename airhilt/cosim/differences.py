"""The first field in which two JSON documents differ."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import zip_longest
from typing import Any

LONGEST_VALUE = 200
"""Greatest number of characters of a value that is shown."""


def first_difference(was: Any, now_is: Any, path: str = "") -> str:
    """Return the path of the first field that differs, with its value then and now.

    Parameters
    ----------
    path
        Path of the two documents themselves.
    """
    for name, before, after in _fields(was, now_is):
        if before != after:
            return first_difference(before, after, f"{path}/{name}")
    return f"{path}: recorded {_shown(was)}, now {_shown(now_is)}"


def _fields(was: Any, now_is: Any) -> Iterator[tuple[str, Any, Any]]:
    if isinstance(was, dict) and isinstance(now_is, dict):
        for key in sorted({*was, *now_is}):
            yield key, was.get(key), now_is.get(key)
    elif isinstance(was, list) and isinstance(now_is, list):
        for index, (before, after) in enumerate(zip_longest(was, now_is)):
            yield str(index), before, after


def _shown(value: Any) -> str:
    text = repr(value)
    return text if len(text) <= LONGEST_VALUE else f"{text[:LONGEST_VALUE]}..."
