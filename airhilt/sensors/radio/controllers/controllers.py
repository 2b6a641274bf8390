"""The simulated controllers of a run: what each attends to, and the calls that it makes."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
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
from airhilt.scenario.conversation import needed_lines
from airhilt.scenario.models import Controller, ScriptedCommand
from airhilt.sensors.radio.answers import Answers
from airhilt.sensors.radio.compliance import COMPLY_AFTER_S
from airhilt.sensors.radio.confirmation import Confirmations
from airhilt.sensors.radio.context import RadioContext
from airhilt.sensors.radio.controllers.displays import Displays
from airhilt.sensors.radio.controllers.measures import Judgement, Measure, Repetition
from airhilt.sensors.radio.controllers.strips import Strips
from airhilt.sensors.radio.controllers.wording import Wording
from airhilt.sensors.radio.radio_call import RadioCall, Speakers
from airhilt.sim.streams import stream
from airhilt.world.actors.reactions import FOLLOWED_FROM, ReactionModel

CONFLICT_ALERT = "conflict_alert"


@dataclass(slots=True)
class Position:
    """A controller's working position at one unit."""

    unit: str
    controller: Controller
    reactions: ReactionModel
    attended: dict[str, Advisory] = field(default_factory=dict)
    """Advisories to which the controller has turned, and which are not over, by id."""
    answered: set[tuple[str, str, tuple[Instruction, ...]]] = field(default_factory=set)
    """What was said: id of the advisory, callsign and instructions."""
    told: set[tuple[str, str]] = field(default_factory=set)
    """Causes of silence that are in the log, with the ids of the advisories."""
    speaking: RadioCall | None = None
    """Call on the air, or waiting for the frequency."""
    calls: int = 0


