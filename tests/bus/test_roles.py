"""With keys, a program joins a run by the certificate of its role, and may do what the role may."""

from __future__ import annotations

import json
import shutil
import stat
import subprocess
import sys
from collections.abc import Iterator, Sequence
from contextlib import closing
from pathlib import Path
from typing import Any

import pytest
import zenoh

from airhilt import run
from airhilt.bus.certificates import HOLDERS, key_file, make_keys
from airhilt.bus.session import Bus, connect_client, free_endpoint
from airhilt.cosim.replay import replay
from airhilt.errors import AirhiltError, BusError
from airhilt.scenario import Scenario
from breadth import mostly_slow
from notices import Notices
from processes import process

TRIES = """
import json, queue, sys, time, zenoh
file, published, heard = sys.argv[1], sys.argv[2].split(), queue.Queue()
session = zenoh.open(zenoh.Config.from_file(file))
everything = session.declare_subscriber("**", lambda sample: heard.put(str(sample.key_expr)))
answers = [
    str(reply.ok.key_expr)
    for key in ("airhilt/*/clock", "airhilt/run/seat/TOWER", "airhilt/run/seat/TOWER/do")
    for reply in session.get(key, timeout=1.0)
    if reply.ok
]
print(json.dumps(answers), flush=True)
for key in published:
    session.put("airhilt/run/" + key, b"{}")
keys = set()
while "airhilt/run/clock" not in keys:  # the run publishes it last
    keys.add(heard.get(timeout=20))
print(json.dumps(sorted(keys)), flush=True)
everything.undeclare()
session.close()
"""
"""Connects as README and docs/workers.md say, asks, publishes, and prints what it has received."""
TRIED = ("advisory/ATC", "command/AAL123", "adsb/a1b2c3", "truth/conflict", "vision/tower")


OF_SEATS = {"seat/TOWER", "seat/TOWER/audio"}
PUBLISHED_BY_RUN = ("truth/state/AAL123", "adsb/d4e5f6", *OF_SEATS, "clock")


@pytest.fixture(scope="module")
def keys(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("keys") / "lab"
    make_keys(folder, free_endpoint().replace("tcp/", "tls/"))
    return folder


@pytest.fixture
def bus(keys: Path) -> Iterator[Bus]:
    with closing(Bus("run", tls=keys)) as opened:
        opened.keep("clock", b"{}")
        opened.keep("seat/TOWER", b"{}")
        opened.answer("seat/*/do", lambda _key, _data, answer: answer(b"{}"))
        yield opened


def try_as(bus: Bus, file: Path) -> tuple[list[str], set[str], set[str]]:
    """Return what answered, what was received, and what the run heard, of a program with a file."""
    heard: list[str] = []
    for key in TRIED:
        bus.hear(key, lambda key, _: heard.append(key))
    command = [sys.executable, "-c", TRIES, str(file), " ".join(TRIED)]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as program:
        assert program.stdout is not None
        answers = json.loads(program.stdout.readline() or "[]")
        while program.poll() is None:
            for key in PUBLISHED_BY_RUN:
                bus.put(key, b"{}")
            try:
                program.wait(0.05)
            except subprocess.TimeoutExpired:
                continue
        received = json.loads(program.stdout.readline() or "[]")
    return answers, {key.removeprefix("airhilt/run/") for key in received}, set(heard)


@pytest.mark.parametrize(
    ("role", "asks", "reads", "publishes"),
    [
        ("observer", [], set(), set()),
        ("worker", [], set(), {"advisory/ATC", "vision/tower"}),
        ("operator", ["seat/TOWER", "seat/TOWER/do"], OF_SEATS, {"command/AAL123"}),
        ("recorder", ["seat/TOWER"], {"truth/state/AAL123", *OF_SEATS}, set()),
    ],
)
def test_a_program_may_do_what_its_role_may(
    bus: Bus, keys: Path, role: Any, asks: list[str], reads: set[str], publishes: set[str]
) -> None:
    """It asks for the state of a seat, and acts there."""
    answers, received, heard = try_as(bus, key_file(keys, role))
    assert answers == [f"airhilt/run/{key}" for key in ("clock", *asks)]
    from_run = received & set(PUBLISHED_BY_RUN)
    assert from_run == {"adsb/d4e5f6", "clock"} | reads
    assert heard == publishes


PLAYS = """
import json, sys, zenoh
session = zenoh.open(zenoh.Config.from_file(sys.argv[1]))
prefix = "airhilt/run/"
kept = [
    session.declare_queryable(
        prefix + "worker/own/describe",
        lambda query: query.reply(prefix + "worker/own/describe", "{}"),
    ),
    session.liveliness().declare_token(prefix + "worker/own"),
    session.liveliness().declare_token(prefix + "seat/TOWER/holder/me"),
]
answers = [reply.ok for reply in session.get("airhilt/*/clock") if reply.ok]
print(len(answers), flush=True)  # What was declared before the query has arrived before it.
sys.stdin.read()
for entity in kept:
    entity.undeclare()
session.close()
"""
"""Plays a worker and a person at a seat, as a program that does not know its role."""


@pytest.mark.parametrize(
    ("role", "there", "answers"),
    [
        ("observer", set(), False),
        ("worker", {"worker/own"}, True),
        ("operator", {"seat/TOWER/holder/me"}, False),
        ("recorder", set(), False),
    ],
)
def test_a_program_is_a_worker_or_takes_a_seat_by_its_role_alone(
    bus: Bus, keys: Path, role: Any, there: set[str], answers: bool
) -> None:
    command = [sys.executable, "-c", PLAYS, str(key_file(keys, role))]
    with subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE) as program:
        assert program.stdout is not None
        assert program.stdout.readline() == b"1\n"
        tokens = bus.session.liveliness().get("airhilt/run/**", timeout=1.0)
        found = {str(token.ok.key_expr) for token in tokens if token.ok is not None}
        assert found == {"airhilt/run/run", *(f"airhilt/run/{key}" for key in there)}
        replies = list(bus.session.get("airhilt/run/worker/own/describe", timeout=1.0))
        assert any(reply.ok is not None for reply in replies) == answers
        program.communicate()


