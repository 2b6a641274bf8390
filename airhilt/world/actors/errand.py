"""A way over an airport that one body follows, and what is allowed on it."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from airhilt.geodesy.wgs84 import Place, azimuth, distance_m, onward
from airhilt.world.surface.ways import NOSE_MARGIN_M

if TYPE_CHECKING:
    from airhilt.world.surface.ground_route import Crossing
    from airhilt.world.surface.layout import Hold, Layout

BEFORE_TAXIWAY_M = 43.5
"""Distance from the centre line of a taxiway at which one holds short of it, in m (ICAO Annex 14
volume I, table 3-1: taxiway centre line to object, code letter E)."""
STANDS_AT_M = 2.0
"""Distance to a place, in m, within which one that stands need not move to it."""
ARRIVED_M = 3.0
"""Distance to the end of a way, in m, within which it has been reached."""
ON_FROM_M = 2.0
"""Distance from its beginning or end, in m, within which a way is on a runway from there."""
AT_LINE_M = 5.0
"""Distance in m within which a way enters a protected area at a hold line."""


class Errand:
    """A way with its end and its stops, in metres along it, of a body that is ``nose_m`` half long.

    The body stops before each runway that has not been cleared, and before taxiways where it has to
    hold short. With ``overhangs`` its nose stays off a runway beyond its end, too.

    Attributes
    ----------
    along_m
        Place of the middle of the body.
    end_m
        Where it ends.
    """

    def __init__(
        self,
        airport: Layout,
        places: Sequence[Place],
        nose_m: float,
        speed_m_s: float | None,
        *,
        before_end_m: float,
        overhangs: bool,
    ) -> None:
        # Not at the top: scenarios without an airport start without the libraries behind it.
        from airhilt.world.surface.ground_route import GroundRoute

        self._airport = airport
        self._places = list(places)
        self._nose_m = nose_m
        self.speed_m_s = speed_m_s
        if overhangs:
            last = next((p for p in places[::-1] if distance_m(p, places[-1]) > 0.1), None)
            towards = 0.0 if last is None else azimuth(last, places[-1])
            places = [*places, onward(places[-1], towards, nose_m)]
        self._route = GroundRoute(airport, places)
        self._cleared: set[Crossing] = set()
        self._before_taxiways: dict[str, float] = {}
        self.along_m = 0.0
        beyond_m = nose_m if overhangs else 0.0
        self.end_m = max(self._route.length_m - beyond_m - before_end_m, 0.0)
        for crossing in self._route.crossings if overhangs else ():
            if self.end_m < crossing.enter_m < self.end_m + nose_m:
                self.end_m = min(self.end_m, max(self._stop_m(crossing), 0.0))

    # --- how far ------------------------------------------------------------------------------

    def come_to(self, here: Place) -> None:
        """Note where the body is."""
        self.along_m = self._route.along_m(here, self.along_m)

    @property
    def limit_m(self) -> float:
        """Where the body has to stop next."""
        stops = [self._stop_m(each) for each in self._ahead() if each not in self._cleared]
        return max(min([self.end_m, *stops, *self._before_taxiways.values()]), self.along_m)

    @property
    def stands_at_limit(self) -> bool:
        """True if the body need not move to where it has to stop."""
        return self.limit_m - self.along_m < STANDS_AT_M

    @property
    def has_stops(self) -> bool:
        """True if the body has to stop before the end."""
        return self.limit_m < self.end_m - ARRIVED_M

    @property
    def is_done(self) -> bool:
        """True if the body has come to the end."""
        return self.end_m - self.along_m < ARRIVED_M

    @property
    def path(self) -> list[Place]:
        """Corners from the body to where it has to stop next."""
        return self._route.part(self.along_m, self.limit_m)

    @property
    def end(self) -> Place:
        """Place where it ends."""
        return self._route.part(self.end_m - 1.0, self.end_m)[-1]

    @property
    def route_end(self) -> Place:
        """Last place of the way."""
        return self._places[-1]

    def extended(self, place: Place) -> Errand:
        """Return the errand with a way that leads on to a place, the same things allowed on it."""
        longer = Errand(
            self._airport,
            [*self._places, place],
            self._nose_m,
            self.speed_m_s,
            before_end_m=0.0,
            overhangs=False,
        )
        longer.along_m = self.along_m
        begun = {(each.runway, round(each.enter_m)) for each in self._cleared}
        longer._cleared = {
            each for each in longer._route.crossings if (each.runway, round(each.enter_m)) in begun
        }
        longer._before_taxiways = dict(self._before_taxiways)
        return longer

    # --- runways ------------------------------------------------------------------------------

    def crosses(self, strip: str | None) -> bool:
        """Return whether a runway is still ahead on the way; any runway, if it is None."""
        return self._next(strip) is not None

    def is_crossing(self, strip: str) -> bool:
        """Return whether the body is on its way over a runway."""
        return any(
            each.runway == strip and each.leave_m > self.along_m
            for each in self._route.crossings
            if not self._is_ahead(each)
        )

    def stays_on(self, strip: str, until_m: float) -> bool:
        """Return whether the way begins on a runway and does not leave it before a distance."""
        return any(
            each.runway == strip and each.enter_m < ON_FROM_M and each.leave_m > until_m - ON_FROM_M
            for each in self._route.crossings
        )

    def has_crossed(self, strip: str) -> bool:
        """Return whether the way has led over a runway."""
        return any(
            each.runway == strip for each in self._route.crossings if not self._is_ahead(each)
        )

    def clear_all(self) -> None:
        """Allow to cross every runway on the way."""
        self._cleared = set(self._route.crossings)

    def clear_next(self, strip: str | None) -> bool:
        """Allow the next crossing of a runway; return whether there is one."""
        crossing = self._next(strip, uncleared=True) or self._next(strip)
        if crossing is not None:
            self._cleared.add(crossing)
        return crossing is not None

    def clear_from_runway(self, strip: str) -> None:
        """Allow the runways that cross the one on which the way begins, until it leaves that."""
        leave_m = max(
            (each.leave_m for each in self._route.crossings
             if each.runway == strip and each.enter_m < ON_FROM_M), default=0.0
        )  # fmt: skip
        self._cleared |= {each for each in self._route.crossings if each.enter_m < leave_m}

    def hold_short_of_runway(self, strip: str) -> None:
        """Stop before a runway that is still ahead."""
        self._cleared -= {each for each in self._ahead() if each.runway == strip}

    def hold_before(self, strip: str | None) -> Hold | None:
        """Return the hold whose line is next before a runway; None if the way enters elsewhere."""
        crossing = self._next(strip)
        if crossing is None:
            return None
        line = self._route.part(crossing.enter_m - 1.0, crossing.enter_m)[-1]
        return next(
            (
                hold
                for hold in self._airport.holds.values()
                if hold.runway == crossing.runway and distance_m(hold.place, line) < AT_LINE_M
            ),
            None,
        )

    @property
    def next_runway(self) -> str | None:
        """Designator of the next runway ahead, in one direction; None if there is none."""
        crossing = self._next(None)
        return None if crossing is None else crossing.runway.split("/")[0]

    @property
    def waits_for_clearance(self) -> bool:
        """True if the body has to stay where it is before a runway."""
        stops = [self._stop_m(each) for each in self._ahead() if each not in self._cleared]
        return min(stops, default=self.end_m + NOSE_MARGIN_M) - self.along_m < NOSE_MARGIN_M

    def room_before_m(self, strip: str) -> float | None:
        """Return the distance of the nose to the next hold line of a runway; None without one."""
        crossing = self._next(strip)
        return None if crossing is None else crossing.enter_m - self._nose_m - self.along_m

    # --- taxiways -----------------------------------------------------------------------------

    def meets(self, taxiway: str) -> bool:
        """Return whether a taxiway is still ahead on the way."""
        meets_m = self._route.meets_m(taxiway, self.along_m + self._nose_m)
        return meets_m is not None and meets_m <= self.end_m + self._nose_m

    def has_met(self, taxiway: str) -> bool:
        """Return whether the way has led to or over a taxiway."""
        first_m = self._route.meets_m(taxiway, -1.0)
        return first_m is not None and first_m <= self.along_m + self._nose_m

    def hold_short_of_taxiway(self, taxiway: str) -> None:
        """Stop before a taxiway that is still ahead."""
        meets_m = self._route.meets_m(taxiway, self.along_m + self._nose_m)
        assert meets_m is not None
        self._before_taxiways[taxiway] = max(meets_m - BEFORE_TAXIWAY_M - self._nose_m, 0.0)

    def pass_taxiways(self) -> None:
        """Stop before no taxiway any more."""
        self._before_taxiways.clear()

    # --- parts --------------------------------------------------------------------------------

    def _stop_m(self, crossing: Crossing) -> float:
        return crossing.enter_m - self._nose_m - NOSE_MARGIN_M

    def _is_ahead(self, crossing: Crossing) -> bool:
        """Return whether the middle of the body has not passed the hold line before a runway."""
        return crossing.enter_m > self.along_m

    def _ahead(self) -> list[Crossing]:
        return [each for each in self._route.crossings if self._is_ahead(each)]

    def _next(self, strip: str | None, *, uncleared: bool = False) -> Crossing | None:
        for each in self._ahead():
            if each.enter_m > self.end_m + self._nose_m:
                continue
            if strip in (None, each.runway) and not (uncleared and each in self._cleared):
                return each
        return None
