"""The ASR worker: transmissions in, transcripts out, also of calls that go on."""

from __future__ import annotations

from collections.abc import Sequence

from airhilt.assistant.asr.engine import AsrEngine, Call, recognised
from airhilt.assistant.asr.partial import PartialRecogniser
from airhilt.audio.pcm import from_pcm
from airhilt.errors import keeping_passing
from airhilt.messages import (
    Briefing,
    DeclaredLatency,
    EnhancedTransmission,
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
    """Gives each transmission to an engine, one after the other, and publishes the transcript.

    Parameters
    ----------
    gives_partials
        True to publish partial transcripts of the calls that go on as well. A step then takes all
        that waits, so that a whole call never waits behind its own beginning.
    hears_enhanced
        True to recognise what an enhancer has made of the transmissions.
    """

    def __init__(
        self,
        engine: AsrEngine,
        name: str = "asr",
        *,
        gives_partials: bool = False,
        hears_enhanced: bool = False,
    ) -> None:
        self._engine = engine
        self._partial = PartialRecogniser(engine) if gives_partials else None
        self._callsigns: tuple[str, ...] = ()
        self._controller = ""
        self.description = WorkerDescription(
            name=name,
            modality="asr",
            inputs=_inputs("enhanced/*" if hears_enhanced else "radio/*/tx", gives_partials),
            latency=DeclaredLatency(median_s=0.05),
        )

    def step(self, t_ns: int, inputs: Sequence[Input]) -> Step:  # noqa: ARG002
        """Recognise the transmissions that have arrived, and those that go on."""
        outputs: list[Output] = []
        missed: list[str] = []
        for item in inputs:
            with keeping_passing(missed):
                if (whole := self._take(item)) is not None:
                    key = f"asr/{whole.frequency_khz}"
                    outputs.append(Output(key, whole.model_dump_json().encode()))
        with keeping_passing(missed):
            for each in self._partial.partials(self._callsigns) if self._partial else ():
                key = f"asr/{each.frequency_khz}/partial"
                outputs.append(Output(key, each.model_dump_json().encode()))
        return Step(tuple(outputs), missed="; ".join(missed))

    def _take(self, item: Input) -> Transcript | None:
        if item.key == "briefing":
            briefing = Briefing.model_validate_json(item.payload)
            self._controller = briefing.controller
            self._callsigns = tuple(entry.callsign for entry in briefing.roster)
            return None
        if self._partial is not None and item.key.endswith("/audio"):
            self._partial.take(item)
            return None
        is_enhanced = item.key.startswith("enhanced/")
        model = EnhancedTransmission if is_enhanced else Transmission
        header = model.model_validate(item.attachment)
        if not header.samples and not item.payload:
            return None  # In a run without sound, its words arrive as text.
        call = Call(
            header.id, header.frequency_khz, header.t_tx_ns, header.keyed_by, self._callsigns
        )
        heard = recognised(self._engine, from_pcm(item.payload), call)
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


def _inputs(calls: str, gives_partials: bool) -> tuple[InputSpec, ...]:
    keys = (calls, "briefing")
    if gives_partials:
        return tuple(InputSpec(key=key, policy="batch") for key in (*keys, "radio/*/audio"))
    return tuple(InputSpec(key=key) for key in keys)
