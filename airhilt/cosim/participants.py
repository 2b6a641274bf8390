"""Workers and external programs connected to a run."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

from airhilt.assistant.reference import EXTERNAL, NO_ASSISTANT, Engines, reference_workers
from airhilt.bus.attach import RESERVED, attach
from airhilt.bus.session import Bus
from airhilt.cosim.recorded import Recorded
from airhilt.engines import ASSISTANT
from airhilt.errors import WorkerError
from airhilt.messages import Modality, WorkerDescription
from airhilt.options import Options
from airhilt.scenario import Scenario
from airhilt.workers import LocalWorker, Worker
from airhilt.workers.pool import Participant

NO_DETECTOR = "none"
"""Name in the place of a detector: no worker looks at pictures."""


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
        Two workers have the same name.
    """
    workers = list(recorded.workers)
    workers += [_participant(worker) for worker in given]
    attached = attach(bus, options.attach, options.attach_timeout_s, options.step_timeout_s, notice)
    workers += [
        Participant(description, worker, "attached")
        for worker, description in attached
        if description is not None
    ]
    programs = [worker.name for worker, description in attached if description is None]
    programs = programs or list(recorded.programs)
    taken = {worker.description.modality for worker in workers}
    may_decide = "decision" in taken or bool(programs)
    assistant = options.assistant or (EXTERNAL if may_decide else ASSISTANT)
    if "decision" in taken and not recorded.is_replay:
        if assistant == NO_ASSISTANT:
            raise WorkerError(
                f"assistant {NO_ASSISTANT!r}, but a worker of yours decides; expected one of them"
            )
        assistant = EXTERNAL
    engines = Engines(
        asr=options.asr if options.speech else None,
        tts=options.tts if options.speech else None,
        detector=_detector(options, scenario),
        wording=options.wording,
    )
    for worker in reference_workers(assistant, scenario.radio, taken, engines):
        workers.append(Participant(worker.description, LocalWorker(worker), "in process"))
    _require_different_names(workers, programs)
    return Participants(assistant, tuple(workers), tuple(programs))


def _participant(worker: Worker) -> Participant:
    """Return a worker of the caller as one of the run.

    Raises
    ------
    WorkerError
        It has no description.
    """
    description = getattr(worker, "description", None)
    if not isinstance(description, WorkerDescription):
        raise WorkerError(
            f"worker {worker!r}: its description is {description!r}; expected a "
            "WorkerDescription (airhilt.messages)"
        )
    return Participant(description, LocalWorker(worker), "caller")


def _require_different_names(workers: Sequence[Participant], programs: Sequence[str]) -> None:
    names = [*(worker.description.name for worker in workers), *programs]
    for name in names:
        if name in RESERVED:
            raise WorkerError(
                f"a worker is named {name!r}, as the log calls others; expected another name"
            )
        if names.count(name) > 1:
            raise WorkerError(f"two workers are named {name!r}; expected a name for each")


def _detector(options: Options, scenario: Scenario) -> str | None:
    """Return the engine that looks at pictures, None if there are none or nobody is to look."""
    if not options.cameras or not scenario.cameras or options.detector == NO_DETECTOR:
        return None
    return options.detector
