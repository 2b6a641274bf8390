"""One run, from scenario to run folder. The main path of AIRHILT begins at `run`.

`Setup` settles what the run is, `connect` who takes part in it, `Vision` how it sees;
`Simulation` connects it all with one `Director`, and each part gets what it needs as arguments.
Data flows one way: actors, sensors, workers, advisories, crews.
"""

from __future__ import annotations

import threading
import time
from collections.abc import Iterator, Sequence
from contextlib import ExitStack, closing, contextmanager, suppress
from functools import partial
from typing import TYPE_CHECKING, Literal

from airhilt.bus.access import ROLES, WITHOUT_KEYS
from airhilt.bus.closed import ClosedBus
from airhilt.bus.endpoints import what_is_open
from airhilt.bus.session import Bus
from airhilt.cosim.briefing import briefing_of, seat_states
from airhilt.cosim.cameras import Vision, started_renderers
from airhilt.cosim.context import RunContext
from airhilt.cosim.engines_in_use import is_own_engine
from airhilt.cosim.external_programs import ExternalPrograms
from airhilt.cosim.notices import RadioNotices, SeatNotices, WorkerNotices
from airhilt.cosim.observer import Observer, Snapshot
from airhilt.cosim.pace_control import MOST_BEHIND_NS, PaceControl, tell_clock
from airhilt.cosim.participants import Participants, connect
from airhilt.cosim.provenance import run_info
from airhilt.cosim.recorded import Recorded
from airhilt.cosim.router import MessageRouter
from airhilt.cosim.setup import Setup
from airhilt.cosim.workload_questions import WorkloadQuestions
from airhilt.cosim.world_loop import WorldLoop
from airhilt.errors import AirhiltError
from airhilt.host.machine import cpu_s, give_memory_back
from airhilt.host.text import LONGEST_LINE, readable
from airhilt.messages import Message, WorkerDescription
from airhilt.metrics.collector import Collector
from airhilt.metrics.plans import Plans, Start
from airhilt.metrics.result import Result
from airhilt.metrics.summary import Summary
from airhilt.options import Options
from airhilt.record import LatencyLog, LogWriter, RunInfo
from airhilt.record.audio import AudioRecorder
from airhilt.report import write_report
from airhilt.scenario import Scenario
from airhilt.scenario.models import AircraftSpec, WildlifeSpec
from airhilt.seats import Seats
from airhilt.sensors.adsb import STAGE as ADSB
from airhilt.sensors.base import Sensor, SensorContext
from airhilt.sensors.radio.advisory_calls import AdvisoryChannel
from airhilt.sensors.radio.backends import FallbackRadio
from airhilt.sensors.radio.context import RadioContext
from airhilt.sensors.radio.conversation import RadioConversation
from airhilt.sensors.radio.stations import Stations
from airhilt.sensors.starting import start_sensors
from airhilt.sim import Director, Pace, Priority, RealTime, StepRecord, Virtual, interruptible
from airhilt.units import FOOT_PER_MINUTE, SECOND_NS, seconds_to_ns
from airhilt.workers import Worker
from airhilt.workers.pool import WorkerPool
from airhilt.world.actors.advisory_delivery import AdvisoryDelivery
from airhilt.world.flight import Aircraft

if TYPE_CHECKING:
    from airhilt.sensors.cameras.renderer_process import RendererKeeper

END_PERIOD_NS = SECOND_NS // 2
"""Period at which the conditions that end the run are evaluated, in ns."""
SNAPSHOT_PERIOD_NS = SECOND_NS // 2
"""Period at which the observer is told how the run is doing, in ns."""


@contextmanager
def _memory_given_back() -> Iterator[None]:
    try:
        yield
    finally:
        give_memory_back()


