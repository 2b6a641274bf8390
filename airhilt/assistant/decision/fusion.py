"""Gated fusion: nothing is told while the transcript of a call is to come."""

from __future__ import annotations

from airhilt.messages import Message, Status, Transcript, Transmission
from airhilt.units import SECOND_NS

PATIENCE_NS = 10 * SECOND_NS
"""Longest wait for a transcript after the end of its call, in ns.

Noise, and calls that blocked each other, may never give one."""


class FusionGate:
    """A gate that is closed from the end of a call until its transcript has come.

    The gate does not wait for ADS-B reports, which come at least once a second.
    """

    def __init__(self) -> None:
        self._pending_ns: dict[str, int] = {}
        """End of each call whose transcript is to come, by its id."""
        self._is_deaf = False

    def receive(self, message: Message) -> None:
        """Wait for the transcript of a call, unless it has come or speech recognition is lost."""
        match message:
            case Transmission(samples=samples) if samples and not self._is_deaf:
                self._pending_ns[message.id] = message.t_end_ns
            case Transcript():
                self._pending_ns.pop(message.id, None)
            case Status(modality="asr"):
                self._is_deaf = message.state == "lost"
                if self._is_deaf:
                    self._pending_ns.clear()

    def opens_ns(self, t_ns: int) -> int | None:
        """Return when the gate opens at the latest; None if it is open."""
        for name, end_ns in list(self._pending_ns.items()):
            if t_ns >= end_ns + PATIENCE_NS:
                del self._pending_ns[name]
        return max(self._pending_ns.values()) + PATIENCE_NS if self._pending_ns else None
