"""Departure of a crew: to line up, backtrack and take off, and to reject a takeoff."""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import partial
from typing import TYPE_CHECKING

from airhilt.commands import (
    BacktrackCommand,
    CancelTakeoffCommand,
    Command,
    EnterCommand,
    HoldPositionCommand,
    LineUpCommand,
    TakeOffCommand,
)
from airhilt.errors import ScenarioError
from airhilt.geodesy.wgs84 import Place
from airhilt.units import DEGREE, FOOT, KNOT
from airhilt.world.actors.actor import Act, Unable, do_nothing
from airhilt.world.actors.final_approach import FinalApproach
from airhilt.world.actors.ground_operations import GroundOperations
from airhilt.world.actors.runway_operations import RunwayOperations
from airhilt.world.actors.runway_turns import RunwayTurns
from airhilt.world.actors.taxi_paths import hold_beside
from airhilt.world.flight.aircraft import Aircraft
from airhilt.world.site import ScenarioSite
from airhilt.world.surface.runway import RunwayEnd

if TYPE_CHECKING:
    from airhilt.world.surface.layout import Hold

DECISION_SPEED_PART = 0.95
"""V1 as a part of the rotation speed: on dry runways the two lie within a few knots."""
LINED_UP_RAD = math.radians(15.0)
"""Greatest angle to the course of a runway at which an aircraft is lined up on it, in rad."""


