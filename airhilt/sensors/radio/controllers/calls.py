"""The calls of controllers: a measure in words, and what those words make its addressee do."""

from __future__ import annotations

from airhilt.phraseology import Instruction
from airhilt.phraseology.say import speak_instruction
from airhilt.scenario.conversation import needed_lines
from airhilt.scenario.models import ScriptedCommand
from airhilt.sensors.radio.context import RadioContext
from airhilt.sensors.radio.controllers.displays import Displays
from airhilt.sensors.radio.controllers.measures import Measure, Repetition
from airhilt.sensors.radio.controllers.positions import Position
from airhilt.sensors.radio.controllers.strips import Contact, Strips
from airhilt.sensors.radio.controllers.wording import Wording
from airhilt.sensors.radio.radio_call import HeardCall, RadioCall, Speakers


class ControllerCalls:
    """Makes calls of measures: ordinary calls, heard and obeyed like all others."""

    def __init__(
        self, context: RadioContext, speakers: Speakers, displays: Displays, strips: Strips
    ) -> None:
        self._context = context
        self._stations = context.stations
        self._speakers = speakers
        self._answers = context.answers
        style, variation_deg = context.radio.phraseology, context.stations.variation_deg
        self._wording = Wording(displays, strips, style, variation_deg)
        self._answered = needed_lines(context.scenario)

    def say(self, position: Position, call: RadioCall) -> None:
        """Let a controller make a call, who makes no other one before it has ended."""
        position.speaking = call
        self._speakers.say(call)

    def instructions(
        self, measure: Measure | Repetition, contact: Contact
    ) -> tuple[Instruction, ...]:
        """Return what a measure tells its crew or driver to do."""
        if isinstance(measure, Measure):
            return self._wording.instructions(measure)
        listener = self._stations.listener(contact.frequency_khz)
        return listener.parse(measure.call.said).instructions

    def call(self, name: str, measure: Measure | Repetition, contact: Contact) -> RadioCall:
        """Return the call of a measure, with what its words make its addressee do."""
        callsign, (unit, frequency_khz) = measure.callsign, contact
        instructions = self.instructions(measure, contact)
        planned: tuple[ScriptedCommand, ...] = ()
        again = None
        if isinstance(measure, Measure):
            text = self._wording.text(measure, instructions)
        else:
            again, said = measure.call, measure.call.said
            if again.scripted is None:
                said = speak_instruction(callsign, instructions, self._context.radio.phraseology)
            text = self._answers.again(callsign, unit, said, is_correction=measure.is_correction)
            planned = tuple(one for one in self._planned(again) if one.actor == callsign)
        return RadioCall(
            name, frequency_khz, unit, callsign, text, planned, is_urgent=True, gives_again=again
        )

    def correction(self, heard: HeardCall) -> RadioCall | None:
        """Return the call by which a unit corrects a readback of the script; None if it is right.

        It is the instruction itself, once more, if another crew has read it back.
        """
        readback, unit = heard.call, heard.listener
        instruction, crew, scripted = readback.in_reply_to, readback.speaker, readback.scripted
        if instruction is None or instruction.scripted is None or instruction.speaker != unit:
            return None
        if readback.asks_for is not None or not self._stations.is_actor(crew):
            return None
        right = instruction.scripted.declared
        differs = self._stations.listener(readback.frequency_khz).differs
        is_addressed = crew == instruction.addressed
        if is_addressed and not differs(heard.said.text, right.text):
            return None
        instruction.in_force[crew] = ()
        if not is_addressed:
            return instruction
        readback.in_force[crew] = ()
        words = self._answers.again(crew, unit, right.text, is_correction=True)
        correction = readback.reply("correction", unit, words, gives_again=instruction)
        text, planned = (
            self._answers.readback_of(right.text, crew, readback.frequency_khz),
            right.commands,
        )
        if scripted is not None:
            text, planned = scripted.declared.text, planned + scripted.declared.commands
        correction.commands = tuple(one for one in planned if one.actor == crew)
        correction.answer = correction.reply("readback", crew, text, is_repeated=False)
        return correction

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
