"""Tables of an evaluation: cells with estimates, as JSON and as Markdown."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Literal

from pydantic import BaseModel, ConfigDict, Field

from airhilt.metrics.estimates import Estimate

NOTHING = "-"
"""Text of a cell without a number."""


class Quantity(BaseModel):
    """A number over many runs, with its 95 % interval."""

    model_config = ConfigDict(extra="forbid", frozen=True)
    value: float | None = Field(description="the number; null: there are no runs for it")
    low: float | None = Field(description="lower end of the interval; null: too few runs")
    high: float | None = Field(description="upper end of the interval")
    n: int = Field(description="number of runs that it rests on")
    text: str = Field(description="how tables write it")


Cell = Quantity | int | str


class Scatter(BaseModel):
    """The figure of a table: two of its columns against each other.

    Rows that begin with the same cell, one after the other, are one series.
    """

    model_config = ConfigDict(extra="forbid", frozen=True)
    x: str
    y: str
    x_scale: Literal["linear", "symlog"] = Field(
        default="linear", description="symlog: by the logarithm from 1 on, as rates need it"
    )


class Table(BaseModel):
    """One table of an evaluation."""

    model_config = ConfigDict(extra="forbid", frozen=True)
    name: str = Field(description="short name, for programs")
    title: str
    columns: tuple[str, ...]
    rows: tuple[tuple[Cell, ...], ...]
    notes: tuple[str, ...] = Field(default=(), description="sentences that belong to the table")
    figure: Scatter | None = Field(default=None, description="its figure, if it has one")

    def markdown(self) -> str:
        """Return the table as Markdown, with its title in front and its notes after it."""
        texts = [[_text(cell) for cell in row] for row in self.rows]
        widths = [
            max(len(text) for text in column) for column in zip(self.columns, *texts, strict=True)
        ]
        rule = "|".join("-" * (width + 2) for width in widths)
        lines = [_line(self.columns, widths), f"|{rule}|", *(_line(row, widths) for row in texts)]
        parts = [f"**{self.title}**", "\n".join(lines), *self.notes]
        return "\n\n".join(parts) + "\n"


def share(found: Estimate) -> Quantity:
    """Return a share of runs as a cell: ``13 of 18 (49 to 88 %)``."""
    return _quantity(found, lambda value: f"{round(value * found.n)} of {found.n}", _percent, " %")


def percent(found: Estimate) -> Quantity:
    """Return a share that is not one of runs as a cell: ``72 % (49 to 88 %)``."""
    return _quantity(found, lambda value: f"{_percent(value)} %", _percent, " %")


def number(found: Estimate, digits: int = 1) -> Quantity:
    """Return a number as a cell: ``7.4 (7.3 to 7.6)``; zero has no sign."""

    def written(value: float) -> str:
        return f"{round(value, digits) + 0.0:.{digits}f}"

    return _quantity(found, written, written)


def _percent(share: float) -> str:
    """Return a share in percent, with one digit where it is above 0 and below 1 %."""
    digits = 1 if 0.0 < share < 0.01 else 0
    return f"{100.0 * share:.{digits}f}"


def _quantity(
    found: Estimate, value: Callable[[float], str], end: Callable[[float], str], unit: str = ""
) -> Quantity:
    """Return an estimate with its text: its value, and the ends of its interval in brackets."""
    text = NOTHING if found.value is None else value(found.value)
    if found.value is not None and found.low is not None and found.high is not None:
        text += f" ({end(found.low)} to {end(found.high)}{unit})"
    return Quantity(value=found.value, low=found.low, high=found.high, n=found.n, text=text)


def _text(cell: Cell) -> str:
    return cell.text if isinstance(cell, Quantity) else str(cell)


def _line(texts: Sequence[str], widths: Sequence[int]) -> str:
    cells = " | ".join(text.ljust(width) for text, width in zip(texts, widths, strict=True))
    return f"| {cells} |"
