"""Words of calls that no script has: readbacks, questions and corrections."""

from __future__ import annotations

from collections.abc import Sequence

from airhilt.phraseology import Instruction
from airhilt.phraseology.say import speak_callsign, speak_readback, speak_say_again
from airhilt.sensors.radio.context import RadioContext
from airhilt.sensors.radio.radio_call import RadioCall


class Answers:
    """Words of answers, in the phraseology of the scenario."""

    def __init__(self, context: RadioContext) -> None:
        self._stations = context.stations
        self._style = context.radio.phraseology

    def readback(self, callsign: str, instructions: Sequence[Instruction]) -> str:
        """Return the readback of some instructions."""
        return speak_readback(callsign, instructions, self._style)

    def readback_of(self, call: RadioCall, text: str, callsign: str) -> str:
        """Return the readback of the words of a call."""
        meant = self._stations.listener(call.frequency_khz).parse(text)
        return self.readback(callsign, meant.instructions)

    def say_again(self, asking: str, asked: str) -> str:
        """Return the request of an actor or a unit to another one to repeat a call."""
        if self._stations.is_actor(asking):
            return speak_say_again(asking, self._style)
        if self._stations.is_actor(asked):
            return f"{speak_callsign(asked, self._style)}, say again."
        return "Say again."

    def negative(self, callsign: str, said: str) -> str:
        """Return the correction of a wrong readback: the call again, marked as such.

        "Negative" and "I say again" are those of ICAO Annex 10 volume II, 5.2.1.5.8.
        """
        return f"{speak_callsign(callsign, self._style)}, negative. I say again. {said}"
