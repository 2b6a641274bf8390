"""The state of an airport's runways: who uses them, what is on them, what was said."""

from __future__ import annotations

import copy
import math
from typing import NamedTuple

from airhilt.assistant.decision.aerodrome import Aerodrome, Strip, Way, way_through
from airhilt.assistant.decision.clearances import Clearances
from airhilt.assistant.decision.guard import ConfidenceGuard, call_of
from airhilt.assistant.decision.mobiles import (
    BRAKING_M_S2,
    STANDING_M_S,
    TAKEOFF_M_S2,
    Mobile,
    Use,
    use_of,
)
from airhilt.assistant.decision.occupancy import (
    SeenAloft,
    SeenOnGround,
    seen_aloft,
    seen_on_ground,
    velocity_of,
)
from airhilt.assistant.decision.partial_calls import PartialCalls
from airhilt.assistant.decision.velocity_checks import VelocityChecks
from airhilt.assistant.decision.visual_tracks import VisualTracks
from airhilt.messages import (
    AdsbReport,
    AirportBriefing,
    Briefing,
    Message,
    PartialTranscript,
    Transcript,
    TransmissionOpened,
)
from airhilt.phraseology import Call
from airhilt.units import SECOND_NS

STALE_NS = 15 * SECOND_NS
"""Silence after which a mobile is forgotten, in ns."""
STALE_STANDING_NS = 30 * SECOND_NS
"""Likewise for a standing mobile, which squitters every five seconds."""
WILDLIFE_NS = 120 * SECOND_NS
"""Time for which wildlife stays where it was reported, in ns."""
LEAST_CHANCE = 0.2
"""Probability below which something is beside a protected area."""
CERTAIN_CHANCE = 0.8
"""Probability from which it counts as certain that something is in the area."""
LIFT_OFF_M_S = 75.0
"""Speed at which a departure has left the ground, in m/s."""
TURN_OFF_M_S = 8.0
"""Speed to which a landing brakes before it turns off, in m/s."""
TURN_OFF_S = 12.0
"""Time from then until it has left the runway, in s."""


class Obstacle(NamedTuple):
    """A mobile on the ground, by ADS-B, whose straight way leads through a protected area."""

    mobile: Mobile
    way: Way

    @property
    def is_inside(self) -> bool:
        """True if it is in the area now."""
        return self.way.entry_m <= 0.0

    def leaving_s(self, own: Use | None, use: Use) -> float | None:
        """Return the time until it is out of the way of a runway's user, in s; None if it stays.

        It is then off the runway, or in the air. Its own use of a runway is None without one.
        """
        mobile, speed = self.mobile, self.mobile.speed_m_s
        if own is not None and own.kind == "departure" and own.strip is use.strip:
            follows = own.direction is use.direction
            return max(LIFT_OFF_M_S - speed, 0.0) / TAKEOFF_M_S2 if follows else None
        if speed < STANDING_M_S:
            return None
        straight_s = self.way.exit_m / speed
        if not mobile.landed:
            return straight_s
        return min(straight_s, max(speed - TURN_OFF_M_S, 0.0) / BRAKING_M_S2 + TURN_OFF_S)


class SeenObstacle(NamedTuple):
    """Something in a protected area that only cameras show."""

    thing: SeenOnGround
    speed_m_s: float
    exit_m: float
    """Distance straight on to where it leaves the area, in m."""
    weight: float
    """Probability that it is there and in the area."""
    is_certain: bool
    """True if both count as certain."""

    @property
    def clear_s(self) -> float | None:
        """Time until it has left the area, in s; None if it stands."""
        return self.exit_m / self.speed_m_s if self.speed_m_s >= STANDING_M_S else None


