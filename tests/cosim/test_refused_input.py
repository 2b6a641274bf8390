"""What reached a run from outside is an input of its replay, also if the run refused it."""

from __future__ import annotations

import json
from collections.abc import Sequence
from pathlib import Path

import pytest

from airhilt import run
from airhilt.bus.session import Bus
from airhilt.cosim.external_programs import ExternalPrograms
from airhilt.cosim.observer import Observer, Snapshot
from airhilt.cosim.replay import replay
from airhilt.errors import WorkerError
from airhilt.record import read_log
from airhilt.scenario import Scenario

CLIMB = json.dumps({"command": {"action": "altitude", "altitude_ft": 33000.0}}).encode()
REFUSED = [
    ("command/DAL456", b"climb!"),
    ("advisory/ATC", b"{}"),
    ("asr/119100", b"\xff\xfe"),
    ("tts/a-1", b"\0\0"),
    ("command/DAL456", b"[" * 5000),
]


class Sends(Observer):
    """Lets messages arrive from outside, one by one, as Zenoh's threads do."""

    def __init__(self, monkeypatch: pytest.MonkeyPatch, given: Sequence[tuple[str, bytes]]) -> None:
        self._left = list(given)
        self._programs: ExternalPrograms | None = None
        monkeypatch.setattr(
            ExternalPrograms, "serve", lambda programs, bus: self.keep(programs, bus)
        )

    def keep(self, programs: ExternalPrograms, bus: Bus) -> None:
        self._programs = programs

    def snapshot(self, snapshot: Snapshot) -> None:
        if self._programs is not None and self._left and snapshot.t_s > 1.0:
            key, data = self._left.pop(0)
            programs = self._programs
            programs._director.post(lambda: programs.take(key, data))


def recorded(
    scenario: Scenario, folder: Path, observer: Observer, *, strict: bool = False
) -> list[tuple[str, str]]:
    """Return kind and subject of the events of a run on what came from outside."""
    short = scenario.model_copy(update={"duration_s": 6.0})
    run(
        short, out=folder, latency="fixed", assistant="none", speech=False, observer=observer,
        strict=strict, report=False,
    )  # fmt: skip
    return outside(folder)


def outside(folder: Path) -> list[tuple[str, str]]:
    events = [json.loads(x.data) for x in read_log(folder / "log.mcap") if x.key == "truth/event"]
    return [
        (event["kind"], event["subject"])
        for event in events
        if event["kind"] in ("unregistered", "refused")
    ]


@pytest.mark.parametrize("number", range(len(REFUSED)))
def test_a_replay_of_refused_input_is_identical(
    encounter: Scenario, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, number: int
) -> None:
    key, _ = REFUSED[number]
    with monkeypatch.context() as patched:
        events = recorded(encounter, tmp_path / "run", Sends(patched, [REFUSED[number]]))
    assert events == [("unregistered", key), ("refused", key)]
    verdict = replay(tmp_path / "run")
    assert verdict.identical, verdict.difference


def test_a_replay_has_accepted_and_refused_input_in_its_order(
    encounter: Scenario, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    given = [REFUSED[0], ("command/AAL123", CLIMB), REFUSED[3], ("command/NOBODY", CLIMB)]
    with monkeypatch.context() as patched:
        events = recorded(encounter, tmp_path / "run", Sends(patched, given))
    assert [kind for kind, _ in events] == ["unregistered", "refused", "refused"]
    verdict = replay(tmp_path / "run")
    assert verdict.identical, verdict.difference


def test_a_replay_of_a_run_that_refused_input_ended_is_identical(
    encounter: Scenario, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    with monkeypatch.context() as patched, pytest.raises(WorkerError, match="no ActorCommand"):
        recorded(encounter, tmp_path / "run", Sends(patched, REFUSED[:1]), strict=True)
    assert outside(tmp_path / "run")[-1] == ("refused", "command/DAL456")
    verdict = replay(tmp_path / "run")
    assert verdict.identical, verdict.difference


class Floods(Sends):
    """Sends a message that is taken, and many that are too large or too many."""

    def snapshot(self, snapshot: Snapshot) -> None:
        if self._programs is not None and self._left and snapshot.t_s > 1.0:
            for _ in range(300):
                self._programs._intake.admit("advisory/*", 1_000_000)
                self._programs._intake.admit("command/*", 10)
        super().snapshot(snapshot)


def test_what_was_dropped_is_counted_in_log_and_summary_and_in_a_replay(
    encounter: Scenario, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    with monkeypatch.context() as patched:
        flood = Floods(patched, [("command/AAL123", CLIMB)])
        events = recorded(encounter, tmp_path / "run", flood)
    assert events == [
        ("unregistered", "advisory/*"), ("refused", "advisory/*"), ("refused", "command/*"),
    ]  # fmt: skip
    logged = read_log(tmp_path / "run" / "log.mcap")
    counts = {
        f"{told['keys']}: {told['cause']}": told["messages"]
        for told in (json.loads(each.data) for each in logged if each.key == "truth/dropped")
    }
    summary = json.loads((tmp_path / "run" / "summary.json").read_text())
    assert summary["messages_dropped"] == counts
    assert counts["advisory/*: size"] == 300
    assert 200 < counts["command/*: rate"] <= 250
    verdict = replay(tmp_path / "run")
    assert verdict.identical, verdict.difference
