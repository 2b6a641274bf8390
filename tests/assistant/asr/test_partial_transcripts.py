"""Calls are recognised while they last, if the run asks for that."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import pytest

from airhilt.assistant.asr.engine import Recognised
from airhilt.assistant.asr.worker import AsrWorker
from airhilt.audio.pcm import Audio, to_pcm
from airhilt.errors import WorkerError
from airhilt.messages import (
    PartialTranscript,
    Transcript,
    Transmission,
    TransmissionChunk,
    TransmissionClosed,
    TransmissionOpened,
)
from airhilt.options import Options
from airhilt.sim.worker import Input
from airhilt.units import SECOND_NS
from airhilt.workers.pool import parse_output, policy_of

KHZ = 134_325
HALF_SECOND = 8_000
SAID = ("american one", "american won two", "american one two three", "american one two three")
"""Words that are recognised in 0.5, 1, 1.5 and 2 s of the call."""


class Growing:
    """An `AsrEngine` that recognises more the longer the audio is."""

    name = "growing"

    def recognise(self, audio: Audio, callsigns: Sequence[str]) -> Recognised:
        words = SAID[len(audio) // HALF_SECOND - 1].split()
        return Recognised(" ".join(words), tuple((word, 0.9) for word in words), 0.9)


def opened(name: str = "call") -> Input:
    header = TransmissionOpened(id=name, frequency_khz=KHZ, t_tx_ns=SECOND_NS)
    return Input(f"radio/{KHZ}/audio", SECOND_NS, b"", header.model_dump(mode="json"))


def chunk(seq: int, name: str = "call") -> Input:
    pcm = to_pcm(np.zeros(HALF_SECOND, np.float32))
    first = seq * HALF_SECOND
    header = TransmissionChunk(
        id=name, frequency_khz=KHZ, seq=seq, first_sample=first, samples=HALF_SECOND, sha256="0"
    )
    return Input(f"radio/{KHZ}/audio", SECOND_NS, pcm, header.model_dump(mode="json"))


def ended(count: int) -> tuple[Input, Input]:
    times = {"frequency_khz": KHZ, "t_tx_ns": SECOND_NS, "t_end_ns": 3 * SECOND_NS}
    samples = count * HALF_SECOND
    closed = TransmissionClosed.model_validate({"id": "call", "samples": samples, **times})
    whole = Transmission.model_validate({"id": "call", "samples": samples, **times})
    pcm = to_pcm(np.zeros(samples, np.float32))
    return (
        Input(f"radio/{KHZ}/audio", SECOND_NS, b"", closed.model_dump(mode="json")),
        Input(f"radio/{KHZ}/tx", SECOND_NS, pcm, whole.model_dump(mode="json")),
    )


def given(worker: AsrWorker, *inputs: Input) -> list[PartialTranscript | Transcript]:
    """Return what a worker publishes on its inputs; each message must be that of its key."""
    messages = []
    for output in worker.step(SECOND_NS, inputs).outputs:
        message = parse_output("asr", output.key, output.payload, 10**12)
        assert isinstance(message, PartialTranscript | Transcript)
        messages.append(message)
    return messages


def test_each_chunk_gives_the_words_so_far_and_how_many_of_them_are_stable() -> None:
    worker = AsrWorker(Growing(), gives_partials=True)
    assert given(worker, opened()) == []
    partials = [message for seq in range(4) for message in given(worker, chunk(seq))]
    assert [partial.text for partial in partials] == list(SAID)
    assert [getattr(partial, "stable_words", None) for partial in partials] == [0, 1, 1, 4]
    heard = [getattr(partial, "t_heard_ns", None) for partial in partials]
    assert heard == [round(t_s * SECOND_NS) for t_s in (1.5, 2.0, 2.5, 3.0)]


def test_chunks_that_have_waited_are_recognised_together() -> None:
    worker = AsrWorker(Growing(), gives_partials=True)
    (partial,) = given(worker, opened(), chunk(0), chunk(1))
    assert partial.text == SAID[1]


def test_a_call_that_has_ended_has_its_whole_transcript_and_no_other() -> None:
    worker = AsrWorker(Growing(), gives_partials=True)
    given(worker, opened(), chunk(0), chunk(1), chunk(2))
    (whole,) = given(worker, chunk(3), *ended(4))
    assert isinstance(whole, Transcript)
    assert whole.text == SAID[3]
    assert given(worker, chunk(3)) == []


def test_a_worker_that_is_not_asked_for_it_does_not_hear_calls_before_their_end() -> None:
    assert not Options().partial_transcripts
    for gives_partials, policy in ((False, None), (True, "batch")):
        inputs = AsrWorker(Growing(), gives_partials=gives_partials).description.inputs
        policies = {wanted.key: wanted.policy for wanted in inputs}
        assert policy_of(f"radio/{KHZ}/audio", policies) == policy


def test_a_partial_transcript_names_its_frequency_in_the_key() -> None:
    worker = AsrWorker(Growing(), gives_partials=True)
    (output,) = worker.step(SECOND_NS, (opened(), chunk(0))).outputs
    assert output.key == f"asr/{KHZ}/partial"
    with pytest.raises(WorkerError, match="a partial transcript of 134325 kHz"):
        parse_output("asr", "asr/118300/partial", output.payload, 0)
