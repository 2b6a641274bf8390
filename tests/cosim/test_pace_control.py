"""A run that stands still until people are there, and whoever lets it go on."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial
from types import SimpleNamespace
from typing import TYPE_CHECKING, cast

import pytest

from airhilt.cosim.pace_control import PaceControl
from airhilt.messages import LeaveSeat, SeatAct, SeatAction, SetPace, TakeSeat
from airhilt.seats import Seats
from airhilt.sim import Director, Priority, RealTime
from seats import state_of

if TYPE_CHECKING:
    from airhilt.bus.session import Bus
    from airhilt.cosim.context import RunContext
    from airhilt.sensors.radio.conversation import RadioConversation

LATER_NS = 3_600_000_000_000
"""Time of the first step of the run, to which no test comes."""
Happening = Callable[["Waiting"], None]


class Waiting:
    """A run that waits for a tower and a pilot."""

    def __init__(self) -> None:
        self.director = Director(RealTime(4.0))
        self.paces: list[str] = []
        states = (state_of("tower"), state_of("AAL1"))
        self.seats = Seats(states, lambda _key, _state: None, self.director)
        self.control = PaceControl(
            cast("RunContext", self),
            self.seats,
            cast("RadioConversation", SimpleNamespace(pause=lambda: None)),
            cast("Bus", SimpleNamespace(run="run", keep=lambda _key, _data: None)),
        )
        self.control.wait_for_seats()
        self.director.at(LATER_NS, lambda: None, Priority.PHYSICS)

    def event(self, _kind: str, _subject: str, text: str) -> None:
        """Take in an event, as the context of the run does."""
        self.paces.append(text)

    def act(self, seat: str, act: SeatAct) -> None:
        action = SeatAction(holder="somebody", act=act)
        for part in (self.seats, self.control):
            part.take(f"seat/{seat}/do", action, b"")

    def pace_after(self, happenings: Sequence[Happening]) -> str:
        """Return the pace after some happenings, one after the other."""
        for happening in happenings:
            self.director.post(partial(happening, self))
        self.director.post(self.director.stop)
        self.director.run()
        assert self.paces[-1] == self.director.pace.name
        return self.paces[-1]


def sits(seat: str) -> Happening:
    return lambda run: run.act(seat, TakeSeat())


def leaves(seat: str) -> Happening:
    return lambda run: run.act(seat, LeaveSeat())


def asks_for(factor: float) -> Happening:
    return lambda run: run.act("tower", SetPace(factor=factor))


@pytest.mark.parametrize(
    ("happenings", "pace"),
    [
        ([], "paused"),
        ([sits("tower")], "paused"),
        ([sits("tower"), leaves("tower")], "paused"),
        ([sits("tower"), leaves("tower"), sits("AAL1")], "paused"),
        ([sits("tower"), sits("AAL1")], "4x"),
        ([sits("tower"), asks_for(1.0)], "realtime"),
        ([sits("tower"), asks_for(0.5), sits("AAL1")], "0.5x"),
        ([sits("tower"), asks_for(0.0), sits("AAL1")], "paused"),
        ([sits("tower"), sits("AAL1"), leaves("tower"), leaves("AAL1")], "realtime"),
    ],
)
def test_a_run_begins_when_all_its_seats_are_taken_or_somebody_lets_it(
    happenings: list[Happening], pace: str
) -> None:
    assert Waiting().pace_after(happenings) == pace
