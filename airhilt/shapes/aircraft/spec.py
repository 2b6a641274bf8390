"""The numbers from which an aircraft is lofted: a part of its ``aircraft/*.json``."""

from __future__ import annotations

from typing import Annotated, Literal, Protocol

import pydantic
from pydantic import Field

from airhilt.quantities import Number

OffsetM = Annotated[Number, Field(ge=-200.0, le=200.0)]
"""Distance along one axis of an aircraft, in m."""
AircraftCategory = Literal["jet", "heavy_jet", "piston_single", "piston_twin"]

WING_ROOT_SHARE = 0.1
"""Distance from the reference point forward to the leading edge of the wing at the fuselage, as a
share of the length."""
TAIL_ROOT_SHARE = -0.38
"""Distance from the reference point forward to the leading edge of the tailplane at the fuselage,
as a share of the length."""
TAIL_CHORD_SHARE = 0.1
"""Chord of the tailplane, as a share of the length."""


class _Section(pydantic.BaseModel):
    model_config = pydantic.ConfigDict(extra="forbid", frozen=True, allow_inf_nan=False)


class AircraftDimensions(_Section):
    """Size of the real aircraft, and where the JSBSim model's wheels are."""

    length_m: Number = Field(gt=0, le=200)
    span_m: Number = Field(gt=0, le=200)
    height_m: Number = Field(gt=0, le=200)
    wheel_height_offset_m: Number = Field(ge=0, le=200)
    """Height of JSBSim's reference point above the ground when the model stands on its wheels."""


class AircraftMesh(_Section):
    """Free shape parameters for a lofted model; the rest follows from `AircraftDimensions`."""

    fuselage_diameter_m: Number = Field(gt=0, le=200)
    wing_sweep_deg: Number = Field(ge=-60, le=80)
    """Sweep of the quarter-chord line."""
    wing_root_chord_m: Number = Field(gt=0, le=200)
    wing_tip_chord_m: Number = Field(gt=0, le=200)
    wing_position: Literal["low", "high"]
    tail_span_m: Number = Field(gt=0, le=200)
    fin_height_m: Number = Field(gt=0, le=200)
    engines_m: tuple[tuple[OffsetM, OffsetM, OffsetM], ...] = Field(max_length=8)
    """Front of each engine: aft of the nose, right of the centre line, above the fuselage axis."""


class AircraftShape(Protocol):
    """Shape of an aircraft type: its category, its size and the numbers of its mesh."""

    @property
    def category(self) -> AircraftCategory: ...  # noqa: D102
    @property
    def dimensions(self) -> AircraftDimensions: ...  # noqa: D102
    @property
    def mesh(self) -> AircraftMesh: ...  # noqa: D102
    def __hash__(self) -> int: ...
