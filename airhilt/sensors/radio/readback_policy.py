"""The policy of answers: reading back, asking again, calling again, and giving up."""

from __future__ import annotations

import re
from collections.abc import Mapping

from airhilt.commands import HoldPositionCommand
from airhilt.sensors.radio.compliance import Decision
from airhilt.sensors.radio.context import RadioContext
from airhilt.sensors.radio.radio_call import (
    ANSWER_AFTER_S,
    MOST_TIMES,
    HeardCall,
    RadioCall,
    Speakers,
)
from airhilt.sim.streams import stream

CALLSIGN = re.compile(r"\b(?:callsign|call sign)\b")
"""Words of a question for the callsign."""
REPEAT_AFTER_S = 6.0
"""Least time in s after which an unanswered call is made again: an estimate."""
REPEAT_SPREAD_S = 2.0
"""Range in s of the random part of that time. Without it, two speakers who blocked each other would
do so again."""


class ReadbackPolicy:
    """Decides what is said because of what was understood."""

    def __init__(
        self, context: RadioContext, calls: Mapping[str, RadioCall], speakers: Speakers
    ) -> None:
        self._radio = context.radio
        self._stations = context.stations
        self._seed = context.seed
        self._questions: dict[frozenset[str | None], RadioCall] = {}
        """The last call that one of two has asked the other to say again."""
        self._say_agains: dict[tuple[str, str | None], RadioCall] = {}
        """The last "say again" of one to another."""
        self._world = context.world
        self._calls = calls
        self._speakers = speakers
        self._answers = context.answers

    def follow_up(self, heard: HeardCall, decision: Decision) -> None:
        """Let a recipient of a call answer it as it was understood, or its speaker repeat it."""
        if heard.is_taken:
            self._taken(heard, decision)
        elif heard.listener == heard.call.addressed:
            if heard.understanding.kind == "unclear":
                self._ask_again(heard.call, heard.listener)
            else:
                self._unanswered(heard.call, heard.listener)

    def call_again(self, call: RadioCall, after_s: float = ANSWER_AFTER_S) -> None:
        """Let the speaker of a call make it once more, because its addressee has asked for it."""
        if not call.is_of_person and call.first.times_given < MOST_TIMES:
            self._say_again_later(call, after_s)

    # --- reading back -----------------------------------------------------------------------

    def _taken(self, heard: HeardCall, decision: Decision) -> None:
        """Go on with what follows from a call once a recipient has taken it."""
        call, listener = heard.call, heard.listener
        is_in_other_words = call.is_of_person and call.scripted is not None and not call.commands
        is_as_said = heard.understanding.kind == "as_said" and not is_in_other_words
        if self._stations.is_actor(listener) and (decision.unable or not is_as_said):
            self._answer_otherwise(call, listener, decision)
        elif self._reads_back(call):
            self._read_back(heard, decision)
        call.take(listener)
        if listener != call.addressed:
            return
        if call.asks_for is not None:
            self.call_again(call.asks_for)
        if call.answer is not None:
            self._speakers.say_later(call.answer)

    def _answer_otherwise(self, call: RadioCall, listener: str, decision: Decision) -> None:
        """Let an actor answer what it has decided, in place of what was planned."""
        text = self._answers.readback(listener, decision.accepted, decision.unable)
        planned = self.readback_in_script(call, listener) or call.answer
        if planned is not None:
            planned.text, planned.commands = text, ()
        elif decision.unable or self._reads_back(call):
            is_repeated = self._radio.controller_checks_readbacks
            reply = call.reply("readback", listener, text, is_repeated=is_repeated)
            self._speakers.say_later(reply)

    def _reads_back(self, call: RadioCall) -> bool:
        """Return whether a call is read back that the script does not read back."""
        return self._radio.readbacks == "generated" or call.scripted is None or call.is_of_person

    def _read_back(self, heard: HeardCall, decision: Decision) -> None:
        """Let somebody answer a call that no line of the script answers."""
        call, listener, taken = heard.call, heard.listener, heard.understanding.call
        if call.answer is not None or self.readback_in_script(call, listener) is not None:
            return
        if call.in_reply_to is not None and call.gives_again is None:
            return
        is_to_crew = self._stations.is_actor(listener) and not self._stations.is_actor(call.speaker)
        if taken.kind == "hail":
            text = self._answers.hail(listener, call.speaker)
        elif taken.kind == "radio_check":
            text = self._answers.read_you(listener, call.speaker)
        elif is_to_crew and taken.asks_again and CALLSIGN.search(taken.text):
            text = self._answers.callsign(listener)
        elif is_to_crew and (decision.accepted or taken.kind == "disregard"):
            text = self._answers.readback(listener, decision.accepted)
        elif is_to_crew and taken.kind == "question":
            text = self._answers.say_again(listener, call.speaker)
        else:
            return
        is_repeated = self._radio.controller_checks_readbacks and bool(decision.accepted)
        self._speakers.say_later(call.reply("readback", listener, text, is_repeated=is_repeated))

    def readback_in_script(self, call: RadioCall, speaker: str) -> RadioCall | None:
        """Return the line in which somebody reads a call back, None if there is none."""
        for other in self._calls.values():
            if other.in_reply_to is call and other.speaker == speaker:
                return other
        return None

    # --- asking and calling again -----------------------------------------------------------

    def _ask_again(self, call: RadioCall, listener: str, after_s: float = ANSWER_AFTER_S) -> None:
        """Let an addressee who is not sure of a call, or waits for it, ask for it again."""
        if call.asks_for is not None:
            self.call_again(call.asks_for, REPEAT_AFTER_S)
            return
        if not call.is_of_person and call.first.times_given >= MOST_TIMES:
            self._give_up(call, listener, self._answers.unreadable(listener, call.speaker))
            return
        asker_and_asked = listener, call.speaker
        waiting = self._say_agains.get(asker_and_asked)
        if waiting is not None and self._is_still_to_be_said(waiting) and not call.is_of_person:
            waiting.asks_for = call  # One "say again" asks for all that was unclear before it.
            return
        question = call.reply(
            f"say-again-{call.times_said}",
            listener,
            self._answers.say_again(listener, call.speaker),
            is_repeated=False,
            asks_for=None if call.is_of_person else call,
        )
        self._questions[frozenset(asker_and_asked)] = call
        self._say_agains[asker_and_asked] = question
        self._speakers.say_later(question, after_s)

    def _is_still_to_be_said(self, call: RadioCall) -> bool:
        return call.times_said == 0 or self._speakers.is_being_made(call)

    def has_question(self, one: str, other: str | None) -> bool:
        """Return whether one of two waits for what it has asked the other to say again."""
        call = self._questions.get(frozenset((one, other)))
        return not (
            call is None
            or call.addressed in call.taken_by
            or call.is_of_person
            or call.first.is_given_up
        )

    def _unanswered(self, call: RadioCall, listener: str) -> None:
        """Let the speaker repeat a call that its addressee has not taken."""
        if listener in call.deaf and not self._radio.controller_checks_readbacks:
            return  # Nobody notices: that is the failure of the scenario.
        asked = call.asks_for
        is_latest = self._say_agains.get((call.speaker, listener)) is call
        if asked is not None and self._is_wanted(asked):
            self.call_again(asked, REPEAT_AFTER_S)
        elif (asked is not None and is_latest and call.times_said < MOST_TIMES) or (
            self._is_wanted(call) and call.first.times_given < MOST_TIMES
        ):
            self._say_again_later(call, REPEAT_AFTER_S)
        elif self._questions.get(frozenset((listener, call.speaker))) is call:
            self._ask_again(call, listener, REPEAT_AFTER_S)
        elif self._is_wanted(call):
            self._give_up(call, call.speaker, self._answers.no_reply(call.speaker, listener))

    def _give_up(self, call: RadioCall, name: str, text: str) -> None:
        """Let somebody say once that a call cannot be understood; who moves on the ground stops."""
        if call.first.is_given_up:
            return
        call.first.is_given_up = True
        other = call.speaker if name != call.speaker else call.addressed
        khz, stops = call.frequency_khz, self._stations.is_moving_on_ground(name)
        if stops:
            self._world.do(name, HoldPositionCommand(action="hold_position"))
            text = f"{text.removesuffix('.')}, holding position."
        end = RadioCall(f"{call.first.id}.end", khz, name, other, text, is_repeated=False)
        self._speakers.say_later(end)

    def _is_wanted(self, call: RadioCall) -> bool:
        """Return whether a call is made until it is taken; a person does that by itself."""
        is_wanted = call.is_repeated or self._radio.controller_checks_readbacks
        return is_wanted and call.asks_for is None and not call.is_of_person

    def _say_again_later(self, call: RadioCall, after_s: float) -> None:
        if not call.is_due_again and not self._speakers.is_being_made(call):
            call.is_due_again = True
            spread = stream(self._seed, f"repeat/{call.id}", call.times_said).random()
            self._speakers.say_later(call, after_s + REPEAT_SPREAD_S * spread)
