"""The true world of a run: actors that move and act, and monitors of what is true of them."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from functools import partial

from airhilt.commands import Command
from airhilt.cosim.conflict_publisher import ConflictPublisher, publish_incursion, tell_end
from airhilt.cosim.conflict_window import ConflictWindow, Step
from airhilt.cosim.events import EventPublisher
from airhilt.cosim.router import MessageRouter
from airhilt.cosim.setup import TICK_S, Setup
from airhilt.errors import AirhiltError, failure_in
from airhilt.messages import (
    ActorCommand,
    ConflictTruth,
    FlyCommand,
    Message,
    SeatAction,
)
from airhilt.scenario.models import AircraftSpec, Condition, EngineFailure, WildlifeSpec
from airhilt.seats import Seats
from airhilt.sim import Director, Priority
from airhilt.sim.payload import Payload
from airhilt.units import SECOND_NS, seconds_to_ns
from airhilt.world.actors import Actor, Unable
from airhilt.world.actors.triggers import Triggers
from airhilt.world.flight import Aircraft
from airhilt.world.truth.conditions import ConditionCompiler
from airhilt.world.truth.conflicts import ConflictMonitor
from airhilt.world.truth.runways import RunwayMonitor
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

    def __init__(
        self,
        director: Director,
        setup: Setup,
        router: MessageRouter,
        event: EventPublisher,
        seats: Seats,
    ) -> None:
        scenario, site, actors = setup.scenario, setup.site, setup.actors
        self._director = director
        self._scenario = scenario
        self._actors = actors
        self._publish = router.publish
        self._event = event
        self._seats = seats
        self._triggers = Triggers()
        self.affected: set[str] = set()
        self.uncleared: set[str] = set()
        self.begun_lines: set[str] = set()
        self.ended_lines: set[str] = set()
        self.ticked_ns = 0
        self.pair = scenario.pair
        self.runways: RunwayMonitor | None = None
        if site.layout is not None:
            self.runways = RunwayMonitor(
                site.layout,
                actors,
                self.affected,
                self.uncleared,
                self._publish,
                partial(publish_incursion, director, router),
            )
        conflicts = ConflictPublisher(director, actors, router, event, self.runways)
        self.monitor = self._conflict_monitor(setup, conflicts)
        self._compile = ConditionCompiler(
            actors, self.monitor, self.runways, self.begun_lines, self.ended_lines
        ).compile
        self._window = self._conflict_window()
        self._ends = [self._compile(condition) for condition in scenario.end_when]

    def _conflict_monitor(self, setup: Setup, conflicts: ConflictPublisher) -> ConflictMonitor:
        scenario, site = setup.scenario, setup.site
        bodies = {callsign: actor.body for callsign, actor in setup.actors.items()}
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
            conflicts.became_true,
        )

    def _conflict_window(self) -> ConflictWindow | None:
        conflict = self._scenario.conflict
        if conflict is None or self.pair is None:
            return None
        opens = self._compile(conflict.opens_when)
        begins = opens if conflict.begins is None else self._compile(conflict.begins)
        return ConflictWindow(self.pair, begins, opens, self.monitor)

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
            self._event("command", callsign, command.model_dump_json(exclude_none=True))
            self.obey(callsign, command)

    def take(self, key: str, message: Message, data: Payload) -> None:  # noqa: ARG002
        """Let an actor carry out the command of a person or a program."""
        match message:
            case ActorCommand(command=command):
                self.obey(key.split("/")[1], command)
            case SeatAction(act=FlyCommand(command=command), t_ns=t_ns):
                given = ActorCommand(t_ns=t_ns, command=command)
                self._publish(f"command/{key.split('/')[1]}", given)

    def obey(self, callsign: str, command: Command) -> None:
        """Let an actor carry out a command, or say that it cannot.

        Nothing happens if there is no such actor, or if it has left the run.
        """
        actor = self._actors.get(callsign)
        if actor is None or actor.body.ended is not None:
            return
        try:
            actor.command(command)
        except Unable as unable:
            self._event("unable", callsign, str(unable))
        else:
            self._seats.end_offer(callsign, command)

    def line_begun(self, line: str) -> None:
        """Take in that a radio line begins now: it may be what begins the conflict."""
        self.begun_lines.add(line)
        if self._window is not None:
            self._publish_steps(self._window.begin_if_due(self._director.now_ns))

    def state_at_ns(self) -> int:
        """Return the time of the states of the actors."""
        return self.ticked_ns

    def has_ended(self) -> bool:
        """Return whether all actors have ended, or a condition that ends the run is true."""
        now_ns = self._director.now_ns
        all_ended = all(actor.body.ended is not None for actor in self._actors.values())
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
        """Forget what waits for a condition: the run is over."""
        self._triggers.clear()

    def _tick(self) -> None:
        now_ns = self._director.now_ns
        for actor in self._actors.values():
            if actor.body.ended is None:
                self._advance(actor)
                if actor.body.ended is not None:
                    tell_end(self._event, actor)
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
                    self._event("unable", actor.spec.callsign, str(unable))
        self._triggers.evaluate(now_ns)
        if self._window is not None:
            self._publish_steps(self._window.look(now_ns))

    def _fail_engine(self, failure: EngineFailure) -> None:
        body = self._actors[failure.actor].body
        if isinstance(body, Aircraft) and body.ended is None:
            body.fail_engine(failure.engine)
            self._event("failure", failure.actor, f"engine {failure.engine} stops")

    def _publish_states(self) -> None:
        now_ns = self._director.now_ns
        for callsign, actor in self._actors.items():
            if actor.body.ended is None:
                self._publish(f"truth/state/{callsign}", truth_of(actor, now_ns))

    def _publish_steps(self, steps: Iterable[Step]) -> None:
        assert self.pair is not None
        for step in steps:
            conflict = ConflictTruth(t_ns=self._director.now_ns, phase=step, actors=self.pair)
            self._publish("truth/conflict", conflict)
