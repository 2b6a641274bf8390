"""A client of a seat: a page or a program takes a seat of a run, acts there, and leaves it."""

from __future__ import annotations

import time
from contextlib import suppress
from secrets import token_urlsafe

import zenoh

from airhilt.messages import SeatAct, SeatAction, SeatAnswer, TakeSeat, key_chunk

ANSWERED_S = 10.0
"""Longest time that the answer of the run may take, in s."""
BEGINS_S = 3.0
"""Time in s for which nobody at all may answer before the run counts as unreachable."""
BETWEEN_S = 0.1
UNREACHABLE = "the run does not answer"


class SeatClient:
    """Takes a seat of a run, and acts there until it is closed.

    Parameters
    ----------
    prefix
        Beginning of the keys of the run, such as ``airhilt/my-run``.
    seat
        Name of the unit or the callsign.
    secret
        Secret of the holder; by default a new one. Who comes back with the same secret while the
        seat is held has it again.
    """

    def __init__(
        self, session: zenoh.Session, prefix: str, seat: str, secret: str | None = None
    ) -> None:
        self.seat = seat
        self._session = session
        self._key = f"{prefix}/seat/{key_chunk(seat)}"
        self._secret = token_urlsafe(16) if secret is None else secret
        self.holder = token_urlsafe(12)
        """Name of the liveliness token."""
        self._token = session.liveliness().declare_token(f"{self._key}/holder/{self.holder}")

    def take(self) -> str:
        """Take the seat; return why that is refused, empty if it is not."""
        return self.act(TakeSeat())

    def act(self, act: SeatAct) -> str:
        """Do something at the seat; return why that is refused, empty if it is not."""
        action = SeatAction(holder=self.holder, secret=self._secret, act=act)
        payload = action.model_dump_json().encode()
        until_s = time.monotonic() + BEGINS_S
        with suppress(zenoh.ZError):  # The run has ended.
            # A run that begins is seen before it is known where it answers.
            while (reason := self._ask(payload)) is None and time.monotonic() < until_s:
                time.sleep(BETWEEN_S)
            return UNREACHABLE if reason is None else reason
        return UNREACHABLE

    def _ask(self, payload: bytes) -> str | None:
        """Return the reason in the answer of the run; None if nobody answers."""
        for reply in self._session.get(f"{self._key}/do", payload=payload, timeout=ANSWERED_S):
            if reply.ok is not None:
                return SeatAnswer.model_validate_json(reply.ok.payload.to_bytes()).reason
        return None

    def close(self) -> None:
        """Leave the seat, if it was taken: the token ends."""
        self._token.undeclare()  # type: ignore[no-untyped-call]
