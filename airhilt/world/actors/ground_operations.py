"""Ground operations of a crew or a driver: where to taxi or drive, and where to hold short."""

from __future__ import annotations

import math
from collections.abc import Sequence
from functools import partial
from typing import TYPE_CHECKING

from airhilt.commands import (
    Command,
    ContinueCommand,
    CrossCommand,
    EnterCommand,
    FollowCommand,
    GiveWayCommand,
    HoldPositionCommand,
    HoldShortCommand,
    PushBackCommand,
    TaxiCommand,
    TaxiToCommand,
    TurnAtCommand,
    VacateCommand,
)
from airhilt.geodesy.wgs84 import Place, azimuth, distance_m
from airhilt.units import KNOT
from airhilt.world.actors.actor import Act, Unable, do_nothing
from airhilt.world.actors.errand import Errand
from airhilt.world.actors.ground_bodies import GroundBody
from airhilt.world.actors.taxi_clearances import (
    hold_of,
    require_taxiway,
    strip_name,
    way_to,
)
from airhilt.world.actors.taxi_paths import hold_beside, taxi_path
from airhilt.world.actors.traffic import Passage, Traffic
from airhilt.world.actors.ways_off import clear_of_line, way_off
from airhilt.world.site import ScenarioSite
from airhilt.world.surface.ways import NOSE_MARGIN_M

if TYPE_CHECKING:
    from airhilt.world.actors.actor import Actor
    from airhilt.world.surface.layout import Hold
    from airhilt.world.surface.strips import RunwayStrip

BEHIND_M = 60.0
"""Distance that is kept between the tail of who is followed and the nose, in m; assumed: about two
lengths of a narrow-body airliner."""
TRAIL_STEP_M = 15.0
"""Distance between the places of who is followed that are kept, in m."""


