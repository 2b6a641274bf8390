"""Limits of lenses, for cameras of scenarios and of airports."""

from __future__ import annotations

from typing import Annotated

from pydantic import Field

NARROWEST_DEG = 0.1
WIDEST_DEG = 170.0
SMALLEST_SIDE_PX = 16
GREATEST_SIDE_PX = 4096

FieldOfView = Annotated[float, Field(ge=NARROWEST_DEG, le=WIDEST_DEG)]
"""Horizontal field of view in degrees."""
SidePx = Annotated[int, Field(ge=SMALLEST_SIDE_PX, le=GREATEST_SIDE_PX)]
"""Width or height of a picture in pixels."""
