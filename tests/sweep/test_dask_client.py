"""What the client of a sweep does with a scheduler that is not as it should be."""

from __future__ import annotations

import time
from collections.abc import Iterator
from typing import Any

import pytest

from airhilt.errors import AirhiltError
from airhilt.sweep.clusters import FAMILY, ClusterError, openness
from airhilt.sweep.dask_client import Workers, prepared
from airhilt.sweep.dask_worker import RunnerPlugin
from airhilt.sweep.environment import Environment
from airhilt.sweep.runner_process import Limits

ENVIRONMENT = Environment(versions={"airhilt": "1"}, code_sha256="0" * 64, renderer="")
DASK = {"dask": "2026.8.0", "distributed": "2026.8.0"}


class FakeClient:
    """A client of a scheduler with some workers and some versions."""

    status = "running"

    class scheduler:  # noqa: N801 - as the attribute of Dask's
        address = "tcp://head:8786"

    def __init__(self, threads: list[int] | None = None, **versions: dict[str, str]) -> None:
        self._threads: Iterator[int] = iter(threads or [])
        self._versions = versions
        self.plugins: list[str] = []

    def nthreads(self) -> dict[str, int]:
        count = next(self._threads)
        if count < 0:
            raise OSError("gone")
        return {"tcp://w:1": count} if count else {}

    def get_versions(self) -> dict[str, Any]:
        workers = {"tcp://w:1": {"packages": DASK | self._versions.get("worker", {})}}
        scheduler = {"packages": DASK | self._versions.get("scheduler", {})}
        return {"client": {"packages": DASK}, "scheduler": scheduler, "workers": workers}

    def register_plugin(self, plugin: RunnerPlugin) -> None:
        self.plugins.append(plugin.name)

    def unregister_worker_plugin(self, name: str) -> None:
        self.plugins.remove(name)


@pytest.fixture
def no_waiting(monkeypatch: pytest.MonkeyPatch) -> None:
    """Count at once, and tell after the second look."""
    clock = iter(range(1000))
    monkeypatch.setattr(time, "monotonic", lambda: float(next(clock)) * 4.0)
    monkeypatch.setattr(time, "sleep", lambda _: None)


def client(*threads: int, **versions: dict[str, str]) -> Any:
    return FakeClient(list(threads), **versions)


def plugin() -> RunnerPlugin:
    return RunnerPlugin("", Limits(1.0, 1.0), ENVIRONMENT)


def test_a_scheduler_without_workers_is_told_once_a_minute(no_waiting: None) -> None:
    notices: list[str] = []
    workers = Workers(client(*[0] * 30, 2), notices.append)
    workers.wait(lambda: False)
    text = "scheduler tcp://head:8786 has no workers; waiting for one, Ctrl-C stops"
    assert notices == [text] * 2


def test_workers_that_come_at_once_are_not_talked_about(no_waiting: None) -> None:
    notices: list[str] = []
    workers = Workers(client(0, 3), notices.append)
    workers.wait(lambda: False)
    assert notices == []


def test_the_user_need_not_wait_for_workers(no_waiting: None) -> None:
    Workers(client(), lambda _: None).wait(lambda: True)


def test_a_scheduler_that_goes_is_lost(no_waiting: None) -> None:
    with pytest.raises(ClusterError, match="tcp://head:8786 is lost; what was finished is kept"):
        Workers(client(-1), lambda _: None).threads()


@pytest.mark.parametrize(
    ("where", "name"), [("scheduler", "scheduler tcp://head:8786"), ("worker", "worker tcp://w:1")]
)
def test_another_version_of_dask_is_refused_by_name(where: str, name: str) -> None:
    other = client(**{where: {"distributed": "2020.1.0"}})
    with (
        pytest.raises(ClusterError, match=f"{name} has distributed 2020.1.0, and this process"),
        prepared(other, plugin()),
    ):
        pass
    assert other.plugins == []


@pytest.mark.parametrize(
    ("where", "is_told"),
    [
        ("tcp://10.1.2.3:8786", True),
        ("ws://head:8786", True),
        ("tls://head:8786", False),
        ("tcp://127.0.0.1:8786", False),
        ("tcp://[::1]:8786", False),
    ],
)
def test_a_scheduler_that_a_whole_network_reaches_is_told(where: str, is_told: bool) -> None:
    assert ("no TLS" in openness(where)) is is_told


def test_nothing_of_a_sweep_stays_on_the_workers() -> None:
    fake = client()
    with prepared(fake, plugin()):
        assert len(fake.plugins) == 1
    assert fake.plugins == []


def test_two_sweeps_do_not_take_each_others_runners() -> None:
    assert plugin().name != plugin().name


def test_a_scheduler_that_is_not_there_is_told(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("airhilt.sweep.clusters.address.TIMEOUT_S", 0.1)
    cluster = FAMILY.create("tcp://127.0.0.1:1")
    with (
        pytest.raises(AirhiltError, match=r"scheduler tcp://127\.0\.0\.1:1: not there"),
        cluster.connect(1, None),
    ):
        pass
