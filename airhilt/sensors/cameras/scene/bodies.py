"""What moves before cameras: its shapes, where it is, and its lights."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from typing import NamedTuple

from airhilt.geodesy.local_frame import LocalFrame
from airhilt.messages import VisibleClass
from airhilt.scenario.models import ActorSpec, AircraftSpec, VehicleSpec
from airhilt.sensors.cameras.scene.lights import Light, aircraft_lights, vehicle_lights
from airhilt.sensors.cameras.view import Pose
from airhilt.shapes import animals, vehicles
from airhilt.shapes.aircraft import aircraft_meshes
from airhilt.shapes.mesh import Mesh
from airhilt.shapes.sizes import Dimensions, Size
from airhilt.units import SECOND_NS
from airhilt.world.actors.actor import Actor
from airhilt.world.flight import Aircraft
from airhilt.world.flight.aircraft_type import AircraftType, load_aircraft_type
from airhilt.world.mover import carried_on
from airhilt.world.surface.kinds import load_kind
from airhilt.world.surface.wildlife import AnimalKind

GEAR_DOWN_BELOW_M = 600.0
"""Above the ground: on a glide path of 3 degrees that is 11 km before the threshold."""
LANDING_LIGHTS_BELOW_M = 3048.0
"""FAA AIM 4-3-23: landing lights on below 10,000 ft."""
WING_BEATS_HZ = 4.0
"""Of a Canada goose, about: C. J. Pennycuick, Journal of Experimental Biology 150 (1990) 171."""
STARLING_BEATS_HZ = 9.0


class BodyState(NamedTuple):
    """Where something is at an instant, and which of its shapes it has."""

    actor: str
    east_m: float
    north_m: float
    up_m: float
    heading_rad: float
    pitch_rad: float
    roll_rad: float
    shape: str
    lit: bool
    """Whether its landing lights are on."""

    @property
    def pose(self) -> Pose:
        """Of its axes in the world."""
        return Pose.of(
            (self.east_m, self.north_m, self.up_m),
            self.heading_rad,
            self.pitch_rad,
            self.roll_rad,
        )


@dataclass(frozen=True)
class Model:
    """How an actor looks.

    Attributes
    ----------
    kind
        Actors of one kind share their shapes.
    shapes
        Its meshes by their names.
    lamps
        Return its lights, in its own axes, at a time in seconds, with landing lights or without.
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


def model_of(actor: ActorSpec) -> Model:
    """Return how an actor of a scenario looks.

    Raises
    ------
    ScenarioError
        There is no such kind.
    """
    if isinstance(actor, AircraftSpec):
        return aircraft_model(actor.aircraft)
    if isinstance(actor, VehicleSpec):
        return vehicle_model(actor.kind)
    return animal_model(actor.kind)


def aircraft_model(name: str) -> Model:
    """Return how a type of aircraft looks."""
    kind = load_aircraft_type(name)
    return Model(
        "airplane",
        name,
        aircraft_meshes(kind),
        lambda t_s, lit: aircraft_lights(kind, t_s, lit),
        aircraft_meshes(kind, coarse=True),
        kind,
    )


def vehicle_model(name: str) -> Model:
    """Return how a kind of vehicle looks: one that has no shape of its own is a van."""
    size = load_kind(name, "vehicle").dimensions
    makers: dict[str, Callable[[Size], Mesh]] = {
        "follow_me": vehicles.follow_me,
        "fire_truck": vehicles.fire_truck,
        "snow_plough": vehicles.snow_plough,
        "tug_with_aircraft": lambda size: vehicles.tug_with_aircraft(
            size, load_aircraft_type("737")
        ),
    }
    mesh = makers.get(name, vehicles.van)(size)
    # Something is towed: what is seen of it is the aircraft.
    label: VisibleClass = "airplane" if name == "tug_with_aircraft" else "truck"
    return Model(label, name, {"driving": mesh}, lambda t_s, _: vehicle_lights(size, t_s))


def animal_model(name: str) -> Model:
    """Return how a kind of animal looks; what flies is a bird, any other a deer or a coyote."""
    kind = load_kind(name, "wildlife")
    size = kind.dimensions
    flight = kind.flight if isinstance(kind, AnimalKind) else None
    if flight is None:
        label: VisibleClass = "coyote" if name == "coyote" else "deer"
        shape = animals.coyote if label == "coyote" else animals.deer
        return Model(label, name, {"standing": shape(size)}, _no_lamps)
    count = kind.count if isinstance(kind, AnimalKind) else 1
    aloft = flight.dimensions
    shapes = {"standing": _bird(size, count, None)}
    for beat in range(animals.WING_BEATS):
        shapes[f"flying{beat}"] = _bird(aloft, count, beat)
    return Model("bird", name, shapes, _no_lamps)


def _bird(size: Size | Dimensions, count: int, beat: int | None) -> Mesh:
    return animals.goose(size, beat) if count == 1 else animals.flock(size, count, beat)


def _no_lamps(_t_s: float, _lit: bool) -> Iterator[Light]:
    return iter(())


def states_of(
    actors: Iterable[Actor], frame: LocalFrame, ground_m: float, now_ns: int, ticked_ns: int
) -> list[BodyState]:
    """Return where everybody is; those that have ended lie where they did.

    Parameters
    ----------
    ticked_ns
        Time of the control tick that their states are of.
    """
    elapsed_s = (now_ns - ticked_ns) / SECOND_NS
    return [
        state_of(
            actor,
            frame,
            ground_m,
            now_ns / SECOND_NS,
            elapsed_s if actor.body.ended is None else 0.0,
        )
        for actor in actors
    ]


def state_of(
    actor: Actor, frame: LocalFrame, ground_m: float, t_s: float, elapsed_s: float = 0.0
) -> BodyState:
    """Return where an actor is, in the axes of the scene.

    Parameters
    ----------
    t_s
        Now.
    elapsed_s
        Since the control tick that its state is of: it has moved straight on since, and has the
        attitude that it had then.

    The scene is flat: heights are altitudes less that of the ground, wherever that is. Between
    two actors at one height this leaves out the fall of the Earth, 0.04 degrees in 10 km.
    """
    state = carried_on(actor.body.state, elapsed_s)
    east, north = frame.to_local((state.latitude_rad, state.longitude_rad))
    up = state.altitude_m - ground_m
    callsign = actor.spec.callsign
    body = actor.body
    if isinstance(body, Aircraft):
        height = body.state.height_agl_m
        shape = "gear" if height < GEAR_DOWN_BELOW_M else "clean"
        lit = height < LANDING_LIGHTS_BELOW_M and state.ground_speed_m_s > 15.0
        angles = body.state.heading_rad, body.state.pitch_rad, body.state.roll_rad
        return BodyState(callsign, east, north, up, *angles, shape, lit)
    shape = "driving"
    if actor.category == "wildlife":
        shape = "standing"
        if not body.on_ground:
            rate = WING_BEATS_HZ if body.dimensions.length_m < 3.0 else STARLING_BEATS_HZ
            shape = f"flying{math.floor(t_s * rate * animals.WING_BEATS) % animals.WING_BEATS}"
    return BodyState(callsign, east, north, up, state.heading_rad, 0.0, 0.0, shape, True)
