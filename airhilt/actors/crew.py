"""The crew of an aircraft: carries out commands, and reacts to advisories after a while."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial

from airhilt.commands import (
    AltitudeCommand,
    Command,
    ResumeRouteCommand,
    SpeedCommand,
    TrackCommand,
    TurnCommand,
)
from airhilt.flight.aircraft import Aircraft
from airhilt.messages import Advisory, Climb, MaintainLevel, Recommendation, Severity, Turn
from airhilt.sim.streams import stream
from airhilt.units import DEGREE, FOOT, FOOT_PER_MINUTE, KNOT

FOLLOWED_FROM = Severity.CAUTION
"""Least severity that a crew acts on."""
REPEAT_FACTOR = 0.5
"""Reaction time to a changed advisory, against the first one: the standard pilot model
of ICAO Annex 10, volume IV, has 2.5 s after 5 s."""


@dataclass(frozen=True, slots=True)
class Reaction:
    """What the crew will do, and after how long."""

    delay_s: float
    act: Callable[[], bool]
    """Does it; tells whether there still was anything to do."""
    text: str


@dataclass(frozen=True, slots=True)
class ReactionTime:
    """A lognormal reaction time, and how probable it is that the crew follows at all."""

    median_s: float
    sigma: float
    compliance: float


class Crew:
    """Flies as told, unless an advisory that it follows says otherwise.

    A command that comes while an advisory is followed is remembered and flown once the conflict
    is over.
    """

    def __init__(
        self, callsign: str, aircraft: Aircraft, reaction: ReactionTime, seed: int
    ) -> None:
        self.callsign = callsign
        self.aircraft = aircraft
        self._reaction = reaction
        self._seed = seed
        self._return_lateral: Callable[[], None] = partial(
            aircraft.hold_track, aircraft.state.track_rad
        )
        self._altitude_before_m = aircraft.target_altitude_m
        self._followed: dict[str, int] = {}
        self._over: set[str] = set()
        self._deferred: list[Command] = []
        self._has_turned = False
        self._has_route = False

    def fly_route(self, waypoints: list[tuple[float, float]]) -> None:
        """Take a route (latitude, longitude in radians) and fly it."""
        self.aircraft.fly_route(waypoints)
        self._return_lateral = self.aircraft.resume_route
        self._has_route = True

    def command(self, command: Command) -> None:
        """Carry a command out, now or after the advisory in hand."""
        if self._followed:
            self._deferred.append(command)
        else:
            self._carry_out(command)

    def _carry_out(self, command: Command) -> None:
        match command:
            case AltitudeCommand(altitude_ft=altitude, vertical_rate_fpm=rate):
                self.aircraft.hold_altitude(
                    altitude * FOOT, None if rate is None else rate * FOOT_PER_MINUTE
                )
            case TrackCommand(track_deg=track):
                self.aircraft.hold_track(track * DEGREE)
                self._return_lateral = partial(self.aircraft.hold_track, track * DEGREE)
            case TurnCommand(degrees=degrees):
                track = self.aircraft.state.track_rad + degrees * DEGREE
                self.aircraft.turn_by(degrees * DEGREE)
                self._return_lateral = partial(self.aircraft.hold_track, track)
            case SpeedCommand(cas_kt=speed):
                self.aircraft.hold_speed(speed * KNOT)
            case ResumeRouteCommand() if self._has_route:
                self.aircraft.resume_route()
                self._return_lateral = self.aircraft.resume_route

    def hear(self, advisory: Advisory) -> Reaction | None:
        """Return how the crew will react to an advisory, None if it will not."""
        if not advisory.active:
            self._over.add(advisory.id)
            if advisory.id not in self._followed:
                return None
            return Reaction(self._delay_s(advisory), lambda: self._resume(advisory.id), "resumes")
        self._over.discard(advisory.id)
        recommendation = advisory.recommendation
        if recommendation is None or advisory.severity.rank < FOLLOWED_FROM.rank:
            return None
        if not self._complies(advisory.id):
            return None
        return Reaction(
            self._delay_s(advisory),
            lambda: self._follow(advisory, recommendation),
            f"follows {recommendation.action}",
        )

    def _complies(self, advisory_id: str) -> bool:
        draw = stream(self._seed, f"compliance/{self.callsign}/{advisory_id}").random()
        return bool(draw < self._reaction.compliance)

    def _delay_s(self, advisory: Advisory) -> float:
        name = f"reaction/{self.callsign}/{advisory.id}"
        draw = stream(self._seed, name, advisory.revision).standard_normal()
        first = self._reaction.median_s * math.exp(self._reaction.sigma * draw)
        return first * (REPEAT_FACTOR if advisory.id in self._followed else 1.0)

    def _follow(self, advisory: Advisory, recommendation: Recommendation) -> bool:
        if advisory.id in self._over or self._followed.get(advisory.id, -1) > advisory.revision:
            return False
        if not self._followed:
            self._altitude_before_m = self.aircraft.target_altitude_m
        self._followed[advisory.id] = advisory.revision
        match recommendation:
            case Climb(altitude_ft=altitude, vertical_rate_fpm=rate):
                self.aircraft.hold_altitude(altitude * FOOT, rate * FOOT_PER_MINUTE)
            case MaintainLevel(altitude_ft=altitude):
                self.aircraft.hold_altitude(altitude * FOOT)
            case Turn(degrees=degrees):
                self._has_turned = True
                self.aircraft.turn_by(degrees * DEGREE)
        return True

    def _resume(self, advisory_id: str) -> bool:
        """Go back to what was flown before, unless another advisory still holds."""
        if self._followed.pop(advisory_id, None) is None or self._followed:
            return False
        self.aircraft.hold_altitude(self._altitude_before_m)
        if self._has_turned:
            self._has_turned = False
            self._return_lateral()
        deferred, self._deferred = self._deferred, []
        for command in deferred:
            self._carry_out(command)
        return True
