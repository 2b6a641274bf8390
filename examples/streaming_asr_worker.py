"""A recogniser that works while somebody speaks. Replace the class `Recognition` by your model.

    airhilt cosim --scenario s01a_bad_readback --snr 10 --endpoint tcp/127.0.0.1:7447 \
        --attach streaming
    python examples/streaming_asr_worker.py tcp/127.0.0.1:7447

It takes the chunks of each transmission as they come, at most 0.5 s of speech each. It gives the
transcript when the transmission has ended. Several transmissions may be on the air at once.
"""

import sys
from collections.abc import Sequence

import numpy as np

from airhilt.messages import (
    InputSpec,
    Transcript,
    TransmissionChunk,
    TransmissionClosed,
    TransmissionOpened,
    WorkerDescription,
)
from airhilt.sim import Input, Output
from airhilt.workers import Step, serve


class Recognition:
    """The recognition of one transmission, up to its newest chunk."""

    def __init__(self) -> None:
        self.seconds: list[float] = []

    def add(self, audio: np.ndarray) -> None:
        """Recognise the next samples (16 kHz, mono, from -1 to 1)."""
        self.seconds.append(len(audio) / 16_000)

    def result(self) -> tuple[str, float]:
        """Return the words of the transmission and their confidence (0 to 1)."""
        return f"about {sum(self.seconds):.0f} seconds in {len(self.seconds)} chunks", 0.1


class StreamingRecogniser:
    description = WorkerDescription(
        name="streaming",
        modality="asr",
        inputs=(InputSpec(key="radio/*/audio", policy="batch"),),
    )

    def __init__(self) -> None:
        self.on_air: dict[str, Recognition] = {}

    def step(self, t_ns: int, inputs: Sequence[Input]) -> Step:
        return Step(tuple(output for item in inputs for output in self.take(item)))

    def take(self, item: Input) -> list[Output]:
        match item.attachment["phase"]:
            case "opened":
                opened = TransmissionOpened.model_validate(item.attachment)
                self.on_air[opened.id] = Recognition()
            case "chunk":
                chunk = TransmissionChunk.model_validate(item.attachment)
                audio = np.frombuffer(item.payload, "<i2").astype(np.float32) / 32_768.0
                self.on_air[chunk.id].add(audio)
            case "closed":
                closed = TransmissionClosed.model_validate(item.attachment)
                return [self.transcript(closed, self.on_air.pop(closed.id))]
        return []

    def transcript(self, closed: TransmissionClosed, recognition: Recognition) -> Output:
        text, confidence = recognition.result()
        transcript = Transcript(
            id=closed.id, frequency_khz=closed.frequency_khz, t_tx_ns=closed.t_tx_ns,
            t_end_ns=closed.t_end_ns, text=text, confidence=confidence, engine="streaming",
        )  # fmt: skip
        return Output(f"asr/{closed.frequency_khz}", transcript.model_dump_json().encode())


if __name__ == "__main__":
    serve(StreamingRecogniser(), connect=sys.argv[1])
