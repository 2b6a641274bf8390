"""One aircraft: an airframe, the laws that fly it, the guard that watches it."""

from __future__ import annotations

import math
from collections.abc import Sequence

from airhilt.flight import standard_atmosphere
from airhilt.flight.aircraft_type import AircraftType
from airhilt.flight.airframe import Airframe, heading_to_track
from airhilt.flight.autopilot import Autopilot
from airhilt.flight.guard import Guard
from airhilt.flight.guidance import (
    Airspeed,
    Altitude,
    AltitudeClearance,
    Heading,
    LateralMode,
    Route,
    Track,
)
from airhilt.flight.model import ModelError
from airhilt.flight.route import legs_through
from airhilt.flight.state import Atmosphere, InitialCondition, require_finite
from airhilt.units import DEGREE, FOOT, FOOT_PER_MINUTE, KNOT, wrap_angle

SETTLING_TIME_S = 40.0
"""For which a model that JSBSim cannot trim flies in still air before it begins."""

SETTLED_SPEED_M_S = 1.5 * KNOT
"""Error of airspeed that is left then, at most."""


class Aircraft:
    """One JSBSim aircraft under guidance.

    It begins in steady flight on its track, holding its altitude and its airspeed (or, with an
    initial vertical rate, climbing to its ceiling or descending to the ground at that rate, until
    it gets an altitude).

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
        initial: InitialCondition,
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
        self._check_initial(initial, terrain_elevation_m)

        self._airframe = airframe = Airframe(
            kind, step_s=tick_s / substeps, seed=seed, terrain_elevation_m=terrain_elevation_m
        )
        heading = heading_to_track(initial, atmosphere)
        self._lateral: LateralMode = Track(heading, self._gains.course_per_s)
        self._vertical = self._initial_altitude(initial, terrain_elevation_m)
        self._speed = Airspeed(initial.calibrated_airspeed_m_s, kind.speeds.maximum_mach)
        airframe.start(initial, heading)
        self._autopilot = self._trimmed(tick_s) if kind.start == "trim" else self._settled(tick_s)
        airframe.release(initial, atmosphere)
        self.state = airframe.state()
        self._lateral = Track(initial.track_rad, self._gains.course_per_s)

    @property
    def target_altitude_m(self) -> float:
        """The altitude that is flown to, or held."""
        return self._vertical.clearance.altitude_m

    @property
    def target_vertical_rate_m_s(self) -> float:
        """The vertical rate commanded now, positive up; 0 at the target altitude."""
        return self._vertical.vertical_rate(self.state)

    @property
    def target_speed_m_s(self) -> float:
        """The calibrated airspeed that is flown to, or held as far as the Mach limit lets it."""
        return self._speed.target_m_s

    def advance(self) -> None:
        """Fly one tick; do nothing once the flight has ended."""
        if self.ended is not None:
            return
        state = self.state
        self._autopilot.fly(
            state,
            self._lateral.turn_rate(state),
            self._vertical.vertical_rate(state),
            self._speed.airspeed(state),
        )
        step = self._airframe.step
        for _ in self._substeps:
            step()
        state = self._airframe.state()
        self.ended = self._guard.check(state)
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
        self._lateral = self._route

    def resume_route(self) -> None:
        """Go back to the route that was left for a track or a heading, intercepting its leg.

        Raises
        ------
        ValueError
            There is no route.
        """
        if self._route is None:
            raise ValueError("there is no route to resume; expected fly_route before")
        if self._lateral is not self._route:
            self._route.rejoin()
            self._lateral = self._route

    def hold_track(self, track_rad: float) -> None:
        """Turn to a true track over the ground by the shorter side, and hold it.

        Raises
        ------
        ValueError
            It is not finite.
        """
        require_finite("track_rad", track_rad)
        self._lateral = Track(track_rad, self._gains.course_per_s)

    def hold_heading(self, heading_rad: float) -> None:
        """Turn to a true heading by the shorter side, and hold it.

        Raises
        ------
        ValueError
            It is not finite.
        """
        require_finite("heading_rad", heading_rad)
        self._lateral = Heading(heading_rad, self._gains.course_per_s)

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
        self._lateral = Track(track, self._gains.course_per_s, angle_rad)

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
        self._vertical = Altitude(accepted, self._gains.altitude_per_s)
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
        self._speed = Airspeed(accepted, self.kind.speeds.maximum_mach)
        return accepted

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

    def _trimmed(self, tick_s: float) -> Autopilot:
        """Let JSBSim trim the airframe; return the autopilot that takes over."""
        self._airframe.trim()
        return Autopilot(self._airframe, self.kind, tick_s, self._airframe.state())

    def _settled(self, tick_s: float) -> Autopilot:
        """Start the engines in flight, fly until all is steady; return the autopilot."""
        self._airframe.crank()
        state = self._airframe.state()
        autopilot = Autopilot(self._airframe, self.kind, tick_s, state)
        for _ in range(round(SETTLING_TIME_S / tick_s)):
            autopilot.fly(
                state,
                self._lateral.turn_rate(state),
                self._vertical.vertical_rate(state),
                self._speed.airspeed(state),
            )
            for _ in self._substeps:
                self._airframe.step()
            state = self._airframe.state()
        wanted = self.target_speed_m_s
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
