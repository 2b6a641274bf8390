"""A recorded track: places, altitudes and times, and the smooth flight through them.

Latitude and longitude are cubic Hermite splines whose slopes are the central differences of the
record; the altitude is a monotone one, which overshoots no level. Velocity is their derivative.
Attitude follows from motion: the bank of a coordinated turn, the pitch of the path, and the heading
that makes good the track in the wind.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Sequence
from typing import Any, NamedTuple

import numpy as np

from airhilt.geodesy.wgs84 import Place, curvature_radii_m, distance_m, earth_centred, offset_m
from airhilt.scenario.models import OnTrack
from airhilt.units import DEGREE, FOOT, FOOT_PER_MINUTE, KNOT, STANDARD_GRAVITY, wrap_angle
from airhilt.world.flight import standard_atmosphere
from airhilt.world.flight.state import AircraftState, Atmosphere

FASTEST_M_S = 1000.0 * KNOT
"""Greatest ground speed of a track, in m/s; a jet stream carries airliners at 700 kt."""
STEEPEST_M_S = 20_000.0 * FOOT_PER_MINUTE
"""Greatest vertical rate of a track, in m/s."""
TIME_ERROR_S = 1.0
"""Error of the time between two points, in s: receivers stamp a position that is up to that old."""
ALTITUDE_STEP_M = 100.0 * FOOT
"""Coarsest step in which transponders send their altitude, in m (ICAO Annex 10, volume IV,
3.1.1.7.12.2)."""
LEVEL_M_S = 200.0 * FOOT_PER_MINUTE
"""Vertical rate below which a track is level, in m/s."""
TURN_S = 2.0
"""Time before and after an instant over which its rate of turn is taken, in s."""
ROLLING_M_S = 0.5
"""Ground speed in m/s below which an aircraft keeps its heading."""
LEAST_FLYING_M_S = 15.0
"""Ground speed in m/s below which an aircraft is not banked."""


class TrackPoint(NamedTuple):
    """One point of a recorded track."""

    t_s: float
    """Time since the start of the run."""
    latitude_rad: float
    longitude_rad: float
    altitude_m: float | None
    """Altitude in the standard atmosphere; None on the ground."""

    @property
    def place(self) -> Place:
        """Latitude and longitude."""
        return self.latitude_rad, self.longitude_rad


def points_of(track: OnTrack) -> tuple[TrackPoint, ...]:
    """Return the points of a track in SI and radians."""
    return tuple(
        TrackPoint(t_s, lat * DEGREE, lon * DEGREE, None if feet is None else feet * FOOT)
        for t_s, lat, lon, feet in track.points
    )


class TrackProblem(NamedTuple):
    """A point that cannot be flown to."""

    number: int
    """Number of the point, from 0."""
    field: str
    """Field of the point: ``time``, ``position`` or ``altitude``."""
    text: str


def track_problems(points: Iterable[TrackPoint]) -> Iterator[TrackProblem]:
    """Yield the points that step back in time, or that nothing reaches from the one before.

    A point that is yielded is left out of the comparison with those behind it.
    """
    last: TrackPoint | None = None
    airborne: TrackPoint | None = None
    for number, point in enumerate(points):
        problem = last and _step_problem(last, point)
        problem = problem or (airborne and _climb_problem(airborne, point))
        if problem is not None:
            yield TrackProblem(number, *problem)
            continue
        last = point
        airborne = airborne if point.altitude_m is None else point


def _step_problem(last: TrackPoint, point: TrackPoint) -> tuple[str, str] | None:
    passed_s = point.t_s - last.t_s
    if passed_s <= 0.0:
        return "time", f"{-passed_s:g} s before the one before; expected a later time"
    away_m = math.hypot(*offset_m(last.place, point.place))
    if away_m > FASTEST_M_S * (passed_s + TIME_ERROR_S):
        return "position", (
            f"{distance_m(last.place, point.place):,.0f} m from the one before, {passed_s:g} s "
            f"earlier; expected at most {FASTEST_M_S / KNOT:g} kt"
        )
    return None


def _climb_problem(last: TrackPoint, point: TrackPoint) -> tuple[str, str] | None:
    passed_s = point.t_s - last.t_s
    if last.altitude_m is not None and point.altitude_m is not None:
        up_m = abs(point.altitude_m - last.altitude_m)
        if up_m > STEEPEST_M_S * (passed_s + TIME_ERROR_S) + ALTITUDE_STEP_M:
            return "altitude", (
                f"{up_m / FOOT:,.0f} ft from the one before, {passed_s:g} s earlier; expected at "
                f"most {STEEPEST_M_S / FOOT_PER_MINUTE:,.0f} ft/min"
            )
    return None


class RecordedTrack:
    """The smooth flight through the points of a track, which are in order of time.

    Parameters
    ----------
    wheels_m
        Altitude of the aircraft's reference point while it stands on the ground.
    """

    def __init__(
        self, points: Sequence[TrackPoint], wheels_m: float, atmosphere: Atmosphere
    ) -> None:
        # Not at the top: scenarios without a recorded track start without SciPy.
        from scipy.interpolate import CubicHermiteSpline, PchipInterpolator

        self._points = points
        self._wheels_m = wheels_m
        self._atmosphere = atmosphere
        times = np.array([point.t_s for point in points])
        altitudes = np.array([self._altitude_m(point) for point in points])
        latitudes = np.array([point.latitude_rad for point in points])
        longitudes = np.unwrap([point.longitude_rad for point in points])
        self._times = times
        self._latitude, self._longitude = (
            CubicHermiteSpline(times, angles, np.gradient(angles, times))
            for angles in (latitudes, longitudes)
        )
        self._altitude = PchipInterpolator(times, altitudes)
        self._rates = [each.derivative() for each in self._splines]
        self._grounded = np.array([point.altitude_m is None for point in points])
        self._levels = _levels(times, altitudes)
        self._heading = self._first_heading()

    @property
    def _splines(self) -> tuple[Any, Any, Any]:
        return self._latitude, self._longitude, self._altitude

    @property
    def begin_s(self) -> float:
        """Time of the first point."""
        return float(self._times[0])

    @property
    def end_s(self) -> float:
        """Time of the last point."""
        return float(self._times[-1])

    def on_ground(self, t_s: float) -> bool:
        """Return whether it is on the ground at a time: between two points that are."""
        before, after = self._around(t_s)
        return bool(self._grounded[before] and self._grounded[after])

    def level_m(self, t_s: float) -> float:
        """Return the altitude in m at which the climb or descent of a time ends."""
        return float(self._levels[self._around(t_s)[0]])

    def places_after(self, t_s: float) -> list[Place]:
        """Return the places of the points in the air after a time."""
        return [
            point.place
            for point in self._points
            if point.t_s > t_s and point.altitude_m is not None
        ]

    def states(self, times_s: Sequence[float]) -> list[AircraftState]:
        """Return the states at times in order, each within the track."""
        at = np.array(times_s)
        latitude, longitude, altitude = (spline(at) for spline in self._splines)
        rates = [rate(at).tolist() for rate in self._rates]
        turns = (self._track(at + TURN_S) - self._track(at - TURN_S)).tolist()
        places = zip(latitude.tolist(), longitude.tolist(), altitude.tolist(), strict=True)
        motions = zip(*rates, turns, strict=True)
        return [
            self._state(t_s, *place, *motion)
            for t_s, place, motion in zip(times_s, places, motions, strict=True)
        ]

    def _state(
        self,
        t_s: float,
        latitude: float,
        longitude: float,
        altitude: float,
        latitude_rate: float,
        longitude_rate: float,
        climb: float,
        turn: float,
    ) -> AircraftState:
        longitude = wrap_angle(longitude)
        meridional, prime_vertical = curvature_radii_m(latitude)
        north = latitude_rate * (meridional + altitude)
        east = longitude_rate * (prime_vertical + altitude) * math.cos(latitude)
        speed = math.hypot(north, east)
        is_on_ground = self.on_ground(t_s)
        roll = pitch = 0.0
        wind_north, wind_east = self._atmosphere.wind_north_m_s, self._atmosphere.wind_east_m_s
        air_north, air_east = north - wind_north, east - wind_east
        airspeed = math.hypot(air_north, air_east, climb)
        if not is_on_ground and speed >= LEAST_FLYING_M_S:
            pitch = math.atan2(climb, speed)
            rate = wrap_angle(turn) / (2.0 * TURN_S)
            roll = math.atan(speed * rate / STANDARD_GRAVITY)
            self._heading = math.atan2(air_east, air_north) % math.tau
        elif speed >= ROLLING_M_S:
            self._heading = math.atan2(east, north) % math.tau
        mach = airspeed / standard_atmosphere.speed_of_sound(altitude)
        return AircraftState(
            latitude,
            longitude,
            altitude,
            max(altitude - self._wheels_m, 0.0),
            north,
            east,
            -climb,
            roll,
            pitch,
            self._heading,
            airspeed,
            standard_atmosphere.calibrated_airspeed(mach, altitude),
            mach,
            *earth_centred((latitude, longitude), altitude),
        )

    def _altitude_m(self, point: TrackPoint) -> float:
        return self._wheels_m if point.altitude_m is None else point.altitude_m

    def _track(self, times_s: np.ndarray) -> np.ndarray:
        """Return the true tracks (rad) at times, which are brought within the track."""
        at = np.clip(times_s, self._times[0], self._times[-1])
        north, east = self._rates[0](at), self._rates[1](at)
        tracks: np.ndarray = np.arctan2(east * np.cos(self._latitude(at)), north)
        return tracks

    def _around(self, t_s: float) -> tuple[int, int]:
        """Return the indexes of the points before and after a time."""
        after = int(np.searchsorted(self._times, t_s, side="right"))
        after = min(max(after, 1), len(self._times) - 1)
        return after - 1, after

    def _first_heading(self) -> float:
        """Return the true track (rad) where the aircraft first moves."""
        north = self._rates[0](self._times)
        east = self._rates[1](self._times) * np.cos(self._latitude(self._times))
        radius_m, _ = curvature_radii_m(float(self._latitude(self._times[0])))
        moving = np.flatnonzero(np.hypot(north, east) * radius_m >= ROLLING_M_S)
        first = int(moving[0]) if len(moving) else 0
        return float(np.arctan2(east[first], north[first])) % math.tau


def _levels(times: np.ndarray, altitudes: np.ndarray) -> np.ndarray:
    """Return the altitude at which the climb or descent behind each point ends."""
    rates = np.diff(altitudes) / np.diff(times)
    ways = np.where(np.abs(rates) < LEVEL_M_S, 0.0, np.sign(rates))
    levels = altitudes.copy()
    for index in range(len(ways) - 1, -1, -1):
        goes_on = index + 1 < len(ways) and ways[index] == ways[index + 1]
        levels[index] = levels[index + 1] if goes_on else altitudes[index + 1]
    return levels
