"""Silence on a frequency after an instruction: nobody has begun to read it back."""

from __future__ import annotations

from airhilt.messages import Transcript, TransmissionOpened
from airhilt.units import SECOND_NS

DUE_NS = 5 * SECOND_NS
"""Silence after an instruction, in ns, from which its readback is late. No document gives a time; a
readback is to be immediate, and crews here and on recorded frequencies begin within 1 to 3 s."""
UNDECIDED_NS = 30 * SECOND_NS
"""Time for which a transmission without words may still be the readback, in ns."""
REMEMBERED_NS = 180 * SECOND_NS
"""Time for which transmissions are remembered, in ns."""


class ReadbackSilence:
    """Follows who transmits when; without the openings of transmissions it says nothing."""

    def __init__(self) -> None:
        self._opened: dict[str, TransmissionOpened] = {}
        self._understood_ns: dict[str, int] = {}
        """End of each transmission whose words are known."""

    def take_opening(self, opened: TransmissionOpened) -> None:
        """Note that a transmission has begun."""
        oldest_ns = opened.t_tx_ns - REMEMBERED_NS
        self._opened = {name: o for name, o in self._opened.items() if o.t_tx_ns >= oldest_ns}
        self._opened[opened.id] = opened

    def take_transcript(self, transcript: Transcript) -> None:
        """Note that the words of a transmission are known."""
        self._understood_ns[transcript.id] = transcript.t_end_ns

    def is_late(self, instruction: Transcript, t_ns: int) -> bool:
        """Return whether an instruction that nobody has read back should have been by now.

        It is not while somebody transmits, or has transmitted what is not understood yet: that may
        be the readback. Calls between others put it off.
        """
        if instruction.id not in self._opened:
            return False
        quiet_since_ns = instruction.t_end_ns
        for opened in self._opened.values():
            is_later = opened.t_tx_ns >= instruction.t_end_ns
            if not is_later or opened.frequency_khz != instruction.frequency_khz:
                continue
            end_ns = self._understood_ns.get(opened.id)
            if end_ns is None and t_ns - opened.t_tx_ns < UNDECIDED_NS:
                return False
            quiet_since_ns = max(quiet_since_ns, end_ns or opened.t_tx_ns)
        return t_ns - quiet_since_ns >= DUE_NS
