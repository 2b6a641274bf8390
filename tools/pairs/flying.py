"""Flies encounters before a decision engine, which hears what an ADS-B receiver would."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from airhilt.assistant.decision.engine import DecisionEngine, ReceivedMessage
from airhilt.geodesy.local_frame import LocalFrame
from airhilt.geodesy.wgs84 import offset_m
from airhilt.messages import Severity
from airhilt.surveillance.receivers import Receiver
from airhilt.surveillance.transponders import Transponder
from airhilt.units import DEGREE, FOOT, NAUTICAL_MILE, SECOND_NS
from pairs.geometry import Encounter, Path

FRAME = LocalFrame((38.9 * DEGREE, -77.0 * DEGREE))
HORIZONTAL_M = 5.0 * NAUTICAL_MILE
VERTICAL_M = 1000.0 * FOOT
LEVEL_KEEPING_M = 50.0 * FOOT
"""Distance below 1,000 ft, in m, from which separation counts as lost: two that are told to fly at
levels 1,000 ft apart waver, and their altitudes are reported in steps of 25 ft."""
STEP_NS = SECOND_NS // 2
NACP, NACV = 9, 2
"""Accuracy categories of the transponders: 30 m and 3 m/s."""


class State(NamedTuple):
    """State of an aircraft as its transponder takes it."""

    latitude_rad: float
    longitude_rad: float
    altitude_m: float
    velocity_north_m_s: float
    velocity_east_m_s: float
    velocity_down_m_s: float
    heading_rad: float


@dataclass(frozen=True)
class Outcome:
    """Outcome of an encounter; times in s from its start, None where there was none.

    Attributes
    ----------
    loss_s
        Separation was lost.
    least
        Least distance in units of the minima.
    begun_s
        Begin or end of the last climb or descent before the loss.
    caution_s, warning_s
        First CAUTION and WARNING.
    """

    loss_s: float | None
    least: float
    begun_s: float | None
    caution_s: float | None
    warning_s: float | None


def fly(encounter: Encounter, engine: DecisionEngine, seed: int) -> Outcome:
    """Fly an encounter to its end before an engine; nobody does what the engine recommends."""
    receiver = Receiver("all", _state(Path(0, 0, (0, 0), 0, 1e4, 0, 0, 0, 0), 0.0), 1e6)
    senders = [
        (path, Transponder(f"00000{number}", f"ENC{number}", NACP, NACV,
                           np.random.default_rng((seed, number))))
        for number, path in enumerate((encounter.first, encounter.second), start=1)
    ]  # fmt: skip
    first: dict[Severity, float] = {}
    loss_s, least = None, math.inf
    for step in range(-2, round(encounter.duration_s * SECOND_NS / STEP_NS)):
        t_ns = max(step, 0) * STEP_NS
        time_s = t_ns / SECOND_NS
        horizontal_m, vertical_m = encounter.distances_m(time_s)
        ratio = max(horizontal_m / HORIZONTAL_M, vertical_m / VERTICAL_M)
        least = min(least, ratio)
        is_lost = horizontal_m < HORIZONTAL_M and vertical_m < VERTICAL_M - LEVEL_KEEPING_M
        if loss_s is None and is_lost:
            loss_s = time_s
        for path, sender in senders:
            state = _state(path, time_s)
            if step <= 0:
                receiver.decode(sender, sender.identification(), t_ns)
            receiver.decode(sender, sender.velocity(state), t_ns)
            decoded = receiver.decode(sender, sender.position(state, t_ns), t_ns)
            if decoded is not None:
                engine.receive(ReceivedMessage(decoded.report(t_ns), t_ns, t_ns))
        for alert in engine.decide(t_ns).alerts:
            if alert.active:
                first.setdefault(alert.severity, time_s)
    changes = [
        time_s
        for path in (encounter.first, encounter.second)
        for time_s in (path.begins_s, path.ends_s)
        if path.rate_m_s and 0.0 < time_s < (math.inf if loss_s is None else loss_s)
    ]
    return Outcome(
        loss_s,
        least,
        max(changes, default=None),
        first.get(Severity.CAUTION, first.get(Severity.WARNING)),
        first.get(Severity.WARNING),
    )


def _state(path: Path, time_s: float) -> State:
    """Return the state of a path at a time, with the velocity along the north that is there."""
    before, place, after = (
        FRAME.to_place(*path.place_m(time_s + shift_s)) for shift_s in (-0.5, 0.0, 0.5)
    )
    altitude_m = path.altitude_m(time_s)
    north_m_s, east_m_s = offset_m(before, after, altitude_m)
    return State(
        *place, altitude_m, north_m_s, east_m_s, -path.vertical_rate_m_s(time_s), path.course_rad
    )
