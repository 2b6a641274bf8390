"""Flies encounters before a decision engine whose advice the crews get, and act on in their way."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Literal, NamedTuple

import numpy as np

from airhilt.assistant.decision.alerts import Alert
from airhilt.assistant.decision.engine import DecisionEngine, ReceivedMessage
from airhilt.assistant.decision.manoeuvres import turn_rate_rad_s
from airhilt.geodesy.wgs84 import offset_m
from airhilt.messages import (
    AdsbReport,
    Climb,
    CockpitInstruments,
    MaintainLevel,
    Message,
    Recommendation,
    TcasReply,
    Turn,
)
from airhilt.scenario.models import Reactions
from airhilt.scenario.models.responses import RESPONSE_MODELS, Channel, ResponseModelName
from airhilt.sensors.tcas import RANGE_JITTER_M
from airhilt.surveillance.receivers import Receiver
from airhilt.surveillance.squitters import ALTITUDE_STEP_FT, quantise
from airhilt.surveillance.tcas_resolution import ACCELERATION_M_S2
from airhilt.surveillance.transponders import Transponder
from airhilt.units import DEGREE, FOOT, FOOT_PER_MINUTE, KNOT, SECOND_NS
from airhilt.world.actors.reactions import FOLLOWED_FROM, ReactionModel
from airhilt.world.truth.conflicts import NMAC
from pairs.flying import FRAME, NACP, NACV, State
from pairs.geometry import Encounter, Path

STEP_S = 0.1
REPORT_STEPS = 5
"""Steps from one report to the next: two a second (RTCA DO-260B)."""
REPLY_STEPS = 10
"""Steps from one interrogation by TCAS to the next: one a second."""
SPOKEN_S = 3.0
"""Time from an alert to the end of the words of its instruction, in s: that of the voice.
The model of ICAO counts from where a resolution advisory is displayed."""

Manner = Literal["follows", "ignores", "opposite"]
"""Manner of a crew: it does as the assistant says, nothing, or what a controller orders against
that."""


@dataclass(frozen=True)
class Flown:
    """Outcome of an encounter.

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
    pending: tuple[float, Recommendation] | None = None
    """Recommendation that is not begun, and its time in s."""

    def __post_init__(self) -> None:
        self.east_m, self.north_m = self.path.place_m(0.0)
        self.altitude_m, self.course_rad = self.path.altitude_m(0.0), self.path.course_rad
        self.rate_m_s = self.path.vertical_rate_m_s(0.0)

    def advance(self, time_s: float) -> None:
        """Fly one step from a time."""
        if self.pending is not None and self.pending[0] <= time_s:
            self._begin(self.pending[1])
            self.pending = None
        if self.level is None:
            self.rate_m_s = self.path.vertical_rate_m_s(time_s)
        else:
            level_m, rate = self.level
            to_go = level_m - self.altitude_m
            slowing = math.sqrt(2.0 * ACCELERATION_M_S2 * abs(to_go))
            wanted = math.copysign(min(rate, slowing), to_go)
            change = ACCELERATION_M_S2 * STEP_S
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

    def instruments(self, t_ns: int) -> CockpitInstruments:
        """Return what its instruments show, as far as it is known of a point."""
        track_deg = self.course_rad / DEGREE % 360.0
        speed_kt = self.path.speed_m_s / KNOT
        return CockpitInstruments(
            t_ns=t_ns, callsign=self.callsign, airspeed_kt=speed_kt, mach=0.7,
            altitude_ft=round(self.altitude_m / FOOT),
            vertical_speed_fpm=round(self.rate_m_s / FOOT_PER_MINUTE),
            north="true", heading_deg=track_deg, track_deg=track_deg, ground_speed_kt=speed_kt,
            pitch_deg=0.0, roll_deg=0.0, gear=0.0, flaps=0.0, on_ground=False, mode="en_route",
            selected_altitude_ft=round(self.altitude_m / FOOT), selected_airspeed_kt=280,
        )  # fmt: skip

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
        least = min(least, max(horizontal / NMAC.horizontal_m, vertical / NMAC.vertical_m))
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
        self._ranges = np.random.default_rng((seed, 0))
        self._has_tcas = TcasReply in engine.reads
        self._sense: dict[str, str] = {}
        self._following: set[tuple[str, str]] = set()
        self.alerts = 0
        self.reversals = 0

    def step(self, number: int, time_s: float) -> None:
        if number % REPORT_STEPS:
            return
        t_ns = round(time_s * SECOND_NS)
        if AdsbReport in self._engine.reads:
            self._report(t_ns, identifies=number <= 2 * REPORT_STEPS)
        if self._has_tcas and number % REPLY_STEPS == 0:
            self._interrogate(t_ns)
        self._take(self._engine.decide(t_ns).alerts, time_s)

    def _report(self, t_ns: int, *, identifies: bool) -> None:
        for aircraft, sender in zip(self._pair, self._senders, strict=True):
            state = aircraft.state()
            if identifies:
                self._receiver.decode(sender, sender.identification(), t_ns)
            self._receiver.decode(sender, sender.velocity(state), t_ns)
            decoded = self._receiver.decode(sender, sender.position(state, t_ns), t_ns)
            if decoded is not None:
                self._receive(decoded.report(t_ns), t_ns)

    def _interrogate(self, t_ns: int) -> None:
        """Let both aircraft interrogate each other by TCAS, as by `airhilt.sensors.tcas`."""
        addresses = [sender.icao24 for sender in self._senders]
        for index, own in enumerate(self._pair):
            other = self._pair[1 - index]
            apart_m = math.hypot(
                own.east_m - other.east_m,
                own.north_m - other.north_m,
                own.altitude_m - other.altitude_m,
            )
            error_m = RANGE_JITTER_M * self._ranges.standard_normal()
            self._receive(own.instruments(t_ns), t_ns)
            reply = TcasReply(
                t_ns=t_ns, callsign=own.callsign, own_icao24=addresses[index], mode="S",
                icao24=addresses[1 - index], range_m=max(apart_m + error_m, 0.0), bearing_deg=0.0,
                altitude_ft=round(quantise(other.altitude_m / FOOT, ALTITUDE_STEP_FT)),
                has_tcas=True,
            )  # fmt: skip
            self._receive(reply, t_ns)

    def _receive(self, message: Message, t_ns: int) -> None:
        self._engine.receive(ReceivedMessage(message, t_ns, t_ns))

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
        is_opposite = manner == "opposite" and isinstance(told, Climb)
        told_by: Channel = "ra" if self._has_tcas else "assistant"
        response = model.respond(
            "controller" if is_opposite else told_by,
            alert.id,
            revision=alert.revision,
            is_repeated=(callsign, alert.id) in self._following,
            is_vertical=isinstance(told, Climb),
        )
        if not response.follows:
            return
        self._following.add((callsign, alert.id))
        if isinstance(told, Climb):
            flown = replace(response, kind="opposite") if is_opposite else response
            told = flown.flown(told, aircraft.altitude_m / FOOT)
        due_s = time_s + response.delay_s + (0.0 if told_by == "ra" else SPOKEN_S)
        earlier_s = -math.inf if aircraft.pending is None else aircraft.pending[0]
        aircraft.pending = max(due_s, earlier_s), told
