"""An aircraft on its recorded track, and how it leaves it to fly on by its flight dynamics."""

from __future__ import annotations

import math
from collections.abc import Callable

from airhilt.geodesy.wgs84 import Place, distance_m
from airhilt.units import DEGREE, FOOT, KNOT
from airhilt.world.flight import standard_atmosphere
from airhilt.world.flight.aircraft_type import AircraftType
from airhilt.world.flight.control import FlightControl
from airhilt.world.flight.guidance import GuidanceModes
from airhilt.world.flight.phases import AircraftSystems, FlightPhase
from airhilt.world.flight.procedures.taxi import AT_REST_M_S
from airhilt.world.flight.route import legs_through
from airhilt.world.flight.state import AircraftState, Atmosphere, InitialCondition, OnGround
from airhilt.world.flight.track import RecordedTrack, TrackPoint

ROW_TICKS = 200
"""Ticks of which the states are computed in one go."""
LEG_M = 3000.0
"""Least length of a leg of the route that the rest of a track becomes, in m."""
GEAR_DOWN_BELOW_M = 600.0
"""Height above the ground below which the gear is down, in m: on a glide path of 3 degrees, that is
11 km before the threshold."""
LANDING_BELOW_M = 3000.0 * FOOT
"""Height above the ground in m below which an aircraft at approach speed has its flaps down."""
LeaveTrack = Callable[[InitialCondition | OnGround, Atmosphere], AircraftSystems]
"""Begins the flight by the flight dynamics, in the air that it then flies in."""


class TrackFollower:
    """Moves one aircraft along its recorded track."""

    def __init__(
        self,
        kind: AircraftType,
        points: tuple[TrackPoint, ...],
        atmosphere: Atmosphere,
        terrain_elevation_m: float,
        tick_s: float,
    ) -> None:
        self._kind = kind
        self._atmosphere = atmosphere
        self._tick_s = tick_s
        wheels_m = terrain_elevation_m + kind.dimensions.wheel_height_offset_m
        self.track = RecordedTrack(points, wheels_m, atmosphere)
        self._ticks = 0
        self._row: list[AircraftState] = []
        """States of the ticks to come, the last one first."""
        self.state = self.track.states([self.track.begin_s])[0]

    @property
    def t_s(self) -> float:
        """Time since the start of the run, in s."""
        return self._ticks * self._tick_s

    @property
    def has_begun(self) -> bool:
        """True from the time of the first point on."""
        return self.t_s >= self.track.begin_s

    @property
    def has_ended(self) -> bool:
        """True after the last point, unless it is on the ground: there the aircraft stays."""
        return self.t_s > self.track.end_s and not self.on_ground()

    def advance(self) -> None:
        """Move on by one tick."""
        self._ticks += 1
        if not self.has_begun:
            return
        if self.t_s > self.track.end_s:
            self.state = self.state._replace(
                velocity_north_m_s=0.0, velocity_east_m_s=0.0, velocity_down_m_s=0.0
            )
            return
        if not self._row:
            times = [(self._ticks + tick) * self._tick_s for tick in range(ROW_TICKS)]
            self._row = self.track.states([t for t in times if t <= self.track.end_s])[::-1]
        self.state = self._row.pop()

    def on_ground(self) -> bool:
        """Return whether the ground carries it."""
        return self.track.on_ground(self.t_s)

    def main_wheel_height_m(self, state: AircraftState) -> float:
        """Return the height of the wheels above the ground, in m."""
        return state.height_agl_m

    def gear(self) -> float:
        """Return the position of the gear, which no record has: down near the ground."""
        return 1.0 if self.state.height_agl_m < GEAR_DOWN_BELOW_M else 0.0

    def flaps(self) -> float:
        """Return the position of the flaps, which no record has: up."""
        return 0.0

    def fuel_kg(self) -> float | None:
        """Return None: no record has the fuel."""
        return None

    @property
    def level_m(self) -> float:
        """Altitude at which its climb or descent ends, in m."""
        return self.track.level_m(self.t_s)

    def route(self) -> list[Place]:
        """Return the rest of the track in the air as waypoints, each a leg from the one before."""
        last = self.state.place
        route: list[Place] = []
        places = self.track.places_after(self.t_s)
        for place in places:
            if distance_m(last, place) >= LEG_M:
                route.append(place)
                last = place
        if route:
            route[-1] = places[-1]
        return route

    def departure(self) -> tuple[InitialCondition | OnGround, Atmosphere]:
        """Return how the flight by the flight dynamics begins, and the air that it flies in.

        The velocity over the ground stays as it is. Where the airspeed would be outside the type's
        envelope, the wind is another than that of the scenario: the one that explains it.

        Raises
        ------
        ValueError
            The aircraft rolls on the ground.
        """
        state, kind = self.state, self._kind
        if self.on_ground():
            if state.ground_speed_m_s > AT_REST_M_S:
                raise ValueError("on the ground, on a recorded track; expected it to stand")
            return OnGround(*state.place, state.heading_rad), self._atmosphere
        slowest, fastest = GuidanceModes(kind).speed_limits_m_s(state.altitude_m)
        approach = kind.speeds.approach_kt * KNOT
        is_slow = state.calibrated_airspeed_m_s < slowest
        on_approach = is_slow and state.height_agl_m < LANDING_BELOW_M
        airspeed = min(
            max(state.calibrated_airspeed_m_s, approach if on_approach else slowest), fastest
        )
        limit = kind.gains.roll.bank_limit_deg * DEGREE
        initial = InitialCondition(
            *state.place,
            altitude_m=state.altitude_m,
            track_rad=state.track_rad,
            calibrated_airspeed_m_s=airspeed,
            vertical_rate_m_s=state.vertical_rate_m_s,
            on_approach=on_approach,
            bank_rad=min(max(state.roll_rad, -limit), limit),
        )
        return initial, self._air(airspeed)

    def _air(self, calibrated_airspeed_m_s: float) -> Atmosphere:
        """Return the air in which an airspeed along the heading keeps the velocity."""
        state, air = self.state, self._atmosphere
        if calibrated_airspeed_m_s == state.calibrated_airspeed_m_s:
            return air
        airspeed = standard_atmosphere.true_airspeed(calibrated_airspeed_m_s, state.altitude_m)
        level = math.sqrt(max(airspeed**2 - state.vertical_rate_m_s**2, 0.0))
        return Atmosphere(
            state.velocity_north_m_s - level * math.cos(state.heading_rad),
            state.velocity_east_m_s - level * math.sin(state.heading_rad),
            air.turbulence_wind_at_20ft_m_s,
            air.turbulence_severity,
        )


