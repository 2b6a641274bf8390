"""Who takes part in a run besides the actors: attached programs, and the workers for the rest."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from airhilt.assistant.reference import AssistantName, Engines, reference_workers
from airhilt.bus.attach import attach
from airhilt.bus.session import Bus
from airhilt.messages import Modality
from airhilt.options import Options, Recorded
from airhilt.scenario import Scenario
from airhilt.workers import LocalWorker
from airhilt.workers.pool import Participant

NO_DETECTOR = "none"
"""In the place of an engine: nobody looks."""


@dataclass(frozen=True)
class Participants:
    """Who takes part in a run besides the actors."""

    assistant: AssistantName
    participants: tuple[Participant, ...]
    """The workers that take grants."""
    programs: tuple[str, ...]
    """Names of attached programs that take none."""

    def does(self, modality: Modality) -> bool:
        """Return whether a worker is there for something."""
        return any(one.description.modality == modality for one in self.participants)


def connect(
    options: Options,
    scenario: Scenario,
    recorded: Recorded,
    bus: Bus,
    notice: Callable[[str], None],
) -> Participants:
    """Wait for the programs that are to attach, and make the workers that nobody else is.

    Parameters
    ----------
    notice
        Called with a line for the user while there is something to wait for.

    Raises
    ------
    BusError
        A program did not attach in time.
    SpeechError, VisionError
        An engine cannot be loaded.
    """
    participants = list(recorded.workers)
    names = [name for name in options.attach if not recorded.workers]
    attached = attach(bus, names, options.attach_timeout_s, options.step_timeout_s, notice)
    participants += [
        Participant(description, worker, attached=True)
        for worker, description in attached
        if description is not None
    ]
    programs = [worker.name for worker, description in attached if description is None]
    programs = programs or list(recorded.programs)
    taken = {participant.description.modality for participant in participants}
    may_decide = "decision" in taken or bool(programs)
    assistant = options.assistant or ("external" if may_decide else "reference")
    engines = Engines(
        asr=options.asr if options.speech else None,
        tts=options.tts if options.speech else None,
        detector=_detector(options, scenario),
    )
    for worker in reference_workers(assistant, scenario.radio, taken, engines):
        participants.append(Participant(worker.description, LocalWorker(worker), attached=False))
    return Participants(assistant, tuple(participants), tuple(programs))


def _detector(options: Options, scenario: Scenario) -> str | None:
    """Return the engine that looks at pictures, None if there are none or nobody is to look."""
    if not options.cameras or not scenario.cameras or options.detector == NO_DETECTOR:
        return None
    return options.detector
