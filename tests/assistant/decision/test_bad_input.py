"""Input that cannot be right is left out or named, and never a silent wrong advisory."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest

import airhilt
from airfield import NORTH, Airfield, Mover, lands
from airhilt import Scenario
from airhilt.assistant.decision.alerts import Alert
from airhilt.assistant.decision.engine import Decision, ReceivedMessage
from airhilt.assistant.decision.worker import DecisionWorker
from airhilt.assistant.wording.engines.template import Template
from airhilt.messages import (
    AdsbReport,
    Advisory,
    Event,
    Evidence,
    Message,
    Severity,
)
from airhilt.record import read_log
from airhilt.sim import Input
from airhilt.surveillance.receivers import Receiver
from airhilt.units import SECOND_NS
from decisions import transcript
from encounters import head_on


def test_what_is_told_of_an_aircraft_with_two_places_says_so() -> None:
    """From 30 s on, a false report follows each one of DAL456."""
    honest, spoofed = head_on(150.0), head_on(150.0)
    hear = spoofed._reports

    def reports(station: Receiver, t_ns: int, step: int) -> list[Input]:
        inputs = hear(station, t_ns, step)
        if step < 60 or len(inputs) < 2:
            return inputs
        true = AdsbReport.model_validate_json(inputs[1].payload)
        false = true.model_copy(update={"latitude_deg": 30.0}).model_dump_json().encode()
        return [*inputs, replace(inputs[1], payload=false)]

    spoofed._reports = reports
    told, known = ([each for _, each in one.fly().told] for one in (spoofed, honest))
    assert [each.severity for each in told] == [each.severity for each in known] != []
    text = "ADS-B of DAL456 inconsistent"
    assert all(text in advisory.evidence.inconsistencies for advisory in told)
    assert all(not advisory.evidence.inconsistencies for advisory in known)


# --- transcripts ----------------------------------------------------------------------------


def test_the_last_word_counts_though_an_earlier_call_is_recognised_after_it() -> None:
    field = Airfield([Mover("AAL123", NORTH, lands(90.0))])
    calls = {
        10: "Ops one, proceed onto runway zero one at delta for inspection.",
        15: "Ops one, hold short of runway zero one.",
    }
    arrives_s = {15: 15, 18: 10}

    def transcripts(t_ns: int) -> list[Input]:
        end_s = arrives_s.get(t_ns // SECOND_NS) if t_ns % SECOND_NS == 0 else None
        if end_s is None:
            return []
        end_ns = end_s * SECOND_NS
        heard = transcript(str(end_s), 119_100, end_ns - 3 * SECOND_NS, end_ns, calls[end_s])
        return [Input("asr/119100", t_ns, heard.model_dump_json().encode())]

    field._transcripts = transcripts
    assert field.run(50.0).told == []


# --- engines of other packages --------------------------------------------------------------


class Careless:
    """An engine whose only alert goes to somebody who cannot be addressed."""

    name = "careless"
    reads: tuple[type[Message], ...] = (AdsbReport,)

    def receive(self, received: ReceivedMessage) -> None: ...

    def decide(self, t_ns: int) -> Decision:
        alert = Alert(
            id="first",
            revision=0,
            kind="runway_conflict",
            severity=Severity.WARNING,
            recipients=("the crew ahead",),
            traffic=(),
            evidence=Evidence(sources=("adsb",)),
        )
        return Decision([alert])


def test_nothing_that_waits_is_left_out() -> None:
    wanted = DecisionWorker(Careless(), Template()).description.inputs
    assert {one.policy for one in wanted} == {"batch"}


def test_an_alert_that_makes_no_advisory_costs_its_worker_and_not_the_run(
    encounter: Scenario, tmp_path: Path
) -> None:
    short = encounter.model_copy(update={"duration_s": 5.0})
    with pytest.warns(RuntimeWarning, match="worker 'decision' failed"):
        result = airhilt.run(
            short, out=tmp_path / "run", latency="fixed", speech=False, cameras=False,
            workers=[DecisionWorker(Careless(), Template())],
        )  # fmt: skip
    assert result.summary.outcome == "finished"
    log = list(read_log(result.folder / "log.mcap"))
    lost = [Event.model_validate_json(m.data) for m in log if m.key == "truth/event"]
    (text,) = [event.text for event in lost if event.kind == "worker_lost"]
    assert "1 validation error for Advisory" in text
    assert not [Advisory for m in log if m.key.startswith("advisory/")]
