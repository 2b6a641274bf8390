"""Words of calls that no script has: readbacks, questions and corrections."""

from __future__ import annotations

from collections.abc import Sequence

from airhilt.phraseology import Instruction, parse_call
from airhilt.phraseology.numbers import Style, speak_digits
from airhilt.phraseology.say import speak_callsign, speak_readback, speak_say_again
from airhilt.phraseology.spoken_actions import phrase_of
from airhilt.sensors.radio.stations import Stations


class Answers:
    """Words of answers, in the phraseology of the scenario."""

    def __init__(self, stations: Stations, style: Style) -> None:
        self._stations = stations
        self._style = style

    def readback(
        self, callsign: str, instructions: Sequence[Instruction | str], unable: Sequence[str] = ()
    ) -> str:
        """Return what an actor answers to instructions: it reads back or tells, or is unable.

        Words among the instructions are said as they are.
        """
        told: list[Instruction | str] = []
        unknown = []
        for each in instructions:
            if isinstance(each, str) or each.action != "say":
                told.append(each)
                continue
            asked = each.position or ""
            report = self._stations.report_of(callsign, asked, self._style)
            if report is None:
                unknown.append(asked)
            else:
                told.append(report)
        if unknown:
            told.append(f"unable to say {' or '.join(unknown)}")
        return speak_readback(callsign, [*told, *unable], self._style)

    def yes(self) -> str:
        """Return the word for yes (Annex 10 volume II, 5.2.1.5.8; FAA's glossary)."""
        return "affirmative" if self._style == "faa" else "affirm"

    def does(self, instruction: Instruction) -> str:
        """Return the words of somebody who is asked whether it stands or holds, and does."""
        words = phrase_of(instruction, self._style, readback=True)
        return f"{self.yes()}, {words.replace('hold', 'holding', 1)}"

    def of_itself(self, callsign: str, instruction: Instruction) -> str:
        """Return what an actor says that is asked whether it does or has something."""
        asked = instruction.action if instruction.position is None else instruction.position
        report = self._stations.report_of(callsign, asked, self._style)
        return report or "unable to confirm"

    def whereabouts(self, callsign: str) -> str:
        """Return the words of an actor that does not do what it is asked about."""
        reports = (
            self._stations.report_of(callsign, asked, self._style)
            for asked in ("position", "intentions")
        )
        return ", ".join(["negative", *filter(None, reports)])

    def read_you(self, called: str, caller: str) -> str:
        """Return the answer of who is called to a radio check (Annex 10 volume II, 5.2.1.8)."""
        names = [self._name(caller), self._name(called)]
        return f"{', '.join(names)}, read you {speak_digits('5', self._style)}."

    def unreadable(self, name: str, other: str) -> str:
        """Return what somebody says who has not understood another one for the last time."""
        return f"{self._name(other)}, {self._name(name)}, your transmission is unreadable."

    def no_reply(self, name: str, other: str) -> str:
        """Return what somebody says whom another one does not answer."""
        return f"{self._name(other)}, {self._name(name)}, no reply heard."

    def hail(self, called: str, caller: str) -> str:
        """Return what who is called answers to who calls without more words."""
        names = [self._name(caller), self._name(called)]
        return f"{', '.join(names)}, go ahead."

    def to_unit(self, callsign: str, unit: str, text: str = "") -> str:
        """Return a call of an actor to a unit."""
        parts = [unit, speak_callsign(callsign, self._style), *([text] if text else [])]
        return f"{', '.join(parts)}."

    def callsign(self, callsign: str) -> str:
        """Return the callsign of an actor as a call of its own."""
        return f"{speak_callsign(callsign, self._style)}."

    def _name(self, name: str) -> str:
        return speak_callsign(name, self._style) if self._stations.is_actor(name) else name

    def readback_of(self, text: str, callsign: str, frequency_khz: int) -> str:
        """Return the readback of the words of a call."""
        meant = self._stations.listener(frequency_khz).parse(text)
        return self.readback(callsign, meant.instructions)

    def say_again(self, asking: str, asked: str) -> str:
        """Return the request of an actor or a unit to another one to repeat a call."""
        if self._stations.is_actor(asking):
            return speak_say_again(asking, self._style)
        if self._stations.is_actor(asked):
            return f"{speak_callsign(asked, self._style)}, say again."
        return "Say again."

    def again(self, callsign: str, unit: str, said: str, *, is_correction: bool) -> str:
        """Return what a unit said, once more: it was not read back, or otherwise.

        "Negative" and "I say again" are those of ICAO Annex 10 volume II, 5.2.1.5.8.
        """
        clauses = said.split(", ")
        while len(clauses) > 1 and _only_addresses(clauses[0], callsign, unit):
            clauses.pop(0)
        begin = "negative, I say again" if is_correction else "I say again"
        return f"{speak_callsign(callsign, self._style)}, {begin}, {', '.join(clauses)}"


def _only_addresses(clause: str, callsign: str, unit: str) -> bool:
    """Return whether a clause of a call of a unit only says for whom it is, and from whom."""
    parsed = parse_call(clause, (callsign,))
    return clause == unit or (parsed.callsign == callsign and not parsed.instructions)
