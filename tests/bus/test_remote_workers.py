"""Workers in other processes: real processes, real Zenoh."""

from __future__ import annotations

import itertools
import json
import signal
import subprocess
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import pytest

from airhilt import run
from airhilt.bus import free_endpoint
from airhilt.cosim.observer import Observer, Snapshot
from airhilt.cosim.replay import replay
from airhilt.errors import RunStopped, WorkerError
from airhilt.record import RunFolder, read_log
from airhilt.scenario import Scenario
from breadth import mostly_slow
from paths import EXAMPLES
from processes import ActsAt, process


@pytest.fixture(scope="module")
def brief(encounter: Scenario) -> Scenario:
    """The encounter until both crews were warned."""
    return encounter.model_copy(update={"duration_s": 6.0})


@contextmanager
def decision_worker(endpoint: str) -> Iterator[subprocess.Popen[bytes]]:
    with process("-m", "airhilt", "worker", "decision", "--connect", endpoint) as started:
        yield started


def test_a_worker_in_another_process_gives_the_same_log(
    encounter: Scenario, tmp_path: Path
) -> None:
    inside = run(encounter, out=tmp_path / "inside", latency="fixed").folder
    endpoint = free_endpoint()
    with decision_worker(endpoint) as worker:
        outside = run(
            encounter, out=tmp_path / "outside", latency="fixed", endpoint=endpoint,
            attach=("decision",),
        ).folder  # fmt: skip
        assert worker.wait(timeout=10.0) == 0
    assert (outside / "log.mcap").read_bytes() == (inside / "log.mcap").read_bytes()
    assert RunFolder(outside).info().workers[0].where == "attached"
    assert replay(outside).identical


@pytest.mark.slow
def test_a_worker_that_wakes_by_itself_is_replayed(encounter: Scenario, tmp_path: Path) -> None:
    """In an outage the decision worker carries conflicts on, called by its own alarm."""
    adsb = encounter.adsb.model_copy(update={"outages_s": ((8.0, 20.0),)})
    deaf = tuple(
        actor.model_copy(update={"pilot": actor.pilot.model_copy(update={"compliance": 0.0})})
        for actor in encounter.actors
    )
    scenario = encounter.model_copy(update={"adsb": adsb, "actors": deaf})
    endpoint = free_endpoint()
    with decision_worker(endpoint):
        folder = run(
            scenario,
            out=tmp_path / "run",
            speech=False,
            latency="fixed",
            endpoint=endpoint,
            attach=("decision",),
        ).folder
    steps = [json.loads(line) for line in (folder / "latency.jsonl").read_text().splitlines()]
    woken = [s for s in steps if s["worker"] == "decision" and 9e9 < s["t_start_ns"] < 20e9]
    assert len(woken) >= 8
    told_s = [x.t_ns / 1e9 for x in read_log(folder / "log.mcap") if x.key == "advisory/ATC"]
    assert max(told_s) > 20.0, "something is said after the outage, by a later step"
    assert replay(folder).identical


@pytest.mark.slow
@pytest.mark.parametrize("strict", [False, True])
def test_a_program_without_grants_that_dies_is_noticed_too(
    encounter: Scenario, tmp_path: Path, strict: bool
) -> None:
    class Kills(Observer):
        def snapshot(self, snapshot: Snapshot) -> None:
            if snapshot.t_s >= 2.0 and program.poll() is None:
                program.kill()
                program.wait()
                time.sleep(0.3)

    short = encounter.model_copy(update={"duration_s": 4.0})
    endpoint = free_endpoint()
    options: dict[str, Any] = {
        "endpoint": endpoint,
        "attach": ("plain",),
        "strict": strict,
        "observer": Kills(),
    }
    with process(EXAMPLES / "plain_zenoh_worker.py", endpoint) as program:
        if strict:
            with pytest.raises(RunStopped, match="plain"):
                run(short, out=tmp_path / "run", speech=False, **options)
            return
        result = run(short, out=tmp_path / "run", speech=False, **options)
    assert result.summary.modalities["decision"] == "lost"
    assert replay(result.folder).identical


def test_external_without_anybody_is_no_assistant(brief: Scenario, tmp_path: Path) -> None:
    summary = run(brief, out=tmp_path / "run", speech=False, assistant="external").summary
    assert summary.modalities["decision"] == "off"


