"""Parameters and examples of which a few show the behaviour; all are tried when asked for."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import pytest
from hypothesis import settings

USUAL_EXAMPLES = 100
"""Number of examples that Hypothesis tries unless a profile says otherwise."""


def mostly_slow(values: Iterable[Any], *quick: Any) -> list[Any]:
    """Return parameters: the quick ones as they are, and all others behind the marker slow.

    A value for several names is a tuple.
    """
    every = list(values)
    assert all(value in every for value in quick), f"{quick} are not all among {every}"
    return [value if value in quick else _slow(value) for value in every]


def examples(most: int) -> settings:
    """Return settings of a property: a third of the examples, or all with the profile `long`."""
    is_long = settings().max_examples > USUAL_EXAMPLES
    return settings(max_examples=most if is_long else -(-most // 3))


def _slow(value: Any) -> Any:
    values = value if isinstance(value, tuple) else (value,)
    return pytest.param(*values, marks=pytest.mark.slow)
