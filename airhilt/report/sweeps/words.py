"""Numbers and estimates in words."""

from __future__ import annotations

from airhilt.metrics.estimates import Estimate

MINUS = "\u2212"
SPACE = "\u202f"
"""Narrow space that does not break, between a number and its unit."""


def number(value: float) -> str:
    """Return a number with three significant digits or so."""
    size = abs(value)
    digits = 0 if size >= 100 else 1 if size >= 10 else 2
    text = f"{value:,.{digits}f}".replace(",", SPACE)
    return text.replace("-", "" if float(f"{value:.{digits}f}") == 0 else MINUS)


def short(value: float, unit: str) -> str:
    """Return a number for a cell of a heat map: a percentage as a whole number."""
    return number(round(value)).split(".")[0] if unit == "%" else number(value)


def estimate(found: Estimate, unit: str) -> tuple[str, str]:
    """Return an estimate and its interval in words; the first is a dash if nothing is known."""
    if found.value is None:
        return "–", ""
    text = f"{short(found.value, unit)}{SPACE}{unit}" if unit else short(found.value, unit)
    if found.low is None or found.high is None:
        return text, ""
    return text, f"{short(found.low, unit)} to {short(found.high, unit)}"
