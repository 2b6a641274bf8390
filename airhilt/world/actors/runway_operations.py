"""Runway operations of a crew: taxi, line up, take off, land, go around."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from functools import partial
from typing import TYPE_CHECKING

from airhilt.commands import (
    CancelTakeoffCommand,
    Command,
    ContinueCommand,
    CrossCommand,
    GoAroundCommand,
    HoldPositionCommand,
    HoldShortCommand,
    LandCommand,
    LineUpCommand,
    RouteCommand,
    SideStepCommand,
    TakeOffCommand,
    TaxiCommand,
    TrackCommand,
    TurnCommand,
)
from airhilt.geodesy.wgs84 import Place
from airhilt.units import FOOT, KNOT, NAUTICAL_MILE, wrap_angle
from airhilt.world.actors.actor import Unable
from airhilt.world.actors.taxi_paths import exit_for, hold_beside, taxi_path
from airhilt.world.flight.aircraft import Aircraft
from airhilt.world.site import ScenarioSite
from airhilt.world.surface.runway import RunwayEnd

if TYPE_CHECKING:
    from airhilt.world.surface.layout import Layout

DECISION_SPEED_PART = 0.95
"""V1 as a part of the rotation speed: on dry runways the two lie within a few knots."""
DECISION_HEIGHT_M = 200.0 * FOOT
"""Height in m at which a crew without a landing clearance goes around (category I minimum)."""
GO_AROUND_CLIMB_M = 3000.0 * FOOT
"""Height above the airport that a go-around climbs to by default, in m."""
LEAST_CLIMB_M = 500.0 * FOOT
"""Least climb of a go-around that begins above that, in m."""
TOO_HIGH_M = 150.0 * FOOT
"""Height over the threshold from which a landing is broken off, in m. The normal height is 50 ft
(ICAO Annex 10 volume I, 3.1.5.1.4)."""
CAPTURE_ANGLE_RAD = math.radians(40.0)
"""Greatest angle to the final approach course at which it is joined, in rad."""
CAPTURE_DISTANCE_M = 0.5 * NAUTICAL_MILE
"""Greatest distance from the extended centre line at which the final approach is joined, in m."""


class FinalApproach:
    """Final approach of a runway, in the airport's plane."""

    def __init__(self, airport: Layout, runway: RunwayEnd) -> None:
        self.runway = runway
        self._frame = airport.local_frame
        self._east, self._north = airport.local_frame.to_local(runway.threshold)
        self._sin, self._cos = math.sin(runway.course_rad), math.cos(runway.course_rad)

    def before_m(self, here: Place) -> float:
        """Return the distance to the threshold along the approach, negative beyond it."""
        east, north = self._off_threshold(here)
        return -(east * self._sin + north * self._cos)

    def right_m(self, here: Place) -> float:
        """Return the distance to the right of the approach."""
        east, north = self._off_threshold(here)
        return east * self._cos - north * self._sin

    def angle_rad(self, track_rad: float) -> float:
        """Return the angle between a track and the approach, positive to the right."""
        return wrap_angle(track_rad - self.runway.course_rad)

    def _off_threshold(self, here: Place) -> tuple[float, float]:
        east, north = self._frame.to_local(here)
        return east - self._east, north - self._north


