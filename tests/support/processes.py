"""Processes beside a test, and what happens to them."""

from __future__ import annotations

import signal
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from airhilt.cosim.observer import Observer, Snapshot


@contextmanager
def process(*command: str | Path) -> Iterator[subprocess.Popen[bytes]]:
    """A process of Python's beside the test; it is ended with it."""
    started = subprocess.Popen([sys.executable, *command], stderr=subprocess.PIPE)
    try:
        yield started
    finally:
        started.send_signal(signal.SIGCONT)
        started.kill()
        started.communicate()


class ActsAt(Observer):
    """Sends a signal to a process once a simulation time has come."""

    def __init__(self, t_s: float, worker: subprocess.Popen[bytes], number: int) -> None:
        self._t_s, self._worker, self._number = t_s, worker, number

    def snapshot(self, snapshot: Snapshot) -> None:
        if snapshot.t_s >= self._t_s and self._number:
            self._worker.send_signal(self._number)
            if self._number == signal.SIGKILL:
                self._worker.wait()
            self._number = 0
