"""The engines of an aircraft."""

from __future__ import annotations

import math

import numpy as np

from airhilt.shapes.aircraft.proportions import Proportions
from airhilt.shapes.colours import DARK, GREY, SILVER
from airhilt.shapes.mesh import Floats, Mesh, box, ellipsoid, join, loft, srgb, tube

BLADE = srgb(60, 60, 62)


def engine(p: Proportions, aft: float, right: float, above: float) -> Mesh:
    """Return an engine whose front is at a place aft of the nose, right, and above the axis."""
    front = p.length / 2.0 - aft
    up = p.axis + above
    if p.is_jet:
        return _turbofan(p, front, right, up)
    return _propeller(p, front, right, up)


def _turbofan(p: Proportions, front: float, right: float, up: float) -> Mesh:
    radius = 0.21 * p.mesh.fuselage_diameter_m + (0.2 if p.is_heavy else 0.15)
    length = 3.6 * radius
    sides = 8 if p.coarse else 20
    angles = np.linspace(0.0, math.tau, sides, endpoint=False)

    def ring(back: float, part: float) -> Floats:
        return np.column_stack((
            right + radius * part * np.cos(angles),
            np.full(sides, front - back * length),
            up + radius * part * np.sin(angles),
        )).astype(np.float32)[::-1]  # fmt: skip

    # The pylon, up and back to the wing.
    wing_up = p.axis - 0.45 * p.radius + 0.1 * (abs(right) - p.radius)
    pylon = box(p.livery.wing, 0.28 * radius, 0.75 * length, max(wing_up - up, 0.4))
    pylon = pylon.moved(right, front - 0.75 * length, up)

    def paint(centres: Floats) -> Floats:
        back = (front - centres[:, 1]) / length
        part = np.hypot(centres[:, 0] - right, centres[:, 2] - up) / radius
        colours = np.tile(np.asarray(p.livery.engine, dtype=np.float32), (len(back), 1))
        colours[(back < 0.12) & (part < 0.9)] = SILVER
        colours[(back < 0.12) & (part < 0.6)] = DARK
        colours[back > 0.97] = GREY
        return colours

    # From the cone at the back along the cowl to the middle of the fan.
    rings = [(1.2, 0.12), (1.0, 0.55), (0.35, 1.04), (0.0, 0.92), (0.02, 0.02)]
    if not p.coarse:
        rings = [(1.2, 0.12), (0.98, 0.36), (1.0, 0.55), (0.72, 0.82), (0.35, 1.04),
                 (0.06, 1.0), (0.0, 0.92), (0.03, 0.84), (0.12, 0.8), (0.1, 0.02)]  # fmt: skip
    return join([loft([ring(*at) for at in rings], paint, closed=True), pylon])


def _propeller(p: Proportions, front: float, right: float, up: float) -> Mesh:
    radius = 0.34 if p.is_single else 0.4
    long = 0.9 if p.is_single else 2.1
    reach = 0.95 if p.is_single else 1.0
    spinner = ellipsoid(SILVER, 0.16, 0.3, 0.16, 10, 7).moved(right, front, up)
    blades = []
    for turn in (0.6, 0.6 + math.pi) if p.is_single else (0.5, 2.6, 4.7):
        tip = (right + reach * math.cos(turn), front, up + reach * math.sin(turn))
        blades.append(tube((right, front, up), tip, (0.07, 0.05), BLADE, 6))
    if p.is_single:
        return join([spinner, *blades])
    rings = []
    for back, part in ((1.0, 0.12), (0.7, 0.62), (0.4, 0.95), (0.1, 1.0), (0.0, 0.5)):
        angles = np.linspace(0.0, math.tau, 14, endpoint=False)
        rings.append(
            np.column_stack((
                right + radius * part * np.cos(angles),
                np.full(14, front - 0.15 - back * long),
                up + radius * 0.85 * part * np.sin(angles),
            ))[::-1]
        )  # fmt: skip
    return join([loft(rings, p.livery.engine, closed=True), spinner, *blades])
