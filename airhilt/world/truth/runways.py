"""Runways: occupants of their protected areas, arrivals, and incursions."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal, NamedTuple

import numpy as np

from airhilt.commands import CircuitLeg
from airhilt.messages import Arrival, RunwayTruth
from airhilt.units import DEGREE, FOOT
from airhilt.world.actors.actor import Actor
from airhilt.world.truth.gaps import Gap, corners, gap, radius_m

if TYPE_CHECKING:
    from airhilt.world.surface.layout import Layout
    from airhilt.world.surface.strips import RunwayStrip

ROLLING = frozenset({"takeoff_roll", "rotate"})
"""Phases of an aircraft that takes off."""
LANDING = frozenset({"glide", "flare"})
"""Phases of an aircraft that lands."""
ROLLING_OUT = frozenset({"rollout"})
"""Phases of an aircraft that has landed."""
USING = ROLLING | LANDING | ROLLING_OUT | {"rejected_takeoff", "go_around", "climb_out"}
"""Phases in which a user of the runway may still come near to an intruder."""
ARRIVAL_WITHIN_S = 30.0
"""Time to the threshold in s below which an arrival uses the runway: the first stage of surface
alerting in good visibility (EUROCONTROL-SPEC-171, A-SMGCS airport safety support)."""
LOW_M = 15.0
"""Height in m below which wildlife is in the way."""
BEHIND_M = 30.0
"""Distance behind the user of a runway, in m, beyond which nothing is in its way."""
SHOWN_ARRIVALS_S = 120.0
"""Time to the threshold in s below which an arrival is published."""

IncursionCategory = Literal["A", "B", "C", "D", "accident"]
"""FAA Order 7050.1B, appendix A, and ICAO Doc 9870, table 6-1: A, collision narrowly avoided; B,
significant potential for collision; C, ample time or distance; D, incorrect presence with no
immediate consequence. The FAA counts a collision as an accident beside them."""

NARROW_M = 100.0 * FOOT
"""Closest distance between the outlines below which an incursion is of category A, in m.

The definitions give no distances. ICAO's RISC calculator (Doc 9870, appendix H) too begins with the
closest proximity. The value is this project's own."""
SIGNIFICANT_M = 500.0 * FOOT
"""Closest distance below which an incursion is of category B, in m: that of a near mid-air
collision."""


DOWNWIND_RAD = 135.0 * DEGREE
ACROSS_RAD = 45.0 * DEGREE
ALIGNED_RAD = 20.0 * DEGREE
"""Least angles between track and runway on downwind, and on base or crosswind, and the greatest on
final: assumptions."""
ALIGNED_M = 1500.0
"""Greatest distance beside the extended centreline on final, in m: an assumption."""


class Leg(NamedTuple):
    """Leg of the circuit that an aircraft flies, and its distance before the threshold."""

    leg: CircuitLeg
    before_threshold_m: float
    """Along the runway; negative past the threshold."""


class User(NamedTuple):
    """Aircraft that takes off from, or lands on, a runway now."""

    callsign: str
    runway: str
    along_m: float
    """Distance past the threshold, in the direction of use."""
    time_to_threshold_s: float
    """Time to the threshold; 0 past it, or rolling."""
    rolling: bool


@dataclass
class Incursion:
    """Runway incursion: an actor in the way of the user of a runway."""

    t_ns: int
    runway: str
    user: str | None
    """Callsign of the user; None if there was none: category D."""
    intruder: str
    closest: Gap | None = None
    collided: bool = False
    over: bool = False

    @property
    def category(self) -> IncursionCategory:
        """Severity category of the incursion."""
        if self.collided:
            return "accident"
        if self.user is None or self.closest is None:
            return "D"
        if self.closest.slant_m < NARROW_M:
            return "A"
        return "B" if self.closest.slant_m < SIGNIFICANT_M else "C"


class _Position(NamedTuple):
    """Actor with its position in the airport's frame, in m."""

    actor: Actor
    east_m: float
    north_m: float


