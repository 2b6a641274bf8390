"""Texts of a run in the lengths and forms in which the page shows them."""

from __future__ import annotations

MOST_CHARACTERS = 400
"""Greatest length of one text: a worker may write as much as it likes."""


def cut(text: str) -> str:
    """Return a text that is not too long."""
    return text if len(text) <= MOST_CHARACTERS else text[: MOST_CHARACTERS - 1] + "…"


def runway_name(key: str) -> str:
    """Return the name of a runway, such as ``01/19``, for ``01-19`` in a key."""
    return key.replace("-", "/")