class Departure:
    """Carries out the commands of one crew from the hold line to the takeoff roll.

    What cannot be carried out raises Unable, ValueError or ScenarioError before anything changes.
    """

    def __init__(
        self,
        aircraft: Aircraft,
        site: ScenarioSite,
        ground: GroundOperations,
        runways: RunwayOperations,
    ) -> None:
        self._aircraft = aircraft
        self._site = site
        self._ground = ground
        self._runways = runways
        self._next: Callable[[], bool] | None = None
        """Next step, tried several times a second until it returns True."""

    def plan(self, command: Command) -> Act | None:
        """Return what carries out a command; None for one that is not about a departure."""
        match command:
            case LineUpCommand(runway=runway):
                return self._plan_line_up(runway)
            case TakeOffCommand():
                return self._plan_take_off(command)
            case CancelTakeoffCommand():
                return self._plan_cancel()
            case HoldPositionCommand() if self._aircraft.phase == "takeoff_roll":
                return self._plan_cancel()
            case BacktrackCommand(runway=runway):
                return self._plan_backtrack(runway)
            case EnterCommand(runway=runway):
                self._require_on_ground()
                raise Unable(f"say again, line up or cross runway {runway}")
        return None

    def forget(self) -> None:
        """Take no further step of what was begun."""
        self._next = None

    def attend(self) -> None:
        """Take the next step if it is due, or raise `Unable`."""
        following, self._next = self._next, None
        if following is not None and not following() and self._next is None:
            self._next = following

    def cancel_takeoff(self) -> bool:
        """Cancel a takeoff, or reject it below the decision speed; return False above that."""
        try:
            self._plan_cancel()()
        except Unable:
            return False
        return True

    # --- plans --------------------------------------------------------------------------------

    def _plan_cancel(self) -> Act:
        aircraft = self._aircraft
        match aircraft.phase:
            case "takeoff_roll":
                decision = DECISION_SPEED_PART * aircraft.kind.speeds.rotate_kt * KNOT
                if aircraft.state.calibrated_airspeed_m_s > decision:
                    raise Unable("unable, above V one")
                do = aircraft.procedures.reject_takeoff
            case "line_up" | "taxi":
                do = aircraft.procedures.hold_position
            case "lined_up" | "standing":
                do = do_nothing
            case "rejected_takeoff":
                raise Unable("unable, takeoff rejected already")
            case "rotate" if aircraft.on_ground:
                raise Unable("unable, above V one")
            case _ if aircraft.on_ground:
                raise Unable("unable, we have landed")
            case _:
                raise Unable("unable, already airborne")

        def cancel() -> None:
            do()
            self._next = None

        return cancel

    def _plan_line_up(self, runway: str) -> Act:
        self._require_on_ground()
        end, strip = self._site.runway(runway), self._site.airport.strip_of(runway).name
        phase = self._aircraft.phase
        if phase in ("lined_up", "line_up"):
            bound = self._runways.bound_runway
            if bound not in (None, end.ident):
                raise Unable(f"unable, lined up on runway {bound}")
            return partial(self._wait, runway, None)
        if phase == "taxi" and self._ground.leads_to(strip):
            return partial(self._wait, runway, self._line_up_once_standing)
        if self._is_lined_up(end):
            return partial(self._wait, runway, None)
        try:
            hold = self._hold(runway)
        except Unable:
            return self._plan_taxi_first(runway)
        return self._plan_entry(hold, runway)

    def _plan_entry(self, hold: Hold, runway: str) -> Act:
        """Return what lines up from a hold, or from where the aircraft is beyond it."""
        here = self._aircraft.state.place
        final = FinalApproach(self._site.airport, self._site.runway(runway))
        try:
            path = self._site.airport.entry_path(hold, runway)
        except ScenarioError:
            raise Unable(f"unable, at the far end of runway {runway}") from None
        # After a hold on the way in, the aircraft goes on from there, not from the hold line.
        aside_m = abs(final.right_m(here))
        ahead = [place for place in path if abs(final.right_m(place)) < aside_m]
        return partial(self._taxi_on, [here, *(ahead or path[-1:])], runway)

    def _taxi_on(self, path: list[Place], runway: str) -> None:
        self._aircraft.procedures.taxi(path, then="lined_up")
        self._ground.forget()
        self._wait(runway, None)

    def _wait(self, runway: str, following: Callable[[str], bool] | None) -> None:
        self._runways.bind(runway)
        self._next = None if following is None else partial(following, runway)

    def _plan_taxi_first(self, runway: str) -> Act:
        """Return what taxies to the holding position, and then lines up."""
        if self._ground.stand is not None:
            raise Unable("unable, still at the stand")
        to_hold = self._ground.plan_to_hold(runway)

        def taxi() -> None:
            to_hold()
            self._wait(runway, self._line_up_once_standing)

        return taxi

    def _plan_take_off(self, command: TakeOffCommand) -> Act:
        line_up = self._plan_line_up(command.runway)

        def take_off() -> None:
            line_up()
            self._next = partial(self._roll_once_lined_up, command)
            self.attend()

        return take_off

    def _plan_backtrack(self, runway: str) -> Act:
        self._require_on_ground()
        airport, end = self._site.airport, self._site.runway(runway)
        final = FinalApproach(airport, end)
        path = [self._aircraft.state.place]
        turns_first = False
        if self._ground.is_on(airport.strip_of(runway).name):
            angle = abs(final.angle_rad(self._aircraft.state.heading_rad))
            turns_first = angle < math.pi / 2.0
        else:
            hold = self._hold(runway)
            inward = airport.taxiways.to_centreline(hold.name, hold.runway)
            path += [airport.node(name) for name in inward]
        from_start_m = end.displaced_m - final.before_m(path[-1])
        turns = RunwayTurns(end)
        back = turns.to_beginning(from_start_m)
        path += [*turns.back_from(from_start_m), *back] if turns_first else back
        return partial(self._taxi_on, path, runway)

    # --- steps --------------------------------------------------------------------------------

    def _line_up_once_standing(self, runway: str) -> bool:
        if self._aircraft.phase != "standing" or not self._ground.has_arrived:
            return False
        self._plan_entry(self._hold(runway), runway)()
        return True

    def _roll_once_lined_up(self, command: TakeOffCommand) -> bool:
        runway, track_deg = command.runway, command.track_deg
        end = self._site.runway(runway)
        if self._aircraft.phase == "standing" and not self._is_lined_up(end):
            if self._ground.has_arrived:
                self._plan_entry(self._hold(runway), runway)()
            return False
        if self._aircraft.phase not in ("lined_up", "standing"):
            return False
        track = () if track_deg is None else (track_deg * DEGREE,)
        climb_to_m = command.climb_to_ft * FOOT
        self._aircraft.procedures.take_off(self._runways.bind(runway), climb_to_m, *track)
        self._ground.forget()
        return True

    # --- where it is --------------------------------------------------------------------------

    def _hold(self, runway: str) -> Hold:
        """Return the holding position at which the aircraft stands, or raise `Unable`."""
        state = self._aircraft.state
        return hold_beside(self._site, state.place, runway, state.heading_rad)

    def _require_on_ground(self) -> None:
        """Raise `Unable` unless the aircraft can move to a runway now."""
        match self._aircraft.phase:
            case "takeoff_roll" | "rotate":
                raise Unable("unable, already rolling")
            case "rollout":
                raise Unable("unable, still rolling")
            case "rejected_takeoff":
                raise Unable("unable, rejecting takeoff")
            case _ if not self._aircraft.on_ground:
                raise Unable("unable, already airborne")

    def _is_lined_up(self, end: RunwayEnd) -> bool:
        """Return whether the aircraft stands on a runway, along its course."""
        final, here = FinalApproach(self._site.airport, end), self._aircraft.state.place
        angle = abs(final.angle_rad(self._aircraft.state.heading_rad))
        rolled_m = end.displaced_m - final.before_m(here)
        return (
            angle < LINED_UP_RAD
            and abs(final.right_m(here)) < end.width_m / 2.0
            and 0.0 <= rolled_m < end.length_m
        )
