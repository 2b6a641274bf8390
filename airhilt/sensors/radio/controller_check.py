"""Controllers check readbacks, and correct the wrong ones."""

from __future__ import annotations

from airhilt.scenario.models import RadioLine, ScriptedCommand
from airhilt.sensors.radio.answers import Answers
from airhilt.sensors.radio.compliance import COMPLY_AFTER_S
from airhilt.sensors.radio.on_air import Utterance
from airhilt.sensors.radio.radio_call import RadioCall
from airhilt.sensors.radio.stations import Stations
from airhilt.world.actors.listening import Listener


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
        if self._listener(readback).differs(said.text, right.text):
            return self._correct(readback, instruction, right)
        return None

    def _correct(self, readback: RadioCall, instruction: RadioCall, right: RadioLine) -> RadioCall:
        """Let a controller repeat what was read back wrongly, and the crew do that instead."""
        crew, unit = readback.speaker, instruction.speaker
        readback.withdrawn_for.add(crew)
        instruction.withdrawn_for.add(crew)
        correction = RadioCall(
            f"{readback.id}.correction",
            readback.frequency_khz,
            unit,
            crew,
            self._answers.negative(crew, right.text),
            self._commands_of_correction(readback, right),
            in_reply_to=readback,
        )
        correction.answer = RadioCall(
            f"{correction.id}.readback",
            readback.frequency_khz,
            crew,
            unit,
            self._text_of_second_readback(readback, right),
            in_reply_to=correction,
            is_repeated=False,
        )
        return correction

    def _commands_of_correction(
        self, readback: RadioCall, right: RadioLine
    ) -> tuple[ScriptedCommand, ...]:
        """Return what a correction makes a crew do: its commands in the script, or its words."""
        crew, listens = readback.speaker, self._listener(readback)
        lines = [right] if readback.scripted is None else [right, readback.scripted.declared]
        in_script = tuple(
            command for line in lines for command in line.commands if command.actor == crew
        )
        meant = listens.parse(right.text, listens.callsigns, None).instructions
        return in_script or tuple(
            ScriptedCommand(actor=crew, command=command, delay_s=COMPLY_AFTER_S)
            for command in listens.commands_of(meant, self._stations.bound_runway(crew))
        )

    def _text_of_second_readback(self, readback: RadioCall, right: RadioLine) -> str:
        if readback.scripted is not None:
            return readback.scripted.declared.text
        listens = self._listener(readback)
        meant = listens.parse(right.text, listens.callsigns, None).instructions
        return self._answers.readback(readback.speaker, meant)

    def _listener(self, call: RadioCall) -> Listener:
        return self._stations.listener(call.frequency_khz)
