"""The ASR worker: transmissions in, transcripts out."""

from __future__ import annotations

from collections.abc import Sequence

from airhilt.assistant.asr.engine import AsrEngine
from airhilt.audio.pcm import SAMPLE_BYTES, SAMPLE_RATE_HZ, Audio, from_pcm
from airhilt.errors import SpeechError
from airhilt.messages import (
    Briefing,
    DeclaredLatency,
    InputSpec,
    Transcript,
    Transmission,
    Word,
    WorkerDescription,
)
from airhilt.phraseology.parties import with_parties
from airhilt.sim.worker import Input, Output
from airhilt.workers.protocol import Step


class AsrWorker:
    """Gives each transmission to an engine, one after the other, and publishes the transcript."""

    def __init__(self, engine: AsrEngine, name: str = "asr") -> None:
        self._engine = engine
        self._callsigns: tuple[str, ...] = ()
        self._controller = ""
        self.description = WorkerDescription(
            name=name,
            modality="asr",
            inputs=(InputSpec(key="radio/*/tx"), InputSpec(key="briefing")),
            latency=DeclaredLatency(median_s=0.05),
        )

    def step(self, t_ns: int, inputs: Sequence[Input]) -> Step:  # noqa: ARG002
        """Recognise the transmissions that have arrived.

        Raises
        ------
        SpeechError
            The engine has failed, or the audio is not what its header says.
        """
        return Step(
            tuple(
                Output(f"asr/{transcript.frequency_khz}", transcript.model_dump_json().encode())
                for item in inputs
                if (transcript := self._take(item)) is not None
            )
        )

    def _take(self, item: Input) -> Transcript | None:
        if item.key == "briefing":
            briefing = Briefing.model_validate_json(item.payload)
            self._controller = briefing.controller
            self._callsigns = tuple(entry.callsign for entry in briefing.roster)
            return None
        header = Transmission.model_validate(item.attachment)
        if not header.samples and not item.payload:
            return None  # In a run without sound, its words arrive as text.
        heard = self._engine.recognise(pcm_to_audio(header, item.payload), self._callsigns)
        transcript = Transcript(
            id=header.id,
            frequency_khz=header.frequency_khz,
            t_tx_ns=header.t_tx_ns,
            t_end_ns=header.t_end_ns,
            text=heard.text,
            words=tuple(Word(text=text, confidence=trust) for text, trust in heard.words),
            confidence=heard.confidence,
            engine=self._engine.name,
        )
        return with_parties(transcript, self._callsigns, self._controller, header.keyed_by)


def pcm_to_audio(header: Transmission, pcm: bytes) -> Audio:
    """Return the samples of a transmission.

    Raises
    ------
    SpeechError
        Their number or their rate is not what the header says.
    """
    if header.sample_rate_hz != SAMPLE_RATE_HZ or len(pcm) != SAMPLE_BYTES * header.samples:
        raise SpeechError(
            f"transmission {header.id}: {len(pcm)} bytes at {header.sample_rate_hz} Hz; expected "
            f"{header.samples} samples of 16 bits at {SAMPLE_RATE_HZ} Hz"
        )
    return from_pcm(pcm)
