"""Runways: occupants of their protected areas, arrivals, and incursions."""

from __future__ import annotations

import math
from collections.abc import Callable, Collection, Iterator, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal, NamedTuple

import numpy as np

from airhilt.commands import CircuitLeg
from airhilt.messages import Arrival, RunwayTruth
from airhilt.units import DEGREE, FOOT
from airhilt.world.actors.actor import Actor
from airhilt.world.truth.gaps import NARROW_M, Gap, corners, gap, radius_m

if TYPE_CHECKING:
    from airhilt.world.surface.layout import Layout
    from airhilt.world.surface.strips import RunwayStrip

ROLLING = frozenset({"takeoff_roll", "rotate", "rejected_takeoff", "rollout"})
"""Phases of an aircraft that rolls along a runway, up to the screen height of a takeoff."""
LANDING = frozenset({"glide", "flare"})
"""Phases of an aircraft that lands."""
MOVING_M_S = 1.0
"""Least speed along a runway of an aircraft that uses it, in m/s."""
ARRIVAL_WITHIN_S = 30.0
"""Time to the threshold in s below which an arrival uses the runway: the first stage of surface
alerting in good visibility (EUROCONTROL-SPEC-171, A-SMGCS airport safety support)."""
LOW_M = 15.0
"""Height in m below which wildlife is in the way."""
BEHIND_M = 30.0
"""Distance behind the user of a runway, in m, beyond which nothing is in its way."""
AIRBORNE_AHEAD_M = 3_000.0 * FOOT
"""Distance ahead, in m, from which an airborne aircraft in the same direction is not in the way:
the least minimum of FAA Order JO 7110.65, 3-9-6 and 3-10-3, that of category I aircraft."""
SHOWN_ARRIVALS_S = 120.0
"""Time to the threshold in s below which an arrival is published."""

IncursionCategory = Literal["A", "B", "C", "D", "accident"]
"""FAA Order 7050.1B, appendix A, and ICAO Doc 9870, table 6-1: A, collision narrowly avoided; B,
significant potential for collision; C, ample time or distance; D, incorrect presence with no
immediate consequence. The FAA counts a collision as an accident beside them."""

