"""Controllers check readbacks, and correct the wrong ones."""

from __future__ import annotations

from airhilt.scenario.models import RadioLine, ScriptedCommand
from airhilt.sensors.radio.answers import Answers
from airhilt.sensors.radio.on_air import Utterance
from airhilt.sensors.radio.radio_call import RadioCall
from airhilt.sensors.radio.stations import Stations


class ControllerCheck:
    """Lets controllers compare readbacks with what they have said."""

    def __init__(self, stations: Stations, answers: Answers) -> None:
        self._stations = stations
        self._answers = answers

    def correction(self, readback: RadioCall, said: Utterance, unit: str) -> RadioCall | None:
        """Return the call by which a controller corrects a readback; None if it is right.

        It is the instruction itself, once more, if another crew has read it back.
        """
        instruction, crew = readback.in_reply_to, readback.speaker
        if (
            instruction is None
            or instruction.scripted is None
            or instruction.speaker != unit
            or readback.asks_for is not None
            or not self._stations.is_actor(crew)
        ):
            return None
        right = instruction.scripted.declared
        if crew != instruction.addressed:
            instruction.withdrawn_for.add(crew)
            return instruction
        if self._stations.listener(readback.frequency_khz).differs(said.text, right.text):
            instruction.withdrawn_for.add(crew)
            return self._correct(readback, unit, right)
        return None

    def _correct(self, readback: RadioCall, unit: str, right: RadioLine) -> RadioCall:
        """Let a controller repeat what was read back wrongly, and the crew do that instead."""
        crew, scripted = readback.speaker, readback.scripted
        readback.withdrawn_for.add(crew)
        words = self._answers.again(crew, unit, right.text, is_correction=True)
        instruction = readback.in_reply_to
        correction = readback.reply("correction", unit, words, gives_again=instruction)
        correction.commands = self._planned(readback, right)
        if scripted is None:
            text = self._answers.readback_of(readback, right.text, crew)
        else:
            text = scripted.declared.text
        correction.answer = correction.reply("readback", crew, text, is_repeated=False)
        return correction

    @staticmethod
    def _planned(readback: RadioCall, right: RadioLine) -> tuple[ScriptedCommand, ...]:
        """Return what the script makes a crew do that has understood rightly."""
        lines = [right] if readback.scripted is None else [right, readback.scripted.declared]
        of_crew = (one for line in lines for one in line.commands if one.actor == readback.speaker)
        return tuple(of_crew)
