"""En-route operations of a crew: direct to a fix, orbits, holds, speeds and rates."""

from __future__ import annotations

import math
from functools import partial

from airhilt.commands import (
    Command,
    CrossFixCommand,
    DirectCommand,
    HoldAtCommand,
    MachCommand,
    OrbitCommand,
    ResumeRouteCommand,
    ResumeSpeedCommand,
    Side,
    SpeedCommand,
    VerticalRateCommand,
)
from airhilt.geodesy.local_frame import LocalFrame
from airhilt.geodesy.wgs84 import Place, azimuth, distance_m
from airhilt.units import DEGREE, FOOT, FOOT_PER_MINUTE, KNOT, NAUTICAL_MILE
from airhilt.world.actors.actor import Act, Unable
from airhilt.world.actors.circuit import radius_now_m, turn_radius_m
from airhilt.world.actors.envelope import LOWEST_HEIGHT_FT, Envelope
from airhilt.world.actors.runway_operations import APPROACHING
from airhilt.world.flight import standard_atmosphere
from airhilt.world.flight.aircraft import Aircraft
from airhilt.world.flight.curves import Curve, Pose, line, shortest, turn
from airhilt.world.site import ScenarioSite
from airhilt.world.truth.flown_conditions import has_passed

STANDARD_RATE_RAD_S = 3.0 * DEGREE
"""Greatest turn rate of an orbit or a hold, in rad/s (ICAO Doc 8168 volume I, holding: 3 degrees a
second, or the rate at a bank of 25 degrees if that is less)."""
HOLDING_LEGS = ((14_000.0, 230.0, 60.0), (20_000.0, 240.0, 90.0))
"""Greatest holding speeds in kt and times outbound in s, up to levels in ft, and `HIGH_HOLDING`
above (ICAO Doc 8168 volume I, table of holding speeds)."""
HIGH_HOLDING = (265.0, 90.0)
SAME_PLACE_M = 0.1 * NAUTICAL_MILE
"""Distance in m within which a fix is a waypoint of the route."""
PART_OF_RATE = 0.97
"""Part of the distance to a fix in which a level is reached that is told for it; assumed."""
LEVEL_M = 200.0 * FOOT
"""Distance in m from a level that is still to be reached (AIM 4-5-2)."""


