"""The simulated controllers of a run: what each attends to, and the calls that it makes."""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial

from airhilt.messages import (
    CONTROLLER,
    Advisory,
    Confirm,
    EquipmentAlert,
    Event,
    EventKind,
    LeaveSeat,
    Message,
    SeatAction,
    key_chunk,
)
from airhilt.phraseology import Instruction
from airhilt.scenario.conversation import controlling_units
from airhilt.scenario.models import Alerting, Controller
from airhilt.sensors.radio.confirmation import Confirmations
from airhilt.sensors.radio.context import RadioContext
from airhilt.sensors.radio.controllers.arrivals import Arrivals
from airhilt.sensors.radio.controllers.calls import ControllerCalls
from airhilt.sensors.radio.controllers.displays import Displays
from airhilt.sensors.radio.controllers.measures import Judgement, Measure, Repetition
from airhilt.sensors.radio.controllers.positions import Alert, Position
from airhilt.sensors.radio.controllers.strips import ANSWERS_WITHIN_S, Contact, Given, Strips
from airhilt.sensors.radio.radio_call import HeardCall, RadioCall, Speakers
from airhilt.sensors.radio.readback_policy import ReadbackPolicy
from airhilt.sim.streams import stream
from airhilt.units import SECOND_NS
from airhilt.world.actors.reactions import FOLLOWED_FROM, controller_reactions

ACTS_WITHIN_S = 10.0
"""Time in s that a controller gives somebody to do what it was told: an assumption."""


