"""The phase that flies an aircraft now, and the commands that change its en-route flight."""

from __future__ import annotations

from collections.abc import Sequence

from airhilt.geodesy.wgs84 import Place
from airhilt.units import FOOT_PER_MINUTE, KNOT, wrap_angle
from airhilt.world.flight.curves import Curve
from airhilt.world.flight.guidance import (
    Altitude,
    CurvedPath,
    GuidanceModes,
    LateralMode,
    Route,
)
from airhilt.world.flight.phases import AircraftSystems, FlightPhase
from airhilt.world.flight.procedures.en_route import EnRoute
from airhilt.world.flight.procedures.taxi import Standing
from airhilt.world.flight.route import legs_through
from airhilt.world.flight.state import InitialCondition, OnGround


class FlightControl:
    """One aircraft under guidance, and its commands for track, route, altitude and airspeed.

    A command ends an approach; it changes what a climb or a descent procedure leads to. All raise
    ValueError on the ground, and for what cannot be flown at all.

    Attributes
    ----------
    state : AircraftState
        State after the last tick.
    phase : FlightPhase
        Phase that flies the next tick.
    guidance : EnRoute
        Modes that are flown now, or that the present procedure leads to.
    """

    def __init__(
        self,
        systems: AircraftSystems,
        initial: InitialCondition | OnGround,
        terrain_elevation_m: float,
    ) -> None:
        self.kind = systems.kind
        self.modes = GuidanceModes(systems.kind)
        self.phase: FlightPhase
        self._route: Route | None = None
        self._begin(systems, initial, terrain_elevation_m)

    def _begin(
        self,
        systems: AircraftSystems,
        initial: InitialCondition | OnGround,
        terrain_elevation_m: float,
    ) -> None:
        """Fly by the flight dynamics from where they begin."""
        self.systems = systems
        self.state = systems.airframe.state()
        modes = self.modes
        if isinstance(initial, OnGround):
            self.guidance = self.climb_on(
                modes.track(initial.heading_rad), modes.steepest_climb(self.state.altitude_m)
            )
            self.phase = Standing(systems, "lined_up" if initial.lined_up else "standing")
        else:
            self.phase = self.guidance = EnRoute(
                systems,
                modes.track(initial.track_rad),
                modes.initial_altitude(initial, terrain_elevation_m),
                modes.airspeed(initial.calibrated_airspeed_m_s),
            )

    def fly_route(self, waypoints: Sequence[tuple[float, float]]) -> None:
        """Fly from here through waypoints, each (latitude, longitude) in rad, then hold the track.

        Legs are geodesics; turns cut the corners. One waypoint at least is away from here.
        """
        state = self.state
        legs = legs_through((state.latitude_rad, state.longitude_rad), waypoints)
        self._route = self.modes.route(legs)
        self.commanded().lateral = self._route

    def fly_curve(self, curve: Curve, *, and_back: bool = False) -> None:
        """Fly a curve, then straight on; or then ``and_back`` to the track or route from before."""
        modes = self.commanded()
        before = modes.lateral
        if isinstance(before, CurvedPath):
            before = before.after()
        modes.lateral = self.modes.curve(curve, before if and_back else None)

    def resume_route(self) -> None:
        """Go back to the route that was left for a track or a heading, intercepting its leg."""
        if self._route is None:
            raise ValueError("there is no route to resume; expected fly_route before")
        modes = self.commanded()
        if modes.lateral is not self._route:
            self._route.rejoin()
            modes.lateral = self._route

    def hold_track(self, track_rad: float) -> None:
        """Turn to a true track over the ground by the shorter side, and hold it."""
        self.commanded().lateral = self.modes.track(track_rad)

    def turn_by(self, angle_rad: float) -> None:
        """Turn from the present track by an angle, positive to the right, and hold the new track.

        The angle is at most a full circle.
        """
        track = wrap_angle(self.state.track_rad + angle_rad)
        self.commanded().lateral = self.modes.track(track, angle_rad)

    def hold_altitude(self, altitude_m: float, vertical_rate_m_s: float | None = None) -> None:
        """Climb or descend to an altitude, the service ceiling at most, level off, and hold it.

        The rate is positive, and at most the greatest of the type; by default the type's own.
        """
        if vertical_rate_m_s is None:
            vertical_rate_m_s = self.kind.speeds.climb_rate_fpm * FOOT_PER_MINUTE
        accepted = self.modes.accepted_clearance(
            altitude_m, vertical_rate_m_s, is_climb=altitude_m >= self.state.altitude_m
        )
        self.commanded().vertical = self.modes.altitude(accepted)

    def hold_speed(self, calibrated_airspeed_m_s: float) -> None:
        """Accelerate or decelerate to a calibrated airspeed, and hold it.

        It is brought between the type's slowest clean speed and its greatest speed and Mach number,
        at the present altitude.
        """
        slowest, greatest = self.modes.speed_limits_m_s(self.state.altitude_m)
        accepted = min(max(calibrated_airspeed_m_s, slowest), greatest)
        self.commanded().speed = self.modes.airspeed(accepted)

    @property
    def waypoints_ahead(self) -> tuple[Place, ...]:
        """Places to which the route that is flown still leads; none without a route."""
        lateral = self.guidance.lateral
        return lateral.ends_ahead if isinstance(lateral, Route) else ()

    @property
    def left_route(self) -> tuple[Place, ...]:
        """Places to which the last route leads, flown or left."""
        return () if self._route is None else self._route.ends_ahead

    @property
    def on_ground(self) -> bool:
        """True if a main wheel carries weight."""
        return self.systems.airframe.on_ground()

    def climb_on(self, lateral: LateralMode, vertical: Altitude) -> EnRoute:
        """Return the modes of a climb at the slowest clean airspeed."""
        return EnRoute(self.systems, lateral, vertical, self.modes.clean_climb_speed())

    def commanded(self) -> EnRoute:
        """Return the modes that a command changes; end a procedure that they do not lead out of."""
        self.leave_track()
        if not self.phase.commandable:
            self.require_airborne("an en-route command")
            modes, state = self.modes, self.state
            self.systems.airframe.clean_up()
            self.phase = self.guidance = EnRoute(
                self.systems,
                modes.track(state.track_rad),
                modes.altitude_at_usual_rate(state.altitude_m),
                modes.airspeed(self.kind.speeds.minimum_clean_kt * KNOT),
            )
        return self.guidance

    def leave_track(self) -> None:
        """Fly on by the flight dynamics from a recorded track; no-op for all others."""

    def require_airborne(self, command: str) -> None:
        """Raise ValueError unless the aircraft is in the air."""
        if self.on_ground:
            raise ValueError(
                f"{command} in phase {self.phase.name} on the ground; expected in the air"
            )

    def require_on_ground(self, command: str, fastest_m_s: float) -> None:
        """Raise ValueError unless the aircraft is on the ground, and at most so fast."""
        if not self.on_ground:
            raise ValueError(
                f"{command} in phase {self.phase.name} in the air; expected on the ground"
            )
        speed = self.state.ground_speed_m_s
        if speed > fastest_m_s:
            raise ValueError(
                f"{command} at {speed / KNOT:.0f} kt; expected at most {fastest_m_s / KNOT:.0f} kt"
            )

    def require_climb(self, climb_to_m: float) -> None:
        """Raise ValueError unless an altitude is above the aircraft."""
        if climb_to_m <= self.state.altitude_m:
            raise ValueError(
                f"climb_to_m is {climb_to_m:.0f}; expected more than the altitude now, "
                f"{self.state.altitude_m:.0f}"
            )