class EnRouteOperations:
    """Carries out the commands of one crew about fixes, orbits, holds, speeds and rates.

    `plan` says what a command will do, or raises `Unable`; nothing changes before it is done.
    """

    def __init__(self, aircraft: Aircraft, site: ScenarioSite) -> None:
        self._aircraft = aircraft
        self._site = site
        self._beyond: tuple[Place, float, float] | None = None
        """Fix to pass, the altitude there, and that to go on to from there, in m."""

    def plan(self, command: Command) -> Act | None:
        """Return what carries out a command; None for one that is about something else."""
        match command:
            case DirectCommand(to=to):
                return self._plan_direct(to)
            case OrbitCommand(turn=side):
                return self._plan_orbit(side)
            case HoldAtCommand(fix=fix, turn=side):
                return self._plan_hold(fix, side)
            case CrossFixCommand():
                return self._plan_crossing(command)
            case SpeedCommand(cas_kt=cas_kt):
                return self._plan_speed(cas_kt * KNOT)
            case MachCommand(mach=mach):
                altitude_m = self._aircraft.state.altitude_m
                cas_m_s = standard_atmosphere.calibrated_airspeed(mach, altitude_m)
                self._require(SpeedCommand(action="speed", cas_kt=cas_m_s / KNOT))
                return self._plan_speed(cas_m_s)
            case ResumeSpeedCommand():
                return self._plan_usual_speed()
            case VerticalRateCommand(vertical_rate_fpm=rate_fpm):
                return self._plan_rate(rate_fpm)
            case ResumeRouteCommand() if not self._aircraft.en_route.left_route:
                raise Unable("unable, no route to resume")
        return None

    # --- lateral ------------------------------------------------------------------------------

    def _plan_direct(self, name: str) -> Act:
        place = self._fix(name)
        if distance_m(self._aircraft.state.place, place) < SAME_PLACE_M:
            raise Unable(f"unable, over {name} already")
        route = self._aircraft.en_route.left_route
        on = next((i for i, p in enumerate(route) if distance_m(p, place) < SAME_PLACE_M), None)
        after = () if on is None else route[on + 1 :]
        return partial(self._aircraft.en_route.fly_route, [place, *after])

    def _plan_orbit(self, side: Side) -> Act:
        self._require_height()
        frame = LocalFrame(self._aircraft.state.place)
        circle = turn(Pose(0.0, 0.0, self._track_rad), _sign(side) * math.tau, self._radius_m())
        curve = Curve(frame, (circle,))
        if self._aircraft.phase in APPROACHING:
            return partial(self._aircraft.procedures.orbit, curve)
        return partial(self._aircraft.en_route.fly_curve, curve, and_back=True)

    def _plan_hold(self, name: str, side: Side) -> Act:
        self._require_height()
        aircraft, place, here = self._aircraft, self._fix(name), self._aircraft.state.place
        slow_m_s, outbound_s = self._holding()
        state, kind = aircraft.state, aircraft.kind
        ratio = state.true_airspeed_m_s / state.calibrated_airspeed_m_s
        speed_m_s = min(slow_m_s, aircraft.target_speed_m_s) * ratio
        radius_m = max(turn_radius_m(kind, speed_m_s), speed_m_s / STANDARD_RATE_RAD_S)
        frame = LocalFrame(place)
        east, north = frame.to_local(here)
        start = Pose(east, north, self._track_rad)
        is_there = distance_m(here, place) < 2.0 * radius_m
        inbound = self._track_rad if is_there else azimuth(here, place)
        to_fix = shortest(start, Pose(0.0, 0.0, inbound), radius_now_m(kind, state), radius_m)
        away = turn(Pose(0.0, 0.0, inbound), _sign(side) * math.pi, radius_m)
        outbound = line(away.end, speed_m_s * outbound_s)
        back = turn(outbound.end, _sign(side) * math.pi, radius_m)
        pattern = (away, outbound, back, line(back.end, outbound.length_m))
        curve = Curve(frame, (*to_fix, *pattern), repeat_from=len(to_fix))

        def hold() -> None:
            aircraft.en_route.fly_curve(curve)
            if aircraft.target_speed_m_s > slow_m_s:
                aircraft.en_route.hold_speed(slow_m_s)

        return hold

    def _holding(self) -> tuple[float, float]:
        """Return the greatest holding speed in m/s, and the time of the outbound leg in s."""
        level_ft = self._aircraft.state.altitude_m / FOOT
        legs = (leg[1:] for leg in HOLDING_LEGS if level_ft <= leg[0])
        greatest_kt, outbound_s = next(legs, HIGH_HOLDING)
        slowest_kt = self._aircraft.kind.speeds.minimum_clean_kt
        return max(greatest_kt, slowest_kt) * KNOT, outbound_s

    # --- vertical, and speed ------------------------------------------------------------------

    def _plan_crossing(self, command: CrossFixCommand) -> Act:
        aircraft, place = self._aircraft, self._fix(command.fix)
        here, level_m = aircraft.state.place, command.altitude_ft * FOOT
        bearing = azimuth(here, place) - self._track_rad
        route = aircraft.en_route.waypoints_ahead
        if math.cos(bearing) < 0.0 and not any(distance_m(p, place) < SAME_PLACE_M for p in route):
            raise Unable(f"unable, {command.fix} is behind us")
        change_m = level_m - aircraft.state.altitude_m
        if (command.bound == "or_more" and change_m < 0.0) or (
            command.bound == "or_less" and change_m > 0.0
        ):
            return partial(self._stay, command, place, None)
        speed_m_s = max(aircraft.state.ground_speed_m_s, 1.0)
        time_s = PART_OF_RATE * distance_m(here, place) / speed_m_s
        rate_m_s = abs(change_m) / max(time_s, 1.0)
        speeds = aircraft.kind.speeds
        greatest_fpm = (
            speeds.maximum_climb_rate_fpm if change_m > 0.0 else speeds.maximum_descent_rate_fpm
        )
        if rate_m_s > greatest_fpm * FOOT_PER_MINUTE:
            raise Unable(f"unable {command.altitude_ft:g} ft by {command.fix}")
        rate_m_s = max(rate_m_s, min(speeds.climb_rate_fpm, greatest_fpm) * FOOT_PER_MINUTE)
        return partial(self._stay, command, place, rate_m_s)

    def _stay(self, command: CrossFixCommand, place: Place, rate_m_s: float | None) -> None:
        """Fly to where the fix is passed, and remember the level beyond it that was told before."""
        aircraft, level_m = self._aircraft, command.altitude_ft * FOOT
        told_m, now_m = aircraft.target_altitude_m, aircraft.state.altitude_m
        by_m = {"or_more": max(told_m, level_m), "or_less": min(told_m, level_m)}.get(
            command.bound or "", level_m
        )
        if by_m != told_m or rate_m_s is not None:
            aircraft.en_route.hold_altitude(by_m, rate_m_s)
        is_on_the_way = abs(told_m - now_m) > LEVEL_M and by_m != told_m
        self._beyond = (place, by_m, told_m) if is_on_the_way else None

    def forget(self) -> None:
        """Go on to no other level beyond a fix."""
        self._beyond = None

    def attend(self) -> None:
        """Go on to the level beyond a fix once that has been passed."""
        if self._beyond is None:
            return
        place, by_m, told_m = self._beyond
        is_kept = abs(self._aircraft.target_altitude_m - by_m) < 1.0
        if is_kept and has_passed(self._aircraft.state, place):
            self._beyond = None
            self._aircraft.en_route.hold_altitude(told_m)

    def _plan_rate(self, rate_fpm: float) -> Act:
        aircraft = self._aircraft
        target_m, altitude_m = aircraft.target_altitude_m, aircraft.state.altitude_m
        if abs(target_m - altitude_m) < 100.0 * FOOT:
            raise Unable("unable, we are level")
        why = Envelope(aircraft, self._site.ground_m).rate(rate_fpm, target_m > altitude_m)
        if why is not None:
            raise Unable(f"unable {why}")
        return partial(aircraft.en_route.hold_altitude, target_m, rate_fpm * FOOT_PER_MINUTE)

    def _plan_speed(self, cas_m_s: float) -> Act:
        preparation = self._aircraft.procedures.preparation
        if preparation is None:
            return partial(self._aircraft.en_route.hold_speed, cas_m_s)
        if preparation.is_slowed and cas_m_s > self._aircraft.kind.speeds.approach_kt * KNOT:
            raise Unable("unable, at approach speed")
        return partial(preparation.hold, cas_m_s)

    def _plan_usual_speed(self) -> Act:
        preparation = self._aircraft.procedures.preparation
        if preparation is not None:
            return partial(preparation.hold, None)
        return partial(
            self._aircraft.en_route.hold_speed, self._aircraft.kind.speeds.cruise_kt * KNOT
        )

    # --- where it is --------------------------------------------------------------------------

    @property
    def _track_rad(self) -> float:
        return self._aircraft.state.track_rad

    def _radius_m(self) -> float:
        """Return the radius of a turn at standard rate, or at the usual bank if that is less."""
        state = self._aircraft.state
        fastest_m_s = max(state.true_airspeed_m_s, state.ground_speed_m_s)
        return max(radius_now_m(self._aircraft.kind, state), fastest_m_s / STANDARD_RATE_RAD_S)

    def _fix(self, name: str) -> Place:
        place = self._site.fix(name)
        if place is None:
            raise Unable(f"unable, we do not have {name}, say heading")
        return place

    def _require(self, command: Command) -> None:
        why = Envelope(self._aircraft, self._site.ground_m).unflyable(command)
        if why is not None:
            raise Unable(f"unable {why}")

    def _require_height(self) -> None:
        if self._aircraft.state.height_agl_m < LOWEST_HEIGHT_FT * FOOT:
            raise Unable("unable, too low to turn")


def _sign(side: Side) -> float:
    return -1.0 if side == "left" else 1.0
