"""The context that all parts of a run share: its setup, clock, messages and observer."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from airhilt.cosim.router import MessageRouter
from airhilt.cosim.setup import Setup
from airhilt.errors import RunStopped
from airhilt.host.text import readable
from airhilt.messages import Event, EventKind, Modality, ModalityState, Status
from airhilt.sim import Director
from airhilt.units import SECOND_NS

if TYPE_CHECKING:
    from airhilt.cosim.observer import Observer


@dataclass(frozen=True)
class RunContext:
    """Context shared by all parts of a run, with the events and modalities that all may change."""

    setup: Setup
    director: Director
    router: MessageRouter
    observer: Observer

    @property
    def now_s(self) -> float:
        """Simulation time in s."""
        return self.director.now_ns / SECOND_NS

    @property
    def is_replay(self) -> bool:
        """True if the run repeats an earlier one."""
        return self.setup.recorded.is_replay

    def event(self, kind: EventKind, subject: str, text: str) -> None:
        """Publish on ``truth/event`` that something happens now."""
        event = Event(t_ns=self.director.now_ns, kind=kind, subject=subject, text=text)
        self.router.publish("truth/event", event)

    def set_modality(self, modality: Modality, state: ModalityState, cause: str = "") -> None:
        """Publish on ``status/<modality>`` that a modality is in a state from now on."""
        self.router.publish(
            f"status/{modality}",
            Status(t_ns=self.director.now_ns, modality=modality, state=state, cause=cause),
        )

    def miss_step(self, worker: str, cause: str) -> None:
        """Go on without the result of one step of a worker, and tell everybody."""
        cause = readable(cause)
        self.event("step_missed", worker, cause)
        self.observer.notice(f"no result of {worker!r} at {self.now_s:.1f} s: {cause}")

    def lose_modality(
        self,
        modality: Modality,
        kind: EventKind,
        subject: str,
        cause: str,
        is_of_machine: bool = False,
    ) -> None:
        """Go on without a modality, and tell everybody.

        Parameters
        ----------
        is_of_machine
            True if another machine, or another time, might not have it.

        Raises
        ------
        RunStopped
            The run is strict.
        """
        cause = readable(cause)
        self.set_modality(modality, "lost", cause)
        self.event(kind, subject, cause)
        self.observer.notice(f"lost at {self.now_s:.1f} s: {cause}")
        if is_of_machine:
            self.observer.machine_failed(cause)
        if self.setup.options.strict:
            raise RunStopped(
                f"stopped at {self.now_s:.1f} s, as --strict asks: {cause}; run again without "
                "--strict to go on without it"
            )