@pytest.mark.parametrize(("number", "latency"), mostly_slow(
    itertools.product([signal.SIGKILL, signal.SIGSTOP], ["measured", "fixed"]),
    (signal.SIGKILL, "measured"), (signal.SIGSTOP, "fixed"),
))  # fmt: skip
def test_a_worker_that_dies_or_freezes_is_noticed_and_the_run_goes_on(
    brief: Scenario, tmp_path: Path, latency: str, number: signal.Signals
) -> None:
    endpoint = free_endpoint()
    with decision_worker(endpoint) as worker:
        result = run(
            brief, out=tmp_path / "run", speech=False, latency=latency, endpoint=endpoint,
            attach=("decision",), step_timeout_s=1.0, observer=ActsAt(3.0, worker, number),
        )  # fmt: skip
    assert result.summary.outcome == "finished"
    assert result.summary.modalities["decision"] == "lost"
    assert result.summary.duration_s == pytest.approx(6.0)
    lost = [
        json.loads(logged.data)
        for logged in read_log(result.folder / "log.mcap")
        if logged.key == "status/decision"
    ][-1]
    assert lost["state"] == "lost"
    assert "decision" in lost["cause"]
    assert 3e9 <= lost["t_ns"] < 5e9
    assert replay(result.folder).identical


def test_strict_stops_with_the_cause(brief: Scenario, tmp_path: Path) -> None:
    endpoint = free_endpoint()
    with (
        decision_worker(endpoint) as worker,
        pytest.raises(RunStopped, match=r"--strict asks: worker 'decision'"),
    ):
        run(
            brief, out=tmp_path / "run", speech=False, endpoint=endpoint, attach=("decision",),
            strict=True, observer=ActsAt(3.0, worker, signal.SIGKILL),
        )  # fmt: skip
    info = RunFolder(tmp_path / "run").info()
    assert info.phase == "stopped"
    assert "decision" in info.cause


@pytest.mark.slow
def test_the_example_on_the_sdk_works(encounter: Scenario, tmp_path: Path) -> None:
    endpoint = free_endpoint()
    with process(EXAMPLES / "sdk_worker.py", endpoint) as worker:
        result = run(
            encounter, out=tmp_path / "run", speech=False, endpoint=endpoint, attach=("simple",)
        )
        assert worker.wait(timeout=10.0) == 0
    assert result.summary.assistant == "external"
    assert [told.id for told in result.summary.advisories] == ["simple-a1b2c3-a4d5e6"]
    assert replay(result.folder).identical


def test_the_example_in_plain_zenoh_makes_the_run_real_time_and_counts(
    encounter: Scenario, tmp_path: Path
) -> None:
    short = encounter.model_copy(update={"duration_s": 4.0})
    endpoint = free_endpoint()
    with process(EXAMPLES / "plain_zenoh_worker.py", endpoint):
        result = run(
            short, out=tmp_path / "run", speech=False, endpoint=endpoint, attach=("plain",)
        )
    assert RunFolder(result.folder).info().pace == "realtime"
    assert RunFolder(result.folder).info().unregistered_programs
    assert [told.id for told in result.summary.advisories] == ["plain-1"]
    assert replay(result.folder).identical


BAD_WORKER = """
import json, sys, zenoh
from airhilt.bus.session import configuration
import time
endpoint, answer = sys.argv[1:]
while True:
    try:
        session = zenoh.open(configuration("client", "connect", endpoint))
        break
    except zenoh.ZError:
        time.sleep(0.05)
run = next(iter(session.get("airhilt/*/clock"))).ok
key = str(run.key_expr).removesuffix("clock") + "worker/bad"
description = {"name": "bad", "modality": "decision", "inputs": [{"key": "adsb/*"}]}
def describe(query):
    with query:
        query.reply(key + "/describe", json.dumps(description))
def step(query):
    with query:
        grant = json.loads(query.attachment.to_bytes())
        reply = {"seq": grant["seq"], "compute_s": 0.0, "outputs": []}
        payload = b""
        if answer == "garbage":
            query.reply(key + "/step", b"garbage", attachment=b"garbage")
            return
        if answer == "past":
            payload = b"{}"
            reply["outputs"] = [{"key": "advisory/ATC", "size": 2, "t_out_ns": 0}]
        if answer == "truth":
            payload = b"{}"
            reply["outputs"] = [{"key": "truth/conflict", "size": 2}]
        if answer == "large":
            payload = b" " * 40_000
            reply["outputs"] = [{"key": "advisory/ATC", "size": 40_000}]
        if answer == "seq":
            reply["seq"] += 1
        query.reply(key + "/step", payload, attachment=json.dumps(reply))
a = session.declare_queryable(key + "/describe", describe)
b = session.declare_queryable(key + "/step", step)
token = session.liveliness().declare_token(key)
time.sleep(60)
"""


@pytest.mark.parametrize(("answer", "said"), mostly_slow(
    [
        ("garbage", "Invalid JSON"),
        ("past", "before its step began"),
        ("truth", "published on 'truth/conflict'"),
        ("large", "40,000 bytes; expected at most 32,000"),
        ("seq", "expected the seq of the grant"),
    ],
    ("garbage", "Invalid JSON"), ("truth", "published on 'truth/conflict'"),
))  # fmt: skip
def test_a_worker_that_breaks_the_contract_ends_the_run_with_its_name(
    encounter: Scenario, tmp_path: Path, answer: str, said: str
) -> None:
    endpoint = free_endpoint()
    with process("-c", BAD_WORKER, endpoint, answer), pytest.raises(WorkerError) as caught:
        run(encounter, out=tmp_path / "run", speech=False, endpoint=endpoint, attach=("bad",))
    assert "'bad'" in str(caught.value)
    assert said in str(caught.value)
    assert "\n" not in str(caught.value)
    folder = RunFolder(tmp_path / "run")
    assert folder.info().phase == "stopped"
    assert (folder.summary() or {})["outcome"].startswith("stopped: worker 'bad'")


