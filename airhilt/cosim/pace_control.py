"""Pause and slow motion, which people at seats ask for."""

from __future__ import annotations

from airhilt.bus.closed import ClosedBus
from airhilt.cosim.context import RunContext
from airhilt.messages import (
    AFTER_STALL_S,
    STALLED,
    Clock,
    LeaveSeat,
    Message,
    Phase,
    SeatAction,
    SetPace,
    TakeSeat,
)
from airhilt.seats import Seats
from airhilt.sensors.radio.conversation import RadioConversation
from airhilt.sim import Pace, Paused, RealTime, Virtual
from airhilt.sim.payload import Payload
from airhilt.units import SECOND_NS, seconds_to_ns

MOST_BEHIND_NS = SECOND_NS
"""Simulation time by which a run with people may be late, in ns, before it is a stall."""


class PaceControl:
    """Changes how fast the time of a run passes, and logs it.

    Once everybody has left the seats, time passes in real time again. A run with people does not
    make up for a stall: time never passes faster for them than the pace says. A run in virtual
    time, such as a replay, logs the change and goes on as fast as before.
    """

    def __init__(
        self, context: RunContext, seats: Seats, radio: RadioConversation, bus: ClosedBus
    ) -> None:
        self._context = context
        self._director = context.director
        self._seats = seats
        self._radio = radio
        self._bus = bus
        self._factor = 1.0
        self._is_awaiting = False
        """True while the run waits for its seats: it has not begun."""
        self._is_at_end = False
        pace = self._director.pace
        self._begun_factor = pace.factor if isinstance(pace, RealTime) else 1.0
        self._lost_ns = 0
        self._lost_until_ns = 0

    def publish_clock(self, phase: Phase = "running") -> None:
        """Publish the time of the run."""
        tell_clock(self._bus, self._director.now_ns, phase, self._director.pace, self._behind_ns)

    @property
    def _behind_ns(self) -> int:
        """Simulation time by which the run is late, or was in a stall a moment ago."""
        lost_ns = self._lost_ns if self._director.now_ns < self._lost_until_ns else 0
        return self._director.behind_ns + lost_ns

    def stall(self, lost_ns: int = 0) -> None:
        """Log that time was lost; a replay does not know how much."""
        now_ns = self._director.now_ns
        self._lost_ns = lost_ns + (self._lost_ns if now_ns < self._lost_until_ns else 0)
        self._lost_until_ns = now_ns + seconds_to_ns(AFTER_STALL_S)
        self._context.event("pace", "run", STALLED)
        self.publish_clock()

    def wait_for_seats(self) -> None:
        """Let the time stand still until all seats are taken, or a person lets it pass."""
        self.set(0.0)
        self._is_awaiting = True

    def stand_still(self) -> None:
        """Let the time stand still for good: the run is at its end."""
        self.set(0.0)
        self._is_at_end = True

    def set(self, factor: float) -> None:
        """Let the time pass at a part of real time; 0 lets it stand still."""
        self._is_awaiting = False
        self._factor = factor
        pace = Paused() if factor == 0.0 else RealTime(factor)
        self._context.event("pace", "run", pace.name)
        if factor == 0.0:
            self._radio.pause()
        self._seats.change_all(pace=pace.name)
        if not isinstance(self._director.pace, Virtual):
            self._director.change_pace(pace)
        self.publish_clock()

    def take(self, key: str, message: Message, data: Payload) -> None:  # noqa: ARG002
        """Take in what a person does at a seat."""
        if not isinstance(message, SeatAction) or self._is_at_end:
            return
        match message.act:
            case SetPace(factor=factor):
                self.set(factor)
            case TakeSeat() if self._is_awaiting:
                if all(state.phase == "taken" for state in self._seats):
                    self.set(self._begun_factor)
            case LeaveSeat() if not self._is_awaiting and self._factor != 1.0:
                if all(state.phase != "taken" for state in self._seats):
                    self.set(1.0)


def tell_clock(bus: ClosedBus, t_ns: int, phase: Phase, pace: Pace, behind_ns: int = 0) -> None:
    """Publish the time of a run."""
    behind_s = round(behind_ns / SECOND_NS, 1)
    clock = Clock(t_ns=t_ns, run=bus.run, phase=phase, pace=pace.name, behind_s=behind_s)
    bus.keep("clock", clock.model_dump_json().encode())
