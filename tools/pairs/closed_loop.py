"""Flies encounters before a decision engine whose advice the crews get, and act on in their way."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Literal, NamedTuple

import numpy as np

from airhilt.assistant.decision.alerts import Alert
from airhilt.assistant.decision.engine import DecisionEngine, ReceivedMessage
from airhilt.assistant.decision.manoeuvres import turn_rate_rad_s
from airhilt.geodesy.wgs84 import offset_m
from airhilt.messages import Climb, MaintainLevel, Recommendation, Turn
from airhilt.scenario.models import Reactions
from airhilt.scenario.models.responses import RESPONSE_MODELS, ResponseModelName
from airhilt.surveillance.receivers import Receiver
from airhilt.surveillance.transponders import Transponder
from airhilt.units import DEGREE, FOOT, FOOT_PER_MINUTE, SECOND_NS, STANDARD_GRAVITY
from airhilt.world.actors.reactions import FOLLOWED_FROM, ReactionModel
from pairs.flying import FRAME, NACP, NACV, State
from pairs.geometry import Encounter, Path

STEP_S = 0.1
REPORT_STEPS = 5
"""Steps from one report to the next: two a second (RTCA DO-260B)."""
VERTICAL_M_S2 = 0.25 * STANDARD_GRAVITY
"""Vertical acceleration of the standard pilot of TCAS II (ICAO Annex 10, volume IV, 4.4.2.6)."""
SPOKEN_S = 3.0
"""Time from an alert to the end of the words of its instruction, in s: that of the voice."""
NMAC_M, NMAC_VERTICAL_M = 500.0 * FOOT, 100.0 * FOOT
"""Near mid-air collision (RTCA DO-185B)."""

Manner = Literal["follows", "ignores", "opposite"]
"""What a crew does: what the assistant says, nothing, or what a controller orders against it."""


@dataclass(frozen=True)
class Flown:
    """What became of an encounter.

    Attributes
    ----------
    is_nmac
        The two came within the distances of a near mid-air collision.
    least
        Least separation in units of these distances.
    alerts
        Number of alerts, with those that say again.
    reversals
        Number of alerts in which an aircraft is told to climb after a descent, or the other way.
    """

    is_nmac: bool
    least: float
    alerts: int = 0
    reversals: int = 0


@dataclass
class _Aircraft:
    """A point that flies its path until it does something else."""

    path: Path
    callsign: str
    east_m: float = 0.0
    north_m: float = 0.0
    altitude_m: float = 0.0
    course_rad: float = 0.0
    rate_m_s: float = 0.0
    level: tuple[float, float] | None = None
    """Level to fly to, and the rate; None: as its path."""
    turns_to_rad: float | None = None
    _pending: list[tuple[float, Recommendation]] = field(default_factory=list)

    def __post_init__(self) -> None:
        self.east_m, self.north_m = self.path.place_m(0.0)
        self.altitude_m, self.course_rad = self.path.altitude_m(0.0), self.path.course_rad
        self.rate_m_s = self.path.vertical_rate_m_s(0.0)

    def told(self, due_s: float, recommendation: Recommendation) -> None:
        """Do what is recommended at a time, in place of what was not begun."""
        self._pending = [(due_s, recommendation)]

    @property
    def due_s(self) -> float | None:
        """Time of what is not begun."""
        return self._pending[0][0] if self._pending else None

    def advance(self, time_s: float) -> None:
        """Fly one step from a time."""
        if self._pending and self._pending[0][0] <= time_s:
            self._begin(self._pending.pop()[1])
        if self.level is None:
            wanted = self.path.vertical_rate_m_s(time_s)
            self.rate_m_s = wanted
        else:
            level_m, rate = self.level
            to_go = level_m - self.altitude_m
            slowing = math.sqrt(2.0 * VERTICAL_M_S2 * abs(to_go))
            wanted = math.copysign(min(rate, slowing), to_go)
            change = VERTICAL_M_S2 * STEP_S
            self.rate_m_s += min(max(wanted - self.rate_m_s, -change), change)
        self.altitude_m += self.rate_m_s * STEP_S
        speed = self.path.speed_m_s
        if self.turns_to_rad is not None:
            left = math.remainder(self.turns_to_rad - self.course_rad, math.tau)
            most = turn_rate_rad_s(speed) * STEP_S
            self.course_rad += min(max(left, -most), most)
        self.east_m += speed * math.sin(self.course_rad) * STEP_S
        self.north_m += speed * math.cos(self.course_rad) * STEP_S

    def _begin(self, recommendation: Recommendation) -> None:
        match recommendation:
            case Climb(altitude_ft=altitude_ft, vertical_rate_fpm=rate_fpm, turn_deg=degrees):
                self.level = altitude_ft * FOOT, rate_fpm * FOOT_PER_MINUTE
                if degrees:
                    self.turns_to_rad = self.course_rad + degrees * DEGREE
            case MaintainLevel(altitude_ft=altitude_ft):
                rate = max(abs(self.rate_m_s), 300.0 * FOOT_PER_MINUTE)
                self.level = altitude_ft * FOOT, rate
            case Turn(degrees=degrees):
                self.turns_to_rad = self.course_rad + degrees * DEGREE

    def state(self) -> State:
        """Return its state as its transponder takes it."""
        place = FRAME.to_place(self.east_m, self.north_m)
        ahead = FRAME.to_place(
            self.east_m + 0.5 * self.path.speed_m_s * math.sin(self.course_rad),
            self.north_m + 0.5 * self.path.speed_m_s * math.cos(self.course_rad),
        )
        north, east = offset_m(place, ahead, self.altitude_m)
        return State(
            *place, self.altitude_m, 2.0 * north, 2.0 * east, -self.rate_m_s, self.course_rad
        )


class Crews(NamedTuple):
    """How the two crews act."""

    model: ResponseModelName
    manners: tuple[Manner, Manner]


def fly_on(encounter: Encounter) -> Flown:
    """Return what becomes of an encounter that nobody is told of."""
    return _flown(_pair(encounter), encounter.duration_s, lambda _step, _time_s: None)


def fly(encounter: Encounter, engine: DecisionEngine, crews: Crews, seed: int) -> Flown:
    """Return what becomes of an encounter whose crews are told what an engine recommends."""
    pair = _pair(encounter)
    loop = _Loop(engine, pair, crews, seed)
    flown = _flown(pair, encounter.duration_s, loop.step)
    return Flown(flown.is_nmac, flown.least, loop.alerts, loop.reversals)


def _pair(encounter: Encounter) -> tuple[_Aircraft, _Aircraft]:
    return _Aircraft(encounter.first, "ENC1"), _Aircraft(encounter.second, "ENC2")


def _flown(
    pair: tuple[_Aircraft, _Aircraft], duration_s: float, step: Callable[[int, float], None]
) -> Flown:
    least = math.inf
    for number in range(round(duration_s / STEP_S)):
        time_s = number * STEP_S
        step(number, time_s)
        first, second = pair
        horizontal = math.hypot(first.east_m - second.east_m, first.north_m - second.north_m)
        vertical = abs(first.altitude_m - second.altitude_m)
        least = min(least, max(horizontal / NMAC_M, vertical / NMAC_VERTICAL_M))
        for aircraft in pair:
            aircraft.advance(time_s)
    return Flown(least < 1.0, least)


class _Loop:
    """Reports to an engine, and its alerts to the crews."""

    def __init__(
        self,
        engine: DecisionEngine,
        pair: tuple[_Aircraft, _Aircraft],
        crews: Crews,
        seed: int,
    ) -> None:
        self._engine = engine
        self._pair = pair
        channels = RESPONSE_MODELS[crews.model].crews
        self._crews: Mapping[str, tuple[_Aircraft, Manner, ReactionModel]] = {
            each.callsign: (
                each,
                manner,
                ReactionModel(each.callsign, channels, Reactions(), seed),
            )
            for each, manner in zip(pair, crews.manners, strict=True)
        }
        start = _Aircraft(Path(0, 0, (0, 0), 0, 1e4, 0, 0, 0, 0), "RCV")
        self._receiver = Receiver("all", start.state(), 1e6)
        self._senders = [
            Transponder(
                f"00000{number}",
                each.callsign,
                NACP,
                NACV,
                np.random.default_rng((seed, number)),
            )
            for number, each in enumerate(pair, start=1)
        ]
        self._sense: dict[str, str] = {}
        self._following: set[tuple[str, str]] = set()
        self.alerts = 0
        self.reversals = 0

    def step(self, number: int, time_s: float) -> None:
        if number % REPORT_STEPS:
            return
        t_ns = round(time_s * SECOND_NS)
        for aircraft, sender in zip(self._pair, self._senders, strict=True):
            state = aircraft.state()
            if number <= 2 * REPORT_STEPS:
                self._receiver.decode(sender, sender.identification(), t_ns)
            self._receiver.decode(sender, sender.velocity(state), t_ns)
            decoded = self._receiver.decode(sender, sender.position(state, t_ns), t_ns)
            if decoded is not None:
                self._engine.receive(ReceivedMessage(decoded.report(t_ns), t_ns, t_ns))
        self._take(self._engine.decide(t_ns).alerts, time_s)

    def _take(self, alerts: Sequence[Alert], time_s: float) -> None:
        for alert in alerts:
            if not alert.active:
                continue
            self.alerts += 1
            for callsign, told in alert.recommendations.items():
                if callsign in self._crews and alert.severity.rank >= FOLLOWED_FROM.rank:
                    self._tell(callsign, alert, told, time_s)

    def _tell(self, callsign: str, alert: Alert, told: Recommendation, time_s: float) -> None:
        if isinstance(told, Climb):
            if self._sense.get(callsign, told.sense) != told.sense:
                self.reversals += 1
            self._sense[callsign] = told.sense
        aircraft, manner, model = self._crews[callsign]
        if manner == "ignores":
            return
        response = model.respond(
            "assistant",
            alert.id,
            revision=alert.revision,
            is_repeated=(callsign, alert.id) in self._following,
            is_vertical=isinstance(told, Climb),
        )
        if not response.follows:
            return
        self._following.add((callsign, alert.id))
        if isinstance(told, Climb):
            told = response.flown(told, aircraft.altitude_m / FOOT)
            if manner == "opposite":
                told = _against(told, aircraft.altitude_m / FOOT)
        due_s = time_s + SPOKEN_S + response.delay_s
        aircraft.told(due_s if aircraft.due_s is None else max(due_s, aircraft.due_s), told)


def _against(told: Climb, altitude_ft: float) -> Climb:
    """Return the climb or descent that a controller orders against one that is recommended."""
    away_ft = altitude_ft - (told.altitude_ft - altitude_ft)
    sense = "descend" if told.sense == "climb" else "climb"
    return told.model_copy(update={"sense": sense, "altitude_ft": away_ft})
