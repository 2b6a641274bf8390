"""A connected program that does not read holds up neither the work of a run nor its end."""

from __future__ import annotations

import queue
import signal
import subprocess
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import closing, contextmanager

import pytest
import zenoh

from airhilt.bus.remote_workers import RemoteWorker
from airhilt.bus.session import Bus, close_session, connect_client, find_run, free_endpoint
from airhilt.messages import InputSpec, StepReply, WorkerDescription
from processes import process

READER = """
import sys, time
from airhilt.bus.session import connect_client
session = connect_client(sys.argv[1], 10.0)
kept = [
    session.declare_subscriber("airhilt/**", lambda sample: None),
    session.declare_queryable("airhilt/run/worker/own/step", lambda query: None),
    session.liveliness().declare_token("airhilt/run/worker/reader"),
]
time.sleep(600.0)
"""
"""A program that reads everything, and never answers the grants of worker ``own``."""
RUN = """
import sys, time
from airhilt.bus.session import Bus
bus = Bus("run", sys.argv[1])
bus.keep("clock", b"{}")
bus.hear("command/*", lambda key, payload: None)
time.sleep(600.0)
"""
"""A run that hears commands."""
READS_AGAIN_S = 4.0
"""Time after which a program goes on, in s; Zenoh would wait 5 s for it, at the end 10 s."""


@contextmanager
def frozen_reader(bus: Bus) -> Iterator[subprocess.Popen[bytes]]:
    """A program that is stopped while it reads, with all filled that waits for it."""
    there: queue.SimpleQueue[str] = queue.SimpleQueue()
    bus.watch_workers(lambda name, _: there.put(name))
    with process("-c", READER, bus.endpoint) as program:
        while there.get(timeout=30.0) != "reader":
            pass
        program.send_signal(signal.SIGSTOP)
        for _ in range(20):
            for _ in range(300):
                bus.put("adsb/a1b2c3", bytes(3000))  # Larger ones go by shared memory.
            time.sleep(0.02)
        yield program


def is_done_before_it_reads(program: subprocess.Popen[bytes], do: Callable[[], None]) -> bool:
    """Let a program go on after a while, and return true if something is done by then."""
    again = threading.Timer(READS_AGAIN_S, program.send_signal, (signal.SIGCONT,))
    again.start()
    do()
    is_frozen = again.is_alive()
    again.cancel()
    return is_frozen


def test_a_run_ends_before_a_program_reads_again() -> None:
    bus = Bus("run")
    with frozen_reader(bus) as program:
        assert is_done_before_it_reads(program, bus.close)


def stop_and_fill(run: subprocess.Popen[bytes], send: Callable[[], None]) -> None:
    """Stop a run, and send it more than it takes."""
    run.send_signal(signal.SIGSTOP)
    for _ in range(60):
        for _ in range(300):
            send()
        time.sleep(0.02)


@pytest.mark.slow
def test_a_program_ends_before_its_run_reads_again() -> None:
    endpoint = free_endpoint()
    with process("-c", RUN, endpoint) as program:
        session = connect_client(endpoint, 30.0)
        find_run(session, 30.0)
        stop_and_fill(program, lambda: session.put("airhilt/run/command/AAL123", bytes(3000)))
        assert is_done_before_it_reads(program, lambda: close_session(session))


def test_another_run_may_listen_where_one_ended_that_was_not_read() -> None:
    first = Bus("run")
    with frozen_reader(first):
        first.close()
        with (
            closing(Bus("second", first.endpoint)) as second,
            connect_client(second.endpoint, 5.0),
        ):
            pass


def test_a_worker_is_called_before_a_program_in_its_name_reads_again() -> None:
    description = WorkerDescription(
        name="own", modality="decision", inputs=(InputSpec(key="adsb/*"),)
    )

    def describe(query: zenoh.Query) -> None:
        with query:
            query.reply("airhilt/run/worker/own/describe", description.model_dump_json())

    def step(query: zenoh.Query) -> None:
        with query:
            header = StepReply(seq=0, compute_s=0.0, wake_ns=1).model_dump_json()
            query.reply("airhilt/run/worker/own/step", b"", attachment=header)

    with closing(Bus("run")) as bus, connect_client(bus.endpoint, 5.0) as own:
        kept = [
            own.declare_queryable("airhilt/run/worker/own/describe", describe),
            own.declare_queryable("airhilt/run/worker/own/step", step),
        ]
        worker = RemoteWorker(bus, "own", timeout_s=30.0)
        while worker.describe(timeout_s=1.0) is None:
            time.sleep(0.02)

        def call() -> None:
            assert worker.dispatch(0, 0, []).result().wake_ns == 1

        with frozen_reader(bus) as program:
            assert is_done_before_it_reads(program, call)
        del kept
