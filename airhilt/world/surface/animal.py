"""Animals and flocks: their kinds in numbers, and bodies that stand, walk, run, fly and flee."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any, Literal

from pydantic import BaseModel, ConfigDict, Field, PositiveFloat

from airhilt.geodesy.local_frame import LocalFrame
from airhilt.geodesy.wgs84 import Place
from airhilt.messages import VisibleClass
from airhilt.shapes.animals import WING_BEATS
from airhilt.shapes.appearance import Appearance
from airhilt.shapes.material import Material
from airhilt.shapes.mesh import Mesh
from airhilt.shapes.sizes import Dimensions, Size
from airhilt.sim.streams import stream
from airhilt.units import wrap_angle
from airhilt.world.mover import Creature, SurfaceState
from airhilt.world.surface.kind import BODY, CreatureKind, within_reach

ARRIVED_M = 0.3
"""Distance below which an animal on the ground has arrived, in m."""
WANDER_INTERVAL_S = 1.0
"""Time between two draws of the wandering, in s."""
WANDER_MEMORY = 0.8
"""Correlation of one draw with the next."""
WANDER_FADES_M = 15.0
"""Distance to the goal from which on an animal wanders less and less, in m."""
SPEED_SIGMA = 0.08
"""Standard deviation of the speed, as a share of the gait's; it is never faster than the gait."""
STEERING_S = 0.3
"""Time constant of a change of direction without limits, in s."""
REACTION_SIGMA = 0.3
"""Sigma of the lognormal reaction time."""
FLIGHT_SPREAD_RAD = math.radians(25.0)
"""Standard deviation of the direction in which an animal flees, about straight away, in rad."""
GREATEST_SPREAD_RAD = math.radians(60.0)
"""Greatest deviation from straight away, in rad."""
HEIGHT_LAG_S = 2.0
"""Time constant of levelling off at a height, in s."""
VERTICAL_ACCELERATION_M_S2 = 3.0
GLIDE_SHARE = 0.5
"""Share of the greatest rate of descent that is used on the way down to land."""
FLARE_S = 1.0
"""Time constant of the descent just above the ground, in s."""
TOUCHDOWN_M_S = 0.3
"""Least rate of descent just above the ground, in m/s."""
LANDING_SPEED_SHARE = 0.5
"""Share of the speed of flight that is flown below `LANDING_HEIGHT_M` when landing."""
LANDING_HEIGHT_M = 5.0
"""Height below which a landing bird slows down, in m."""
AnimalPhase = Literal["standing", "walking", "running", "flying", "fleeing"]
Gait = Literal["walking", "running", "flying"]


class Flight(BaseModel):
    """Numbers of a bird's flight, and its mesh in the air."""

    model_config = ConfigDict(extra="forbid", frozen=True, allow_inf_nan=False)
    dimensions: Dimensions
    mesh: Callable[[Size, int], Mesh]
    """Makes the mesh in the air, with the wings in one of `WING_BEATS` positions."""
    wing_beats_hz: PositiveFloat
    speed_m_s: PositiveFloat
    acceleration_m_s2: PositiveFloat
    lateral_m_s2: PositiveFloat
    """Greatest acceleration across, in a turn."""
    climb_m_s: PositiveFloat
    descent_m_s: PositiveFloat
    height_m: PositiveFloat
    """Height at which it flies from one place on the ground to another, or away from danger."""


class AnimalKind(CreatureKind, BaseModel):
    """A kind of animal, or a flock of birds that moves as one."""

    model_config = ConfigDict(extra="forbid", frozen=True, allow_inf_nan=False)

    name: str
    description: str
    source: str
    """Source of the numbers, and which of them are estimates."""
    label: VisibleClass
    dimensions: Dimensions
    mesh: Callable[[Size], Mesh]
    walk_m_s: PositiveFloat
    run_m_s: PositiveFloat
    acceleration_m_s2: PositiveFloat
    lateral_m_s2: PositiveFloat
    """Greatest acceleration across on the ground, in a turn."""
    turn_rate_rad_s: PositiveFloat = math.pi
    wander_rad: float = Field(ge=0.0, le=1.0)
    """Standard deviation of its direction on the way to a place."""
    reaction_s: PositiveFloat
    """Median time from a fright to the first step."""
    flees_for_m: PositiveFloat
    """Distance after which a flight from danger ends."""
    flight: Flight | None = None
    radar_cross_section_m2: PositiveFloat
    """Radar cross section of all that move as one."""

    def appearance(self) -> Appearance:
        """Return its mesh on the ground, and those of a wing beat if it flies."""
        meshes = {BODY: self.mesh(self.dimensions).made_of(Material.COAT)}
        flight = self.flight
        if flight is not None:
            for beat in range(WING_BEATS):
                meshes[f"flying{beat}"] = flight.mesh(flight.dimensions, beat).made_of(
                    Material.COAT
                )
        return Appearance(meshes)

    def mesh_of(self, body: Creature, t_s: float) -> str:
        """Return the name of the mesh that an animal shows: on the ground, or in a wing beat."""
        if self.flight is None or body.on_ground:
            return BODY
        return f"flying{math.floor(t_s * self.flight.wing_beats_hz * WING_BEATS) % WING_BEATS}"

    def create(self, place: Place, heading_rad: float, **start: Any) -> AnimalBody:
        """Return an animal of this kind; see `airhilt.world.surface.kind.Kind`."""
        return AnimalBody(self, place, heading_rad, **start)


