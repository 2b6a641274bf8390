"""Workers and external programs connected to a run."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

from airhilt.bus.attach import RESERVED, attach
from airhilt.bus.session import Bus
from airhilt.cosim.engines_in_use import engines_in_use, is_of_user, is_remote, other_machines
from airhilt.cosim.equipment import equipment_of, require_no_equipment
from airhilt.cosim.given_modalities import limited
from airhilt.cosim.recorded import Recorded
from airhilt.cosim.reference_workers import reference_workers, speak_min_level
from airhilt.engine_families import ASSISTANTS, EXTERNAL
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
        assistant = options.assistant or (EXTERNAL if may_decide else ASSISTANTS.default)
    _require_used(options, assistant)
    options = options.model_copy(update={"assistant": assistant})
    made = [
        _participant(worker, "in process", is_of_user(options, worker.description.modality))
        for worker in reference_workers(options, scenario, taken)
    ]
    if recorded.is_replay:
        _require_no_service(made, options)
    else:
        for sentence in other_machines(options, engines_in_use(options, (), made)):
            notice(sentence)
    workers += made
    workers = [limited(worker, options.given_modalities) for worker in workers]
    workers += equipment_of(scenario, [worker.description.name for worker in workers])
    _require_different_names(workers, programs)
    return Participants(assistant, tuple(workers), tuple(programs))


def _require_no_service(workers: Sequence[Participant], options: Options) -> None:
    """Complain about a worker of a replay that would ask a service.

    A run records what each service answers, so that its replay sends nothing, and no key, to the
    addresses in a record that may be somebody else's.

    Raises
    ------
    WorkerError
        The record names a service, and has not the worker that asked it.
    """
    for worker in workers:
        if is_remote(options, worker.description.modality):
            raise WorkerError(
                f"worker {worker.description.name!r}: the record names a service for it, and has "
                "none of its answers; expected a record that was not changed: a replay asks no "
                "service"
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
    """Complain about a configuration of an assistant that the run does not make.

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
    """Complain about limited modalities where a program without grants reads the whole bus.

    Raises
    ------
    WorkerError
        There is such a program.
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
