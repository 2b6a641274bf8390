"""The workers that AIRHILT brings along, for what no attached worker does."""

from __future__ import annotations

from collections.abc import Collection
from typing import Any, Literal, NamedTuple

from airhilt.assistant.decision import DecisionConfig, DecisionWorker
from airhilt.engines import EngineFamily
from airhilt.errors import WorkerError
from airhilt.messages import Modality
from airhilt.phraseology.numbers import Style
from airhilt.scenario.models import Radio
from airhilt.workers.protocol import Worker

ASR = "embedded"
TTS = "espeak"
DETECTOR = "embedded"
"""The engines unless others are named."""
DEFAULTS = {"airhilt.asr": ASR, "airhilt.tts": TTS, "airhilt.detectors": DETECTOR}
"""The engine of each family unless another is named, by entry point group."""

AssistantName = Literal["reference", "none", "external"]


class Engines(NamedTuple):
    """What the reference workers work with, as on the command line; None: not at all."""

    asr: str | None = None
    tts: str | None = None
    detector: str | None = None


def reference_workers(
    assistant: AssistantName,
    radio: Radio,
    taken: Collection[Modality],
    engines: Engines,
) -> list[Worker]:
    """Return the workers that a run needs and has not got.

    Only ``reference`` has the decision worker. There is somebody who recognises speech unless
    nobody would read it, and a voice and somebody who looks where there is somebody who decides.

    Parameters
    ----------
    taken
        What attached workers do.

    Raises
    ------
    airhilt.errors.SpeechError, airhilt.errors.VisionError
        An engine cannot be loaded.
    """
    workers: list[Worker] = []
    is_assisted = assistant != "none"
    asr, tts, detector = engines
    if asr is not None and "asr" not in taken and (is_assisted or radio.topology == "asr_first"):
        workers.append(reference_worker("asr", asr))
    if tts is not None and "tts" not in taken and is_assisted:
        workers.append(reference_worker("tts", tts, style=radio.phraseology))
    if detector is not None and "vision" not in taken and is_assisted:
        workers.append(reference_worker("vision", detector))
    if assistant == "reference" and "decision" not in taken:
        workers.append(DecisionWorker(DecisionConfig(is_gated=radio.topology == "gated_fusion")))
    return workers


def families() -> tuple[EngineFamily[Any], ...]:
    """Return the families of engines that workers are made of."""
    # Not at the top: a run without speech or cameras starts without the libraries behind them.
    from airhilt.assistant.asr import engines as asr
    from airhilt.assistant.vision import detectors
    from airhilt.voices import engines as voices

    return asr.FAMILY, voices.FAMILY, detectors.FAMILY


def reference_worker(
    kind: str, engine: str | None = None, name: str | None = None, style: Style = "faa"
) -> Worker:
    """Return one worker with its default settings.

    Parameters
    ----------
    kind
        ``decision``, ``asr``, ``tts`` or ``vision``.
    engine
        Of all but ``decision``.
    style
        Of ``tts``: how numbers are said.

    Raises
    ------
    airhilt.errors.SpeechError, airhilt.errors.VisionError
        The engine cannot be loaded.
    WorkerError
        There is no such worker, or it has no engine.
    """
    # Not at the top: a run without speech or cameras starts without the libraries behind them.
    match kind:
        case "asr":
            from airhilt.assistant.asr.engines import asr_engine
            from airhilt.assistant.asr.worker import AsrWorker

            return AsrWorker(asr_engine(ASR if engine is None else engine), name=name or kind)
        case "tts":
            from airhilt.assistant.tts.worker import TtsWorker
            from airhilt.voices.engines import tts_engine

            return TtsWorker(
                tts_engine(TTS if engine is None else engine), style=style, name=name or kind
            )
        case "vision":
            from airhilt.assistant.vision.detectors import vision_engine
            from airhilt.assistant.vision.worker import VisionWorker

            return VisionWorker(vision_engine(DETECTOR if engine is None else engine), name or kind)
        case "decision" if engine is None:
            return DecisionWorker(name=name or kind)
        case "decision":
            raise WorkerError(f"worker decision has no engines to choose from; got {engine!r}")
    raise WorkerError(f"no reference worker {kind!r}; expected decision, asr, tts or vision")
