"""The commands that calls have for the people at seats, who give them or leave them."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable

from airhilt.commands import Command
from airhilt.messages import CommandOffer
from airhilt.sensors.base import Publish
from airhilt.sensors.radio.hearing import key_chunk

MOST_OFFERS = 5
"""Number of commands that are offered at a seat at a time: the newest."""


class Offers:
    """Offers people the commands that an automaton would carry out; they decide if, and when."""

    def __init__(self, publish: Publish, now_ns: Callable[[], int]) -> None:
        self._publish = publish
        self._now_ns = now_ns
        self._open: defaultdict[str, list[CommandOffer]] = defaultdict(list)
        """Offers that are open, by seat, the oldest first."""
        self._count = 0

    def make(self, seat: str, call: str, command: Command) -> None:
        """Offer the person at a seat a command of a call; an open offer of the same one is over."""
        self.end(seat, command)
        self._count += 1
        offer = CommandOffer(
            t_ns=self._now_ns(), seat=seat, number=self._count, call=call, command=command
        )
        self._open[seat].append(offer)
        self._tell(offer)
        for old in self._open[seat][:-MOST_OFFERS]:
            self._end(old)

    def end(self, seat: str, command: Command) -> None:
        """End the offer of a command that the person at a seat has given, or is offered anew."""
        for offer in [one for one in self._open[seat] if one.command == command]:
            self._end(offer)

    def end_all(self, seat: str) -> None:
        """End all offers of a seat: its person has left, and nobody else carries them out."""
        for offer in list(self._open[seat]):
            self._end(offer)

    def _end(self, offer: CommandOffer) -> None:
        self._open[offer.seat].remove(offer)
        self._tell(offer.model_copy(update={"t_ns": self._now_ns(), "is_over": True}))

    def _tell(self, offer: CommandOffer) -> None:
        self._publish(f"offer/{key_chunk(offer.seat)}", offer)
