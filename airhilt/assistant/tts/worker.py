"""The TTS worker: advisories in, the assistant's voice out."""

from __future__ import annotations

import hashlib
from collections.abc import Sequence

from airhilt.audio.pcm import SAMPLE_BYTES, to_pcm
from airhilt.messages import (
    ASSISTANT,
    SPEAK_MIN_LEVEL,
    Advisory,
    AdvisoryAudio,
    Briefing,
    DeclaredLatency,
    InputSpec,
    Severity,
    WorkerDescription,
)
from airhilt.phraseology.aloud import read_aloud
from airhilt.phraseology.numbers import Style
from airhilt.sim.worker import Input, Output
from airhilt.voices.engine import TtsEngine
from airhilt.workers.protocol import Step


class TtsWorker:
    """Speaks the urgent advisories with one voice.

    An advisory to several recipients comes once to each; each copy is spoken, because every
    recipient has a loudspeaker. The recipient's own callsign is said on a frequency, but not by the
    loudspeaker in its cockpit, as the briefing tells.

    Parameters
    ----------
    speak_min_level
        Least severity that is spoken.
    """

    def __init__(
        self,
        engine: TtsEngine,
        speak_min_level: Severity = SPEAK_MIN_LEVEL,
        style: Style = "faa",
        name: str = "tts",
    ) -> None:
        self.description = WorkerDescription(
            name=name,
            modality="tts",
            inputs=tuple(InputSpec(key=key, policy="fifo") for key in ("advisory/*", "briefing")),
            latency=DeclaredLatency(median_s=0.1),
        )
        self._engine = engine
        self._voice = engine.voice_of(ASSISTANT)
        self._speak_min_level = speak_min_level
        self._style = style
        self._says_callsign = False

    def step(self, t_ns: int, inputs: Sequence[Input]) -> Step:  # noqa: ARG002
        """Speak the advisories that are active and urgent enough."""
        least = self._speak_min_level.rank
        spoken: list[Output] = []
        for item in inputs:
            if item.key == "briefing":
                briefing = Briefing.model_validate_json(item.payload)
                self._says_callsign = briefing.advisory_channel == "frequency"
                continue
            advisory = Advisory.model_validate_json(item.payload)
            if advisory.active and advisory.severity.rank >= least:
                spoken.append(self._speak(advisory))
        return Step(tuple(spoken))

    def _speak(self, advisory: Advisory) -> Output:
        text = read_aloud(
            advisory.message, advisory.recipient, self._style, says_callsign=self._says_callsign
        )
        pcm = to_pcm(self._engine.synthesise(text, self._voice))
        header = AdvisoryAudio(
            id=advisory.id,
            revision=advisory.revision,
            recipient=advisory.recipient,
            text=text,
            t_dec_ns=advisory.t_ns,
            engine=self._engine.name,
            samples=len(pcm) // SAMPLE_BYTES,
            sha256=hashlib.sha256(pcm).hexdigest(),
        )
        return Output(f"tts/{advisory.id}", pcm, attachment=header.model_dump(mode="json"))
