"""The numbers from which an aircraft is lofted: a part of its ``aircraft/*.json``."""

from __future__ import annotations

from typing import Literal, Protocol

import pydantic
from pydantic import Field

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

    length_m: float = Field(gt=0)
    span_m: float = Field(gt=0)
    height_m: float = Field(gt=0)
    wheel_height_offset_m: float = Field(ge=0)
    """Height of JSBSim's reference point above the ground when the model stands on its wheels."""


class AircraftMesh(_Section):
    """Free shape parameters for a lofted model; the rest follows from `AircraftDimensions`."""

    fuselage_diameter_m: float = Field(gt=0)
    wing_sweep_deg: float
    """Sweep of the quarter-chord line."""
    wing_root_chord_m: float = Field(gt=0)
    wing_tip_chord_m: float = Field(gt=0)
    wing_position: Literal["low", "high"]
    tail_span_m: float = Field(gt=0)
    fin_height_m: float = Field(gt=0)
    engines_m: tuple[tuple[float, float, float], ...]
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
