"""Ground vehicles: their kinds in numbers, and bodies that follow paths within these limits."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import NamedTuple

from pydantic import BaseModel, ConfigDict, PositiveFloat

from airhilt.geodesy.local_frame import LocalFrame
from airhilt.geodesy.wgs84 import Place
from airhilt.messages import EmitterCategory, VisibleClass
from airhilt.shapes.appearance import Appearance
from airhilt.shapes.material import Material
from airhilt.shapes.mesh import Mesh
from airhilt.shapes.sizes import Dimensions, Size
from airhilt.shapes.vehicles import van
from airhilt.world.mover import SurfaceState
from airhilt.world.surface.alignment import Element, aligned
from airhilt.world.surface.kind import (
    DrivenKind,
    VehiclePhase,
    vehicle_appearance,
    within_reach,
)

STANDING_M_S = 1e-6
"""Speed below which a vehicle stands, in m/s."""
SAME_END_M = 1e-6
"""Distance below which a vehicle is at the end of its path, in m."""


class VehicleKind(DrivenKind, BaseModel):
    """A kind of ground vehicle that differs from others in numbers, looks and labels."""

    model_config = ConfigDict(extra="forbid", frozen=True, allow_inf_nan=False)

    name: str
    description: str
    source: str
    """Source of the numbers, and which of them are estimates."""
    dimensions: Dimensions
    mesh: Callable[[Size], Mesh] = van
    label: VisibleClass = "truck"
    emitter_category: EmitterCategory = "C2"
    """Category that its transponder sends: C1 for emergency, C2 for service vehicles."""
    radar_cross_section_m2: PositiveFloat = 200.0
    """Radar cross section; the default is that of a pickup truck (M. Skolnik, Introduction to Radar
    Systems, 3rd edition, table 2.2)."""
    cruise_m_s: PositiveFloat
    """Speed at which it is driven by default."""
    maximum_m_s: PositiveFloat
    acceleration_m_s2: PositiveFloat
    braking_m_s2: PositiveFloat
    lateral_m_s2: PositiveFloat
    """Greatest acceleration across, in a corner."""
    turning_radius_m: PositiveFloat
    """Least radius of the path of its middle."""

    def appearance(self) -> Appearance:
        """Return its mesh, with a beacon and headlamps."""
        return vehicle_appearance(
            self.mesh(self.dimensions).made_of(Material.SKIN), self.dimensions
        )

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
        """Return a vehicle of this kind; see `airhilt.world.surface.kind.Kind`."""
        if height_m != 0.0:
            raise ValueError(f"height_m is {height_m}; a {self.name} does not fly")
        return Vehicle(self, place, heading_rad, ground_m=ground_m, tick_s=tick_s)


class _Stage(NamedTuple):
    """An element of the path, with the speeds at which it can be driven."""

    element: Element
    limit_m_s: float
    """Greatest speed in it, for the acceleration across."""
    exit_squared: float
    """Square of the greatest speed at its end from which the vehicle can brake for what follows."""
    beyond_m: float
    """Length of all that comes after it."""


class Vehicle:
    """A vehicle on a path.

    Its middle follows the path, and its heading is the direction of the path there: it is one
    rigid body that does not slip, and its steering is immediate. That holds for a tug with an
    aircraft in tow as well, which really bends in the middle.

    The parameters are those of `airhilt.world.surface.kind.Kind.create`. While it brakes because of
    `stop`, its phase is ``stopping``.

    Raises
    ------
    ValueError
        The place is at a pole.
    """

    on_ground = True

    def __init__(
        self,
        kind: VehicleKind,
        place: Place,
        heading_rad: float,
        *,
        ground_m: float,
        tick_s: float,
    ) -> None:
        self.kind = kind
        self.dimensions = kind.dimensions
        self.ended: str | None = None
        self.phase: VehiclePhase = "standing"
        self._ground_m = ground_m
        self._tick_s = tick_s
        self._local_frame = LocalFrame(place, ground_m)
        self._stages: list[_Stage] = []
        self._index = 0
        self._along = 0.0
        self._speed = 0.0
        self._cruise = kind.cruise_m_s
        self.state = self._state(0.0, 0.0, heading_rad)

    def drive(self, path: Sequence[Place], speed_m_s: float | None = None) -> None:
        """Follow a path from here, with its corners rounded, and stop exactly at its end.

        A vehicle passes a point that is too near to be reached within the limits: it brakes on
        its heading, turns, and comes back. The speed is by default that of the kind.

        Raises
        ------
        ValueError
            The path is empty or leads too far away, or the speed is not positive.
        """
        if not path:
            raise ValueError("the path has no place; expected at least its end")
        speed = self.kind.cruise_m_s if speed_m_s is None else speed_m_s
        if not speed > STANDING_M_S:
            raise ValueError(f"speed_m_s is {speed}; expected more than 0")
        local_frame = LocalFrame(
            (self.state.latitude_rad, self.state.longitude_rad), self._ground_m
        )
        self._stages = self._plan([within_reach(local_frame, place) for place in path])
        self._local_frame = local_frame
        self._cruise = min(speed, self.kind.maximum_m_s)
        self._index, self._along = 0, 0.0
        self.phase = "driving" if self._stages else "standing"

    def stop(self) -> None:
        """Brake to a stand on the path until `resume`; no-op for a standing vehicle."""
        if self.phase == "driving":
            self.phase = "stopping"

    def resume(self) -> None:
        """Go on along the path that `stop` left.

        Raises
        ------
        ValueError
            There is nothing left of it.
        """
        if not self._stages:
            raise ValueError("there is no path to go on with")
        self.phase = "driving"

    def advance(self) -> None:
        """Move on by one tick.

        The new speed is the greatest one from which the braking distance, v2 = exit2 + 2 b d, is
        still long enough after the tick, which is driven at the mean of old and new speed.
        """
        if self.phase == "standing" or self.ended is not None:
            return
        stage, speed, tick = self._stages[self._index], self._speed, self._tick_s
        slowdown = self.kind.braking_m_s2 * tick
        if self.phase == "stopping":
            new = speed - slowdown
        else:
            limit = min(self._cruise, stage.limit_m_s)
            new = max(min(speed + self.kind.acceleration_m_s2 * tick, limit), speed - slowdown)
            left = stage.element.length_m - self._along
            reserve = stage.exit_squared + 2.0 * self.kind.braking_m_s2 * left - slowdown * speed
            root = slowdown * slowdown + 4.0 * reserve
            new = min(new, 0.5 * (math.sqrt(root) - slowdown) if root > 0.0 else 0.0)
        if new < STANDING_M_S:
            self._come_to_a_stand()
            return
        self._speed = new
        self._along += 0.5 * (speed + new) * tick
        while self._along > stage.element.length_m and stage.beyond_m > 0.0:
            self._along -= stage.element.length_m
            self._index += 1
            stage = self._stages[self._index]
        self.state = self._state(*stage.element.at(self._along))

    def _come_to_a_stand(self) -> None:
        """Stop at the end of the braking distance, or exactly at the end of the path."""
        stage = self._stages[self._index]
        length = stage.element.length_m
        braked = self._along + 0.5 * self._speed * self._speed / self.kind.braking_m_s2
        at_the_end = stage.beyond_m == 0.0 and braked > length - SAME_END_M
        self._along = length if at_the_end else min(braked, length)
        self._speed = 0.0
        self.state = self._state(*stage.element.at(self._along))
        self.phase = "standing"
        if at_the_end:
            self._stages = []

    def _plan(self, points: Sequence[tuple[float, float]]) -> list[_Stage]:
        """Return the stages of a path: the first of three that begins as fast as it drives now.

        It turns at once; or slows down straight ahead for a turn; or stops before that.
        """
        kind, squared = self.kind, self._speed * self._speed
        heading = self.state.heading_rad
        turning = min(squared, kind.lateral_m_s2 * kind.turning_radius_m)
        for slowed in (squared, turning, 0.0):
            ahead = Element(0.0, 0.0, heading, 0.0, (squared - slowed) / (2.0 * kind.braking_m_s2))
            east, north, _ = ahead.end
            elements = aligned((east, north), heading, points, kind.turning_radius_m)
            stages = self._stages_of([ahead, *elements] if ahead.length_m > 0.0 else elements)
            if squared <= self._entry_squared(stages) * (1.0 + 1e-12):
                break
        return stages

    def _stages_of(self, elements: list[Element]) -> list[_Stage]:
        """Return the elements with their speeds, found from the end, where the vehicle stands."""
        kind = self.kind
        stages: list[_Stage] = []
        for element in reversed(elements):
            curvature = abs(element.curvature_per_m)
            limit = math.sqrt(kind.lateral_m_s2 / curvature) if curvature else math.inf
            beyond = stages[-1].element.length_m + stages[-1].beyond_m if stages else 0.0
            exit_squared = min(self._entry_squared(stages[-1:]), limit * limit)
            stages.append(_Stage(element, limit, exit_squared, beyond))
        return stages[::-1]

    def _entry_squared(self, stages: list[_Stage]) -> float:
        """Return the greatest square of the speed at which the first of some stages can begin."""
        if not stages:
            return 0.0
        first = stages[0]
        braked = first.exit_squared + 2.0 * self.kind.braking_m_s2 * first.element.length_m
        return min(braked, first.limit_m_s * first.limit_m_s)

    def _state(self, east: float, north: float, heading: float) -> SurfaceState:
        latitude, longitude = self._local_frame.to_place(east, north)
        speed = self._speed
        return SurfaceState(
            latitude,
            longitude,
            self._ground_m,
            0.0,
            speed * math.cos(heading),
            speed * math.sin(heading),
            0.0,
            heading % math.tau,
        )
