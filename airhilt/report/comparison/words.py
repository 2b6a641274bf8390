"""Comparisons in words, for the terminal and for pages."""

from __future__ import annotations

from typing import Any

from airhilt.metrics.columns import Value
from airhilt.report.comparison.runs import MetricDifference
from airhilt.report.comparison.sweeps import MeasureDifference
from airhilt.report.sweeps.words import MINUS, SPACE, estimate, number

Json = dict[str, Any]

LEAST_P = 0.001


def signed(value: float) -> str:
    """Return a number with its sign."""
    text = number(value)
    return text if value <= 0 or text.startswith(MINUS) else f"+{text}"


def p_value(value: float) -> str:
    """Return a probability with two digits, or that it is smaller than a thousandth."""
    return f"< {LEAST_P}" if value < LEAST_P else f"{value:.3f}"


def measure_row(found: MeasureDifference) -> Json:
    """Return one measure of two sides as the texts of a row."""
    unit, difference, test = found.measure.unit, found.difference, found.test
    change, interval = "–", ""
    if difference.value is not None:
        change = f"{signed(difference.value)}{SPACE}{'points' if unit == '%' else unit}"
    is_clear = False
    if difference.low is not None and difference.high is not None:
        interval = f"{signed(difference.low)} to {signed(difference.high)}"
        is_clear = difference.low > 0.0 or difference.high < 0.0
    return {
        "title": found.measure.title,
        "first": estimate(found.first, unit),
        "second": estimate(found.second, unit),
        "difference": (change, interval),
        "split": f"{test.only_first} : {test.only_second}" if test else "",
        "p_value": p_value(test.p_value) if test else "",
        "pairs": difference.n,
        "one_sided": found.one_sided,
        "is_clear": is_clear,
    }


def metric_row(found: MetricDifference) -> Json:
    """Return one metric of two runs as the texts of a row."""
    return {
        "name": found.name,
        "unit": "" if found.unit == "1" else found.unit,
        "first": value_text(found.first),
        "second": value_text(found.second),
        "difference": "" if found.difference is None else signed(found.difference),
    }


def value_text(value: Value) -> str:
    """Return a value of a column in words; a dash for null."""
    if value is None:
        return "–"
    if isinstance(value, bool):
        return "yes" if value else "no"
    return number(value) if isinstance(value, float) else str(value)
