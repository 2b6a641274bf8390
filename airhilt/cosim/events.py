"""Events of a run: one line each about something that happened, for the log and the report."""

from __future__ import annotations

from airhilt.cosim.router import MessageRouter
from airhilt.messages import Event, EventKind
from airhilt.sim import Director


class EventPublisher:
    """Publishes events on ``truth/event``."""

    def __init__(self, director: Director, router: MessageRouter) -> None:
        self._director = director
        self._router = router

    def __call__(self, kind: EventKind, subject: str, text: str) -> None:
        """Publish an event that happens now."""
        event = Event(t_ns=self._director.now_ns, kind=kind, subject=subject, text=text)
        self._router.publish("truth/event", event)