@_memory_given_back()  # After the function, whose variables are the run.
def run(
    scenario: Scenario,
    options: Options | None = None,
    observer: Observer | None = None,
    recorded: Recorded | None = None,
    workers: Sequence[Worker] = (),
    keeper: RendererKeeper | None = None,
) -> Result:
    """Run a scenario and leave its run folder behind.

    Parameters
    ----------
    recorded
        Parts of the record of an earlier run that a replay takes.
    workers
        Workers of this process that take the places of reference workers.
    keeper
        Keeps the process that draws from one run of this process to the next; None: each run
        has one of its own.

    Raises
    ------
    AirhiltError
        Something that was given is wrong, or a worker broke its contract. If the run had begun,
        its folder is complete up to that instant.
    KeyboardInterrupt
        Likewise.
    """
    with connected(
        scenario, options or Options(), observer or Observer(), recorded, workers, keeper
    ) as simulation:
        return _run_and_report(simulation)


@contextmanager
def connected(
    scenario: Scenario,
    options: Options,
    observer: Observer,
    recorded: Recorded | None = None,
    workers: Sequence[Worker] = (),
    keeper: RendererKeeper | None = None,
) -> Iterator[Simulation]:
    """Give the simulation of a run that is about to begin; see `run` for arguments and errors."""
    recorded = recorded or Recorded()
    with ExitStack() as stack:
        processes = stack.enter_context(
            started_renderers(scenario, options, recorded, bool(workers), keeper)
        )
        setup = Setup(scenario, options, recorded)
        for text in setup.notices:
            observer.notice(text)
        options, pace = setup.options, setup.pace
        bus = stack.enter_context(closing(_open_bus(setup.name, options, observer)))
        tell_clock(bus, 0, "waiting", pace)
        participants = connect(setup, bus, observer.notice, workers)
        has_people = bool(setup.seats) and not setup.recorded.is_replay
        has_programs = bool(participants.programs) and not setup.recorded.programs
        if options.pace is None and (has_people or has_programs):
            pace = RealTime()
        vision = stack.enter_context(closing(Vision(setup, participants, processes, observer)))
        setup.folder.create(options.overwrite)
        info = run_info(setup, participants, pace, bus.endpoint, vision.renderer)
        setup.folder.write_info(info)
        log = stack.enter_context(closing(LogWriter(setup.folder.log_path)))
        log.flush()  # A run that is killed at once leaves a log that can be read.
        latency_log = stack.enter_context(closing(LatencyLog(setup.folder.latency_path)))
        yield Simulation(
            setup, info, participants, pace, vision, bus, observer, log=log, latency_log=latency_log
        )


def _open_bus(name: str, options: Options, observer: Observer) -> ClosedBus:
    """Return the bus of a run: closed where nobody is told how to join it."""
    if not options.may_be_joined:
        return ClosedBus(name)
    bus = Bus(
        name,
        options.endpoint,
        anyone=ROLES if options.share_truth else WITHOUT_KEYS,
        tls=options.tls,
        insecure=options.insecure,
    )
    if options.insecure:
        observer.notice(what_is_open(bus.endpoint, options.share_truth))
    return bus


def _run_and_report(simulation: Simulation) -> Result:
    with interruptible(simulation.interrupt):
        simulation.advance()
        try:
            result = simulation.finish()
        except BaseException:
            with suppress(AirhiltError):  # What stopped the run is the news, not its report.
                simulation.report()
            raise
        simulation.report()
        return result


