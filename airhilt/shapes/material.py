"""Materials, which tell by what texture a surface varies about its colour."""

from __future__ import annotations

from enum import IntEnum


class Material(IntEnum):
    """Material of a triangle."""

    PAINT = 0
    GRASS = 1
    ASPHALT = 2
    CONCRETE = 3
    FIELD = 4
    FOLIAGE = 5
    WATER = 6
    WALL = 7
    CLOUD = 8
    SKIN = 9
    """Sheet metal of aircraft and vehicles, with panels, seams and dirt."""
    COAT = 10
    """Fur, feathers and cloth."""
    DECK = 11
    """Thin clouds high above everything."""
