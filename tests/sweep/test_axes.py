"""Values of axes, as people write them and as sweep files have them."""

from __future__ import annotations

import math
from itertools import pairwise

import pytest
from hypothesis import given
from hypothesis import strategies as st
from pydantic import ValidationError

from airhilt.errors import AirhiltError
from airhilt.sweep.axes import Interval, Range, listed, read_values


@pytest.mark.parametrize(
    ("text", "values"),
    [
        ("0:20:5", (0, 5, 10, 15, 20)),
        ("0:19:5", (0, 5, 10, 15)),
        ("-0.1:0.2:0.1", (-0.1, 0, 0.1, 0.2)),
        ("7:7:1", (7,)),
        ("log:1:1000:4", (1, 10, 100, 1000)),
        ("reference, 400", ("reference", 400)),
        ("true,false,null", (True, False, None)),
        ('["fixed,asr=fixed:2", "measured"]', ("fixed,asr=fixed:2", "measured")),
        ("lognormal:0.5", ("lognormal:0.5",)),
    ],
)
def test_what_a_person_writes_gives_values(text: str, values: tuple[object, ...]) -> None:
    found = read_values(text)
    assert not isinstance(found, Interval) or isinstance(found, Range)
    assert listed(found) == values
    assert [type(value) for value in listed(found)] == [type(value) for value in values]


def test_two_numbers_are_an_interval_to_draw_from() -> None:
    assert read_values("0:20") == Interval.model_validate({"from": 0, "to": 20})
    assert read_values("log:1:100") == Interval.model_validate(
        {"from": 1, "to": 100, "scale": "log"}
    )


@pytest.mark.parametrize(
    ("text", "problem"),
    [
        ("1,,2", "one is empty"),
        ("20:0:5", "smaller end first"),
        ("0:20:-5", "greater than 0"),
        ("0:1e9:0.001", "more than 1000000 values"),
        ("log:0:10:3", "positive"),
        ("log:1:10:2.5", "integer"),
        ("0:nan:1", "finite"),
        ("[1, 2", "no JSON"),
        ("[]", "at least 1"),
    ],
)
def test_values_that_cannot_be_say_why(text: str, problem: str) -> None:
    with pytest.raises((AirhiltError, ValidationError), match=problem):
        read_values(text)


@given(
    start=st.integers(-1000, 1000),
    steps=st.integers(0, 200),
    step=st.integers(1, 99),
    scale=st.sampled_from([1, 10, 100, 1000]),
)
def test_a_range_has_its_end_whatever_the_step(
    start: int, steps: int, step: int, scale: int
) -> None:
    """Steps such as 0.1 are no binary numbers, and must not lose the last value."""
    end = start + steps * step
    found = Range.model_validate({"from": start / scale, "to": end / scale, "step": step / scale})
    assert len(found.values()) == steps + 1
    assert found.values()[-1] == pytest.approx(end / scale, rel=1e-11, abs=1e-11)


@given(low=st.floats(1e-3, 1e3), factor=st.floats(1.5, 1e3), count=st.integers(2, 50))
def test_a_log_range_has_even_ratios_and_both_ends(low: float, factor: float, count: int) -> None:
    found = Range.model_validate(
        {"from": low, "to": low * factor, "scale": "log", "count": count}
    ).values()
    ratios = {round(math.log(b / a), 6) for a, b in pairwise(found)}
    assert max(ratios) - min(ratios) < 1e-5
    assert (found[0], found[-1]) == pytest.approx((low, low * factor), rel=1e-9)
