"""Texts of a run in the forms in which the page shows them."""

from __future__ import annotations


def runway_name(key: str) -> str:
    """Return the name of a runway, such as ``01/19``, for ``01-19`` in a key."""
    return key.replace("-", "/")