class RunwaySituation:
    """The runways of an airport, and everybody near them."""

    def __init__(
        self, airport: AirportBriefing, briefing: Briefing, guard: ConfidenceGuard | None = None
    ) -> None:
        self.aerodrome = Aerodrome(airport)
        self._guard = guard or ConfidenceGuard()
        self.clearances = Clearances(self._guard)
        self._partial_calls = PartialCalls(self._guard)
        self.uses: dict[str, Use] = {}
        """Uses of runways by address."""
        self._roster = {entry.callsign: entry.category == "vehicle" for entry in briefing.roster}
        """Mark of each callsign that is a vehicle."""
        self._animals = frozenset(briefing.animals)
        self._mobiles: dict[str, Mobile] = {}
        self._velocities = VelocityChecks()
        self._heard_ns: dict[str, int] = {}
        """Time at which the last report of each arrived, however old it was."""
        self._obstacles: dict[str, dict[str, Obstacle]] = {
            strip.name: {} for strip in self.aerodrome.strips
        }
        """Obstacles by runway and address."""
        self._wildlife: dict[str, Transcript] = {}
        """The last report of wildlife, by runway."""
        self.aloft: tuple[SeenAloft, ...] = ()
        """Things in the air that only cameras show."""
        self._seen: dict[str, list[SeenObstacle]] = {}
        """Obstacles that only cameras show, by runway."""

    def is_vehicle(self, callsign: str) -> bool:
        """Return whether a callsign is a vehicle by the roster."""
        return self._roster.get(callsign, False)

    def mobile(self, callsign: str) -> Mobile | None:
        """Return the mobile with a callsign, None if there is none."""
        return next((m for m in self._mobiles.values() if m.callsign == callsign), None)

    def use(self, mobile: Mobile) -> Use | None:
        """Return how a mobile uses a runway, None if it does not."""
        return self.uses.get(mobile.icao24)

    def obstacles(self, strip: Strip) -> list[Obstacle]:
        """Return the mobiles on a runway, or with it straight ahead."""
        return list(self._obstacles[strip.name].values())

    def seen(self, strip: Strip) -> list[SeenObstacle]:
        """Return what only cameras show on a runway."""
        return self._seen.get(strip.name, [])

    def look(self, visual_tracks: VisualTracks) -> None:
        """Update what cameras show on the ground and in the air."""
        self.aloft = tuple(seen_aloft(visual_tracks, self.aerodrome))
        things = list(seen_on_ground(visual_tracks, self.aerodrome, self.aloft, self._animals))
        self._seen = {
            strip.name: [seen for thing in things if (seen := self._seen_on(strip, thing))]
            for strip in self.aerodrome.strips
        }

    def _seen_on(self, strip: Strip, thing: SeenOnGround) -> SeenObstacle | None:
        """Return something that cameras show as an obstacle; None if it is not on the runway."""
        chance = thing.fix.chance(strip.share_inside)
        if chance < LEAST_CHANCE:
            return None
        # Nobody knows where an animal will go: it stands.
        east, north = (0.0, 0.0) if thing.is_animal else velocity_of(thing, self.aerodrome)
        ahead = way_through(strip.core(), thing.fix.point, math.atan2(east, north))
        return SeenObstacle(
            thing,
            speed_m_s=math.hypot(east, north),
            exit_m=0.0 if ahead is None else ahead.exit_m,
            weight=thing.belief * chance,
            is_certain=thing.is_established and chance >= CERTAIN_CHANCE,
        )

    def wildlife_report(self, strip: Strip, t_ns: int) -> Transcript | None:
        """Return the report of wildlife on a runway within `WILDLIFE_NS`, None without one."""
        report = self._wildlife.get(strip.name)
        return report if report is not None and t_ns - report.t_end_ns <= WILDLIFE_NS else None

    def take(self, message: Message, t_ns: int) -> None:
        """Update what is known with one message at a time."""
        match message:
            case AdsbReport():
                self.take_report(message, t_ns)
            case TransmissionOpened():
                self.clearances.take_opening(message)
            case PartialTranscript():
                self._partial_calls.take(message, self.callsigns)
            case Transcript():
                self.take_transcript(message)

    def take_report(self, report: AdsbReport, t_ns: int) -> None:
        """Update the position of an aircraft or a vehicle at a time."""
        self._heard_ns[report.icao24] = t_ns
        report = self._velocities.checked(report)
        point = self.aerodrome.locate(report.latitude_deg, report.longitude_deg)
        mobile = self._mobiles.get(report.icao24)
        if mobile is None:
            mobile = self._mobiles[report.icao24] = Mobile.of(report, point)
        elif report.t_adsb_in_ns < mobile.t_ns:
            return
        else:
            mobile.update(report, point)
        mobile.is_vehicle = mobile.is_vehicle or self.is_vehicle(mobile.callsign)
        self._place(mobile)

    def _place(self, mobile: Mobile) -> None:
        """Update which runways a mobile is on, is heading for, or uses."""
        for strip in self.aerodrome.strips:
            obstacles, core = self._obstacles[strip.name], strip.core(mobile.nacp)
            way = way_through(core, mobile.point, mobile.heading_rad) if mobile.on_ground else None
            if way is None:
                obstacles.pop(mobile.icao24, None)
            else:
                obstacles[mobile.icao24] = Obstacle(mobile, way)
        if not mobile.on_ground:
            self.clearances.finish(mobile.callsign, "cleared_for_takeoff", "line_up")
        elif mobile.landed and not any(s.contains(mobile.point) for s in self.aerodrome.strips):
            mobile.landed = False
            self.clearances.finish(mobile.callsign, "cleared_to_land")
        use = use_of(mobile, self.aerodrome.strips)
        if use is None:
            self.uses.pop(mobile.icao24, None)
        else:
            self.uses[mobile.icao24] = use

    def forget(self, t_ns: int) -> None:
        """Forget the mobiles of which nothing arrived for a while."""
        for icao24, mobile in list(self._mobiles.items()):
            standing = mobile.on_ground and mobile.speed_m_s < STANDING_M_S
            silent_ns = t_ns - self._heard_ns[icao24]
            if silent_ns > (STALE_STANDING_NS if standing else STALE_NS):
                del self._mobiles[icao24]
                self.uses.pop(icao24, None)
                for obstacles in self._obstacles.values():
                    obstacles.pop(icao24, None)

    @property
    def callsigns(self) -> list[str]:
        """Callsigns of all who are expected or known by ADS-B, in order."""
        return sorted(self._roster.keys() | {each.callsign for each in self._mobiles.values()})

    def supposed(self, t_ns: int) -> tuple[RunwaySituation, tuple[str, ...]] | None:
        """Return the situation that follows if unfinished calls mean what was heard of them so far.

        With it come the ids of these calls; None if none has a provisional instruction.
        """
        calls = self._partial_calls.provisional(t_ns)
        if not calls:
            return None
        other = copy.copy(self)
        other.clearances = copy.deepcopy(self.clearances)
        for call, heard in calls:
            other.clearances.take(call, heard)
        return other, tuple(heard.id for _, heard in calls)

    def take_transcript(self, transcript: Transcript) -> None:
        """Update clearances and reports of wildlife with a call."""
        self._partial_calls.end(transcript.id)
        call = call_of(transcript, self.callsigns)
        for said in call.instructions:
            if said.action == "wildlife":
                for strip in self._reported_on(said.runway, call):
                    self._wildlife[strip.name] = transcript
            elif said.action == "wildlife_gone" and self._guard.is_certain(said):
                for strip in self._reported_on(said.runway, call):
                    self._wildlife.pop(strip.name, None)
        self.clearances.take(call, transcript)

    def _reported_on(self, runway: str | None, call: Call) -> tuple[Strip, ...]:
        """Return the runway named, else the one that the caller uses, else all."""
        strip = self.aerodrome.strip_of(runway)
        if strip is not None:
            return (strip,)
        used = [use.strip for use in self.uses.values() if use.mobile.callsign == call.callsign]
        return tuple(used) or self.aerodrome.strips
