"""Limits of lenses, for cameras of scenarios and of airports."""

from __future__ import annotations

from typing import Annotated

from pydantic import Field

from airhilt.imaging import GREATEST_SIDE_PX, SMALLEST_SIDE_PX
from airhilt.quantities import Count, Number

FieldOfView = Annotated[Number, Field(ge=0.1, le=170.0)]
"""Horizontal field of view in degrees."""
SidePx = Annotated[Count, Field(ge=SMALLEST_SIDE_PX, le=GREATEST_SIDE_PX)]
"""Width or height of a picture in pixels."""
