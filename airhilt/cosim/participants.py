"""Workers and external programs connected to a run."""

from __future__ import annotations

from collections.abc import Callable, Collection, Sequence
from dataclasses import dataclass, replace
from typing import Literal

from airhilt.assistant.vision.class_names import notice_of
from airhilt.bus.attach import attach, require_different_names
from airhilt.bus.closed import ClosedBus
from airhilt.bus.session import Bus
from airhilt.cosim.engines_in_use import engines_in_use, is_of_user, is_remote, other_machines
from airhilt.cosim.equipment import equipment_of, require_no_equipment
from airhilt.cosim.option_checks import inputs_given
from airhilt.cosim.reference_workers import reference_workers, speak_min_level
from airhilt.cosim.setup import Setup
from airhilt.engine_families import ASSISTANTS, EXTERNAL, RECOGNISERS
from airhilt.errors import WorkerError
from airhilt.messages import Modality, Severity
from airhilt.options import Options
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

    def recogniser(self, options: Options) -> Literal["none", "embedded", "other"]:
        """Return what recognises spoken calls; `SeatState` has the meaning of the words."""
        found = [worker for worker in self.workers if worker.description.modality == "asr"]
        if not found:
            return "none"
        ships = options.asr == RECOGNISERS.default
        return "embedded" if ships and found[0].where == "in process" else "other"

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
    setup: Setup, bus: ClosedBus, notice: Callable[[str], None], given: Sequence[Worker] = ()
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
        An engine cannot be loaded, or a service does not answer as it must.
    WorkerError
        A worker is none, cannot be told from another, or is not what the options or the record
        ask for.
    """
    options, recorded = setup.options, setup.recorded
    workers = list(recorded.workers)
    workers += [_participant(worker, "caller", is_of_user=True) for worker in given]
    attached = []
    if isinstance(bus, Bus):
        waits_s = options.attach_timeout_s, options.step_timeout_s
        attached = attach(bus, options.attach, *waits_s, notice)
    workers += [
        Participant(description, worker, "attached", is_of_user=True)
        for worker, description in attached
        if description is not None
    ]
    if not recorded.is_replay:
        require_no_equipment(workers)
    programs = [worker.name for worker, description in attached if description is None]
    programs = programs or list(recorded.programs)
    taken = {worker.description.modality for worker in workers}
    assistant = _assistant(options, recorded.is_replay, "decision" in taken, programs)
    options = options.model_copy(update={"assistant": assistant})
    require = _no_service(options) if recorded.is_replay else lambda _: None
    made = [
        _participant(worker, "in process", is_of_user(options, worker.description.modality))
        for worker in reference_workers(options, setup.scenario, taken, require)
    ]
    for participant in made:
        if told := notice_of(participant.description):
            notice(told)
    if not recorded.is_replay:
        used = engines_in_use(options, (), made)
        for sentence in other_machines(options, used):
            notice(sentence)
        for each in used:
            each.engine.probe(each.argument)
    workers = [limited(worker, options.given_modalities) for worker in (*workers, *made)]
    workers += equipment_of(setup.scenario, [worker.description.name for worker in workers])
    require_different_names([*(each.description.name for each in workers), *programs])
    return Participants(assistant, tuple(workers), tuple(programs))


def _assistant(
    options: Options, is_replay: bool, has_decision: bool, programs: Sequence[str]
) -> str:
    """Return the name of the assistant of a run, if what the options say of it can be."""
    if has_decision and not is_replay and options.assistant not in (None, EXTERNAL):
        raise WorkerError(
            f"assistant {options.assistant!r}, but a worker of yours decides; expected one of them"
        )
    if programs and options.modalities != Options.model_fields["modalities"].default:
        raise WorkerError(
            f"--modalities {options.modalities}: {programs[0]!r} takes no grants, so it hears "
            "everything on the bus; expected a worker (docs/workers.md)"
        )
    may_decide = has_decision or bool(programs)
    assistant = options.assistant or (EXTERNAL if may_decide else ASSISTANTS.default)
    for option, value in (
        ("--assistant-config", options.assistant_config),
        ("--recipients", options.recipients),
    ):
        if assistant == EXTERNAL and value is not None:
            raise WorkerError(
                f"{option} would do nothing: a worker or program of yours decides; expected only "
                "one of the two"
            )
    return assistant


def _no_service(options: Options) -> Callable[[Modality], None]:
    """Return what complains about a worker of a replay that would ask a service.

    A run records what each service answers, so that its replay sends nothing, and no key, to the
    addresses in a record that may be somebody else's.
    """

    def require(modality: Modality) -> None:
        if is_remote(options, modality):
            raise WorkerError(
                f"worker for {modality}: the record names a service for it, and has none of its "
                "answers; expected a record that was not changed: a replay asks no service"
            )

    return require


def _participant(worker: Worker, where: Where, is_of_user: bool) -> Participant:
    """Return a worker of this process as one of the run; see `LocalWorker` for its errors."""
    local = LocalWorker(worker)
    return Participant(local.description, local, where, is_of_user)


def limited(worker: Participant, given: Collection[str]) -> Participant:
    """Return a worker that, if it decides, has inputs of the given modalities only.

    Others keep their inputs; see `inputs_given` for the error.
    """
    description = worker.description
    if description.modality != "decision":
        return worker
    inputs = inputs_given(description.engine or description.name, description.inputs, given)
    return replace(worker, description=description.model_copy(update={"inputs": inputs}))
