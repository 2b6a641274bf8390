"""What is wrong on an airport's runways at this instant: the ladder's steps (a), (b) and (c).

What cameras show counts as an obstacle without a transponder.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Literal

from airhilt.assistant.decision.aerodrome import Strip, Vector
from airhilt.assistant.decision.clearances import Clearance, Discrepancy
from airhilt.assistant.decision.ladder import fused_severity
from airhilt.assistant.decision.line_of_sight import Fix
from airhilt.assistant.decision.mobiles import (
    BRAKING_M_S2,
    FINAL_M,
    ROLLING_M_S,
    STANDING_M_S,
    TAKEOFF_M_S2,
    TOUCHDOWN_M,
    Kind,
    Mobile,
    Use,
)
from airhilt.assistant.decision.occupancy import SeenAloft
from airhilt.assistant.decision.situation import Obstacle, SeenObstacle, Situation
from airhilt.messages import Severity
from airhilt.phraseology import Action
from airhilt.surveillance.squitters import NACP_95_PERCENT_M
from airhilt.units import SECOND_NS

PAPER_TIME_TO_GO_S = 8.0
"""The time to go in step (b) of the AIRHILT paper's ladder (arXiv 2511.18718)."""
BEHIND_M = 30.0
"""Who is so far behind the user of a runway is not in its way any more."""
LIFT_OFF_M_S = 75.0
"""At which a departure has left the ground."""
TURN_OFF_M_S = 8.0
"""To which a landing brakes before it turns off."""
TURN_OFF_S = 12.0
"""From then until it has left the runway."""
STOPPING_MARGIN_M = 100.0
"""Beyond the distance in which who has landed can stop, nobody is in its way."""
LEAST_ENTRY_M_S = 2.0
"""Who is slower is not about to enter a runway."""
HARD_BRAKING_M_S2 = 4.0
"""Of a vehicle in front of a hold line."""
ONE_SIDED = 0.67
"""Of the 95 % radius of a position error, exceeded in 5 % of cases in one direction:
1.645 / 2.4477."""
CROSSING_NS = 30 * SECOND_NS
"""Who was cleared to cross, and is not seen, is across after that."""
FLIGHT_PATH_M = 60.0
"""Birds that will be no farther beside the flight path are in it,"""
FLIGHT_PATH_HEIGHT_M = 40.0
"""or no farther above or below."""
BIRDS_WANDER_M_S = 3.0
"""By which they get elsewhere than straight on, for each second."""
BIRDS_BESIDE_M = 300.0
"""Birds in the air that are no farther beside the flight path may get into it."""
BIRDS_ABOVE_M = 100.0
BIRDS_FORESEEN_S = 25.0
"""For so long birds are taken to fly straight on."""
CLIMB_OUT_HEIGHT_M = 150.0
"""Below it birds over a runway are in the way of a departure."""
LEAST_CLOSING = 0.1
"""Of an arrival's speed; who flies before it hardly slower is not met."""
BIRDS_LIKELY = 0.3
"""Part of the places at which birds of unknown distance may be."""
WILDLIFE = "wildlife"
UNIDENTIFIED = "unidentified"
_DOING: dict[Kind, str] = {
    "arrival": "on final for",
    "departure": "takes off from",
    "rollout": "rolls out on",
}


@dataclass(frozen=True)
class RunwayConfig:
    """Thresholds for conflicts on runways.

    Surface alerting first looks at an arrival 30 s before the threshold in good visibility
    (EUROCONTROL-SPEC-171). A WARNING comes 5 s before that, for the way that an advisory takes,
    and a CAUTION well ahead of it.
    """

    caution_s: float = 60.0
    warning_s: float = 35.0
    late_s: float = PAPER_TIME_TO_GO_S
    """Nearer than this, who is on the runway is in the way even if it is about to leave."""
    leaving_margin_s: float = 8.0
    """Between somebody's leaving and the next user."""
    crossing_margin_s: float = 10.0
    """Between two that pass the crossing of two runways."""
    persistence_s: float = 1.0
    """How long a severity must hold before it is told."""
    release_s: float = 5.0
    """How long a conflict must be over before it is told so."""


