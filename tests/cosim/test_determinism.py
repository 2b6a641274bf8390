"""The same scenario, seed and latency source give the same bytes."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest
import zenoh

from airhilt import run
from airhilt.bus.session import close_session, connect_client, find_run, free_endpoint
from airhilt.cosim.observer import Observer, Snapshot
from airhilt.cosim.replay import replay
from airhilt.scenario import Scenario
from airhilt.scenario.models.radio import ReceiverRadio
from breadth import mostly_slow
from shortened import shortened


@pytest.fixture(scope="module")
def brief(encounter: Scenario) -> Scenario:
    """The encounter with its first call and the first warnings."""
    return Scenario.model_validate(shortened(encounter.model_dump(mode="json"), 12.0))


def log_of(scenario: Scenario, out: Path, **options: Any) -> bytes:
    return (run(scenario, out=out, **options).folder / "log.mcap").read_bytes()


@pytest.fixture(scope="module")
def first(brief: Scenario, tmp_path_factory: pytest.TempPathFactory) -> bytes:
    """The log with a seed and fixed latencies."""
    return log_of(brief, tmp_path_factory.mktemp("first") / "run", seed=3, latency="fixed")


def test_the_same_seed_gives_the_same_log(first: bytes, brief: Scenario, tmp_path: Path) -> None:
    assert log_of(brief, tmp_path / "b", seed=3, latency="fixed") == first


def test_a_viewer_who_comes_late_and_reads_everything_does_not_change_the_log(
    first: bytes, brief: Scenario, tmp_path: Path
) -> None:
    """The viewer asks for the newest of what is published once."""
    endpoint = free_endpoint()
    found: list[str] = []
    sessions: list[zenoh.Session] = []

    class Late(Observer):
        def snapshot(self, snapshot: Snapshot) -> None:
            if not found and snapshot.t_s >= 4.0:
                session = connect_client(endpoint, 10.0)
                prefix = find_run(session, 10.0)
                session.declare_subscriber(f"{prefix}/**", lambda _: found.append("heard"))
                kept = session.get(f"{prefix}/briefing", timeout=5.0)
                found.extend(str(each.ok.key_expr).removeprefix(prefix) for each in kept if each.ok)
                sessions.append(session)

    viewed = log_of(
        brief, tmp_path / "b", seed=3, latency="fixed", endpoint=endpoint, observer=Late()
    )
    for session in sessions:
        close_session(session)
    assert viewed == first
    assert {"/briefing", "heard"} <= set(found)


def test_another_seed_gives_another_log(first: bytes, brief: Scenario, tmp_path: Path) -> None:
    assert log_of(brief, tmp_path / "b", seed=4, latency="fixed") != first


def test_another_process_with_another_hash_seed_gives_the_same_log(
    brief: Scenario, tmp_path: Path
) -> None:
    here = log_of(brief, tmp_path / "here", latency="lognormal")
    out, file = tmp_path / "there", tmp_path / "brief.json"
    file.write_text(brief.model_dump_json())
    subprocess.run(
        [sys.executable, "-m", "airhilt", "cosim", "--scenario", file,
         "--latency", "lognormal", "--out", out, "--json"],
        env={**os.environ, "PYTHONHASHSEED": "1"},
        capture_output=True,
        check=True,
    )  # fmt: skip
    assert (out / "log.mcap").read_bytes() == here


@pytest.mark.parametrize(("snr_db", "is_same"), [(60.0, True), (-5.0, False)])
def test_receivers_change_the_log_only_where_they_are_worse_than_the_calls(
    brief: Scenario, tmp_path: Path, snr_db: float, is_same: bool
) -> None:
    listeners = {name for line in brief.radio.lines for name in (line.speaker, line.to) if name}
    receivers = dict.fromkeys(listeners, ReceiverRadio(snr_db=snr_db))
    radio = brief.radio.model_copy(update={"snr_db": 3.0})
    given = radio.model_copy(update={"receivers": receivers})
    without, with_them = (
        log_of(
            brief.model_copy(update={"radio": each}), tmp_path / name,
            latency="fixed", assistant="none", speech=False,
        )
        for name, each in (("without", radio), ("with", given))
    )  # fmt: skip
    assert (with_them == without) == is_same


def test_pace_does_not_change_the_log(first: bytes, brief: Scenario, tmp_path: Path) -> None:
    assert log_of(brief, tmp_path / "b", seed=3, latency="fixed", pace="40x") == first


def test_the_log_knows_nothing_of_names_and_folders(
    first: bytes, brief: Scenario, tmp_path: Path
) -> None:
    named = log_of(brief, tmp_path / "b", seed=3, latency="fixed", run_name="two")
    assert named == first


@pytest.mark.parametrize("latency", mostly_slow(["measured", "lognormal"], "measured"))
def test_a_replay_is_identical(brief: Scenario, tmp_path: Path, latency: str) -> None:
    folder = run(brief, out=tmp_path / "run", latency=latency).folder
    verdict = replay(folder)
    assert verdict.identical, verdict
    assert verdict.messages > 100


def test_a_replay_of_a_changed_log_says_where_it_differs(brief: Scenario, tmp_path: Path) -> None:
    folder = run(brief, out=tmp_path / "run", latency="fixed").folder
    other = run(brief, out=tmp_path / "other", latency="fixed", seed=5).folder
    (folder / "log.mcap").write_bytes((other / "log.mcap").read_bytes())
    verdict = replay(folder)
    assert not verdict.identical
    assert "truth/state/" in verdict.difference
    assert "0.000 s" in verdict.difference
