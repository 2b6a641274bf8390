"""The reference workers of a run: what it needs and no attached worker does."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable

from airhilt.assistant.language_model import LanguageModelSettings
from airhilt.assistant.reference import decision_worker, reference_worker, vision_worker
from airhilt.engine_families import ASSISTANTS, NONE
from airhilt.messages import SPEAK_MIN_LEVEL, Modality, Severity, WorkerDescription
from airhilt.options import Options, class_pairs
from airhilt.scenario import Scenario
from airhilt.workers.protocol import Worker


def reference_workers(
    options: Options,
    scenario: Scenario,
    taken: Collection[Modality],
    require: Callable[[Modality], None] = lambda _: None,
) -> list[Worker]:
    """Return the workers that a run needs and has not got.

    Speech is recognised unless nobody would read it: automata do with the topology ``asr_first``,
    and where people speak. Where somebody decides, there is a voice, and somebody looks at
    pictures.

    Parameters
    ----------
    taken
        Modalities of the workers that are there.
    require
        Called with the modality of each worker before it is made, which may ask a service; it
        raises what forbids that.

    Raises
    ------
    AirhiltError
        An engine cannot be loaded.
    """
    given, radio = options.given_modalities, scenario.radio
    is_assisted = options.assistant != NONE
    workers: list[Worker] = []
    is_enhanced = "enhancement" in taken or options.enhancer != NONE
    if options.enhancer != NONE and "enhancement" not in taken:
        require("enhancement")
        workers.append(reference_worker("enhancement", options.enhancer))
    is_read = radio.topology == "asr_first" or options.seat or (is_assisted and "asr" in given)
    if options.speech and is_read and "asr" not in taken:
        require("asr")
        workers.append(
            reference_worker(
                "asr",
                options.asr,
                gives_partials=options.partial_transcripts,
                hears_enhanced=is_enhanced,
            )
        )
    deciding: list[Worker] = []
    assistant = options.assistant or ASSISTANTS.default
    if assistant not in ASSISTANTS.words and "decision" not in taken:
        require("decision")
        deciding.append(
            decision_worker(
                assistant,
                wording=options.wording,
                configuration=options.assistant_config,
                told=options.recipients,
                is_gated=radio.topology == "gated_fusion",
                llm=_language_model(options),
            )
        )
    if options.speech and "tts" not in taken and is_assisted:
        require("tts")
        level = speak_min_level(worker.description for worker in deciding)
        settings = {"style": radio.phraseology, "speak_min_level": level}
        workers.append(reference_worker("tts", options.tts, **settings))
    has_pictures = options.cameras and bool(scenario.cameras) and "vision" in given
    if has_pictures and options.detector != NONE and "vision" not in taken and is_assisted:
        require("vision")
        workers.append(_vision_worker(options))
    return workers + deciding


def speak_min_level(workers: Iterable[WorkerDescription]) -> Severity:
    """Return the least severity that is spoken, by the configuration of the decision engine."""
    for worker in workers:
        level = worker.configuration.get("speak_min_level")
        if worker.modality == "decision" and level is not None:
            return Severity(level)
    return SPEAK_MIN_LEVEL


def _vision_worker(options: Options) -> Worker:
    classes = options.detector_classes
    return vision_worker(
        options.detector,
        classes=None if classes is None else class_pairs(classes),
        shares_detections=options.share_pictures,
    )


def _language_model(options: Options) -> LanguageModelSettings | None:
    if options.llm is None:
        return None
    return LanguageModelSettings(
        options.llm, options.llm_model, options.llm_deadline_s, options.seed
    )
