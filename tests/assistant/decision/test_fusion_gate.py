"""Gated fusion: nothing is told while a transcript is to come."""

import pytest

from airhilt.assistant.decision import DecisionConfig, DecisionWorker
from airhilt.assistant.decision.fusion import PATIENCE_NS, FusionGate
from airhilt.messages import Status, Transcript, Transmission
from airhilt.units import SECOND_NS

END_NS = 5_000_000_000


def received(name="a", samples=16_000):
    return Transmission(id=name, frequency_khz=118_000, t_tx_ns=0, t_end_ns=END_NS, samples=samples)


def transcribed(name="a"):
    return Transcript(
        id=name, frequency_khz=118_000, t_tx_ns=0, t_end_ns=END_NS, text="x", confidence=1.0,
        engine="e",
    )  # fmt: skip


def test_the_gate_is_open_while_nothing_is_to_come():
    assert FusionGate().opens_ns(0) is None


def test_it_is_closed_from_the_end_of_a_call_to_its_transcript():
    gate = FusionGate()
    gate.take_transmission(received())
    assert gate.opens_ns(END_NS) == END_NS + PATIENCE_NS
    gate.take_transcript(transcribed("another"))
    assert gate.opens_ns(END_NS) is not None
    gate.take_transcript(transcribed())
    assert gate.opens_ns(END_NS) is None


def test_it_waits_for_10_s_at_most():
    assert PATIENCE_NS == 10 * SECOND_NS
    gate = FusionGate()
    gate.take_transmission(received())
    assert gate.opens_ns(END_NS + PATIENCE_NS) is None


def test_it_waits_for_no_transcript_of_a_call_without_sound():
    gate = FusionGate()
    gate.take_transmission(received(samples=0))
    assert gate.opens_ns(END_NS) is None


@pytest.mark.parametrize(("state", "waits"), [("lost", False), ("on", True)])
def test_once_recognition_is_lost_it_waits_no_more(state, waits):
    gate = FusionGate()
    gate.take_transmission(received())
    gate.take_status(Status(modality="asr", state=state))
    assert (gate.opens_ns(END_NS) is not None) == waits
    gate.take_transmission(received("b"))
    assert (gate.opens_ns(END_NS) is not None) == waits


def test_only_a_gated_worker_asks_for_what_the_gate_needs():
    def keys(config):
        return {wanted.key for wanted in DecisionWorker(config).description.inputs}

    gated = keys(DecisionConfig(is_gated=True))
    assert gated - keys(DecisionConfig()) == {"radio/*/tx", "status/*"}
