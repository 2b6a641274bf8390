"""The fuselage of an aircraft, with what stands on it."""

from __future__ import annotations

import math

import numpy as np

from airhilt.shapes.aircraft.proportions import Proportions
from airhilt.shapes.colours import GLASS
from airhilt.shapes.mesh import Floats, Mesh, ellipsoid, loft

WINDOW_PITCH_M = 0.51
"""Distance between cabin windows: frames 20 in apart (Boeing D6-58325-6, section 2.3)."""


def fuselage(p: Proportions) -> Mesh:
    """Return the fuselage, painted with its windows."""
    stations = np.unique(
        np.concatenate((
            np.linspace(0.0, 0.16, 14),
            np.arange(0.16, 0.66, WINDOW_PITCH_M / 2.0 / p.length)
            if p.is_jet
            else np.linspace(0.16, 0.66, 12),
            np.linspace(0.66, 1.0, 14),
        ))
    )  # fmt: skip
    if p.coarse:
        stations = np.array((0.0, 0.012, 0.028, 0.062, 0.16, 0.4, 0.64, 0.76, 0.88, 1.0))
    angles = np.linspace(0.0, math.tau, p.segments, endpoint=False)
    rings = []
    for part in stations:
        half_width, half_height, rise = _section(p, float(part))
        rings.append(
            np.column_stack((
                half_width * np.cos(angles),
                np.full(p.segments, p.length * (0.5 - part)),
                p.axis + rise + half_height * np.sin(angles),
            ))
        )  # fmt: skip
    # Rings go aft, and their points run from the right side up.
    rings.reverse()
    return loft([ring[::-1] for ring in rings], lambda centres: _paint(p, centres), closed=True)


def _section(p: Proportions, part: float) -> tuple[float, float, float]:
    """Return half width, half height and rise of the axis at a part of the length."""
    radius = p.radius
    nose, tail = (0.13, 0.62) if p.is_jet else (0.22, 0.42)
    if part < nose:
        u = part / nose
        grown = math.sqrt(max(1.0 - (1.0 - u) ** 2.2, 0.0)) if p.is_jet else u**0.45
        if not p.is_jet:
            grown = 0.32 + 0.68 * min(1.0, u**0.7) if p.is_single else 0.05 + 0.95 * grown
        return radius * max(grown, 0.03), radius * max(grown, 0.03), -0.22 * radius * (1 - u)
    if part > tail:
        u = (part - tail) / (1.0 - tail)
        left = 1.0 - 0.93 * u ** (1.5 if p.is_jet else 1.0)
        lift = (0.62 if p.is_jet else 0.18) * radius * u**1.4
        wide = 1.0 - 0.95 * u ** (1.8 if p.is_jet else 1.0)
        return radius * wide, radius * left, lift
    return radius, radius, 0.0


def _paint(p: Proportions, centres: Floats) -> Floats:
    """Return the colours of the fuselage at some points."""
    livery, radius = p.livery, p.radius
    aft = p.length / 2.0 - centres[:, 1]
    above = (centres[:, 2] - p.axis) / radius
    colours = np.tile(np.asarray(livery.body, dtype=np.float32), (len(centres), 1))
    if p.is_jet:
        colours[above < -0.42] = livery.belly
        colours[(above > -0.42) & (above < -0.2)] = livery.stripe
        along = aft / p.length
        tail = (along > 0.78 - 0.1 * above) & (along > 0.7)
        colours[tail] = livery.tail
        row = (above > 0.08) & (above < 0.34) & (along > 0.16) & (along < 0.66)
        windows = np.floor(aft / (WINDOW_PITCH_M / 2.0)).astype(int) % 2 == 0
        colours[row & windows & (not p.coarse)] = GLASS
        screen = (along > 0.028) & (along < 0.062) & (above > 0.18) & (above < 0.62)
        colours[screen] = GLASS
    else:
        colours[(above > -0.35) & (above < 0.0)] = livery.stripe
        colours[above < -0.75] = livery.belly
    return colours


def upper_deck(p: Proportions) -> Mesh:
    """Return the hump of a 747, over the first third."""
    length, radius = 0.27 * p.length, 0.62 * p.radius

    def paint(centres: Floats) -> Floats:
        colours = np.tile(np.asarray(p.livery.body, dtype=np.float32), (len(centres), 1))
        front = 0.5 * length - centres[:, 1]
        above = centres[:, 2] / p.radius
        colours[(front < 0.13 * length) & (above > 0.2) & (above < 0.5)] = GLASS
        return colours

    finer = (8, 6) if p.coarse else (24, 24)
    hump = ellipsoid(paint, radius, length / 2.0, 0.72 * p.radius, *finer)
    ahead = 0.445 * p.length - length / 2.0
    return hump.moved(0.0, ahead, p.axis + 0.66 * p.radius)


def cabin(p: Proportions) -> Mesh:
    """Return the glazed cabin on top of a small aircraft's fuselage."""
    radius = p.radius
    length = 0.34 * p.length
    middle = p.length * (0.5 - (0.36 if p.is_single else 0.42))
    high = 0.62 * radius if p.is_single else 0.5 * radius

    def paint(centres: Floats) -> Floats:
        colours = np.tile(np.asarray(GLASS, dtype=np.float32), (len(centres), 1))
        colours[centres[:, 2] > 0.88 * high] = p.livery.body
        posts = np.abs(np.mod(centres[:, 1] / length * 3.0 + 0.5, 1.0) - 0.5) < 0.12
        colours[posts & (np.abs(centres[:, 0]) > 0.5 * radius)] = p.livery.body
        return colours

    rings = []
    for end, (wide, tall) in (
        (-0.5, (0.35, 0.05)),
        (-0.3, (0.8, 0.85)),
        (-0.1, (0.93, 1.0)),
        (0.18, (0.93, 1.0)),
        (0.34, (0.9, 0.7)),
        (0.5, (0.82, 0.05)),
    ):
        outline = [(-1.0, -0.3), (1.0, -0.3), (0.98, 0.35), (0.82, 0.95), (-0.82, 0.95),
                   (-0.98, 0.35)]  # fmt: skip
        rings.append([
            (x * wide * radius * 0.98, end * length, z * tall * high if z > 0 else z * high)
            for x, z in outline
        ][::-1])  # fmt: skip
    skin = loft(rings, paint, closed=True)
    return skin.moved(0.0, middle, p.axis + 0.62 * radius)
