"""The radio of a run: calls are made, heard, answered, and acted upon.

`RadioConversation` takes the lines of the script as they come due and follows each until its
addressee has taken it, or its speaker has given up. Who is not sure of a call asks for it again;
who does not answer is called again; who has understood something else does that.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Sequence
from functools import partial

from airhilt.commands import Command
from airhilt.messages import HearingTruth, Message, SpokenTruth, Transcript
from airhilt.scenario.failures import EffectiveLine
from airhilt.scenario.models import Condition, RadioLine, Scenario, ScriptedCommand, StuckMicrophone
from airhilt.sensors.radio.answers import Answers
from airhilt.sensors.radio.backend import Publish, RadioBackend
from airhilt.sensors.radio.call import RadioCall, calls_of
from airhilt.sensors.radio.frequency_arbiter import GAP_S, FrequencyArbiter, OnAir, Utterance
from airhilt.sensors.radio.hearing import HearingModel, Outcome
from airhilt.sensors.radio.script import RadioScript
from airhilt.sensors.radio.stations import Stations
from airhilt.sim import Director, Priority
from airhilt.sim.streams import stream
from airhilt.units import seconds_to_ns
from airhilt.world.actors.listening import Listener, Understanding, commands_of

ANSWER_AFTER_S = 1.0
"""From the end of a call to an answer that is not in the script: an estimate."""
REPEAT_AFTER_S = 6.0
"""For so long at least a call goes unanswered until it is made again: an estimate."""
REPEAT_SPREAD_S = 2.0
"""By so much that time varies, or those who blocked each other would do so again."""
MOST_REPEATS = 2
"""How often a call is made again before its speaker gives up."""
COMPLY_AFTER_S = 2.0
"""From taking a call to doing what it is taken for, where that is not what was said; the same as
the default of scripted commands."""
TRANSCRIPT_PATIENCE_S = 20.0
"""From the end of a call, for so long a crew that reads the radio waits for the transcript."""

NOTHING = Understanding("not_for_me")
AS_SAID = Understanding("as_said")
UNCLEAR = Understanding("unclear")
_OUTCOMES: dict[str, Outcome] = {
    "as_said": "understood",
    "otherwise": "misheard",
    "unclear": "unsure",
    "not_for_me": "missed",
}

Read = Callable[[str, tuple[float, ...] | None], None]
"""Takes the words of a transcript, none if there is no transcript, and their confidences."""


class RadioConversation:
    """Lets the calls of a scenario happen.

    Parameters
    ----------
    once
        Calls its second argument as soon as its first, a condition, is true.
    do
        Lets an actor do something.
    failed
        Called with each line that something is wrong with.
    microphone_stuck
        Called with an actor's callsign and what happens, in words.
    microphones_free
        Called when no microphone is stuck any more.
    ended_lines
        Gets the ids of the calls that have been on the air.
    """

    def __init__(
        self,
        director: Director,
        scenario: Scenario,
        lines: Sequence[EffectiveLine],
        stations: Stations,
        sound: RadioBackend,
        seed: int,
        ended_lines: set[str],
        *,
        once: Callable[[Condition, Callable[[], None]], None],
        publish: Publish,
        do: Callable[[str, Command], None],
        failed: Callable[[EffectiveLine], None],
        microphone_stuck: Callable[[str, str], None],
        microphones_free: Callable[[], None],
    ) -> None:
        self._ended_lines = ended_lines
        self._director = director
        self._radio = scenario.radio
        self._stations = stations
        self._backend = sound
        self._seed = seed
        self._hearing = HearingModel(seed)
        self._answers = Answers(scenario.radio.phraseology)
        self._once = once
        self._publish = publish
        self._do = do
        self._microphone_stuck = microphone_stuck
        self._microphones_free = microphones_free
        self._stuck = 0
        """How many microphones are."""
        self._bus = FrequencyArbiter(director, sound.speak, stations.audible, self._ended)
        self._calls = calls_of(scenario, lines)
        self._on_air: dict[str, RadioCall] = {}
        """By the id of the transmission."""
        self._unread: dict[str, list[Read]] = {}
        """Who waits for the transcript of a transmission."""
        RadioScript(director, lines, once, failed, self._due)
        for failure in scenario.failures:
            if isinstance(failure, StuckMicrophone):
                at_ns = seconds_to_ns(failure.at_s)
                director.at(at_ns, partial(self._stick, failure), Priority.SCRIPT)

    # --- speaking ---------------------------------------------------------------------------

    def _stick(self, failure: StuckMicrophone) -> None:
        actor = failure.actor
        self._stuck += 1
        self._microphone_stuck(actor, f"its microphone is stuck for {failure.for_s:g} s")
        self._after(failure.for_s, self._unstick)
        for frequency_khz in self._stations.frequencies_of(actor):
            name = f"stuck-microphone.{actor}.{failure.at_s:g}.{frequency_khz}"
            self._bus.press(Utterance(name, frequency_khz, actor, None, ""), failure.for_s)

    def _unstick(self) -> None:
        self._stuck -= 1
        if not self._stuck:
            self._microphones_free()

    def _due(self, line: RadioLine) -> None:
        """Say a line once its speaker has taken what it follows from."""
        call = self._calls[line.id]
        for needed in call.needs:
            if needed is None:
                return
            if call.speaker not in needed.taken_by:
                due = partial(self._after, GAP_S, partial(self._due, line))
                needed.once_taken_by(call.speaker, due)
                return
        self._say(call)

    def _say(self, call: RadioCall) -> None:
        if not self._stations.is_there(call.speaker):
            return
        again = call.times_said
        call.times_said += 1
        call.is_due_again = False
        scripted = call.scripted
        replied_to = call.in_reply_to
        utterance = Utterance(
            f"{call.id}.repeat-{again}" if again else call.id,
            call.frequency_khz,
            call.speaker,
            call.addressed,
            call.said,
            None if replied_to is None else replied_to.id,
            listens_first=again > 0 or scripted is None or scripted.listens_first,
        )
        self._on_air[utterance.id] = call
        self._bus.say(utterance)

    def _after(self, delay_s: float, action: Callable[[], None]) -> None:
        due_ns = self._director.now_ns + seconds_to_ns(delay_s)
        self._director.at(due_ns, action, Priority.SCRIPT)

    # --- on the air -------------------------------------------------------------------------

    def _ended(self, on_air: OnAir) -> None:
        """Let a transmission that has ended be received, heard, and acted upon."""
        said = on_air.utterance
        mixed_with = self._mixed_with(on_air)
        transcript = self._receive(on_air, mixed_with)
        call = self._on_air.pop(said.id, None)
        if call is not None:
            self._ended_lines.add(call.id)
            self._let_read(call, said, is_blocked=bool(mixed_with))
        if transcript is not None:
            self._publish(f"asr/{said.frequency_khz}", transcript)
        if call is None:
            return
        if call.is_first_time:
            self._carry_out(call, call.speaker)
        for listener in call.recipients():
            if not self._reads(listener):
                self._hear(call, on_air, listener)

    def close(self) -> None:
        """Let what is on the air be received as far as it has come; nobody acts upon it."""
        for on_air in self._bus.close():
            self._receive(on_air, self._mixed_with(on_air))

    def _mixed_with(self, on_air: OnAir) -> tuple[OnAir, ...]:
        """Return what else the units received at the same time."""
        return tuple(
            other
            for other in on_air.overlapping
            if self._stations.received(other.utterance.speaker)
        )

    def _receive(self, on_air: OnAir, mixed_with: tuple[OnAir, ...]) -> Transcript | None:
        """Publish a transmission, and how the units receive it if they do.

        Returns its words where there is no sound to recognise them from.
        """
        self._tell_truth(on_air, mixed_with)
        said = on_air.utterance
        if not (self._squelch_opens and self._stations.received(said.speaker)):
            return None
        background = self._stations.background_of(said.speaker)
        reception = self._backend.receive(on_air, mixed_with, self._radio.snr_db, background)
        self._publish(f"radio/{said.frequency_khz}/tx", reception.header, raw=reception.pcm)
        return reception.transcript

    def _tell_truth(self, on_air: OnAir, mixed_with: Sequence[OnAir]) -> None:
        said = on_air.utterance
        truth = SpokenTruth(
            t_ns=self._director.now_ns,
            id=said.id,
            speaker=said.speaker,
            addressed=said.addressed,
            frequency_khz=said.frequency_khz,
            text=said.text,
            t_tx_ns=on_air.t_tx_ns,
            t_end_ns=on_air.t_end_ns,
            in_reply_to=said.in_reply_to,
            blocked_by=tuple(other.utterance.id for other in mixed_with),
            snr_db=self._radio.snr_db,
        )
        self._publish(f"truth/radio/{said.id}", truth)

    @property
    def _squelch_opens(self) -> bool:
        snr_db = self._radio.snr_db
        return snr_db is None or snr_db >= self._radio.squelch_db

    def _reaches(self, on_air: OnAir, listener: str) -> bool:
        """Return whether a transmission reaches somebody, and no other with it."""
        audible = self._stations.audible
        return (
            self._squelch_opens
            and audible(on_air.utterance.speaker, listener)
            and not any(audible(other.utterance.speaker, listener) for other in on_air.overlapping)
        )

    # --- listening --------------------------------------------------------------------------

    def _hear(self, call: RadioCall, on_air: OnAir, listener: str) -> None:
        """Let somebody listen to a call that is for him."""
        said = on_air.utterance
        if listener in call.deaf or not self._reaches(on_air, listener):
            self._make_of(call, said, listener, NOTHING, "")
            return
        heard = self._hearing.listen(said.id, listener, said.text, self._radio.snr_db)
        match heard.outcome:
            case "understood":
                understanding = AS_SAID
            case "misheard":
                understanding = self._sense(call, said, listener, heard.text, None)
            case "unsure":
                understanding = UNCLEAR
            case "missed":
                understanding = NOTHING
        self._make_of(call, said, listener, understanding, heard.text)

    def _reads(self, listener: str) -> bool:
        """Return whether somebody reads the radio instead of listening to it."""
        return self._radio.topology == "asr_first" and self._stations.is_crew(listener)

    def _let_read(self, call: RadioCall, said: Utterance, *, is_blocked: bool) -> None:
        """Let the crews that read the radio wait for the transcript of a call.

        Nobody reads a call that was received with another in it.
        """
        recipients = call.recipients()
        for listener in self._stations.actors_on(said.frequency_khz):
            if listener == said.speaker or not self._reads(listener):
                continue
            if listener in recipients and (is_blocked or listener in call.deaf):
                self._make_of(call, said, listener, NOTHING, "", read=True)
            elif listener in recipients:
                read = partial(self._read, call, said, listener)
                self._unread.setdefault(said.id, []).append(read)
            elif self._radio.overhearing and not is_blocked and listener not in call.taken_by:
                overhear = partial(self._overhear, call, said, listener)
                self._unread.setdefault(said.id, []).append(overhear)
        if said.id in self._unread:
            self._after(TRANSCRIPT_PATIENCE_S, partial(self._give_out, said.id, "", None))

    def take(self, key: str, message: Message, data: bytes) -> None:  # noqa: ARG002
        """Give a transcript to the crews that wait for it."""
        if isinstance(message, Transcript):
            confidences = tuple(word.confidence for word in message.words) or None
            self._give_out(message.id, message.text, confidences)

    def _give_out(
        self, transmission: str, text: str, confidences: tuple[float, ...] | None
    ) -> None:
        for read in self._unread.pop(transmission, ()):
            read(text, confidences)

    def _read(
        self,
        call: RadioCall,
        said: Utterance,
        listener: str,
        text: str,
        confidences: tuple[float, ...] | None,
    ) -> None:
        """Let the recipient of a call read it."""
        understanding = self._sense(call, said, listener, text, confidences) if text else NOTHING
        self._make_of(call, said, listener, understanding, text, read=True)

    def _overhear(
        self,
        call: RadioCall,
        said: Utterance,
        listener: str,
        text: str,
        confidences: tuple[float, ...] | None,
    ) -> None:
        """Let a crew read a call for somebody else, which it may take for its own."""
        if not text or self._stations.is_actor(said.speaker):
            return
        understanding = self._listener(call).overhear(
            text, said.text, listener, self._stations.bound_runway(listener), confidences
        )
        if understanding.kind == "otherwise":
            self._tell_hearing(said, listener, understanding, text, read=True)
            self._comply(call, listener, understanding.commands)

    def _sense(
        self,
        call: RadioCall,
        said: Utterance,
        listener: str,
        heard: str,
        confidences: tuple[float, ...] | None,
    ) -> Understanding:
        """Return what the recipient of a call makes of the words that reached him.

        He knows it by his own callsign, or by the one that he takes for it; a unit, by the
        caller's.
        """
        stations = self._stations
        names = [listener, call.addressed or ""]
        if not stations.is_actor(listener):
            names = [call.speaker]
        known_by = tuple(name for name in names if stations.is_actor(name))
        return self._listener(call).make_sense(
            heard, said.text, known_by, stations.bound_runway(listener), confidences
        )

    def _listener(self, call: RadioCall) -> Listener:
        return Listener(self._stations.actors_on(call.frequency_khz))

    def _make_of(
        self,
        call: RadioCall,
        said: Utterance,
        listener: str,
        understanding: Understanding,
        text: str,
        *,
        read: bool = False,
    ) -> None:
        """Let somebody act on what he makes of a call."""
        self._tell_hearing(said, listener, understanding, text, read=read)
        match understanding.kind:
            case "as_said":
                self._carry_out(call, listener)
                self._taken(call, said, listener, understanding)
            case "otherwise":
                self._mistaken(call, listener, understanding)
                self._taken(call, said, listener, understanding)
            case "unclear" if listener == call.addressed:
                self._unclear(call, listener)
            case "not_for_me" if listener == call.addressed:
                self._unanswered(call, listener)

    def _tell_hearing(
        self,
        said: Utterance,
        listener: str,
        understanding: Understanding,
        text: str,
        *,
        read: bool,
    ) -> None:
        truth = HearingTruth(
            t_ns=self._director.now_ns,
            id=said.id,
            actor=listener,
            outcome=_OUTCOMES[understanding.kind],
            text=text,
            source="transcript" if read else "ear",
        )
        self._publish(f"truth/hearing/{re.sub('[^A-Za-z0-9]+', '_', listener)}", truth)

    # --- doing ------------------------------------------------------------------------------

    def _carry_out(self, call: RadioCall, actor: str) -> None:
        """Let somebody do what a call means for him."""
        for scripted in call.meant:
            if scripted.actor == actor:
                self._after(scripted.delay_s, partial(self._when_due, call, scripted))

    def _when_due(self, call: RadioCall, scripted: ScriptedCommand) -> None:
        def act() -> None:
            if scripted.actor not in call.withdrawn_for:
                self._do(scripted.actor, scripted.command)

        if scripted.when is None:
            act()
        else:
            self._once(scripted.when, act)

    def _comply(self, call: RadioCall, actor: str, commands: Iterable[Command]) -> None:
        """Let an actor do what it has taken a call for."""
        for command in commands:
            scripted = ScriptedCommand(actor=actor, command=command, delay_s=COMPLY_AFTER_S)
            self._after(scripted.delay_s, partial(self._when_due, call, scripted))

    # --- answering --------------------------------------------------------------------------

    def _taken(
        self, call: RadioCall, said: Utterance, listener: str, understanding: Understanding
    ) -> None:
        """Go on with what follows from a call once somebody has taken it."""
        call.take(listener)
        if self._radio.readbacks == "generated":
            self._read_back(call, said, listener, understanding)
        if listener != call.addressed:
            return
        if call.asks_for is not None:
            self._repeat(call.asks_for, ANSWER_AFTER_S)
        if call.answer is not None:
            self._after(ANSWER_AFTER_S, partial(self._say, call.answer))
        if self._radio.controller_checks_readbacks:
            self._check(call, said, listener)

    def _mistaken(self, call: RadioCall, listener: str, understanding: Understanding) -> None:
        """Let an actor do what it has taken a call for, and read that back."""
        if not self._stations.is_actor(listener):
            return
        self._comply(call, listener, understanding.commands)
        readback = self._readback_in_script(call, listener)
        if readback is not None and understanding.call is not None:
            readback.text = self._answers.readback(listener, understanding.call.instructions)
            readback.commands = ()

    def _readback_in_script(self, call: RadioCall, speaker: str) -> RadioCall | None:
        for other in self._calls.values():
            if other.in_reply_to is call and other.speaker == speaker:
                return other
        return None

    def _read_back(
        self, call: RadioCall, said: Utterance, listener: str, understanding: Understanding
    ) -> None:
        """Let an actor read back an instruction of a unit that no line of the script does."""
        if (
            call.in_reply_to is not None
            or not self._stations.is_actor(listener)
            or self._stations.is_actor(call.speaker)
            or self._readback_in_script(call, listener) is not None
        ):
            return
        listens = self._listener(call)
        parsed = understanding.call or listens.parse(said.text, listens.callsigns, None)
        if parsed.instructions:
            readback = RadioCall(
                f"{call.id}.readback",
                call.frequency_khz,
                listener,
                call.speaker,
                self._answers.readback(listener, parsed.instructions),
                in_reply_to=call,
                is_repeated=self._radio.controller_checks_readbacks,
            )
            self._after(ANSWER_AFTER_S, partial(self._say, readback))

    def _unclear(self, call: RadioCall, listener: str) -> None:
        """Let somebody ask for a call again that he is not sure of."""
        if call.asks_for is not None:
            self._repeat(call.asks_for, REPEAT_AFTER_S)
        if not self._may_repeat(call):
            return
        question = RadioCall(
            f"{call.id}.say-again-{call.times_said}",
            call.frequency_khz,
            listener,
            call.speaker,
            self._answers.say_again(self._callsign(listener), self._callsign(call.speaker)),
            in_reply_to=call,
            is_repeated=False,
            asks_for=call,
        )
        self._after(ANSWER_AFTER_S, partial(self._say, question))

    def _callsign(self, name: str) -> str | None:
        return name if self._stations.is_actor(name) else None

    def _unanswered(self, call: RadioCall, listener: str) -> None:
        """Let a call that its addressee has not taken be made again."""
        if listener in call.deaf and not self._radio.controller_checks_readbacks:
            return  # Nobody notices: so the scenario has it.
        if call.asks_for is not None:
            self._repeat(call.asks_for, REPEAT_AFTER_S)
        self._repeat(call, REPEAT_AFTER_S)

    def _may_repeat(self, call: RadioCall) -> bool:
        is_wanted = call.is_repeated or self._radio.controller_checks_readbacks
        return is_wanted and call.asks_for is None and call.times_said <= MOST_REPEATS

    def _repeat(self, call: RadioCall, after_s: float) -> None:
        if self._may_repeat(call) and not call.is_due_again:
            call.is_due_again = True
            spread = stream(self._seed, f"repeat/{call.id}", call.times_said).random()
            self._after(after_s + REPEAT_SPREAD_S * spread, partial(self._say, call))

    def _check(self, readback: RadioCall, said: Utterance, unit: str) -> None:
        """Let a controller correct a readback that is wrong, or is somebody else's."""
        instruction, crew = readback.in_reply_to, readback.speaker
        if (
            instruction is None
            or instruction.scripted is None
            or instruction.speaker != unit
            or readback.asks_for is not None
            or not self._stations.is_actor(crew)
        ):
            return
        right = instruction.scripted.declared
        if crew != instruction.addressed:
            instruction.withdrawn_for.add(crew)
            self._repeat(instruction, ANSWER_AFTER_S)
        elif self._listener(readback).differs(said.text, right.text):
            self._correct(readback, instruction, right)

    def _correct(self, readback: RadioCall, instruction: RadioCall, right: RadioLine) -> None:
        """Let a controller say again what was read back wrongly, and the crew do that instead."""
        crew, unit, listens = readback.speaker, instruction.speaker, self._listener(readback)
        readback.withdrawn_for.add(crew)
        instruction.withdrawn_for.add(crew)
        meant = listens.parse(right.text, listens.callsigns, None).instructions
        scripted = None if readback.scripted is None else readback.scripted.declared
        commands = tuple(
            command
            for line in (right, scripted)
            for command in (() if line is None else line.commands)
            if command.actor == crew
        ) or tuple(
            ScriptedCommand(actor=crew, command=command, delay_s=COMPLY_AFTER_S)
            for command in commands_of(meant, self._stations.bound_runway(crew))
        )
        read_again = self._answers.readback(crew, meant) if scripted is None else scripted.text
        correction = RadioCall(
            f"{readback.id}.correction",
            readback.frequency_khz,
            unit,
            crew,
            self._answers.negative(crew, right.text),
            commands,
            in_reply_to=readback,
        )
        correction.answer = RadioCall(
            f"{correction.id}.readback",
            readback.frequency_khz,
            crew,
            unit,
            read_again,
            in_reply_to=correction,
            is_repeated=False,
        )
        self._after(ANSWER_AFTER_S, partial(self._say, correction))