class Controllers:
    """Lets each unit without a person do what a controller would do about advisories.

    The controllers get the advisories to the controller, and the conflict alert of the world. After
    a reaction time each speaks to those that it works, one call at a time, the most urgent first.
    What was said is not repeated while nothing new is to be said; a call that nobody answers is
    made again like every other. Nobody who has reported a TCAS RA is told anything before it is
    clear of conflict (ICAO Doc 4444, 15.7.3.2).
    """

    def __init__(
        self,
        context: RadioContext,
        speakers: Speakers,
        policy: ReadbackPolicy,
        confirmations: Confirmations,
    ) -> None:
        self._context = context
        self._director = context.director
        self._stations = context.stations
        self._seats = context.seats
        self._speakers = speakers
        self._policy = policy
        self._confirmations = confirmations
        self._displays = Displays(context.director)
        self._strips = Strips(context.stations, context.director)
        self._judgement = Judgement(self._displays, self._strips, speakers.said)
        self._calls = ControllerCalls(context, speakers, self._displays, self._strips)
        self._arrivals = Arrivals(context, self._calls, self._displays, self._strips)
        declared = context.scenario.controllers
        self._positions = {
            unit: Position(
                unit, each, controller_reactions(context.scenario, unit, each, context.seed)
            )
            for unit in controlling_units(context.scenario)
            for each in [declared.get(unit, Controller())]
        }
        self._shown: dict[str, Alert] = {}
        """The last revision of each advisory to the controller that is not over, by id."""

    # --- what controllers perceive ----------------------------------------------------------

    def take(self, key: str, message: Message) -> None:
        """Take in a message of the bus: an advisory, an alert, or what the displays show."""
        match message:
            case Advisory(recipient=recipient) if recipient == CONTROLLER:
                self._advised(message, message.kind)
            case EquipmentAlert(equipment=equipment, advisory=advisory) if (
                advisory.recipient == CONTROLLER and equipment == "conflict_alert"
            ):
                self._advised(advisory, "conflict_alert")
            case SeatAction(act=LeaveSeat()):
                self._person_left(key.split("/")[1])
            case _:
                self._displays.take(message)

    def ended(self, call: RadioCall) -> None:
        """Take in that a call has been on the air: the strips of its unit have it."""
        if self._stations.is_actor(call.speaker):
            self._strips.answered(call)
            return
        self._strips.said(call)
        position = self._positions.get(call.speaker)
        if position is not None and position.speaking is call:
            position.speaking = None
            self._speak(position)

    def heard(self, heard: HeardCall) -> None:
        """Take in a call of an actor as a unit has heard it."""
        call = heard.call
        if not self._stations.is_actor(call.speaker):
            return
        self._strips.heard(heard)
        position = self._positions.get(heard.listener)
        if position is None:
            return
        self._arrivals.heard(heard, position)
        if self._strips.misread(position.unit) is not None:
            self._speak(position)

    def check(self, heard: HeardCall) -> None:
        """Correct a readback that a unit has taken, where the units of the scenario check all."""
        if not self._context.radio.controller_checks_readbacks:
            return
        if heard.listener != heard.call.addressed:
            return
        correction = self._calls.correction(heard)
        if correction is not None and correction is heard.call.in_reply_to:
            self._policy.call_again(correction)
        elif correction is not None:
            self._strips.corrects(correction)
            self._speakers.say_later(correction)

    def awaits_answer(self, one: str, other: str | None) -> bool:
        """Return whether one of two is a unit that waits for the answer to a correction."""
        unit, actor = (other, one) if self._stations.is_actor(one) else (one, other)
        if unit is None or actor is None or self._seats.has_person(unit):
            return False
        return self._strips.awaits_answer(unit, actor)

    def contact(self, callsign: str) -> Contact | None:
        """Return the unit that works an actor, and on which frequency; None if there is none."""
        return self._strips.contact(callsign)

    # --- reacting ---------------------------------------------------------------------------

    def _advised(self, advisory: Advisory, kind: Alerting) -> None:
        """Show an advisory to the controllers, who turn to it after their reaction times."""
        if not advisory.active:
            self._over(advisory)
            return
        asks = isinstance(advisory.recommendation, Confirm)
        if asks or advisory.severity.rank >= FOLLOWED_FROM.rank:
            self._shown[advisory.id] = alert = Alert(kind, advisory)
            for position in self._positions.values():
                self._react(position, alert)

    def _over(self, advisory: Advisory) -> None:
        """Forget a conflict that is over: if it comes back, everything is said anew."""
        self._shown.pop(advisory.id, None)
        self._judgement.forget(advisory.id)
        traffic = frozenset(advisory.traffic)
        if all(set(each.advisory.traffic) != traffic for each in self._shown.values()):
            for position in self._positions.values():
                position.forget(traffic)

    def _react(self, position: Position, alert: Alert) -> None:
        advisory = alert.advisory
        if not self._concerns(position, alert):
            return
        response = position.reactions.respond(
            "assistant",
            advisory.id,
            revision=advisory.revision,
            is_repeated=advisory.id in position.attended,
        )
        if not response.follows:
            self._silent(position, advisory, "does not respond")
            return
        self._director.after(response.delay_s, partial(self._look, position, advisory.id))

    def _look(self, position: Position, identity: str) -> None:
        """Look at all that is shown, because of one advisory, unless that is over."""
        if identity not in self._shown or self._seats.has_person(position.unit):
            return
        for alert in self._shown.values():
            if self._concerns(position, alert) and self._heeds(position, alert.advisory):
                position.attended.add(alert.advisory.id)
        self._speak(position)

    def _concerns(self, position: Position, alert: Alert) -> bool:
        return alert.kind in position.controller.acts_on and any(
            self._works(position, callsign) for callsign in alert.advisory.traffic
        )

    def _heeds(self, position: Position, advisory: Advisory) -> bool:
        """Return whether a controller acts on an advisory that it has seen."""
        if not position.reactions.respond("assistant", advisory.id).follows:
            return False
        if self._ignores(position, advisory.id) and self._judgement.is_contradicted(advisory):
            self._silent(position, advisory, "the displays contradict it")
            return False
        return True

    def _ignores(self, position: Position, identity: str) -> bool:
        draw = stream(self._context.seed, f"contradicted/{position.unit}/{identity}").random()
        return bool(draw < position.controller.ignores_contradicted)

    def _works(self, position: Position, callsign: str) -> bool:
        """Return whether a unit works an actor; what nobody works concerns the first unit."""
        contact = self._strips.contact(callsign)
        if contact is None:
            return position is next(iter(self._positions.values()))
        return contact.unit == position.unit

    def _person_left(self, seat: str) -> None:
        """Let a controller turn to the advisories in force when its person has left."""
        for position in self._positions.values():
            if key_chunk(position.unit) == seat:
                for alert in list(self._shown.values()):
                    self._react(position, alert)

    # --- speaking ---------------------------------------------------------------------------

    def _speak(self, position: Position) -> None:
        """Make the most urgent call that is still to be made, if the controller is not speaking."""
        if position.speaking is not None or self._seats.has_person(position.unit):
            return
        misread = self._strips.misread(position.unit)
        if misread is not None:
            self._correct(position, misread)
            return
        for alert in sorted(self._shown.values(), key=lambda each: each.urgency):
            call = None
            if alert.advisory.id in position.attended:
                call = next(self._calls_about(position, alert.advisory), None)
            if call is not None:
                self._calls.say(position, call)
                return

    def _correct(self, position: Position, misread: Given) -> None:
        """Say an own call again that was read back wrongly."""
        callsign = misread.call.addressed or ""
        contact = Contact(position.unit, misread.call.frequency_khz)
        repetition = Repetition(callsign, misread.call, is_correction=True)
        call = self._calls.call(self._name(position), repetition, contact)
        self._strips.corrects(call)
        self._event("controller_reacts", position.unit, f"{callsign}: corrects a readback")
        self._calls.say(position, call)

    def _name(self, position: Position) -> str:
        position.calls += 1
        return f"controller.{key_chunk(position.unit)}.{position.calls}"

    def _calls_about(self, position: Position, advisory: Advisory) -> Iterator[RadioCall]:
        """Yield the calls that are still to be made because of an advisory."""
        if isinstance(advisory.recommendation, Confirm):
            if not self._is_settled(advisory, advisory.recommendation.callsign):
                call = self._confirmations.confirmation(advisory, position.unit)
                if call is not None:
                    yield call
            return
        for measure in self._judgement.measures(advisory):
            call = self._call_of(position, advisory, measure)
            if call is not None:
                yield call

    def _call_of(
        self, position: Position, advisory: Advisory, measure: Measure | Repetition
    ) -> RadioCall | None:
        """Return the call of a measure; None if it was made, or cannot be made by this unit."""
        callsign = measure.callsign
        contact = self._strips.contact(callsign)
        if contact is None:
            if position is next(iter(self._positions.values())):
                self._silent(position, advisory, f"no unit can call {callsign}")
            return None
        if contact.unit != position.unit or not self._stations.is_there(callsign):
            return None
        if self._strips.of(callsign).follows_ra:
            self._silent(position, advisory, f"{callsign} follows a TCAS RA")
            return None
        instructions = self._calls.instructions(measure, contact)
        actions = tuple(each.action for each in instructions)
        told = (frozenset(advisory.traffic), callsign, actions)
        if not position.has_news(told, instructions):
            return None
        is_told = self._is_told(callsign, measure, instructions)
        if is_told is None:
            self._director.after(ANSWERS_WITHIN_S, partial(self._speak, position))
            return None
        position.said[told] = instructions
        if is_told:
            return None
        does = ", ".join(action.replace("_", " ") for action in actions)
        self._event("controller_reacts", position.unit, f"{callsign}: {does} ({advisory.id})")
        call = self._calls.call(self._name(position), measure, contact)
        if isinstance(measure, Repetition):
            self._strips.corrects(call)
        return call

    def _is_settled(self, advisory: Advisory, callsign: str) -> bool:
        """Return whether a call need not be confirmed now.

        Something is more urgent, or the controller has heard it read back as it was, or has given
        other instructions since.
        """
        if any(each.advisory.severity.rank >= FOLLOWED_FROM.rank for each in self._shown.values()):
            return True
        strip, said = self._strips.of(callsign), self._speakers.said
        calls = [said[name] for name in advisory.evidence.radio_ids if name in said]
        answered = [call.in_reply_to for call in calls if call.in_reply_to is not None]
        told = [strip.instructions.get(call.first) for call in (*calls, *answered)]
        if any(each is not None and each.is_read_back for each in told):
            return True
        given = [each for each in told[: len(calls)] if each is not None]
        return bool(given) and all(each is not strip.last for each in given)

    def _is_told(
        self, callsign: str, measure: Measure | Repetition, instructions: tuple[Instruction, ...]
    ) -> bool | None:
        """Return whether somebody was told the same a moment ago, or what replaces a repetition.

        None: it was told, and the answer is still to come.
        """
        last = self._strips.of(callsign).last
        if last is None:
            return False
        since_s = (self._director.now_ns - last.told_ns) / SECOND_NS
        if since_s > ACTS_WITHIN_S:
            return False
        if isinstance(measure, Repetition):
            if last.call is not measure.call:
                return True
            if last.call.gives_again is None:
                return False
        meant = self._stations.listener(last.call.frequency_khz).parse(last.call.said).instructions
        if not {each.action for each in instructions} <= {each.action for each in meant}:
            return False
        if last.is_read_back:
            return True
        return None if since_s < ANSWERS_WITHIN_S else False

    # --- what is told -----------------------------------------------------------------------

    def _silent(self, position: Position, advisory: Advisory, why: str) -> None:
        if (advisory.id, why) not in position.silences:
            position.silences.add((advisory.id, why))
            self._event("controller_silent", position.unit, f"{why} ({advisory.id})")

    def _event(self, kind: EventKind, subject: str, text: str) -> None:
        event = Event(t_ns=self._director.now_ns, kind=kind, subject=subject, text=text)
        self._context.publish("truth/event", event)
