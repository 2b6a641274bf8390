"""The true world of a run: actors that move and act, and monitors of what is true of them."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import Any, Literal

from airhilt.commands import Command
from airhilt.cosim.context import RunContext
from airhilt.cosim.setup import TICK_S
from airhilt.errors import AirhiltError, ScenarioError, failure_in
from airhilt.messages import (
    ActorCommand,
    ConflictPhase,
    ConflictTruth,
    FlyCommand,
    Message,
    SeatAction,
)
from airhilt.scenario.models import AircraftSpec, Condition, EngineFailure, WildlifeSpec
from airhilt.seats import Seats
from airhilt.sensors.radio.conversation import RadioConversation
from airhilt.sim import Priority
from airhilt.sim.payload import Payload
from airhilt.units import SECOND_NS, seconds_to_ns
from airhilt.world.actors import Actor, Unable
from airhilt.world.actors.triggers import Triggers
from airhilt.world.flight import Aircraft
from airhilt.world.mover import goes_on
from airhilt.world.truth.conditions import ConditionCompiler
from airhilt.world.truth.conflicts import ConflictMonitor, Pair
from airhilt.world.truth.runways import Incursion, RunwayMonitor
from airhilt.world.truth.states import minima_of, truth_of, zone_of

TRUTH_PERIOD_NS = SECOND_NS // 5
"""Period of the true states that are published, in ns."""
CONDITION_PERIOD_NS = SECOND_NS // 10
"""Period at which triggers and the conflict window are evaluated, in ns."""
RUNWAY_PERIOD_NS = SECOND_NS // 5
"""Period at which the occupancy of runways is evaluated, in ns."""


class WorldLoop:
    """Moves the actors of a run tick by tick, and publishes what becomes true of them.

    Attributes
    ----------
    pair
        Actors of the declared conflict; None if the scenario declares none.
    monitor
        Truth about each pair of actors.
    runways
        Truth about runways; None without an airport.
    affected
        Callsigns of actors that act under a failure which has happened.
    uncleared
        Callsigns of affected actors that act without a clearance.
    begun_lines, ended_lines
        Ids of the radio lines that have begun, and of those that have been on the air.
    ticked_ns
        Time of the last physics tick, of which all states are.
    """

    def __init__(self, context: RunContext, seats: Seats) -> None:
        self._context = context
        self._director = context.director
        self._scenario = context.setup.scenario
        self._actors = context.setup.actors
        self._publish = context.router.publish
        self._seats = seats
        self._triggers = Triggers()
        self.radio: RadioConversation | None = None
        """Radio on which actors say why they cannot do what they were told; None: there is none."""
        self.affected: set[str] = set()
        self.uncleared: set[str] = set()
        self.begun_lines: set[str] = set()
        self.ended_lines: set[str] = set()
        self.ticked_ns = 0
        self.pair = self._scenario.pair
        layout = context.setup.site.layout
        self.runways: RunwayMonitor | None = None
        if layout is not None:
            self.runways = RunwayMonitor(
                layout,
                self._actors,
                self.affected,
                self.uncleared,
                self._publish,
                self._publish_incursion,
            )
        self.monitor = self._conflict_monitor()
        self._compile = ConditionCompiler(
            self._actors,
            self.monitor,
            self.runways,
            self.begun_lines,
            self.ended_lines,
            context.setup.site,
        ).compile
        conflict = self._scenario.conflict
        if conflict is not None:
            self._opens = self._compile(conflict.opens_when)
            begins = conflict.begins
            self._begins = self._opens if begins is None else self._compile(begins)
        self._ends = [self._compile(condition) for condition in self._scenario.end_when]
        self._has_begun = conflict is None
        self._window: Literal["before", "open", "after"] = "before" if conflict else "after"

    def _conflict_monitor(self) -> ConflictMonitor:
        scenario, site = self._scenario, self._context.setup.site
        bodies = {callsign: actor.body for callsign, actor in self._actors.items()}
        return ConflictMonitor(
            {c: body for c, body in bodies.items() if isinstance(body, Aircraft)},
            {c: body for c, body in bodies.items() if not isinstance(body, Aircraft)},
            minima_of(scenario.separation),
            site.ground_m,
            zone_of(site),
            TICK_S,
            frozenset(
                spec.callsign
                for spec in scenario.actors
                if isinstance(spec, AircraftSpec) and spec.transponder.equipped
            ),
            frozenset() if self.pair is None else frozenset({self.pair}),
            self._became_true,
        )

    def schedule(self) -> None:
        """Schedule physics, truth and the evaluation of conditions."""
        every, tick_ns = self._director.every, seconds_to_ns(TICK_S)
        every(tick_ns, self._tick, Priority.PHYSICS, first_ns=tick_ns)
        every(TRUTH_PERIOD_NS, self._publish_states, Priority.SENSOR)
        if self.runways is not None:
            tick = self.runways.tick
            every(RUNWAY_PERIOD_NS, lambda: tick(self._director.now_ns), Priority.OBSERVE)
        every(CONDITION_PERIOD_NS, self._evaluate, Priority.OBSERVE)

    def schedule_occurrences(self) -> None:
        """Let engines fail, and wildlife move, when the scenario says so."""
        for failure in self._scenario.failures:
            if isinstance(failure, EngineFailure):
                self.once(failure.when, partial(self._fail_engine, failure))
        for actor in self._actors.values():
            if isinstance(actor.spec, WildlifeSpec):
                for cue in actor.spec.plan:
                    self.once(cue.when, partial(self.do, actor.spec.callsign, cue.command))

    def once(self, condition: Condition, action: Callable[[], None]) -> None:
        """Do an action as soon as a condition of the scenario is true."""
        self._triggers.once(self._compile(condition), action)

    def do(self, callsign: str, command: Command) -> None:
        """Let an actor do what a radio line or its plan says, and publish that it does."""
        if self._actors[callsign].body.ended is None:
            self._context.event("command", callsign, command.model_dump_json(exclude_none=True))
            why = self.obey(callsign, command)
            if why is not None:
                self.tell(callsign, why)

    def refusal(self, callsign: str, command: Command) -> str | None:
        """Return why an actor cannot carry out a command now, as it says it; None: it can."""
        return self._actors[callsign].refusal(command)

    def never(self, condition: Condition) -> str | None:
        """Return why a condition cannot come true, as an actor says it; None: it can."""
        try:
            self._compile(condition)
        except ScenarioError as error:
            return f"unable, {error}"
        return None

    def no_response(self, callsign: str, text: str) -> None:
        """Publish that an actor does not do what it was told."""
        self._context.event("no_response", callsign, text)

    def take(self, key: str, message: Message, data: Payload) -> None:  # noqa: ARG002
        """Let an actor carry out the command of a person or a program."""
        match message:
            case ActorCommand(command=command):
                self.obey(key.split("/")[1], command)
            case SeatAction(act=FlyCommand(command=command), t_ns=t_ns):
                given = ActorCommand(t_ns=t_ns, command=command)
                self._publish(f"command/{key.split('/')[1]}", given)

    def tell(self, callsign: str, words: str) -> None:
        """Let an actor tell its unit something of its own accord, where there is a radio."""
        if self.radio is not None:
            self.radio.tell(callsign, words)

    def obey(self, callsign: str, command: Command) -> str | None:
        """Let an actor carry out a command; return why it cannot, or None.

        Nothing happens if there is no such actor, or if it has left the run.
        """
        actor = self._actors.get(callsign)
        if actor is None or actor.body.ended is not None:
            return None
        try:
            actor.command(command)
        except Unable as unable:
            self._context.event("unable", callsign, str(unable))
            return str(unable)
        self._seats.end_offer(callsign, command)
        return None

    def line_begun(self, line: str) -> None:
        """Take in that a radio line begins now: it may be what begins the conflict."""
        self.begun_lines.add(line)
        self._begin_if_due()

    def has_ended(self) -> bool:
        """Return whether all actors have ended, or a condition that ends the run is true."""
        now_ns = self._director.now_ns
        all_ended = not any(goes_on(actor.body) for actor in self._actors.values())
        return all_ended or any(test(now_ns) for test in self._ends)

    def closest_approach_ns(self) -> int | None:
        """Return when the pair of the conflict was nearest up to now; None if there is none."""
        truth = None if self.pair is None else self.monitor.pairs.get(self.pair)
        return None if truth is None or truth.closest is None else truth.closest.t_ns

    def distances_m(self) -> tuple[float, float] | None:
        """Return how far the pair of the conflict is apart, horizontally and vertically."""
        if self.pair is None or not self.monitor.flying(self.pair):
            return None
        return self.monitor.motion(self.pair).distance_m, self.monitor.vertical_m(self.pair)

    def clear(self) -> None:
        """Let go of all parts, because monitors and triggers refer back to it: the run is over."""
        vars(self).clear()

    def _tick(self) -> None:
        now_ns = self._director.now_ns
        for actor in self._actors.values():
            if goes_on(actor.body):
                self._advance(actor)
                if not goes_on(actor.body):
                    self._tell_end(actor)
        self.ticked_ns = now_ns
        self.monitor.tick(now_ns)

    def _advance(self, actor: Actor) -> None:
        """Move an actor on by one tick; its body may be the code of another package."""
        try:
            actor.body.advance()
        except AirhiltError:
            raise
        except Exception as error:
            raise AirhiltError(
                f"actor {actor.spec.callsign!r} cannot move on at "
                f"{self._director.now_ns / SECOND_NS:.2f} s: {failure_in(error)}"
            ) from error

    def _evaluate(self) -> None:
        """Let actors go on with what they began, and evaluate triggers and conflict window."""
        now_ns = self._director.now_ns
        for actor in self._actors.values():
            if actor.body.ended is None:
                try:
                    actor.attend()
                except Unable as unable:
                    self._context.event("unable", actor.spec.callsign, str(unable))
                    self.tell(actor.spec.callsign, str(unable))
        self._triggers.evaluate(now_ns)
        self._begin_if_due()
        self._move_window()

    def _fail_engine(self, failure: EngineFailure) -> None:
        body = self._actors[failure.actor].body
        if isinstance(body, Aircraft) and body.ended is None:
            body.fail_engine(failure.engine)
            self._context.event("failure", failure.actor, f"engine {failure.engine} stops")

    def _publish_states(self) -> None:
        now_ns = self._director.now_ns
        for callsign, actor in self._actors.items():
            if actor.body.ended is None:
                self._publish(f"truth/state/{callsign}", truth_of(actor, now_ns))

    # --- what becomes true ------------------------------------------------------------------

    def _begin_if_due(self) -> None:
        """Begin the declared conflict if its event has happened."""
        if not self._has_begun and self._begins(self._director.now_ns):
            self._has_begun = True
            self._publish_conflict("begun", self.pair)

    def _move_window(self) -> None:
        """Open the conflict window on the scenario's condition; close it once the pair is past."""
        if self.pair is None:
            return
        now_ns = self._director.now_ns
        if self._window == "before" and self._opens(now_ns):
            self._window = "open"
            self.monitor.open_window(self.pair, now_ns)
            self._publish_conflict("opened", self.pair)
        elif self._window == "open" and self._has_passed(self.pair):
            self._window = "after"
            self.monitor.close_window(self.pair)
            self._publish_conflict("closed", self.pair)

    def _has_passed(self, pair: Pair) -> bool:
        """Return whether a pair moves apart and will not lose separation, or one has ended."""
        if not self.monitor.flying(pair):
            return True
        is_receding = self.monitor.motion(pair).time_to_closest_approach_s() < 0.0
        return is_receding and self.monitor.time_to_loss_s(pair) is None

    def _became_true(
        self, phase: ConflictPhase, pair: Pair, horizontal_m: float, vertical_m: float
    ) -> None:
        """Publish what became true of a pair; whatever collides, ends."""
        if all(self._actors[callsign].category == "wildlife" for callsign in pair):
            return  # A herd.
        self._publish_conflict(phase, pair, horizontal_m=horizontal_m, vertical_m=vertical_m)
        if phase != "collision":
            return
        if self.runways is not None:
            self.runways.collided(*pair)
        for callsign, other in (pair, pair[::-1]):
            actor, struck = self._actors[callsign], self._actors[other]
            if struck.category == "wildlife" and not struck.body.on_ground:
                continue  # An aircraft flies on after a bird strike.
            actor.body.ended = f"collision with {other}"
            self._tell_end(actor)

    def _publish_incursion(self, incursion: Incursion) -> None:
        closest = incursion.closest
        self._publish_conflict(
            "runway_incursion",
            tuple(each for each in (incursion.user, incursion.intruder) if each is not None),
            horizontal_m=closest.horizontal_m if closest else None,
            vertical_m=closest.vertical_m if closest else None,
            runway=incursion.runway.replace("/", "-"),
        )

    def _publish_conflict(
        self, phase: ConflictPhase, actors: tuple[str, ...] | None, **facts: Any
    ) -> None:
        truth = ConflictTruth(t_ns=self._director.now_ns, phase=phase, actors=actors or (), **facts)
        self._publish("truth/conflict", truth)

    def _tell_end(self, actor: Actor) -> None:
        self._context.event("actor_ended", actor.spec.callsign, actor.body.ended or "")
