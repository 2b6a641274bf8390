"""Gated fusion: nothing is told while something that was sensed has not been taken in."""

from __future__ import annotations

from airhilt.messages import Status, Transcript, Transmission
from airhilt.units import SECOND_NS

PATIENCE_NS = 10 * SECOND_NS
"""After the end of a call, for so long its transcript is waited for: noise, and calls that blocked
each other, may never give one."""


class FusionGate:
    """Is closed while a call has ended and its transcript has not come.

    ADS-B reports come once a second at least, and are taken in as they come: nothing waits for
    them.
    """

    def __init__(self) -> None:
        self._pending_ns: dict[str, int] = {}
        """Ends of the calls whose transcripts are waited for, by their ids."""
        self._is_deaf = False

    def take_transmission(self, transmission: Transmission) -> None:
        """Take in that a call has been received."""
        if transmission.samples and not self._is_deaf:
            self._pending_ns[transmission.id] = transmission.t_end_ns

    def take_transcript(self, transcript: Transcript) -> None:
        """Take in the words of a call."""
        self._pending_ns.pop(transcript.id, None)

    def take_status(self, status: Status) -> None:
        """Take in that a modality is lost: no more transcripts are waited for."""
        if status.modality == "asr":
            self._is_deaf = status.state == "lost"
            if self._is_deaf:
                self._pending_ns.clear()

    def opens_ns(self, t_ns: int) -> int | None:
        """Return when the gate opens at the latest; None if it is open."""
        for name, end_ns in list(self._pending_ns.items()):
            if t_ns >= end_ns + PATIENCE_NS:
                del self._pending_ns[name]
        return max(self._pending_ns.values()) + PATIENCE_NS if self._pending_ns else None
