"""Equipment of the world in a run: what the scenario and the options put there."""

from __future__ import annotations

from collections.abc import Collection, Sequence

from airhilt.assistant.equipment import equipment_name, equipment_worker
from airhilt.errors import WorkerError
from airhilt.scenario import Scenario
from airhilt.workers.pool import EQUIPMENT, Participant
from airhilt.workers.protocol import LocalWorker


def with_requested_equipment(scenario: Scenario, requested: Sequence[str]) -> Scenario:
    """Return a scenario with the equipment that the options ask for besides its own."""
    equipment = tuple(dict.fromkeys((*scenario.equipment, *requested)))
    return scenario.model_copy(update={"equipment": equipment})


def equipment_of(scenario: Scenario, taken: Collection[str]) -> list[Participant]:
    """Return the workers that are the equipment of a scenario.

    Parameters
    ----------
    taken
        Names of workers that are there already: a replay has some from its record.

    Raises
    ------
    AirhiltError
        An engine cannot be loaded, or is there twice.
    """
    names = [equipment_name(engine) for engine in scenario.equipment]
    for engine, name in zip(scenario.equipment, names, strict=True):
        if names.count(name) > 1:
            raise WorkerError(
                f"equipment: {engine!r} is there twice, as {', '.join(scenario.equipment)}; "
                "expected each engine once"
            )
    workers = [
        LocalWorker(equipment_worker(engine))
        for engine, name in zip(scenario.equipment, names, strict=True)
        if name not in taken
    ]
    return [Participant(worker.description, worker, "in process") for worker in workers]


def require_no_equipment(participants: Sequence[Participant]) -> None:
    """Complain about a worker of the user that poses as equipment of the world.

    Raises
    ------
    WorkerError
        There is one.
    """
    for each in participants:
        if each.description.modality == EQUIPMENT:
            raise WorkerError(
                f"worker {each.description.name!r} has the modality {EQUIPMENT!r}; expected "
                "decision: equipment is in the scenario (docs/scenarios.md#equipment)"
            )