class TrackPhase(FlightPhase):
    """Follows a recorded track."""

    name = "on_track"

    def __init__(self) -> None:
        """Have no systems: nothing flies."""

    def fly(self, state: AircraftState) -> FlightPhase:  # noqa: ARG002
        """Return itself: `TrackFollower` moves the aircraft."""
        return self


class TrackControl(FlightControl):
    """Commands of an aircraft on a recorded track; the first one takes it off its track.

    It then flies on along the rest of the track as a route, to the level of its climb or descent,
    at its airspeed, as far as the command does not change that.
    """

    def __init__(
        self,
        kind: AircraftType,
        follower: TrackFollower,
        leave: LeaveTrack,
        terrain_elevation_m: float,
    ) -> None:
        self.kind = kind
        self.modes = GuidanceModes(kind)
        self.state = follower.state
        self.phase = TrackPhase()
        self._route = None
        self._follower = follower
        self._leave = leave
        self._terrain_elevation_m = terrain_elevation_m

    @property
    def on_ground(self) -> bool:
        """True if the ground carries it."""
        return self._follower.on_ground() if self._is_on_track else super().on_ground

    @property
    def waypoints_ahead(self) -> tuple[Place, ...]:
        """Places to which the track or the route still leads."""
        return tuple(self._follower.route()) if self._is_on_track else super().waypoints_ahead

    @property
    def left_route(self) -> tuple[Place, ...]:
        """Places to which the track, or the last route, leads."""
        return tuple(self._follower.route()) if self._is_on_track else super().left_route

    def resume_route(self) -> None:
        """Go back to the track, as a route; no-op on it."""
        if not self._is_on_track:
            super().resume_route()

    def leave_track(self) -> None:
        """Fly on by the flight dynamics, if it does not already."""
        if not self._is_on_track:
            return
        follower, state = self._follower, self.state
        initial, atmosphere = follower.departure()
        level_m, route = follower.level_m, follower.route()
        self._begin(self._leave(initial, atmosphere), initial, self._terrain_elevation_m)
        if isinstance(initial, OnGround):
            return
        self.guidance.vertical = self.modes.altitude_at_usual_rate(level_m)
        if route:
            self._route = self.modes.route(legs_through(state.place, route))
            self.guidance.lateral = self._route

    @property
    def _is_on_track(self) -> bool:
        return isinstance(self.phase, TrackPhase)