SIGNIFICANT_M = 500.0 * FOOT
"""Closest distance between the outlines below which an incursion is of category B, in m; below
`NARROW_M` it is of category A.

The definitions give no distances; ICAO's RISC calculator (Doc 9870, appendix H) too begins with the
closest proximity. Both limits are those of the FAA's degrees of hazard of near midair collisions:
"potential" below 500 ft, as in AIM 7-7-3, and "critical" below 100 ft."""
OVER_M = SIGNIFICANT_M + 25.0
"""Height over a protected area, in m, up to which an aircraft is in the way or uses the runway. Who
is higher passes `SIGNIFICANT_M` above whatever stands there: the highest tail, of an A380, is at
24.1 m."""


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
    """Aircraft that rolls along a runway or flies low along it, or comes to land on it."""

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
            name: list(self._users(strip, positions, inside[name]))
            for name, strip in self._layout.strips.items()
        }
        used = {user.callsign: user.runway for own in users.values() for user in own}
        for name, own in users.items():
            occupants = tuple(filter(self._occupies, inside[name]))
            self._publish(now_ns, name, occupants, own)
            for user in own:
                for intruder in inside[name]:
                    if intruder != user.callsign and self._is_in_way(
                        user, intruder, positions[intruder], used.get(intruder)
                    ):
                        self._incur(now_ns, name, user.callsign, intruder)
            if not own:
                for intruder in filter(self._has_no_business, occupants):
                    self._incur_alone(now_ns, name, intruder)
        for name, own in users.items():
            for user in own:
                if user.rolling and user.callsign in self._uncleared:
                    self._incur_uncleared(now_ns, name, user, users)
        self._update_closest(used)

    def is_on(self, callsign: str, runway: str) -> bool:
        """Return whether an actor is in the protected area of this runway."""
        return callsign in self._occupants[self._layout.strip_of(runway).name]

    def is_on_any(self, callsign: str) -> bool:
        """Return whether an actor is in the protected area of a runway."""
        return any(callsign in occupants for occupants in self._occupants.values())

    def is_bound_for(self, callsign: str, runway: str) -> bool:
        """Return whether an actor is going to use a runway, in that direction."""
        return self._actors[callsign].bound_runway == self._layout.runway(runway).ident

    def share_runway(self, first: str, second: str) -> bool:
        """Return whether two occupy one runway, or soon land on it, or on two that cross."""
        on = [
            {
                name
                for name, occupants in self._occupants.items()
                if callsign in occupants
                or callsign in (arrival.actor for arrival in self._arrivals[name])
            }
            for callsign in (first, second)
        ]
        crossed = {other for name in on[0] for other, _ in self._crossings.get(name, ())}
        return not on[1].isdisjoint(on[0] | crossed)

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

    def _occupies(self, callsign: str) -> bool:
        """Return whether an actor inside a protected area occupies it: in flight only birds do."""
        actor = self._actors[callsign]
        return actor.body.on_ground or actor.category == "wildlife"

    def _inside(self, positions: dict[str, _Position]) -> dict[str, tuple[str, ...]]:
        """Return the callsigns in or low over each protected area, by the name of the runway."""
        low = {
            callsign: position
            for callsign, position in positions.items()
            if (body := position.actor.body).on_ground
            or body.state.height_agl_m
            < (LOW_M if position.actor.category == "wildlife" else OVER_M)
        }
        return {
            name: tuple(
                callsign for callsign, position in low.items() if self._reaches(strip, position)
            )
            for name, strip in self._layout.strips.items()
        }

    def _reaches(self, strip: RunwayStrip, position: _Position) -> bool:
        """Return whether any part of an actor is in a protected area."""
        body, centre = position.actor.body, (position.east_m, position.north_m)
        if strip.protects(centre):
            return True
        if not strip.protects(centre, radius_m(body)):
            return False
        return any(map(strip.protects, np.add(corners(body), centre).tolist()))

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

    def _users(
        self, strip: RunwayStrip, positions: dict[str, _Position], inside: Collection[str]
    ) -> Iterator[User]:
        for callsign, position in positions.items():
            actor, body = position.actor, position.actor.body
            if callsign not in inside and body.phase not in LANDING:
                continue
            flies = actor.category == "aircraft" and not body.on_ground
            rolling = body.phase in ROLLING
            for end in strip.ends:
                turned = math.remainder(body.state.heading_rad - end.course_rad, math.tau)
                is_along = callsign in inside and abs(turned) < ALIGNED_RAD
                lands = body.phase in LANDING and actor.bound_runway == end.ident
                along, speed = self._along(position, end.ident)
                if speed > MOVING_M_S and (lands or (is_along and (flies or rolling))):
                    rolling = rolling or body.on_ground
                    to_go_s = 0.0 if rolling else max(-along, 0.0) / speed
                    yield User(callsign, end.ident, along, to_go_s, rolling)

    def _is_in_way(self, user: User, callsign: str, other: _Position, used: str | None) -> bool:
        """Return whether an actor, which may itself use a runway, is in the way of a user."""
        ahead_m = self._along(other, user.runway)[0] - user.along_m
        if user.time_to_threshold_s > ARRIVAL_WITHIN_S or ahead_m < -BEHIND_M:
            return False
        ends = {end.ident for end in self._layout.strip_of(user.runway).ends}
        is_head_on = used != user.runway and used in ends
        if is_head_on or (used is None and self._occupies(callsign)):
            return True
        # What rolls or flies in the same direction or across leaves in time, as a rule: an arrival
        # may not cross the threshold before, unless the other is airborne far enough ahead (FAA
        # Order JO 7110.65, 3-9-6, 3-10-3, and 3-10-4).
        is_away = not other.actor.body.on_ground and ahead_m > AIRBORNE_AHEAD_M
        return user.time_to_threshold_s <= 0.0 and not (used == user.runway and is_away)

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

    def _update_closest(self, used: Mapping[str, str]) -> None:
        """Update the closest distance of each incursion while one of both uses a runway.

        A pass in flight is followed to its end.
        """
        for incursion in self.incursions.values():
            if incursion.user is None or incursion.closest is None or incursion.over:
                continue
            pair = (incursion.user, incursion.intruder)
            user, intruder = (self._actors[name].body for name in pair)
            now = gap(user, intruder)
            is_nearer = now.slant_m < incursion.closest.slant_m
            passes = is_nearer and not (user.on_ground and intruder.on_ground)
            is_over = used.keys().isdisjoint(pair) and not passes
            if user.ended or intruder.ended or is_over:
                incursion.over = True
            elif is_nearer:
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
            if not user.rolling
            and self.is_bound_for(user.callsign, user.runway)
            and user.time_to_threshold_s < SHOWN_ARRIVALS_S
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
