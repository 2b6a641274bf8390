"""Questions about workload: ISA while the run goes on, NASA-TLX when it has come to its end."""

from __future__ import annotations

import threading
from collections import Counter
from functools import partial
from typing import Literal

from airhilt.cosim.context import RunContext
from airhilt.cosim.pace_control import PaceControl
from airhilt.messages import (
    RUN,
    UNREGISTERED,
    AnswerQuestion,
    Message,
    SeatAction,
    WorkloadQuestion,
    key_chunk,
)
from airhilt.seats import Seats
from airhilt.sim import Priority, Virtual
from airhilt.sim.payload import Payload
from airhilt.units import seconds_to_ns

PATIENCE_S = 600.0
"""Wall time for which the end of a run waits for ratings, in s: an assumption."""


class WorkloadQuestions:
    """Asks the people at seats, and ends the run once they have answered.

    A person who leaves the seat is not waited for. Who does not answer in time is logged as having
    given no answer, so that a replay ends at the same time.
    """

    def __init__(self, context: RunContext, seats: Seats, pace: PaceControl) -> None:
        options = context.setup.options
        self._context = context
        self._director = context.director
        self._seats = seats
        self._pace = pace
        self._has_tlx = options.nasa_tlx
        self._is_closing = False
        self._asked: Counter[str] = Counter()
        self._patience: threading.Timer | None = None
        if options.isa_minutes is not None:
            period_ns = seconds_to_ns(60.0 * options.isa_minutes)
            ask = partial(self._ask_all, "isa")
            self._director.every(period_ns, ask, Priority.OBSERVE, first_ns=period_ns)

    def take(self, key: str, message: Message, data: Payload) -> None:  # noqa: ARG002
        """End the run after the last answer, or when the last who was asked has left."""
        if isinstance(message, SeatAction) and self._is_closing and not self._open():
            self._director.stop()

    def end(self) -> None:
        """End the run, after the answers of those who are asked at the end."""
        if self._is_closing:
            return
        can_wait = self._context.is_replay or not isinstance(self._director.pace, Virtual)
        if not (self._has_tlx and can_wait and any(one.phase == "taken" for one in self._seats)):
            self._director.stop()
            return
        self._is_closing = True
        self._ask_all("nasa_tlx")
        self._pace.stand_still()
        if not self._context.is_replay:
            self._patience = threading.Timer(PATIENCE_S, self._director.post, [self._give_up])
            self._patience.daemon = True
            self._patience.start()

    def close(self) -> None:
        """Wait for nobody any more: the run is over."""
        if self._patience is not None:
            self._patience.cancel()
            self._patience = None

    def _ask_all(self, scale: Literal["isa", "nasa_tlx"]) -> None:
        for state in self._seats:
            if state.phase == "taken":
                self._asked[state.seat] += 1
                question = WorkloadQuestion(
                    number=self._asked[state.seat], scale=scale, asked_ns=self._director.now_ns
                )
                self._seats.ask(state.seat, question)

    def _open(self) -> dict[str, int]:
        """Return the numbers of the questions that have no answer yet, by seat."""
        return {one.seat: one.question.number for one in self._seats if one.question is not None}

    def _give_up(self) -> None:
        for seat, number in self._open().items():
            action = SeatAction(
                t_ns=self._director.now_ns, holder=RUN, act=AnswerQuestion(question=number)
            )
            self._context.router.heard(f"seat/{key_chunk(seat)}/do", action, UNREGISTERED)
