"""Runs whose assistant is at an address: decided there, recorded here, replayed without it."""

from __future__ import annotations

import json
import runpy
import threading
from http.server import BaseHTTPRequestHandler, HTTPServer
from pathlib import Path
from typing import Any

import pytest
from click.testing import CliRunner

import airhilt
from airhilt import Scenario
from airhilt.assistant.decision.worker import DecisionWorker
from airhilt.cli.commands.rescore import COMMAND
from airhilt.cosim.replay import replay, rescore
from airhilt.errors import WorkerError
from airhilt.messages import Event, Severity
from airhilt.metrics.summary import Summary
from airhilt.record import read_log
from notices import Notices
from paths import ROOT
from services import answering, nobody, service

OPTIONS: dict[str, Any] = {"latency": "fixed", "speech": False, "cameras": False}
STRANGER = {
    "id": "x", "kind": "loss_of_separation", "severity": "WARNING", "recipients": ["NOBODY9"],
    "traffic": ["AAL123", "DAL456"],
}  # fmt: skip


def test_a_service_that_warns_nobody_gets_a_hint(encounter: Scenario, tmp_path: Path) -> None:
    notices = Notices()
    with service(answering(json.dumps({"advisories": [STRANGER]}).encode())) as url:
        airhilt.run(encounter, out=tmp_path / "run", observer=notices, assistant=url, **OPTIONS)
    assert [text for text in notices.texts if "WARNING to NOBODY9: nobody has that name" in text]


def test_the_example_warns_both_crews_and_its_run_replays_without_it(
    encounter: Scenario, tmp_path: Path
) -> None:
    handler = runpy.run_path(str(ROOT / "examples" / "http_assistant.py"))["Handler"]
    with HTTPServer(("127.0.0.1", 0), handler) as server:
        thread = threading.Thread(target=server.serve_forever, args=(0.02,))
        thread.start()
        url = f"http://127.0.0.1:{server.server_port}/advise"
        try:
            result = airhilt.run(encounter, out=tmp_path / "run", assistant=url, **OPTIONS)
        finally:
            server.shutdown()
            thread.join()
    summary = result.summary
    assert summary.assistant == url
    assert [each.severity for each in summary.advisories] == [Severity.CAUTION]
    reactions = [
        event
        for logged in read_log(result.folder / "log.mcap")
        if logged.key == "truth/event"
        and (event := Event.model_validate_json(logged.data)).kind == "pilot_reacts"
    ]
    assert {event.subject for event in reactions} == {"AAL123", "DAL456"}
    assert summary.conflict_outcome == "avoided"
    assert replay(result.folder).identical
    assert scored(rescore(result.folder)[0]) == scored(summary)
    runner = CliRunner()
    assert runner.invoke(COMMAND, [str(result.folder)]).output.endswith("the same scores\n")
    path = result.folder / "summary.json"
    path.write_text(path.read_text().replace('"avoided": true', '"avoided": false'))
    told = runner.invoke(COMMAND, [str(result.folder)])
    assert "summary.json/avoided: recorded False, now True" in told.output
    assert told.exit_code == 1


def scored(summary: Summary) -> dict[str, Any]:
    return summary.model_dump(exclude={"real_time_factor", "cpu_s", "too_slow", "latency_sources"})


@pytest.mark.parametrize(
    "lie",
    [
        {"evidence": {"sources": ["radio"], "radio_ids": ["of another run"]}},
        {"evidence": {"sources": ["adsb"], "tracks": ["abcdef"]}},
        {"traffic": ["AAL123"]},
        {"traffic": ["NOBODY9", "AAL123"]},
    ],
)
def test_who_says_what_cannot_be_known_has_warned_nobody_of_the_conflict(
    lie: dict[str, Any], encounter: Scenario, tmp_path: Path
) -> None:
    told = STRANGER | {"recipients": ["AAL123", "DAL456"]} | lie
    with service(answering(json.dumps({"advisories": [told]}).encode())) as url:
        run = airhilt.run(encounter, out=tmp_path / "run", assistant=url, **OPTIONS)
    assert run.summary.modalities["decision"] == "on"
    assert run.summary.advisories
    assert run.summary.t_first_warning_s is None


def test_a_service_that_fails_is_a_lost_worker_and_the_run_goes_on(
    encounter: Scenario, tmp_path: Path
) -> None:
    given = iter([b'{"advisories": []}'] * 3)  # The first is to the probe.

    def answer(handler: BaseHTTPRequestHandler, body: bytes) -> None:
        answering(next(given, b'{"advisories": [{"id": "x"}]}'))(handler, body)

    with service(answer) as url:
        invalid = airhilt.run(encounter, out=tmp_path / "invalid", assistant=url, **OPTIONS)
    assert invalid.summary.modalities["decision"] == "lost"
    assert invalid.summary.steps_missed == {"decision": 2}
    assert invalid.summary.outcome == "finished"
    assert not invalid.summary.advisories
    assert replay(invalid.folder).identical


def test_a_service_that_is_down_ends_the_command_before_the_run(
    encounter: Scenario, tmp_path: Path
) -> None:
    with pytest.raises(WorkerError, match="is not there"):
        airhilt.run(encounter, out=tmp_path / "run", assistant=nobody(), **OPTIONS)
    assert not (tmp_path / "run").exists()


def test_scores_are_made_again_though_no_worker_of_the_run_is_there(
    encounter: Scenario, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    flown = airhilt.run(encounter, out=tmp_path / "run", latency="fixed", cameras=False)

    def nobody_decides(*_: object) -> None:
        raise AssertionError("the assistant was asked")

    monkeypatch.setattr(DecisionWorker, "step", nobody_decides)
    summary, verdict = rescore(flown.folder)
    assert verdict.identical
    assert scored(summary) == scored(flown.summary)
