"""Outlines of bodies as seen from above: corners right of and ahead of the reference point."""

from __future__ import annotations

import functools
import math

import numpy as np
import numpy.typing as npt

from airhilt.shapes.aircraft.spec import (
    TAIL_CHORD_SHARE,
    TAIL_ROOT_SHARE,
    WING_ROOT_SHARE,
    AircraftShape,
)

Points = npt.NDArray[np.float64]
"""Points right of and ahead of a body, or east and north, in m; shape (n, 2)."""


@functools.lru_cache(maxsize=64)
def aircraft_outline(aircraft: AircraftShape) -> Points:
    """Return the corners of an aircraft's fuselage, swept wing and tailplane as one polygon."""
    length, half_span = aircraft.dimensions.length_m, aircraft.dimensions.span_m / 2.0
    mesh = aircraft.mesh
    half_width = mesh.fuselage_diameter_m / 2.0
    nose = length / 2.0
    swept = math.tan(math.radians(mesh.wing_sweep_deg)) * (half_span - half_width)
    wing = WING_ROOT_SHARE * length
    tail, chord = TAIL_ROOT_SHARE * length, TAIL_CHORD_SHARE * length
    right = [
        (half_width, nose - half_width),
        (half_width, wing),
        (half_span, wing - swept),
        (half_span, wing - swept - mesh.wing_tip_chord_m),
        (half_width, wing - mesh.wing_root_chord_m),
        (half_width, tail),
        (mesh.tail_span_m / 2.0, tail - chord / 2.0),
        (mesh.tail_span_m / 2.0, tail - chord),
        (half_width, tail - chord),
        (half_width, nose - length),
    ]
    left = [(-aside, ahead) for aside, ahead in reversed(right)]
    return np.array([(0.0, nose), *right, *left])


def turned(points: Points, heading_rad: float) -> Points:
    """Return points right of and ahead of a body as points east and north of it."""
    sin, cos = math.sin(heading_rad), math.cos(heading_rad)
    right, ahead = points[:, 0], points[:, 1]
    return np.column_stack((right * cos + ahead * sin, ahead * cos - right * sin))
