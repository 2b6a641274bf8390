"""Equipment of the world: a decision engine that is there besides the assistant under test.

TCAS II aboard, a controller's conflict alert and runway lights exist whatever assistant is tested,
so the margins of the assistant are measured with them in the world. Their alerts are no advisories
of the assistant: they have keys and messages of their own.
"""

from __future__ import annotations

from collections.abc import Collection, Sequence

from airhilt.assistant.reference import decision_worker
from airhilt.errors import WorkerError
from airhilt.messages import Advisory, DeclaredLatency, EquipmentAlert
from airhilt.scenario import Scenario
from airhilt.sim.worker import Input, Output
from airhilt.workers.pool import EQUIPMENT, Participant
from airhilt.workers.protocol import LocalWorker, Step, Worker

LATENCY = DeclaredLatency(median_s=0.1, sigma=0.0)
"""Latency of equipment from its inputs to its alert, whatever the latencies of the assistant are;
an assumption."""


def equipment_of(scenario: Scenario, taken: Collection[str]) -> list[Participant]:
    """Return the workers that are the equipment of a scenario, without those that are ``taken``.

    A replay has the names of some from its record.

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
                "decision: equipment is in the scenario (docs/equipment.md)"
            )


def equipment_worker(engine: str) -> Worker:
    """Return the equipment of a decision engine such as ``tcas``; its name is that of the engine.

    Raises
    ------
    AirhiltError
        The engine cannot be loaded.
    """
    return EquipmentWorker(decision_worker(engine, name=equipment_name(engine)))


def equipment_name(engine: str) -> str:
    """Return the name of the worker of an engine, such as ``equipment-tcas``."""
    return f"{EQUIPMENT}-{engine.partition(':')[0]}"


class EquipmentWorker:
    """Publishes the advisories of a decision worker as alerts of equipment."""

    def __init__(self, decision: Worker) -> None:
        self._decision = decision
        self._equipment = decision.description.name.removeprefix(f"{EQUIPMENT}-")
        self.description = decision.description.model_copy(
            update={"modality": EQUIPMENT, "latency": LATENCY}
        )

    def step(self, t_ns: int, inputs: Sequence[Input]) -> Step:
        """Let it decide, and publish what it says."""
        decided = self._decision.step(t_ns, inputs)
        return Step(tuple(self._alert(each) for each in decided.outputs), decided.wake_ns)

    def _alert(self, output: Output) -> Output:
        if not output.key.startswith("advisory/"):
            raise WorkerError(
                f"equipment {self._equipment!r} published on {output.key!r}; expected advisories: "
                "a language model cannot be equipment"
            )
        advisory = Advisory.model_validate_json(output.payload)
        alert = EquipmentAlert(equipment=self._equipment, advisory=advisory)
        key = f"equipment/{self._equipment}/{advisory.recipient}"
        return Output(key, alert.model_dump_json().encode(), output.t_out_ns)
