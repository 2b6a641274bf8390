"""Signals that end a run do so between two events, so that nothing is left half done."""

from __future__ import annotations

import signal
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager


@contextmanager
def interruptible(interrupt: Callable[[], None]) -> Iterator[None]:
    """Call ``interrupt`` on the first signal that would raise wherever Python then is.

    The signals are SIGINT and SIGTERM, where a Python function handles them. More are ignored
    to the end, because what then finishes the run must not be interrupted. On another thread than
    the main one nothing changes: signals do not reach it.
    """
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    earlier = {
        number: handler
        for number in (signal.SIGINT, signal.SIGTERM)
        if callable(handler := signal.getsignal(number))
    }

    def handle(*_: object) -> None:
        for number in earlier:
            signal.signal(number, signal.SIG_IGN)
        interrupt()

    for number in earlier:
        signal.signal(number, handle)
    try:
        yield
    finally:
        for number, handler in earlier.items():
            signal.signal(number, handler)
