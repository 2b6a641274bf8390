"""Bodies before cameras: their shapes and their lights."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from functools import cached_property
from types import MappingProxyType
from typing import Any, NamedTuple

import numpy as np

from airhilt.errors import CameraError
from airhilt.imaging.view import Pose
from airhilt.messages import VisibleClass
from airhilt.scenario.models import ActorSpec, AircraftSpec
from airhilt.sensors.cameras.scene.projected_box import Outline
from airhilt.shapes.aircraft import aircraft_meshes
from airhilt.shapes.lights import Light, aircraft_lights
from airhilt.shapes.mesh import Mesh
from airhilt.world.flight.aircraft_type import AircraftType, load_aircraft_type
from airhilt.world.surface.kinds import load_kind

MOST_ACTORS = int(np.iinfo(np.uint8).max)
"""Number of actors that ``Frame.instance`` tells apart."""


class BodyState(NamedTuple):
    """Place, attitude and shape of an actor at an instant."""

    actor: str
    east_m: float
    north_m: float
    up_m: float
    heading_rad: float
    pitch_rad: float
    roll_rad: float
    shape: str
    lit: bool
    """Its landing lights are on."""

    @property
    def pose(self) -> Pose:
        """Pose of its axes in the world."""
        return Pose.of(
            (self.east_m, self.north_m, self.up_m),
            self.heading_rad,
            self.pitch_rad,
            self.roll_rad,
        )


@dataclass(frozen=True)
class Model:
    """The looks of an actor.

    Attributes
    ----------
    kind
        Actors of one kind share their shapes.
    lights
        Returns its lights, in its own axes, at a time in seconds, with landing lights or without.
    far
        Coarser meshes of some of these names, for pictures in which it is small.
    aircraft
        Its type if it is one, for cameras that are mounted on it.
    """

    label: VisibleClass
    kind: str
    shapes: Mapping[str, Mesh]
    lights: Callable[[float, bool], Iterator[Light]]
    far: Mapping[str, Mesh] = field(default_factory=dict)
    aircraft: AircraftType | None = None

    @cached_property
    def outlines(self) -> dict[str, Outline]:
        """Outlines of its shapes."""
        return {name: Outline.of(mesh) for name, mesh in self.shapes.items()}


def model_of(actor: ActorSpec, files: Mapping[str, Any]) -> Model:
    """Return how an actor of a scenario looks.

    Parameters
    ----------
    files
        Types of aircraft that the scenario brings along.

    Raises
    ------
    ScenarioError
        There is no such kind.
    """
    return (
        aircraft_model(actor.aircraft, files)
        if isinstance(actor, AircraftSpec)
        else kind_model(actor.kind)
    )


def aircraft_model(
    name: str, files: Mapping[str, Any] = MappingProxyType({}), livery: int = 0
) -> Model:
    """Return how a type of aircraft looks in a livery."""
    kind = load_aircraft_type(name, files)
    return Model(
        "airplane",
        f"{name} {livery}",
        aircraft_meshes(kind, livery=livery),
        lambda t_s, lit: aircraft_lights(kind, t_s, lit),
        aircraft_meshes(kind, coarse=True, livery=livery),
        kind,
    )


def kind_model(name: str) -> Model:
    """Return how a kind of vehicle or wildlife looks."""
    kind = load_kind(name)
    look = kind.appearance()
    return Model(kind.label, name, look.meshes, look.lights, look.far)


def numbered(actors: Iterable[str]) -> dict[str, int]:
    """Return the numbers of actors in ``Frame.instance``, from 1.

    Raises
    ------
    CameraError
        There are more than pictures tell apart.
    """
    numbers = {actor: number for number, actor in enumerate(actors, start=1)}
    if len(numbers) > MOST_ACTORS:
        raise CameraError(
            f"there are {len(numbers)} actors, and cameras tell at most {MOST_ACTORS} apart; take "
            "some out of the scenario, or run it with --no-cameras"
        )
    return numbers
