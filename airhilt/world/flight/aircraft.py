"""One aircraft: an airframe, the laws that fly it, the guard that watches it."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace

from airhilt.geodesy.wgs84 import Place
from airhilt.shapes.aircraft.spec import AircraftDimensions
from airhilt.units import DEGREE, FOOT, FOOT_PER_MINUTE, KNOT, wrap_angle
from airhilt.world.flight import standard_atmosphere
from airhilt.world.flight.aircraft_type import AircraftType
from airhilt.world.flight.airframe import Airframe, heading_to_track
from airhilt.world.flight.autopilot import Autopilot
from airhilt.world.flight.ground import GroundLaw
from airhilt.world.flight.guard import Guard
from airhilt.world.flight.guidance import (
    Airspeed,
    Altitude,
    AltitudeClearance,
    Heading,
    LateralMode,
    Route,
    Track,
)
from airhilt.world.flight.model import ModelError
from airhilt.world.flight.phases import Cockpit, FlightPhase
from airhilt.world.flight.procedures.approach import Glide
from airhilt.world.flight.procedures.emergency_descent import EmergencyDescent
from airhilt.world.flight.procedures.en_route import EnRoute
from airhilt.world.flight.procedures.engine_failure import DriftDown
from airhilt.world.flight.procedures.final import Final
from airhilt.world.flight.procedures.go_around import GoAround
from airhilt.world.flight.procedures.landing import Flare
from airhilt.world.flight.procedures.side_step import require_side_step
from airhilt.world.flight.procedures.takeoff import RejectedTakeoff, TakeoffRoll, require_lined_up
from airhilt.world.flight.procedures.taxi import Stand, Standing, Taxi, Way
from airhilt.world.flight.route import legs_through
from airhilt.world.flight.state import Atmosphere, InitialCondition, OnGround, require_finite
from airhilt.world.flight.taxi_path import TaxiPath
from airhilt.world.surface.runway import RunwayEnd

SETTLING_TIME_S = 40.0
"""For which a model that JSBSim cannot trim flies in still air before it begins."""

STARTING_TIME_S = 5.0
"""For which the engines start, of an aircraft that begins on the ground."""
IDLING_TIME_S = 15.0
"""For which they then run down to idle, while the struts settle."""
FASTEST_TAXI_M_S = 20.0
"""Ground speed from which a taxi or a takeoff may begin."""

SETTLED_SPEED_M_S = 1.5 * KNOT
"""Error of airspeed that is left then, at most."""


class Aircraft:
    """One JSBSim aircraft under guidance.

    It begins standing on the ground, or in steady flight on its track, holding its altitude and its
    airspeed (or, with an initial vertical rate, climbing to its ceiling or descending to the ground
    at that rate, until it gets an altitude).

    Parameters
    ----------
    kind
        Its type.
    initial
        Where it begins and how it flies there.
    seed
        Of its turbulence. The same seed and the same commands give the same flight, bit by bit.
    atmosphere
        The air, there from the first instant.
    terrain_elevation_m
        Of the flat ground below it, above WGS84.
    tick_s
        Between two calls of `advance`; the laws work once in it.
    substeps
        Steps of the flight dynamics in a tick.

    Attributes
    ----------
    kind : AircraftType
    state : AircraftState
        After the last `advance`.
    ended : str or None
        Why it flies no more: ``ground_contact``, ``state_not_finite``, or ``envelope_exceeded:``
        and what it exceeded. The state stays the last one before that.

    Raises
    ------
    ValueError
        The initial condition is outside the type's envelope.
    ModelError
        JSBSim does not have the model, or cannot fly it there.
    """

    def __init__(
        self,
        kind: AircraftType,
        initial: InitialCondition | OnGround,
        *,
        seed: int,
        atmosphere: Atmosphere,
        terrain_elevation_m: float = 0.0,
        tick_s: float = 0.05,
        substeps: int = 6,
    ) -> None:
        self.kind = kind
        self.ended: str | None = None
        self._substeps = range(substeps)
        self._guard = Guard(kind)
        self._gains = kind.gains.guidance
        self._bank_limit = kind.gains.roll.bank_limit_deg * DEGREE
        self._route: Route | None = None
        self._failing: list[int] = []
        self._airframe = airframe = Airframe(
            kind, step_s=tick_s / substeps, seed=seed, terrain_elevation_m=terrain_elevation_m
        )
        if isinstance(initial, OnGround):
            autopilot = self._stood(initial, atmosphere, tick_s)
        else:
            autopilot = self._flown(initial, atmosphere, terrain_elevation_m, tick_s)
        self.state = airframe.state()
        self._cockpit = Cockpit(
            kind, airframe, autopilot, GroundLaw(airframe, kind, tick_s), tick_s
        )
        self._phase: FlightPhase
        if isinstance(initial, OnGround):
            self._modes = self._climb_to(
                Track(initial.heading_rad, self._gains.course_per_s), self.state.altitude_m
            )
            self._phase = Standing(self._cockpit, "lined_up" if initial.lined_up else "standing")
        else:
            self._phase = self._modes = EnRoute(
                self._cockpit,
                Track(initial.track_rad, self._gains.course_per_s),
                self._initial_altitude(initial, terrain_elevation_m),
                Airspeed(initial.calibrated_airspeed_m_s, kind.speeds.maximum_mach),
            )

    @property
    def phase(self) -> str:
        """What it does, such as ``en_route``, ``glide`` or ``go_around``."""
        return self._phase.name

    @property
    def on_ground(self) -> bool:
        """Whether a main wheel carries weight."""
        return self._airframe.on_ground()

    @property
    def main_wheel_height_m(self) -> float:
        """How far the main wheels, not loaded, are above the ground."""
        return self._airframe.main_wheel_height_m(self.state)

    @property
    def dimensions(self) -> AircraftDimensions:
        """Its size."""
        return self.kind.dimensions

    @property
    def target_altitude_m(self) -> float:
        """The altitude that is flown to, or held."""
        return self._modes.vertical.clearance.altitude_m

    @property
    def target_vertical_rate_m_s(self) -> float:
        """The vertical rate commanded now, positive up; 0 at the target altitude."""
        return self._modes.vertical.vertical_rate(self.state)

    @property
    def target_speed_m_s(self) -> float:
        """The calibrated airspeed that is flown to, or held as far as the Mach limit lets it."""
        return self._modes.speed.target_m_s

    def advance(self) -> None:
        """Fly one tick; do nothing once the flight has ended."""
        if self.ended is not None:
            return
        self._phase = phase = self._phase.fly(self.state)
        if isinstance(phase, Standing) and phase.at_rest:
            if self.state.ground_speed_m_s > 0.0:
                self.state = self.state._replace(
                    velocity_north_m_s=0.0, velocity_east_m_s=0.0, velocity_down_m_s=0.0
                )
            return
        if phase.may_touch:
            self._airframe.feel_wind(self.state.ground_speed_m_s)
        step = self._airframe.step
        for _ in self._substeps:
            step()
        while self._failing:
            self._airframe.cut_engine(self._failing.pop())
        state = self._airframe.state()
        self.ended = self._guard.check(
            state, may_touch=phase.may_touch, on_ground=self._airframe.on_ground()
        )
        if self.ended is None:
            self.state = state

    def fly_route(self, waypoints: Sequence[tuple[float, float]]) -> None:
        """Fly from here through waypoints, then hold the last leg's track.

        Parameters
        ----------
        waypoints
            Each (latitude, longitude) in radians. Legs are geodesics; turns cut the corners.

        Raises
        ------
        ValueError
            A waypoint is not on Earth, or none is away from here.
        """
        here = (self.state.latitude_rad, self.state.longitude_rad)
        legs = legs_through(here, waypoints)
        self._route = Route(legs, self._gains.course_per_s, self._bank_limit)
        self._commanded().lateral = self._route

    def resume_route(self) -> None:
        """Go back to the route that was left for a track or a heading, intercepting its leg.

        Raises
        ------
        ValueError
            There is no route.
        """
        if self._route is None:
            raise ValueError("there is no route to resume; expected fly_route before")
        modes = self._commanded()
        if modes.lateral is not self._route:
            self._route.rejoin()
            modes.lateral = self._route

    def hold_track(self, track_rad: float) -> None:
        """Turn to a true track over the ground by the shorter side, and hold it.

        Raises
        ------
        ValueError
            It is not finite.
        """
        require_finite("track_rad", track_rad)
        self._commanded().lateral = Track(track_rad, self._gains.course_per_s)

    def hold_heading(self, heading_rad: float) -> None:
        """Turn to a true heading by the shorter side, and hold it.

        Raises
        ------
        ValueError
            It is not finite.
        """
        require_finite("heading_rad", heading_rad)
        self._commanded().lateral = Heading(heading_rad, self._gains.course_per_s)

    def turn_by(self, angle_rad: float) -> None:
        """Turn from the present track by an angle, positive to the right, and hold the new track.

        Raises
        ------
        ValueError
            It is not finite, or more than a full circle.
        """
        require_finite("angle_rad", angle_rad)
        if abs(angle_rad) > 2.0 * math.pi:
            raise ValueError(f"angle_rad is {angle_rad}; expected within +-2 pi")
        track = wrap_angle(self.state.track_rad + angle_rad)
        self._commanded().lateral = Track(track, self._gains.course_per_s, angle_rad)

    def hold_altitude(
        self, altitude_m: float, vertical_rate_m_s: float | None = None
    ) -> AltitudeClearance:
        """Climb or descend to an altitude, level off, and hold it.

        Parameters
        ----------
        altitude_m
            Above the service ceiling, the ceiling is taken.
        vertical_rate_m_s
            Positive; above the type's greatest rate, that is taken. By default the type's own.

        Returns
        -------
        AltitudeClearance
            What was accepted.

        Raises
        ------
        ValueError
            A value is not finite, or the rate not positive.
        """
        require_finite("altitude_m", altitude_m)
        speeds = self.kind.speeds
        up = altitude_m >= self.state.altitude_m
        limit = (
            speeds.maximum_climb_rate_fpm if up else speeds.maximum_descent_rate_fpm
        ) * FOOT_PER_MINUTE
        if vertical_rate_m_s is None:
            vertical_rate_m_s = speeds.climb_rate_fpm * FOOT_PER_MINUTE
        require_finite("vertical_rate_m_s", vertical_rate_m_s)
        if vertical_rate_m_s <= 0.0:
            raise ValueError(f"vertical_rate_m_s is {vertical_rate_m_s}; expected more than 0")
        accepted = AltitudeClearance(
            min(altitude_m, speeds.service_ceiling_ft * FOOT), min(vertical_rate_m_s, limit)
        )
        self._commanded().vertical = Altitude(accepted, self._gains.altitude_per_s)
        return accepted

    def hold_speed(self, calibrated_airspeed_m_s: float) -> float:
        """Accelerate or decelerate to a calibrated airspeed, and hold it.

        Parameters
        ----------
        calibrated_airspeed_m_s
            Brought between the type's slowest clean speed and its greatest speed and Mach number,
            at the present altitude.

        Returns
        -------
        float
            What was accepted.

        Raises
        ------
        ValueError
            It is not finite.
        """
        require_finite("calibrated_airspeed_m_s", calibrated_airspeed_m_s)
        slowest, greatest = self._speed_limits(self.state.altitude_m)
        accepted = min(max(calibrated_airspeed_m_s, slowest), greatest)
        self._commanded().speed = Airspeed(accepted, self.kind.speeds.maximum_mach)
        return accepted

    def land(self, runway: RunwayEnd, exit_path: Sequence[Place] = ()) -> None:
        """Join the final approach of a runway, land on it, and leave it.

        Below the glide path the present altitude is held until the path is met.

        Parameters
        ----------
        runway
            To land on.
        exit_path
            From the runway's centre line to where the aircraft stands at the end; without one it
            stops on the runway.

        Raises
        ------
        ValueError
            It is on the ground, or too far from the final approach to join it.
        """
        self._require_airborne("land")
        final = Final(runway, self.kind)
        final.require_reachable(self.state)
        self._approach(final, exit_path)

    def side_step(self, runway: RunwayEnd, exit_path: Sequence[Place] = ()) -> None:
        """Leave the approach that is flown for that of another runway.

        Parameters
        ----------
        runway, exit_path
            As for `land`.

        Raises
        ------
        ValueError
            There is no approach, it is too late, or the other runway's approach is too far off.
        """
        if not isinstance(self._phase, Glide):
            raise ValueError(f"side_step in phase {self.phase}; expected glide")
        final = Final(runway, self.kind)
        require_side_step(self.state, final)
        self._approach(final, exit_path)

    def go_around(self, climb_to_m: float) -> None:
        """Break off the approach: climb on the runway's course to an altitude, and level off.

        Parameters
        ----------
        climb_to_m
            The altitude.

        Raises
        ------
        ValueError
            No approach is flown, the wheels have touched, or the altitude is not finite or not
            above.
        """
        require_finite("climb_to_m", climb_to_m)
        if not isinstance(self._phase, Glide | Flare) or self.on_ground:
            raise ValueError(f"go_around in phase {self.phase}; expected glide or flare")
        if climb_to_m <= self.state.altitude_m:
            raise ValueError(
                f"climb_to_m is {climb_to_m:.0f}; expected more than the altitude now, "
                f"{self.state.altitude_m:.0f}"
            )
        self._modes = self._climb_to(self._phase.final, climb_to_m)
        self._phase = GoAround(self._cockpit, self._modes)

    def taxi(
        self, path: Sequence[Place], speed_m_s: float | None = None, *, then: Stand = "standing"
    ) -> None:
        """Taxi along a path from here, and stand at its end.

        Parameters
        ----------
        path
            To follow.
        speed_m_s
            At most; by default what the type taxies at.
        then
            What standing at the end is: ``lined_up`` on a runway.

        Raises
        ------
        ValueError
            It is in the air or too fast, or there is no path.
        """
        self._require_on_ground("taxi", FASTEST_TAXI_M_S)
        if not path:
            raise ValueError("the path is empty; expected a place to taxi to")
        ground = self.kind.ground
        speed = ground.taxi_speed_kt * KNOT if speed_m_s is None else speed_m_s
        here = (self.state.latitude_rad, self.state.longitude_rad)
        track = TaxiPath([here, *path], speed, ground.look_ahead_m)
        called: Way = "line_up" if then == "lined_up" else "taxi"
        self._phase = Taxi(self._cockpit, track, called, then)

    def hold_position(self) -> None:
        """Stop on the way, and stay until `resume_taxi`; where it stands already, it stays.

        Raises
        ------
        ValueError
            It does not taxi.
        """
        if isinstance(self._phase, Standing):
            return
        if not isinstance(self._phase, Taxi):
            raise ValueError(f"hold_position in phase {self.phase}; expected taxi")
        self._phase.hold()

    def resume_taxi(self) -> None:
        """Go on after `hold_position`.

        Raises
        ------
        ValueError
            It is not holding its position on a way.
        """
        if not isinstance(self._phase, Taxi):
            raise ValueError(f"resume_taxi in phase {self.phase}; expected a taxi that was held")
        self._phase.resume()

    def take_off(self, runway: RunwayEnd, climb_to_m: float) -> None:
        """Take off from where it is, climb on the runway's course, and level off.

        Parameters
        ----------
        runway
            On which it stands or taxies, in its direction.
        climb_to_m
            The altitude.

        Raises
        ------
        ValueError
            It is in the air or not lined up, or the altitude is not finite or not above.
        """
        require_finite("climb_to_m", climb_to_m)
        self._require_on_ground("take_off", FASTEST_TAXI_M_S)
        line = Final(runway, self.kind)
        require_lined_up(self.state, line)
        if climb_to_m <= self.state.altitude_m:
            raise ValueError(
                f"climb_to_m is {climb_to_m:.0f}; expected more than the altitude now, "
                f"{self.state.altitude_m:.0f}"
            )
        self._modes = self._climb_to(line, climb_to_m)
        self._phase = TakeoffRoll(self._cockpit, line, self._modes)

    def reject_takeoff(self) -> None:
        """Stop on the runway.

        Raises
        ------
        ValueError
            It does not roll for takeoff.
        """
        if not isinstance(self._phase, TakeoffRoll):
            raise ValueError(f"reject_takeoff in phase {self.phase}; expected takeoff_roll")
        self._phase = RejectedTakeoff(self._cockpit, self._phase.line)

    def fail_engine(self, engine: int) -> None:
        """Stop an engine, counted from 0, for good; what is flown goes on.

        It stops at the end of the next tick: what is set before the first one, JSBSim undoes.

        Raises
        ------
        ValueError
            There is no such engine.
        """
        self._airframe.require_engine(engine)
        self._failing.append(engine)

    def drift_down(self) -> None:
        """Descend to where the remaining engines keep the altitude at drift-down speed.

        The track or the route goes on. A turn commanded meanwhile is flown; an altitude commanded
        meanwhile is not gone below.

        Raises
        ------
        ValueError
            It is on the ground.
        """
        self._require_airborne("drift_down")
        speeds = self.kind.speeds
        modes = self._commanded()
        self._airframe.clean_up()
        modes.vertical = Altitude(
            AltitudeClearance(-1000.0, speeds.maximum_descent_rate_fpm * FOOT_PER_MINUTE),
            self._gains.altitude_per_s,
        )
        modes.speed = Airspeed(speeds.drift_down_kt * KNOT, speeds.maximum_mach)
        self._phase = DriftDown(self._cockpit, modes)

    def emergency_descent(self, altitude_m: float) -> None:
        """Descend as fast as the type safely can, and level off.

        Parameters
        ----------
        altitude_m
            To level off at.

        Raises
        ------
        ValueError
            It is not finite or not below, or the aircraft is on the ground.
        """
        self._require_airborne("emergency_descent")
        require_finite("altitude_m", altitude_m)
        if altitude_m >= self.state.altitude_m:
            raise ValueError(
                f"altitude_m is {altitude_m:.0f}; expected less than the altitude now, "
                f"{self.state.altitude_m:.0f}"
            )
        modes = self._commanded()
        self._airframe.clean_up()
        rate = self.kind.speeds.maximum_descent_rate_fpm * FOOT_PER_MINUTE
        modes.vertical = Altitude(AltitudeClearance(altitude_m, rate), self._gains.altitude_per_s)
        self._phase = EmergencyDescent(self._cockpit, modes)

    def _approach(self, final: Final, exit_path: Sequence[Place]) -> None:
        """Fly the final approach, from the present altitude."""
        speeds = self.kind.speeds
        self._phase = Glide(self._cockpit, final, exit_path, self.state.altitude_m)
        self._modes = EnRoute(
            self._cockpit,
            final,
            Altitude(
                AltitudeClearance(
                    final.runway.elevation_m, speeds.climb_rate_fpm * FOOT_PER_MINUTE
                ),
                self._gains.altitude_per_s,
            ),
            Airspeed(speeds.approach_kt * KNOT, speeds.maximum_mach),
        )

    def _commanded(self) -> EnRoute:
        """Return the modes that a command changes; end the procedure that does not know them.

        Raises
        ------
        ValueError
            The aircraft is on the ground.
        """
        if not self._phase.commandable:
            self._require_airborne("an en-route command")
            speeds = self.kind.speeds
            self._airframe.clean_up()
            self._phase = self._modes = EnRoute(
                self._cockpit,
                Track(self.state.track_rad, self._gains.course_per_s),
                Altitude(
                    AltitudeClearance(
                        self.state.altitude_m, speeds.climb_rate_fpm * FOOT_PER_MINUTE
                    ),
                    self._gains.altitude_per_s,
                ),
                Airspeed(speeds.minimum_clean_kt * KNOT, speeds.maximum_mach),
            )
        return self._modes

    def _climb_to(self, lateral: LateralMode, altitude_m: float) -> EnRoute:
        """Return the modes of a climb to an altitude at the slowest clean airspeed."""
        speeds = self.kind.speeds
        clearance = AltitudeClearance(
            min(altitude_m, speeds.service_ceiling_ft * FOOT),
            speeds.maximum_climb_rate_fpm * FOOT_PER_MINUTE,
        )
        slowest = max(speeds.minimum_clean_kt, speeds.climb_safety_kt) * KNOT
        return EnRoute(
            self._cockpit,
            lateral,
            Altitude(clearance, self._gains.altitude_per_s),
            Airspeed(slowest, speeds.maximum_mach),
        )

    def _require_on_ground(self, what: str, fastest_m_s: float) -> None:
        if not self.on_ground:
            raise ValueError(f"{what} in phase {self.phase} in the air; expected on the ground")
        speed = self.state.ground_speed_m_s
        if speed > fastest_m_s:
            raise ValueError(
                f"{what} at {speed / KNOT:.0f} kt; expected at most {fastest_m_s / KNOT:.0f} kt"
            )

    def _require_airborne(self, what: str) -> None:
        if self.on_ground:
            raise ValueError(f"{what} in phase {self.phase} on the ground; expected in the air")

    def _initial_altitude(self, initial: InitialCondition, terrain_elevation_m: float) -> Altitude:
        speeds = self.kind.speeds
        rate = initial.vertical_rate_m_s
        altitude = initial.altitude_m
        if rate > 0.0:
            altitude = speeds.service_ceiling_ft * FOOT
        elif rate < 0.0:
            altitude = terrain_elevation_m
        clearance = AltitudeClearance(
            altitude, abs(rate) or speeds.climb_rate_fpm * FOOT_PER_MINUTE
        )
        return Altitude(clearance, self._gains.altitude_per_s)

    def _flown(
        self,
        initial: InitialCondition,
        atmosphere: Atmosphere,
        terrain_elevation_m: float,
        tick_s: float,
    ) -> Autopilot:
        """Begin in flight; return the autopilot that flies."""
        self._check_initial(initial, terrain_elevation_m)
        heading = heading_to_track(initial, atmosphere)
        begin = self._trimmed if self.kind.start == "trim" else self._settled
        autopilot = begin(initial, heading, tick_s)
        self._airframe.release(initial, atmosphere)
        return autopilot

    def _stood(self, initial: OnGround, atmosphere: Atmosphere, tick_s: float) -> Autopilot:
        """Begin on the wheels; return the autopilot that will fly."""
        airframe = self._airframe
        airframe.start_on_ground(initial)
        airframe.set_brakes(1.0)
        if self.kind.start == "settle":
            airframe.crank()
        for seconds in (STARTING_TIME_S, IDLING_TIME_S):
            for _ in range(round(seconds / tick_s) * len(self._substeps)):
                airframe.step()
            airframe.set_throttle(0.0)
        airframe.blow(atmosphere)
        return Autopilot(airframe, self.kind, tick_s, airframe.state())

    def _trimmed(self, initial: InitialCondition, heading: float, tick_s: float) -> Autopilot:
        """Let JSBSim trim the airframe; return the autopilot that takes over."""
        self._airframe.start(initial, heading)
        self._airframe.trim()
        return Autopilot(self._airframe, self.kind, tick_s, self._airframe.state())

    def _settled(self, initial: InitialCondition, heading: float, tick_s: float) -> Autopilot:
        """Start the engines in flight, fly until all is steady; return the autopilot.

        It ends at the initial altitude.
        """
        rate, wanted = initial.vertical_rate_m_s, initial.calibrated_airspeed_m_s
        before = initial.altitude_m - rate * SETTLING_TIME_S
        self._airframe.start(replace(initial, altitude_m=before), heading)
        self._airframe.crank()
        lateral = Track(heading, self._gains.course_per_s)
        vertical = self._initial_altitude(replace(initial, vertical_rate_m_s=0.0), 0.0)
        state = self._airframe.state()
        autopilot = Autopilot(self._airframe, self.kind, tick_s, state)
        for _ in range(round(SETTLING_TIME_S / tick_s)):
            autopilot.fly(
                state,
                lateral.turn_rate(state),
                rate or vertical.vertical_rate(state),
                wanted,
            )
            for _ in self._substeps:
                self._airframe.step()
            state = self._airframe.state()
        error = abs(state.calibrated_airspeed_m_s - wanted)
        if not error < SETTLED_SPEED_M_S:
            raise ModelError(
                f"{self.kind.name} cannot fly steadily at {wanted / KNOT:.0f} kt at "
                f"{state.altitude_m / FOOT:.0f} ft: it came to "
                f"{state.calibrated_airspeed_m_s / KNOT:.0f} kt"
            )
        return autopilot

    def _check_initial(self, initial: InitialCondition, terrain_elevation_m: float) -> None:
        ceiling = self.kind.speeds.service_ceiling_ft * FOOT
        if not terrain_elevation_m < initial.altitude_m <= ceiling:
            raise ValueError(
                f"altitude_m is {initial.altitude_m:.0f}; expected between the terrain at "
                f"{terrain_elevation_m:.0f} m and the service ceiling of {self.kind.name} at "
                f"{ceiling:.0f} m"
            )
        slowest, fastest = self._speed_limits(initial.altitude_m)
        if initial.on_approach:
            slowest = self.kind.speeds.approach_kt * KNOT
        if not slowest <= initial.calibrated_airspeed_m_s <= fastest:
            raise ValueError(
                f"calibrated_airspeed_m_s is {initial.calibrated_airspeed_m_s:.1f}; expected "
                f"{slowest:.1f} to {fastest:.1f} for {self.kind.name} at "
                f"{initial.altitude_m:.0f} m"
            )

    def _speed_limits(self, altitude_m: float) -> tuple[float, float]:
        """Return the slowest and the greatest calibrated airspeed (m/s) of guidance."""
        speeds = self.kind.speeds
        greatest = min(
            speeds.maximum_kt * KNOT,
            standard_atmosphere.calibrated_airspeed(speeds.maximum_mach, altitude_m),
        )
        return speeds.minimum_clean_kt * KNOT, greatest
