"""The calls of controllers: a measure in words, and what those words make its addressee do."""

from __future__ import annotations

from airhilt.phraseology import Instruction
from airhilt.phraseology.say import speak_instruction
from airhilt.scenario.conversation import needed_lines
from airhilt.scenario.models import ScriptedCommand
from airhilt.sensors.radio.answers import Answers
from airhilt.sensors.radio.context import RadioContext
from airhilt.sensors.radio.controllers.displays import Displays
from airhilt.sensors.radio.controllers.measures import Measure, Repetition
from airhilt.sensors.radio.controllers.strips import Contact, Strips
from airhilt.sensors.radio.controllers.wording import Wording
from airhilt.sensors.radio.radio_call import RadioCall, Speakers


class ControllerCalls:
    """Makes calls of measures: ordinary calls, heard and obeyed like all others."""

    def __init__(
        self, context: RadioContext, speakers: Speakers, displays: Displays, strips: Strips
    ) -> None:
        self._context = context
        self._director = context.director
        self._stations = context.stations
        self._speakers = speakers
        self._answers = Answers(context)
        style, variation_deg = context.radio.phraseology, context.stations.variation_deg
        self._wording = Wording(displays, strips, style, variation_deg)
        self._answered = needed_lines(context.scenario)

    def instructions(
        self, measure: Measure | Repetition, contact: Contact
    ) -> tuple[Instruction, ...]:
        """Return what a measure tells its crew or driver to do."""
        if isinstance(measure, Measure):
            return self._wording.instructions(measure, self._director.now_ns)
        listener = self._stations.listener(contact.frequency_khz)
        return listener.parse(measure.call.said).instructions

    def call(self, name: str, measure: Measure | Repetition, contact: Contact) -> RadioCall:
        """Return the call of a measure, with what its words make its addressee do."""
        callsign, (unit, frequency_khz) = measure.callsign, contact
        instructions = self.instructions(measure, contact)
        if isinstance(measure, Measure):
            text = self._wording.text(measure, instructions, self._director.now_ns)
        else:
            said, is_correction = measure.call.said, measure.is_correction
            if measure.call.scripted is None:
                said = speak_instruction(callsign, instructions, self._context.radio.phraseology)
            text = self._answers.again(callsign, unit, said, is_correction=is_correction)
        planned: tuple[ScriptedCommand, ...] = ()
        again = measure.call if isinstance(measure, Repetition) else None
        if isinstance(measure, Repetition):
            planned = tuple(one for one in self._planned(measure.call) if one.actor == callsign)
        return RadioCall(
            name, frequency_khz, unit, callsign, text, planned, is_urgent=True, gives_again=again
        )

    def _planned(self, call: RadioCall) -> tuple[ScriptedCommand, ...]:
        """Return the commands of a scripted instruction and of a right readback in the script."""
        if call.scripted is None:
            return call.commands
        differs = self._stations.listener(call.frequency_khz).differs
        lines = [
            line.declared
            for line in self._context.lines
            if call.id in self._answered[line.declared.id]
            and line.declared.speaker == call.addressed
            and not differs(line.declared.text, call.said)
        ]
        return sum((line.commands for line in lines), call.scripted.declared.commands)
