"""The workers that AIRHILT brings along, for what no attached worker does."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Any, NamedTuple, Protocol

from airhilt.assistant.language_model import LanguageModelSettings, UsesLanguageModel
from airhilt.engines import ASR, ASSISTANT, DETECTOR, ENHANCER, TTS, WORDING, Engine, EngineFamily
from airhilt.errors import LanguageModelError, WorkerError
from airhilt.messages import SPEAK_MIN_LEVEL, Modality, Severity, WorkerDescription
from airhilt.phraseology.numbers import Style
from airhilt.workers.protocol import Worker

if TYPE_CHECKING:
    from airhilt.assistant.decision.engine import DecisionEngine
    from airhilt.assistant.wording.engine import AdvisoryWording

DEFAULTS = {
    "airhilt.enhancers": ENHANCER,
    "airhilt.asr": ASR,
    "airhilt.tts": TTS,
    "airhilt.detectors": DETECTOR,
    "airhilt.assistants": ASSISTANT,
    "airhilt.wording": WORDING,
}
"""The engine of each family unless another is named, by entry point group."""
NO_ASSISTANT = "none"
"""Name that stands for no assistant: nobody decides, and nobody is warned."""
NO_DETECTOR = "none"
"""Name that stands for no detector: no worker looks at pictures."""
NO_ENHANCER = "none"
"""Name that stands for no enhancer: recognisers get the audio as it was received."""
EMBEDDED_ENHANCER = "spectral"
"""Engine of a worker that enhances, unless another is named."""
EXTERNAL = "external"
"""Name that stands for a worker or program of the user, which decides."""


class Engines(NamedTuple):
    """Engines of the reference workers, as on the command line; None: no such worker."""

    asr: str | None = None
    tts: str | None = None
    detector: str | None = None
    wording: str = WORDING
    llm: LanguageModelSettings | None = None
    configuration: Mapping[str, Any] | None = None
    """Configuration of the decision engine; None: its own defaults."""
    shares_detections: bool = False
    """Detections of the same pictures are shared with other runs."""
    partial_transcripts: bool = False
    """Calls are recognised while they last, too."""
    enhancer: str | None = None


class RadioSetup(Protocol):
    """Use of the radio by a scenario, as far as workers depend on it."""

    @property
    def topology(self) -> str:
        """``parallel``, ``asr_first`` or ``gated_fusion``."""

    @property
    def phraseology(self) -> Style:
        """Style in which numbers are said."""


def reference_workers(
    assistant: str,
    radio: RadioSetup,
    taken: Collection[Modality],
    engines: Engines,
    *,
    people_speak: bool = False,
) -> list[Worker]:
    """Return the workers that a run needs and has not got.

    Speech is recognised unless nobody would read it. Where somebody decides, there is a voice, and
    somebody looks at pictures.

    Parameters
    ----------
    taken
        Tasks of the attached workers.
    people_speak
        True if people may speak, whom automata understand by a recogniser.

    Raises
    ------
    AirhiltError
        An engine cannot be loaded.
    """
    workers: list[Worker] = []
    is_assisted = assistant != NO_ASSISTANT
    _, tts, detector, wording, llm, configuration, shares_detections, *_ = engines
    if is_assisted or people_speak or radio.topology == "asr_first":
        workers += _recognition(taken, engines)
    deciding: list[Worker] = []
    if assistant not in (NO_ASSISTANT, EXTERNAL) and "decision" not in taken:
        is_gated = radio.topology == "gated_fusion"
        also = (NO_ASSISTANT, EXTERNAL)
        deciding.append(
            decision_worker(
                assistant,
                wording,
                configuration=configuration,
                is_gated=is_gated,
                also=also,
                llm=llm,
            )
        )
    if tts is not None and "tts" not in taken and is_assisted:
        level = speak_min_level(worker.description for worker in deciding)
        voice = reference_worker("tts", tts, style=radio.phraseology, speak_min_level=level)
        workers.append(voice)
    if detector is not None and "vision" not in taken and is_assisted:
        vision = reference_worker(
            "vision", detector, also=(NO_DETECTOR,), shares_detections=shares_detections
        )
        workers.append(vision)
    return workers + deciding


def _recognition(taken: Collection[Modality], engines: Engines) -> Iterator[Worker]:
    """Yield the workers that enhance and recognise speech, as far as nobody else does."""
    is_enhanced = "enhancement" in taken
    if engines.enhancer is not None and not is_enhanced:
        is_enhanced = True
        yield reference_worker("enhancement", engines.enhancer)
    if engines.asr is None or "asr" in taken:
        return
    yield asr_worker(
        engines.asr, gives_partials=engines.partial_transcripts, hears_enhanced=is_enhanced
    )


def speak_min_level(workers: Iterable[WorkerDescription]) -> Severity:
    """Return the least severity that is spoken, by the configuration of the decision engine."""
    for worker in workers:
        level = worker.configuration.get("speak_min_level")
        if worker.modality == "decision" and level is not None:
            return Severity(level)
    return SPEAK_MIN_LEVEL


def asr_worker(
    engine: str, name: str = "asr", *, gives_partials: bool = False, hears_enhanced: bool = False
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


def decision_worker(
    engine: str = ASSISTANT,
    wording: str = WORDING,
    *,
    configuration: Mapping[str, Any] | None = None,
    is_gated: bool = False,
    name: str = "decision",
    also: Sequence[str] = (),
    llm: LanguageModelSettings | None = None,
) -> Worker:
    """Return the worker around a decision engine.

    Parameters
    ----------
    configuration
        Values of the configuration of the engine; None: the defaults.
    also
        Words that the caller takes in the place of an engine, such as ``none``, for error messages.
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
    from airhilt.assistant.wording.engines import advisory_wording

    parts = decision_engine(engine, also, configuration), advisory_wording(wording)
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


