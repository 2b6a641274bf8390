"""Guards of the bus: refusals before anybody is asked, and answers that are none."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import closing

import pytest
import zenoh

from airhilt.bus.attach import attach
from airhilt.bus.remote_workers import RemoteWorker
from airhilt.bus.session import Bus, connect_client
from airhilt.errors import AirhiltError, WorkerError
from airhilt.messages import parts_of


@pytest.fixture
def bus() -> Iterator[Bus]:
    with closing(Bus("run")) as opened:
        yield opened


@pytest.mark.parametrize(
    ("names", "answer"),
    [
        (["Decision"], "worker name 'Decision': expected lower-case letters"),
        (["run"], "a worker is named 'run', as the log calls others"),
        (["asr", "own", "asr"], "two workers are named 'asr'"),
    ],
)
def test_names_that_no_worker_can_have_are_refused_before_anybody_is_waited_for(
    bus: Bus, names: list[str], answer: str
) -> None:
    told: list[str] = []
    with pytest.raises(AirhiltError, match=answer):
        attach(bus, names, 0.0, 1.0, told.append)
    assert told == []


def test_a_worker_that_cannot_describe_itself_is_told_from_one_that_takes_no_grants(
    bus: Bus,
) -> None:
    def fail(query: zenoh.Query) -> None:
        with query:
            query.reply_err(b"no idea")

    worker = RemoteWorker(bus, "own", timeout_s=1.0)
    assert worker.describe(timeout_s=1.0) is None
    with connect_client(bus.endpoint, 5.0) as own:
        kept = own.declare_queryable("airhilt/run/worker/own/describe", fail)
        list(own.get("airhilt/*/clock", timeout=1.0))  # What was declared before it has arrived.
        with pytest.raises(WorkerError, match="worker 'own' is there, but did not describe itself"):
            worker.describe(timeout_s=1.0)
        del kept


def test_payloads_that_were_put_together_are_taken_apart_again() -> None:
    assert parts_of(b"onethree", [3, 0, 5]) == [b"one", b"", b"three"]


@pytest.mark.parametrize("sizes", [[2], [2, 2], []])
def test_sizes_that_are_not_those_of_the_payload_are_refused(sizes: list[int]) -> None:
    with pytest.raises(ValueError, match=r"3 bytes of payload, but sizes \["):
        parts_of(b"one", sizes)