class Controllers:
    """Lets each unit without a person do what a controller would do about advisories.

    The controllers get the advisories to the controller, and the conflict alert of the world. After
    a reaction time each speaks to those that it works, one call at a time, the most urgent first.
    What was said is not repeated while nothing new is to be said; a call that nobody answers is
    made again like every other. Nobody who has reported a TCAS RA is told anything before it is
    clear of conflict (ICAO Doc 4444, 15.7.3.2).
    """

    def __init__(
        self, context: RadioContext, speakers: Speakers, confirmations: Confirmations
    ) -> None:
        self._context = context
        self._director = context.director
        self._stations = context.stations
        self._seats = context.seats
        self._speakers = speakers
        self._confirmations = confirmations
        self._answers = Answers(context)
        self._displays = Displays()
        self._strips = Strips(context.stations)
        self._judgement = Judgement(self._displays, self._strips, speakers.said)
        radio = context.radio
        self._wording = Wording(self._displays, radio.phraseology, context.stations.variation_deg)
        self._positions = {
            unit: Position(unit, each, ReactionModel(unit, each, context.seed))
            for unit, each in controllers_of(context).items()
        }
        self._answered = needed_lines(context.scenario)
        self._latest: dict[str, Advisory] = {}
        """The last revision of each advisory to the controller that is not over, by id."""

    # --- what controllers perceive ----------------------------------------------------------

    def take(self, key: str, message: Message) -> None:
        """Take in a message of the bus: an advisory, an alert, or what the displays show."""
        match message:
            case Advisory(recipient=recipient) if recipient == CONTROLLER:
                self._advised(message, message.kind)
            case EquipmentAlert(equipment=equipment, advisory=advisory) if (
                advisory.recipient == CONTROLLER and equipment == CONFLICT_ALERT
            ):
                self._advised(advisory, CONFLICT_ALERT)
            case SeatAction(act=LeaveSeat()):
                self._person_left(key.split("/")[1])
            case _:
                self._displays.take(message)

    def ended(self, call: RadioCall) -> None:
        """Take in that a call has been on the air: the strips of its unit have it."""
        if self._stations.is_actor(call.speaker):
            return
        self._strips.said(call)
        position = self._positions.get(call.speaker)
        if position is not None and position.speaking is call:
            position.speaking = None
            self._speak(position)

    def heard(self, call: RadioCall, unit: str, text: str) -> None:
        """Take in a call of an actor as a unit has heard it."""
        if self._stations.is_actor(call.speaker):
            self._strips.heard(call, unit, text)

    # --- reacting ---------------------------------------------------------------------------

    def _advised(self, advisory: Advisory, kind: str) -> None:
        """Let the controllers turn to an advisory, each after its reaction time."""
        if not advisory.active:
            self._latest.pop(advisory.id, None)
            for position in self._positions.values():
                position.attended.pop(advisory.id, None)
            return
        asks = isinstance(advisory.recommendation, Confirm)
        if not asks and advisory.severity.rank < FOLLOWED_FROM.rank:
            return
        self._latest[advisory.id] = advisory
        for position in self._positions.values():
            if kind in position.controller.acts_on:
                self._react(position, advisory)

    def _react(self, position: Position, advisory: Advisory) -> None:
        if not any(self._works(position, callsign) for callsign in advisory.traffic):
            return
        if not position.reactions.complies(advisory.id):
            self._silent(position, advisory, "does not respond to it")
            return
        again = advisory.id in position.attended
        delay_s = position.reactions.delay_s(advisory, again)
        self._director.after(delay_s, partial(self._attend, position, advisory.id))

    def _attend(self, position: Position, identity: str) -> None:
        """Turn to an advisory as it is now, unless it is over."""
        advisory = self._latest.get(identity)
        if advisory is None or self._seats.has_person(position.unit):
            return
        now_ns = self._director.now_ns
        if self._judgement.is_contradicted(advisory, now_ns) and self._ignores(position, identity):
            self._silent(position, advisory, "its displays contradict it")
            return
        position.attended[identity] = advisory
        if isinstance(advisory.recommendation, Confirm):
            self._confirmations.confirm(advisory, position.unit)
        self._speak(position)

    def _ignores(self, position: Position, identity: str) -> bool:
        draw = stream(self._context.seed, f"contradicted/{position.unit}/{identity}").random()
        return bool(draw < position.controller.ignores_contradicted)

    def _works(self, position: Position, callsign: str) -> bool:
        """Return whether a unit works an actor; what nobody works concerns the first unit."""
        contact = self._strips.contact(callsign) if self._stations.is_actor(callsign) else None
        if contact is None:
            return position is next(iter(self._positions.values()))
        return contact.unit == position.unit

    def _person_left(self, seat: str) -> None:
        """Let a controller turn to the advisories in force when its person has left."""
        for position in self._positions.values():
            if key_chunk(position.unit) == seat:
                for advisory in list(self._latest.values()):
                    self._react(position, advisory)

    # --- speaking ---------------------------------------------------------------------------

    def _speak(self, position: Position) -> None:
        """Make the most urgent call that is still to be made, if the controller is not speaking."""
        if position.speaking is not None or self._seats.has_person(position.unit):
            return
        for advisory in sorted(position.attended.values(), key=_urgency):
            for measure in self._judgement.measures(advisory, self._director.now_ns):
                call = self._call(position, advisory, measure)
                if call is not None:
                    position.speaking = call
                    self._speakers.say(call)
                    return

    def _call(
        self, position: Position, advisory: Advisory, measure: Measure | Repetition
    ) -> RadioCall | None:
        """Return the call of a measure; None if it was made, or cannot be made by this unit."""
        callsign = measure.callsign
        contact = self._strips.contact(callsign) if self._stations.is_actor(callsign) else None
        if contact is None:
            if position is next(iter(self._positions.values())):
                self._silent(position, advisory, f"no unit can call {callsign}")
            return None
        if contact.unit != position.unit or not self._stations.is_there(callsign):
            return None
        if self._strips.of(callsign).follows_ra:
            self._silent(position, advisory, f"{callsign} follows a TCAS RA")
            return None
        listener = self._stations.listener(contact.frequency_khz)
        if isinstance(measure, Repetition):
            instructions = listener.parse(measure.call.said).instructions
            text = self._answers.negative(callsign, position.unit, measure.call.said)
        else:
            now_ns = self._director.now_ns
            instructions = self._wording.instructions(measure, now_ns)
            text = self._wording.text(measure, instructions, now_ns)
        said = (advisory.id, callsign, instructions)
        if not instructions or said in position.answered:
            return None
        position.answered.add(said)
        position.calls += 1
        call = RadioCall(
            f"controller.{key_chunk(position.unit)}.{position.calls}",
            contact.frequency_khz,
            position.unit,
            callsign,
            text,
            tuple(self._commands(callsign, measure, contact.frequency_khz, instructions)),
        )
        call.once_taken_by(callsign, partial(self._supersede, callsign, call))
        self._event("controller_reacts", position.unit, f"{callsign}: {_named(instructions)} "
                    f"({advisory.id})")  # fmt: skip
        return call

    def _commands(
        self,
        callsign: str,
        measure: Measure | Repetition,
        frequency_khz: int,
        instructions: tuple[Instruction, ...],
    ) -> Iterator[ScriptedCommand]:
        """Yield what the words of a call make its addressee do.

        Words of the script that are said again do what the script has for them.
        """
        if isinstance(measure, Repetition):
            planned = [one for one in self._planned(measure.call) if one.actor == callsign]
            if planned:
                yield from planned
                return
        listener = self._stations.listener(frequency_khz)
        runway = self._stations.bound_runway(callsign)
        for order in listener.orders_of(instructions, runway):
            if order.command is not None:
                yield ScriptedCommand(actor=callsign, command=order.command, delay_s=COMPLY_AFTER_S)

    def _planned(self, call: RadioCall) -> tuple[ScriptedCommand, ...]:
        """Return the commands of a scripted instruction and of its readback, without failures."""
        if call.scripted is None:
            return call.commands
        answers = [
            line.declared.commands
            for line in self._context.lines
            if call.addressed == line.declared.speaker
            and call.id in self._answered[line.declared.id]
        ]
        return sum(answers, call.scripted.declared.commands)

    def _supersede(self, callsign: str, call: RadioCall) -> None:
        """Let an actor leave undone what calls before have told it and it has not done yet."""
        for other in self._speakers.said.values():
            if other is not call and callsign in (other.speaker, other.addressed):
                other.withdrawn_for.add(callsign)

    # --- what is told -----------------------------------------------------------------------

    def _silent(self, position: Position, advisory: Advisory, why: str) -> None:
        if (advisory.id, why) not in position.told:
            position.told.add((advisory.id, why))
            self._event("controller_silent", position.unit, f"{why} ({advisory.id})")

    def _event(self, kind: EventKind, subject: str, text: str) -> None:
        event = Event(t_ns=self._director.now_ns, kind=kind, subject=subject, text=text)
        self._context.publish("truth/event", event)


def controllers_of(context: RadioContext) -> Mapping[str, Controller]:
    """Return the controller of each unit, the one that listens first."""
    radio, is_actor = context.radio, context.stations.is_actor
    lines = [line.declared for line in context.lines]
    named = [radio.controller, *(line.speaker for line in lines), *(line.to for line in lines)]
    units = [name for name in dict.fromkeys(named) if name is not None and not is_actor(name)]
    declared = context.scenario.controllers
    return {unit: declared.get(unit, Controller()) for unit in units}


def _urgency(advisory: Advisory) -> tuple[int, float]:
    """Return a key that is the least for the most urgent advisory."""
    evidence = advisory.evidence
    times = (evidence.time_to_go_s, evidence.time_to_loss_s)
    return -advisory.severity.rank, min((time for time in times if time is not None), default=1e9)


def _named(instructions: tuple[Instruction, ...]) -> str:
    return ", ".join(each.action.replace("_", " ") for each in instructions)
