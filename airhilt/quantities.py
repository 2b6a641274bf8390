"""Quantities of scenario files and commands: strict types, each with its unit and its bounds.

A strict number is neither ``true`` nor ``"19"``. A field whose bounds are its own is a `Number`:
pydantic applies bounds of field and type one after the other, and the last one wins. The bounds
are those of what can be simulated: a day, the atmosphere that aircraft fly in, and what a radio or
a radar reaches.
"""

from __future__ import annotations

import datetime
from typing import Annotated, Any

from pydantic import AfterValidator, BeforeValidator, Field, Strict
from pydantic_core import PydanticCustomError

LONGEST_RUN_S = 86_400.0
EARLIEST = datetime.date(1900, 1, 1)
LATEST = datetime.date(2100, 12, 31)
LEAST_MHZ, GREATEST_MHZ = 100, 1000


def _no_number(value: Any) -> Any:
    """Return a date or its text unchanged; pydantic alone would take a number for a Unix time."""
    if isinstance(value, int | float):
        raise PydanticCustomError("date_type", "expected a date, such as 2026-05-01")
    return value


def _of_our_time(date: datetime.date) -> datetime.date:
    """Return a date for which the position of the sun is known, unchanged."""
    if not EARLIEST <= date <= LATEST:
        raise PydanticCustomError("date_range", f"expected a date from {EARLIEST} to {LATEST}")
    return date


def _in_order(period_s: tuple[float, float]) -> tuple[float, float]:
    """Return a period that does not end before it begins, unchanged."""
    begin_s, end_s = period_s
    if begin_s >= end_s:
        raise PydanticCustomError("period", "it ends before it begins; expected [from, to]")
    return period_s


def _in_khz(value: Any) -> Any:
    """Return a frequency in kHz unchanged; a number that can only be meant in MHz is refused."""
    if isinstance(value, int | float) and GREATEST_MHZ > value > LEAST_MHZ:
        raise PydanticCustomError(
            "frequency_khz",
            "expected kHz, a whole number: {mhz} MHz is {khz}",
            {"mhz": f"{value:g}", "khz": round(value * 1000)},
        )
    return value


Flag = Annotated[bool, Strict()]
Count = Annotated[int, Strict()]
"""Whole number. Its field has the bounds."""
Number = Annotated[float, Strict()]
"""Number that may have a fraction. Its field has the bounds."""

Share = Annotated[Number, Field(ge=0.0, le=1.0)]
"""Probability, or part of a whole."""
TimeS = Annotated[Number, Field(ge=0.0, le=LONGEST_RUN_S)]
"""Time since the start of the run, in s."""
PeriodS = Annotated[tuple[TimeS, TimeS], AfterValidator(_in_order)]
"""Beginning and end of a period, in s since the start of the run."""
Date = Annotated[datetime.date, BeforeValidator(_no_number), AfterValidator(_of_our_time)]

AltitudeFt = Annotated[Number, Field(ge=-1500.0, le=60_000.0)]
"""Altitude above mean sea level, in ft; the lowest airport lies at -1,266 ft."""
HeightFt = Annotated[Number, Field(ge=0.0, le=60_000.0)]
"""Height above the ground, in ft."""
SpeedKt = Annotated[Number, Field(ge=0.0, le=1000.0)]
"""Speed in kt."""
VerticalRateFpm = Annotated[Number, Field(gt=0.0, le=20_000.0)]
"""Rate of climb or descent, in ft/min."""
DistanceNm = Annotated[Number, Field(ge=0.0, le=500.0)]
"""Distance in NM."""
SnrDb = Annotated[Number, Field(ge=-30.0, le=60.0)]
"""Signal-to-noise ratio in dB."""
FrequencyKhz = Annotated[Count, Field(ge=117_975, le=137_000), BeforeValidator(_in_khz)]
"""Name of a channel of the aeronautical VHF band with 25 or 8.33 kHz spacing, in kHz."""

FileName = Annotated[str, Field(min_length=1, max_length=200)]
"""Name that AIRHILT knows, or the path of a file, relative to what names it."""
Name = Annotated[str, Field(min_length=1, max_length=40)]
"""Name that people read, such as that of a unit."""
