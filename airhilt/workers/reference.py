"""The workers that AIRHILT brings along, for what no attached worker does."""

from __future__ import annotations

from collections.abc import Collection
from typing import Literal

from airhilt.messages import Modality
from airhilt.scenario.models import Topology
from airhilt.workers.decision import DecisionConfig, DecisionWorker
from airhilt.workers.protocol import Worker

AssistantName = Literal["reference", "none", "external"]


def reference_workers(
    assistant: AssistantName,
    topology: Topology,
    taken: Collection[Modality],
    asr: str | None,
    tts: str | None,
) -> list[Worker]:
    """Return the workers that a run needs and has not got.

    Only ``reference`` has the decision worker. There is somebody who recognises speech unless
    nobody would read it, and a voice where there is somebody who decides.

    Parameters
    ----------
    taken
        What attached workers do.
    asr, tts
        Engines, as on the command line; None without speech.

    Raises
    ------
    airhilt.errors.SpeechError
        An engine cannot be loaded.
    """
    workers: list[Worker] = []
    is_assisted = assistant != "none"
    if asr is not None and "speech" not in taken and (is_assisted or topology == "asr_first"):
        # Not at the top: a run without speech starts without the libraries behind it.
        from airhilt.workers.asr.engines import asr_engine
        from airhilt.workers.asr.worker import AsrWorker

        workers.append(AsrWorker(asr_engine(asr)))
    if tts is not None and "voice" not in taken and is_assisted:
        from airhilt.radio.voices.engines import tts_engine
        from airhilt.workers.tts.worker import TtsWorker

        workers.append(TtsWorker(tts_engine(tts)))
    if assistant == "reference" and "decision" not in taken:
        workers.append(DecisionWorker(DecisionConfig(is_gated=topology == "gated_fusion")))
    return workers
