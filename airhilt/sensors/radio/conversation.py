"""The radio of a run: calls are made, heard, answered, and acted upon.

`RadioConversation` connects the parts. `RadioScript` says when a line is due, `Transmissions`
carries it, `Listeners` understand it, `Compliance` lets actors do what they understood, and
`ReadbackPolicy` decides what is said because of that.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial

from airhilt.messages import (
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
)
from airhilt.scenario.failures import EffectiveLine
from airhilt.scenario.models import RadioLine, Scenario
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
from airhilt.sensors.radio.person_calls import PersonCalls
from airhilt.sensors.radio.radio_call import RadioCall, calls_of
from airhilt.sensors.radio.readback_policy import ReadbackPolicy
from airhilt.sensors.radio.script import RadioScript
from airhilt.sensors.radio.speakers import Speakers
from airhilt.sensors.radio.spoken_calls import SpokenCalls
from airhilt.sensors.radio.stations import Stations
from airhilt.sensors.radio.stuck_microphones import StuckMicrophones
from airhilt.sensors.radio.surroundings import RadioFailures, RadioWorld
from airhilt.sensors.radio.transmissions import EndedTransmission, Transmissions
from airhilt.sim import Director, Priority
from airhilt.sim.payload import Payload
from airhilt.units import seconds_to_ns

BLOCKED = "Your call was blocked: somebody else was on the air at the same time."
"""Notice to a person whose call nobody could understand."""


class RadioConversation:
    """Lets the calls of a scenario happen.

    Parameters
    ----------
    failures
        Gets what the failures of the scenario do to the radio.
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
        world: RadioWorld,
        failures: RadioFailures,
        publish: Publish,
        seats: Seats,
        advisory_channel: AdvisoryChannel | None = None,
        hearing: HearingModel | None = None,
    ) -> None:
        radio = scenario.radio
        self._director = director
        self._scenario = scenario
        self._lines = lines
        self._stations = stations
        self._world = world
        self._failures = failures
        self._publish = publish
        self._seats = seats
        self._calls = calls_of(scenario, lines)
        self._transmissions = self._make_transmissions(backend)
        self._speakers = Speakers(self._transmissions, stations, seats)
        self._person_calls = PersonCalls(seats, stations, self._speakers.said, director)
        self._spoken = SpokenCalls(self._person_calls)
        self._microphones = Microphones(director, self._transmissions, seats)
        self._compliance = Compliance(director, world, seats)
        policy = ReadbackPolicy(director, radio, stations, seed, self._calls, self._speakers)
        self._listeners = self._make_listeners(hearing or HearingModel(seed), policy)
        self._confirmations = Confirmations(
            director, stations, Answers(radio.phraseology), self._speakers, policy
        )
        self._advisories: AdvisoryCalls | None = None
        if advisory_channel is not None:
            callsigns = scenario.callsigns
            self._advisories = AdvisoryCalls(
                director, stations, callsigns, advisory_channel, self._transmissions, publish
            )

    def _make_transmissions(self, backend: RadioBackend) -> Transmissions:
        return Transmissions(
            self._director,
            self._scenario.radio,
            self._stations,
            backend,
            self._publish,
            began=self._began,
            ended=self._ended,
            roster=self._scenario.roster,
            seats=[state.seat for state in self._seats],
        )

    def _make_listeners(self, hearing: HearingModel, policy: ReadbackPolicy) -> Listeners:
        return Listeners(
            self._director,
            self._scenario.radio,
            self._stations,
            hearing,
            self._transmissions,
            self._seats,
            self._publish,
            self._compliance,
            policy,
        )

    def start(self) -> None:
        """Schedule the lines of the script, and the microphones that get stuck."""
        RadioScript(self._director, self._lines, self._world, self._failures, self._due).start()
        StuckMicrophones(
            self._director, self._stations, self._transmissions, self._failures
        ).schedule(self._scenario.failures)

    def take(self, key: str, message: Message, data: Payload) -> None:
        """Give a transcript to the crews that wait for it, and advisories to who is to confirm.

        Advisories that are spoken on a frequency are transmitted.
        """
        if isinstance(message, SeatAction) and (state := self._seats.at(key)) is not None:
            self._act(state.seat, message.act)
        if self._advisories is not None:
            self._advisories.take(message, data)
        if isinstance(message, Transcript):
            recognised = self._spoken.recognised(message)
            if recognised is not None:
                self._recognised(*recognised)
        if isinstance(message, Advisory):
            self._confirmations.take(message)
        else:
            self._listeners.take(message)

    def _act(self, speaker: str, act: SeatAct) -> None:
        """Take in what the person at a seat does."""
        match act:
            case SayText():
                self._speakers.say(self._person_calls.call(speaker, act))
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
            self._speakers.say(call)

    def _after_gap(self, action: Callable[[], None]) -> None:
        due_ns = self._director.now_ns + seconds_to_ns(GAP_S)
        self._director.at(due_ns, action, Priority.SCRIPT)

    # --- what comes of it -------------------------------------------------------------------

    def _began(self, said: Utterance) -> None:
        call = self._speakers.on_air.get(said.id)
        if call is not None:
            self._world.line_begun(call.id)

    def _ended(self, ended: EndedTransmission) -> None:
        """Let a transmission that has ended be heard or read, and acted upon."""
        said = ended.on_air.utterance
        call = self._speakers.on_air.pop(said.id, None)
        if call is not None:
            self._world.ended_lines.add(call.id)
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
        self._speakers.said[said.id] = call
        self._world.line_begun(call.id)
        self._world.ended_lines.add(call.id)
        self._listeners.let_understand(call, said, on_air, is_clear=is_clear)
