"""The workers that AIRHILT brings along, around the engines of `airhilt.engine_families`."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from airhilt.assistant.language_model import LanguageModelSettings, UsesLanguageModel
from airhilt.engine_families import (
    ASSISTANTS,
    DETECTORS,
    FAMILIES,
    RECOGNISERS,
    VOICES,
    WORDINGS,
)
from airhilt.errors import LanguageModelError, WorkerError
from airhilt.messages import SPEAK_MIN_LEVEL, Severity
from airhilt.phraseology.numbers import Style
from airhilt.workers.protocol import Worker

if TYPE_CHECKING:
    from airhilt.assistant.decision.engine import DecisionEngine
    from airhilt.assistant.wording.engine import AdvisoryWording

# Engines are imported where they are used: a run without speech or cameras starts without the
# libraries behind them.


def reference_worker(
    kind: str,
    engine: str | None = None,
    name: str | None = None,
    configuration: Mapping[str, Any] | None = None,
) -> Worker:
    """Return one worker with its default settings.

    Parameters
    ----------
    kind
        Modality of a family of engines, such as ``asr``.
    engine
        Engine as on the command line; None: the usual one.
    name
        Name of the worker; None: its kind.
    configuration
        Values of the configuration of a decision engine; None: the defaults.

    Raises
    ------
    AirhiltError
        The engine cannot be loaded, or there is no such worker.
    """
    name = name or kind
    match kind:
        case "enhancement":
            return enhancement_worker(engine or "spectral", name)
        case "asr":
            return asr_worker(engine or RECOGNISERS.default, name)
        case "tts":
            return tts_worker(engine or VOICES.default, name)
        case "vision":
            return vision_worker(engine or DETECTORS.default, name)
        case "decision":
            return decision_worker(engine or ASSISTANTS.default, name, configuration=configuration)
    kinds = sorted({family.modality for family in FAMILIES})
    raise WorkerError(f"no reference worker {kind!r}; expected one of {', '.join(kinds)}")


def enhancement_worker(engine: str, name: str = "enhancement") -> Worker:
    """Return the worker around an enhancer.

    Raises
    ------
    SpeechError
        The enhancer cannot be loaded.
    """
    from airhilt.assistant.enhancement.engines import FAMILY
    from airhilt.assistant.enhancement.worker import EnhancementWorker

    return EnhancementWorker(FAMILY.create(engine), name)


def asr_worker(
    engine: str,
    name: str = "asr",
    *,
    gives_partials: bool = False,
    hears_enhanced: bool = False,
) -> Worker:
    """Return the worker around a recogniser.

    Parameters
    ----------
    gives_partials
        True if it gives partial transcripts of the calls that go on.
    hears_enhanced
        True if it recognises what an enhancer has made of the transmissions.

    Raises
    ------
    SpeechError
        The recogniser cannot be loaded.
    """
    from airhilt.assistant.asr.engines import asr_engine
    from airhilt.assistant.asr.worker import AsrWorker

    recogniser = asr_engine(engine)
    return AsrWorker(recogniser, name, gives_partials=gives_partials, hears_enhanced=hears_enhanced)


def tts_worker(
    engine: str,
    name: str = "tts",
    *,
    style: Style = "faa",
    speak_min_level: Severity = SPEAK_MIN_LEVEL,
) -> Worker:
    """Return the worker around a voice.

    Parameters
    ----------
    style
        Style in which it says numbers.
    speak_min_level
        Least severity that it speaks.

    Raises
    ------
    SpeechError
        The voice cannot be loaded.
    """
    from airhilt.assistant.tts.worker import TtsWorker
    from airhilt.voices.engines import tts_engine

    return TtsWorker(tts_engine(engine), speak_min_level, style=style, name=name)


def vision_worker(engine: str, name: str = "vision", *, shares_detections: bool = False) -> Worker:
    """Return the worker around a detector.

    Parameters
    ----------
    shares_detections
        True if it shares the detections of the same pictures with other runs.

    Raises
    ------
    VisionError
        The detector cannot be loaded.
    """
    from airhilt.assistant.vision.detectors import vision_engine
    from airhilt.assistant.vision.shared_looks import Reproducible, SharedLooks
    from airhilt.assistant.vision.worker import VisionWorker

    detector = vision_engine(engine)
    if shares_detections and isinstance(detector, Reproducible):
        return VisionWorker(detector, name, SharedLooks(detector))
    return VisionWorker(detector, name)


def decision_worker(
    engine: str = ASSISTANTS.default,
    name: str = "decision",
    *,
    wording: str = WORDINGS.default,
    configuration: Mapping[str, Any] | None = None,
    is_gated: bool = False,
    llm: LanguageModelSettings | None = None,
) -> Worker:
    """Return the worker around a decision engine.

    Parameters
    ----------
    configuration
        Values of the configuration of the engine; None: the defaults.
    llm
        Language model for an engine or a wording that asks one; None: there is none.

    Raises
    ------
    AirhiltError
        The engine or the wording cannot be loaded, or just one of the two is there: a language
        model, and somebody who asks it.
    """
    from airhilt.assistant.decision.engines import decision_engine
    from airhilt.assistant.decision.worker import DecisionWorker
    from airhilt.assistant.wording.engines import FAMILY

    parts = decision_engine(engine, configuration), FAMILY.create(wording)
    _connect_language_model(parts, llm)
    return DecisionWorker(*parts, is_gated=is_gated, name=name)


def _connect_language_model(
    parts: tuple[DecisionEngine, AdvisoryWording], llm: LanguageModelSettings | None
) -> None:
    """Give the language model to an engine and a wording that ask one.

    Raises
    ------
    LanguageModelError
        One asks a language model and there is none, or the other way round.
    """
    asking = [part for part in parts if isinstance(part, UsesLanguageModel)]
    if llm is None:
        if asking:
            raise LanguageModelError(
                f"{asking[0].name!r} asks a language model; expected --llm URL of `airhilt cosim`, "
                "the address of an OpenAI-compatible endpoint"
            )
        return
    if not asking:
        raise LanguageModelError(
            f"--llm {llm.url}: nobody asks the language model; expected --assistant llm, "
            "--wording llm, or both"
        )
    for part in asking:
        part.use(llm)
