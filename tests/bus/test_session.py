"""A session that cannot be opened says why; one that is closed leaves nothing behind."""

from __future__ import annotations

import gc
import queue
import re
import subprocess
import sys
import time
from contextlib import closing
from pathlib import Path
from typing import Never
from weakref import ReferenceType, ref

import pytest
import zenoh

from airhilt.bus.closed import Answer
from airhilt.bus.remote_workers import RemoteWorker
from airhilt.bus.session import Bus, connect_client, free_endpoint
from airhilt.errors import BusError, RendererError
from airhilt.sim.payload import DeferredBytes
from airhilt.sim.worker import Input, WorkerLost
from resources import held, linux_only

NO_MEMORY = "Unable to create POSIX shm segment: OS error 30 at /build/zenoh-shm/src/segment.rs:85."


@pytest.fixture
def _no_shared_memory(monkeypatch: pytest.MonkeyPatch) -> None:
    """Let Zenoh fail as it does where /dev/shm is read-only."""

    def refuse(_: zenoh.Config) -> Never:
        raise zenoh.ZError(NO_MEMORY)

    monkeypatch.setattr(zenoh, "open", refuse)


def test_a_port_in_use_is_named_with_the_words_of_zenoh() -> None:
    with (
        closing(Bus("first")) as first,
        pytest.raises(BusError, match="cannot listen on") as error,
    ):
        Bus("second", first.endpoint)
    message = str(error.value)
    assert "Address already in use (os error 98)" in message
    assert "another program has the port" in message
    assert ".rs:" not in message


FORKS = """
import os
from contextlib import closing
from airhilt.bus.session import Bus
with closing(Bus("before")):
    pass
if (child := os.fork()) == 0:
    try:
        Bus("after")
    except Exception as error:
        print(error, flush=True)
    os._exit(0)
os.waitpid(child, 0)
with closing(Bus("again")):
    pass
"""


@linux_only
def test_a_fork_of_a_process_that_had_a_run_is_told_that_it_has_no_bus() -> None:
    done = subprocess.run(
        [sys.executable, "-c", FORKS], capture_output=True, text=True, check=True, timeout=300
    )
    assert "this process was forked from one that has had a run" in done.stdout
    assert "get_context('spawn')" in done.stdout


def test_no_outgoing_connection_is_given_the_port_of_a_run_that_has_not_begun() -> None:
    given = Path("/proc/sys/net/ipv4/ip_local_port_range")
    if not given.exists():
        pytest.skip("no Linux")
    first = int(given.read_text().split()[0])
    if first < 32_768:  # which it is, if nobody changes it
        pytest.skip(f"outgoing connections of this system have ports from {first} on")
    ports = {int(free_endpoint().rpartition(":")[2]) for _ in range(50)}
    assert len(ports) > 45
    assert max(ports) < first


def test_an_address_of_another_machine_is_not_called_a_port_in_use() -> None:
    endpoint = "tcp/192.0.2.1:7447"  # for documentation only: RFC 5737
    with pytest.raises(BusError, match=re.escape(endpoint)) as error:
        Bus("run", endpoint, insecure=True)
    assert "expected a free port of this machine" in str(error.value)
    assert "in use" not in str(error.value)


@pytest.mark.usefixtures("_no_shared_memory")
def test_shared_memory_that_cannot_be_made_is_the_cause_and_not_the_port() -> None:
    with pytest.raises(BusError, match="/dev/shm must be writable") as error:
        Bus("run")
    assert "Unable to create POSIX shm segment: OS error 30;" in str(error.value)
    assert "port" not in str(error.value)


@linux_only
def test_a_closed_session_leaves_no_descriptor_and_no_shared_memory() -> None:
    def use(name: str) -> Bus:
        with closing(Bus(name)) as bus:
            bus.put("truth/state/AAL123", b"{}")
            bus.keep("clock", b"{}")
            bus.hear("command/*", lambda key, payload: None)
            bus.watch_workers(lambda name, alive: None)
        return bus

    use("first")  # Zenoh keeps threads and their descriptors for the sessions to come.
    before = held()
    closed = [use(f"run-{number}") for number in range(5)]
    after = held()  # Sessions of other tests may have ended meanwhile.
    assert after.descriptors <= before.descriptors
    assert after.shared_memory <= before.shared_memory
    assert len(closed) == 5


def test_a_closed_session_keeps_nobody_who_listened() -> None:
    class Listener:
        def note(self, name: str, is_there: bool = False) -> None:
            """Take no note."""

        def answer(self, key: str, data: bytes, answer: Answer) -> None:
            """Give no answer."""

    def listened() -> ReferenceType[Listener]:
        listener = Listener()
        with closing(Bus("left")) as bus:
            bus.watch_workers(listener.note)
            bus.watch_holders(lambda key, _: listener.note(key))
            bus.answer("seat/*/do", listener.answer)
            bus.hear("command/*", lambda key, _: listener.note(key, True))
        return ref(listener)

    kept = listened()
    gc.collect()
    assert kept() is None


def test_a_subscriber_gets_what_is_made_for_it_and_not_what_cannot_be_made() -> None:
    def fail() -> Never:
        raise RendererError("it has ended")

    heard: queue.SimpleQueue[bytes] = queue.SimpleQueue()
    with closing(Bus("run")) as bus, connect_client(bus.endpoint, 5.0) as client:
        client.declare_subscriber(
            f"{bus.prefix}/camera", lambda sample: heard.put(sample.payload.to_bytes())
        )
        bus.put("camera", b"")
        deadline = time.monotonic() + 5.0
        while not bus._publishers["camera"].matching_status.matching:  # type: ignore[attr-defined]
            assert time.monotonic() < deadline, "Zenoh knows of no subscriber"
            time.sleep(0.01)
        bus.put("camera", DeferredBytes(1, fail))
        bus.put("camera", DeferredBytes(2, lambda: b"ok"))
        received = [heard.get(timeout=5.0)]
        if received == [b""]:  # It was there before the first message.
            received = [heard.get(timeout=5.0)]
    assert received == [b"ok"]


def test_a_worker_is_not_called_with_a_picture_that_cannot_be_drawn() -> None:
    def fail() -> Never:
        raise RendererError("it has ended")

    picture = Input.of("camera/tower/frame", 0, DeferredBytes(1, fail))
    with closing(Bus("run")) as bus:
        step = RemoteWorker(bus, "vision", 1.0).dispatch(0, 0, [picture])
        with pytest.raises(WorkerLost, match="it has ended"):
            step.result()


def test_a_client_that_is_told_no_endpoint_asks_for_one_or_for_keys() -> None:
    with pytest.raises(BusError, match="no endpoint of a run; expected one, such as tcp/127"):
        connect_client(None, patience_s=0.0)
