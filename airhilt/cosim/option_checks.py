"""Checks of the options of a run, wherever they come from: the command line or Python."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import replace

from airhilt.assistant.decision.worker import DecisionWorker
from airhilt.assistant.wording.engines.template import Template
from airhilt.cosim.engines_in_use import is_own_engine
from airhilt.engine_families import ASSISTANTS, DETECTORS, EXTERNAL, FAMILIES, NONE
from airhilt.errors import AirhiltError, WorkerError, shown
from airhilt.messages import InputSpec
from airhilt.options import MODALITIES, Options, flag_of
from airhilt.scenario import Scenario
from airhilt.scenario.twin import twin_of
from airhilt.sensors.cameras import AUTO

KEYS: Mapping[str, tuple[str, ...]] = {
    "adsb": ("adsb",),
    "asr": ("asr", "radio", "enhanced", "seat"),
    "vision": ("vision", "camera"),
}
"""First chunks of the keys of each modality: its results, and the sound or pictures behind them."""
NO_EVIDENCE = frozenset({"briefing", "status"})
"""First chunks of keys that tell an assistant of the run, and nothing of the traffic."""


def check_options(options: Options, scenario: Scenario) -> None:
    """Check that engines are known, used or not, and that no option is given that does nothing.

    Raises
    ------
    AirhiltError
        An option names an engine that is not there, or does nothing because of another option.
    """
    topology = options.topology or scenario.radio.topology
    for name in sorted(options.model_fields_set):
        field = Options.model_fields[name]
        flag, value = flag_of(field), getattr(options, name)
        if flag is None or value == field.default:
            continue
        if name == "asr" and options.speech and topology == "asr_first":
            continue  # Crews get the transcript, whoever decides.
        for other in _against(options, name, flag.needs):
            given = flag.name if isinstance(value, bool) else f"{flag.name} {shown(value)}"
            raise AirhiltError(f"{given} would do nothing {other}")
    if options.twin:
        twin_of(scenario)
    if options.tls is not None and options.share_truth:
        raise AirhiltError(
            "--share-truth would do nothing with --tls: who has the certificate of a recorder "
            "reads truth, and nobody else; expected only one of the two"
        )
    if options.advisory_channel == "frequency" and not scenario.radio.lines:
        raise AirhiltError(
            f"--advisory-channel frequency: {scenario.name!r} has no radio calls, and so no "
            "frequency; expected cockpit"
        )
    if options.enhancer != NONE:
        _require_use_of_enhancer(options, topology)
    for family in FAMILIES:
        if (text := getattr(options, family.option)) is not None:
            family.require_there(text)
    if options.cameras and options.renderer != AUTO:
        # Not at the top: a run without cameras starts without the libraries behind them.
        from airhilt.sensors.cameras.renderers import require_known

        require_known(options.renderer)
    if options.assistant_config is not None:
        assistant, _ = ASSISTANTS.choose(options.assistant or ASSISTANTS.default)
        assistant.configured(options.assistant_config)
    if options.detector_classes is not None:
        detector, _ = DETECTORS.choose(options.detector, DETECTORS.words)
        if detector.configuration is None:
            raise AirhiltError(
                f"--detector-classes would do nothing with --detector {shown(options.detector)}, "
                "which has its own classes; expected onnx:FILE or yolo:FILE"
            )
    _require_evidence(options)
    require_known_equipment((*scenario.equipment, *options.equipment))


def _against(options: Options, name: str, needs: tuple[str, ...]) -> Iterator[str]:
    """Yield the reasons in words why an option does nothing: something that it needs is absent."""
    for need in needs:
        flag = flag_of(Options.model_fields[need])
        spelling = need if flag is None else flag.name
        if need != "assistant":
            if getattr(options, need) in (None, ()):
                yield f"without {spelling}; expected both or none"
            elif not getattr(options, need):
                yield f"with {spelling}; expected only one of the two"
        elif options.assistant == NONE or (
            options.assistant == EXTERNAL
            and name in ("wording", "llm", "assistant_config", "recipients")
        ):
            yield f"with {spelling} {options.assistant}; expected only one of the two"


def _require_use_of_enhancer(options: Options, topology: str) -> None:
    """Complain about an enhancer whose output nobody would use."""
    if topology != "asr_first":
        raise AirhiltError(
            f"--enhancer {shown(options.enhancer)} would do nothing with --topology {topology}; "
            "expected asr_first"
        )
    if options.partial_transcripts:
        raise AirhiltError(
            "--partial-transcripts would be of audio that no enhancer has had; expected it "
            "without --enhancer"
        )


def _require_evidence(options: Options) -> None:
    """Complain about modalities that leave an engine of AIRHILT nothing to read."""
    name = options.assistant or ASSISTANTS.default
    if options.given_modalities.issuperset(MODALITIES) or not is_own_engine(name):
        return
    engine = ASSISTANTS.create(name, options.assistant_config)
    inputs = DecisionWorker(engine, Template()).description.inputs
    inputs_given(name, inputs, options.given_modalities)


def require_known_equipment(names: Iterable[str]) -> None:
    """Check that equipment is made of decision engines that are there.

    Raises
    ------
    AirhiltError
        An engine is not there, or asks a program elsewhere.
    """
    family = replace(ASSISTANTS, word="equipment")
    for name in names:
        if family.choose(name)[0].is_remote:
            raise AirhiltError(
                f"equipment {name!r}: it asks a program elsewhere; expected an engine that "
                "decides by itself"
            )


def inputs_given(
    name: str, inputs: Sequence[InputSpec], given: Collection[str]
) -> tuple[InputSpec, ...]:
    """Return those of the inputs that belong to no modality, or to one that is given.

    Parameters
    ----------
    name
        Name of the assistant, for the error message.

    Raises
    ------
    WorkerError
        Nothing of the traffic is left.
    """
    withheld = {key for modality, keys in KEYS.items() if modality not in given for key in keys}
    left = tuple(each for each in inputs if _first(each) not in withheld)
    if len(left) < len(inputs) and all(_first(each) in NO_EVIDENCE for each in left):
        reads = "+".join(
            modality
            for modality, keys in KEYS.items()
            if any(_first(each) in keys for each in inputs)
        )
        raise WorkerError(
            f"--modalities {'+'.join(each for each in KEYS if each in given)}: assistant {name!r} "
            f"reads {reads}, so nothing is left to it; expected some of that"
        )
    return left


def _first(wanted: InputSpec) -> str:
    return wanted.key.partition("/")[0]
