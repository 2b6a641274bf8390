"""The worker that listens to the radio."""

from __future__ import annotations

import hashlib
from collections.abc import Sequence
from typing import Any

import numpy as np

from airhilt.assistant.asr.engine import Recognised
from airhilt.assistant.asr.worker import AsrWorker
from airhilt.audio.pcm import Audio, to_pcm
from airhilt.messages import Briefing, RosterEntry, Transcript, Transmission, Word
from airhilt.sim.worker import Input, Output
from airhilt.workers.pool import parse_output


class Counting:
    """An `AsrEngine` that hears how many samples there were."""

    name = "counting"

    def __init__(self) -> None:
        self.asked: list[tuple[Audio, tuple[str, ...]]] = []

    def recognise(self, audio: Audio, callsigns: Sequence[str]) -> Recognised:
        self.asked.append((audio, tuple(callsigns)))
        words = (("samples", 0.5), (str(len(audio)), 0.75))
        return Recognised(f"samples {len(audio)}", words, 0.625)


def transmission(name: str = "call", samples: int = 1_600, **changes: Any) -> Input:
    pcm = to_pcm(np.linspace(-0.5, 0.5, samples, dtype=np.float32))
    header = {
        "id": name,
        "frequency_khz": 134_325,
        "t_tx_ns": 1_000_000_000,
        "t_end_ns": 3_000_000_000,
        "samples": samples,
        "sha256": hashlib.sha256(pcm).hexdigest(),
    }
    attachment = Transmission.model_validate(header | changes).model_dump(mode="json")
    return Input(f"radio/{attachment['frequency_khz']}/tx", 3_000_000_000, pcm, attachment)


def briefing(*callsigns: str) -> Input:
    roster = tuple(
        RosterEntry(callsign=callsign, category="aircraft", type="B738") for callsign in callsigns
    )
    message = Briefing(
        controller="TOWER",
        horizontal_separation_nm=3.0,
        vertical_separation_ft=1_000.0,
        roster=roster,
    )
    return Input("briefing", 0, message.model_dump_json().encode())


def transcripts(worker: AsrWorker, *inputs: Input) -> list[Transcript]:
    outputs = worker.step(3_000_000_000, inputs).outputs
    return [checked(output) for output in outputs]


def checked(output: Output) -> Transcript:
    message = parse_output("asr", output.key, output.payload, 10**12, output.attachment)
    assert isinstance(message, Transcript)
    return message


def test_a_transmission_becomes_a_transcript_of_it() -> None:
    (transcript,) = transcripts(AsrWorker(Counting()), transmission("readback", 1_600))
    assert transcript == Transcript(
        id="readback",
        frequency_khz=134_325,
        t_tx_ns=1_000_000_000,
        t_end_ns=3_000_000_000,
        text="samples 1600",
        words=(Word(text="samples", confidence=0.5), Word(text="1600", confidence=0.75)),
        confidence=0.625,
        engine="counting",
    )


def test_transmissions_are_taken_in_order_each_on_its_frequency() -> None:
    sent = [
        transmission("first", 16),
        transmission("second", 32, frequency_khz=119_100),
        transmission("third", 48),
    ]
    worker = AsrWorker(Counting())
    assert [output.key for output in worker.step(0, sent).outputs] == [
        "asr/134325",
        "asr/119100",
        "asr/134325",
    ]
    assert [(one.id, one.text) for one in transcripts(worker, *sent)] == [
        ("first", "samples 16"),
        ("second", "samples 32"),
        ("third", "samples 48"),
    ]


def test_a_run_without_sound_has_nothing_to_recognise() -> None:
    engine = Counting()
    assert transcripts(AsrWorker(engine), transmission(samples=0)) == []
    assert engine.asked == []


def test_a_briefing_tells_who_may_be_on_the_frequency_and_is_no_call() -> None:
    engine = Counting()
    worker = AsrWorker(engine)
    assert transcripts(worker, briefing("AAL123", "DAL456")) == []
    transcripts(worker, transmission())
    transcripts(worker, transmission())
    assert [callsigns for _, callsigns in engine.asked] == [("AAL123", "DAL456")] * 2