def is_own_engine(name: str) -> bool:
    """Return whether a decision engine of that name comes with AIRHILT; empty names none.

    The one that asks a service does not count: the service is the user's.
    """
    from airhilt.assistant.decision.engines import FAMILY
    from airhilt.assistant.decision.engines.http import ENGINE as SERVICE

    return name != SERVICE.name and any(point.name == name for point in FAMILY.own())


def is_remote(modality: Modality, assistant: str, engines: Engines) -> bool:
    """Return whether the reference worker of a modality asks a program elsewhere.

    Raises
    ------
    AirhiltError
        There is no engine of such a name here.
    """
    return any(engine.is_remote for _, engine in _engines_of(modality, assistant, engines))


def is_of_user(modality: Modality, assistant: str, engines: Engines) -> bool:
    """Return whether the reference worker of a modality has an engine that AIRHILT does not bring.

    That is one of another package, or a program elsewhere; the errors are those of `is_remote`.
    """
    return any(
        engine.is_remote or not family.brings(engine.name)
        for family, engine in _engines_of(modality, assistant, engines)
    )


def _engines_of(
    modality: Modality, assistant: str, engines: Engines
) -> Iterator[tuple[EngineFamily[Any], Engine[Any]]]:
    """Yield the engines of the reference worker of a modality, each with its family."""
    asr, tts, detector, wording, *_ = engines
    names = {
        "airhilt.enhancers": ("enhancement", engines.enhancer),
        "airhilt.asr": ("asr", asr),
        "airhilt.tts": ("tts", tts),
        "airhilt.detectors": ("vision", detector),
        "airhilt.assistants": ("decision", assistant),
        "airhilt.wording": ("decision", wording),
    }
    for family in families():
        does, name = names[family.group]
        if does == modality and name is not None:
            yield family, family.choose(name)[0]


def families() -> tuple[EngineFamily[Any], ...]:
    """Return the families of engines that workers are made of."""
    # Not at the top: a run without speech or cameras starts without the libraries behind them.
    from airhilt.assistant.asr import engines as asr
    from airhilt.assistant.decision import engines as decision
    from airhilt.assistant.enhancement import engines as enhancement
    from airhilt.assistant.vision import detectors
    from airhilt.assistant.wording import engines as wording
    from airhilt.voices import engines as voices

    return (
        enhancement.FAMILY,
        asr.FAMILY,
        voices.FAMILY,
        detectors.FAMILY,
        decision.FAMILY,
        wording.FAMILY,
    )


def reference_worker(
    kind: str,
    engine: str | None = None,
    name: str | None = None,
    style: Style = "faa",
    also: Sequence[str] = (),
    configuration: Mapping[str, Any] | None = None,
    speak_min_level: Severity = SPEAK_MIN_LEVEL,
    shares_detections: bool = False,
) -> Worker:
    """Return one worker with its default settings.

    Parameters
    ----------
    kind
        ``decision``, ``enhancement``, ``asr``, ``tts`` or ``vision``.
    engine
        Engine as on the command line; None: the usual one.
    style
        Style in which ``tts`` says numbers.
    also
        Words that the caller takes in the place of an engine, such as ``none``, for error messages.
    configuration
        Values of the configuration of a decision engine; None: the defaults.
    speak_min_level
        Least severity that ``tts`` speaks.
    shares_detections
        True if ``vision`` shares the detections of the same pictures with other runs.

    Raises
    ------
    AirhiltError
        The engine cannot be loaded, or there is no such worker.
    """
    # Not at the top: a run without speech or cameras starts without the libraries behind them.
    match kind:
        case "enhancement":
            from airhilt.assistant.enhancement.engines import enhancer
            from airhilt.assistant.enhancement.worker import EnhancementWorker

            return EnhancementWorker(
                enhancer(EMBEDDED_ENHANCER if engine is None else engine), name or kind
            )
        case "asr":
            return asr_worker(ASR if engine is None else engine, name or kind)
        case "tts":
            from airhilt.assistant.tts.worker import TtsWorker
            from airhilt.voices.engines import tts_engine

            return TtsWorker(
                tts_engine(TTS if engine is None else engine),
                speak_min_level,
                style=style,
                name=name or kind,
            )
        case "vision":
            from airhilt.assistant.vision.detectors import vision_engine
            from airhilt.assistant.vision.shared_looks import Reproducible, SharedLooks
            from airhilt.assistant.vision.worker import VisionWorker

            detector = vision_engine(DETECTOR if engine is None else engine, also)
            if shares_detections and isinstance(detector, Reproducible):
                return VisionWorker(detector, name or kind, SharedLooks(detector))
            return VisionWorker(detector, name or kind)
        case "decision":
            return decision_worker(
                ASSISTANT if engine is None else engine,
                configuration=configuration,
                name=name or kind,
                also=also,
            )
    raise WorkerError(
        f"no reference worker {kind!r}; expected decision, enhancement, asr, tts or vision"
    )
