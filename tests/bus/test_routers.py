"""A router of the lab's own lies between runs and their programs, in a process of its own."""

from __future__ import annotations

import json
from collections.abc import Iterator
from contextlib import AbstractContextManager, closing
from pathlib import Path
from typing import Any

import pytest

from airhilt import run
from airhilt.bus.certificates import key_file, make_keys
from airhilt.bus.session import Bus, close_session, connect_client, find_run, free_endpoint
from airhilt.cosim.observer import Observer, Snapshot
from airhilt.errors import BusError
from airhilt.scenario import Scenario
from processes import process
from routers import router

OPTIONS: dict[str, Any] = {"latency": "fixed", "speech": False}


@pytest.fixture(scope="module")
def brief(encounter: Scenario) -> Scenario:
    return encounter.model_copy(update={"duration_s": 6.0})


@pytest.fixture(scope="module")
def log(brief: Scenario, tmp_path_factory: pytest.TempPathFactory) -> bytes:
    """The log of the run whose worker is in its process."""
    out = tmp_path_factory.mktemp("inside") / "run"
    return (run(brief, out=out, **OPTIONS).folder / "log.mcap").read_bytes()


def test_a_worker_attaches_through_a_router(brief: Scenario, tmp_path: Path, log: bytes) -> None:
    at, lab = free_endpoint(), free_endpoint()
    with router(lab, [at]), process("-m", "airhilt", "worker", "decision", "--connect", lab) as own:
        folder = run(brief, out=tmp_path / "run", endpoint=at, attach=("decision",), **OPTIONS)
        assert own.wait(timeout=30.0) == 0
    assert (folder.folder / "log.mcap").read_bytes() == log


def test_all_behind_a_router_have_the_role_of_its_certificate(
    brief: Scenario, tmp_path: Path, log: bytes
) -> None:
    """The router itself asks programs of its own machine for nothing."""
    at, lab, keys = free_endpoint().replace("tcp/", "tls/"), free_endpoint(), tmp_path / "keys"
    make_keys(keys, at)
    transport = json.loads(key_file(keys, "worker").read_text())["transport"]
    with (
        router(lab, [at], transport),
        process("-m", "airhilt", "worker", "decision", "--connect", lab) as own,
    ):
        folder = run(brief, out=tmp_path / "run", tls=keys, attach=("decision",), **OPTIONS)
        assert own.wait(timeout=30.0) == 0
    assert (folder.folder / "log.mcap").read_bytes() == log


class Cuts(Observer):
    """Ends a router in the middle of a run, and starts it again."""

    def __init__(self, start: Iterator[AbstractContextManager[Any]]) -> None:
        self._start = start
        self._router = next(start)
        self._router.__enter__()
        self.cuts = 0

    def snapshot(self, snapshot: Snapshot) -> None:
        if snapshot.t_s >= 2.0 and not self.cuts:
            self.cuts += 1
            self.end()
            self._router = next(self._start)
            self._router.__enter__()

    def end(self) -> None:
        self._router.__exit__(None, None, None)


def test_a_worker_that_a_router_comes_back_to_has_missed_nothing(
    brief: Scenario, tmp_path: Path, log: bytes
) -> None:
    at, lab = free_endpoint(), free_endpoint()
    cuts = Cuts(router(lab, [at]) for _ in range(2))
    with process("-m", "airhilt", "worker", "decision", "--connect", lab) as own:
        folder = run(
            brief, out=tmp_path / "run", endpoint=at, attach=("decision",), observer=cuts, **OPTIONS
        )
        assert own.wait(timeout=30.0) == 0
    cuts.end()
    assert cuts.cuts == 1
    assert (folder.folder / "log.mcap").read_bytes() == log


def test_two_runs_on_one_router_are_told_apart_by_name(tmp_path: Path) -> None:
    with closing(Bus("one")) as one, closing(Bus("two")) as two:
        for bus in (one, two):
            bus.keep("clock", b"{}")
        lab = free_endpoint()
        with router(lab, [one.endpoint, two.endpoint]):
            session = connect_client(lab, 30.0)
            try:
                for name in ("one", "two"):
                    assert find_run(session, 30.0, name) == f"airhilt/{name}"
                with pytest.raises(BusError, match="one, two; expected the name of one"):
                    find_run(session, 30.0)
            finally:
                close_session(session)
            with process("-m", "airhilt", "worker", "decision", "--connect", lab) as unsure:
                assert unsure.wait(timeout=60.0) == 2
