"""Bodies before cameras: their shapes, where they are, and their lights."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from types import MappingProxyType
from typing import Any, NamedTuple

import numpy as np

from airhilt.errors import CameraError
from airhilt.geodesy.local_frame import LocalFrame
from airhilt.imaging.view import Pose
from airhilt.messages import VisibleClass
from airhilt.scenario.models import ActorSpec, AircraftSpec
from airhilt.shapes.aircraft import aircraft_meshes
from airhilt.shapes.lights import Light, aircraft_lights
from airhilt.shapes.mesh import Mesh
from airhilt.units import SECOND_NS
from airhilt.world.actors.actor import Actor
from airhilt.world.flight import Aircraft
from airhilt.world.flight.aircraft_type import AircraftType, load_aircraft_type
from airhilt.world.mover import ABSENT, carried_on
from airhilt.world.surface.kinds import load_kind

MOST_ACTORS = int(np.iinfo(np.uint8).max)
"""Number of actors that ``Frame.instance`` tells apart."""
LANDING_LIGHTS_BELOW_M = 3048.0
"""Height, in m, below which landing lights are on: 10,000 ft, FAA AIM 4-3-23."""
LANDING_LIGHTS_ABOVE_M_S = 15.0
"""Ground speed, in m/s, above which landing lights are on: an aircraft that taxies has them off."""


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


def aircraft_model(name: str, files: Mapping[str, Any] = MappingProxyType({})) -> Model:
    """Return how a type of aircraft looks."""
    kind = load_aircraft_type(name, files)
    return Model(
        "airplane",
        name,
        aircraft_meshes(kind),
        lambda t_s, lit: aircraft_lights(kind, t_s, lit),
        aircraft_meshes(kind, coarse=True),
        kind,
    )


def kind_model(name: str) -> Model:
    """Return how a kind of vehicle or wildlife looks."""
    kind = load_kind(name)
    look = kind.appearance()
    return Model(kind.label, name, look.meshes, look.lights, look.far)


def states_of(
    actors: Iterable[Actor], local_frame: LocalFrame, ground_m: float, now_ns: int, ticked_ns: int
) -> list[BodyState]:
    """Return where everybody is, in the axes of the scene; those that have ended stay there.

    The scene is flat: heights are altitudes less that of the ground, wherever that is. Between
    two actors at one height this leaves out the fall of the Earth, 0.04 degrees in 10 km.

    Parameters
    ----------
    ticked_ns
        Time of the control tick that their states are of: they have moved straight on since, and
        have the attitudes that they had then.
    """
    elapsed_s = (now_ns - ticked_ns) / SECOND_NS
    found = []
    for actor in actors:
        if actor.body.ended in ABSENT:
            continue
        body, callsign, shape = actor.body, actor.spec.callsign, actor.mesh(now_ns / SECOND_NS)
        state = carried_on(body.state, elapsed_s if body.ended is None else 0.0)
        east, north = local_frame.to_local((state.latitude_rad, state.longitude_rad))
        pitch = roll = 0.0
        heading, lit = state.heading_rad, True
        if isinstance(body, Aircraft):
            heading, pitch, roll = (
                body.state.heading_rad,
                body.state.pitch_rad,
                body.state.roll_rad,
            )
            lit = has_landing_lights_on(body.state.height_agl_m, state.ground_speed_m_s)
        up = state.altitude_m - ground_m
        found.append(BodyState(callsign, east, north, up, heading, pitch, roll, shape, lit))
    return found


def has_landing_lights_on(height_agl_m: float, ground_speed_m_s: float) -> bool:
    """Return whether an aircraft has its landing lights on."""
    return height_agl_m < LANDING_LIGHTS_BELOW_M and ground_speed_m_s > LANDING_LIGHTS_ABOVE_M_S


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
