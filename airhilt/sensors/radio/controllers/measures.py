"""Measures of a controller about an advisory: an action for each whom it concerns.

An advisory that recommends actions decides it. Without recommendations the controller judges by
its strips and displays.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from itertools import combinations

from airhilt.geodesy.relative_motion import Minima, VerticalProfile, relative, time_to_loss_s
from airhilt.messages import (
    Advisory,
    CancelTakeoff,
    Climb,
    GoAround,
    HoldPosition,
    MaintainLevel,
    Recommendation,
    Severity,
)
from airhilt.phraseology import Action
from airhilt.sensors.radio.controllers.displays import Displays, Target
from airhilt.sensors.radio.controllers.strips import DEPARTING, ENTERING, LANDING, Strips
from airhilt.sensors.radio.radio_call import RadioCall
from airhilt.units import FOOT, FOOT_PER_MINUTE, KNOT, NAUTICAL_MILE

ROLLING_M_S = 30.0 * KNOT
"""Ground speed in m/s from which somebody on a runway is not taxiing: an assumption."""
CLIMBING_M_S = 500.0 * FOOT_PER_MINUTE
"""Vertical speed in m/s from which somebody climbs for sure: an assumption."""
LEVEL_FT = 1000.0
"""Distance of cruising levels (ICAO Annex 2, appendix 3), in ft."""
USUAL_RATE_FPM = 1500.0
"""Vertical rate that a recommendation of the controller's own stands for, in ft/min; nothing of it
is said."""
LEAST_HEIGHT_M = 2000.0 * FOOT
"""Height above the airport below which a controller gives no descent, in m: an assumption."""
LOOK_AHEAD_S = 120.0
"""Time for which a controller judges by displays whether two come near each other, in s."""
ALERT_WITHIN_S = 60.0
"""Time to a loss of separation in s within which two are in unsafe proximity, so that a controller
issues a safety alert (FAA Order JO 7110.65, 2-1-6): an assumption."""
NEAR_ON_GROUND_M = 0.5 * NAUTICAL_MILE
"""Distance in m within which two on an airport are near each other: an assumption."""


@dataclass(frozen=True, slots=True)
class Measure:
    """An action for one actor."""

    callsign: str
    action: Recommendation
    traffic: Target | None = None
    """Traffic that it is to be told of, if that is displayed."""
    is_alert: bool = True
    """True if the two are in unsafe proximity, or that cannot be told."""


@dataclass(frozen=True, slots=True)
class Repetition:
    """An instruction that is said again to one actor, because it was not read back as given."""

    callsign: str
    call: RadioCall
    is_correction: bool
    """True if it was read back otherwise; False if it was not read back."""


class Judgement:
    """Decides on measures, from an advisory, the strips and the displays."""

    def __init__(self, displays: Displays, strips: Strips, said: Mapping[str, RadioCall]) -> None:
        self._displays = displays
        self._strips = strips
        self._said = said
        self._levels: dict[str, dict[str, Recommendation]] = {}
        """Levels that the controllers chose themselves, by advisory: they hold while it lasts."""

    def forget(self, advisory_id: str) -> None:
        """Forget what was decided about an advisory that is over."""
        self._levels.pop(advisory_id, None)

    def measures(self, advisory: Advisory) -> tuple[Measure | Repetition, ...]:
        """Return what is to be done about an advisory, the most important first."""
        actions = dict(self._recommended(advisory)) or dict(self._own(advisory))
        measures: list[Measure | Repetition] = []
        doubt = self._in_doubt(advisory)
        if doubt is not None and isinstance(actions.get(doubt.callsign), MaintainLevel | None):
            actions.pop(doubt.callsign, None)
            if not self._is_read_back(doubt, advisory):
                measures.append(doubt)
        measures += (self._measure(advisory, *each) for each in actions.items())
        return tuple(measures)

    def _measure(self, advisory: Advisory, callsign: str, action: Recommendation) -> Measure:
        own = self._displays.target(callsign)
        others = [name for name in advisory.traffic if name != callsign]
        traffic = self._displays.target(others[0]) if others else None
        is_alert = own is None or traffic is None or self._come_near(own, traffic, ALERT_WITHIN_S)
        return Measure(callsign, action, traffic, is_alert=is_alert)

    def is_contradicted(self, advisory: Advisory) -> bool:
        """Return whether the displays show all of the traffic, and no two of it coming near.

        What was read back is no matter of displays.
        """
        targets = [self._displays.target(callsign) for callsign in advisory.traffic]
        shown = [target for target in targets if target is not None]
        if advisory.kind not in ("loss_of_separation", "runway_conflict"):
            return False
        if len(shown) < max(2, len(targets)):
            return False
        return not any(
            self._come_near(one, other, LOOK_AHEAD_S) for one, other in combinations(shown, 2)
        )

    def _come_near(self, one: Target, other: Target, within_s: float) -> bool:
        motion = relative(one, other)
        if one.on_ground or other.on_ground:
            within = motion.interval_within(NEAR_ON_GROUND_M)
            return within is not None and within[1] >= 0.0 and within[0] <= within_s
        minima = Minima(self._displays.horizontal_minimum_m, self._displays.vertical_minimum_m)
        own, their = (VerticalProfile(it.altitude_m, it.vertical_m_s) for it in (one, other))
        loss_s = time_to_loss_s(motion, own, their, minima)
        return loss_s is not None and loss_s <= within_s

    def _recommended(self, advisory: Advisory) -> Iterator[tuple[str, Recommendation]]:
        """Yield what an advisory recommends, as far as it makes sense by the displays.

        Who is on the runway already is to leave it, not to stop there, once the user of the runway
        is told to keep off. Who climbs away goes around already.
        """
        keep_off = any(
            isinstance(each, GoAround | CancelTakeoff) for each in advisory.recommendations.values()
        )
        for callsign, action in advisory.recommendations.items():
            target = self._displays.target(callsign)
            if target is not None and isinstance(action, GoAround):
                is_done = target.vertical_m_s > CLIMBING_M_S
            else:
                is_on = target is not None and self._displays.runway_of(target) is not None
                is_done = isinstance(action, HoldPosition) and is_on and keep_off
            if not is_done:
                yield callsign, action

    # --- what was read back wrongly ---------------------------------------------------------

    def _in_doubt(self, advisory: Advisory) -> Repetition | None:
        """Return the instruction that was read back wrongly, or by nobody, or by somebody else."""
        if advisory.kind != "readback_mismatch":
            return None
        calls = [self._said[name] for name in advisory.evidence.radio_ids if name in self._said]
        for callsign in advisory.traffic:
            given = self._strips.of(callsign).instructions
            spoke = any(call.speaker == callsign for call in calls)
            if given and (spoke or any(call.addressed == callsign for call in calls)):
                in_evidence = {call.first for call in calls}
                newest = list(reversed(given))
                first = next((each for each in newest if each in in_evidence), newest[0])
                return Repetition(callsign, given[first].call, is_correction=spoke)
        return None

    def _is_read_back(self, doubt: Repetition, advisory: Advisory) -> bool:
        """Return whether a unit has heard an instruction read back as it was.

        What it heard in the call that an advisory is about does not count: it may have misheard.
        """
        given = self._strips.of(doubt.callsign).instructions[doubt.call.first]
        calls = [self._said[name] for name in advisory.evidence.radio_ids if name in self._said]
        return given.is_read_back is True and given.readback not in calls

    # --- judged by the controller itself ----------------------------------------------------

    def _own(self, advisory: Advisory) -> Iterator[tuple[str, Recommendation]]:
        match advisory.kind:
            case "runway_conflict":
                yield from self._on_runway(advisory)
            case "loss_of_separation":
                levels = self._levels.get(advisory.id) or dict(self._in_flight(advisory))
                self._levels[advisory.id] = levels
                yield from levels.items()
            case _:
                return

    def _on_runway(self, advisory: Advisory) -> Iterator[tuple[str, Recommendation]]:
        """Yield the actions of those who use a runway, or are about to.

        Who departs is stopped. Who taxies or drives towards the runway holds, and so does who was
        cleared on to it and is on no display. Who is on it goes on. An arrival goes around once it
        is urgent, unless the displays show that all others can be held short.
        """
        is_urgent = advisory.severity.rank >= Severity.WARNING.rank
        are_short = True
        arrivals: list[tuple[str, str]] = []
        for callsign in advisory.traffic:
            target = self._displays.target(callsign)
            strip = self._strips.of(callsign)
            runway = strip.runway or advisory.evidence.runway or ""
            final = None if target is None else self._displays.final_of(target)
            if final is not None or _is_arrival(target, strip.runway_use):
                arrivals.append((callsign, final or runway))
                continue
            are_short &= target is not None and self._displays.runway_of(target) is None
            if _is_departure(target, strip.runway_use):
                yield callsign, CancelTakeoff(runway=runway)
            elif self._is_short(target, strip.runway_use):
                yield callsign, HoldPosition(runway=runway)
        if is_urgent and (not are_short or len(arrivals) > 1):
            for callsign, runway in arrivals[-1:] if are_short else arrivals:
                yield callsign, GoAround(runway=runway)

    def _is_short(self, target: Target | None, use: Action | None) -> bool:
        """Return whether somebody on the ground has not entered a runway, as far as is known."""
        if target is None:
            return use in ENTERING
        return target.on_ground and self._displays.runway_of(target) is None

    def _in_flight(self, advisory: Advisory) -> Iterator[tuple[str, Recommendation]]:
        """Yield a climb of the higher of two and a descent of the lower, to free levels."""
        targets = [self._displays.target(callsign) for callsign in advisory.traffic]
        shown = [target for target in targets if target is not None and not target.on_ground]
        if len(shown) < 2:
            return
        lower, higher = sorted(shown[:2], key=lambda each: (each.altitude_m, each.callsign))
        up_ft = _next_level_ft(max(lower.altitude_m, higher.altitude_m) / FOOT, up=True)
        down_ft = _next_level_ft(min(lower.altitude_m, higher.altitude_m) / FOOT, up=False)
        if up_ft <= self._displays.ceiling_ft(higher.callsign):
            yield (
                higher.callsign,
                Climb(sense="climb", altitude_ft=up_ft, vertical_rate_fpm=USUAL_RATE_FPM),
            )
        if self._displays.height_m(lower) - LEVEL_FT * FOOT >= LEAST_HEIGHT_M:
            yield (
                lower.callsign,
                Climb(sense="descend", altitude_ft=down_ft, vertical_rate_fpm=USUAL_RATE_FPM),
            )
        else:
            level_ft = round(lower.altitude_m / FOOT / 100.0) * 100.0
            yield lower.callsign, MaintainLevel(altitude_ft=level_ft)


def _is_arrival(target: Target | None, use: Action | None) -> bool:
    return use in LANDING and (target is None or not target.on_ground)


def _is_departure(target: Target | None, use: Action | None) -> bool:
    """Return whether somebody departs by its clearance, or rolls and has none to land."""
    if target is not None and not target.on_ground:
        return False
    is_rolling = target is not None and target.speed_m_s >= ROLLING_M_S
    return use in DEPARTING or (is_rolling and use not in LANDING)


def _next_level_ft(altitude_ft: float, *, up: bool) -> float:
    """Return the first cruising level at least one level above or below an altitude."""
    if up:
        return math.ceil((altitude_ft - 100.0) / LEVEL_FT) * LEVEL_FT + LEVEL_FT
    return math.floor((altitude_ft + 100.0) / LEVEL_FT) * LEVEL_FT - LEVEL_FT
