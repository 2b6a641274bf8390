"""A run on loopback keeps programs to what they may do, and believes no answer of a stranger."""

from __future__ import annotations

import itertools
import queue
import time
from collections.abc import Callable, Iterator
from contextlib import closing
from typing import Any

import pytest
import zenoh

from airhilt.bus.access import ROLES
from airhilt.bus.remote_workers import RemoteWorker
from airhilt.bus.session import Bus, connect_client
from airhilt.errors import WorkerError
from airhilt.messages import InputSpec, StepReply, WorkerDescription

DESCRIPTION = WorkerDescription(name="own", modality="decision", inputs=(InputSpec(key="adsb/*"),))


@pytest.fixture
def bus() -> Iterator[Bus]:
    with closing(Bus("run")) as opened:
        yield opened


@pytest.fixture
def client(bus: Bus) -> Iterator[Callable[[], zenoh.Session]]:
    """Return new sessions with the run, as programs of other processes have them."""
    sessions: list[zenoh.Session] = []

    def connect() -> zenoh.Session:
        sessions.append(connect_client(bus.endpoint, 5.0))
        return sessions[-1]

    yield connect
    for session in sessions:
        session.close()  # type: ignore[no-untyped-call]


def received(session: zenoh.Session, publish: Callable[[], None]) -> str:
    """Return the first key that a subscriber to everything receives of what is published."""
    got: queue.Queue[str] = queue.Queue()
    subscriber: Any = session.declare_subscriber("**", lambda sample: got.put(str(sample.key_expr)))
    for _ in range(200):
        publish()
        try:
            return got.get(timeout=0.05)
        except queue.Empty:
            continue
    subscriber.undeclare()
    raise AssertionError("nothing was received")


def answer(session: zenoh.Session, name: str, *, complete: bool = False) -> list[Any]:
    """Let a session answer as the worker ``own``, in whose steps it asks to be woken."""
    key = f"airhilt/run/worker/{DESCRIPTION.name}"

    def describe(query: zenoh.Query) -> None:
        with query:
            query.reply(f"{key}/describe", DESCRIPTION.model_dump_json())

    def step(query: zenoh.Query) -> None:
        with query:
            if name == "failing rogue":
                query.reply_err(b"failed")
                return
            wake_ns = 1 if name == "own" else 2
            header = StepReply(seq=0, compute_s=0.0, wake_ns=wake_ns).model_dump_json()
            query.reply(f"{key}/step", b"", attachment=header)

    return [
        session.declare_queryable(f"{key}/describe", describe, complete=complete),
        session.declare_queryable(f"{key}/step", step, complete=complete),
    ]


def described(worker: RemoteWorker) -> bool:
    for _ in range(500):
        if worker.describe(timeout_s=1.0) is not None:
            return True
        time.sleep(0.02)
    return False


def test_truth_reaches_no_program_unless_it_is_shared(
    bus: Bus, client: Callable[[], zenoh.Session]
) -> None:
    def publish(bus: Bus) -> None:
        bus.put("truth/conflict", b"{}")
        bus.put("adsb/a1b2c3", b"{}")

    assert received(client(), lambda: publish(bus)) == "airhilt/run/adsb/a1b2c3"
    with closing(Bus("run", anyone=ROLES)) as shared:
        session: Any = connect_client(shared.endpoint, 5.0)
        key = received(session, lambda: shared.put("truth/conflict", b"{}"))
        assert key == "airhilt/run/truth/conflict"
        session.close()


def test_a_program_cannot_publish_what_is_of_the_run(client: Callable[[], zenoh.Session]) -> None:
    forger = client()

    def forge() -> None:
        for key in ("adsb/a1b2c3", "clock", "truth/conflict", "worker/own", "advisory/ATC"):
            forger.put(f"airhilt/run/{key}", b"{}")

    assert received(client(), forge) == "airhilt/run/advisory/ATC"


def test_a_program_cannot_end_the_run_for_its_workers(client: Callable[[], zenoh.Session]) -> None:
    seen: queue.Queue[tuple[str, zenoh.SampleKind]] = queue.Queue()
    subscriber = client().liveliness().declare_subscriber(
        "airhilt/run/**", lambda each: seen.put((str(each.key_expr), each.kind)), history=True
    )  # fmt: skip
    rogue = client().liveliness()
    for key in ("run", "worker/rogue"):
        rogue.declare_token(f"airhilt/run/{key}").undeclare()  # type: ignore[no-untyped-call]
    told = [seen.get(timeout=5.0) for _ in range(3)]
    assert sorted(told, key=str) == [
        ("airhilt/run/run", zenoh.SampleKind.PUT),
        ("airhilt/run/worker/rogue", zenoh.SampleKind.DELETE),
        ("airhilt/run/worker/rogue", zenoh.SampleKind.PUT),
    ]
    del subscriber


@pytest.mark.parametrize("rogue", ["rogue", "failing rogue"])
def test_an_answer_of_another_program_is_ignored_and_named(
    bus: Bus, client: Callable[[], zenoh.Session], rogue: str
) -> None:
    """Zenoh would ask the rogue alone, because it says that its answers are complete."""
    worker = RemoteWorker(bus, "own", 5.0)
    kept = answer(client(), "own")
    assert described(worker)
    stranger = client()
    kept += answer(stranger, rogue, complete=True)
    refused: list[tuple[str, str]] = []
    bus.refused = lambda *refusal: refused.append(refusal)
    for _ in itertools.takewhile(lambda _: not refused, range(1000)):
        assert worker.dispatch(0, 0, []).result().wake_ns == 1
    assert {key for key, _ in refused} == {"worker/own/step"}
    assert f"Zenoh id {stranger.info.zid()}" in refused[0][1]


def test_two_programs_that_answer_as_one_worker_are_refused(
    bus: Bus, client: Callable[[], zenoh.Session]
) -> None:
    worker = RemoteWorker(bus, "own", 5.0)
    kept = answer(client(), "own")
    assert described(worker)
    kept += answer(client(), "rogue")
    with pytest.raises(WorkerError, match="2 programs answer as worker 'own'"):
        any(worker.describe(timeout_s=1.0) is None for _ in range(1000))


def test_a_program_that_answers_every_key_is_not_asked(
    bus: Bus, client: Callable[[], zenoh.Session]
) -> None:
    stranger = client()

    def lie(query: zenoh.Query) -> None:
        with query:
            query.reply(query.key_expr, b"{}")

    kept = [stranger.declare_queryable("airhilt/**", lie, complete=True)]
    kept += answer(client(), "own")
    worker = RemoteWorker(bus, "own", 5.0)
    assert described(worker)
    assert worker.dispatch(0, 0, []).result().wake_ns == 1
