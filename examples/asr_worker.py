"""A recogniser, with AIRHILT's SDK. Replace the function `recognise` by your model.

    airhilt cosim --scenario s01a_bad_readback --snr 10 --endpoint tcp/127.0.0.1:7447 --attach mine
    python examples/asr_worker.py tcp/127.0.0.1:7447

This one gives the length of each call as its text. It replaces the embedded recogniser. The report
compares its transcripts with the words that were said.
"""

import sys
from collections.abc import Sequence

import numpy as np

from airhilt.messages import InputSpec, Transcript, Transmission, WorkerDescription
from airhilt.sim import Input, Output
from airhilt.workers import Step, serve


def recognise(audio: np.ndarray) -> tuple[str, float]:
    """Return the words of a call (16 kHz, mono, from -1 to 1) and their confidence (0 to 1)."""
    return f"about {len(audio) / 16_000:.0f} seconds of speech", 0.1


class MyRecogniser:
    description = WorkerDescription(
        name="mine", modality="asr", inputs=(InputSpec(key="radio/*/tx"),)
    )

    def step(self, t_ns: int, inputs: Sequence[Input]) -> Step:
        return Step(tuple(self.transcript(item) for item in inputs))

    def transcript(self, item: Input) -> Output:
        call = Transmission.model_validate(item.attachment)
        audio = np.frombuffer(item.payload, "<i2").astype(np.float32) / 32_768.0
        text, confidence = recognise(audio)
        transcript = Transcript(
            id=call.id, frequency_khz=call.frequency_khz, t_tx_ns=call.t_tx_ns,
            t_end_ns=call.t_end_ns, text=text, confidence=confidence, engine="mine",
        )  # fmt: skip
        return Output(f"asr/{call.frequency_khz}", transcript.model_dump_json().encode())


if __name__ == "__main__":
    serve(MyRecogniser(), connect=sys.argv[1])