class GroundOperations:
    """Moves one body over an airport as a controller says, and on to no runway without a clearance.

    `plan` says what a command will do, or raises `Unable`; nothing changes before it is done. A
    taxi clearance does not allow to cross a runway (FAA JO 7110.65, 3-7-2).
    """

    def __init__(self, body: GroundBody, site: ScenarioSite, traffic: Traffic) -> None:
        self._body = body
        self._site = site
        self._traffic = traffic
        self._errand: Errand | None = None
        self._next: TaxiToCommand | None = None
        """Clearance that is followed once the runway has been left."""
        self._told: TaxiToCommand | None = None
        """Clearance that is followed."""
        self._driven_to_m = 0.0
        """Where the body stops by itself, in metres along its way."""
        self._gives_way: Passage | None = None
        self._leader: Actor | None = None
        self._awaited: tuple[FollowCommand, Actor, Place] | None = None
        """Command to follow somebody once it has passed, who that is, and its last place."""

    # --- commands -----------------------------------------------------------------------------

    def plan(self, command: Command) -> Act | None:
        """Return what carries out a command; None for one that is not about the ground.

        `Unable`, ValueError or ScenarioError says why it cannot be carried out.
        """
        match command:
            case TaxiCommand():
                return self._plan_scripted(command)
            case TaxiToCommand():
                return self._plan_taxi(command)
            case HoldPositionCommand():
                return self._plan_hold_position()
            case ContinueCommand():
                return self._plan_continue()
            case HoldShortCommand(runway=runway, taxiway=taxiway):
                return self._plan_hold_short(runway, taxiway)
            case CrossCommand(runway=runway, at=at):
                return self._plan_cross(runway, at)
            case EnterCommand(runway=runway, at=at):
                return self._plan_enter(runway, at)
            case VacateCommand():
                return self._plan_vacate(command)
            case TurnAtCommand():
                return self._plan_turn(command)
            case FollowCommand():
                return self._plan_follow(command)
            case GiveWayCommand(to=to):
                return self._plan_give_way(to)
            case PushBackCommand():
                self._require_free()
                raise Unable(
                    "unable, no tug here, ready to taxi"
                    if self.stand is not None
                    else "unable, not at a stand"
                )
        return None

    def forget(self) -> None:
        """Forget the way, and what was to come after it: something else moves the body now."""
        self._errand = self._next = self._told = self._gives_way = None
        self._leader = self._awaited = None

    def attend(self) -> None:
        """Note how far it has come, and take the next step that is due, or raise `Unable`."""
        if self._next is not None and not self._body.busy and not self._body.is_rolling_out:
            command, self._next = self._next, None
            self._plan_taxi(command)()
        if self._gives_way is not None and self._gives_way.is_over():
            self._gives_way = None
            if self._errand is not None and not self._errand.is_done:
                self._go_on(self._errand)
        if self._awaited is not None:
            self._attend_awaited(*self._awaited)
        errand = self._errand
        if errand is None:
            return
        errand.come_to(self._here)
        if self._leader is not None and self._gives_way is None:
            self._attend_leader(errand, self._leader)

    @property
    def has_arrived(self) -> bool:
        """True if there is nowhere to go on to."""
        errand = self._errand
        return errand is None or (not self._body.is_moving and errand.is_done)

    def leads_to(self, strip: str) -> bool:
        """Return whether the way ends at a hold line of a runway, by its whole name.

        `Unable` says that it leads over another runway first, which is not cleared.
        """
        errand = self._errand
        if errand is None:
            return True
        if not self._ends_before(errand, strip):
            return False
        self._require_no_stop(errand)
        return True

    def plan_to_hold(self, runway: str) -> Act:
        """Return what goes to the holding position of a runway, without a stop before it."""
        self._require_free()
        errand = self._errand_to(TaxiToCommand(action="taxi_to", runway=runway))
        self._require_no_stop(errand)
        return partial(self._begin, errand)

    @staticmethod
    def _require_no_stop(errand: Errand) -> None:
        if errand.has_stops:
            raise Unable(f"unable, runway {errand.next_runway} is on our way")

    # --- to taxi ------------------------------------------------------------------------------

    def _plan_scripted(self, command: TaxiCommand) -> Act:
        """Return what goes to a given place, over any runway."""
        if self._body.is_airborne:
            raise Unable("unable, airborne")
        path = taxi_path(self._site, self._here, command, self._nose_m)
        speed = None if command.speed_kt is None else command.speed_kt * KNOT

        def go() -> None:
            self._body.go(path, speed)
            self.forget()
            if self._site.layout is not None:
                self._errand = self._errand_on([self._here, *path], speed, goes_on=False)
                self._errand.clear_all()
                self._driven_to_m = self._errand.limit_m

        return go

    def _plan_taxi(self, command: TaxiToCommand) -> Act:
        if self._body.is_rolling_out:
            way_to(self._site.airport, self._here, None, command)
            return partial(setattr, self, "_next", command)
        self._require_free()
        errand = self._errand_to(command)

        def begin() -> None:
            told = self._told
            self._begin(errand)
            self._told = command if command.runway or command.place else told

        return begin

    def _errand_to(self, command: TaxiToCommand) -> Errand:
        """Return the errand of a taxi clearance from here.

        One without an end changes the way, or ends where it holds short.
        """
        if command.runway is None and command.place is None and self._told is not None:
            to = {"runway": self._told.runway, "place": self._told.place}
            try:
                return self._errand_to(command.model_copy(update=to))
            except Unable:
                if not command.hold_short:
                    raise
        airport = self._site.airport
        way = way_to(airport, self._here, self._body.state.heading_rad, command)
        short_m = self._nose_m + NOSE_MARGIN_M if way.is_hold else 0.0
        errand = self._errand_on([self._here, *way.places], before_end_m=short_m)
        for runway in command.cross:
            if not errand.clear_next(strip_name(airport, runway)):
                raise Unable(f"unable, runway {runway} is not on our way")
        for name in command.hold_short:
            self._plan_hold_short_on(errand, name)()
        return errand

    def _plan_way_over(self, strip: str, places: Sequence[Place]) -> Act:
        """Return what follows a way from here over a runway, by its whole name."""
        errand = self._errand_on([self._here, *places])
        errand.clear_next(strip)
        return partial(self._begin, errand)

    def _plan_hold_position(self) -> Act:
        self._require_free()

        def hold() -> None:
            self._body.stop()
            self._next = self._gives_way = self._leader = self._awaited = None

        return hold

    def _plan_continue(self) -> Act:
        self._require_free()
        errand = self._errand
        if errand is None or errand.is_done:
            if not self._body.can_resume:
                raise Unable("unable, no further clearance")
            return self._body.resume
        if errand.waits_for_clearance:
            raise Unable(f"unable, holding short of runway {errand.next_runway}")

        def go_on() -> None:
            self._gives_way = None
            errand.pass_taxiways()
            self._go_on(errand)

        return go_on

    # --- at runways and taxiways --------------------------------------------------------------

    def _plan_hold_short(self, runway: str | None, taxiway: str | None) -> Act:
        errand = self._errand
        if self._body.is_rolling_out:
            return self._plan_hold_short_on_landing(runway, taxiway)
        self._require_free()
        if runway is None and taxiway is None:
            runway = None if errand is None else errand.next_runway
            if runway is None and any(map(self._is_before, self._site.airport.strips.values())):
                return self._body.stop
            if runway is None:
                raise Unable("say again, hold short of what")
        if taxiway is not None:
            require_taxiway(self._site.airport, taxiway)
        if runway is not None:
            self._require_off(runway)
        if errand is None or self.has_arrived:
            return self._body.stop
        hold = self._plan_hold_short_on(errand, runway or taxiway or "")

        def hold_short() -> None:
            hold()
            if self._body.is_moving:
                self._move(errand)

        self._require_room(errand, runway)
        return hold_short

    def _require_off(self, runway: str) -> None:
        """Raise `Unable` if the body is on a runway, or there is none of that name."""
        if self.is_on(strip_name(self._site.airport, runway)):
            raise Unable(f"unable, already on runway {runway}")

    def _require_room(self, errand: Errand, runway: str | None) -> None:
        """Raise `Unable` if the body is too fast to stop before a runway."""
        if runway is None:
            return
        room_m = errand.room_before_m(strip_name(self._site.airport, runway))
        speed = self._body.state.ground_speed_m_s
        if room_m is not None and speed**2 / (2.0 * self._body.braking_m_s2) > room_m:
            raise Unable(f"unable, too late to hold short of runway {runway}")

    def _plan_hold_short_on_landing(self, runway: str | None, taxiway: str | None) -> Act:
        """Return nothing to do if the way off the runway stays short of there."""
        airport = self._site.airport
        if taxiway is not None:
            require_taxiway(airport, taxiway)
        elif runway is not None:
            strip = strip_name(airport, runway)
            crossed = [pair for *pair, _ in airport.intersections if strip in pair]
            if self.is_on(strip) or any(self.is_on(name) for pair in crossed for name in pair):
                raise Unable(f"unable to hold short of runway {runway}")
        return do_nothing

    def _plan_hold_short_on(self, errand: Errand, name: str) -> Act:
        """Return what stops on a way before a runway or a taxiway; it changes the errand alone."""
        airport = self._site.airport
        is_runway = name[:1].isdigit()
        if is_runway:
            strip = strip_name(airport, name)
            if errand.crosses(strip):
                return partial(errand.hold_short_of_runway, strip)
            past = errand.has_crossed(strip)
            if not past and self._ends_before(errand, strip):
                return do_nothing
            what = f"runway {name}"
        else:
            require_taxiway(airport, name)
            if errand.meets(name):
                return partial(errand.hold_short_of_taxiway, name)
            past, what = errand.has_met(name), f"taxiway {name}"
        raise Unable(f"unable, past {what}" if past else f"unable, {what} is not on our way")

    def _plan_cross(self, runway: str | None, at: str | None) -> Act:
        self._require_free()
        airport, errand = self._site.airport, self._errand
        strip = None if runway is None else strip_name(airport, runway)
        if at is not None:
            require_taxiway(airport, at)
        if errand is not None and errand.crosses(strip):
            hold = errand.hold_before(strip)
            if at is not None and hold is not None and at not in (hold.taxiway, hold.position):
                raise Unable(f"unable, we cross at {hold.taxiway}")
            return partial(self._cross, errand, strip)
        if errand is not None and strip is not None and errand.is_crossing(strip):
            return do_nothing
        return self._plan_cross_from_hold(runway, at)

    def _cross(self, errand: Errand, strip: str | None) -> None:
        errand.clear_next(strip)
        if self._gives_way is None:
            self._move(errand)

    def _plan_cross_from_hold(self, runway: str | None, at: str | None) -> Act:
        """Return what goes from a hold line to beyond the one on the other side."""
        airport = self._site.airport
        if runway is None:
            raise Unable("say again, cross which runway")
        hold = self._hold_here(runway, at)
        way = airport.way_across(hold)
        if way is None:
            raise Unable(f"unable, taxiway {hold.taxiway} does not lead across runway {runway}")
        return self._plan_way_over(hold.runway, clear_of_line(airport, *way, self._nose_m))

    def _plan_enter(self, runway: str, at: str | None) -> Act:
        """Return what drives on to a runway, from the hold line here or from another."""
        self._require_free()
        airport = self._site.airport
        strip = strip_name(airport, runway)
        if self.is_on(strip):
            return self._body.stop
        places: list[Place] = []
        if at is None:
            hold = self._hold_here(runway, None)
        else:
            hold = hold_of(airport, runway, at, self._here)
            to_hold = TaxiToCommand(action="taxi_to", runway=runway, place=hold.position)
            heading_rad = self._body.state.heading_rad
            places = way_to(airport, self._here, heading_rad, to_hold).places[:-1]
        inward = airport.taxiways.to_centreline(hold.name, strip)
        places += [hold.place, *(airport.node(name) for name in inward[1:])]
        return self._plan_way_over(strip, places)

    def _plan_vacate(self, command: VacateCommand) -> Act:
        """Return what leaves the runway on which the body stands or moves."""
        self._require_free()
        strips = self._site.airport.strips.values()
        strip = next((strip for strip in strips if self.is_on(strip.name)), None)
        if strip is None:
            raise Unable("unable, not on a runway")
        errand = self._errand
        leaves = errand is not None and errand.is_crossing(strip.name) and not errand.is_done
        if errand is not None and leaves and command.exit is None and command.side is None:
            return partial(self._go_on, errand)
        heading_rad = self._body.state.heading_rad
        way = way_off(self._site, strip, self._here, heading_rad, self._nose_m, command)
        leaving = self._errand_on([self._here, *way])
        leaving.clear_from_runway(strip.name)
        return partial(self._begin, leaving)

    def _plan_turn(self, command: TurnAtCommand) -> Act:
        """Return what turns onto a taxiway, off the runway on which the body is or on its way."""
        name, side = command.taxiway, command.side
        if any(self.is_on(strip) for strip in self._site.airport.strips):
            return self._plan_vacate(VacateCommand(action="vacate", exit=name, side=side))
        return self._plan_taxi(TaxiToCommand(action="taxi_to", via=(name,)))

    # --- other traffic ------------------------------------------------------------------------

    def _plan_give_way(self, to: str) -> Act:
        self._require_free()
        passage = self._traffic.passage(self._traffic.named(to), "passing")

        def give_way() -> None:
            self._gives_way = passage
            self._body.stop()

        return give_way

    def _plan_follow(self, command: FollowCommand) -> Act | None:
        if self._body.is_airborne:
            return None
        self._require_free()
        leader = self._traffic.named(command.whom)
        if not leader.body.on_ground:
            raise Unable(f"unable, {command.whom} is airborne")
        there = leader.body.state.place
        way = self._site.airport.taxi_route(self._here, there, (), self._body.state.heading_rad)
        errand = self._errand_on([self._here, *way], goes_on=False)
        errand.end_m = max(errand.end_m - self._gap_m(leader), 0.0)
        for name in command.hold_short:
            if name[:1].isdigit():  # It stops before each runway to which the leader goes.
                self._require_off(name)
            else:
                self._plan_hold_short_on(errand, name)()

        def follow() -> None:
            self._begin(errand)
            self._leader = leader

        def wait() -> None:
            self.forget()
            self._body.stop()
            self._awaited = command, leader, there

        return follow if self._comes_from_behind([self._here, *way], leader) else wait

    def _comes_from_behind(self, way: Sequence[Place], leader: Actor) -> bool:
        """Return whether a way comes to the tail of who is followed, and that has left its stand.

        Who is on a stand yet, or comes towards the body, has to pass first.
        """
        state, there = leader.body.state, leader.body.state.place
        reach_m = leader.body.dimensions.length_m / 2.0
        before = next((place for place in way[::-1] if distance_m(place, there) > reach_m), way[0])
        is_from_ahead = math.cos(azimuth(there, before) - state.heading_rad) > 0.0
        return not is_from_ahead and self._site.airport.stand_at(there) is None

    def _attend_awaited(self, command: FollowCommand, leader: Actor, seen: Place) -> None:
        """See whether who is to be followed has passed, each time that it has moved on."""
        if distance_m(leader.body.state.place, seen) > TRAIL_STEP_M:
            self._awaited = None
            act = self._plan_follow(command)
            if act is not None:
                act()

    def _attend_leader(self, errand: Errand, leader: Actor) -> None:
        """Go on behind who is followed; who has left the ground is followed no more."""
        if leader.body.ended is not None or not leader.body.on_ground:
            self._leader = None
            return
        there = leader.body.state.place
        if distance_m(errand.route_end, there) < TRAIL_STEP_M:
            return
        longer = errand.extended(there)
        longer.end_m = max(longer.end_m - self._gap_m(leader), errand.along_m)
        self._errand = longer
        self._move(longer)

    def _gap_m(self, leader: Actor) -> float:
        return leader.body.dimensions.length_m / 2.0 + BEHIND_M + self._nose_m

    # --- steps --------------------------------------------------------------------------------

    def _begin(self, errand: Errand) -> None:
        self.forget()
        self._errand = errand
        self._move(errand)

    def _go_on(self, errand: Errand) -> None:
        """Move on after a stop on the way."""
        if errand.limit_m == self._driven_to_m:
            self._body.resume()
        else:
            self._move(errand)

    def _move(self, errand: Errand) -> None:
        """Move on to where the body has to stop next."""
        self._driven_to_m = errand.limit_m
        if errand.stands_at_limit:
            self._body.stop()
        else:
            self._body.go(errand.path, errand.speed_m_s)

    # --- what is where ------------------------------------------------------------------------

    def is_on(self, strip: str) -> bool:
        """Return whether the body is within the protected area of a runway, by its whole name."""
        airport = self._site.airport
        return airport.strips[strip].protects(airport.local_frame.to_local(self._here))

    @property
    def _here(self) -> Place:
        state = self._body.state
        return state.latitude_rad, state.longitude_rad

    @property
    def _nose_m(self) -> float:
        return self._body.length_m / 2.0

    def _require_free(self) -> None:
        """Raise `Unable` if the body cannot follow a path now."""
        if self._body.busy:
            raise Unable(self._body.busy)

    def _errand_on(
        self,
        places: Sequence[Place],
        speed_m_s: float | None = None,
        *,
        before_end_m: float = 0.0,
        goes_on: bool = True,
    ) -> Errand:
        return Errand(
            self._site.airport,
            places,
            self._nose_m,
            speed_m_s,
            before_end_m=before_end_m,
            overhangs=goes_on,
        )

    def _hold_here(self, runway: str, at: str | None) -> Hold:
        """Return the holding position of a runway at which the body stands, or raise `Unable`."""
        hold = hold_beside(self._site, self._here, runway)
        if at is not None and at not in (hold.taxiway, hold.position):
            raise Unable(f"unable, not at {at}, we are at {hold.taxiway}")
        return hold

    def _is_before(self, strip: RunwayStrip) -> bool:
        """Return whether the body is at a hold line of a runway, and points to it."""
        heading_rad = self._body.state.heading_rad
        try:
            hold_beside(self._site, self._here, strip.ends[0].ident, heading_rad)
        except Unable:
            return False
        return not self.is_on(strip.name)

    def _ends_before(self, errand: Errand, strip: str) -> bool:
        """Return whether a way ends at a hold line of a runway."""
        reach_m = self._nose_m + 2.0 * NOSE_MARGIN_M
        return any(
            hold.runway == strip and distance_m(errand.end, hold.place) < reach_m
            for hold in self._site.airport.holds.values()
        )

    @property
    def stand(self) -> str | None:
        """Return the stand on which the body is parked."""
        return self._site.airport.stand_at(self._here)
