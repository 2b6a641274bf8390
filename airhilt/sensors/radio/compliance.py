"""Compliance: what actors decide to do of a call that they have taken, and do in time.

An ordinary instruction is obeyed unless it cannot be. Whether and when an urgent one is, one that a
controller gives because of an advisory, is drawn from the response model.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from functools import partial
from typing import NamedTuple

from airhilt.commands import (
    CancelTakeoffCommand,
    Command,
    ContactCommand,
    GoAroundCommand,
    HoldPositionCommand,
    HoldShortCommand,
    ReportCommand,
    TakeOffCommand,
)
from airhilt.messages import Event
from airhilt.phraseology import Call, Instruction
from airhilt.phraseology.call import OTHERWISE, STOPS, Action, Question
from airhilt.phraseology.spoken_actions import with_digits
from airhilt.scenario.models import Condition, ScriptedCommand
from airhilt.sensors.radio.context import RadioContext
from airhilt.sensors.radio.radio_call import HeardCall, RadioCall, Speakers
from airhilt.sensors.radio.stations import SAY_FREQUENCY
from airhilt.world.actors.air_phases import VERTICAL
from airhilt.world.actors.orders import TO_A_RUNWAY, Order, Subject, orders_of, subject_of
from airhilt.world.actors.reactions import reaction_models

COMPLY_AFTER_S = 2.0
"""Time in s from taking a call to doing what was understood, where that is not what was said. The
same as the default of scripted commands."""
REPORTS_AFTER_S = 1.0
"""Time in s from an event to the report of it: an assumption."""
TUNING_S = 4.0
"""Time in s from leaving a frequency to the first call on the next one: an assumption."""
SAME_LEVEL_FT = 200.0
"""Difference in ft up to which a level is that at which an aircraft flies (AIM 4-5-2)."""
STOPPING = (HoldPositionCommand, HoldShortCommand, CancelTakeoffCommand)
"""Commands on the ground that are done whatever else the call says."""
FORESEEN_S = 5.0
"""Time in s for which a crew foresees if it can do what the script has for it: an assumption."""


class Decision(NamedTuple):
    """Decision of an actor about a call that it has taken."""

    commands: tuple[ScriptedCommand, ...] = ()
    """Commands that it carries out."""
    accepted: tuple[Instruction | str, ...] = ()
    """Instructions that it reads back, and words that answer questions."""
    unable: tuple[str, ...] = ()
    """Words about the rest: why it cannot do it, or what it asks before it can."""


@dataclass
class _Answer:
    """Answer of an actor to the orders of a call, as far as it has gone through them."""

    commands: dict[Command, Condition | None] = field(default_factory=dict)
    accepted: list[Order] = field(default_factory=list)
    unable: list[str] = field(default_factory=list)
    undone: dict[Command, str] = field(default_factory=dict)
    """Why commands are not done."""
    stops: bool = False
    """True if it stops at once, and so does not move for the same call."""
    refused: dict[Subject, str | None] = field(default_factory=dict)
    """Why the last order now about each subject cannot be done; None if it can."""


class Compliance:
    """Lets actors do what calls make them do.

    A later call about the same subject replaces what an actor has not done yet of earlier ones.
    """

    def __init__(self, context: RadioContext, speakers: Speakers) -> None:
        self._context = context
        self._speakers = speakers
        self._director = context.director
        self._world = context.world
        self._seats = context.seats
        self._stations = context.stations
        self._reactions = reaction_models(context.scenario, context.seed)
        self._undone: set[tuple[str, str]] = set()
        """Calls, and actors, of which was told that there is no response."""
        self._obeyed: dict[str, list[RadioCall]] = {}
        """Calls of which actors have decided to do something, by actor."""

    # --- deciding ---------------------------------------------------------------------------

    def take(self, heard: HeardCall) -> Decision:
        """Let an actor decide what it does of a call as it has taken it, and do that.

        What the script plans for its words is done; of other words, what they order. After
        "disregard", nothing is done that was told before.
        """
        call, actor, taken = heard.call, heard.listener, heard.understanding.call
        if taken.disregards:
            for one in self._obeyed.get(actor, ()):
                one.in_force[actor] = ()
        planned = tuple(one for one in call.meant if one.actor == actor)
        is_scripted = planned or (call.scripted is not None and not call.is_of_person)
        if heard.understanding.kind == "as_said" and is_scripted:
            decision = self._planned(planned, taken, actor)
        else:
            decision = self._ordered(call, taken, actor)
        self.comply(call, actor, decision.commands)
        return decision

    def _planned(self, planned: tuple[ScriptedCommand, ...], taken: Call, actor: str) -> Decision:
        soon = (one for one in planned if one.when is None and one.delay_s <= FORESEEN_S)
        first = next(soon, None)
        why = None if first is None else self._refusal(actor, first.command)
        if why is not None:
            return self._told(actor, Decision(unable=(why,)))
        return Decision(planned, (*taken.instructions, *self._answered(taken, actor)))

    def _ordered(self, call: RadioCall, taken: Call, actor: str) -> Decision:
        """Return the decision about what the words of a call order.

        It is made in the order in which the actor does things, and read back in that of the call.
        """
        listener = self._stations.listener(call.frequency_khz)
        orders = listener.orders_of(taken.instructions, self._stations.bound_runway(actor), actor)
        orders = tuple(self._possible(actor, orders))
        stops = [each for each in orders if isinstance(each.command, HoldPositionCommand)]
        answer = _Answer(stops=any(self._stops(actor, each) for each in stops))
        for order in sorted(orders, key=lambda each: (each.rank, each.part_of is not None)):
            if order.part_of is None:
                self._answer_order(actor, order, answer)
            elif any(order.part_of is each.instruction for each in answer.accepted):
                answer.accepted.append(order)
            elif order.alone is not None:
                self._answer_order(actor, replace(order, command=order.alone), answer)
        scripted = tuple(
            ScriptedCommand(actor=actor, command=command, delay_s=COMPLY_AFTER_S, when=when)
            for command, when in answer.commands.items()
        )
        accepted = {id(each.instruction) for each in answer.accepted}
        read_back: list[Instruction | str] = [
            each.instruction for each in orders if id(each.instruction) in accepted
        ]
        read_back += self._answered(taken, actor)
        decision = Decision(scripted, tuple(read_back), tuple(dict.fromkeys(answer.unable)))
        return self._told(actor, decision)

    def _answer_order(self, actor: str, order: Order, answer: _Answer) -> None:
        """Add what an actor does of an order of its call, or why it does nothing of it."""
        if order.after in answer.undone and isinstance(order.command, TO_A_RUNWAY):
            order = replace(order, when=None)  # It does not wait for what is not done.
        why = order.unable or order.question or self._contradicts(actor, order.instruction)
        if why is None and order.command is not None:
            why = self._why_refused(actor, order, answer)
            if order.when is None and not isinstance(order.command, STOPPING):
                answer.refused[subject_of(order.command)] = why
        if why is not None:
            answer.unable.append(why)
            if order.command is not None:
                answer.undone[order.command] = why
            return
        answer.accepted.append(order)
        if order.command is not None and not self._keeps(actor, order.instruction):
            answer.commands[order.command] = order.when

    def _why_refused(self, actor: str, order: Order, answer: _Answer) -> str | None:
        """Return why an actor does not do an order; None if it does.

        Who goes around is not where it was. An approach, and a movement on the ground, is refused
        with what it follows from in the same call; a stop never is. Who is told to stop moves no
        more for the same call.
        """
        command = order.command
        if command is None or any(isinstance(each, GoAroundCommand) for each in answer.commands):
            return None
        if order.when is not None and order.after in answer.undone:
            return answer.undone[order.after]
        subject = subject_of(command)
        is_move = subject == "surface" and not isinstance(command, STOPPING)
        if answer.stops and is_move and order.when is None:
            return "unable, told to stop"
        is_cancelled = any(isinstance(each, CancelTakeoffCommand) for each in answer.commands)
        if is_cancelled and isinstance(command, TakeOffCommand):
            return "unable, takeoff cancelled"
        is_first = order.when is not None or subject not in answer.refused
        before = None if is_first else answer.refused[subject]
        if is_move and before is not None:
            return before
        if subject == "approach" and not is_first:
            return before
        return self._refusal(actor, command, order.when)

    def _stops(self, actor: str, order: Order) -> bool:
        """Return whether an actor stops at once for an order to hold its position."""
        command = order.command
        return command is not None and not (order.when or self._refusal(actor, command))

    def _keeps(self, actor: str, told: Instruction) -> bool:
        """Return whether an actor keeps the limit of an instruction, now and where it goes to."""
        if told.bound == "or_more" and self._stations.is_approaching(actor):
            return False
        limit, *kept = self._value(actor, told)
        if limit is None or told.bound is None:
            return False
        is_or_more = told.bound == "or_more"
        return all(
            each is not None and (each >= limit if is_or_more else each <= limit) for each in kept
        )

    def _contradicts(self, actor: str, told: Instruction) -> str | None:
        """Return what an actor asks that is told to climb to below itself, or to descend to above.

        None if it is not.
        """
        level_ft, now_ft, _ = self._value(actor, told)
        if self._seats.has_person(actor):
            return None
        if told.action != "altitude" or level_ft is None or now_ft is None or told.bound:
            return None
        is_above = level_ft > now_ft + SAME_LEVEL_FT
        is_below = level_ft < now_ft - SAME_LEVEL_FT
        wrong = (told.sense == "climb" and is_below) or (told.sense == "descend" and is_above)
        if not wrong or told.condition is not None:
            return None
        at = self._stations.report_of(actor, "altitude", self._context.radio.phraseology)
        return f"say again altitude, we are at {at}"

    def _value(
        self, actor: str, told: Instruction
    ) -> tuple[float | None, float | None, float | None]:
        """Return the level or speed of an instruction, that of an actor, and the one it goes to."""
        if told.action == "altitude":
            return told.altitude_ft, *self._stations.altitudes_ft(actor)
        if told.action == "speed":
            return told.speed_kt, *self._stations.airspeeds_kt(actor)
        return None, None, None

    def _possible(self, actor: str, orders: Sequence[Order]) -> list[Order]:
        """Return orders without the second of two alternatives, or without a first that fails."""
        possible: list[Order] = []
        for order in orders:
            if possible and order.instruction.condition == OTHERWISE:
                first = possible[-1].command
                if first is None or self._refusal(actor, first) is None:
                    continue
                possible.pop()
                order = replace(order, instruction=replace(order.instruction, condition=None))
            possible.append(order)
        return possible

    def _answered(self, taken: Call, actor: str) -> tuple[str, ...]:
        """Return the answers of an actor to the questions of a call; it does nothing of them."""
        return tuple(dict.fromkeys(self._answer(each, actor) for each in taken.asked))

    def _answer(self, question: Question, actor: str) -> str:
        about = question.about
        if question.asks == "able":
            if about.action == "cleared_to_land" and self._stations.on_ground(actor):
                about = replace(about, action="taxi")  # A runway is taken for the take-off.
            return self._why_not(about, actor) or self._context.answers.yes()
        if about.action not in STOPS:
            return self._context.answers.of_itself(actor, about)
        if self._holds(about, actor):
            return self._context.answers.does(about)
        return self._context.answers.whereabouts(actor)

    def _holds(self, about: Instruction, actor: str) -> bool:
        """Return whether an actor stands, and could go on to the runway that it holds short of."""
        if not self._stations.on_ground(actor) or self._stations.is_moving_on_ground(actor):
            return False
        if about.action != "hold_short":
            return about.action in ("hold_position", "stop")
        goes_on: tuple[Action, ...] = ("line_up", "cross")
        return any(self._why_not(replace(about, action=each), actor) is None for each in goes_on)

    def _why_not(self, about: Instruction, actor: str) -> str | None:
        """Return why an actor could not do something now; None if it could."""
        runway, variation_deg = self._stations.bound_runway(actor), self._stations.variation_deg
        (order,) = orders_of((about,), runway, variation_deg, actor)
        if order.command is None:
            return order.unable or order.question or None
        return self._refusal(actor, order.command)

    def _refusal(self, actor: str, command: Command, when: Condition | None = None) -> str | None:
        """Return why an actor cannot carry out a command now; a person decides without us.

        A command that waits for a condition is refused only if that can never come true.
        """
        if self._seats.has_person(actor):
            return None
        if isinstance(command, ContactCommand):
            return self._stations.unknown(command.unit, command.frequency_khz)
        if when is not None:
            return self._world.never(when)
        if isinstance(command, VERTICAL) and self._stations.is_approaching(actor):
            return "unable, on the approach"
        return self._world.refusal(actor, command)

    def _told(self, actor: str, decision: Decision) -> Decision:
        """Publish what an actor refuses, and return the decision."""
        for text in decision.unable:
            if not text.startswith("unable"):
                continue  # It asks.
            now_ns = self._director.now_ns
            event = Event(t_ns=now_ns, kind="unable", subject=actor, text=text)
            self._context.publish("truth/event", event)
        return decision

    # --- doing ------------------------------------------------------------------------------

    def carry_out(self, call: RadioCall, actor: str) -> None:
        """Let the speaker of a call do what the script has for it in the call."""
        self.comply(call, actor, tuple(one for one in call.meant if one.actor == actor))

    def comply(self, call: RadioCall, actor: str, commands: tuple[ScriptedCommand, ...]) -> None:
        """Let an actor do what it has decided to do of a call, once if that is only confirmed."""
        obeyed = self._obeyed.setdefault(actor, [])
        same = (one.in_force[actor] for one in obeyed if one.first is call.first)
        if any(all(scripted in known for scripted in commands) for known in same):
            return
        subjects = {subject_of(scripted.command) for scripted in commands}
        for one in obeyed:
            before = one.in_force[actor]
            kept = [each for each in before if subject_of(each.command) not in subjects]
            one.in_force[actor] = tuple(kept)
        if commands:
            call.in_force[actor] = (*call.in_force.get(actor, ()), *commands)
            obeyed.append(call)
        for scripted in commands:
            self._do_later(call, scripted)

    def _offer(self, actor: str, call: str, command: Command) -> bool:
        """Offer the person who acts for an actor a command; return False if there is none."""
        if not self._seats.has_person(actor):
            return False
        self._seats.offer(actor, call, command)
        return True

    def _do_later(self, call: RadioCall, scripted: ScriptedCommand) -> None:
        """Let an actor carry out a command in time; a person is offered it at once instead."""
        if self._offer(scripted.actor, call.id, scripted.command):
            return
        if call.is_urgent:
            response = self._reactions[scripted.actor].respond("controller", call.id)
            if not response.follows:
                self._leave_undone(call, scripted)
                return
            scripted = scripted.model_copy(update={"delay_s": response.delay_s})
        self._director.after(scripted.delay_s, partial(self._do_on_condition, call, scripted))

    def _leave_undone(self, call: RadioCall, scripted: ScriptedCommand) -> None:
        """Tell once that an actor does not respond to a call."""
        if (call.id, scripted.actor) not in self._undone:
            self._undone.add((call.id, scripted.actor))
            does = scripted.command.action.replace("_", " ")
            self._world.no_response(scripted.actor, f"does not respond to {does} ({call.id})")

    def _change_frequency(self, call: RadioCall, actor: str, command: ContactCommand) -> None:
        """Let an actor leave its frequency, and call the unit on another one."""
        frequency_khz = self._stations.tune(actor, command.unit, command.frequency_khz)
        if frequency_khz is None:
            unit = self._stations.unit_on(call.frequency_khz)
            text = self._context.answers.to_unit(actor, unit or "Station", SAY_FREQUENCY)
            question = RadioCall(f"{call.id}.contact", call.frequency_khz, actor, unit, text)
            self._speakers.say_later(question)
            return
        event = Event(
            t_ns=self._director.now_ns,
            kind="command",
            subject=actor,
            text=command.model_dump_json(exclude_none=True),
        )
        self._context.publish("truth/event", event)
        unit = self._stations.unit_on(frequency_khz)
        if command.calls:
            text = self._context.answers.to_unit(actor, unit or (command.unit or "station").title())
            hail = RadioCall(f"{call.id}.contact", frequency_khz, actor, unit, text)
            self._speakers.say_later(hail, TUNING_S)

    def _report(self, call: RadioCall, actor: str, command: ReportCommand) -> None:
        """Let an actor tell its unit what that wants to hear of."""
        words = with_digits(command.words, self._context.radio.phraseology)
        text = self._context.answers.to_unit(actor, call.speaker, words)
        told = RadioCall(
            f"{call.id}.report-{command.words.replace(' ', '-')}",
            call.frequency_khz,
            actor,
            call.speaker,
            text,
        )
        self._speakers.say_later(told, REPORTS_AFTER_S)

    def _do_on_condition(self, call: RadioCall, scripted: ScriptedCommand) -> None:
        def act() -> None:
            actor, command = scripted.actor, scripted.command
            if not call.is_in_force(actor, command):
                return
            if isinstance(command, ContactCommand):
                self._change_frequency(call, actor, command)
            elif isinstance(command, ReportCommand):
                self._report(call, actor, command)
            elif not self._offer(actor, call.id, command):
                self._world.do(actor, command)

        if scripted.when is None:
            act()
        else:
            self._world.once(scripted.when, act)
