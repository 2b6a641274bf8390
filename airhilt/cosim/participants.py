"""Workers and external programs connected to a run."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

from airhilt.assistant.language_model import LanguageModelSettings
from airhilt.assistant.reference import (
    EXTERNAL,
    NO_DETECTOR,
    NO_ENHANCER,
    Engines,
    is_of_user,
    is_remote,
    reference_workers,
    speak_min_level,
)
from airhilt.bus.attach import RESERVED, attach
from airhilt.bus.session import Bus
from airhilt.cosim.equipment import equipment_of, require_no_equipment
from airhilt.cosim.given_modalities import limited
from airhilt.cosim.other_machines import other_machines
from airhilt.cosim.recorded import Recorded
from airhilt.engines import ASSISTANT
from airhilt.errors import WorkerError
from airhilt.messages import Modality, Severity
from airhilt.options import Options
from airhilt.scenario import Scenario
from airhilt.workers import LocalWorker, Worker
from airhilt.workers.pool import Participant, Where


@dataclass(frozen=True)
class Participants:
    """Workers and external programs connected to a run.

    Attributes
    ----------
    assistant
        The name of a decision engine, ``none`` or ``external``.
    workers
        The workers that take grants.
    programs
        Names of attached programs that take no grants.
    """

    assistant: str
    workers: tuple[Participant, ...]
    programs: tuple[str, ...]

    def does(self, modality: Modality) -> bool:
        """Return whether a worker is there for a modality."""
        return any(worker.description.modality == modality for worker in self.workers)

    @property
    def speak_min_level(self) -> Severity:
        """Least severity that is spoken."""
        return speak_min_level(worker.description for worker in self.workers)

    @property
    def subscribed(self) -> frozenset[str]:
        """First chunks of the keys that workers with grants subscribe to."""
        inputs = (wanted for worker in self.workers for wanted in worker.description.inputs)
        return frozenset(wanted.key.partition("/")[0] for wanted in inputs)

    @property
    def attached(self) -> tuple[str, ...]:
        """Names of all that run in other processes, with grants or without."""
        remote = [w.description.name for w in self.workers if w.where == "attached"]
        return (*remote, *self.programs)


def connect(
    options: Options,
    scenario: Scenario,
    recorded: Recorded,
    bus: Bus,
    notice: Callable[[str], None],
    given: Sequence[Worker] = (),
) -> Participants:
    """Wait for the programs that are to attach, and make the workers that nobody else is.

    Parameters
    ----------
    notice
        Called with a line for the user while there is something to wait for.
    given
        Workers of this process that the caller of the run gives.

    Raises
    ------
    BusError
        A program did not attach in time.
    SpeechError, VisionError
        An engine cannot be loaded.
    WorkerError
        A worker has no description or no method `step`, two have the same name, or one decides
        though the options name another assistant, or reads nothing that the options give it. Or
        one would ask a service in a replay.
    """
    workers = list(recorded.workers)
    workers += [_participant(worker, "caller", is_of_user=True) for worker in given]
    attached = attach(bus, options.attach, options.attach_timeout_s, options.step_timeout_s, notice)
    workers += [
        Participant(description, worker, "attached", is_of_user=True)
        for worker, description in attached
        if description is not None
    ]
    if not recorded.is_replay:
        require_no_equipment(workers)
    programs = [worker.name for worker, description in attached if description is None]
    programs = programs or list(recorded.programs)
    _require_no_programs(options, programs)
    taken = {worker.description.modality for worker in workers}
    if "decision" in taken and not recorded.is_replay:
        assistant = _external_assistant(options)
    else:
        may_decide = "decision" in taken or bool(programs)
        assistant = options.assistant or (EXTERNAL if may_decide else ASSISTANT)
    _require_used(options, assistant)
    engines = _engines(options, scenario)
    reference = reference_workers(
        assistant, scenario.radio, taken, engines, people_speak=bool(options.seat)
    )
    made = [
        _participant(
            worker, "in process", is_of_user(worker.description.modality, assistant, engines)
        )
        for worker in reference
    ]
    if recorded.is_replay:
        _require_no_service(made, assistant, engines)
    else:
        for sentence in other_machines(assistant, engines):
            notice(sentence)
    workers += made
    workers = [limited(worker, options.given_modalities) for worker in workers]
    workers += equipment_of(scenario, [worker.description.name for worker in workers])
    _require_different_names(workers, programs)
    return Participants(assistant, tuple(workers), tuple(programs))


def _require_no_service(workers: Sequence[Participant], assistant: str, engines: Engines) -> None:
    """Complain about a worker of a replay that would ask a service.

    A run records what each service answers, so that its replay sends nothing, and no key, to the
    addresses in a record that may be somebody else's.

    Raises
    ------
    WorkerError
        The record names a service, and has not the worker that asked it.
    """
    for worker in workers:
        description = worker.description
        if is_remote(description.modality, assistant, engines):
            raise WorkerError(
                f"worker {description.name!r}: the record names a service for it, and has none of "
                "its answers; expected a record that was not changed: a replay asks no service"
            )


def _external_assistant(options: Options) -> str:
    """Return the name of an assistant whose decisions a worker of the user makes.

    Raises
    ------
    WorkerError
        The options name another one, or ask for none.
    """
    if options.assistant not in (None, EXTERNAL):
        raise WorkerError(
            f"assistant {options.assistant!r}, but a worker of yours decides; expected one of them"
        )
    return EXTERNAL


def _require_used(options: Options, assistant: str) -> None:
    """Complain about a configuration that nobody has.

    Raises
    ------
    WorkerError
        A worker or program of the user decides.
    """
    if assistant == EXTERNAL and options.assistant_config is not None:
        raise WorkerError(
            "--assistant-config would do nothing: a worker or program of yours decides; expected "
            "only one of the two"
        )


def _require_no_programs(options: Options, programs: Sequence[str]) -> None:
    """Complain about a program that hears what the assistant is not to be given.

    Raises
    ------
    WorkerError
        One takes no grants, and so reads whatever it likes.
    """
    if programs and options.modalities != Options.model_fields["modalities"].default:
        raise WorkerError(
            f"--modalities {options.modalities}: {programs[0]!r} takes no grants, so it hears "
            "everything on the bus; expected a worker (docs/workers.md)"
        )


def _participant(worker: Worker, where: Where, is_of_user: bool) -> Participant:
    """Return a worker of this process as one of the run; see `LocalWorker` for its errors."""
    local = LocalWorker(worker)
    return Participant(local.description, local, where, is_of_user)


def _require_different_names(workers: Sequence[Participant], programs: Sequence[str]) -> None:
    names = [*(worker.description.name for worker in workers), *programs]
    for name in names:
        if name in RESERVED:
            raise WorkerError(
                f"a worker is named {name!r}, as the log calls others; expected another name"
            )
        if names.count(name) > 1:
            raise WorkerError(f"two workers are named {name!r}; expected a name for each")
        for other in names:
            if other.startswith(f"{name}-"):
                raise WorkerError(
                    f"two workers are named {name!r} and {other!r}: an id that begins with "
                    f"'{other}-' would be of both; expected a name that does not begin the other"
                )


def _engines(options: Options, scenario: Scenario) -> Engines:
    is_read = (
        "asr" in options.given_modalities
        or scenario.radio.topology == "asr_first"
        or bool(options.seat)
    )
    return Engines(
        asr=options.asr if options.speech and is_read else None,
        tts=options.tts if options.speech else None,
        detector=_detector(options, scenario),
        wording=options.wording,
        llm=_language_model(options),
        configuration=options.assistant_config,
        shares_detections=options.share_pictures,
        partial_transcripts=options.partial_transcripts,
        enhancer=None if options.enhancer == NO_ENHANCER else options.enhancer,
    )


def _language_model(options: Options) -> LanguageModelSettings | None:
    if options.llm is None:
        return None
    return LanguageModelSettings(
        options.llm, options.llm_model, options.llm_deadline_s, options.seed
    )


def _detector(options: Options, scenario: Scenario) -> str | None:
    """Return the engine that looks at pictures, None if there are none or nobody is to look."""
    if not options.cameras or not scenario.cameras or options.detector == NO_DETECTOR:
        return None
    if "vision" not in options.given_modalities:
        return None
    return options.detector