class RunwayMonitor:
    """Watches the runways of an airport.

    Parameters
    ----------
    affected
        Actors that act under a failure of the scenario. Their presence, like that of wildlife, is
        incorrect even if no aircraft uses the runway.
    uncleared
        Affected actors that act without a clearance. The presence of one that takes off or has
        landed is incorrect from then on: ICAO Doc 9870, 1.1, and FAA Order 7050.1B count it
        whether or not somebody else is near.
    occupied
        Called with a key and a message when the occupants or arrivals of a runway change.
    incurred
        Called with each incursion when it begins.
    """

    def __init__(
        self,
        layout: Layout,
        actors: Mapping[str, Actor],
        affected: set[str],
        uncleared: set[str],
        occupied: Callable[[str, RunwayTruth], None],
        incurred: Callable[[Incursion], None],
    ) -> None:
        self.incursions: dict[tuple[str, str | None, str], Incursion] = {}
        self._layout = layout
        self._actors = actors
        self._affected = affected
        self._uncleared = uncleared
        self._occupied = occupied
        self._incurred = incurred
        self._axes = {
            end.ident: (
                *layout.local_frame.to_local(end.threshold),
                math.sin(end.course_rad),
                math.cos(end.course_rad),
            )
            for strip in layout.strips.values()
            for end in strip.ends
        }
        """Threshold (east, north), and sine and cosine of the course."""
        self._crossings: dict[str, list[tuple[str, tuple[float, float]]]] = {}
        """Runways that cross each runway, and where the centre lines meet, in local metres."""
        for first, second, point in layout.intersections:
            self._crossings.setdefault(first, []).append((second, point))
            self._crossings.setdefault(second, []).append((first, point))
        self._occupants: dict[str, tuple[str, ...]] = dict.fromkeys(layout.strips, ())
        self._arrivals: dict[str, tuple[Arrival, ...]] = dict.fromkeys(layout.strips, ())

    def tick(self, now_ns: int) -> None:
        """Update all runways."""
        positions = {
            callsign: self._position(actor)
            for callsign, actor in self._actors.items()
            if actor.body.ended is None
        }
        inside = self._inside(positions)
        users = {
            name: list(self._users(strip, positions)) for name, strip in self._layout.strips.items()
        }
        for name, own in users.items():
            occupants = inside[name]
            self._publish(now_ns, name, occupants, own)
            for user in own:
                for intruder in occupants:
                    if intruder != user.callsign and self._is_in_way(user, positions[intruder]):
                        self._incur(now_ns, name, user.callsign, intruder)
            if not own:
                for intruder in filter(self._has_no_business, occupants):
                    self._incur_alone(now_ns, name, intruder)
        for name, own in users.items():
            for user in own:
                if user.rolling and user.callsign in self._uncleared:
                    self._incur_uncleared(now_ns, name, user, users)
        self._update_closest()

    def is_on(self, callsign: str, runway: str) -> bool:
        """Return whether an actor is in the protected area of this runway."""
        return callsign in self._occupants[self._layout.strip_of(runway).name]

    def is_on_any(self, callsign: str) -> bool:
        """Return whether an actor is in the protected area of a runway."""
        return any(callsign in occupants for occupants in self._occupants.values())

    def is_bound_for(self, callsign: str, runway: str) -> bool:
        """Return whether an actor is going to use a runway, in that direction."""
        return self._actors[callsign].bound_runway == self._layout.runway(runway).ident

    def time_to_threshold_s(self, callsign: str, runway: str) -> float | None:
        """Return the time of an airborne aircraft to the threshold of its runway, in s, or None."""
        actor = self._actors[callsign]
        if actor.body.on_ground or not self.is_bound_for(callsign, runway):
            return None
        ident = self._layout.runway(runway).ident
        along_m, closing_m_s = self._along(self._position(actor), ident)
        return -along_m / closing_m_s if along_m <= 0.0 and closing_m_s > 1.0 else None

    def leg(self, callsign: str) -> Leg | None:
        """Return the leg of the circuit that an airborne aircraft flies by its track; None: none.

        The circuit is that of the runway that it is bound for.
        """
        actor = self._actors[callsign]
        if actor.body.on_ground or actor.bound_runway is None:
            return None
        ident = self._layout.runway(actor.bound_runway).ident
        position = self._position(actor)
        past_m, _ = self._along(position, ident)
        east_m, north_m, sin, cos = self._axes[ident]
        aside_m = (position.east_m - east_m) * cos - (position.north_m - north_m) * sin
        angle = abs(math.remainder(actor.body.state.track_rad - math.atan2(sin, cos), math.tau))
        if angle > DOWNWIND_RAD:
            return Leg("downwind", -past_m)
        if angle > ACROSS_RAD:
            return Leg("base" if past_m < 0.0 else "crosswind", -past_m)
        is_aligned = angle < ALIGNED_RAD and abs(aside_m) < ALIGNED_M
        if past_m >= 0.0:
            return Leg("upwind", -past_m)
        return Leg("final", -past_m) if is_aligned else None

    def collided(self, first: str, second: str) -> None:
        """Record that two actors have collided."""
        for incursion in self.incursions.values():
            if {incursion.user, incursion.intruder} == {first, second}:
                incursion.collided = True
                incursion.closest = Gap(0.0, 0.0)

    # --- positions --------------------------------------------------------------------------

    def _position(self, actor: Actor) -> _Position:
        state = actor.body.state
        place = state.latitude_rad, state.longitude_rad
        return _Position(actor, *self._layout.local_frame.to_local(place))

    def _inside(self, positions: dict[str, _Position]) -> dict[str, tuple[str, ...]]:
        """Return the callsigns in each protected area, by the name of the runway."""
        low = {
            callsign: position
            for callsign, position in positions.items()
            if (body := position.actor.body).on_ground
            or (position.actor.category == "wildlife" and body.state.height_agl_m < LOW_M)
        }
        return {
            name: tuple(
                callsign for callsign, position in low.items() if self._reaches(strip, position)
            )
            for name, strip in self._layout.strips.items()
        }

    def _reaches(self, strip: RunwayStrip, position: _Position) -> bool:
        """Return whether any part of an actor is in a protected area."""
        actor, east, north = position
        start_east, start_north, sin, cos = self._axes[strip.ends[0].ident]
        aside = (east - start_east) * cos - (north - start_north) * sin
        if abs(aside) > strip.hold_distance_m + radius_m(actor.body):
            return False
        import shapely

        points = np.add(corners(actor.body), (east, north))
        return bool(shapely.contains_xy(strip.protected_area, points).any())

    def _along(self, position: _Position, runway: str) -> tuple[float, float]:
        """Return distance past the threshold (m), and speed along the runway (m/s)."""
        actor, *place = position
        _, _, sin, cos = self._axes[runway]
        state = actor.body.state
        speed = state.velocity_east_m_s * sin + state.velocity_north_m_s * cos
        return self._past_threshold(runway, *place), speed

    def _past_threshold(self, runway: str, east_m: float, north_m: float) -> float:
        threshold_east, threshold_north, sin, cos = self._axes[runway]
        return (east_m - threshold_east) * sin + (north_m - threshold_north) * cos

    # --- users and intruders ----------------------------------------------------------------

    def _users(self, strip: RunwayStrip, positions: dict[str, _Position]) -> Iterator[User]:
        idents = {end.ident for end in strip.ends}
        for callsign, position in positions.items():
            actor = position.actor
            runway, phase = actor.bound_runway, actor.body.phase
            if runway not in idents:
                continue
            along, speed = self._along(position, runway)
            if phase in ROLLING or (phase in ROLLING_OUT and speed > 1.0):
                yield User(callsign, runway, along, 0.0, rolling=True)
            elif phase in LANDING and speed > 1.0:
                to_go_s = max(-along, 0.0) / speed
                yield User(callsign, runway, along, to_go_s, actor.body.on_ground)

    def _is_in_way(self, user: User, other: _Position) -> bool:
        if user.time_to_threshold_s > ARRIVAL_WITHIN_S:
            return False
        if self._along(other, user.runway)[0] < user.along_m - BEHIND_M:
            return False
        actor = other.actor
        follows = actor.bound_runway == user.runway and actor.body.phase in (ROLLING | ROLLING_OUT)
        # An aircraft that rolls ahead in the same direction leaves in time, as a rule: the next may
        # not cross the threshold before (FAA Order JO 7110.65, 3-9-6 and 3-10-3).
        return not follows or user.rolling or user.time_to_threshold_s <= 0.0

    def _has_no_business(self, callsign: str) -> bool:
        """Return whether an actor is there by mistake, and not bound for a runway."""
        actor = self._actors[callsign]
        if actor.category == "wildlife":
            return True
        return callsign in self._affected and actor.bound_runway is None

    def _incur_uncleared(
        self, now_ns: int, name: str, rolling: User, users: Mapping[str, list[User]]
    ) -> None:
        """Record that an aircraft rolls without a clearance, and who uses a crossing runway."""
        for crossing, point in self._crossings.get(name, ()):
            for other in users[crossing]:
                if other.time_to_threshold_s <= ARRIVAL_WITHIN_S and all(
                    self._past_threshold(user.runway, *point) > user.along_m - BEHIND_M
                    for user in (rolling, other)
                ):
                    self._incur(now_ns, name, other.callsign, rolling.callsign)
        self._incur_alone(now_ns, name, rolling.callsign)

    def _incur_alone(self, now_ns: int, name: str, intruder: str) -> None:
        """Record an incorrect presence in nobody's way, unless it is known from an incursion."""
        if not any(
            incursion.runway == name and intruder in (incursion.user, incursion.intruder)
            for incursion in self.incursions.values()
        ):
            self._incur(now_ns, name, None, intruder)

    def _incur(self, now_ns: int, name: str, user: str | None, intruder: str) -> None:
        for key in ((name, user, intruder), (name, intruder, user)):
            if key in self.incursions:
                self.incursions[key].over = False
                return
        incursion = Incursion(now_ns, name, user, intruder)
        self.incursions[name, user, intruder] = incursion
        if user is not None:
            incursion.closest = gap(self._actors[user].body, self._actors[intruder].body)
        self._incurred(incursion)

    def _update_closest(self) -> None:
        """Update the closest distance of each incursion while one of both uses the runway."""
        for incursion in self.incursions.values():
            if incursion.user is None or incursion.closest is None or incursion.over:
                continue
            user, intruder = (
                self._actors[name].body for name in (incursion.user, incursion.intruder)
            )
            if user.ended or intruder.ended or {user.phase, intruder.phase}.isdisjoint(USING):
                incursion.over = True
                continue
            now = gap(user, intruder)
            if now.slant_m < incursion.closest.slant_m:
                incursion.closest = now

    def _publish(
        self, now_ns: int, name: str, occupants: tuple[str, ...], users: list[User]
    ) -> None:
        arrivals = tuple(
            Arrival(
                actor=user.callsign,
                runway=user.runway,
                time_to_threshold_s=round(user.time_to_threshold_s, 1),
            )
            for user in users
            if not user.rolling and user.time_to_threshold_s < SHOWN_ARRIVALS_S
        )
        known = {(arrival.actor, arrival.runway) for arrival in self._arrivals[name]}
        if occupants == self._occupants[name] and known == {(a.actor, a.runway) for a in arrivals}:
            return
        self._occupants[name], self._arrivals[name] = occupants, arrivals
        key = name.replace("/", "-")
        self._occupied(
            f"truth/runway/{key}",
            RunwayTruth(t_ns=now_ns, runway=key, occupants=occupants, arrivals=arrivals),
        )
