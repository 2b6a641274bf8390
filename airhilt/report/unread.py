"""Messages of a log that the page leaves out because a part of it cannot read them."""

from __future__ import annotations

from collections.abc import Callable

from pydantic import ValidationError

from airhilt.errors import first_problem
from airhilt.host.text import readable
from airhilt.record import Logged
from airhilt.units import SECOND_NS

CANNOT_READ = (
    ValueError, LookupError, TypeError, AttributeError, RecursionError, ArithmeticError,
)  # fmt: skip
"""Exceptions of a reader whose message has other content than it expects."""


class UnreadMessages:
    """Counts the messages that a reader refuses, and remembers the first."""

    def __init__(self) -> None:
        self._count = 0
        self._first = ""
        self._last: Logged | None = None

    def attempt(self, read: Callable[[Logged], None], logged: Logged) -> None:
        """Hand a message to a reader; one that several readers refuse counts once."""
        try:
            read(logged)
        except CANNOT_READ as error:
            if self._last is not logged:
                self._count += 1
                self._last = logged
            place = f"{logged.key} at {logged.t_ns / SECOND_NS:.1f} s"
            self._first = self._first or f"{place}: {_cause(error)}"

    def note(self) -> str:
        """Return a sentence on the messages that were left out, empty if there are none."""
        if not self._count:
            return ""
        begin = "One message of the log is not as this version writes it, and left out"
        if self._count > 1:
            begin = (
                f"{self._count} messages of the log are not as this version writes them, and left "
                "out. The first is"
            )
        return readable(f"{begin}: {self._first}")


def _cause(error: Exception) -> str:
    if isinstance(error, ValidationError):
        return f"{error.title}: {first_problem(error)}"
    return f"{type(error).__name__}: {error}"
