"""Measures that all parts of an aircraft's mesh share."""

from __future__ import annotations

import math
from dataclasses import dataclass

from airhilt.shapes.aircraft.spec import WING_ROOT_SHARE, AircraftMesh, AircraftShape
from airhilt.shapes.colours import SILVER, WHITE
from airhilt.shapes.mesh import Colour, srgb

SEGMENTS, COARSE_SEGMENTS = 28, 12
"""Corners of a cross-section of the fuselage."""


@dataclass(frozen=True)
class Livery:
    """The colours of an aircraft."""

    body: Colour
    belly: Colour
    tail: Colour
    stripe: Colour
    wing: Colour
    engine: Colour


_NAVY, _CRIMSON, _PINE = srgb(24, 62, 140), srgb(176, 28, 44), srgb(30, 70, 60)
_PALE, _STEEL, _IVORY = srgb(196, 202, 210), srgb(176, 182, 190), srgb(240, 236, 222)
_SAND, _TEAL, _AMBER, _NIGHT = (
    srgb(222, 206, 170),
    srgb(14, 122, 128),
    srgb(236, 150, 30),
    srgb(22, 30, 56),
)
_AIRLINES = (
    Livery(WHITE, _PALE, _NAVY, _NAVY, SILVER, WHITE),
    Livery(WHITE, _STEEL, _CRIMSON, srgb(28, 44, 96), SILVER, srgb(200, 204, 210)),
    Livery(_NIGHT, _NIGHT, _AMBER, _AMBER, SILVER, _NIGHT),
    Livery(SILVER, SILVER, _NAVY, _CRIMSON, SILVER, SILVER),
    Livery(WHITE, WHITE, _TEAL, WHITE, _PALE, _TEAL),
    Livery(_AMBER, _AMBER, WHITE, WHITE, SILVER, _AMBER),
    Livery(_SAND, WHITE, _PINE, _SAND, SILVER, WHITE),
    Livery(_TEAL, WHITE, _TEAL, WHITE, SILVER, _TEAL),
)
_OWNERS = (
    Livery(WHITE, WHITE, srgb(180, 30, 34), srgb(180, 30, 34), WHITE, srgb(180, 30, 34)),
    Livery(_IVORY, _PINE, _PINE, srgb(196, 150, 40), _IVORY, _PINE),
    Livery(WHITE, WHITE, WHITE, _NAVY, WHITE, WHITE),
    Livery(srgb(228, 196, 40), srgb(228, 196, 40), _NIGHT, _NIGHT, srgb(228, 196, 40), _NIGHT),
    Livery(WHITE, _NAVY, _NAVY, WHITE, WHITE, _NAVY),
    Livery(_SAND, _SAND, srgb(120, 52, 24), srgb(120, 52, 24), _SAND, _SAND),
)
LIVERIES = {
    "jet": _AIRLINES,
    "heavy_jet": (*_AIRLINES[1:], _AIRLINES[0]),
    "piston_single": _OWNERS,
    "piston_twin": (*_OWNERS[1:], _OWNERS[0]),
}
"""Liveries by category; the first one is that of an aircraft of which no more is known."""


@dataclass(frozen=True)
class Proportions:
    """Measures of an aircraft that several of its parts need, in m, and how it is drawn."""

    mesh: AircraftMesh
    """The free shape parameters of its type."""
    livery: Livery
    coarse: bool
    """True if it is drawn with few triangles."""
    is_jet: bool
    is_heavy: bool
    is_single: bool
    length: float
    half_span: float
    radius: float
    """Radius of the fuselage."""
    ground: float
    """Height of the ground below the reference point, when it stands on its wheels; negative."""
    fin_top: float
    """Height of the top of the fin above the reference point."""
    axis: float
    """Height of the fuselage's axis above the reference point: fins of jets stand on top of the
    fuselage, those of others on the tail cone."""

    @classmethod
    def of(cls, aircraft: AircraftShape, coarse: bool = False, livery: int = 0) -> Proportions:
        """Return the proportions of an aircraft type."""
        liveries = LIVERIES[aircraft.category]
        size, mesh = aircraft.dimensions, aircraft.mesh
        is_jet = aircraft.category in ("jet", "heavy_jet")
        radius = mesh.fuselage_diameter_m / 2.0
        fin_top = size.height_m - size.wheel_height_offset_m
        return cls(
            mesh=mesh,
            livery=liveries[livery % len(liveries)],
            coarse=coarse,
            is_jet=is_jet,
            is_heavy=aircraft.category == "heavy_jet",
            is_single=aircraft.category == "piston_single",
            length=size.length_m,
            half_span=size.span_m / 2.0,
            radius=radius,
            ground=-size.wheel_height_offset_m,
            fin_top=fin_top,
            axis=fin_top - mesh.fin_height_m - (radius if is_jet else 0.0),
        )

    @property
    def segments(self) -> int:
        """Corners of a cross-section of the fuselage."""
        return COARSE_SEGMENTS if self.coarse else SEGMENTS

    @property
    def is_high_wing(self) -> bool:
        """True if the wing is above the fuselage."""
        return self.mesh.wing_position == "high"

    @property
    def wing_root_up(self) -> float:
        """Height of the wing at its root."""
        return self.axis + (1.22 if self.is_high_wing else -0.5) * self.radius

    @property
    def dihedral(self) -> float:
        """Slope of the wing, upwards and outwards."""
        degrees = 6.0 if self.is_jet else 1.7 if self.is_high_wing else 5.0
        return math.tan(math.radians(degrees))

    @property
    def wing_tip(self) -> tuple[float, float, float]:
        """Leading edge of the right wing tip: right, ahead, up."""
        out = self.half_span - self.radius
        back = math.tan(math.radians(self.mesh.wing_sweep_deg)) * out
        up = self.wing_root_up + self.dihedral * out
        return self.half_span, WING_ROOT_SHARE * self.length - back, up
