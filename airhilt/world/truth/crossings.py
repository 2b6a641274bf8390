"""Points at which the runways of an airport cross."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from airhilt.world.surface.strips import RunwayStrip

Local = tuple[float, float]
"""East and north in the airport's frame, in m."""


def crossings(strips: Mapping[str, RunwayStrip]) -> dict[str, list[tuple[str, Local]]]:
    """Return, for each runway, the runways that cross it, and where their centre lines meet."""
    found: dict[str, list[tuple[str, Local]]] = {}
    for name, strip in strips.items():
        found[name] = []
        for other, its in strips.items():
            meeting = strip.centreline.intersection(its.centreline)
            if other != name and meeting.geom_type == "Point":
                found[name].append((other, (meeting.x, meeting.y)))
    return found
