"""Kinds of ground vehicles that are described by numbers."""

from __future__ import annotations

from collections.abc import Callable

from pydantic import BaseModel, ConfigDict, PositiveFloat

from airhilt.geodesy.wgs84 import Place
from airhilt.messages import EmitterCategory, VisibleClass
from airhilt.shapes.appearance import Appearance
from airhilt.shapes.mesh import Mesh
from airhilt.shapes.sizes import Dimensions, Size
from airhilt.shapes.vehicles import van
from airhilt.world.surface.kind import DrivenKind, vehicle_appearance
from airhilt.world.surface.vehicle import Vehicle


class VehicleKind(DrivenKind, BaseModel):
    """A kind of ground vehicle that differs from others in numbers, looks and labels.

    Attributes
    ----------
    source
        Source of the numbers, and which of them are estimates.
    mesh
        Makes its mesh, in its size.
    label
        Class that it has in pictures.
    emitter_category
        Category that its transponder sends: C1 for emergency, C2 for service vehicles.
    radar_cross_section_m2
        Radar cross section; the default is that of a pickup truck (M. Skolnik, Introduction to
        Radar Systems, 3rd edition, table 2.2).
    cruise_m_s
        Speed at which it is driven if no other is asked for.
    lateral_m_s2
        Greatest acceleration across, in a corner.
    turning_radius_m
        Least radius of the path of its middle.
    """

    model_config = ConfigDict(extra="forbid", frozen=True, allow_inf_nan=False)

    name: str
    description: str
    source: str
    dimensions: Dimensions
    mesh: Callable[[Size], Mesh] = van
    label: VisibleClass = "truck"
    emitter_category: EmitterCategory = "C2"
    radar_cross_section_m2: PositiveFloat = 200.0
    cruise_m_s: PositiveFloat
    maximum_m_s: PositiveFloat
    acceleration_m_s2: PositiveFloat
    braking_m_s2: PositiveFloat
    lateral_m_s2: PositiveFloat
    turning_radius_m: PositiveFloat

    def appearance(self) -> Appearance:
        """Return its mesh, with a beacon and headlamps."""
        return vehicle_appearance(self.mesh(self.dimensions), self.dimensions)

    def create(
        self,
        place: Place,
        heading_rad: float,
        *,
        ground_m: float,
        tick_s: float,
        seed: int = 0,  # noqa: ARG002
        height_m: float = 0.0,
    ) -> Vehicle:
        """Return a vehicle of this kind; see `airhilt.world.surface.kind.Kind`.

        Raises
        ------
        ValueError
            It was to begin above the ground, or at no place.
        """
        if height_m != 0.0:
            raise ValueError(f"height_m is {height_m}; a {self.name} does not fly")
        return Vehicle(self, place, heading_rad, ground_m=ground_m, tick_s=tick_s)
