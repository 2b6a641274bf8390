"""Input that cannot be right is left out or named, and never a silent wrong advisory."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

import airhilt
from airfield import NORTH, Airfield, Mover, lands, stands
from airhilt import Scenario
from airhilt.assistant.decision.alerts import Alert
from airhilt.assistant.decision.engine import Decision, ReceivedMessage
from airhilt.assistant.decision.worker import DecisionWorker
from airhilt.assistant.wording.engines.template import Template
from airhilt.errors import WorkerError
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
from encounters import Encounter, Flight, head_on

INCONSISTENT = "ADS-B of DAL456 inconsistent"


# --- ADS-B ----------------------------------------------------------------------------------


def changed(encounter: Encounter, change: Callable[[int, list[Input]], list[Input]]) -> Encounter:
    """Let what the receiver gives out at each step go through a function first."""
    hear = encounter._reports

    def reports(station: Receiver, t_ns: int, step: int) -> list[Any]:
        return change(step, hear(station, t_ns, step))

    encounter._reports = reports
    return encounter


def report_of(item: Input) -> AdsbReport:
    return AdsbReport.model_validate_json(item.payload)


def with_report(item: Input, **values: Any) -> Input:
    false = report_of(item).model_copy(update=values)
    return replace(item, payload=false.model_dump_json().encode())


def far_apart(seconds: float = 100.0) -> Encounter:
    """Two at one level that pass each other 60 NM apart."""
    return Encounter(
        [
            Flight("AAL123", "a1b2c3", 90.0, 30.7, 35_000),
            Flight("DAL456", "a4d5e6", 270.0, 30.7, 35_000, offset_nm=60.0),
        ],
        seconds,
    )


def ahead_of_the_other(step: int, inputs: list[Input]) -> Input:
    """Return a false report: the second aircraft is a degree ahead of the first."""
    first, second = (report_of(item) for item in inputs)
    return with_report(
        inputs[1],
        latitude_deg=first.latitude_deg,
        longitude_deg=first.longitude_deg + 0.4,
        altitude_ft=first.altitude_ft,
        t_adsb_in_ns=second.t_adsb_in_ns,
    )


def test_two_places_of_one_address_are_no_conflict_at_the_false_one() -> None:
    def spoof(step: int, inputs: list[Input]) -> list[Input]:
        false = [ahead_of_the_other(step, inputs)] if step >= 60 and len(inputs) == 2 else []
        return [*inputs, *false]

    assert changed(far_apart(), spoof).fly().told == []


def test_what_is_told_of_an_aircraft_with_two_places_says_so() -> None:
    def spoof(step: int, inputs: list[Input]) -> list[Input]:
        if step < 60 or len(inputs) < 2:
            return inputs
        return [*inputs, with_report(inputs[1], latitude_deg=30.0)]

    told = [advisory for _, advisory in changed(head_on(150.0), spoof).fly().told]
    assert [str(advisory.severity) for advisory in told if advisory.recipient == "DAL456"]
    assert all(INCONSISTENT in advisory.evidence.inconsistencies for advisory in told)
    honest = [advisory for _, advisory in head_on(150.0).fly().told]
    assert [each.severity for each in told] == [each.severity for each in honest]
    assert all(not advisory.evidence.inconsistencies for advisory in honest)


def test_a_jump_on_to_the_runway_sends_nobody_around() -> None:
    field = Airfield(
        [Mover("AAL123", NORTH, lands(60.0)), Mover("OPS1", NORTH, stands(800.0, 1500.0))]
    )
    on_runway = field.movers[1]
    hear = field._report

    def report(station: Receiver, mover: Mover, t_ns: int, step: int) -> list[Input]:
        if mover is on_runway and 40 <= step < 60:
            mover = replace(mover, spot=stands(1200.0))
            mover.transponder = on_runway.transponder
        return hear(station, mover, t_ns, step)

    field._report = report
    assert field.run(50.0).told == []


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


def test_an_alert_that_makes_no_advisory_is_refused_with_the_engine_and_the_field() -> None:
    worker = DecisionWorker(Careless(), Template())
    with pytest.raises(
        WorkerError, match=r"'careless' gave an alert 'first' that makes no Advisory: recipient"
    ):
        worker.step(0, [])


def test_a_run_with_such_an_engine_goes_on_and_names_it(
    encounter: Scenario, tmp_path: Path
) -> None:
    short = encounter.model_copy(update={"duration_s": 5.0})
    result = airhilt.run(
        short, out=tmp_path / "run", latency="fixed", speech=False, cameras=False,
        workers=[DecisionWorker(Careless(), Template())],
    )  # fmt: skip
    assert result.summary.outcome == "finished"
    log = list(read_log(result.folder / "log.mcap"))
    lost = [Event.model_validate_json(m.data) for m in log if m.key == "truth/event"]
    (text,) = [event.text for event in lost if event.kind == "worker_lost"]
    assert "'careless' gave an alert 'first' that makes no Advisory" in text
    assert not [Advisory for m in log if m.key.startswith("advisory/")]
