"""A flock of starlings."""

from __future__ import annotations

import math
from functools import partial

from airhilt.shapes import animals
from airhilt.shapes.sizes import Dimensions
from airhilt.world.surface.animal import AnimalKind, Flight

COUNT = 300
BIRD = Dimensions(length_m=0.21, span_m=0.37, height_m=0.2)
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


KIND = AnimalKind(
    name="flock",
    description=f"{COUNT} European starlings, Sturnus vulgaris, that keep together",
    source=(
        "European starlings have cost the most lives: FAA AC 150/5200-32B, section 4. Size of a "
        "bird: Cornell Lab of Ornithology, All About Birds. Shape of the flock, and birds about "
        "1 m apart in the air: M. Ballerini et al., Animal Behaviour 76 (2008) 201-215. Speeds, "
        "accelerations, and 0.5 m apart on the ground are estimates. "
        "Radar cross section of a bird: that of the standard avian target (0.025 square metres,"
        " 0.5 kg; FAA AC 150/5220-25), by the 2/3 power of the mass."
    ),
    label="bird",
    dimensions=flock_on_the_ground(BIRD, COUNT, spacing_m=0.5),
    mesh=partial(animals.flock, count=COUNT),
    walk_m_s=0.5,
    run_m_s=1.5,
    acceleration_m_s2=2.5,
    lateral_m_s2=3.0,
    wander_rad=0.25,
    reaction_s=0.5,
    flees_for_m=400.0,
    radar_cross_section_m2=COUNT * 0.007,
    flight=Flight(
        dimensions=flock_aloft(BIRD, COUNT, spacing_m=1.0),
        mesh=partial(animals.flock, count=COUNT),
        wing_beats_hz=9.0,
        speed_m_s=17.0,
        acceleration_m_s2=5.0,
        lateral_m_s2=8.0,
        climb_m_s=3.0,
        descent_m_s=5.0,
        height_m=40.0,
    ),
)
