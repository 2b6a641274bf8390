"""A run takes of the messages of programs what it can, and counts the others."""

from __future__ import annotations

import queue
from collections.abc import Callable
from contextlib import closing
from functools import partial
from typing import Any

import pytest
import zenoh

from airhilt.bus.intake import (
    MOST_MISSING,
    MOST_SENDERS,
    MOST_WAITING,
    MOST_WAITING_BYTES,
    ROUTED_BYTES,
    Intake,
    Source,
)
from airhilt.bus.session import Bus, connect_client
from airhilt.messages import DropCause, Limit

KEYS = "advisory/*"


class Clock:
    """Wall time that a test sets."""

    def __init__(self) -> None:
        self.t_s = 0.0

    def __call__(self) -> float:
        return self.t_s


def intake(
    limit: Limit, clock: Callable[[], float] | None = None
) -> tuple[Intake, list[tuple[str, DropCause]]]:
    told: list[tuple[str, DropCause]] = []
    made = Intake({KEYS: limit}, lambda keys, cause: told.append((keys, cause)), clock or Clock())
    return made, told


def test_a_message_above_the_limit_is_dropped_and_the_first_is_told() -> None:
    taken, told = intake(Limit(size_bytes=10, rate_hz=5))
    assert [taken.admit(KEYS, size) for size in (10, 11, 1000)] == [True, False, False]
    assert told == [(KEYS, "size")]
    assert taken.dropped == {(KEYS, "size"): 2}


def test_as_many_as_the_rate_are_taken_in_a_second() -> None:
    clock = Clock()
    taken, told = intake(Limit(size_bytes=10, rate_hz=5), clock)
    first = [taken.admit(KEYS, 1) for _ in range(100)]
    clock.t_s = 0.4
    second = [taken.admit(KEYS, 1) for _ in range(100)]
    clock.t_s = 100.0
    third = [taken.admit(KEYS, 1) for _ in range(100)]
    assert (sum(first), sum(second), sum(third)) == (5, 2, 5)
    assert told == [(KEYS, "rate")]
    assert taken.dropped == {(KEYS, "rate"): 288}


@pytest.mark.parametrize(
    ("size", "room"), [(1, MOST_WAITING), (MOST_WAITING_BYTES // 4, 4), (MOST_WAITING_BYTES, 1)]
)
def test_what_waits_is_limited_in_number_and_size(size: int, room: int) -> None:
    taken, _ = intake(Limit(size_bytes=MOST_WAITING_BYTES, rate_hz=10 * MOST_WAITING))
    assert sum(taken.admit(KEYS, size) for _ in range(room + 3)) == room
    assert taken.dropped == {(KEYS, "queue"): 3}
    taken.release(size)
    assert taken.admit(KEYS, size)


def test_missing_numbers_of_a_sender_are_counted() -> None:
    taken, told = intake(Limit(size_bytes=10, rate_hz=100))
    for number in (7, 8, 12, 11, 13):
        assert taken.admit(KEYS, 1, Source("a", number))
    assert taken.admit(KEYS, 1, Source("b", 1000))
    assert taken.admit(KEYS, 1)
    assert told == [(KEYS, "transport")]
    assert taken.dropped == {(KEYS, "transport"): 3}


def test_a_number_far_from_the_last_one_begins_the_count_anew() -> None:
    taken, _ = intake(Limit(size_bytes=10, rate_hz=100))
    for number in (0, 2**32 - 1, 2, 4):
        assert taken.admit(KEYS, 1, Source("a", number))
    assert taken.dropped == {(KEYS, "transport"): 1}
    assert taken.admit(KEYS, 1, Source("a", 4 + MOST_MISSING + 1))
    assert taken.dropped == {(KEYS, "transport"): 1 + MOST_MISSING}


def test_the_numbers_of_a_bounded_number_of_senders_are_followed() -> None:
    taken, _ = intake(Limit(size_bytes=10, rate_hz=10 * MOST_SENDERS))
    for sender in range(MOST_SENDERS + 1):
        taken.admit(KEYS, 0, Source(str(sender), 1))
    taken.admit(KEYS, 0, Source("0", 3))
    taken.admit(KEYS, 0, Source(str(MOST_SENDERS), 9))
    assert taken.dropped == {(KEYS, "transport"): 1}


def test_a_bus_hears_what_is_admitted_and_learns_sizes_and_numbers() -> None:
    heard: queue.Queue[int] = queue.Queue()
    taken, _ = intake(Limit(size_bytes=1000, rate_hz=100))
    with closing(Bus("run")) as bus:
        bus.hear(KEYS, lambda _, data: heard.put(len(data)), partial(taken.admit, KEYS))
        session: Any = connect_client(bus.endpoint, 5.0)
        publisher = session.declare_publisher(
            "airhilt/run/advisory/ATC", congestion_control=zenoh.CongestionControl.BLOCK
        )
        for number, size in enumerate((1, ROUTED_BYTES + 1, 1001, 3)):
            source = zenoh.SourceInfo(publisher.id, number)
            publisher.put(bytes(size), source_info=source)
        assert [heard.get(timeout=10.0) for _ in range(2)] == [1, 3]
        session.close()
    assert taken.dropped == {(KEYS, "size"): 1, (KEYS, "transport"): 1}
