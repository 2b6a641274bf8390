"""The appearance of a body: its meshes and its lights."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field

from airhilt.shapes.lights import Light, no_lights
from airhilt.shapes.mesh import Mesh


@dataclass(frozen=True)
class Appearance:
    """Meshes and lights of the bodies of one kind."""

    meshes: Mapping[str, Mesh]
    """All meshes that such a body may show, by their names; it shows one at a time."""
    lights: Callable[[float, bool], Iterator[Light]] = no_lights
    """Yields the lights that are on at a time in seconds, with landing lights or without."""
    far: Mapping[str, Mesh] = field(default_factory=dict)
    """Coarser meshes of some of these names, for pictures in which the body is small."""
