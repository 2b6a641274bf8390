"""Notices to people at seats: what their aircraft and the run cannot do."""

from __future__ import annotations

from collections.abc import Callable, Collection

from airhilt.messages import Event, Message, SeatNotice
from airhilt.sensors.base import Publish
from airhilt.sensors.radio.hearing import key_chunk
from airhilt.sim.payload import Payload


class SeatNotices:
    """Tells the person at a seat that a command cannot be done, or that a message is refused.

    Parameters
    ----------
    seats
        Units and callsigns that are left to people.
    """

    def __init__(self, seats: Collection[str], publish: Publish, now_ns: Callable[[], int]) -> None:
        self._names = {key_chunk(seat): seat for seat in seats}
        self._publish = publish
        self._now_ns = now_ns

    def take(self, key: str, message: Message, data: Payload) -> None:  # noqa: ARG002
        """Receive a message of the run."""
        match message:
            case Event(kind="unable", subject=subject, text=text):
                why = text.removeprefix("unable").lstrip(" ,:")
                self._tell(key_chunk(subject), f"Unable: {why}")
            case Event(kind="refused", subject=subject, text=text):
                self._tell(subject.rpartition("/")[2], f"Refused: {text}")

    def _tell(self, chunk: str, text: str) -> None:
        seat = self._names.get(chunk)
        if seat is not None:
            notice = SeatNotice(t_ns=self._now_ns(), seat=seat, text=text)
            self._publish(f"notice/{chunk}", notice)
