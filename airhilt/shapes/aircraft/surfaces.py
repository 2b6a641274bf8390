"""The wings and the tail of an aircraft."""

from __future__ import annotations

import math

import numpy as np

from airhilt.shapes.aircraft.proportions import Proportions
from airhilt.shapes.aircraft.spec import TAIL_CHORD_SHARE, TAIL_ROOT_SHARE, WING_ROOT_SHARE
from airhilt.shapes.mesh import Colour, Floats, Mesh, Paint, ellipsoid, join, loft, tube

_AEROFOIL = [
    (1.0, 0.0), (0.6, 0.34), (0.3, 0.5), (0.08, 0.34), (0.0, 0.0), (0.08, -0.22), (0.3, -0.34),
    (0.6, -0.2),
]  # fmt: skip
"""Corners of a wing section: aft of the leading edge in chords, and up in thicknesses."""


def wing(p: Proportions) -> Mesh:
    """Return the right wing, of a jet with its winglet and flap fairings."""
    shape, radius = p.mesh, p.radius
    root_at = WING_ROOT_SHARE * p.length
    up, dihedral = p.wing_root_up, p.dihedral
    sweep = math.tan(math.radians(shape.wing_sweep_deg))
    sections = []
    for part in (0.0, 0.33, 1.0) if p.coarse else (0.0, 0.33, 0.66, 1.0):
        out = 0.3 * radius + part * (p.half_span - 0.3 * radius)
        past = max(out - radius, 0.0)
        straight = shape.wing_root_chord_m + part * (
            shape.wing_tip_chord_m - shape.wing_root_chord_m
        )
        sections.append((out, root_at - sweep * past, up + dihedral * past, straight))
    if not p.is_jet:
        return _surface(sections, 0.14, lambda centres: _wing_paint(p, centres))
    wing = _surface(sections, 0.13, p.livery.wing)
    tip_out, tip_at, tip_up, chord = sections[-1]
    rise = 0.07 * p.half_span
    winglet = _blade(
        [(tip_out - 0.05, tip_at, tip_up), (tip_out + 0.35 * rise, tip_at - 0.9 * rise,
         tip_up + rise)], (chord, 0.45 * chord), 0.08, p.livery.tail
    )  # fmt: skip
    if p.coarse:
        return join([wing, winglet])
    fairings = [
        ellipsoid(p.livery.wing, 0.12 * radius, 0.32 * chord_here, 0.16 * radius, 8, 7)
        .moved(out, at - 0.92 * chord_here, height - 0.14 * radius)
        for out, at, height, chord_here in sections[1:3]
    ]  # fmt: skip
    return join([wing, winglet, *fairings])


def _wing_paint(p: Proportions, centres: Floats) -> Floats:
    colours = np.tile(np.asarray(p.livery.wing, dtype=np.float32), (len(centres), 1))
    colours[centres[:, 0] > 0.8 * p.half_span] = p.livery.tail
    return colours


def tailplane(p: Proportions) -> Mesh:
    """Return the right half of the tailplane."""
    at = TAIL_ROOT_SHARE * p.length
    chord = TAIL_CHORD_SHARE * p.length
    half = p.mesh.tail_span_m / 2.0
    sweep = math.tan(math.radians(p.mesh.wing_sweep_deg + 5.0)) if p.is_jet else 0.12
    up = p.axis + (0.42 * p.radius if p.is_jet else 0.2 * p.radius)
    rise = 0.12 if p.is_jet else 0.0
    sections = [
        (part * half, at - sweep * part * half, up + rise * part * half,
         chord * (1.15 - 0.65 * part))
        for part in ((0.0, 1.0) if p.coarse else (0.0, 0.5, 1.0))
    ]  # fmt: skip
    colour = p.livery.wing if p.is_jet else p.livery.body
    return _surface(sections, 0.1, colour)


def fin(p: Proportions) -> Mesh:
    """Return the fin."""
    at = TAIL_ROOT_SHARE * p.length + (0.055 if p.is_jet else 0.02) * p.length
    chord = TAIL_CHORD_SHARE * p.length * (1.75 if p.is_jet else 1.5)
    bottom = p.axis + (0.55 * p.radius if p.is_jet else 0.1 * p.radius)
    rise = p.fin_top - bottom
    slope = math.tan(math.radians(40.0 if p.is_jet else 28.0))
    chords = (chord, 0.36 * chord if p.is_jet else 0.5 * chord)
    return _blade(
        [(0.0, at, bottom), (0.0, at - slope * rise, p.fin_top)],
        chords,
        0.1,
        p.livery.tail,
    )


def strut(p: Proportions) -> Mesh:
    """Return the right strut of a high wing."""
    wing_up = p.axis + 1.2 * p.radius
    ahead = WING_ROOT_SHARE * p.length - 0.3 * p.mesh.wing_root_chord_m
    return tube(
        (0.9 * p.radius, ahead, p.axis - 0.7 * p.radius),
        (0.48 * p.half_span, ahead, wing_up),
        (0.05, 0.05),
        p.livery.body,
    )


def _surface(
    sections: list[tuple[float, float, float, float]], thickness: float, colour: Colour | Paint
) -> Mesh:
    """Return a wing: leading edges (right, ahead, up) and chords, from the root outwards."""
    rings = [
        [(out, at - chord * x, up + chord * thickness * z) for x, z in _AEROFOIL]
        for out, at, up, chord in sections
    ]
    return loft(rings, colour, closed=True)


def _blade(
    edge: list[tuple[float, float, float]],
    chords: tuple[float, float],
    thickness: float,
    colour: Colour,
) -> Mesh:
    """Return an upright surface, given by its leading edge from the bottom up."""
    rings = [
        [(right + chord * thickness * z, at - chord * x, up) for x, z in _AEROFOIL][::-1]
        for (right, at, up), chord in zip(edge, chords, strict=True)
    ]
    return loft(rings, colour, closed=True)