ODD_WORKER = """
import sys
from airhilt.messages import InputSpec, WorkerDescription
from airhilt.workers import Step, serve
class Odd:
    description = WorkerDescription(
        name="odd", modality="decision", inputs=(InputSpec(key="adsb/*"),)
    )
    def step(self, t_ns, inputs):
        return Step(("x",))
serve(Odd(), sys.argv[1])
"""


def test_a_worker_of_the_sdk_whose_step_has_a_part_of_another_type_is_lost(
    encounter: Scenario, tmp_path: Path
) -> None:
    endpoint = free_endpoint()
    short = encounter.model_copy(update={"duration_s": 3.0})
    with process("-c", ODD_WORKER, endpoint):
        result = run(short, out=tmp_path / "run", speech=False, endpoint=endpoint, attach=("odd",))
    assert result.summary.outcome == "finished"
    (lost,) = [
        json.loads(logged.data)["cause"]
        for logged in read_log(result.folder / "log.mcap")
        if logged.key == "status/decision" and json.loads(logged.data)["state"] == "lost"
    ]
    assert "worker 'odd' returned 'x' among its outputs; expected airhilt.workers.Output" in lost


@pytest.mark.skipif(not Path("/proc/net/tcp").exists(), reason="needs /proc")
@pytest.mark.parametrize("is_open", [True, False])
def test_a_run_listens_on_loopback_only_and_where_nobody_is_to_join_nowhere(
    brief: Scenario, tmp_path: Path, is_open: bool
) -> None:
    seen: set[str] = set()

    class Looks(Observer):
        def snapshot(self, snapshot: Snapshot) -> None:
            seen.update(listening_addresses())

    run(
        brief, out=tmp_path / "run", speech=False, latency="fixed", observer=Looks(),
        endpoint=free_endpoint() if is_open else None,
    )  # fmt: skip
    assert seen == ({"127.0.0.1"} if is_open else set())


def listening_addresses() -> set[str]:
    """Return the IPv4 and IPv6 addresses on which this process listens."""
    inodes = set()
    for link in Path("/proc/self/fd").iterdir():
        target = str(link.readlink()) if link.is_symlink() else ""
        if target.startswith("socket:["):
            inodes.add(target[8:-1])
    found = set()
    for table in ("tcp", "tcp6"):
        for line in Path("/proc/net", table).read_text().splitlines()[1:]:
            fields = line.split()
            if fields[3] == "0A" and fields[9] in inodes:
                raw = bytes.fromhex(fields[1].split(":")[0])
                found.add(".".join(map(str, reversed(raw))) if len(raw) == 4 else raw.hex())
    return found


def test_a_command_from_outside_moves_an_aircraft(encounter: Scenario, tmp_path: Path) -> None:
    import zenoh

    from airhilt.bus.session import configuration

    class Commands(Observer):
        def __init__(self) -> None:
            self.session: zenoh.Session | None = None

        def snapshot(self, snapshot: Snapshot) -> None:
            if self.session is None:
                config = configuration("client", "connect", endpoint)
                self.session = zenoh.open(config)
                command = {"command": {"action": "altitude", "altitude_ft": 33000.0}}
                for name, payload in (("AAL123", json.dumps(command)), ("DAL456", "climb!")):
                    self.session.put(f"airhilt/encounter-0/command/{name}", payload)
                self.session.put("airhilt/encounter-0/tts/a-1", b"\0\0")
                time.sleep(0.3)

    endpoint = free_endpoint()
    commands = Commands()
    short = encounter.model_copy(update={"duration_s": 3.0})
    try:
        result = run(
            short,
            out=tmp_path / "run",
            speech=False,
            endpoint=endpoint,
            assistant="none",
            observer=commands,
        )
    finally:
        if commands.session is not None:
            commands.session.close()  # type: ignore[no-untyped-call]
    logged = list(read_log(result.folder / "log.mcap"))
    targets = [
        json.loads(x.data)["target_altitude_m"]
        for x in logged
        if x.key.endswith("AAL123") and x.key.startswith("truth/state")
    ]
    assert targets[-1] == pytest.approx(33000 * 0.3048)
    events = [json.loads(x.data) for x in logged if x.key == "truth/event"]
    assert "unregistered" in {event["kind"] for event in events}
    # Messages on different keys come in any order.
    refused = {event["subject"] for event in events if event["kind"] == "refused"}
    assert refused == {"command/DAL456", "tts/a-1"}
    verdict = replay(result.folder)
    assert verdict.identical, verdict.difference
