"""What the client of a sweep does with a scheduler that is not as it should be."""

from __future__ import annotations

import time
from concurrent.futures import CancelledError
from types import SimpleNamespace
from typing import Any

import pytest
from distributed import KilledWorker

from airhilt.errors import AirhiltError
from airhilt.sweep.dask_executor import IN_HAND_PER_THREAD, Workers, outcomes, prepared
from airhilt.sweep.dask_worker import RunnerPlugin
from airhilt.sweep.environment import Environment
from airhilt.sweep.outcome import Outcome, Request
from airhilt.sweep.runner_process import Limits
from airhilt.sweep.scheduler import SchedulerError
from fake_dask import FakeClient, FakeFuture
from runners import request

ENVIRONMENT = Environment(versions={"airhilt": "1"}, code_sha256="0" * 64, renderer="")


@pytest.fixture
def no_waiting(monkeypatch: pytest.MonkeyPatch) -> None:
    """Count at once, and tell after the second look."""
    clock = iter(range(1000))
    monkeypatch.setattr(time, "monotonic", lambda: float(next(clock)) * 4.0)
    monkeypatch.setattr(time, "sleep", lambda _: None)


def client(*threads: int) -> Any:
    return FakeClient(list(threads) or [1])


def plugin() -> RunnerPlugin:
    return RunnerPlugin("", Limits(1.0, 1.0), ENVIRONMENT)


def test_a_scheduler_without_workers_is_told_once(no_waiting: None) -> None:
    notices: list[str] = []
    workers = Workers(client(*[0] * 30, 2), notices.append)
    workers.wait(lambda: False)
    text = "scheduler tcp://head:8786 has no workers; waiting for one, Ctrl-C stops"
    assert notices == [text]
    Workers(client(0, 3), notices.append).wait(lambda: False)
    assert len(notices) == 1, "of workers that come at once nothing is told"


def test_a_scheduler_that_goes_is_lost(no_waiting: None) -> None:
    with pytest.raises(SchedulerError, match="tcp://head:8786 is lost; what was finished is kept"):
        Workers(client(-1), lambda _: None).threads()


def test_nothing_of_a_sweep_stays_on_the_workers() -> None:
    fake = client()
    with prepared(fake, plugin()), prepared(fake, plugin()):
        assert len(set(fake.plugins)) == 2, "two sweeps do not take each other's runners"
    assert fake.plugins == []


def ended(fake: Any, count: int = 1, stop_after: int = 1000) -> list[Outcome]:
    """Return the outcomes of some runs; the user stops after some of them."""
    found: list[Outcome] = []
    workers = Workers(fake, lambda _: None)
    asked = [request(str(number)) for number in range(count)]
    for each in outcomes(fake, "plugin", asked, workers, lambda: len(found) >= stop_after):
        found.append(each)
    return found


def test_every_run_has_its_outcome() -> None:
    assert {each.key for each in ended(client(2), 9)} == {str(number) for number in range(9)}


def test_runs_in_hand_finish_and_no_more_are_given_out() -> None:
    fake = client(2)
    assert len(ended(fake, 9, stop_after=1)) == len(fake.submitted) == 2 * IN_HAND_PER_THREAD


def test_a_run_under_which_workers_die_is_its_crash() -> None:
    last: Any = SimpleNamespace(address="tcp://w:7")

    def killed(_: Request) -> FakeFuture:
        return FakeFuture(KilledWorker("task", last, 3), "error")

    (found,) = ended(FakeClient(ends=killed))
    assert (found.key, found.status, found.machine.host) == ("0", "crashed", "tcp://w:7")
    assert found.cause == "workers died under it, the last one at tcp://w:7"


@pytest.mark.parametrize(
    ("error", "status", "told"),
    [
        (OSError(28, "No space left on device"), "error", "a worker cannot run anything: OSError"),
        (AirhiltError("worker tcp://w:1: another version"), "error", "another version"),
        (OSError("connection closed"), "lost", "tcp://head:8786 is lost; what was finished"),
        (CancelledError("0"), "cancelled", "tcp://head:8786 is lost; what was finished"),
    ],
)
def test_what_ends_a_sweep_is_told_as_it_is(error: Exception, status: str, told: str) -> None:
    with pytest.raises(AirhiltError, match=told):
        ended(FakeClient(ends=lambda _: FakeFuture(error, status)))
