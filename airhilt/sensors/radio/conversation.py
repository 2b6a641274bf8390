"""The radio of a run: calls are made, heard, answered, and acted upon.

`RadioConversation` connects the parts. `RadioScript` says when a line is due, `Transmissions`
carries it, `Listeners` understand it, `Compliance` lets actors do what they understood, and
`ReadbackPolicy` decides what is said because of that.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial

from airhilt.commands import Command
from airhilt.messages import (
    FROM_MICROPHONE,
    Advisory,
    AgreeToUses,
    LeaveSeat,
    Message,
    PressToTalk,
    ReleaseToTalk,
    SayText,
    SayVoice,
    SeatAct,
    SeatAction,
    Transcript,
    key_chunk,
)
from airhilt.scenario.failures import EffectiveLine
from airhilt.scenario.models import Condition, Radio, RadioLine, Scenario
from airhilt.scenario.roster import callsigns_of, roster_of
from airhilt.seats import Seats
from airhilt.sensors.base import Publish
from airhilt.sensors.radio.advisory_calls import AdvisoryCalls, AdvisoryChannel
from airhilt.sensors.radio.answers import Answers
from airhilt.sensors.radio.backends import RadioBackend
from airhilt.sensors.radio.compliance import Compliance
from airhilt.sensors.radio.confirmation import Confirmations
from airhilt.sensors.radio.frequency_arbiter import GAP_S
from airhilt.sensors.radio.hearing import HearingModel
from airhilt.sensors.radio.listeners import Listeners
from airhilt.sensors.radio.microphones import Microphones
from airhilt.sensors.radio.on_air import OnAir, Utterance
from airhilt.sensors.radio.open_microphone import OpenMicrophone
from airhilt.sensors.radio.person_calls import PersonCalls
from airhilt.sensors.radio.radio_call import RadioCall, calls_of
from airhilt.sensors.radio.readback_policy import ReadbackPolicy
from airhilt.sensors.radio.script import RadioScript
from airhilt.sensors.radio.spoken_calls import SpokenCalls
from airhilt.sensors.radio.stations import Stations
from airhilt.sensors.radio.stuck_microphones import StuckMicrophones
from airhilt.sensors.radio.transmissions import EndedTransmission, Transmissions
from airhilt.sim import Director, Priority
from airhilt.sim.payload import Payload
from airhilt.units import seconds_to_ns
from airhilt.world.actors.listening import Understanding

BLOCKED = "Your call was blocked: somebody else was on the air at the same time."
"""Notice to a person whose call nobody could understand."""


class RadioConversation:
    """Lets the calls of a scenario happen.

    Parameters
    ----------
    ended_lines
        Gets the ids of the calls that have been on the air.
    line_begun
        Called with the id of a call when it begins, also when it is said again.
    once
        Calls its second argument as soon as its first, a condition, is true.
    do
        Lets an actor carry out a command.
    failed
        Called with each line that a failure of the scenario changes, when it is due.
    microphone_stuck
        Called with an actor's callsign and a description of what happens.
    microphones_free
        Called when no microphone is stuck any more.
    advisory_channel
        Channel of the advisories to crews and drivers; None if they are heard in the cockpit.
    hearing
        Draws what people hear; None takes the model of `hearing` with the seed of the run.
    seats
        Seats of people: nobody else speaks or acts there.
    """

    def __init__(
        self,
        director: Director,
        scenario: Scenario,
        lines: Sequence[EffectiveLine],
        stations: Stations,
        backend: RadioBackend,
        seed: int,
        ended_lines: set[str],
        *,
        line_begun: Callable[[str], None],
        once: Callable[[Condition, Callable[[], None]], None],
        publish: Publish,
        do: Callable[[str, Command], None],
        failed: Callable[[EffectiveLine], None],
        microphone_stuck: Callable[[str, str], None],
        microphones_free: Callable[[], None],
        advisory_channel: AdvisoryChannel | None = None,
        hearing: HearingModel | None = None,
        seats: Seats,
    ) -> None:
        radio = scenario.radio
        self._director = director
        self._scenario = scenario
        self._stations = stations
        self._backend = backend
        self._publish = publish
        self._line_begun = line_begun
        self._ended_lines = ended_lines
        self._calls = calls_of(scenario, lines)
        self._on_air: dict[str, RadioCall] = {}
        """Calls on the air or waiting for it, by the id of the transmission."""
        self._said: dict[str, RadioCall] = {}
        """Calls that were made, by the ids of their transmissions."""
        self._times_pressed = 0
        self._seats = seats
        self._person_calls = PersonCalls(seats, stations, self._said, director)
        self._microphones = Microphones(director, self.press, seats)
        self._script = RadioScript(director, lines, once, failed, self._due)
        self._transmissions = self._make_transmissions(scenario)
        self._stuck_microphones = self._make_stuck_microphones(microphone_stuck, microphones_free)
        self._listeners = self._make_listeners(radio, hearing or HearingModel(seed))
        self._compliance = Compliance(director, once, do, self._offer)
        self._policy = ReadbackPolicy(director, radio, stations, seed, self._calls, self._say)
        self._confirmations = self._make_confirmations(radio)
        self._advisories = self._make_advisory_calls(scenario, advisory_channel)
        self._spoken = SpokenCalls(self._person_calls, self._recognised)

    def _make_transmissions(self, scenario: Scenario) -> Transmissions:
        return Transmissions(
            self._director,
            scenario.radio,
            self._stations,
            self._backend,
            self._publish,
            began=self._began,
            ended=self._ended,
            roster=roster_of(scenario),
            seats=[state.seat for state in self._seats],
        )

    def _make_stuck_microphones(
        self, stuck: Callable[[str, str], None], all_free: Callable[[], None]
    ) -> StuckMicrophones:
        return StuckMicrophones(
            self._director,
            self._stations,
            transmit_carrier=self._transmissions.transmit_carrier,
            stuck=stuck,
            all_free=all_free,
        )

    def _make_listeners(self, radio: Radio, hearing: HearingModel) -> Listeners:
        return Listeners(
            self._director,
            radio,
            self._stations,
            hearing,
            reaches=self._transmissions.reaches,
            seats=self._seats,
            publish=self._publish,
            understood=self._understood,
            overheard=self._overheard,
        )

    def _make_confirmations(self, radio: Radio) -> Confirmations:
        return Confirmations(
            self._director,
            self._stations,
            Answers(radio.phraseology),
            self._said,
            readback_of=self._policy.readback_in_script,
            call_again=self._policy.call_again,
            say=self._say,
        )

    def _make_advisory_calls(
        self, scenario: Scenario, channel: AdvisoryChannel | None
    ) -> AdvisoryCalls | None:
        if channel is None:
            return None
        return AdvisoryCalls(
            self._director,
            self._stations,
            callsigns_of(scenario),
            channel,
            say=self._transmissions.say,
            reaches=self._transmissions.reaches,
            publish=self._publish,
        )

    def start(self) -> None:
        """Schedule the lines of the script, and the microphones that get stuck."""
        self._script.start()
        self._stuck_microphones.schedule(self._scenario.failures)

    def take(self, key: str, message: Message, data: Payload) -> None:
        """Give a transcript to the crews that wait for it, and advisories to who is to confirm.

        Advisories that are spoken on a frequency are transmitted.
        """
        if isinstance(message, SeatAction) and (state := self._seats.at(key)) is not None:
            self._act(state.seat, message.act)
        if self._advisories is not None:
            self._advisories.take(message, data)
        if isinstance(message, Transcript):
            self._spoken.take(message)
        if isinstance(message, Advisory):
            self._confirmations.take(message)
        else:
            self._listeners.take(message)

    def press(self, speaker: str, frequency_khz: int) -> OpenMicrophone:
        """Let a person speak: transmit what is fed to the microphone until it is released."""
        self._times_pressed += 1
        name = f"{FROM_MICROPHONE}{key_chunk(speaker)}.{self._times_pressed}"
        utterance = Utterance(name, frequency_khz, speaker, None, "", is_from_microphone=True)
        return self._transmissions.press(utterance)

    def _act(self, speaker: str, act: SeatAct) -> None:
        """Take in what the person at a seat does."""
        match act:
            case SayText():
                self._say(self._person_calls.call(speaker, act))
            case PressToTalk() if not self._stations.is_there(speaker):
                self._seats.cut(speaker, f"{speaker} is not there any more.")
            case PressToTalk(frequency_khz=given_khz):
                frequency_khz = self._person_calls.frequency_khz(speaker, given_khz)
                self._microphones.press(speaker, frequency_khz)
            case SayVoice(pcm=pcm):
                self._microphones.feed(speaker, pcm)
            case ReleaseToTalk():
                self._microphones.release(speaker)
            case AgreeToUses(uses=uses) if "voice" not in uses:
                self._microphones.release(speaker)
            case LeaveSeat():
                self._microphones.release(speaker)
                for call in self._person_calls.leave(speaker):
                    self._say(call)

    def pause(self) -> None:
        """End the calls of people: nobody is on the air while the time stands still."""
        for state in self._seats:
            self._microphones.release(state.seat)

    def close(self) -> None:
        """Publish what is on the air as far as it has come; nobody acts upon it."""
        self._transmissions.close()

    # --- speaking ---------------------------------------------------------------------------

    def _due(self, line: RadioLine) -> None:
        """Say a line once its speaker has taken the calls that it follows from."""
        call = self._calls[line.id]
        for needed in call.needs:
            if needed is None:
                return
            if call.speaker not in needed.taken_by:
                due = partial(self._after_gap, partial(self._due, line))
                needed.once_taken_by(call.speaker, due)
                return
        if self._seats.has_person(call.speaker):
            self._person_calls.tell(call)
            self._compliance.carry_out(call, call.speaker)
        else:
            self._say(call)

    def _offer(self, actor: str, call: str, command: Command) -> bool:
        """Offer the person who acts for an actor a command; return False if there is none."""
        if not self._seats.has_person(actor):
            return False
        self._seats.offer(actor, call, command)
        return True

    def _after_gap(self, action: Callable[[], None]) -> None:
        due_ns = self._director.now_ns + seconds_to_ns(GAP_S)
        self._director.at(due_ns, action, Priority.SCRIPT)

    def _say(self, call: RadioCall) -> None:
        if not self._stations.is_there(call.speaker):
            return
        if self._seats.has_person(call.speaker) and not call.is_of_person:
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
            None if replied_to is None else replied_to.transmission or replied_to.id,
            None if scripted is None else scripted.declared.id,
            listens_first=again > 0 or scripted is None or scripted.listens_first,
        )
        call.transmission = utterance.id
        self._on_air[utterance.id] = self._said[utterance.id] = call
        self._transmissions.say(utterance)

    # --- what comes of it -------------------------------------------------------------------

    def _began(self, said: Utterance) -> None:
        call = self._on_air.get(said.id)
        if call is not None:
            self._line_begun(call.id)

    def _ended(self, ended: EndedTransmission) -> None:
        """Let a transmission that has ended be heard or read, and acted upon."""
        said = ended.on_air.utterance
        call = self._on_air.pop(said.id, None)
        if call is not None:
            self._ended_lines.add(call.id)
            self._listeners.let_read(call, said, is_blocked=ended.is_blocked)
        if ended.transcript is not None:
            self._publish(f"asr/{said.frequency_khz}", ended.transcript)
        if self._advisories is not None:
            self._advisories.ended(ended.on_air)
        if ended.is_blocked and self._seats.has_person(said.speaker):
            self._seats.notify(said.speaker, BLOCKED)
        if said.is_from_microphone:
            self._spoken.ended(ended)
        if call is None:
            return
        if call.is_first_time:
            self._compliance.carry_out(call, call.speaker)
        self._listeners.let_hear(call, ended.on_air)

    def _recognised(self, call: RadioCall, said: Utterance, on_air: OnAir, is_clear: bool) -> None:
        """Let a call that a person spoke be understood, as it was recognised."""
        call.times_said += 1
        call.transmission = said.id
        self._said[said.id] = call
        self._line_begun(call.id)
        self._ended_lines.add(call.id)
        self._listeners.let_understand(call, said, on_air, is_clear=is_clear)

    def _understood(
        self, call: RadioCall, said: Utterance, listener: str, understanding: Understanding
    ) -> None:
        if understanding.kind == "as_said":
            self._compliance.carry_out(call, listener)
        elif understanding.kind == "otherwise" and self._stations.is_actor(listener):
            self._compliance.comply(call, listener, understanding.commands)
        self._policy.follow_up(call, said, listener, understanding)

    def _overheard(
        self,
        call: RadioCall,
        said: Utterance,  # noqa: ARG002
        listener: str,
        understanding: Understanding,
    ) -> None:
        self._compliance.comply(call, listener, understanding.commands)
