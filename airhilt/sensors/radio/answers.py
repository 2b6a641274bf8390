"""Words of calls that no script has: readbacks, questions and corrections."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from airhilt.phraseology import Instruction, Style
from airhilt.phraseology.say import speak_callsign, speak_readback, speak_say_again


@dataclass(frozen=True, slots=True)
class Answers:
    """Words of answers, in one phraseology."""

    style: Style

    def readback(self, callsign: str, instructions: Sequence[Instruction]) -> str:
        """Return the readback of some instructions."""
        return speak_readback(callsign, instructions, self.style)

    def say_again(self, by: str | None, to: str | None) -> str:
        """Return the request to repeat a call.

        Parameters
        ----------
        by, to
            Callsigns of the actor who asks and of the actor who is asked; None for a unit.
        """
        if by is not None:
            return speak_say_again(by, self.style)
        return "Say again." if to is None else f"{speak_callsign(to, self.style)}, say again."

    def negative(self, callsign: str, said: str) -> str:
        """Return the correction of a wrong readback: the call again, marked as such.

        "Negative" and "I say again" are those of ICAO Annex 10 volume II, 5.2.1.5.8.
        """
        return f"{speak_callsign(callsign, self.style)}, negative. I say again. {said}"
