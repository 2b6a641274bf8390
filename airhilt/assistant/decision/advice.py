"""Advice in force: what two crews in conflict were told, and what they do of it."""

from __future__ import annotations

import math
from typing import Literal, NamedTuple

from airhilt.assistant.decision.manoeuvres import (
    CHANGED_RESPONSE_S,
    NONE,
    RESPONSE_S,
    Manoeuvre,
    turn_rate_rad_s,
)
from airhilt.assistant.decision.tracks import LEVEL_BELOW_M_S, LEVEL_WITHIN_M, Track
from airhilt.messages import Climb, Recommendation
from airhilt.surveillance.tcas_resolution import Sense
from airhilt.units import DEGREE, SECOND_NS

SEEN_S = 4.0
"""Time from the begin of a climb, a descent or a turn until it shows in reports, in s: 3 s to reach
1,500 ft/min with 0.25 g (ICAO Annex 10, volume IV, 4.4.2.6), and the filter of the track."""
SEEN_TURN_RAD = 5.0 * DEGREE
"""Change of the course that shows a turn; assumed."""

Adherence = Literal["pending", "follows", "departs"]
"""Has time to respond yet, does as told, or does not."""


class Advice(NamedTuple):
    """Advice that one crew was told, and how the crew flew then."""

    recommendation: Recommendation | None
    manoeuvre: Manoeuvre
    told_ns: int
    course_rad: float
    vertical_rate_m_s: float
    is_changed: bool
    """True if it replaces other advice, so that the response takes less time."""
    sense: Sense | None
    """Sense of the last climb or descent that the crew was told; None before the first."""

    @classmethod
    def of(
        cls,
        recommendation: Recommendation | None,
        manoeuvre: Manoeuvre,
        track: Track,
        before: Advice | None,
    ) -> Advice:
        """Return advice to a crew that flies as its track says; the same as before stays."""
        if before is not None and before.recommendation == recommendation:
            return before
        is_changed = before is not None and before.recommendation is not None
        sense = None if before is None else before.sense
        return cls(
            recommendation,
            manoeuvre,
            track.t_ns,
            _course_rad(track),
            track.vertical_rate_m_s,
            is_changed,
            recommendation.sense if isinstance(recommendation, Climb) else sense,
        )

    @property
    def _response_s(self) -> float:
        return CHANGED_RESPONSE_S if self.is_changed else RESPONSE_S

    def adherence(self, track: Track) -> Adherence:
        """Return whether a crew does as told; who was told nothing, flies on as it does."""
        if self.manoeuvre == NONE or (self._climbs(track) and self._turns(track)):
            return "follows"
        if self._moves_away(track) or self._elapsed_s(track) > self._response_s + SEEN_S:
            return "departs"
        return "pending"

    def left(self, track: Track) -> Manoeuvre:
        """Return what is left of the manoeuvre."""
        return self.manoeuvre._replace(turn_rad=self.manoeuvre.turn_rad - self._turned_rad(track))

    def expected(self, track: Track) -> tuple[Manoeuvre, float]:
        """Return the manoeuvre that is to be expected of a crew, and the time to its begin in s.

        Nothing is expected of a crew that departs from what it was told.
        """
        adherence = self.adherence(track)
        if adherence == "departs":
            return NONE, 0.0
        if adherence == "follows":
            return self.left(track), 0.0
        return self.manoeuvre, max(self._response_s - self._elapsed_s(track), 0.0)

    def _elapsed_s(self, track: Track) -> float:
        return (track.t_ns - self.told_ns) / SECOND_NS

    def _to_go_m(self, track: Track) -> float:
        target_m = self.manoeuvre.target_m
        return 0.0 if target_m is None else target_m - track.altitude_m

    def _climbs(self, track: Track) -> bool:
        """Return whether an aircraft is at the level, or moves to it."""
        to_go_m = self._to_go_m(track)
        rate = track.vertical_rate_m_s
        moves = to_go_m * rate > 0.0 and abs(rate) >= LEVEL_BELOW_M_S
        return moves or abs(to_go_m) <= LEVEL_WITHIN_M

    def _turns(self, track: Track) -> bool:
        """Return whether an aircraft has turned as far as its bank allows since it began."""
        turn = self.manoeuvre.turn_rad
        if turn == 0.0:
            return True
        speed_m_s = math.hypot(track.velocity_north_m_s, track.velocity_east_m_s)
        flown_s = max(self._elapsed_s(track) - self._response_s - SEEN_S, 0.0)
        expected = min(abs(turn), turn_rate_rad_s(speed_m_s) * flown_s)
        least = max(0.5 * expected, SEEN_TURN_RAD)
        return self._turned_rad(track) * math.copysign(1.0, turn) >= least

    def _turned_rad(self, track: Track) -> float:
        if self.manoeuvre.turn_rad == 0.0:
            return 0.0
        return math.remainder(_course_rad(track) - self.course_rad, math.tau)

    def _moves_away(self, track: Track) -> bool:
        """Return whether an aircraft began to move away from its level after it was told."""
        change = track.vertical_rate_m_s - self.vertical_rate_m_s
        to_go_m = self._to_go_m(track)
        away = to_go_m * track.vertical_rate_m_s < 0.0 and abs(to_go_m) > LEVEL_WITHIN_M
        return away and to_go_m * change < 0.0 and abs(change) >= LEVEL_BELOW_M_S


def _course_rad(track: Track) -> float:
    return math.atan2(track.velocity_east_m_s, track.velocity_north_m_s)