def with_files_exchanged(keys: Path, folder: Path, *, named: str, of: str) -> Path:
    """Return a folder of keys in which the file of one role has what is of another."""
    shutil.copytree(keys, folder)
    shutil.copy(folder / f"{of}.json", folder / f"{named}.json")
    return folder


@pytest.mark.parametrize("of", mostly_slow(["observer", "operator", "recorder"], "operator"))
def test_a_worker_with_the_certificate_of_another_role_is_told_so(
    bus: Bus, keys: Path, tmp_path: Path, of: str
) -> None:
    folder = with_files_exchanged(keys, tmp_path / "lab", named="worker", of=of)
    with process("-m", "airhilt", "worker", "decision", "--tls", folder) as worker:
        assert worker.wait(timeout=60.0) == 2
        assert worker.stderr is not None
        said = worker.stderr.read().decode()
    assert said == (
        f"airhilt: {folder}/worker.json: its certificate is of {of!r}; expected that of 'worker', "
        "as `airhilt keys init` has made it\n"
    )


@pytest.mark.parametrize("of", ["observer", "worker", "operator", "recorder"])
def test_a_run_with_the_certificate_of_a_program_is_told_so(
    keys: Path, tmp_path: Path, of: str
) -> None:
    folder = with_files_exchanged(keys, tmp_path / "lab", named="router", of=of)
    with pytest.raises(BusError, match=rf"router\.json: its certificate is of '{of}'; expected"):
        Bus("run", tls=folder)


def refused(file: Path, endpoint: str, *left_out: str) -> bool:
    """Return whether a program cannot connect with a file, without some of its settings."""
    document = json.loads(file.read_text())
    document["connect"] = {
        "endpoints": [endpoint], "timeout_ms": 500, "exit_on_failure": True,
    }  # fmt: skip
    for name in left_out:
        del document["transport"]["link"]["tls"][name]
    try:
        session: Any = zenoh.open(zenoh.Config.from_json5(json.dumps(document)))
    except zenoh.ZError:
        return True
    session.close()
    return False


def test_a_program_without_a_certificate_of_the_run_cannot_connect(
    bus: Bus, keys: Path, tmp_path: Path
) -> None:
    worker = key_file(keys, "worker")
    others = tmp_path / "others"
    make_keys(others, bus.endpoint)
    assert not refused(worker, bus.endpoint)
    assert refused(worker, bus.endpoint, "connect_certificate_base64", "connect_private_key_base64")
    assert refused(key_file(others, "worker"), bus.endpoint)
    assert refused(worker, bus.endpoint.replace("tls/", "tcp/"))


