"""The first field in which two documents differ is named."""

from __future__ import annotations

from typing import Any

import pytest

from airhilt.cosim.differences import LONGEST_VALUE, first_difference


@pytest.mark.parametrize(
    ("was", "now_is", "difference"),
    [
        ({"a": 1, "b": 2}, {"a": 1, "b": 3}, "/b: recorded 2, now 3"),
        ({"a": {"b": "x"}}, {"a": {}}, "/a/b: recorded 'x', now None"),
        ({"a": [1, {"b": 2}]}, {"a": [1, {"b": 4}]}, "/a/1/b: recorded 2, now 4"),
        ({"a": [1]}, {"a": [1, 7]}, "/a/1: recorded None, now 7"),
        ({"a": []}, {"a": [None]}, "/a: recorded [], now [None]"),
        ({"a": 1}, [1], ": recorded {'a': 1}, now [1]"),
    ],
)
def test_the_first_field_that_differs_is_named(was: Any, now_is: Any, difference: str) -> None:
    assert first_difference(was, now_is) == difference
    assert first_difference(was, now_is, "key") == f"key{difference}"


def test_a_long_value_is_cut() -> None:
    assert len(first_difference("x" * 10_000, 1)) < LONGEST_VALUE + 50
