"""Noise is reduced in a stage of its own, before speech is recognised."""

from __future__ import annotations

import hashlib
from collections.abc import Sequence

import numpy as np
import pytest

from airhilt.assistant.asr.engine import Recognised
from airhilt.assistant.asr.worker import AsrWorker
from airhilt.assistant.enhancement.worker import EnhancementWorker
from airhilt.audio.pcm import Audio, from_pcm, to_pcm
from airhilt.cosim.option_checks import check_options
from airhilt.cosim.requested import STAGES
from airhilt.errors import AirhiltError, WorkerError
from airhilt.messages import EnhancedTransmission, Transcript, Transmission
from airhilt.metrics.latencies import StageLatencies
from airhilt.options import Options
from airhilt.sim.worker import Input
from airhilt.units import SECOND_NS
from airhilt.workers.pool import parse_output
from airhilt.world.loading import load

KHZ = 134_325


class Halving:
    name = "halving"

    def enhance(self, audio: Audio) -> Audio:
        return np.asarray(0.5 * audio, np.float32)


class Loudness:
    """An `AsrEngine` that hears how loud the audio is."""

    name = "loudness"

    def recognise(self, audio: Audio, callsigns: Sequence[str]) -> Recognised:
        return Recognised(f"{float(np.abs(audio).max()):.2f}", (), 1.0)


def transmission(samples: int = 1_600) -> Input:
    pcm = to_pcm(np.full(samples, 0.5, np.float32))
    header = Transmission(
        id="call",
        frequency_khz=KHZ,
        t_tx_ns=SECOND_NS,
        t_end_ns=3 * SECOND_NS,
        keyed_by="Tower",
        samples=samples,
        sha256=hashlib.sha256(pcm).hexdigest(),
    )
    return Input(f"radio/{KHZ}/tx", 3 * SECOND_NS, pcm, header.model_dump(mode="json"))


def test_the_recogniser_hears_what_the_enhancer_has_made_of_a_call() -> None:
    (output,) = EnhancementWorker(Halving()).step(0, (transmission(),)).outputs
    message = parse_output("enhancement", output.key, output.payload, 10**12, output.attachment)
    assert isinstance(message, EnhancedTransmission)
    assert (message.id, message.keyed_by, message.enhancer) == ("call", "Tower", "halving")
    assert (message.t_tx_ns, message.t_end_ns) == (SECOND_NS, 3 * SECOND_NS)
    assert np.allclose(from_pcm(output.payload), 0.25)
    worker = AsrWorker(Loudness(), hears_enhanced=True)
    assert [wanted.key for wanted in worker.description.inputs] == ["enhanced/*", "briefing"]
    (heard,) = worker.step(0, (Input(output.key, 0, output.payload, output.attachment),)).outputs
    transcript = Transcript.model_validate_json(heard.payload)
    assert (transcript.id, transcript.text, transcript.t_end_ns) == ("call", "0.25", 3 * SECOND_NS)


def test_enhanced_audio_must_be_what_its_header_says_and_on_its_frequency() -> None:
    (output,) = EnhancementWorker(Halving()).step(0, (transmission(),)).outputs
    with pytest.raises(WorkerError, match="not what their header says"):
        parse_output("w", output.key, output.payload[2:], 0, output.attachment)
    with pytest.raises(WorkerError, match="expected the frequency in the key"):
        parse_output("w", "enhanced/118000", output.payload, 0, output.attachment)


def test_its_latency_is_a_stage_of_its_own() -> None:
    assert "enhancement" in STAGES
    latencies = StageLatencies()
    assert "enhancement" not in latencies.statistics()
    latencies.take(
        EnhancedTransmission(
            t_ns=4 * SECOND_NS, id="call", frequency_khz=KHZ, t_tx_ns=SECOND_NS,
            t_end_ns=3 * SECOND_NS, samples=1, sha256="0", enhancer="halving",
        )
    )  # fmt: skip
    assert latencies.statistics()["enhancement"].p50_s == 1.0


@pytest.mark.parametrize(
    ("options", "says"),
    [
        (Options(enhancer="spectral"), "would do nothing with --topology parallel"),
        (Options(enhancer="spectral", topology="asr_first", speech=False), "--no-speech"),
        (
            Options(enhancer="spectral", topology="asr_first", partial_transcripts=True),
            "--partial-transcripts",
        ),
        (Options(enhancer="spectrul", topology="asr_first"), "did you mean 'spectral'"),
    ],
)
def test_an_enhancer_that_would_do_nothing_is_refused(options: Options, says: str) -> None:
    with pytest.raises(AirhiltError, match=says):
        check_options(options, load("s01a_nominal"))
    check_options(Options(enhancer="spectral", topology="asr_first"), load("s01a_nominal"))
