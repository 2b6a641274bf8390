"""The connection of a station to a run that goes on: its name, its seats, what it has told."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import suppress
from pathlib import Path
from typing import TypeVar

import zenoh
from pydantic import ValidationError

from airhilt.bus.access import Role
from airhilt.bus.session import close_session, connect_client, find_run
from airhilt.errors import StationError
from airhilt.host.text import readable
from airhilt.messages import Briefing, Clock, Message, Phase, SeatState
from airhilt.scenario.seats import ROLES, without_roles

T = TypeVar("T", bound=Message)

ASKED_S = 2.0
"""Longest time that an answer of the run may take, in s."""
PHASE_PERIOD_S = 0.1
"""Time between two questions if a run has begun, in s."""


class RunConnection:
    """Connects a station to the run at an endpoint.

    Parameters
    ----------
    endpoint
        Endpoint of the run; None: the one of the keys.
    role
        Role of the station: the operator where people may take seats.
    patience_s
        Longest wait for the run, in s.
    tls
        Folder with the keys of the role; None: the run asks for none.
    run
        Name of the run; None: there is one only.

    Attributes
    ----------
    session
        Session with the run.
    prefix
        Beginning of the keys of the run.
    run
        Name of the run.

    Raises
    ------
    BusError
        No run answers there in time, or several do; or the keys are none.
    """

    def __init__(
        self,
        endpoint: str | None,
        role: Role = "observer",
        *,
        patience_s: float = 30.0,
        tls: Path | None = None,
        run: str | None = None,
    ) -> None:
        self.session = connect_client(endpoint, patience_s, tls, role)
        try:
            self.prefix = find_run(self.session, patience_s, run)
        except BaseException:
            close_session(self.session)
            raise
        self.run = self.prefix.rpartition("/")[2]

    def seats(self, names: Sequence[str], tell: Callable[[str], None]) -> tuple[str, ...]:
        """Return the seats of the run that are asked for, each once.

        Nobody knows the seats of a run that has not begun. A role waits until it has; without one,
        names stand for themselves alone.

        Parameters
        ----------
        tell
            Called with a line for the user once there is a role that has to wait.

        Raises
        ------
        StationError
            The run goes on, and has no such seat; or a role is asked for, and it does not say
            which seats it has.
        """
        roles = sorted(ROLES.intersection(names))
        phase = self._phase() if names else None
        if roles and phase == "waiting":
            tell(f"the run has not begun; until then nobody knows the seat of {roles[0]!r}")
        while roles and phase == "waiting":
            time.sleep(PHASE_PERIOD_S)
            phase = self._phase() or self._phase()  # One answer may be late.
        if phase == "running":
            return self._known(names)
        if roles:
            raise StationError(
                f"--seat {roles[0]!r}: the run does not say which seats it has "
                f"({phase or 'no answer'}); expected a run that goes on"
            )
        return tuple(dict.fromkeys(names))

    def _known(self, names: Sequence[str]) -> tuple[str, ...]:
        known = sorted({info.seat for info in self._told("seat/*", SeatState)})
        controller = next((one.controller for one in self._told("briefing", Briefing)), "")
        seats = without_roles(names, controller, known)
        for name in names:
            if not set(without_roles([name], controller, known)).issubset(known):
                raise StationError(
                    f"--seat {readable(name)!r}: not a seat of the run; expected "
                    + (readable(", ".join(map(repr, known))) or "none: it has no seats")
                )
        return seats

    def answers(self, key: str) -> Iterator[zenoh.Sample]:
        """Yield what the run answers to a query on a key below its own."""
        for reply in self.session.get(f"{self.prefix}/{key}", timeout=ASKED_S):
            if reply.ok is not None:
                yield reply.ok

    def close(self) -> None:
        """Leave the run."""
        close_session(self.session)

    def _phase(self) -> Phase | None:
        """Return the phase of the run; None: it does not say."""
        return next((clock.phase for clock in self._told("clock", Clock)), None)

    def _told(self, key: str, kind: type[T]) -> Iterator[T]:
        """Yield the messages of a kind that the run has told before."""
        for sample in self.answers(key):
            with suppress(ValidationError):
                yield kind.model_validate_json(sample.payload.to_bytes())
