"""Two aircraft over flat ground, and what their TCAS II gets of each other."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field
from functools import partial

import numpy as np

from airhilt.assistant.decision.alerts import Alert
from airhilt.assistant.decision.engine import DecisionEngine, ReceivedMessage
from airhilt.messages import (
    Climb,
    CockpitInstruments,
    MaintainLevel,
    Message,
    TcasReply,
    TransponderMode,
)
from airhilt.units import FOOT, KNOT, NAUTICAL_MILE, SECOND_NS

STEP_NS = SECOND_NS // 5
RADIO_ALTIMETER_FT = 2500.0


@dataclass
class Jet:
    """An aircraft on a straight track that passes ``offset_nm`` to the right of the middle.

    It is abeam the middle at time 0, and times before are negative.
    """

    callsign: str
    icao24: str
    track_deg: float
    speed_kt: float
    altitude_ft: float
    rate_fpm: float = 0.0
    offset_nm: float = 0.0
    has_tcas: bool = True
    mode: TransponderMode = "S"
    on_ground: bool = False
    silent_s: tuple[float, float] = (math.inf, math.inf)
    """From when to when it does not reply."""
    target_ft: float | None = None
    ordered: tuple[float, float, float] | None = None
    """Time at which it begins what a controller orders, the level in ft, and the rate in ft/min."""
    phase_ns: int = 0
    """Time in each second at which it interrogates."""

    def place_m(self, time_s: float) -> tuple[float, float]:
        angle = math.radians(self.track_deg)
        along, right = self.speed_kt * KNOT * time_s, self.offset_nm * NAUTICAL_MILE
        return (
            along * math.sin(angle) + right * math.cos(angle),
            along * math.cos(angle) - right * math.sin(angle),
        )

    def climb(self, target_ft: float, rate_fpm: float) -> None:
        self.target_ft = target_ft
        self.rate_fpm = math.copysign(rate_fpm, target_ft - self.altitude_ft)

    def advance(self, step_s: float) -> None:
        self.altitude_ft += self.rate_fpm / 60.0 * step_s
        if self.target_ft is not None and (self.target_ft - self.altitude_ft) * self.rate_fpm <= 0:
            self.altitude_ft, self.rate_fpm, self.target_ft = self.target_ft, 0.0, None


@dataclass
class Meeting:
    """Flies two aircraft from ``begin_s`` to ``end_s`` before an engine; both meet at time 0."""

    engine: DecisionEngine
    jets: tuple[Jet, ...]
    begin_s: float = -130.0
    end_s: float = 30.0
    ground_ft: float = 0.0
    noise_m: float = 0.0
    seed: int = 0
    obeys: Callable[[str], bool] = lambda _: False
    respond_s: float = 5.0
    told: list[tuple[float, Alert]] = field(default_factory=list)
    least_m: float = math.inf
    least_ft: float = math.inf
    """Least vertical distance of the first two within 500 ft horizontally."""
    _orders: list[tuple[float, Callable[[], None]]] = field(default_factory=list)

    def fly(self) -> Meeting:
        draws = np.random.default_rng(self.seed)
        for jet in self.jets:
            if jet.ordered is not None:
                begins_s, level_ft, rate_fpm = jet.ordered
                self._orders.append((begins_s, partial(jet.climb, level_ft, rate_fpm)))
        for step in range(round((self.end_s - self.begin_s) * SECOND_NS / STEP_NS)):
            t_ns = step * STEP_NS
            time_s = self.begin_s + t_ns / SECOND_NS
            for due_s, act in [order for order in self._orders if order[0] <= time_s]:
                act()
                self._orders.remove((due_s, act))
            for own in self.jets:
                self._give(self._instruments(own, t_ns), t_ns)
                if own.has_tcas and t_ns % SECOND_NS == own.phase_ns and not own.on_ground:
                    for other in self.jets:
                        if other is not own:
                            self._interrogate(own, other, t_ns, draws)
            for alert in self.engine.decide(t_ns).alerts:
                self.told.append((-time_s, alert))
                self._follow(alert, time_s)
            for jet in self.jets:
                jet.advance(STEP_NS / SECOND_NS)
            self._measure(time_s)
        return self

    def _give(self, message: Message, t_ns: int) -> None:
        self.engine.receive(ReceivedMessage(message, t_ns, t_ns))

    def _instruments(self, own: Jet, t_ns: int) -> CockpitInstruments:
        height_ft = own.altitude_ft - self.ground_ft
        return CockpitInstruments(
            t_ns=t_ns, callsign=own.callsign, airspeed_kt=250.0, mach=0.7,
            altitude_ft=round(own.altitude_ft), vertical_speed_fpm=round(own.rate_fpm),
            north="true", heading_deg=own.track_deg, track_deg=own.track_deg,
            ground_speed_kt=own.speed_kt, pitch_deg=0.0, roll_deg=0.0, gear=0.0, flaps=0.0,
            on_ground=own.on_ground, mode="en_route", selected_altitude_ft=35_000,
            selected_airspeed_kt=280,
            radio_height_ft=round(height_ft) if height_ft <= RADIO_ALTIMETER_FT else None,
        )  # fmt: skip

    def _interrogate(self, own: Jet, other: Jet, t_ns: int, draws: np.random.Generator) -> None:
        time_s = self.begin_s + t_ns / SECOND_NS
        error_m = self.noise_m * draws.standard_normal()
        if other.silent_s[0] <= time_s < other.silent_s[1]:
            return
        gap_m = (own.altitude_ft - other.altitude_ft) * FOOT
        range_m = math.hypot(*np.subtract(own.place_m(time_s), other.place_m(time_s)), gap_m)
        step_ft = 25 if other.mode == "S" else 100
        reply = TcasReply(
            t_ns=t_ns, callsign=own.callsign, own_icao24=own.icao24, mode=other.mode,
            icao24=other.icao24 if other.mode == "S" else None,
            range_m=max(range_m + error_m, 0.0), bearing_deg=0.0,
            altitude_ft=step_ft * round(other.altitude_ft / step_ft),
            on_ground=other.on_ground, has_tcas=other.has_tcas,
        )  # fmt: skip
        self._give(reply, t_ns)

    def _follow(self, alert: Alert, time_s: float) -> None:
        for jet in self.jets:
            recommendation = alert.recommendations.get(jet.callsign)
            if recommendation is None or not self.obeys(jet.callsign):
                continue
            match recommendation:
                case Climb(altitude_ft=level, vertical_rate_fpm=rate):
                    order = partial(jet.climb, level, rate)
                case MaintainLevel(altitude_ft=level):
                    order = partial(jet.climb, level, 1500.0)
                case _:
                    continue
            self._orders.append((time_s + self.respond_s, order))

    def _measure(self, time_s: float) -> None:
        one, other = self.jets[:2]
        apart_m = math.hypot(*np.subtract(one.place_m(time_s), other.place_m(time_s)))
        self.least_m = min(self.least_m, apart_m)
        if apart_m < 500 * FOOT:
            self.least_ft = min(self.least_ft, abs(one.altitude_ft - other.altitude_ft))

    def to(self, callsign: str) -> list[Alert]:
        """Return what one crew was told."""
        return [alert for _, alert in self.told if callsign in alert.recipients]

    def first_s(self, severity: str) -> float | None:
        """Return how long before the meeting the first alert of a severity came."""
        return next((s for s, alert in self.told if str(alert.severity) == severity), None)

    def notes(self, callsign: str) -> list[str]:
        """Return the announcements in one cockpit."""
        return [alert.evidence.note for alert in self.to(callsign)]
