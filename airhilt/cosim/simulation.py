"""One run, from scenario to run folder. The main path of AIRHILT begins at `run`.

`prepare` settles what the run is, `gather` who takes part in it, `open_vision` how it sees;
`Simulation` hangs it all on one `Director`, and each part gets what it needs as arguments. Data
flows one way: aircraft, sensors, workers, advisories, crews.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from contextlib import ExitStack, closing, suppress
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Literal

from pydantic import ValidationError

from airhilt.bus.session import Bus
from airhilt.commands import Command
from airhilt.cosim.briefing import briefing_of
from airhilt.cosim.cameras import Vision, open_vision
from airhilt.cosim.participants import Participants, connect
from airhilt.cosim.router import UNREGISTERED, MessageRouter
from airhilt.cosim.setup import TICK_S, Setup, set_up
from airhilt.errors import AirhiltError, RunStopped, WorkerError, first_problem
from airhilt.files import sha256
from airhilt.messages import (
    ActorCommand,
    Advisory,
    Clock,
    ConflictPhase,
    ConflictTruth,
    Event,
    EventKind,
    Message,
    Modality,
    ModalityState,
    Phase,
    Status,
)
from airhilt.metrics.collector import Collector, pair_of
from airhilt.metrics.plans import Plans
from airhilt.metrics.summary import Summary
from airhilt.options import Options, Recorded
from airhilt.record import LatencyLog, LogWriter, RunInfo
from airhilt.record.audio import AudioRecorder
from airhilt.report.report import write_report
from airhilt.scenario import Scenario
from airhilt.scenario.failures import EffectiveLine
from airhilt.scenario.models import AircraftSpec, Condition, EngineFailure, WildlifeSpec
from airhilt.sensors.base import SensorContext, start_sensors
from airhilt.sensors.radio.backends import FallbackRadio
from airhilt.sensors.radio.conversation import RadioConversation
from airhilt.sensors.radio.stations import Stations
from airhilt.sim import Director, Pace, Priority, RealTime, StepRecord, Virtual, interruptible
from airhilt.units import SECOND_NS, seconds_to_ns
from airhilt.workers.pool import WorkerPool, parse_output
from airhilt.world.actors import Actor, Unable
from airhilt.world.actors.advisory_delivery import AdvisoryDelivery
from airhilt.world.actors.triggers import Triggers
from airhilt.world.flight import Aircraft
from airhilt.world.truth.conditions import ConditionCompiler
from airhilt.world.truth.conflicts import ConflictMonitor, Pair
from airhilt.world.truth.runways import Incursion, RunwayMonitor
from airhilt.world.truth.states import minima_of, truth_of, zone_of

TRUTH_PERIOD_NS = SECOND_NS // 5
CONDITION_PERIOD_NS = SECOND_NS // 10
"""How often the conflict window is looked at."""
RUNWAY_PERIOD_NS = SECOND_NS // 5
"""How often runways are."""
END_PERIOD_NS = SECOND_NS // 2
"""How often the conditions that end the run are."""
SNAPSHOT_PERIOD_NS = SECOND_NS // 2


@dataclass(frozen=True)
class Result:
    """What a run gave."""

    summary: Summary
    folder: Path


@dataclass(frozen=True)
class Snapshot:
    """How a run is doing, for a progress line."""

    t_s: float
    duration_s: float
    horizontal_m: float | None
    vertical_m: float | None
    advisory: Advisory | None


class Observer:
    """Is told how a run is doing; this one does not listen."""

    def snapshot(self, snapshot: Snapshot) -> None:
        """Take in how it is doing, about twice a simulated second."""

    def notice(self, text: str) -> None:
        """Take in something that the user should know at once."""


def run(
    scenario: Scenario,
    options: Options | None = None,
    observer: Observer | None = None,
    recorded: Recorded | None = None,
) -> Result:
    """Run a scenario and leave its run folder behind.

    Raises
    ------
    AirhiltError
        Something that was given is wrong, or a worker broke its contract. If the run had begun,
        its folder is complete up to that instant.
    KeyboardInterrupt
        Likewise.
    """
    observer = observer or Observer()
    setup = set_up(scenario, options or Options(), recorded or Recorded())
    options, pace = setup.options, setup.pace
    with ExitStack() as stack:
        bus = stack.enter_context(closing(Bus(setup.name, options.listen)))
        _tell_clock(bus, 0, "waiting", pace)
        participants = connect(options, setup.scenario, setup.recorded, bus, observer.notice)
        if participants.programs and options.pace is None and not setup.recorded.programs:
            pace = RealTime()
        vision = stack.enter_context(open_vision(setup, participants, observer.notice))
        setup.folder.create(options.overwrite)
        info = setup.info(participants, pace, bus.endpoint, vision.renderer)
        setup.folder.write_info(info)
        simulation = Simulation(setup, participants, pace, vision, bus, observer)
        with interruptible(simulation.interrupt):
            try:
                result = simulation.run(info)
            except BaseException:
                with suppress(AirhiltError):  # What stopped the run is the news, not its report.
                    write_report(setup.folder.path)
                raise
            write_report(setup.folder.path)
            return result


def _tell_clock(bus: Bus, t_ns: int, phase: Phase, pace: Pace) -> None:
    clock = Clock(t_ns=t_ns, run=bus.run, phase=phase, pace=pace.name)
    bus.keep("clock", clock.model_dump_json().encode())


class Simulation:
    """Everything that one run needs, hung on its Director."""

    def __init__(
        self,
        setup: Setup,
        participants: Participants,
        pace: Pace,
        vision: Vision,
        bus: Bus,
        observer: Observer,
    ) -> None:
        scenario, site, options = setup.scenario, setup.site, setup.options
        actors, folder, lines = setup.actors, setup.folder, setup.lines
        self._scenario = scenario
        self._site = site
        self._options = options
        self._bus = bus
        self._folder = folder
        self._actors = actors
        self._observer = observer
        self._director = Director(pace)
        self._log = LogWriter(folder.log_path)
        self._latency_log = LatencyLog(folder.latency_path)
        self._router = MessageRouter(bus, self._log)
        self._phase: Phase = "running"
        self._ticked_ns = 0
        self._heard_unregistered = False
        self._participants = participants
        self._programs = set(participants.programs)
        self._has_decision = bool(participants.programs) or participants.does("decision")
        self._ended_lines: set[str] = set()

        self._cues = Triggers()
        self._misled: set[str] = set()
        """Actors that act under a failure that has happened."""
        self._pair = pair_of(scenario)
        self._monitor = ConflictMonitor(
            {c: p.body for c, p in actors.items() if isinstance(p.body, Aircraft)},
            {c: p.body for c, p in actors.items() if not isinstance(p.body, Aircraft)},
            minima_of(scenario.separation),
            site.ground_m,
            zone_of(site),
            TICK_S,
            frozenset(
                actor.callsign
                for actor in scenario.actors
                if isinstance(actor, AircraftSpec) and actor.transponder.equipped
            ),
            frozenset() if self._pair is None else frozenset({self._pair}),
            self._became_true,
        )
        self._runways = None
        if site.layout is not None:
            self._runways = RunwayMonitor(
                site.layout, actors, self._misled, self._router.publish, self._incurred
            )
        self._conditions = ConditionCompiler(
            actors, self._monitor, self._runways, self._ended_lines
        )
        compiled = self._conditions.compile
        self._opens = None if scenario.conflict is None else compiled(scenario.conflict.opens_when)
        self._ends = [compiled(condition) for condition in scenario.end_when]
        self._sound = FallbackRadio(setup.sound, scenario.radio.words_per_minute, self._lose_radio)
        self._radio = RadioConversation(
            self._director,
            scenario,
            lines,
            Stations(actors, site, scenario.radio.lines),
            self._sound,
            options.seed,
            self._ended_lines,
            once=self._once,
            publish=self._router.publish,
            do=self._do,
            failed=self._failed,
            microphone_stuck=self._microphone_stuck,
            microphones_free=self._microphones_free,
        )
        self._radio.start()
        plans = Plans(lines, setup.ends_ns)
        self._collector = Collector(scenario, site.ground_m, self._monitor, self._runways, plans)
        self._pool = WorkerPool(
            self._director,
            participants.participants,
            setup.latency,
            options.seed,
            publish=self._router.publish,
            done=self._worker_done,
            lost=lambda worker, cause: self._lose(worker.name, worker.modality, cause),
        )
        self._router.listen(AudioRecorder(folder.audio_path).take)
        self._router.observe(self._collector.take)
        self._router.listen(self._pool.offer)
        self._advised = AdvisoryDelivery(
            self._director, actors, self._event, is_voiced=participants.does("tts")
        )
        self._router.listen(self._radio.take)
        self._router.listen(self._advised.take)
        self._sensors = start_sensors(
            setup.sensor_types,
            SensorContext(
                director=self._director,
                scenario=scenario,
                site=site,
                actors=actors,
                latency=setup.latency,
                seed=options.seed,
                state_at_ns=lambda: self._ticked_ns,
                publish=self._router.publish,
                step_done=self._latency_log.step,
            ),
        )
        self._vision = vision
        vision.mount(
            self._director,
            self._router,
            state_at_ns=lambda: self._ticked_ns,
            closest_ns=self._closest_approach_ns,
            lost=partial(self._go_on_without, "vision", "cameras_lost", "cameras"),
        )
        self._schedule_world()
        self._schedule_occurrences()
        self._schedule_recorded(setup.recorded)
        self._serve_bus()

    # --- the run ----------------------------------------------------------------------------

    def run(self, info: RunInfo) -> Result:
        """Run to the end, and finish the run folder whatever happens."""
        begun_wall, begun_cpu = time.perf_counter(), time.process_time()
        failure: BaseException | None = None
        try:
            self._set_modalities()
            self._brief()
            self._vision.start()
            self._director.run()
        except BaseException as error:
            failure = error
            if isinstance(error, KeyboardInterrupt):
                self._observer.notice(f"interrupted; {self._folder.path} is complete up to here")
        self._phase = "finished" if failure is None else "stopped"
        wall_s = time.perf_counter() - begun_wall
        cpu_s = time.process_time() - begun_cpu
        try:
            summary = self._finish(info, _cause(failure), wall_s, cpu_s)
        except AirhiltError:
            if failure is None:
                raise
        if failure is not None:
            raise failure
        return Result(summary, self._folder.path)

    def interrupt(self) -> None:
        """Stop after the event in hand."""
        self._director.interrupt()

    def _finish(self, info: RunInfo, cause: str, wall_s: float, cpu_s: float) -> Summary:
        """Close the logs, then write the summary and ``run.json``."""
        phase: Literal["finished", "stopped"] = "stopped" if cause else "finished"
        self._event(phase, "run", cause or "came to its end")
        self._publish_clock()
        with closing(self._latency_log), closing(self._log), ExitStack() as stack:
            stack.callback(self._vision.finish)
            self._radio.close()
            sensed = (step for sensor in self._sensors for step in sensor.unfinished())
            for step in (*self._pool.unfinished(), *sensed):
                self._latency_log.step(step)
        summary = self._summary(cause, wall_s, cpu_s)
        self._folder.write_summary(summary)
        self._folder.write_info(
            info.model_copy(
                update={
                    "phase": phase,
                    "cause": cause,
                    "unregistered_programs": self._heard_unregistered,
                    "hashes": {"log.mcap": sha256(self._folder.log_path)},
                }
            )
        )
        return summary

    def _summary(self, cause: str, wall_s: float, cpu_s: float) -> Summary:
        now_ns = self._director.now_ns
        return self._collector.summary(
            {
                "seed": self._options.seed,
                "assistant": self._participants.assistant,
                "outcome": f"stopped: {cause}" if cause else "finished",
                "inputs_dropped": self._pool.inputs_dropped(),
                "real_time_factor": now_ns / SECOND_NS / max(wall_s, 1e-9),
                "cpu_s": cpu_s,
            },
            now_ns,
        )

    def _schedule_world(self) -> None:
        director, every = self._director, self._director.every
        tick_ns = seconds_to_ns(TICK_S)
        every(tick_ns, self._tick, Priority.PHYSICS, first_ns=tick_ns)
        every(TRUTH_PERIOD_NS, self._publish_truth, Priority.SENSOR)
        if self._runways is not None:
            runways = self._runways
            every(RUNWAY_PERIOD_NS, lambda: runways.look(director.now_ns), Priority.OBSERVE)
        every(CONDITION_PERIOD_NS, self._look_around, Priority.OBSERVE)
        every(END_PERIOD_NS, self._end_if_due, Priority.OBSERVE)
        every(SECOND_NS, self._publish_clock, Priority.OBSERVE)
        every(SECOND_NS, self._log.flush, Priority.OBSERVE, first_ns=SECOND_NS)
        every(SNAPSHOT_PERIOD_NS, self._tell_observer, Priority.OBSERVE)
        director.at(seconds_to_ns(self._scenario.duration_s), director.stop, Priority.OBSERVE)

    def _schedule_recorded(self, recorded: Recorded) -> None:
        """Let what came from other processes in an earlier run come at its time."""
        if recorded.end_ns is not None:
            self._director.at(recorded.end_ns + 1, self._director.stop, Priority.PHYSICS)
        for message in recorded.foreign:
            self._director.at(
                message.t_ns,
                partial(self._foreign, message.key, message.data),
                Priority.SCRIPT,
            )
        for name, loss in recorded.losses.items():
            self._director.at(loss.t_ns, partial(self._gone, name), Priority.SETTLE)

    def _end_if_due(self) -> None:
        now_ns = self._director.now_ns
        everybody_ended = all(p.body.ended is not None for p in self._actors.values())
        if everybody_ended or any(test(now_ns) for test in self._ends):
            self._director.stop()

    # --- the world --------------------------------------------------------------------------

    def _tick(self) -> None:
        now_ns = self._director.now_ns
        for actor in self._actors.values():
            body = actor.body
            if body.ended is None:
                body.advance()
                if body.ended is not None:
                    self._actor_ended(actor)
        self._ticked_ns = now_ns
        self._monitor.tick(now_ns)

    def _actor_ended(self, actor: Actor) -> None:
        callsign, cause = actor.spec.callsign, actor.body.ended or ""
        self._collector.ended_actors[callsign] = cause
        self._event("actor_ended", callsign, cause)

    def _look_around(self) -> None:
        """Let everything that waits for the world to be so look whether it is."""
        now_ns = self._director.now_ns
        for actor in self._actors.values():
            if actor.body.ended is None:
                try:
                    actor.attend()
                except Unable as unable:
                    self._event("unable", actor.spec.callsign, str(unable))
        self._cues.look(now_ns)
        self._watch_window()

    def _once(self, condition: Condition, action: Callable[[], None]) -> None:
        self._cues.once(self._conditions.compile(condition), action)

    def _schedule_occurrences(self) -> None:
        """Let engines fail, and wildlife move, when the scenario says so."""
        for failure in self._scenario.failures:
            if isinstance(failure, EngineFailure):
                self._once(failure.when, partial(self._fail_engine, failure))
        for actor in self._actors.values():
            if isinstance(actor.spec, WildlifeSpec):
                for cue in actor.spec.plan:
                    action = partial(self._do, actor.spec.callsign, cue.command)
                    self._once(cue.when, action)

    def _fail_engine(self, failure: EngineFailure) -> None:
        body = self._actors[failure.actor].body
        if isinstance(body, Aircraft) and body.ended is None:
            body.fail_engine(failure.engine)
            self._event("failure", failure.actor, f"engine {failure.engine} stops")

    def _watch_window(self) -> None:
        """Open the conflict window on its condition; close it once the pair is past it."""
        now_ns, window, pair = self._director.now_ns, self._collector.window, self._pair
        if self._opens is None or pair is None or window.closed_ns is not None:
            return
        if window.opened_ns is None:
            if self._opens(now_ns):
                window.opened_ns = now_ns
                self._publish_conflict("opened", pair)
        elif not self._monitor.flying(pair) or self._is_past(pair):
            window.closed_ns = now_ns
            self._publish_conflict("closed", pair)

    def _is_past(self, pair: Pair) -> bool:
        motion, _, _ = self._monitor.motion(pair)
        return motion.time_to_closest_approach_s() < 0.0 and not self._opens_again(pair)

    def _opens_again(self, pair: Pair) -> bool:
        return self._monitor.time_to_loss_s(pair) is not None

    def _became_true(
        self, phase: ConflictPhase, pair: Pair, horizontal_m: float, vertical_m: float
    ) -> None:
        if all(self._actors[callsign].category == "wildlife" for callsign in pair):
            return  # A herd.
        now_ns = self._director.now_ns
        self._router.publish(
            "truth/conflict",
            ConflictTruth(
                t_ns=now_ns,
                phase=phase,
                actors=pair,
                horizontal_m=horizontal_m,
                vertical_m=vertical_m,
            ),
        )
        if phase == "collision":
            if self._runways is not None:
                self._runways.collided(*pair)
            for callsign, other in (pair, pair[::-1]):
                actor, struck = self._actors[callsign], self._actors[other]
                if struck.category == "wildlife" and not struck.body.on_ground:
                    continue  # An aircraft flies on after a bird strike.
                actor.body.ended = f"collision with {other}"
                self._actor_ended(actor)

    def _incurred(self, incursion: Incursion) -> None:
        actors = (incursion.user, incursion.intruder)
        self._router.publish(
            "truth/conflict",
            ConflictTruth(
                t_ns=self._director.now_ns,
                phase="runway_incursion",
                actors=tuple(actor for actor in actors if actor is not None),
                horizontal_m=incursion.closest.horizontal_m if incursion.closest else None,
                vertical_m=incursion.closest.vertical_m if incursion.closest else None,
                runway=incursion.runway.replace("/", "-"),
            ),
        )

    def _publish_conflict(self, phase: ConflictPhase, pair: Pair) -> None:
        self._router.publish(
            "truth/conflict",
            ConflictTruth(t_ns=self._director.now_ns, phase=phase, actors=pair),
        )

    def _publish_truth(self) -> None:
        now_ns = self._director.now_ns
        for callsign, actor in self._actors.items():
            if actor.body.ended is None:
                self._router.publish(f"truth/state/{callsign}", truth_of(actor, now_ns))

    # --- sensors ----------------------------------------------------------------------------

    def _closest_approach_ns(self) -> int | None:
        """Return when the annotated pair was nearest up to now."""
        truth = None if self._pair is None else self._monitor.pairs.get(self._pair)
        return None if truth is None or truth.closest is None else truth.closest.t_ns

    def _failed(self, happening: EffectiveLine) -> None:
        self._misled |= happening.misled
        for text in happening.failures:
            self._event("failure", happening.declared.id, text)

    def _microphone_stuck(self, callsign: str, text: str) -> None:
        self._event("failure", callsign, text)
        self._set_modality("radio", "lost", f"{callsign}: {text}")
        self._observer.notice(
            f"radio blocked at {self._director.now_ns / SECOND_NS:.1f} s by {callsign}: {text}"
        )

    def _microphones_free(self) -> None:
        if not self._sound.is_lost:
            self._set_modality("radio", "on")
        self._observer.notice(f"radio free again at {self._director.now_ns / SECOND_NS:.1f} s")

    def _do(self, callsign: str, command: Command) -> None:
        """Let an actor do what a line or its plan says."""
        if self._actors[callsign].body.ended is None:
            self._event("command", callsign, command.model_dump_json(exclude_none=True))
            self._obey(callsign, command)

    def _obey(self, callsign: str, command: Command) -> None:
        """Let an actor do as it was told, or say that it cannot."""
        actor = self._actors[callsign]
        if actor.body.ended is not None:
            return
        try:
            actor.command(command)
        except Unable as unable:
            self._event("unable", callsign, str(unable))

    # --- workers ----------------------------------------------------------------------------

    def _worker_done(self, record: StepRecord) -> None:
        self._latency_log.step(record)
        self._collector.step(record)

    def _lose(self, name: str, modality: Modality, cause: str) -> None:
        if modality == "tts":
            self._advised.voice_lost()
        self._latency_log.lost(name, self._director.now_ns, cause)
        self._go_on_without(modality, "worker_lost", name, cause)

    def _lose_radio(self, cause: str) -> None:
        self._go_on_without("radio", "radio_lost", "radio", cause)

    def _go_on_without(self, modality: Modality, kind: EventKind, subject: str, cause: str) -> None:
        now_ns = self._director.now_ns
        self._set_modality(modality, "lost", cause)
        self._event(kind, subject, cause)
        self._observer.notice(f"lost at {now_ns / SECOND_NS:.1f} s: {cause}")
        if self._options.strict:
            raise RunStopped(
                f"stopped at {now_ns / SECOND_NS:.1f} s, as --strict asks: {cause}; run again "
                "without --strict to go on without it"
            )

    def _serve_bus(self) -> None:
        """Notice workers that go, and hear what other programs publish by themselves."""
        attached = {
            p.description.name for p in self._participants.participants if p.attached
        } | self._programs

        def changed(name: str, alive: bool) -> None:
            if not alive and name in attached:
                self._director.post(partial(self._gone, name))

        self._bus.watch_workers(changed)
        for pattern in ("advisory/*", "asr/*", "vision/*", "command/*"):
            self._bus.hear(
                pattern,
                lambda key, data: self._director.post(lambda: self._hear_unregistered(key, data)),
            )

    def _gone(self, name: str) -> None:
        """Give up a worker or a program of another process that has ended."""
        cause = f"worker {name!r} is gone: its process ended"
        if name in self._programs:
            self._programs.discard(name)
            self._lose(name, "decision", cause)
        else:
            self._pool.servers[name].lose(cause)

    def _hear_unregistered(self, key: str, data: bytes) -> None:
        """Take in a message that no grant asked for; such a program needs real time."""
        if isinstance(self._director.pace, Virtual):
            self._director.change_pace(RealTime())
            self._observer.notice(
                f"a program that takes no grants published on {key}: going on in real time"
            )
        self._foreign(key, data)

    def _foreign(self, key: str, data: bytes) -> None:
        """Let a message that no grant asked for count now."""
        if not self._heard_unregistered:
            self._heard_unregistered = True
            self._event("unregistered", key, "a program that takes no grants has published")
        try:
            message = _parse_foreign(key, data, self._director.now_ns)
        except WorkerError as error:
            self._event("refused", key, str(error))
            self._observer.notice(str(error))
            if self._options.strict:
                raise
            return
        stamped = message.model_copy(update={"t_ns": self._director.now_ns})
        if isinstance(stamped, Advisory) and not self._has_decision:
            self._has_decision = True
            self._set_modality("decision", "on")
        self._router.heard(key, stamped, UNREGISTERED)
        if isinstance(stamped, ActorCommand):
            callsign = key.split("/")[1]
            if callsign in self._actors:
                self._obey(callsign, stamped.command)

    # --- what is told -----------------------------------------------------------------------

    def _brief(self) -> None:
        briefing = briefing_of(self._scenario, self._site)
        self._router.publish("briefing", briefing)
        self._bus.keep("briefing", briefing.model_dump_json().encode())

    def _set_modalities(self) -> None:
        scenario = self._scenario
        equipped = any(
            not isinstance(actor, WildlifeSpec) and actor.transponder.equipped
            for actor in scenario.actors
        )
        self._set_modality("adsb", "on" if equipped else "off")
        self._set_modality("radio", "on" if scenario.radio.lines else "off")
        self._set_modality("asr", "on" if self._participants.does("asr") else "off")
        self._set_modality("tts", "on" if self._participants.does("tts") else "off")
        self._set_modality("vision", *self._vision.state)
        self._set_modality("decision", "on" if self._has_decision else "off")

    def _set_modality(self, modality: Modality, state: ModalityState, cause: str = "") -> None:
        self._collector.modalities[modality] = state
        self._router.publish(
            f"status/{modality}",
            Status(t_ns=self._director.now_ns, modality=modality, state=state, cause=cause),
        )

    def _publish_clock(self) -> None:
        _tell_clock(self._bus, self._director.now_ns, self._phase, self._director.pace)

    def _event(self, kind: EventKind, subject: str, text: str) -> None:
        self._router.publish(
            "truth/event",
            Event(t_ns=self._director.now_ns, kind=kind, subject=subject, text=text),
        )

    def _tell_observer(self) -> None:
        horizontal = vertical = None
        if self._pair is not None and self._monitor.flying(self._pair):
            motion, first, second = self._monitor.motion(self._pair)
            horizontal = motion.distance_m
            vertical = abs(first.altitude_m - second.altitude_m)
        self._observer.snapshot(
            Snapshot(
                self._director.now_ns / SECOND_NS,
                self._scenario.duration_s,
                horizontal,
                vertical,
                self._collector.last_advisory,
            )
        )


def _cause(failure: BaseException | None) -> str:
    """Return why a run was stopped, in words; empty if it was not."""
    match failure:
        case None:
            return ""
        case KeyboardInterrupt():
            return "interrupted"
        case AirhiltError():
            return str(failure)
        case _:
            return f"{type(failure).__name__}: {failure}"


def _parse_foreign(key: str, data: bytes, now_ns: int) -> Message:
    """Return what an unregistered program put on a key.

    Raises
    ------
    WorkerError
        It is not what belongs there.
    """
    if not key.startswith("command/"):
        return parse_output(UNREGISTERED, key, data, now_ns)
    try:
        return ActorCommand.model_validate_json(data)
    except ValidationError as error:
        raise WorkerError(
            f"{key}: not a command: {first_problem(error)}; see `airhilt schema`"
        ) from None
