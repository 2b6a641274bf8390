"""Sizes of flocks of birds that move as one."""

from __future__ import annotations

import math

from airhilt.shapes.sizes import Dimensions

FLOCK_PROPORTIONS = (2.8, 5.6)
"""Middle and longest axis of a flock in the air against its thickness: M. Ballerini et al.,
Empirical investigation of starling flocks, Animal Behaviour 76 (2008) 201-215. Which of the two
points ahead is not settled there; here the flock is wider than long."""


def flock_aloft(bird: Dimensions, count: int, spacing_m: float) -> Dimensions:
    """Return the box around so many birds in the air, each in a cube of ``spacing_m``.

    The proportions are `FLOCK_PROPORTIONS`; the box is never smaller than one bird.
    """
    length, span = FLOCK_PROPORTIONS
    thickness = spacing_m * (count / (length * span)) ** (1.0 / 3.0)
    return Dimensions(
        length_m=max(length * thickness, bird.length_m),
        span_m=max(span * thickness, bird.span_m),
        height_m=max(thickness, bird.height_m),
    )


def flock_on_the_ground(bird: Dimensions, count: int, spacing_m: float) -> Dimensions:
    """Return the box around so many birds on the ground, each on a square of ``spacing_m``."""
    side = spacing_m * math.sqrt(count)
    return Dimensions(
        length_m=max(side, bird.length_m), span_m=max(side, bird.span_m), height_m=bird.height_m
    )
