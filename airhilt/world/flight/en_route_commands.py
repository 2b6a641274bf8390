"""En-route commands to an aircraft: track, heading, route, altitude and airspeed."""

from __future__ import annotations

import math
from collections.abc import Sequence

from airhilt.units import FOOT_PER_MINUTE, wrap_angle
from airhilt.world.flight.control import FlightControl
from airhilt.world.flight.guidance import AltitudeClearance, Route
from airhilt.world.flight.route import legs_through


class EnRouteCommands:
    """Changes the guidance modes of one aircraft.

    A command ends an approach; it changes what a climb or a descent procedure leads to. All raise
    ValueError on the ground.
    """

    def __init__(self, control: FlightControl) -> None:
        self._control = control
        self._route: Route | None = None

    def fly_route(self, waypoints: Sequence[tuple[float, float]]) -> None:
        """Fly from here through waypoints, then hold the last leg's track.

        Parameters
        ----------
        waypoints
            Each (latitude, longitude) in radians. Legs are geodesics; turns cut the corners.

        Raises
        ------
        ValueError
            No waypoint is away from here.
        """
        state = self._control.state
        legs = legs_through((state.latitude_rad, state.longitude_rad), waypoints)
        self._route = self._control.modes.route(legs)
        self._control.commanded().lateral = self._route

    def resume_route(self) -> None:
        """Go back to the route that was left for a track or a heading, intercepting its leg.

        Raises
        ------
        ValueError
            There is no route.
        """
        if self._route is None:
            raise ValueError("there is no route to resume; expected fly_route before")
        modes = self._control.commanded()
        if modes.lateral is not self._route:
            self._route.rejoin()
            modes.lateral = self._route

    def hold_track(self, track_rad: float) -> None:
        """Turn to a true track over the ground by the shorter side, and hold it."""
        self._control.commanded().lateral = self._control.modes.track(track_rad)

    def turn_by(self, angle_rad: float) -> None:
        """Turn from the present track by an angle, positive to the right, and hold the new track.

        Raises
        ------
        ValueError
            It is more than a full circle.
        """
        if abs(angle_rad) > 2.0 * math.pi:
            raise ValueError(f"angle_rad is {angle_rad}; expected within +-2 pi")
        track = wrap_angle(self._control.state.track_rad + angle_rad)
        self._control.commanded().lateral = self._control.modes.track(track, angle_rad)

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
            The altitude and the rate that are flown.
        """
        control = self._control
        if vertical_rate_m_s is None:
            vertical_rate_m_s = control.systems.kind.speeds.climb_rate_fpm * FOOT_PER_MINUTE
        accepted = control.modes.accepted_clearance(
            altitude_m, vertical_rate_m_s, is_climb=altitude_m >= control.state.altitude_m
        )
        control.commanded().vertical = control.modes.altitude(accepted)
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
            The airspeed that is flown, in m/s.
        """
        control = self._control
        slowest, greatest = control.modes.speed_limits_m_s(control.state.altitude_m)
        accepted = min(max(calibrated_airspeed_m_s, slowest), greatest)
        control.commanded().speed = control.modes.airspeed(accepted)
        return accepted
