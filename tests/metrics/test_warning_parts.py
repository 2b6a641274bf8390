"""What the time to first warning consists of."""

from __future__ import annotations

from typing import Any

import pytest

from airhilt.messages import Advisory, Evidence, Severity, Transcript
from airhilt.metrics.calls import CallRecord
from airhilt.metrics.summary import WarningParts
from airhilt.metrics.warning_parts import parts_of, supporting_transcript
from airhilt.units import SECOND_NS

KHZ = 119_100


def ns(t_s: float) -> int:
    return round(t_s * SECOND_NS)


def transcript(name: str, tx_s: float, end_s: float, asr_s: float) -> Transcript:
    return Transcript(
        t_ns=ns(asr_s), id=name, frequency_khz=KHZ, t_tx_ns=ns(tx_s), t_end_ns=ns(end_s),
        text="", confidence=1.0, engine="embedded",
    )  # fmt: skip


def advisory(ready_s: float, dec_s: float, *radio_ids: str, sources: Any = ("radio",)) -> Advisory:
    return Advisory(
        t_ns=ns(dec_s), id="a", revision=0, recipient="ATC", recipients=("ATC",),
        kind="runway_conflict", severity=Severity.CAUTION, traffic=("AAL1", "DAL2"), message="",
        evidence=Evidence(sources=sources, radio_ids=radio_ids), t_ready_ns=ns(ready_s),
    )  # fmt: skip


READBACK = transcript("readback", 10.0, 14.0, 16.0)


def rounded(parts: WarningParts) -> tuple[float, ...]:
    return tuple(round(value, 6) for value in parts.model_dump().values())


def test_a_warning_by_the_call_that_begins_the_conflict_is_said_recognised_decided_and_spoken() -> (
    None
):
    parts = parts_of(ns(10.0), ns(17.5), advisory(16.0, 16.6), READBACK)
    assert rounded(parts) == (4.0, 2.0, 0.0, 0.6, 0.9)


def test_what_is_waited_for_after_the_transcript_is_evidence() -> None:
    parts = parts_of(ns(10.0), ns(25.0), advisory(23.0, 24.0), READBACK)
    assert rounded(parts) == (4.0, 2.0, 7.0, 1.0, 1.0)


def test_words_that_are_recognised_while_they_are_said_take_no_time_to_recognise() -> None:
    early = transcript("readback", 10.0, 14.0, 13.0)
    parts = parts_of(ns(10.0), ns(14.0), advisory(13.0, 13.5), early)
    assert rounded(parts) == (3.0, 0.0, 0.0, 0.5, 0.5)


@pytest.mark.parametrize("call", [READBACK, None])
def test_evidence_that_was_complete_before_the_conflict_began_is_negative(call: Any) -> None:
    parts = parts_of(ns(20.0), ns(17.0), advisory(16.0, 16.5), call)
    assert rounded(parts) == (0.0, 0.0, -4.0, 0.5, 0.5)
    assert sum(rounded(parts)) == pytest.approx(-3.0)


# --- the transcript that a warning rests on -------------------------------------------------


def found(advised: Advisory, beginning: str | None = "readback") -> str | None:
    calls = {
        "clearance": CallRecord(transcripts=[transcript("clearance", 1.0, 4.0, 5.0)]),
        "readback": CallRecord(transcripts=[READBACK]),
    }
    known = supporting_transcript(advised, beginning, calls.get)
    return None if known is None else known.id


def test_a_warning_rests_on_the_last_call_that_its_evidence_names() -> None:
    assert found(advisory(16.0, 17.0, "readback", "clearance")) == "readback"
    assert found(advisory(16.0, 17.0, "clearance")) == "clearance"


def test_without_names_it_rests_on_the_call_that_begins_the_conflict_if_on_the_radio() -> None:
    assert found(advisory(16.0, 17.0)) == "readback"
    assert found(advisory(16.0, 17.0), beginning=None) is None
    assert found(advisory(16.0, 17.0, sources=("adsb", "vision"))) is None


def test_what_was_recognised_after_the_evidence_was_complete_is_no_part_of_it() -> None:
    assert found(advisory(15.0, 17.0, "readback", "clearance")) == "clearance"
