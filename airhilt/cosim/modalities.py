"""The modalities of a run: which of them work, and what happens when one is lost."""

from __future__ import annotations

from airhilt.cosim.events import EventPublisher
from airhilt.cosim.observer import Observer
from airhilt.cosim.router import MessageRouter
from airhilt.errors import RunStopped
from airhilt.host.text import readable
from airhilt.messages import EventKind, Modality, ModalityState, Status
from airhilt.sim import Director
from airhilt.units import SECOND_NS


class Modalities:
    """Publishes on ``status/<modality>`` how each modality stands.

    Parameters
    ----------
    is_strict
        True if the loss of a modality stops the run.
    """

    def __init__(
        self,
        director: Director,
        router: MessageRouter,
        event: EventPublisher,
        observer: Observer,
        *,
        is_strict: bool,
    ) -> None:
        self._director = director
        self._router = router
        self._event = event
        self._observer = observer
        self._is_strict = is_strict

    def set(self, modality: Modality, state: ModalityState, cause: str = "") -> None:
        """Publish that a modality is in a state from now on."""
        self._router.publish(
            f"status/{modality}",
            Status(t_ns=self._director.now_ns, modality=modality, state=state, cause=cause),
        )

    def lose(
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
        self.set(modality, "lost", cause)
        self._event(kind, subject, cause)
        t_s = self._director.now_ns / SECOND_NS
        self._observer.notice(f"lost at {t_s:.1f} s: {cause}")
        if is_of_machine:
            self._observer.machine_failed(cause)
        if self._is_strict:
            raise RunStopped(
                f"stopped at {t_s:.1f} s, as --strict asks: {cause}; run again without --strict "
                "to go on without it"
            )
