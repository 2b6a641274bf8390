"""The negative control that warns everybody of everything, whatever happens."""

from __future__ import annotations

from collections.abc import Mapping

from airhilt.assistant.decision.alerts import Alert
from airhilt.assistant.decision.engine import Decision, ReceivedMessage
from airhilt.assistant.decision.resolution import TURN_DEG
from airhilt.engines import Engine
from airhilt.errors import AirhiltError
from airhilt.messages import (
    CONTROLLER,
    Briefing,
    Evidence,
    GoAround,
    HoldPosition,
    Message,
    Recommendation,
    Severity,
    Transcript,
    Turn,
)
from airhilt.units import seconds_to_ns


class CryWolfEngine:
    """Knows nothing, and tells the whole roster once that it is in conflict, and what to do.

    At an airport everybody is to go around, and to hold position; elsewhere everybody turns. It
    rests on the last call that was heard, whatever that said.

    Parameters
    ----------
    delay_s
        Time from the begin of the run to the warning, in s.
    """

    name = "cry_wolf"
    reads: tuple[type[Message], ...] = (Briefing, Transcript)

    def __init__(self, delay_s: float = 0.0) -> None:
        self._due_ns = seconds_to_ns(delay_s)
        self._briefing: Briefing | None = None
        self._heard: tuple[str, ...] = ()
        self._is_told = False

    def receive(self, received: ReceivedMessage) -> None:
        """Take in who is there, and the last call."""
        match received.message:
            case Briefing() as briefing:
                self._briefing = briefing
            case Transcript(id=name):
                self._heard = (name,)

    def decide(self, t_ns: int) -> Decision:
        """Return the warnings, once."""
        briefing = self._briefing
        if briefing is None or self._is_told:
            return Decision()
        if t_ns < self._due_ns:
            return Decision(again_ns=self._due_ns)
        self._is_told = True
        return Decision([self._warning(briefing, *each) for each in _orders(briefing).items()])

    def _warning(self, briefing: Briefing, name: str, told: Recommendation) -> Alert:
        everybody = tuple(entry.callsign for entry in briefing.roster)
        is_airport = not isinstance(told, Turn)
        return Alert(
            id=name,
            revision=0,
            kind="runway_conflict" if is_airport else "loss_of_separation",
            severity=Severity.WARNING,
            recipients=(*everybody, CONTROLLER),
            traffic=everybody,
            evidence=Evidence(
                sources=("radio",),
                runway=getattr(told, "runway", None),
                note="everybody is in conflict",
                radio_ids=self._heard,
            ),
            recommendations=dict.fromkeys(everybody, told),
        )


def _orders(briefing: Briefing) -> Mapping[str, Recommendation]:
    """Return what everybody is told, by the names of the alerts."""
    airport = briefing.airport
    if airport is None or not airport.runways:
        return {"turn": Turn(degrees=TURN_DEG)}
    runway = airport.runways[0].ident
    return {"go-around": GoAround(runway=runway), "hold": HoldPosition(runway=runway)}


def _engine(argument: str) -> CryWolfEngine:
    """Return the engine; the argument is its delay in s.

    Raises
    ------
    AirhiltError
        It is no time from 0 to 3,600 s.
    """
    try:
        delay_s = float(argument or 0.0)
    except ValueError:
        delay_s = -1.0
    if not 0.0 <= delay_s <= 3600.0:
        raise AirhiltError(
            f"assistant 'cry_wolf:{argument}': expected a delay in s from 0 to 3600, as cry_wolf:5"
        )
    return CryWolfEngine(delay_s)


ENGINE = Engine(
    name="cry_wolf",
    summary="warns everybody of everything at once, as a negative control",
    create=_engine,
    argument="SECONDS",
)
