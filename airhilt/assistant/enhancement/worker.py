"""The enhancement worker: transmissions in, the same with less noise out."""

from __future__ import annotations

import hashlib
from collections.abc import Sequence

from airhilt.assistant.enhancement.engine import Enhancer
from airhilt.audio.pcm import from_pcm, to_pcm
from airhilt.messages import (
    DeclaredLatency,
    EnhancedTransmission,
    InputSpec,
    Transmission,
    WorkerDescription,
)
from airhilt.sim.worker import Input, Output
from airhilt.workers.protocol import Step


class EnhancementWorker:
    """Gives each transmission to an enhancer, one after the other, and publishes the result."""

    def __init__(self, engine: Enhancer, name: str = "enhancement") -> None:
        self._engine = engine
        self.description = WorkerDescription(
            name=name,
            modality="enhancement",
            inputs=(InputSpec(key="radio/*/tx"),),
            latency=DeclaredLatency(median_s=0.05),
        )

    def step(self, t_ns: int, inputs: Sequence[Input]) -> Step:  # noqa: ARG002
        """Enhance the transmissions that have arrived."""
        return Step(tuple(output for item in inputs if (output := self._take(item)) is not None))

    def _take(self, item: Input) -> Output | None:
        header = Transmission.model_validate(item.attachment)
        if not header.samples and not item.payload:
            return None  # In a run without sound, its words arrive as text.
        pcm = to_pcm(self._engine.enhance(from_pcm(item.payload)))
        result = EnhancedTransmission(
            id=header.id,
            frequency_khz=header.frequency_khz,
            t_tx_ns=header.t_tx_ns,
            t_end_ns=header.t_end_ns,
            keyed_by=header.keyed_by,
            samples=header.samples,
            sha256=hashlib.sha256(pcm).hexdigest(),
            enhancer=self._engine.name,
        )
        return Output(
            f"enhanced/{header.frequency_khz}", pcm, attachment=result.model_dump(mode="json")
        )
