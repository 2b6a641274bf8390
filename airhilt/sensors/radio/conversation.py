"""The radio of a run: calls are made, heard, answered, and acted upon.

`RadioConversation` connects the parts. `RadioScript` says when a line is due, `Transmissions`
carries it, `Listeners` understand it, `Compliance` lets actors do what they understood, and
`ReadbackPolicy` decides what is said because of that.
"""

from __future__ import annotations

from functools import partial

from airhilt.messages import (
    Advisory,
    AgreeToUses,
    EquipmentAlert,
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
from airhilt.scenario.models import RadioLine
from airhilt.sensors.radio.advisory_calls import AdvisoryCalls, AdvisoryChannel
from airhilt.sensors.radio.compliance import Compliance
from airhilt.sensors.radio.confirmation import Confirmations
from airhilt.sensors.radio.context import RadioContext
from airhilt.sensors.radio.controllers import Controllers
from airhilt.sensors.radio.frequency_arbiter import GAP_S, FrequencyArbiter
from airhilt.sensors.radio.hearing import HearingModel
from airhilt.sensors.radio.listeners import Listeners
from airhilt.sensors.radio.microphones import Microphones
from airhilt.sensors.radio.on_air import OnAir
from airhilt.sensors.radio.person_calls import PersonCalls, RecognisedCall
from airhilt.sensors.radio.ra_reports import RaReports
from airhilt.sensors.radio.radio_call import RadioCall, Speakers, calls_of
from airhilt.sensors.radio.readback_policy import ReadbackPolicy
from airhilt.sensors.radio.script import RadioScript
from airhilt.sensors.radio.transmissions import Transmissions
from airhilt.sim.payload import Payload

BLOCKED = "Your call was blocked: somebody else was on the air at the same time."
"""Notice to a person whose call nobody could understand."""


class RadioConversation:
    """Lets the calls of a scenario happen.

    Without a channel, advisories to crews and drivers are heard in the cockpit. Without a model of
    hearing, that of `hearing` draws what people hear, with the seed of the run.
    """

    def __init__(
        self,
        context: RadioContext,
        advisory_channel: AdvisoryChannel | None = None,
        hearing: HearingModel | None = None,
    ) -> None:
        self._context = context
        self._stations = context.stations
        self._seats = context.seats
        self._calls = calls_of(context.scenario, context.lines)
        self._transmissions = transmissions = Transmissions(context)
        self._arbiter = arbiter = FrequencyArbiter(
            context.director,
            context.backend.speak,
            context.stations.audible,
            began=self._began,
            ended=self._ended,
        )
        self._speakers = Speakers(context, arbiter)
        self._person_calls = PersonCalls(context, self._speakers.said)
        self._microphones = Microphones(context.director, arbiter, context.seats)
        self._tellings = 0
        """Number of calls about what an actor cannot do any more."""
        self._compliance = Compliance(context, self._speakers)
        self._policy = policy = ReadbackPolicy(context, self._calls, self._speakers)
        hearing = hearing or HearingModel(context.seed)
        self._confirmations = Confirmations(context, self._speakers, policy)
        self._controllers = Controllers(context, self._speakers, policy, self._confirmations)
        self._ra_reports = RaReports(context, self._speakers, self._controllers.contact)
        self._listeners = Listeners(
            context, hearing, transmissions, self._compliance, policy, self._controllers
        )
        self._advisories: AdvisoryCalls | None = None
        if advisory_channel is not None:
            callsigns = context.scenario.callsigns
            self._advisories = AdvisoryCalls(
                context, callsigns, advisory_channel, arbiter, transmissions
            )

    def start(self) -> None:
        """Schedule the lines of the script, and the microphones that get stuck."""
        RadioScript(self._context, self._arbiter, self._due).start()

    def take(self, key: str, message: Message, data: Payload) -> None:
        """Give a transcript to the crews that wait for it, and advisories to who is to confirm.

        Advisories that are spoken on a frequency are transmitted.
        """
        if isinstance(message, SeatAction) and (state := self._seats.at(key)) is not None:
            self._act(state.seat, message.act)
        if self._advisories is not None:
            self._advisories.take(message, data)
        match message:
            case Transcript():
                recognised = self._person_calls.recognised(message)
                if recognised is not None:
                    self._recognised(recognised)
                self._listeners.take(message)
            case Advisory(recipient=recipient) if self._stations.is_actor(recipient):
                self._confirmations.take(message)
            case EquipmentAlert():
                self._ra_reports.take(message)
        self._controllers.take(key, message)

    def _act(self, speaker: str, act: SeatAct) -> None:
        """Take in what the person at a seat does."""
        match act:
            case SayText(frequency_khz=given_khz, text=text):
                frequency_khz = self._person_calls.frequency_khz(speaker, given_khz)
                self._speakers.say(self._person_calls.make(speaker, frequency_khz, text))
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
                    self._speakers.say(call)

    def pause(self) -> None:
        """End the calls of people: nobody is on the air while the time stands still."""
        for state in self._seats:
            self._microphones.release(state.seat)

    def close(self) -> None:
        """Publish what is on the air as far as it has come; nobody acts upon it."""
        for on_air in self._arbiter.close():
            self._transmissions.finish(on_air)

    # --- speaking ---------------------------------------------------------------------------

    def _due(self, line: RadioLine) -> None:
        """Say a line once its speaker has taken the calls that it follows from."""
        call = self._calls[line.id]
        for needed in call.needs:
            if needed is None:
                return
            if call.speaker not in needed.taken_by:
                due = partial(self._due, line)
                after_gap = partial(self._context.director.after, GAP_S, due)
                needed.once_taken_by(call.speaker, after_gap)
                return
        orders = any(scripted.actor != call.speaker for scripted in call.commands)
        if not orders and self._is_open(call.speaker, call.addressed):
            self._context.director.after(GAP_S, partial(self._due, line))
        elif self._seats.has_person(call.speaker):
            self._person_calls.tell(call)
            self._compliance.carry_out(call, call.speaker)
        else:
            self._speakers.say(call)

    def _is_open(self, one: str, other: str | None) -> bool:
        """Return whether one of two waits for the other to repeat or to read back something."""
        return self._policy.has_question(one, other) or self._controllers.awaits_answer(one, other)

    def tell(self, callsign: str, words: str) -> None:
        """Let an actor tell the unit that it is with what it does, or cannot do any more."""
        contact = self._controllers.contact(callsign)
        if contact is not None:
            self._tellings += 1
            name = f"tells.{key_chunk(callsign)}.{self._tellings}"
            text = self._context.answers.to_unit(callsign, contact.unit, words)
            call = RadioCall(name, contact.frequency_khz, callsign, contact.unit, text)
            self._speakers.say_later(call)

    # --- what comes of it -------------------------------------------------------------------

    def _began(self, on_air: OnAir) -> None:
        self._transmissions.open(on_air)
        if self._advisories is not None:
            self._advisories.began(on_air)
        call = self._speakers.on_air.get(on_air.utterance.id)
        if call is not None:
            self._context.world.line_begun(call.id)

    def _ended(self, on_air: OnAir) -> None:
        """Let a transmission that has ended be heard or read, and acted upon."""
        is_blocked, transcript = self._transmissions.finish(on_air)
        said = on_air.utterance
        call = self._speakers.on_air.pop(said.id, None)
        if call is not None:
            self._context.world.ended_lines.add(call.id)
            self._listeners.let_read(call, said, is_blocked=is_blocked)
        if transcript is not None:
            self._context.publish(f"asr/{said.frequency_khz}", transcript)
        if self._advisories is not None:
            self._advisories.ended(on_air)
        if is_blocked and self._seats.has_person(said.speaker):
            self._seats.notify(said.speaker, BLOCKED)
        if said.is_from_microphone and not is_blocked:
            self._person_calls.ended(on_air)
        if call is None:
            return
        if call.times_said == 1:
            self._compliance.carry_out(call, call.speaker)
        self._controllers.ended(call)
        self._listeners.let_hear(call, on_air)

    def _recognised(self, recognised: RecognisedCall) -> None:
        """Let a call that a person spoke be understood, as it was recognised."""
        call, said, on_air, is_clear = recognised
        call.times_said += 1
        call.transmission = said.id
        self._speakers.said[said.id] = call
        self._context.world.line_begun(call.id)
        self._context.world.ended_lines.add(call.id)
        self._listeners.let_understand(call, said, on_air, is_clear=is_clear)
