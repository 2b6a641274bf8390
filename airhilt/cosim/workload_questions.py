"""Questions about workload: ISA while the run goes on, NASA-TLX when it has come to its end."""

from __future__ import annotations

import threading
from collections import Counter
from collections.abc import Callable, Sequence
from typing import Literal

from airhilt.messages import WorkloadAnswer, WorkloadQuestion
from airhilt.sensors.base import Publish
from airhilt.sensors.radio.hearing import key_chunk
from airhilt.sim import Director, Priority, Virtual
from airhilt.units import seconds_to_ns

PATIENCE_S = 600.0
"""Wall time for which the end of a run waits for ratings, in s: an assumption."""


class WorkloadQuestions:
    """Asks the people at seats, and ends the run once they have answered.

    A person who leaves the seat is not waited for. Who does not answer in time is logged as having
    given no answer, so that a replay ends at the same time.

    Parameters
    ----------
    seats
        Units and callsigns that are left to people.
    isa_minutes
        Time between two ISA questions, in minutes; None: they are not asked.
    has_tlx
        True asks for NASA-TLX at the end.
    is_replay
        True if the answers come from the record of an earlier run.
    hold
        Lets the time stand still.
    take
        Takes a message as if it had come from the bus: its key and its data.

    Attributes
    ----------
    is_closing
        True once the run has come to its end and waits for answers.
    """

    def __init__(
        self,
        director: Director,
        seats: Sequence[str],
        publish: Publish,
        *,
        isa_minutes: float | None,
        has_tlx: bool,
        is_replay: bool,
        hold: Callable[[], None],
        take: Callable[[str, bytes], None],
    ) -> None:
        self.is_closing = False
        self._director = director
        self._names = {key_chunk(seat): seat for seat in seats}
        self._publish = publish
        self._has_tlx = has_tlx
        self._is_replay = is_replay
        self._hold = hold
        self._take = take
        self._present: dict[str, None] = {}
        """Seats at which somebody is, as parts of keys."""
        self._asked: Counter[str] = Counter()
        self._unanswered: set[tuple[str, int]] = set()
        """Questions that have no answer yet: seat and number."""
        self._open: dict[str, int] = {}
        """Questions for which the end waits, by seat."""
        if isa_minutes is not None:
            period_ns = seconds_to_ns(60.0 * isa_minutes)
            director.every(period_ns, self._ask_isa, Priority.OBSERVE, first_ns=period_ns)

    def occupy(self, seat: str, *, is_taken: bool) -> None:
        """Take in that a person has taken a seat, a part of keys, or has left it."""
        if is_taken:
            self._present[seat] = None
        else:
            self._present.pop(seat, None)
            self._settle(seat)

    def answer(self, seat: str, answer: WorkloadAnswer) -> None:
        """Take in an answer."""
        self._unanswered.discard((seat, answer.question))
        if self._open.get(seat) == answer.question:
            self._settle(seat)

    def is_open(self, seat: str, number: int) -> bool:
        """Return whether a question was asked and has no answer yet."""
        return (seat, number) in self._unanswered

    def end(self) -> None:
        """End the run, after the answers of those who are asked at the end."""
        if self.is_closing:
            return
        can_wait = self._is_replay or not isinstance(self._director.pace, Virtual)
        if not (self._has_tlx and can_wait and self._present):
            self._director.stop()
            return
        self.is_closing = True
        self._open = self._ask_all("nasa_tlx")
        self._hold()
        if not self._is_replay:
            waiting = threading.Timer(PATIENCE_S, self._director.post, [self._give_up])
            waiting.daemon = True
            waiting.start()

    def _ask_isa(self) -> None:
        self._ask_all("isa")

    def _ask_all(self, scale: Literal["isa", "nasa_tlx"]) -> dict[str, int]:
        """Ask everybody, and return the numbers of the questions by seat."""
        asked = {}
        for seat in self._present:
            self._asked[seat] += 1
            asked[seat] = self._asked[seat]
            self._unanswered.add((seat, asked[seat]))
            question = WorkloadQuestion(
                t_ns=self._director.now_ns,
                seat=self._names[seat],
                number=asked[seat],
                scale=scale,
            )
            self._publish(f"question/{seat}", question)
        return asked

    def _give_up(self) -> None:
        for seat, number in list(self._open.items()):
            answer = WorkloadAnswer(question=number)
            self._take(f"workload/{seat}", answer.model_dump_json().encode())

    def _settle(self, seat: str) -> None:
        if self.is_closing and self._open.pop(seat, None) is not None and not self._open:
            self._director.stop()
