"""Values of one parameter: lists, and ranges with even steps or even ratios."""

from __future__ import annotations

import json
import math
from typing import Annotated, Literal

from pydantic import (
    BaseModel,
    ConfigDict,
    Discriminator,
    Field,
    JsonValue,
    Tag,
    ValidationError,
    model_validator,
)

from airhilt.errors import AirhiltError, first_problem, shown

MOST_VALUES = 1_000_000
"""Values that one axis may have."""
DIGITS = 12
"""Significant digits of a value in a range: 0.1 * 3 is 0.3."""

Number = Annotated[float, Field(allow_inf_nan=False)]


class Interval(BaseModel):
    """All numbers between two ends; where samples are drawn from."""

    model_config = ConfigDict(extra="forbid", frozen=True, populate_by_name=True)
    start: Number = Field(alias="from", description="lower end")
    end: Number = Field(alias="to", description="upper end")
    scale: Literal["linear", "log"] = Field(
        default="linear", description="log: even in the logarithm"
    )

    @model_validator(mode="after")
    def _is_in_order(self) -> Interval:
        if self.end < self.start:
            raise ValueError(f"from {self.start:g} to {self.end:g}; expected the smaller end first")
        if self.scale == "log" and self.start <= 0.0:
            raise ValueError(f"from {self.start:g} on a log scale; expected a positive number")
        return self

    def at(self, share: float) -> float:
        """Return the value at a share (0 to 1) of the interval, along its scale."""
        if self.scale == "log":
            return _rounded(self.start * (self.end / self.start) ** share)
        return _rounded(self.start + (self.end - self.start) * share)


class Range(Interval):
    """Values from one end to the other, both ends included."""

    step: Annotated[float, Field(gt=0.0, allow_inf_nan=False)] | None = Field(
        default=None, description="difference of neighbours, on a linear scale"
    )
    count: Annotated[int, Field(ge=1, le=MOST_VALUES)] | None = Field(
        default=None, description="number of values"
    )

    @model_validator(mode="after")
    def _says_how_many(self) -> Range:
        if (self.step is None) == (self.count is None):
            raise ValueError("expected either a step or a count")
        if self.step is not None and self.scale == "log":
            raise ValueError("a log scale has no step; expected a count")
        if self.step is not None and (self.end - self.start) / self.step >= MOST_VALUES:
            raise ValueError(f"a step of {self.step:g} makes more than {MOST_VALUES} values")
        return self

    def values(self) -> tuple[float | int, ...]:
        """Return the values; integers if ends and step are integers.

        The last one is the end itself if a whole number of steps leads there.
        """
        if self.step is not None:
            steps = math.floor((self.end - self.start) / self.step * (1.0 + 1e-12) + 1e-9)
            return tuple(_plain(self.start + index * self.step) for index in range(steps + 1))
        assert self.count is not None
        last = max(self.count - 1, 1)
        return tuple(_plain(self.at(index / last)) for index in range(self.count))


def _form(values: object) -> str:
    return "range" if isinstance(values, dict | Range) else "list"


Values = Annotated[
    Annotated[Range, Tag("range")]
    | Annotated[tuple[JsonValue, ...], Field(min_length=1), Tag("list")],
    Discriminator(_form),
]
"""Values of an axis, as a sweep file has them."""


def listed(values: Range | tuple[JsonValue, ...]) -> tuple[JsonValue, ...]:
    """Return the values of an axis one by one."""
    return values.values() if isinstance(values, Range) else values


def read_values(text: str) -> Range | Interval | tuple[JsonValue, ...]:
    """Return what a person writes for the values of a parameter on the command line.

    ``0:20:5`` is a range with its end, ``log:1:100:5`` five values in even ratios, ``0:20`` an
    interval to draw samples from, ``a,b`` and ``[1, 2]`` (JSON) are lists.

    Raises
    ------
    AirhiltError
        It is empty, or a range that cannot be.
    """
    text = text.strip()
    if text.startswith(("[", "{", '"')):
        try:
            found = json.loads(text)
        except json.JSONDecodeError as error:
            raise AirhiltError(f"values {shown(text)}: no JSON: {error.msg}") from None
        if found == []:
            raise AirhiltError("values []: expected at least 1")
        return tuple(found) if isinstance(found, list) else (found,)
    range_given = _read_range(text)
    if range_given is not None:
        return range_given
    parts = [part.strip() for part in text.split(",")]
    if not all(parts):
        raise AirhiltError(
            f"values {shown(text)}: one is empty; expected such as 1,2,3 or 0:20:5 or log:1:100:5"
        )
    return tuple(read_value(part) for part in parts)


def read_value(text: str) -> JsonValue:
    """Return one value: a number, true, false or null as in JSON, otherwise the text itself."""
    try:
        value = json.loads(text)
    except json.JSONDecodeError:
        return text
    return value if isinstance(value, int | float | bool) or value is None else text


def _read_range(text: str) -> Range | Interval | None:
    """Return the range or interval in a text, None if it is not written as one."""
    is_log = text.startswith("log:")
    parts = text.removeprefix("log:").split(":")
    if len(parts) not in (2, 3):
        return None
    try:
        numbers = [float(part) for part in parts]
    except ValueError:
        return None
    ends = {"from": numbers[0], "to": numbers[1], "scale": "log" if is_log else "linear"}
    try:
        if len(numbers) == 2:
            return Interval.model_validate(ends)
        last = {"count": parts[2]} if is_log else {"step": numbers[2]}
        return Range.model_validate(ends | last)
    except ValidationError as error:
        raise AirhiltError(f"values {text}: {first_problem(error)}") from None


def _rounded(value: float) -> float:
    return float(f"{value:.{DIGITS}g}")


def _plain(value: float) -> float | int:
    rounded = _rounded(value)
    return int(rounded) if rounded.is_integer() and abs(rounded) < 2**53 else rounded