class Simulation:
    """The parts of one run, connected with its Director.

    Its caller calls `advance`, at once to the end or in steps, and then `finish`.

    Attributes
    ----------
    setup
        What the run is made of.
    router
        Whoever wants the messages of the run puts itself among the listeners of this.
    """

    def __init__(
        self,
        setup: Setup,
        info: RunInfo,
        participants: Participants,
        pace: Pace,
        vision: Vision,
        bus: ClosedBus,
        observer: Observer,
        *,
        log: LogWriter,
        latency_log: LatencyLog,
    ) -> None:
        self.setup, self._info = setup, info
        self._participants = participants
        self._observer = observer
        self._vision = vision
        self._director = Director(pace)
        self._log, self._latency_log = log, latency_log
        self.router = MessageRouter(bus, log)
        self._context = context = RunContext(setup, self._director, self.router, observer)
        stations = Stations(setup.actors, setup.site, setup.scenario)
        self._seats = Seats(
            seat_states(setup, participants, stations), self.router.publish, self._director
        )
        self._world = WorldLoop(context, self._seats)
        self._collector = self._make_collector()
        self._advisories = self._make_advisory_delivery()
        self._pool = self._make_pool()
        self._programs = ExternalPrograms(context, self._seats, participants)
        self._backend = FallbackRadio(
            setup.sound,
            setup.scenario.radio.words_per_minute,
            partial(context.lose_modality, "radio", "radio_lost", "radio"),
            failed=lambda cause: observer.notice(f"asks the voices again: {cause}"),
        )
        self._radio = self._world.radio = self._make_radio(stations)
        self._radio.start()
        self._pace_control = PaceControl(context, self._seats, self._radio, bus)
        if setup.seats:
            self._director.lose_time(MOST_BEHIND_NS, self._pace_control.stall)
        self._questions = WorkloadQuestions(context, self._seats, self._pace_control)
        self._sensors: list[Sensor] = []
        self._failures: list[BaseException] = []
        self._begun: tuple[float, float] | None = None
        self._connect()
        self._vision.mount(context, self._world)
        self._schedule()
        self._serve(bus)

    def _connect(self) -> None:
        """Let the parts take in the messages of the run, in this order."""
        setup, router = self.setup, self.router
        recorder = AudioRecorder(
            setup.folder.audio_path, keeps_voices=setup.options.voice_recording
        )
        router.listeners += (
            self._seats.take,
            recorder.take,
            self._pool.offer,
            self._world.take,
            self._radio.take,
            self._advisories.take,
            self._pace_control.take,
            self._questions.take,
        )
        router.observers += (self._collector.take, SeatNotices(self._context, self._seats).take)
        if not self._context.is_replay:
            # AIRHILT's own engines have no author to tell: a traffic advisory of TCAS is only to
            # look.
            descriptions = [worker.description for worker in self._participants.workers]
            exempt = [each.name for each in descriptions if is_own_engine(each.engine)]
            notices = WorkerNotices(setup.actors, exempt, self._observer.notice)
            router.attributed.append(notices.take)

    def _make_collector(self) -> Collector:
        setup, world = self.setup, self._world
        starts = {
            callsign: Start(
                actor.body.kind.speeds.climb_rate_fpm * FOOT_PER_MINUTE,
                tuple(setup.site.place(position) for position in actor.spec.route),
                actor.spec.commands,
            )
            for callsign, actor in setup.actors.items()
            if isinstance(actor.body, Aircraft) and isinstance(actor.spec, AircraftSpec)
        }
        return Collector(
            setup.scenario,
            setup.site.ground_m,
            world.monitor,
            world.runways,
            Plans(setup.lines, setup.ends_ns, starts),
            setup.options.advisory_channel == "frequency",
            {
                one.name: [wanted.key for wanted in one.inputs]
                for worker in self._participants.workers
                if (one := worker.description).modality == "decision"
            },
            setup.options.given_modalities,
            setup.seats,
            self._director.pace.name,
        )

    def _make_advisory_delivery(self) -> AdvisoryDelivery:
        return AdvisoryDelivery(
            self._director,
            self.setup.actors,
            self._context.event,
            self._world.tell,
            is_voiced=self._participants.does("tts"),
            speak_min_level=self._participants.speak_min_level,
            is_on_frequency=self.setup.options.advisory_channel == "frequency",
            seats=self._seats,
        )

    def _make_pool(self) -> WorkerPool:
        return WorkerPool(
            self._director,
            self._participants.workers,
            self.setup.latency,
            self.setup.options.seed,
            publish=self.router.publish,
            done=self._step_done,
            lost=self._worker_lost,
        )

    def _make_radio(self, stations: Stations) -> RadioConversation:
        setup, participants = self.setup, self._participants
        channel = None
        if setup.options.advisory_channel == "frequency":
            channel = AdvisoryChannel(
                participants.does("tts"), participants.speak_min_level, self._advisories
            )
        context = RadioContext(
            self._director,
            setup.scenario,
            setup.lines,
            stations,
            self._backend,
            setup.options.seed,
            self._world,
            RadioNotices(self._context, self._world, self._backend),
            self.router.publish,
            self._seats,
        )
        return RadioConversation(context, channel)

    def _schedule(self) -> None:
        """Schedule the world, what is published regularly, and the end of the run."""
        director, every = self._director, self._director.every
        self._world.schedule()
        every(END_PERIOD_NS, self._end_if_due, Priority.OBSERVE)
        every(SECOND_NS, self._pace_control.publish_clock, Priority.OBSERVE)
        every(SECOND_NS, self._flush_logs, Priority.OBSERVE, first_ns=SECOND_NS)
        every(SNAPSHOT_PERIOD_NS, self._tell_observer, Priority.OBSERVE)
        duration_ns = seconds_to_ns(self.setup.scenario.duration_s)
        director.at(duration_ns, self._questions.end, Priority.OBSERVE)
        self._world.schedule_occurrences()
        self._schedule_recorded(self.setup.recorded)

    def _schedule_recorded(self, recorded: Recorded) -> None:
        """Let what came from other processes in an earlier run come at its time."""
        if recorded.end_ns is not None:
            self._director.at(recorded.end_ns + 1, self._director.stop, Priority.PHYSICS)
        for message in recorded.unregistered:
            take = partial(self._programs.take_accepted, message.key, message.data)
            self._director.at(message.t_ns, take, Priority.SCRIPT)
        for event in recorded.refused:
            refuse = partial(self._programs.take_refused, event.subject, event.text)
            self._director.at(event.t_ns, refuse, Priority.SCRIPT)
        for stall in recorded.stalls:
            self._director.at(stall.t_ns, self._pace_control.stall, Priority.SCRIPT)
        self._programs.count_dropped(recorded.dropped)
        for name, loss in recorded.losses.items():
            self._director.at(loss.t_ns, partial(self._gone, name), Priority.SETTLE)

    def _serve(self, bus: ClosedBus) -> None:
        """Notice workers that end, and hear what other programs publish by themselves."""
        expected = set(self._participants.attached)
        leaving: dict[str, threading.Timer] = {}
        returns_s = bus.returns_s

        def give_up(name: str) -> None:
            expected.discard(name)
            self._director.post(partial(self._gone, name))

        def changed(name: str, alive: bool) -> None:
            if name not in expected:
                return
            if alive and name in leaving:
                leaving.pop(name).cancel()
            elif not alive and returns_s:
                leaving[name] = timer = threading.Timer(returns_s, give_up, (name,))
                timer.daemon = True
                timer.start()
            elif not alive:
                give_up(name)

        bus.watch_workers(changed)
        self._programs.serve(bus)

    # --- the run ----------------------------------------------------------------------------

    def advance(self, until_ns: int | None = None) -> bool:
        """Run to the end, or up to the events of a time; return true if the run goes on from there.

        What fails is kept, and ends the run: `finish` raises it.
        """
        with _kept(self._failures):
            if self._begun is None:
                self._begin()
            return self._director.run(until_ns)
        return False

    def _begin(self) -> None:
        self._begun = time.perf_counter(), cpu_s()
        self._set_modalities()
        self._brief()
        self._sensors += start_sensors(self.setup.sensor_types, self._sensor_context())
        self._vision.start()
        self._wait_for_seats()

    def finish(self, cause: str = "") -> Result:
        """Finish the run folder, and raise what stopped the run.

        Parameters
        ----------
        cause
            Why its caller ends the run before its end; empty: it came to its end.
        """
        failures, folder = self._failures, self.setup.folder
        if failures and isinstance(failures[0], KeyboardInterrupt):
            self._observer.notice(f"interrupted; {folder.path} is complete up to here")
        begun_wall, begun_cpu_s = self._begun or (time.perf_counter(), cpu_s())
        wall_s, used_s = time.perf_counter() - begun_wall, cpu_s() - begun_cpu_s
        sensed = self._measurements_in_hand(failures)
        with _kept(failures):
            self._close_logs(_cause(failures) or cause, sensed)
        with _kept(failures):
            summary = self._summary(_cause(failures) or cause, wall_s, used_s)
            folder.write_summary(summary)
            for sentence in summary.too_slow:
                self._observer.notice(sentence)
        with _kept(failures):
            folder.write_info(self._final_info(_cause(failures) or cause))
        error = self._first(failures) if failures else None
        self._clear()
        if error is not None:
            raise error
        return Result(folder, summary)

    def post(self, key: str, message: Message) -> None:
        """Let a message of a program of this process count, between the next two events.

        The log has it as one of another process, so that a replay has it too.
        """
        take = partial(self._programs.take_accepted, key, message.model_dump_json().encode())
        self._director.post(take)

    def report(self) -> None:
        """Write the report of a run that is finished, if it is to have one."""
        if self.setup.options.report:
            write_report(self.setup.folder.path)

    def interrupt(self) -> None:
        """Stop after the event in hand."""
        self._director.interrupt()

    def _clear(self) -> None:
        """Let go of what refers back to its owner, so that the run leaves nothing in memory."""
        self._questions.close()
        self._director.clear()
        self.router.clear()
        self._world.clear()
        del self._pool

    def _measurements_in_hand(self, failures: list[BaseException]) -> list[StepRecord]:
        """Return what sensors have measured and not published; keep the failures of those asked."""
        steps: list[StepRecord] = []
        for sensor in self._sensors:
            with _kept(failures):
                steps += sensor.unfinished()
        return steps

    def _flush_logs(self) -> None:
        """Let the operating system have both logs: of each step whose result is in the log too."""
        self._latency_log.flush()
        self._log.flush()

    def _close_logs(self, cause: str, sensed: Sequence[StepRecord]) -> None:
        """Write the last lines of the logs and close them."""
        phase: Literal["stopped", "finished"] = "stopped" if cause else "finished"
        with closing(self._latency_log), closing(self._log), ExitStack() as stack:
            stack.callback(self._vision.finish)
            self._context.event(phase, "run", cause or "came to its end")
            self._programs.finish()
            self._pace_control.publish_clock(phase)
            self._radio.close()
            for step in (*self._pool.unfinished(), *sensed):
                self._latency_log.step(step)

    def _final_info(self, cause: str) -> RunInfo:
        """Return what ``run.json`` says of the run when it has ended."""
        return self._info.model_copy(
            update={
                "phase": "stopped" if cause else "finished",
                "cause": cause,
                "unregistered_programs": self._programs.heard,
                "files": self.setup.folder.manifest(),
            }
        )

    def _first(self, failures: Sequence[BaseException]) -> BaseException:
        """Return what stopped the run; tell the user what failed after it."""
        first, *others = failures
        for text in dict.fromkeys(_said(other) for other in others):
            if text != _said(first):
                self._observer.notice(f"failed as well, when the run was finished: {text}")
                first.add_note(f"Failed as well, when the run was finished: {text}")
        return first

    def _summary(self, cause: str, wall_s: float, used_s: float) -> Summary:
        now_ns = self._director.now_ns
        return self._collector.summary(
            {
                "seed": self.setup.options.seed,
                "assistant": self._participants.assistant,
                "outcome": f"stopped: {cause}" if cause else "finished",
                "latency_sources": {
                    ADSB: self.setup.latency.of(ADSB).own_text,
                    **self._pool.latency_sources(),
                },
                "too_slow": self._pool.too_slow(),
                "inputs_dropped": self._pool.inputs_dropped(),
                "steps_missed": self._pool.steps_missed(),
                "messages_dropped": self._programs.dropped,
                "real_time_factor": now_ns / SECOND_NS / max(wall_s, 1e-9),
                "cpu_s": used_s,
            },
            now_ns,
        )

    def _wait_for_seats(self) -> None:
        """Let the run stand still at its start until its seats are taken, if that is wanted."""
        if not self.setup.options.wait_for_seats:
            return
        self._pace_control.wait_for_seats()
        if not self._context.is_replay and not isinstance(self._director.pace, Virtual):
            seats = ", ".join(self.setup.seats)
            self._observer.notice(f"the run begins when this is taken: {seats}")

    def _sensor_context(self) -> SensorContext:
        setup, world = self.setup, self._world
        return SensorContext(
            director=self._director,
            scenario=setup.scenario,
            site=setup.site,
            actors=setup.actors,
            latency=setup.latency,
            seed=setup.options.seed,
            state_at_ns=lambda: world.ticked_ns,
            publish=self.router.publish,
            step_done=self._latency_log.step,
            subscribed=self._participants.subscribed,
        )

    def _end_if_due(self) -> None:
        if self._world.has_ended():
            self._questions.end()

    # --- workers ----------------------------------------------------------------------------

    def _step_done(self, record: StepRecord) -> None:
        self._latency_log.step(record)
        self._collector.step(record)
        if record.missed:
            self._context.miss_step(record.worker, record.missed)

    def _worker_lost(self, worker: WorkerDescription, cause: str, is_of_machine: bool) -> None:
        """Go on without a worker."""
        if worker.modality == "tts":
            self._advisories.voice_lost()
            self._seats.change_all(spoken_from=None)
        cause, name = readable(cause), worker.name
        self._latency_log.lost(name, self._director.now_ns, cause)
        self._context.lose_modality(worker.modality, "worker_lost", name, cause, is_of_machine)

    def _gone(self, name: str) -> None:
        """Give up a worker or a program of another process that has ended."""
        cause = f"worker {name!r} is gone: its process ended"
        if name in self._participants.programs:
            self._latency_log.lost(name, self._director.now_ns, cause)
            self._context.lose_modality("decision", "worker_lost", name, cause, is_of_machine=True)
        else:
            self._pool.servers[name].lose(cause, is_of_machine=True)

    # --- what is told -----------------------------------------------------------------------

    def _brief(self) -> None:
        setup = self.setup
        briefing = briefing_of(setup.scenario, setup.site, setup.options.advisory_channel)
        self.router.publish("briefing", briefing)
        has_voice = self._participants.does("tts")
        self._seats.open(
            has_sound=self._backend.has_sound,
            spoken_from=self._participants.speak_min_level if has_voice else None,
        )

    def _set_modalities(self) -> None:
        scenario, does = self.setup.scenario, self._participants.does
        given = self.setup.options.given_modalities
        is_equipped = any(
            not isinstance(spec, WildlifeSpec) and spec.transponder.has_adsb
            for spec in scenario.actors
        )
        self._context.set_modality("adsb", "on" if is_equipped and "adsb" in given else "off")
        self._context.set_modality("radio", "on" if scenario.radio.lines else "off")
        self._context.set_modality("asr", "on" if does("asr") and "asr" in given else "off")
        self._context.set_modality("tts", "on" if does("tts") else "off")
        self._context.set_modality("vision", *self._vision.state)
        self._context.set_modality("decision", "on" if self._programs.has_decision else "off")
        if does("enhancement"):
            self._context.set_modality("enhancement", "on")
        if does("equipment"):
            self._context.set_modality("equipment", "on")

    def _tell_observer(self) -> None:
        horizontal_m, vertical_m = self._world.distances_m() or (None, None)
        self._observer.snapshot(
            Snapshot(
                self._director.now_ns / SECOND_NS,
                self.setup.scenario.duration_s,
                horizontal_m,
                vertical_m,
                self._collector.last_advisory,
            )
        )


@contextmanager
def _kept(failures: list[BaseException]) -> Iterator[None]:
    """Keep what fails, so that the rest of the run folder is written all the same."""
    try:
        yield
    except BaseException as error:
        failures.append(error)


def _cause(failures: Sequence[BaseException]) -> str:
    """Return why a run was stopped, in words; empty if it was not."""
    return _said(failures[0]) if failures else ""


def _said(failure: BaseException) -> str:
    match failure:
        case KeyboardInterrupt():
            return "interrupted"
        case AirhiltError():
            return readable(str(failure), LONGEST_LINE)
        case _:
            return readable(f"{type(failure).__name__}: {failure}", LONGEST_LINE)
