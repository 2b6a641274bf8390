"""The workers that AIRHILT brings along, around the engines of `airhilt.engine_families`."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from airhilt.assistant.language_model import LanguageModelSettings, UsesLanguageModel
from airhilt.engine_families import (
    ASSISTANTS,
    DETECTORS,
    ENHANCERS,
    FAMILIES,
    RECOGNISERS,
    VOICES,
    WORDINGS,
)
from airhilt.errors import LanguageModelError, WorkerError
from airhilt.messages import Told
from airhilt.workers.protocol import Worker

if TYPE_CHECKING:
    from airhilt.assistant.decision.worker import DecisionWorker

# Engines are imported where they are used: a run without speech or cameras starts without the
# libraries behind them.


def reference_worker(
    kind: str, engine: str | None = None, name: str | None = None, **settings: Any
) -> Worker:
    """Return one worker.

    Parameters
    ----------
    kind
        Modality of a family of engines, such as ``asr``.
    engine
        Engine as on the command line; None: the usual one.
    name
        Name of the worker; None: its kind.
    settings
        Settings of the worker that are not the defaults, as its class has them, or
        `vision_worker` or `decision_worker`.

    Raises
    ------
    AirhiltError
        The engine cannot be loaded, or there is no such worker.
    """
    name = name or kind
    match kind:
        case "enhancement":
            from airhilt.assistant.enhancement.worker import EnhancementWorker

            return EnhancementWorker(ENHANCERS.create(engine or "spectral"), name)
        case "asr":
            from airhilt.assistant.asr.worker import AsrWorker

            return AsrWorker(RECOGNISERS.create(engine or RECOGNISERS.default), name, **settings)
        case "tts":
            from airhilt.assistant.tts.worker import TtsWorker
            from airhilt.voices.engines import tts_engine

            return TtsWorker(tts_engine(engine or VOICES.default), name=name, **settings)
        case "vision":
            return vision_worker(engine or DETECTORS.default, name, **settings)
        case "decision":
            return decision_worker(engine or ASSISTANTS.default, name, **settings)
    kinds = sorted({family.modality for family in FAMILIES})
    raise WorkerError(f"no reference worker {kind!r}; expected one of {', '.join(kinds)}")


def vision_worker(
    engine: str,
    name: str = "vision",
    *,
    classes: Mapping[str, str] | None = None,
    shares_detections: bool = False,
) -> Worker:
    """Return the worker around a detector.

    Parameters
    ----------
    classes
        Labels by the names that the detector's model gives its classes.
    shares_detections
        True if it shares the detections of the same pictures with other runs.

    Raises
    ------
    VisionError
        The detector cannot be loaded.
    """
    from airhilt.assistant.vision.shared_looks import Reproducible, SharedLooks
    from airhilt.assistant.vision.worker import VisionWorker

    configuration = None if classes is None else {"classes": classes}
    detector = DETECTORS.create(engine, configuration)
    if shares_detections and isinstance(detector, Reproducible):
        return VisionWorker(detector, name, SharedLooks(detector))
    return VisionWorker(detector, name)


def decision_worker(
    engine: str = ASSISTANTS.default,
    name: str = "decision",
    *,
    wording: str = WORDINGS.default,
    configuration: Mapping[str, Any] | None = None,
    told: Told | None = None,
    is_gated: bool = False,
    llm: LanguageModelSettings | None = None,
) -> DecisionWorker:
    """Return the worker around a decision engine.

    Parameters
    ----------
    configuration
        Values of the configuration of the engine; None: the defaults.
    told
        Who is told of conflicts; None: whom the engine tells.
    llm
        Language model for an engine or a wording that asks one; None: there is none.

    Raises
    ------
    AirhiltError
        The engine or the wording cannot be loaded, or just one of the two is there: a language
        model, and somebody who asks it.
    """
    from airhilt.assistant.decision.worker import DecisionWorker

    parts = ASSISTANTS.create(engine, configuration), WORDINGS.create(wording)
    asking = [part for part in parts if isinstance(part, UsesLanguageModel)]
    if llm is None and asking:
        raise LanguageModelError(
            f"{asking[0].name!r} asks a language model; expected --llm URL of `airhilt cosim`, "
            "the address of an OpenAI-compatible endpoint"
        )
    if llm is not None:
        if not asking:
            raise LanguageModelError(
                f"--llm {llm.url}: nobody asks the language model; expected --assistant llm, "
                "--wording llm, or both"
            )
        for part in asking:
            part.use(llm)
    return DecisionWorker(*parts, told=told, is_gated=is_gated, name=name)