class RunwayOperations:
    """Carries out the commands of one crew about runways and taxiways.

    What cannot be carried out raises Unable, ValueError or ScenarioError.
    """

    def __init__(self, aircraft: Aircraft, site: ScenarioSite) -> None:
        self._final: FinalApproach | None = None
        """Final approach of the runway that the crew is going to use."""
        self._aircraft = aircraft
        self._site = site
        self._cleared_to_land = False
        self._next: Callable[[], bool] | None = None
        """Next step, tried several times a second until it returns True."""

    @property
    def bound_runway(self) -> str | None:
        """Runway that the crew is going to use, in the direction of use.

        None before it has one, and after it has left it.
        """
        return None if self._final is None else self._final.runway.ident

    def bind(self, runway: str) -> RunwayEnd:
        """Set the runway that the crew is going to use; return it."""
        end = self._site.runway(runway)
        self._final = FinalApproach(self._site.airport, end)
        return end

    # --- commands -----------------------------------------------------------------------------

    def carry_out(self, command: Command) -> bool:
        """Carry out a command; return False for one that is not about runways or taxiways."""
        match command:
            case TaxiCommand():
                self._taxi(command)
            case HoldPositionCommand() | HoldShortCommand():
                self._aircraft.procedures.hold_position()
                self._next = None
            case ContinueCommand() | CrossCommand():
                self._aircraft.procedures.resume_taxi()
            case LineUpCommand(runway=runway):
                self._line_up(runway)
            case TakeOffCommand(runway=runway, climb_to_ft=altitude):
                self._take_off(runway, altitude * FOOT)
            case CancelTakeoffCommand():
                self.cancel_takeoff()
            case LandCommand():
                self._land(command)
            case GoAroundCommand(climb_to_ft=altitude):
                self._break_off(altitude * FOOT)
            case SideStepCommand(runway=runway):
                self._side_step(runway)
            case RouteCommand() | TrackCommand() | TurnCommand():
                self._next = None
                return False
            case _:
                return False
        return True

    def begin_on_final(self, runway: str) -> None:
        """Fly the approach from where the aircraft is; it still needs a clearance to land."""
        self._aircraft.procedures.land(self.bind(runway))
        self._next = self._go_around_uncleared

    def attend(self) -> None:
        """Take the next step of an operation if it is due; a landing may become a go-around."""
        following, self._next = self._next, None
        if following is not None and not following() and self._next is None:
            self._next = following
        phase = self._aircraft.phase
        has_left = phase == "en_route" and self._next is None
        if phase in ("climb_out", "vacate") or has_left:
            self._final = None
        elif phase == "glide" and self._final is not None:
            self._go_around_if_too_high(self._final)

    # --- advisories ---------------------------------------------------------------------------

    def go_around(self) -> bool:
        """Break off the approach; return whether there was one."""
        aircraft = self._aircraft
        if aircraft.phase not in ("glide", "flare") or aircraft.on_ground:
            return False
        usual_m = self._site.ground_m + GO_AROUND_CLIMB_M
        self._break_off(max(usual_m, aircraft.state.altitude_m + LEAST_CLIMB_M))
        return True

    def cancel_takeoff(self) -> bool:
        """Cancel a takeoff, or reject it below the decision speed; return False above that."""
        aircraft = self._aircraft
        match aircraft.phase:
            case "takeoff_roll":
                decision = DECISION_SPEED_PART * aircraft.kind.speeds.rotate_kt * KNOT
                if aircraft.state.calibrated_airspeed_m_s > decision:
                    return False
                aircraft.procedures.reject_takeoff()
            case "line_up" | "taxi":
                aircraft.procedures.hold_position()
            case "lined_up" | "standing":
                pass
            case _:
                return False
        self._next = None
        return True

    def hold_position(self) -> bool:
        """Stop taxiing; return whether there was anything to stop."""
        if self._aircraft.phase not in ("taxi", "line_up"):
            return False
        self._next = None
        self._aircraft.procedures.hold_position()
        return True

    # --- steps --------------------------------------------------------------------------------

    def _here(self) -> Place:
        state = self._aircraft.state
        return state.latitude_rad, state.longitude_rad

    def _taxi(self, command: TaxiCommand) -> None:
        self._next = None
        nose_m = self._aircraft.kind.dimensions.length_m / 2.0
        path = taxi_path(self._site, self._here(), command, nose_m)
        speed = None if command.speed_kt is None else command.speed_kt * KNOT
        self._aircraft.procedures.taxi(path, speed)

    def _line_up(self, runway: str) -> None:
        aircraft, here = self._aircraft, self._here()
        final = FinalApproach(self._site.airport, self._site.runway(runway))
        if aircraft.phase == "taxi":
            self._next = partial(self._line_up_once_standing, runway)
        elif aircraft.phase not in ("lined_up", "line_up"):
            hold = hold_beside(self._site, here, runway)
            path = self._site.airport.entry_path(hold, runway)
            # After a hold on the way in, the aircraft goes on from there, not from the hold line.
            aside_m = abs(final.right_m(here))
            ahead = [place for place in path if abs(final.right_m(place)) < aside_m]
            aircraft.procedures.taxi([here, *(ahead or path[-1:])], then="lined_up")
        self._final = final

    def _line_up_once_standing(self, runway: str) -> bool:
        if self._aircraft.phase != "standing":
            return False
        self._line_up(runway)
        return True

    def _take_off(self, runway: str, climb_to_m: float) -> None:
        if self._aircraft.phase in ("takeoff_roll", "rotate"):
            raise Unable("unable, already rolling")
        self._line_up(runway)
        self._next = partial(self._roll_once_lined_up, runway, climb_to_m)
        self.attend()

    def _roll_once_lined_up(self, runway: str, climb_to_m: float) -> bool:
        if self._aircraft.phase == "standing":
            self._line_up(runway)
            return False
        if self._aircraft.phase != "lined_up":
            return False
        self._aircraft.procedures.take_off(self.bind(runway), climb_to_m)
        return True

    def _land(self, command: LandCommand) -> None:
        aircraft, site = self._aircraft, self._site
        if aircraft.on_ground:
            raise Unable("unable, on the ground")
        runway = site.runway(command.runway)
        bound = self.bound_runway
        on_final = aircraft.phase in ("glide", "flare") and not command.via
        if on_final and bound not in (None, runway.ident):
            raise Unable(f"unable, on final approach to runway {bound}")
        exit_path: Sequence[Place] = ()
        if command.vacate:
            speed_m_s = aircraft.kind.speeds.approach_kt * KNOT
            way_out = exit_for(site, runway, speed_m_s, command.exit)
            exit_path = way_out.path if way_out else ()
        self.bind(command.runway)
        self._cleared_to_land = True
        if command.via:
            via = [site.place(position) for position in command.via]
            aircraft.en_route.fly_route([*via, runway.threshold])
        self._next = partial(self._land_once_on_final, exit_path)
        if not command.via:
            self.attend()

    def _land_once_on_final(self, exit_path: Sequence[Place]) -> bool:
        final, state = self._final, self._aircraft.state
        here = self._here()
        if (
            final is None
            or final.before_m(here) <= 0.0
            or abs(final.angle_rad(state.track_rad)) > CAPTURE_ANGLE_RAD
            or abs(final.right_m(here)) > CAPTURE_DISTANCE_M
        ):
            return False
        self._aircraft.procedures.land(final.runway, exit_path)
        return True

    def _go_around_uncleared(self) -> bool:
        if self._cleared_to_land or self._aircraft.phase not in ("glide", "flare"):
            return True
        if self._aircraft.state.height_agl_m > DECISION_HEIGHT_M:
            return False
        if not self.go_around():
            return True
        raise Unable("unable, no clearance to land: going around")

    def _go_around_if_too_high(self, final: FinalApproach) -> None:
        """Break off an approach that has crossed the threshold too high."""
        too_high = self._aircraft.state.height_agl_m > TOO_HIGH_M
        if too_high and final.before_m(self._here()) < 0.0 and self.go_around():
            raise Unable("unable, too high over the threshold: going around")

    def _break_off(self, climb_to_m: float) -> None:
        self._cleared_to_land = False
        self._next = None
        self._aircraft.procedures.go_around(climb_to_m)
        self._final = None

    def _side_step(self, runway: str) -> None:
        self._aircraft.procedures.side_step(self._site.runway(runway))
        self.bind(runway)
