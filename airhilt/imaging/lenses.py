"""Limits of lenses, for cameras of scenarios and of airports."""

from __future__ import annotations

from typing import Annotated

from pydantic import Field

from airhilt.quantities import Count, Number

NARROWEST_DEG = 0.1
WIDEST_DEG = 170.0
SMALLEST_SIDE_PX = 16
GREATEST_SIDE_PX = 4096

FieldOfView = Annotated[Number, Field(ge=NARROWEST_DEG, le=WIDEST_DEG)]
"""Horizontal field of view in degrees."""
SidePx = Annotated[Count, Field(ge=SMALLEST_SIDE_PX, le=GREATEST_SIDE_PX)]
"""Width or height of a picture in pixels."""
