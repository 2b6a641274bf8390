"""The landing gear of an aircraft."""

from __future__ import annotations

import numpy as np

from airhilt.shapes.aircraft.proportions import Proportions
from airhilt.shapes.colours import SILVER, TYRE
from airhilt.shapes.mesh import Mesh, tube, wheel


def gear(p: Proportions) -> list[Mesh]:
    """Return the legs and wheels of the landing gear."""
    radius = 0.6 if p.is_heavy else 0.55 if p.is_jet else 0.22
    width = 0.4 if p.is_jet else 0.16
    nose_at = p.length * (0.5 - (0.12 if p.is_jet else 0.16))
    main_at = -0.04 * p.length if p.is_jet else -0.06 * p.length + 0.4
    out = 0.17 * p.half_span if p.is_jet else 0.24 * p.half_span
    legs = [(0.0, nose_at), (out, main_at), (-out, main_at)]
    if p.is_heavy:
        legs += [(side * 0.06 * p.half_span, main_at - 3.0) for side in (1.0, -1.0)]
    parts = []
    for right, at in legs:
        top = p.axis - 0.5 * p.radius
        inboard = 0.75 * right if not p.is_jet else right
        parts.append(
            tube((inboard, at, top), (right, at, p.ground + radius),
                 (0.14, 0.14) if p.is_jet else (0.06, 0.06), SILVER,
                 4 if p.coarse else 8)
        )  # fmt: skip
        sides = (-0.45, 0.45) if p.is_jet else (0.0,)
        rows = (-0.7, 0.7) if p.is_heavy and right else (0.0,)
        if p.coarse:
            reach = (sides[-1] + width / 2.0, 0.0, 0.0)
            hub = right, at, p.ground + radius
            ends = np.subtract(hub, reach), np.add(hub, reach)
            parts.append(tube(*ends, (radius, radius), TYRE, 6))
            continue
        parts += [
            wheel(TYRE, radius, width).moved(right + side, at + row, p.ground + radius)
            for side in sides
            for row in rows
        ]
    return parts