def test_a_worker_attaches_with_the_keys_alone(
    encounter: Scenario, tmp_path: Path, keys: Path
) -> None:
    short = encounter.model_copy(update={"duration_s": 4.0})
    with process("-m", "airhilt", "worker", "decision", "--tls", keys) as worker:
        result = run(short, out=tmp_path / "run", latency="fixed", tls=keys, attach=("decision",))
        assert worker.wait(timeout=10.0) == 0
    assert result.summary.modalities["decision"] == "on"
    assert replay(result.folder).identical


def test_only_the_user_can_read_keys_and_none_is_overwritten(keys: Path, tmp_path: Path) -> None:
    for holder in HOLDERS:
        assert stat.S_IMODE(key_file(keys, holder).stat().st_mode) == 0o600
    with pytest.raises(BusError, match=r"router.json: is there already"):
        make_keys(keys, "tls/127.0.0.1:7447")
    with pytest.raises(BusError, match="expected the form tls/"):
        make_keys(tmp_path / "keys", "tcp/127.0.0.1:7447")


@pytest.mark.parametrize("content", [None, b"", b"{}", b"[" * 100_000, b'{"transport": 3}'])
def test_keys_that_are_none_are_named(tmp_path: Path, content: bytes | None) -> None:
    if content is not None:
        (tmp_path / "router.json").write_bytes(content)
    with pytest.raises(BusError, match=r"router\.json.*airhilt keys init"):
        Bus("run", tls=tmp_path)


@pytest.mark.parametrize(
    ("endpoint", "options", "words"),
    [
        ("tcp/0.0.0.0:7447", {}, "other machines can reach it"),
        ("udp/[::]:7447", {}, "other machines can reach it"),
        ("ws/sim.example.org:7447", {}, "other machines can reach it"),
        ("tcp/[::ffff:127.0.0.1]:7447", {}, "other machines can reach it"),
        ("tcp/127.0.0.1.example.org:7447", {}, "other machines can reach it"),
        ("serial//dev/ttyS0", {}, "expected the form tcp/"),
        ("tls/127.0.0.1:7447", {}, "its protocol needs certificates"),
        ("tcp/127.0.0.1:7447", {"tls": True}, "--tls needs a protocol with certificates"),
        (None, {"tls": True, "insecure": True}, "expected only one of the two"),
    ],
)
def test_an_endpoint_that_lets_strangers_in_is_refused(
    keys: Path, endpoint: str | None, options: dict[str, Any], words: str
) -> None:
    given: Sequence[tuple[str, Any]] = [
        (name, keys if name == "tls" else value) for name, value in options.items()
    ]
    with pytest.raises(BusError, match=words):
        Bus("run", endpoint, **dict(given))


def test_insecure_says_what_it_opens(encounter: Scenario, tmp_path: Path) -> None:
    notices = Notices()
    endpoint = free_endpoint().replace("127.0.0.1", "0.0.0.0")
    short = encounter.model_copy(update={"duration_s": 1.0})
    run(short, out=tmp_path / "run", endpoint=endpoint, insecure=True, observer=notices)
    assert (
        f"whoever reaches {endpoint} can read all sensors and advisories, attach"
        in (notices.texts[0])
    )
    is_open: dict[str, Any] = {"endpoint": endpoint, "insecure": True, "share_truth": True}
    run(short, out=tmp_path / "open", observer=notices, **is_open)
    assert "can read all sensors and advisories and the truth, attach" in notices.texts[-1]
    with pytest.raises(AirhiltError, match="--insecure would do nothing without --endpoint"):
        run(short, out=tmp_path / "other", insecure=True)


def test_a_program_with_keys_of_another_authority_is_told_that_it_is_not_let_in(
    bus: Bus, tmp_path: Path
) -> None:
    make_keys(tmp_path / "others", bus.endpoint)
    with pytest.raises(BusError, match=f"what listens on {bus.endpoint} does not let this"):
        connect_client(bus.endpoint, 0.0, tmp_path / "others")


def test_where_nothing_listens_is_told_as_such(bus: Bus, keys: Path) -> None:
    with pytest.raises(BusError, match=r"nothing listens on tls/127\.0\.0\.1:9"):
        connect_client("tls/127.0.0.1:9", 0.0, keys)
