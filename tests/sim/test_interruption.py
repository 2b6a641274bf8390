"""A signal ends a run between two events."""

from __future__ import annotations

import os
import signal
from collections.abc import Iterator

import pytest

from airhilt.sim import Director, Priority, Virtual, interruptible


@pytest.fixture(autouse=True)
def usual_handler() -> Iterator[None]:
    """As a terminal starts a program; in the background SIGINT is ignored."""
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    yield
    signal.signal(signal.SIGINT, before)


def test_the_event_in_hand_is_finished_and_the_next_is_not_begun() -> None:
    director = Director(Virtual())
    done = []

    def take_a_signal() -> None:
        os.kill(os.getpid(), signal.SIGINT)
        done.append("first")

    director.at(1, take_a_signal, Priority.PHYSICS)
    director.at(2, lambda: done.append("second"), Priority.PHYSICS)
    with interruptible(director.interrupt), pytest.raises(KeyboardInterrupt):
        director.run()
    assert done == ["first"]


def test_further_signals_are_ignored_until_all_is_finished() -> None:
    calls = []
    with interruptible(lambda: calls.append("interrupted")):
        for _ in range(3):
            os.kill(os.getpid(), signal.SIGINT)
    assert calls == ["interrupted"]


def test_handlers_are_as_before_afterwards() -> None:
    before = signal.getsignal(signal.SIGINT)
    with interruptible(lambda: None):
        assert signal.getsignal(signal.SIGINT) is not before
    assert signal.getsignal(signal.SIGINT) is before


def test_a_signal_that_python_does_not_handle_keeps_its_effect() -> None:
    assert signal.getsignal(signal.SIGTERM) == signal.SIG_DFL
    with interruptible(lambda: None):
        assert signal.getsignal(signal.SIGTERM) == signal.SIG_DFL
