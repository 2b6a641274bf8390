"""Routes each message to the log, the bus, and the workers that asked for its key."""

from __future__ import annotations

from collections.abc import Callable

from airhilt.bus.closed import ClosedBus
from airhilt.messages import RUN, Briefing, Message, RadarInfo, SeatState
from airhilt.record.log import LogWriter
from airhilt.sim.payload import Payload

Listener = Callable[[str, Message, Payload], None]
"""Called with key, message and payload: its JSON, or the raw bytes that it is the header of."""
Attributed = Callable[[str, Message], None]
"""Called with the name of the publisher and its message."""
CONSTANT = (Briefing, SeatState, RadarInfo)
"""Messages that are published when they change; who comes late asks for the newest."""


class MessageRouter:
    """Publishes a message once to everybody; truth reaches the log and viewers only.

    Attributes
    ----------
    observers
        Called with every message, truth too: they measure the run.
    listeners
        Called with every message that is not truth.
    attributed
        Called with every message that is not truth, and the name of its publisher.
    """

    def __init__(self, bus: ClosedBus, log: LogWriter) -> None:
        self._bus = bus
        self._log = log
        self.observers: list[Listener] = []
        self.listeners: list[Listener] = []
        self.attributed: list[Attributed] = []

    def clear(self) -> None:
        """Forget all who are called: the run is over."""
        for called in (self.observers, self.listeners, self.attributed):
            called.clear()

    def publish(
        self, key: str, message: Message, publisher: str = RUN, raw: Payload | None = None
    ) -> None:
        """Publish a message whose ``t_ns`` is now.

        Parameters
        ----------
        raw
            Payload of a key whose message is only the header (audio, images).
        """
        data = message.model_dump_json().encode()
        self._log.write(key, publisher, type(message), message.t_ns, data)
        if isinstance(message, CONSTANT):
            self._bus.keep(key, data)
        elif raw is None:
            self._bus.put(key, data)
        else:
            self._bus.put(key, raw, data)
        self._tell(key, message, publisher, data if raw is None else raw)

    def heard(
        self, key: str, message: Message, publisher: str, logged: Message | None = None
    ) -> None:
        """Take in what another process has put on the bus itself.

        Parameters
        ----------
        logged
            Message as the log is to have it; None: as it is.
        """
        data = (logged or message).model_dump_json().encode()
        self._log.write(key, publisher, type(message), message.t_ns, data)
        self._tell(key, message, publisher, data)

    def _tell(self, key: str, message: Message, publisher: str, payload: Payload) -> None:
        for observer in self.observers:
            observer(key, message, payload)
        if key.startswith("truth/"):
            return
        for listener in self.listeners:
            listener(key, message, payload)
        for attributed in self.attributed:
            attributed(publisher, message)