@dataclass(frozen=True, slots=True)
class Threat:
    """Something that is wrong."""

    key: tuple[str, ...]
    """The same for the same conflict, from step to step."""
    severity: Severity
    """INFO where all will be well, but is not yet."""
    strip: Strip
    runway: str
    """The direction that is used."""
    parties: tuple[str, ...]
    """Callsigns of those whom it concerns."""
    traffic: tuple[str, ...]
    """Those, and what else is in the way."""
    text: str
    text_for_other: str | None = None
    """For the second party, where it is another."""
    time_to_go_s: float | None = None
    sources: tuple[str, ...] = ("adsb",)
    """That on which it hinges first."""
    kind: Literal["runway_conflict", "readback_mismatch"] = "runway_conflict"


class Assessment:
    """Looks for threats in a situation at one instant."""

    def __init__(self, situation: Situation, config: RunwayConfig, t_ns: int) -> None:
        self._situation = situation
        self._config = config
        self._t_ns = t_ns
        self._in_force = list(situation.clearances.in_force(t_ns))

    def threats(self) -> Iterator[Threat]:
        """Yield all; more than one may have the same key."""
        uses = list(self._situation.uses.values())
        for use in uses:
            for obstacle in self._situation.obstacles(use.strip):
                yield from self._in_way(use, obstacle)
            for seen in self._situation.seen(use.strip):
                yield from self._seen_in_way(use, seen)
            yield from self._unseen(use)
            yield from self._wildlife(use)
            for thing in self._situation.aloft:
                yield from self._aloft(use, thing)
        for first, second in itertools.combinations(uses, 2):
            if first.strip is second.strip:
                yield from self._head_on(first, second)
            else:
                yield from self._crossing(first, second)
        for discrepancy in self._situation.clearances.discrepancies(self._t_ns):
            yield from self._misread(discrepancy)
        yield from self._opposed()

    # --- a runway is occupied and somebody comes: step (b) ----------------------------------

    def _in_way(self, use: Use, obstacle: Obstacle) -> Iterator[Threat]:
        """Yield that somebody is on a runway before its user, or about to enter it."""
        other = obstacle.mobile
        enters = not obstacle.is_inside
        coming = None if other is use.mobile else self._coming(use, other.point)
        if coming is None or (enters and not self._enters(obstacle, use.strip)):
            return
        severity, time_to_go_s = coming
        clear_s, is_allowed = self._clear_s(obstacle, use), self._is_allowed(other, use.strip)
        if self._is_harmless(clear_s, is_allowed, severity, time_to_go_s):
            severity = Severity.INFO
        if enters and severity is Severity.WARNING:
            severity = Severity.CAUTION
        verb = "is about to enter" if enters else "is on"
        yield self._between(
            use,
            other.callsign,
            severity,
            f"{other.callsign} {verb} runway {use.direction.ident}",
            time_to_go_s,
        )

    def _seen_in_way(self, use: Use, seen: SeenObstacle) -> Iterator[Threat]:
        """Yield that cameras show something on a runway before its user.

        While it is not sure yet, it is one hint among others.
        """
        runway, thing = use.direction.ident, seen.thing
        coming = self._coming(use, thing.spot.point)
        if coming is None:
            return
        severity, time_to_go_s = coming
        callsign = None
        if not thing.is_animal:
            callsign = self._sent_there(use.strip, thing.label == "truck")
        cleared_to = self._cleared_to(callsign, use.strip)
        clear_s = None if "proceed" in cleared_to else seen.clear_s
        if seen.is_sure and self._is_harmless(
            clear_s, "cross" in cleared_to, severity, time_to_go_s
        ):
            severity = Severity.INFO
        elif not seen.is_sure:
            reported = self._situation.has_wildlife(use.strip, self._t_ns)
            is_told = reported if thing.is_animal else callsign is not None
            hinted = fused_severity(seen.weight, 1.0, float(is_told))
            if hinted is None:
                return
            severity = min(severity, hinted, key=lambda each: each.rank)
        sources: tuple[str, ...] = ("vision", "adsb") if seen.is_sure else ("adsb", "vision")
        if thing.is_animal:
            text, other = f"{thing.label} on runway {runway}", WILDLIFE
        elif callsign is not None:
            text, other = f"{callsign} is on runway {runway}, seen by camera", callsign
            sources = (*sources, "radio")
        else:
            text, other = f"unidentified {thing.label} on runway {runway}", UNIDENTIFIED
        yield self._between(use, other, severity, text, time_to_go_s, sources)

    def _sent_there(self, strip: Strip, vehicle: bool) -> str | None:
        """Return the one vehicle, or aircraft, without ADS-B that was cleared on to a runway."""
        situation = self._situation
        names = {
            clearance.callsign
            for clearance in self._cleared_on(strip)
            if situation.mobile(clearance.callsign) is None
            and situation.is_vehicle(clearance.callsign) == vehicle
        }
        return names.pop() if len(names) == 1 else None

    def _coming(self, use: Use, point: Vector) -> tuple[Severity, float] | None:
        """Return how severe it is that a runway's user comes to a place, and its time to go.

        None if it does not, or not soon.
        """
        along_m = use.direction.along_m(point)
        if use.is_climbing or along_m < use.along_m - BEHIND_M:
            return None
        time_to_go_s = self._time_to_go_s(use, along_m)
        severity = self._urgency(use, time_to_go_s)
        return None if severity is None else (severity, time_to_go_s)

    def _is_harmless(
        self, clear_s: float | None, is_allowed: bool, severity: Severity, time_to_go_s: float
    ) -> bool:
        """Return whether what is on a runway leaves it in time, and may do so as late."""
        if clear_s is None or clear_s + self._config.leaving_margin_s > time_to_go_s:
            return False
        is_late = time_to_go_s <= self._config.late_s
        return (is_allowed and not is_late) or severity is Severity.CAUTION

    def _time_to_go_s(self, use: Use, along_m: float) -> float:
        """Return the time until a runway's user is there; infinite if it stops before.

        For an arrival it is the time to the threshold.
        """
        if use.kind == "arrival":
            return use.time_to_threshold_s(self._t_ns)
        if use.kind == "rollout":
            braked_m = use.mobile.speed_m_s**2 / (2.0 * BRAKING_M_S2) + STOPPING_MARGIN_M
            if along_m - use.along_m > braked_m:
                return math.inf
            return max(along_m - use.along_m, 0.0) / use.mobile.speed_m_s
        time_s = use.time_to_s(max(along_m, use.along_m), self._t_ns)
        return math.inf if time_s is None else time_s

    def _urgency(self, use: Use, time_to_go_s: float) -> Severity | None:
        """Return how severe it is that the runway's user finds it occupied."""
        if math.isinf(time_to_go_s):
            return None
        if use.kind != "arrival" or time_to_go_s <= self._config.warning_s:
            return Severity.WARNING
        return Severity.CAUTION if time_to_go_s <= self._config.caution_s else None

    def _enters(self, obstacle: Obstacle, strip: Strip) -> bool:
        """Return whether somebody outside can surely not stop short of the runway any more.

        Who was told to hold is given the benefit of the doubt.
        """
        mobile = obstacle.mobile
        idents = tuple(direction.ident for direction in strip.directions)
        holds = self._situation.clearances.is_holding(mobile.callsign, idents)
        error_m = NACP_95_PERCENT_M[mobile.nacp] * (1.0 if holds else ONE_SIDED)
        to_line_m = obstacle.way.entry_m - strip.margin_m(mobile.nacp)
        braking_m = mobile.speed_m_s**2 / (2.0 * HARD_BRAKING_M_S2)
        return mobile.speed_m_s > LEAST_ENTRY_M_S and to_line_m + error_m <= braking_m

    def _clear_s(self, obstacle: Obstacle, use: Use) -> float | None:
        """Return when somebody will be off the runway, or in the air; None if it will not."""
        mobile, speed = obstacle.mobile, obstacle.mobile.speed_m_s
        own = self._situation.use(mobile)
        if own is not None and own.kind == "departure" and own.strip is use.strip:
            follows = own.direction is use.direction
            return max(LIFT_OFF_M_S - speed, 0.0) / TAKEOFF_M_S2 if follows else None
        if speed < STANDING_M_S or "proceed" in self._cleared_to(mobile.callsign, use.strip):
            return None
        straight_s = obstacle.way.exit_m / speed
        if not mobile.landed:
            return straight_s
        return min(straight_s, max(speed - TURN_OFF_M_S, 0.0) / BRAKING_M_S2 + TURN_OFF_S)

    def _is_allowed(self, mobile: Mobile, strip: Strip) -> bool:
        """Return whether somebody has landed, takes off, or was cleared to cross a runway."""
        return (
            mobile.landed
            or self._situation.use(mobile) is not None
            or "cross" in self._cleared_to(mobile.callsign, strip)
        )

    def _cleared_to(self, callsign: str | None, strip: Strip) -> set[Action]:
        return {c.action for c in self._cleared_on(strip) if c.callsign == callsign}

    def _cleared_on(self, strip: Strip) -> Iterator[Clearance]:
        for clearance in self._in_force:
            if self._situation.aerodrome.strip_of(clearance.runway) is strip:
                yield clearance

    def _unseen(self, use: Use) -> Iterator[Threat]:
        """Yield that somebody unseen was cleared on to the runway; of less weight."""
        if use.is_climbing:
            return
        for clearance in self._cleared_on(use.strip):
            callsign = clearance.callsign
            if clearance.action not in ("cross", "proceed") or self._situation.mobile(callsign):
                continue
            time_to_go_s = self._time_to_go_s(use, use.direction.length_m)
            if self._urgency(use, time_to_go_s) is None:
                continue
            left_ns = clearance.t_end_ns + CROSSING_NS - self._t_ns
            if clearance.action == "cross" and left_ns / SECOND_NS <= time_to_go_s:
                continue
            text = f"{callsign} was cleared on to runway {use.direction.ident}"
            yield self._between(
                use, callsign, Severity.CAUTION, text, time_to_go_s, ("adsb", "radio")
            )

    def _wildlife(self, use: Use) -> Iterator[Threat]:
        """Yield that wildlife was reported on the runway."""
        if not self._situation.has_wildlife(use.strip, self._t_ns):
            return
        if use.kind == "rollout" or use.is_climbing:
            return
        time_to_go_s = self._time_to_go_s(use, use.along_m)
        severity = self._urgency(use, time_to_go_s)
        if severity is not None:
            text = f"wildlife reported on runway {use.direction.ident}"
            yield self._between(use, WILDLIFE, severity, text, time_to_go_s, ("adsb", "radio"))

    # --- birds in the air, and aircraft that only cameras show ------------------------------

    def _aloft(self, use: Use, thing: SeenAloft) -> Iterator[Threat]:
        """Yield that something is, or will be, where a runway's user flies."""
        if use.kind == "rollout" or use.is_climbing:
            return
        times = (self._meets_s(use, thing, place) for place in thing.places)
        met = [time_s for time_s in times if time_s is not None]
        time_to_go_s = min(met, default=None)
        is_in_path = len(met) >= max(BIRDS_LIKELY * len(thing.places), 1.0)
        severity = None
        if is_in_path and time_to_go_s is not None:
            severity = self._urgency(use, time_to_go_s)
            if severity is Severity.WARNING and not thing.is_located:
                severity = Severity.CAUTION
        elif thing.is_located:
            time_to_go_s = self._time_abeam_s(use, thing.places[0])
            if time_to_go_s is not None and self._are_beside(use, thing.places[0]):
                severity = self._urgency(use, time_to_go_s) and Severity.CAUTION
        if severity is not None:
            where = "on final for" if use.kind == "arrival" else "over"
            what, other = "unidentified aircraft", UNIDENTIFIED
            if thing.are_birds:
                what, other = "birds", WILDLIFE
            text = f"{what} {where} runway {use.direction.ident}"
            yield self._between(use, other, severity, text, time_to_go_s, ("vision", "adsb"))

    def _meets_s(self, use: Use, thing: SeenAloft, place: Fix) -> float | None:
        """Return when a runway's user meets what flies straight on; None if it does not."""
        east, north, up = thing.velocity
        ahead = use.direction.ahead
        time_s = self._time_abeam_s(use, place, east * ahead.east + north * ahead.north)
        if time_s is None:
            return None
        flown_s = min(time_s, BIRDS_FORESEEN_S)
        point = Vector(place.point.east + east * flown_s, place.point.north + north * flown_s)
        low_m, high_m = sorted((place.height_m, max(place.height_m + up * flown_s, 0.0)))
        room_m = 2.0 * place.error_m + BIRDS_WANDER_M_S * flown_s * thing.is_located
        if abs(use.direction.across_m(point)) > FLIGHT_PATH_M + room_m:
            return None
        room_m += FLIGHT_PATH_HEIGHT_M
        path_m = self._height_m(use, use.direction.along_m(point))
        if use.mobile.on_ground:  # Until then it may be anywhere below.
            return time_s if low_m <= CLIMB_OUT_HEIGHT_M + room_m else None
        return time_s if low_m - room_m <= path_m <= high_m + room_m else None

    def _are_beside(self, use: Use, place: Fix) -> bool:
        """Return whether birds in the air are near enough to get into the flight path."""
        path_m = self._height_m(use, use.direction.along_m(place.point))
        is_near = abs(use.direction.across_m(place.point)) <= BIRDS_BESIDE_M
        return is_near and place.height_m <= path_m + BIRDS_ABOVE_M

    def _time_abeam_s(self, use: Use, place: Fix, ahead_m_s: float = 0.0) -> float | None:
        """Return when a runway's user draws level with a place that moves on; None if never."""
        along_m = use.direction.along_m(place.point)
        if not -FINAL_M <= along_m <= use.direction.length_m:
            return None
        time_s = use.time_to_s(along_m, self._t_ns)
        if time_s is None or use.kind != "arrival":
            return time_s
        closing = 1.0 - ahead_m_s / max(use.mobile.speed_m_s, 1.0)
        return time_s / closing if closing > LEAST_CLOSING else None

    def _height_m(self, use: Use, along_m: float) -> float:
        """Return how high above the ground, as cameras give heights, an arrival will be."""
        mobile = use.mobile
        if mobile.altitude_m is None:
            return 0.0
        left_m = TOUCHDOWN_M - use.along_m
        height_m = mobile.altitude_m - self._situation.aerodrome.ground_m
        return height_m * max(TOUCHDOWN_M - along_m, 0.0) / left_m if left_m > 0.0 else 0.0

    def _between(
        self,
        use: Use,
        other: str,
        severity: Severity,
        text: str,
        time_to_go_s: float | None,
        sources: tuple[str, ...] = ("adsb",),
    ) -> Threat:
        """Return a threat between the user of a runway and somebody, or something."""
        own = use.mobile.callsign
        return Threat(
            ("runway", *sorted((own, other))),
            severity,
            use.strip,
            use.direction.ident,
            (own,) if other in (WILDLIFE, UNIDENTIFIED) else (own, other),
            (own, other),
            text,
            f"{own} {_DOING[use.kind]} runway {use.direction.ident}",
            time_to_go_s,
            sources,
        )

    # --- two use runways that meet ----------------------------------------------------------

    def _head_on(self, first: Use, second: Use) -> Iterator[Threat]:
        """Yield that two use one runway in opposite directions."""
        if first.direction is second.direction:
            return
        gap_m = first.direction.along_m(second.mobile.point) - first.along_m
        kinds = {first.kind, second.kind}
        if gap_m < 0.0 or kinds == {"arrival", "rollout"}:  # The latter is on the runway.
            return
        if kinds == {"arrival"}:
            time_to_go_s = min(use.time_to_threshold_s(self._t_ns) for use in (first, second))
            severity = self._urgency(first, time_to_go_s)
        else:
            closing_m_s = first.mobile.speed_m_s + second.mobile.speed_m_s
            time_to_go_s = gap_m / max(closing_m_s, ROLLING_M_S)
            severity = Severity.WARNING
        if severity is not None:
            text = f"{second.mobile.callsign} opposite on runway {first.strip.name}"
            yield self._between(first, second.mobile.callsign, severity, text, time_to_go_s)

    def _crossing(self, first: Use, second: Use) -> Iterator[Threat]:
        """Yield that two come to the crossing of their runways at about the same time."""
        point = self._situation.aerodrome.crossing(first.strip, second.strip)
        if point is None:
            return
        times_s = [
            use.time_to_s(use.direction.along_m(point), self._t_ns) for use in (first, second)
        ]
        own_s, other_s = times_s
        if own_s is None or other_s is None:
            return
        time_to_go_s = min(own_s, other_s)
        config = self._config
        if abs(own_s - other_s) > config.crossing_margin_s or time_to_go_s > config.caution_s:
            return
        severity = Severity.WARNING if time_to_go_s <= config.warning_s else Severity.CAUTION
        text = f"{second.mobile.callsign} on crossing runway {second.direction.ident}"
        yield self._between(first, second.mobile.callsign, severity, text, time_to_go_s)

    # --- what was said: steps (a) and (c) ---------------------------------------------------

    def _misread(self, discrepancy: Discrepancy) -> Iterator[Threat]:
        """Yield that a readback is wrong, or somebody else's, and the runway is active."""
        strip, activity = self._activity(discrepancy)
        if strip is None or not activity:
            return
        parties = tuple(dict.fromkeys((discrepancy.callsign, discrepancy.addressed)))
        yield Threat(
            ("readback", discrepancy.callsign, str(discrepancy.t_end_ns)),
            Severity.CAUTION,
            strip,
            discrepancy.read.runway or strip.directions[0].ident,
            parties,
            tuple(dict.fromkeys((*parties, activity[0]))),
            f"{discrepancy.words}, traffic {activity[0]}",
            sources=("radio", "adsb"),
            kind="readback_mismatch",
        )

    def _activity(self, discrepancy: Discrepancy) -> tuple[Strip | None, list[str]]:
        """Return the runway that a wrong readback is about, and who else uses it."""
        aerodrome = self._situation.aerodrome
        named = [each.runway for each in (discrepancy.read, discrepancy.given) if each]
        strips = [strip for ident in named if (strip := aerodrome.strip_of(ident)) is not None]
        for strip in dict.fromkeys(strips) or aerodrome.strips:
            activity = [name for name in self._active(strip) if name != discrepancy.callsign]
            if activity:
                return strip, list(dict.fromkeys(activity))
        return None, []

    def _active(self, strip: Strip) -> Iterator[str]:
        """Yield who is on a runway, uses it or one that crosses it, or was cleared on to it."""
        for obstacle in self._situation.obstacles(strip):
            if obstacle.is_inside:
                yield obstacle.mobile.callsign
        for use in self._situation.uses.values():
            if use.strip is strip or self._situation.aerodrome.crossing(strip, use.strip):
                yield use.mobile.callsign
        for clearance in self._cleared_on(strip):
            yield clearance.callsign

    def _opposed(self) -> Iterator[Threat]:
        """Yield that two are cleared to use one runway in opposite directions."""
        using = [
            clearance
            for clearance in self._in_force
            if clearance.action in ("cleared_to_land", "cleared_for_takeoff", "line_up")
        ]
        for first, second in itertools.combinations(using, 2):
            strip = self._situation.aerodrome.strip_of(first.runway)
            if (
                strip is None
                or first.runway is None
                or strip is not self._situation.aerodrome.strip_of(second.runway)
                or first.runway == second.runway
                or first.callsign == second.callsign
            ):
                continue
            parties = (first.callsign, second.callsign)
            yield Threat(
                ("clearances", strip.name, *sorted(parties)),
                Severity.CAUTION,
                strip,
                first.runway,
                parties,
                parties,
                f"cleared for runway {first.runway} and runway {second.runway}",
                sources=("radio",),
            )
