"""Gated fusion: nothing is told while a transcript is to come."""

from __future__ import annotations

from typing import Any

import pytest

from airhilt.assistant.decision.fusion import PATIENCE_NS, FusionGate
from airhilt.messages import Status, Transcript, Transmission
from airhilt.units import SECOND_NS
from decisions import reference

END_NS = 5_000_000_000


def received(name: str = "a", samples: int = 16_000) -> Transmission:
    return Transmission(id=name, frequency_khz=118_000, t_tx_ns=0, t_end_ns=END_NS, samples=samples)


def transcribed(name: str = "a") -> Transcript:
    return Transcript(
        id=name, frequency_khz=118_000, t_tx_ns=0, t_end_ns=END_NS, text="x", confidence=1.0,
        engine="e",
    )  # fmt: skip


def test_the_gate_is_open_while_nothing_is_to_come() -> None:
    assert FusionGate().opens_ns(0) is None


def test_it_is_closed_from_the_end_of_a_call_to_its_transcript() -> None:
    gate = FusionGate()
    gate.receive(received())
    assert gate.opens_ns(END_NS) == END_NS + PATIENCE_NS
    gate.receive(transcribed("another"))
    assert gate.opens_ns(END_NS) is not None
    gate.receive(transcribed())
    assert gate.opens_ns(END_NS) is None


def test_it_waits_for_10_s_at_most() -> None:
    assert PATIENCE_NS == 10 * SECOND_NS
    gate = FusionGate()
    gate.receive(received())
    assert gate.opens_ns(END_NS + PATIENCE_NS) is None


def test_it_waits_for_no_transcript_of_a_call_without_sound() -> None:
    gate = FusionGate()
    gate.receive(received(samples=0))
    assert gate.opens_ns(END_NS) is None


@pytest.mark.parametrize(("state", "waits"), [("lost", False), ("on", True)])
def test_once_recognition_is_lost_it_waits_no_more(state: str, waits: bool) -> None:
    gate = FusionGate()
    gate.receive(received())
    gate.receive(Status(modality="asr", state=state))
    assert (gate.opens_ns(END_NS) is not None) == waits
    gate.receive(received("b"))
    assert (gate.opens_ns(END_NS) is not None) == waits


def test_only_a_gated_worker_asks_for_what_the_gate_needs() -> None:
    def keys(**options: Any) -> set[str]:
        return {wanted.key for wanted in reference(**options).description.inputs}

    assert keys(is_gated=True) - keys() == {"radio/*/tx", "status/*"}
