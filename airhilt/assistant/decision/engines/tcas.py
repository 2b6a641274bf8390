"""The baseline aboard: TCAS II, which tells a crew of traffic and how to avoid it."""

from __future__ import annotations

from airhilt.assistant.decision.alerts import Alert
from airhilt.assistant.decision.engine import Decision, ReceivedMessage
from airhilt.assistant.decision.tcas_unit import Senses, TcasUnit
from airhilt.engines import Engine
from airhilt.errors import WorkerError
from airhilt.messages import CockpitInstruments, Message, TcasReply

MISS_DISTANCE_FILTER = "hmd"
"""Argument that asks for the horizontal miss distance filter."""


class TcasEngine:
    """TCAS II of each aircraft that interrogates others; equipped aircraft coordinate."""

    name = "tcas"
    reads: tuple[type[Message], ...] = (CockpitInstruments, TcasReply)

    def __init__(self, *, filters_misses: bool = False) -> None:
        self._filters_misses = filters_misses
        self._senses: Senses = {}
        self._units: dict[str, TcasUnit] = {}
        self._instruments: dict[str, CockpitInstruments] = {}

    def receive(self, received: ReceivedMessage) -> None:
        """Give a reply or instruments to the unit of their aircraft."""
        match received.message:
            case CockpitInstruments(callsign=callsign) as instruments:
                self._instruments[callsign] = instruments
                if callsign in self._units:
                    self._units[callsign].take_instruments(instruments)
            case TcasReply() as reply:
                self._unit(reply).take_reply(reply)

    def decide(self, t_ns: int) -> Decision:
        """Let all units look at their intruders, the lowest address first."""
        alerts: list[Alert] = []
        units = sorted(self._units.values(), key=lambda unit: unit.icao24)
        for unit in units:
            alerts += unit.judge(t_ns)
        due = [unit.due_ns for unit in units if unit.due_ns is not None]
        return Decision(alerts, again_ns=min(due, default=None))

    def _unit(self, reply: TcasReply) -> TcasUnit:
        unit = self._units.get(reply.callsign)
        if unit is None:
            unit = self._units[reply.callsign] = TcasUnit(
                reply.callsign,
                reply.own_icao24,
                self._senses,
                filters_misses=self._filters_misses,
            )
            if reply.callsign in self._instruments:
                unit.take_instruments(self._instruments[reply.callsign])
        return unit


def _create(argument: str) -> TcasEngine:
    if argument not in ("", MISS_DISTANCE_FILTER):
        raise WorkerError(
            f"assistant 'tcas:{argument}': expected tcas or tcas:{MISS_DISTANCE_FILTER}"
        )
    return TcasEngine(filters_misses=argument == MISS_DISTANCE_FILTER)


ENGINE = Engine(
    name="tcas",
    summary="TCAS II, which tells the crews that carry it; with hmd: horizontal miss filter",
    create=_create,
    argument=MISS_DISTANCE_FILTER,
)
