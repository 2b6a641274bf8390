"""Parameters of which a few show the behaviour; the others are tried when asked for."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import pytest


def mostly_slow(values: Iterable[Any], *quick: Any) -> list[Any]:
    """Return parameters: the quick ones as they are, and all others behind the marker slow.

    A value for several names is a tuple.
    """
    every = list(values)
    assert all(value in every for value in quick), f"{quick} are not all among {every}"
    return [value if value in quick else _slow(value) for value in every]


def _slow(value: Any) -> Any:
    values = value if isinstance(value, tuple) else (value,)
    return pytest.param(*values, marks=pytest.mark.slow)
