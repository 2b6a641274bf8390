"""Ground operations of a crew or a driver: where to taxi or drive, and where to hold short."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, field
from functools import partial
from typing import TYPE_CHECKING, Protocol

from airhilt.commands import (
    Command,
    ContinueCommand,
    CrossCommand,
    HoldPositionCommand,
    HoldShortCommand,
    TaxiCommand,
    TaxiToCommand,
)
from airhilt.geodesy.wgs84 import Place, azimuth, distance_m, onward
from airhilt.units import KNOT
from airhilt.world.actors.actor import Unable
from airhilt.world.actors.taxi_clearances import require_taxiway, strip_name, way_to
from airhilt.world.actors.taxi_paths import hold_beside, taxi_path
from airhilt.world.flight.aircraft import Aircraft
from airhilt.world.mover import Driven, Motion
from airhilt.world.site import ScenarioSite
from airhilt.world.surface.ways import NOSE_MARGIN_M

if TYPE_CHECKING:
    from airhilt.world.surface.ground_route import Crossing, GroundRoute
    from airhilt.world.surface.layout import Layout

BEFORE_TAXIWAY_M = 43.5
"""Distance from the centre line of a taxiway at which one holds short of it, in m (ICAO Annex 14
volume I, table 3-1: taxiway centre line to object, code letter E)."""
STANDS_AT_M = 1.0
"""Distance to a place, in m, within which one that stands need not move to it."""
OVER_LINE_M = 1.0
"""Distance of the nose over a hold line, in m, from which it has been passed."""

Act = Callable[[], None]
"""What a command does, once it is known that it can be done."""


class GroundBody(Protocol):
    """A body that moves over the ground along paths: an aircraft that taxis, or a vehicle."""

    @property
    def state(self) -> Motion:
        """Place and movement now."""

    @property
    def length_m(self) -> float:
        """Length from nose to tail."""

    @property
    def is_moving(self) -> bool:
        """True while it follows a path, and is not held on it."""

    def go(self, path: Sequence[Place], speed_m_s: float | None) -> None:
        """Follow a path from here, and stop at its end."""

    def stop(self) -> None:
        """Stop on the path; no-op for one that stands."""

    def resume(self) -> None:
        """Go on along the path; ValueError if there is nothing left of it."""


@dataclass
class _Errand:
    """A way that is followed, with what is allowed on it; all distances in metres along it."""

    route: GroundRoute
    end_m: float
    speed_m_s: float | None
    cleared: set[Crossing]
    """Crossings of runways that are allowed."""
    holds_short: set[float] = field(default_factory=set)
    """Where to stop before taxiways, until told to go on."""
    along_m: float = 0.0
    """Place of the middle of the body."""
    driven_to_m: float | None = None
    """Where the body stops by itself; None before it has been told."""


class GroundOperations:
    """Moves one body over an airport as a controller says, and before no runway without a clearance.

    `plan` says what a command will do, or raises `Unable`; nothing changes before it is done.
    """

    def __init__(self, body: GroundBody, site: ScenarioSite) -> None:
        self._body = body
        self._site = site
        self._errand: _Errand | None = None

    @property
    def has_arrived(self) -> bool:
        """True if there is nowhere to go on to."""
        errand = self._errand
        return errand is None or (
            not self._body.is_moving and errand.end_m - errand.along_m < 2.0 + STANDS_AT_M
        )

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
                return self._body.stop
            case ContinueCommand():
                return self._plan_continue()
            case HoldShortCommand(runway=runway, taxiway=taxiway):
                return self._plan_hold_short(runway, taxiway)
            case CrossCommand(runway=runway, at=at):
                return self._plan_cross(runway, at)
        return None

    def abandon(self) -> None:
        """Forget the way: something else moves the body now."""
        self._errand = None

    def attend(self) -> None:
        """Take note of how far it has come."""
        errand = self._errand
        if errand is not None:
            errand.along_m = errand.route.along_m(self._here, errand.along_m)

    # --- plans --------------------------------------------------------------------------------

    def _plan_scripted(self, command: TaxiCommand) -> Act:
        """Return what goes to a given place, over any runway."""
        path = taxi_path(self._site, self._here, command, self._nose_m)
        speed = None if command.speed_kt is None else command.speed_kt * KNOT

        def go() -> None:
            self._body.go(path, speed)
            if self._site.layout is not None:
                route = self._route([self._here, *path])
                self._errand = _Errand(route, route.length_m, speed, set(route.crossings))
                self._errand.driven_to_m = route.length_m

        return go

    def _plan_taxi(self, command: TaxiToCommand) -> Act:
        airport = self._site.airport
        places, is_hold = way_to(airport, self._here, self._body.state.heading_rad, command)
        return self._plan_way(
            [self._here, *places], self._nose_m + NOSE_MARGIN_M if is_hold else 0.0
        )

    def _plan_way(
        self, places: Sequence[Place], before_end_m: float = 0.0, cleared: Iterable[str] = ()
    ) -> Act:
        """Return what follows a way, to some distance before its end.

        The first crossings of the runways ``cleared`` are allowed.
        """
        ahead = onward(places[-1], azimuth(places[-2], places[-1]), self._nose_m)
        route = self._route([*places, ahead])
        end_m = max(route.length_m - self._nose_m - before_end_m, 0.0)
        errand = _Errand(route, end_m, None, set())
        for runway in cleared:
            errand.cleared |= set(self._ahead(errand, runway)[:1])
        errand.end_m = min([end_m, *self._stops_beyond(errand, end_m)])
        return partial(self._begin, errand)

    def _plan_continue(self) -> Act:
        errand = self._errand
        if errand is None or errand.driven_to_m == errand.end_m:
            return self._body.resume
        if self._limit_m(errand) - errand.along_m < STANDS_AT_M:
            crossing = next(iter(self._uncleared(errand)), None)
            what = "" if crossing is None else f" of runway {crossing.runway}"
            raise Unable(f"unable, holding short{what}")
        return partial(self._move, errand)

    def _plan_hold_short(self, runway: str | None, taxiway: str | None) -> Act:
        airport, errand = self._site.airport, self._errand
        if taxiway is not None:
            require_taxiway(airport, taxiway)
            if errand is None or self.has_arrived:
                return self._body.stop
            return self._plan_hold_before(errand, taxiway)
        if runway is None and errand is not None and errand.route.crossings:
            ahead = [each for each in errand.route.crossings if self._is_ahead(errand, each)]
            runway = ahead[0].runway.split("/")[0] if ahead else None
        if runway is None:
            raise Unable("unable, say which runway to hold short of")
        strip = strip_name(airport, runway)
        if self._is_on(strip):
            raise Unable(f"unable, already on runway {runway}")
        if errand is None or self.has_arrived:
            return self._body.stop
        ahead = self._ahead(errand, strip)
        if not ahead:
            if any(each.runway == strip for each in errand.route.crossings):
                raise Unable(f"unable, past runway {runway}")
            if self._ends_before(errand, strip):
                return _nothing
            raise Unable(f"unable, runway {runway} is not on our way")

        def hold_short() -> None:
            errand.cleared -= set(ahead)
            self._move(errand)

        return hold_short

    def _plan_hold_before(self, errand: _Errand, taxiway: str) -> Act:
        """Return what stops before a taxiway on the way."""
        from_m = errand.along_m + self._nose_m
        meets_m = errand.route.meets_m(taxiway, from_m)
        if meets_m is None or meets_m > errand.end_m + self._nose_m:
            passed = errand.route.meets_m(taxiway, -1.0) is not None
            raise Unable(
                f"unable, past taxiway {taxiway}"
                if passed
                else f"unable, taxiway {taxiway} is not on our way"
            )

        def hold_short() -> None:
            errand.holds_short.add(max(meets_m - BEFORE_TAXIWAY_M - self._nose_m, 0.0))
            self._move(errand)

        return hold_short

    def _plan_cross(self, runway: str | None, at: str | None) -> Act:
        airport, errand = self._site.airport, self._errand
        if at is not None:
            require_taxiway(airport, at)
        if errand is not None:
            strip = None if runway is None else strip_name(airport, runway)
            for crossing in errand.route.crossings:
                if not self._is_ahead(errand, crossing) or crossing.enter_m > errand.end_m:
                    continue
                if strip in (None, crossing.runway):
                    return partial(self._clear, errand, crossing)
        return self._plan_cross_from_hold(runway)

    def _plan_cross_from_hold(self, runway: str | None) -> Act:
        """Return what goes from a hold line to beyond the one on the other side."""
        airport = self._site.airport
        if runway is None:
            raise Unable("unable, say which runway to cross")
        strip = strip_name(airport, runway)
        if self._is_on(strip):
            return self._plan_continue()
        hold = hold_beside(self._site, self._here, runway)
        way = airport.way_across(hold)
        if way is None:
            raise Unable(f"unable, taxiway {hold.taxiway} does not lead across runway {runway}")
        places, line_m = way
        far_m = line_m + self._body.length_m / 2.0 + NOSE_MARGIN_M
        kept = _first(airport, places, far_m)
        return self._plan_way([self._here, *kept], cleared=[strip])

    # --- steps --------------------------------------------------------------------------------

    def _begin(self, errand: _Errand) -> None:
        self._errand = errand
        self._move(errand)

    def _clear(self, errand: _Errand, crossing: Crossing) -> None:
        errand.cleared.add(crossing)
        self._move(errand)

    def _move(self, errand: _Errand) -> None:
        """Move on to where the body has to stop next."""
        limit_m = self._limit_m(errand)
        errand.driven_to_m = limit_m
        if limit_m - errand.along_m < STANDS_AT_M:
            self._body.stop()
        else:
            self._body.go(errand.route.part(errand.along_m, limit_m), errand.speed_m_s)

    def _limit_m(self, errand: _Errand) -> float:
        """Return where the body has to stop next."""
        stops = [self._stop_before(each) for each in self._uncleared(errand)]
        return max(min([errand.end_m, *stops, *errand.holds_short]), errand.along_m)

    # --- what is where ------------------------------------------------------------------------

    @property
    def _here(self) -> Place:
        state = self._body.state
        return state.latitude_rad, state.longitude_rad

    @property
    def _nose_m(self) -> float:
        return self._body.length_m / 2.0

    def _route(self, places: Sequence[Place]) -> GroundRoute:
        # Not at the top: scenarios without an airport start without the libraries behind it.
        from airhilt.world.surface.ground_route import GroundRoute

        return GroundRoute(self._site.airport, places)

    def _stop_before(self, crossing: Crossing) -> float:
        return crossing.enter_m - self._nose_m - NOSE_MARGIN_M

    def _is_ahead(self, errand: _Errand, crossing: Crossing) -> bool:
        """Return whether the nose has not passed the hold line before a runway."""
        return crossing.enter_m > errand.along_m + self._nose_m - OVER_LINE_M

    def _ahead(self, errand: _Errand, strip: str) -> list[Crossing]:
        return [
            each
            for each in errand.route.crossings
            if each.runway == strip and self._is_ahead(errand, each)
        ]

    def _uncleared(self, errand: _Errand) -> list[Crossing]:
        return [
            each
            for each in errand.route.crossings
            if each not in errand.cleared and self._is_ahead(errand, each)
        ]

    def _stops_beyond(self, errand: _Errand, end_m: float) -> list[float]:
        """Return where to stop because the nose would pass a hold line at the end of the way."""
        return [
            self._stop_before(each)
            for each in errand.route.crossings
            if end_m < each.enter_m < end_m + self._nose_m
        ]

    def _is_on(self, strip: str) -> bool:
        """Return whether the body is within the protected area of a runway."""
        from shapely import Point

        airport = self._site.airport
        at = Point(airport.local_frame.to_local(self._here))
        return bool(airport.strips[strip].protected_area.contains(at))

    def _ends_before(self, errand: _Errand, strip: str) -> bool:
        """Return whether the way ends at a hold line of a runway."""
        end = errand.route.part(errand.end_m - 1.0, errand.end_m)[-1]
        reach_m = self._nose_m + 2.0 * NOSE_MARGIN_M
        return any(
            hold.runway == strip and distance_m(end, hold.place) < reach_m
            for hold in self._site.airport.holds.values()
        )


def _first(airport: Layout, places: Sequence[Place], length_m: float) -> list[Place]:
    """Return the first metres of a way."""
    from airhilt.world.surface import path as lines

    points = [airport.local_frame.to_local(place) for place in places]
    return [airport.local_frame.to_place(*point) for point in lines.cut(points, length_m)]


def _nothing() -> None:
    """Do what is done already."""


class TaxiingAircraft:
    """An aircraft on the ground, moved along paths."""

    def __init__(self, aircraft: Aircraft) -> None:
        self._aircraft = aircraft
        self.length_m = aircraft.kind.dimensions.length_m

    @property
    def state(self) -> Motion:
        """Place and movement now."""
        return self._aircraft.state

    @property
    def is_moving(self) -> bool:
        """True while it taxis."""
        return self._aircraft.phase in ("taxi", "line_up", "vacate")

    def go(self, path: Sequence[Place], speed_m_s: float | None) -> None:
        """Taxi along a path from here, and stand at its end."""
        self._aircraft.procedures.taxi(path, speed_m_s)

    def stop(self) -> None:
        """Stop on the path."""
        self._aircraft.procedures.hold_position()

    def resume(self) -> None:
        """Go on along the path."""
        self._aircraft.procedures.resume_taxi()


class DrivenVehicle:
    """A vehicle, driven along paths."""

    def __init__(self, body: Driven) -> None:
        self._body = body
        self.go, self.stop, self.resume = body.drive, body.stop, body.resume

    @property
    def length_m(self) -> float:
        """Length from nose to tail."""
        return self._body.dimensions.length_m

    @property
    def state(self) -> Motion:
        """Place and movement now."""
        return self._body.state

    @property
    def is_moving(self) -> bool:
        """True while it drives."""
        return self._body.phase == "driving"
