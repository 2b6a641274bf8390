"""Kinds of animals and flocks that are described by numbers."""

from __future__ import annotations

import math
from collections.abc import Callable

from pydantic import BaseModel, ConfigDict, Field, PositiveFloat, PositiveInt

from airhilt.geodesy.wgs84 import Place
from airhilt.messages import VisibleClass
from airhilt.shapes.animals import WING_BEATS
from airhilt.shapes.appearance import Appearance
from airhilt.shapes.mesh import Mesh
from airhilt.shapes.sizes import Dimensions, Size
from airhilt.world.mover import Creature
from airhilt.world.surface.animal import AnimalBody
from airhilt.world.surface.kind import BODY, CreatureKind


class Flight(BaseModel):
    """Numbers of a bird's flight, and its mesh in the air.

    Attributes
    ----------
    dimensions
        Size in the air.
    mesh
        Makes the mesh in the air, in that size, with the wings in one of `WING_BEATS` positions.
    wing_beats_hz
        Frequency of its wing beats, in Hz.
    lateral_m_s2
        Greatest acceleration across, in a turn.
    height_m
        Height at which it flies from one place on the ground to another, or away from danger.
    """

    model_config = ConfigDict(extra="forbid", frozen=True, allow_inf_nan=False)
    dimensions: Dimensions
    mesh: Callable[[Size, int], Mesh]
    wing_beats_hz: PositiveFloat
    speed_m_s: PositiveFloat
    acceleration_m_s2: PositiveFloat
    lateral_m_s2: PositiveFloat
    climb_m_s: PositiveFloat
    descent_m_s: PositiveFloat
    height_m: PositiveFloat


class AnimalKind(CreatureKind, BaseModel):
    """A kind of animal, or a flock of birds that moves as one.

    Attributes
    ----------
    source
        Source of the numbers, and which of them are estimates.
    label
        Class that it has in pictures.
    count
        Number of animals that move as one.
    dimensions
        Size on the ground.
    mesh
        Makes its mesh on the ground, in that size.
    acceleration_m_s2
        Acceleration on the ground, of getting faster and slower.
    lateral_m_s2
        Greatest acceleration across on the ground, in a turn.
    turn_rate_rad_s
        Greatest rate of turn on the ground.
    wander_rad
        Standard deviation of its direction on the way to a place.
    reaction_s
        Median time from a fright to the first step.
    flees_for_m
        Distance after which a flight from danger ends.
    flight
        Its flight; None if it does not fly.
    radar_cross_section_m2
        Radar cross section of all that move as one.
    """

    model_config = ConfigDict(extra="forbid", frozen=True, allow_inf_nan=False)

    name: str
    description: str
    source: str
    label: VisibleClass
    count: PositiveInt = 1
    dimensions: Dimensions
    mesh: Callable[[Size], Mesh]
    walk_m_s: PositiveFloat
    run_m_s: PositiveFloat
    acceleration_m_s2: PositiveFloat
    lateral_m_s2: PositiveFloat
    turn_rate_rad_s: PositiveFloat = math.pi
    wander_rad: float = Field(ge=0.0, le=1.0)
    reaction_s: PositiveFloat
    flees_for_m: PositiveFloat
    flight: Flight | None = None
    radar_cross_section_m2: PositiveFloat

    def appearance(self) -> Appearance:
        """Return its mesh on the ground, and those of a wing beat if it flies."""
        meshes = {BODY: self.mesh(self.dimensions)}
        flight = self.flight
        if flight is not None:
            for beat in range(WING_BEATS):
                meshes[f"flying{beat}"] = flight.mesh(flight.dimensions, beat)
        return Appearance(meshes)

    def mesh_of(self, body: Creature, t_s: float) -> str:
        """Return the name of the mesh that an animal shows: on the ground, or in a wing beat."""
        if self.flight is None or body.on_ground:
            return BODY
        return f"flying{math.floor(t_s * self.flight.wing_beats_hz * WING_BEATS) % WING_BEATS}"

    def create(
        self,
        place: Place,
        heading_rad: float,
        *,
        ground_m: float,
        tick_s: float,
        seed: int = 0,
        height_m: float = 0.0,
    ) -> AnimalBody:
        """Return an animal of this kind; see `airhilt.world.surface.kind.Kind`.

        Raises
        ------
        ValueError
            It was to begin at no place, or in the air and does not fly.
        """
        return AnimalBody(
            self,
            place,
            heading_rad,
            ground_m=ground_m,
            tick_s=tick_s,
            seed=seed,
            height_m=height_m,
        )
