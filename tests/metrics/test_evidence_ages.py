"""How old the evidence was that decisions rested on."""

from __future__ import annotations

from typing import Any, cast

import pytest

from airhilt.messages import AdsbReport, Message, Transcript
from airhilt.metrics.evidence_ages import EvidenceAges
from airhilt.sim import StepRecord
from airhilt.units import seconds_to_ns


def report(observed_s: float, t_s: float) -> Message:
    known = {"t_ns": seconds_to_ns(t_s), "t_adsb_in_ns": seconds_to_ns(observed_s)}
    return AdsbReport.model_construct(**cast(Any, known))


def call(end_s: float, t_s: float) -> Message:
    known = {"t_ns": seconds_to_ns(t_s), "t_end_ns": seconds_to_ns(end_s)}
    return Transcript.model_construct(**cast(Any, known))


def step(start_s: float, latency_s: float, worker: str = "decision") -> StepRecord:
    start_ns = seconds_to_ns(start_s)
    return StepRecord(worker, 0, start_ns, start_ns, seconds_to_ns(latency_s), 0.0, 0)


def test_what_a_slow_worker_judges_by_is_stale_for_most_of_the_time() -> None:
    ages = EvidenceAges(["decision"])
    for second in range(40):
        ages.take(report(second, second))
        if second % 10 == 0:
            ages.step(step(second, 10.0))
    age = ages.statistics(seconds_to_ns(40))["adsb"]
    assert age.max_s == pytest.approx(20.0)
    assert age.stale_share == pytest.approx(35.0 / 40.0)


def test_a_step_has_what_arrived_before_it_began_and_not_what_arrived_meanwhile() -> None:
    ages = EvidenceAges(["decision"])
    ages.take(report(0.0, 0.0))
    ages.take(report(1.0, 1.0))
    ages.step(step(0.0, 4.0))
    ages.step(step(4.0, 0.0))
    assert ages.statistics(seconds_to_ns(5))["adsb"].max_s == pytest.approx(4.0)
    ages.take(report(5.0, 5.0))
    ages.step(step(4.5, 3.5))
    assert ages.statistics(seconds_to_ns(12))["adsb"].max_s == pytest.approx(11.0)


def test_a_quiet_frequency_is_not_stale_and_a_call_that_waits_is() -> None:
    ages = EvidenceAges(["decision"])
    ages.take(call(10.0, 10.0))
    ages.step(step(10.0, 1.0))
    quiet = ages.statistics(seconds_to_ns(110))["asr"]
    assert (quiet.stale_share, quiet.max_s) == (0.0, pytest.approx(1.0))
    ages.take(call(50.0, 60.0))
    ages.step(step(65.0, 0.0))
    assert ages.statistics(seconds_to_ns(110))["asr"].stale_share == pytest.approx(0.1)


def test_a_call_whose_transcript_comes_after_that_of_a_later_one_is_stale_for_a_share() -> None:
    ages = EvidenceAges(["decision"])
    ages.take(call(40.0, 41.0))
    ages.step(step(41.0, 0.0))
    ages.take(call(10.0, 50.0))
    ages.step(step(50.0, 0.0))
    assert ages.statistics(seconds_to_ns(60))["asr"].stale_share == pytest.approx(0.7)


def test_steps_of_others_judge_nothing() -> None:
    ages = EvidenceAges(["decision"])
    ages.take(call(10.0, 10.0))
    ages.step(step(10.0, 0.0, worker="tts"))
    assert ages.statistics(seconds_to_ns(20))["asr"].stale_share == pytest.approx(0.5)


def test_no_time_counts_twice_where_a_quick_worker_overtakes_a_slow_one() -> None:
    ages = EvidenceAges(["slow", "quick"])
    ages.take(report(0.0, 0.0))
    ages.step(step(0.0, 8.0, worker="slow"))
    ages.step(step(0.0, 2.0, worker="quick"))
    ages.step(step(9.0, 1.0, worker="quick"))
    age = ages.statistics(seconds_to_ns(10))["adsb"]
    assert age.mean_s == pytest.approx(5.0)
    assert age.stale_share == pytest.approx(0.5)


def test_telling_the_ages_changes_nothing() -> None:
    ages = EvidenceAges(["decision"])
    ages.take(report(0.0, 0.0))
    ages.take(call(0.0, 1.0))
    ages.step(step(0.0, 1.0))
    early = ages.statistics(seconds_to_ns(3))
    assert ages.statistics(seconds_to_ns(9)) != early
    assert ages.statistics(seconds_to_ns(3)) == early