class AnimalBody:
    """An animal, or a flock that moves as one.

    On its way it wanders: direction and speed are autoregressive draws of its own random streams.
    The same seed and the same orders give the same way, bit by bit. Wind does not carry it off.
    One that begins in the air flies straight on. The parameters are those of
    `airhilt.world.surface.kind.Kind.create`.

    Raises
    ------
    ValueError
        The place is at a pole, or it is to be in the air and does not fly.
    """

    def __init__(
        self,
        kind: AnimalKind,
        place: Place,
        heading_rad: float,
        *,
        ground_m: float,
        tick_s: float,
        seed: int = 0,
        height_m: float = 0.0,
    ) -> None:
        self.kind = kind
        self.ended: str | None = None
        self._ground_m = ground_m
        self._tick_s = tick_s
        self._local_frame = LocalFrame(place, ground_m)
        self._east = self._north = 0.0
        self._heading = heading_rad % math.tau
        self._speed = 0.0
        self._height = height_m
        self._climb = 0.0

        self._gait: Gait | None = None
        """Gait; None for one that stands, or comes to a stand."""
        self._goal: tuple[float, float] | None = None
        """Goal in the local frame; None for straight ahead."""
        self._goal_height = height_m
        self._lands = False
        self._descends = False
        """True on the way down to the ground: it does not climb before it is there."""

        self._alarm_ticks = 0
        """Ticks until it flees."""
        self._escape = 0.0
        self._fleeing = False
        self._flee_left_m = 0.0

        self._wander_rng = stream(seed, "wander")
        self._fright_rng = stream(seed, "startle")
        self._wander_ticks = max(1, round(WANDER_INTERVAL_S / tick_s))
        self._wander_left = 0
        self._wander = self._slowness = 0.0
        if height_m > 0.0:
            self._speed = self._flight.speed_m_s
            self._gait = "flying"
        self.state = self._state()

    @property
    def on_ground(self) -> bool:
        """True if the ground carries it."""
        return self._height <= 0.0

    @property
    def dimensions(self) -> Dimensions:
        """Size now: in the air wings are spread, and flocks have other shapes."""
        return self.kind.dimensions if self._height <= 0.0 else self._flight.dimensions

    @property
    def startled(self) -> bool:
        """True from a fright until its flight is over."""
        return self._fleeing or self._alarm_ticks > 0

    @property
    def phase(self) -> AnimalPhase:
        """``standing``, ``walking``, ``running``, ``flying`` or ``fleeing``."""
        if self._fleeing:
            return "fleeing"
        if self._height > 0.0:
            return "flying"
        if self._gait is None and self._speed == 0.0:
            return "standing"
        return self._gait or "walking"

    def stand(self) -> None:
        """Stop; in the air, land ahead and then stop."""
        self._end_flight()
        if self._height > 0.0:
            self._begin("flying", None, 0.0, lands=True)
        else:
            self._gait = None

    def walk_to(self, place: Place) -> None:
        """Walk to a place and stand there; out of the air, land there first."""
        self._go("walking", place)

    def run_to(self, place: Place) -> None:
        """Run to a place and stand there; out of the air, land there first."""
        self._go("running", place)

    def fly_to(self, place: Place, height_m: float) -> None:
        """Fly to a place and about there at a height above the ground; at 0, land there.

        It touches down where its glide ends, and walks what is left.

        Raises
        ------
        ValueError
            It does not fly, or the place is too far away.
        """
        usual = self._flight.height_m
        transit = height_m or (self._height if self._height > 0.0 else usual)
        self._move_origin()
        goal = within_reach(self._local_frame, place)
        self._end_flight()
        self._begin("flying", goal, transit, lands=height_m == 0.0)

    def startle(self, away_from: Place) -> None:
        """Flee from a place after a reaction time, running or, if it can, flying.

        A bird on the ground flies away and lands; one in the air goes on flying. One that is
        startled already takes no notice.

        Raises
        ------
        ValueError
            The place is too far away.
        """
        if self.startled:
            return
        self._move_origin()
        east, north = within_reach(self._local_frame, away_from)
        delay = self.kind.reaction_s * math.exp(REACTION_SIGMA * self._fright_rng.standard_normal())
        spread = FLIGHT_SPREAD_RAD * self._fright_rng.standard_normal()
        away = math.atan2(-east, -north) if east or north else self._heading
        self._escape = away + max(-GREATEST_SPREAD_RAD, min(GREATEST_SPREAD_RAD, spread))
        self._alarm_ticks = max(1, math.ceil(delay / self._tick_s))

    def advance(self) -> None:
        """Move on by one tick; do nothing once it has ended."""
        if self.ended is not None:
            return
        if self._alarm_ticks:
            self._alarm_ticks -= 1
            if self._alarm_ticks == 0:
                self._flee()
        if self._gait is None and self._speed == 0.0:
            return
        if self._wander_left == 0:
            self._wander_left = self._wander_ticks
            self._draw_wander()
        self._wander_left -= 1
        if self._height > 0.0 or self._gait == "flying":
            self._fly()
        else:
            self._walk_or_run()
        self.state = self._state()

    # --- what it means to do ----------------------------------------------------------------

    @property
    def _flight(self) -> Flight:
        if self.kind.flight is None:
            raise ValueError(f"a {self.kind.name} does not fly")
        return self.kind.flight

    def _go(self, gait: Gait, place: Place) -> None:
        if self._height > 0.0:
            self.fly_to(place, 0.0)
            return
        self._move_origin()
        goal = within_reach(self._local_frame, place)
        self._end_flight()
        self._begin(gait, goal, 0.0, lands=False)

    def _begin(
        self, gait: Gait, goal: tuple[float, float] | None, height_m: float, *, lands: bool
    ) -> None:
        self._gait, self._goal = gait, goal
        self._goal_height, self._lands, self._descends = height_m, lands, False

    def _end_flight(self) -> None:
        self._alarm_ticks = 0
        self._fleeing = False

    def _flee(self) -> None:
        """Begin to flee."""
        self._fleeing = True
        far = self._flee_left_m = self.kind.flees_for_m
        east = self._east + far * math.sin(self._escape)
        north = self._north + far * math.cos(self._escape)
        flight = self.kind.flight
        if flight is None:
            self._begin("running", (east, north), 0.0, lands=False)
        else:
            height = max(self._height, flight.height_m)
            self._begin("flying", (east, north), height, lands=self._height <= 0.0)

    def _move_origin(self) -> None:
        """Move the origin of the local frame to the present place."""
        goal = None if self._goal is None else self._local_frame.to_place(*self._goal)
        self._local_frame = LocalFrame(
            (self.state.latitude_rad, self.state.longitude_rad), self._ground_m
        )
        self._east = self._north = 0.0
        self._goal = None if goal is None else self._local_frame.to_local(goal)

    def _draw_wander(self) -> None:
        fresh = math.sqrt(1.0 - WANDER_MEMORY * WANDER_MEMORY)
        aside, slower = self._wander_rng.standard_normal(2).tolist()
        self._wander = WANDER_MEMORY * self._wander + fresh * self.kind.wander_rad * aside
        self._slowness = WANDER_MEMORY * self._slowness + fresh * SPEED_SIGMA * slower

    # --- how it moves -----------------------------------------------------------------------

    def _walk_or_run(self) -> None:
        """Move on the ground: towards the goal, as fast as its turns and its stopping allow."""
        kind = self.kind
        distance, off = self._to_goal()
        slow = self._speed * self._speed < 4.0 * kind.acceleration_m_s2 * ARRIVED_M
        if self._gait is None or (distance < ARRIVED_M and slow):
            self._gait = None
            wanted = off = 0.0
        else:
            gait = kind.walk_m_s if self._gait == "walking" else kind.run_m_s
            wanted = gait * (1.0 - min(abs(self._slowness), 0.5))
            wanted = min(wanted, math.sqrt(2.0 * kind.acceleration_m_s2 * distance))
            # The circle from here to the goal has this curvature; behind, it has to be tighter.
            if abs(off) < 0.5 * math.pi:
                curvature = 2.0 * abs(math.sin(off)) / distance
                if curvature * wanted * wanted > kind.lateral_m_s2:
                    wanted = math.sqrt(kind.lateral_m_s2 / curvature)
                if curvature * wanted > kind.turn_rate_rad_s:
                    wanted = kind.turn_rate_rad_s / curvature
            else:
                wanted = min(wanted, kind.walk_m_s)
        step = kind.acceleration_m_s2 * self._tick_s
        speed = max(min(wanted, self._speed + step), self._speed - step, 0.0)
        self._step(off, speed, kind.turn_rate_rad_s, kind.lateral_m_s2)
        if speed == 0.0 and self._gait is None:
            self._fleeing = False

    def _fly(self) -> None:
        """Move in the air: level at a height, or down to the ground."""
        flight = self._flight
        distance, off = self._to_goal()
        wanted = flight.speed_m_s * (1.0 - min(abs(self._slowness), 0.5))
        if self._descends and self._height < LANDING_HEIGHT_M:
            wanted *= LANDING_SPEED_SHARE
        step = flight.acceleration_m_s2 * self._tick_s
        speed = max(min(wanted, self._speed + step), self._speed - step)
        self._step(off, speed, math.inf, flight.lateral_m_s2)
        self._climb_or_descend(flight, distance)
        if self._height <= 0.0 and self._descends:
            self._touch_down()
        elif self._fleeing and not self._lands:
            self._flee_left_m -= speed * self._tick_s
            if self._flee_left_m <= 0.0:
                self._fleeing = False
                self._goal = None

    def _climb_or_descend(self, flight: Flight, distance: float) -> None:
        """Change the height: up to its own or, once the glide reaches the goal, down."""
        glide = GLIDE_SHARE * flight.descent_m_s
        if self._lands and not self._descends:
            ahead = 0.0 if self._goal is None else distance
            self._descends = self._height > 0.0 and ahead * glide <= self._height * self._speed
        if self._descends:
            wanted = -max(min(glide, self._height / FLARE_S), TOUCHDOWN_M_S)
        else:
            wanted = (self._goal_height - self._height) / HEIGHT_LAG_S
            lift = min(1.0, self._speed / (LANDING_SPEED_SHARE * flight.speed_m_s))
            wanted = max(-flight.descent_m_s, min(wanted, flight.climb_m_s * lift))
        step = VERTICAL_ACCELERATION_M_S2 * self._tick_s
        climb = max(min(wanted, self._climb + step), self._climb - step)
        self._height = max(0.0, self._height + 0.5 * (self._climb + climb) * self._tick_s)
        self._climb = climb

    def _touch_down(self) -> None:
        """Land: walk the rest of the way, or stand if none is left."""
        self._climb = 0.0
        if self._goal is None or self._fleeing:
            self._gait = None
        else:
            self._begin("walking", self._goal, 0.0, lands=False)

    def _to_goal(self) -> tuple[float, float]:
        """Return the distance to the goal, and the turn towards it with the wandering added."""
        if self._goal is None:
            return math.inf, 0.0
        east, north = self._goal[0] - self._east, self._goal[1] - self._north
        distance = math.hypot(east, north)
        wander = self._wander * min(1.0, distance / WANDER_FADES_M)
        return distance, wrap_angle(math.atan2(east, north) + wander - self._heading)

    def _step(self, off: float, speed: float, turn_rate: float, lateral: float) -> None:
        """Turn within the limits and move on at the mean of the old and the new velocity."""
        tick, before, heading = self._tick_s, self._speed, self._heading
        fastest = max(before, speed)
        if fastest > 0.0:
            turn_rate = min(turn_rate, lateral / fastest)
        turned = heading + max(-turn_rate, min(turn_rate, off / STEERING_S)) * tick
        half = 0.5 * tick
        self._east += half * (before * math.sin(heading) + speed * math.sin(turned))
        self._north += half * (before * math.cos(heading) + speed * math.cos(turned))
        self._speed, self._heading = speed, turned % math.tau

    def _state(self) -> SurfaceState:
        latitude, longitude = self._local_frame.to_place(self._east, self._north)
        return SurfaceState(
            latitude,
            longitude,
            self._ground_m + self._height,
            self._height,
            self._speed * math.cos(self._heading),
            self._speed * math.sin(self._heading),
            -self._climb,
            self._heading,
        )
