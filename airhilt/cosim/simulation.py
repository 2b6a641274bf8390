"""One run, from scenario to run folder. The main path of AIRHILT begins at `run`.

`set_up` settles what the run is, `connect` who takes part in it, `open_vision` how it sees;
`Simulation` connects it all with one `Director`, and each part gets what it needs as arguments.
Data flows one way: actors, sensors, workers, advisories, crews.
"""

from __future__ import annotations

import time
from collections.abc import Iterator, Sequence
from contextlib import ExitStack, closing, contextmanager, suppress
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Literal

from airhilt.bus.access import ROLES, WITHOUT_KEYS
from airhilt.bus.endpoints import what_is_open
from airhilt.bus.session import Bus
from airhilt.cosim.advisory_hints import AdvisoryHints
from airhilt.cosim.briefing import briefing_of
from airhilt.cosim.cameras import Vision, open_vision, started_renderers
from airhilt.cosim.engines_in_use import is_own_engine
from airhilt.cosim.events import EventPublisher
from airhilt.cosim.external_programs import ExternalPrograms
from airhilt.cosim.language_model_notices import LanguageModelNotices
from airhilt.cosim.modalities import Modalities
from airhilt.cosim.observer import Observer, Result, Snapshot
from airhilt.cosim.pace_control import PaceControl, tell_clock
from airhilt.cosim.participants import Participants, connect
from airhilt.cosim.radio import RunRadio
from airhilt.cosim.recorded import Recorded
from airhilt.cosim.router import MessageRouter
from airhilt.cosim.seat_notices import SeatNotices
from airhilt.cosim.seat_states import seat_states
from airhilt.cosim.setup import Setup, set_up
from airhilt.cosim.workload_questions import WorkloadQuestions
from airhilt.cosim.world_loop import WorldLoop
from airhilt.errors import AirhiltError
from airhilt.host.machine import cpu_s, give_memory_back
from airhilt.host.text import LONGEST_LINE, readable
from airhilt.messages import WorkerDescription
from airhilt.metrics.collector import Collector
from airhilt.metrics.plans import Plans
from airhilt.metrics.summary import Summary
from airhilt.options import Options
from airhilt.record import LatencyLog, LogWriter, RunInfo
from airhilt.record.audio import AudioRecorder
from airhilt.report import write_report
from airhilt.scenario import Scenario
from airhilt.scenario.models import WildlifeSpec
from airhilt.seats import Seats
from airhilt.sensors.adsb import STAGE as ADSB
from airhilt.sensors.base import Sensor, SensorContext
from airhilt.sensors.radio.advisory_calls import AdvisoryChannel
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
    options = options or Options()
    try:
        return _run(
            scenario, options, observer or Observer(), recorded or Recorded(), workers, keeper
        )
    finally:
        give_memory_back()


def _run(
    scenario: Scenario,
    options: Options,
    observer: Observer,
    recorded: Recorded,
    workers: Sequence[Worker],
    keeper: RendererKeeper | None,
) -> Result:
    with ExitStack() as stack:
        processes = stack.enter_context(
            started_renderers(scenario, options, recorded, bool(workers), keeper)
        )
        setup = set_up(scenario, options, recorded)
        for text in setup.notices:
            observer.notice(text)
        options, pace = setup.options, setup.pace
        bus = stack.enter_context(closing(_open_bus(setup.name, options, observer)))
        tell_clock(bus, 0, "waiting", pace)
        participants = connect(
            options, setup.scenario, setup.recorded, bus, observer.notice, workers
        )
        has_people = bool(setup.seats) and not setup.recorded.is_replay
        has_programs = bool(participants.programs) and not setup.recorded.programs
        if options.pace is None and (has_people or has_programs):
            pace = RealTime()
        vision = stack.enter_context(open_vision(setup, participants, processes, observer))
        setup.folder.create(options.overwrite)
        info = setup.info(participants, pace, bus.endpoint, vision.renderer)
        setup.folder.write_info(info)
        log = stack.enter_context(closing(LogWriter(setup.folder.log_path)))
        log.flush()  # A run that is killed at once leaves a log that can be read.
        latency_log = stack.enter_context(closing(LatencyLog(setup.folder.latency_path)))
        simulation = Simulation(
            setup, participants, pace, vision, bus, observer, log=log, latency_log=latency_log
        )
        return _run_and_report(simulation, info, setup.folder.path)


def _open_bus(name: str, options: Options, observer: Observer) -> Bus:
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


def _run_and_report(simulation: Simulation, info: RunInfo, folder: Path) -> Result:
    with interruptible(simulation.interrupt):
        if not info.options.report:
            return simulation.run(info)
        try:
            result = simulation.run(info)
        except BaseException:
            with suppress(AirhiltError):  # What stopped the run is the news, not its report.
                write_report(folder)
            raise
        write_report(folder)
        return result


class Simulation:
    """The parts of one run, connected with its Director."""

    def __init__(
        self,
        setup: Setup,
        participants: Participants,
        pace: Pace,
        vision: Vision,
        bus: Bus,
        observer: Observer,
        *,
        log: LogWriter,
        latency_log: LatencyLog,
    ) -> None:
        self._setup = setup
        self._participants = participants
        self._bus = bus
        self._observer = observer
        self._vision = vision
        self._director = Director(pace)
        self._log = log
        self._latency_log = latency_log
        self._router = MessageRouter(bus, log)
        self._event = EventPublisher(self._director, self._router)
        self._modalities = Modalities(
            self._director, self._router, self._event, observer, is_strict=setup.options.strict
        )
        self._stations = Stations(setup.actors, setup.site, setup.scenario.radio.lines)
        self._seats = Seats(
            seat_states(setup, participants, self._stations), self._router.publish, self._director
        )
        self._world = WorldLoop(self._director, setup, self._router, self._event, self._seats)
        self._collector = self._make_collector()
        self._advisories = self._make_advisory_delivery()
        self._pool = self._connect_workers()
        self._programs = self._connect_programs()
        self._connect_seats_and_records()
        self._router.listen(self._pool.offer)
        self._router.listen(self._world.take)
        self._radio = self._connect_radio()
        self._pace_control = PaceControl(self._director, self._event, self._seats, self._radio, bus)
        if setup.seats:
            self._pace_control.keep_time()
        self._questions = self._make_questions()
        self._router.listen(self._advisories.take)
        self._connect_notices()
        self._router.listen(self._pace_control.take)
        self._router.listen(self._questions.take)
        self._sensors: list[Sensor] = [self._radio, vision]
        self._mount_cameras()
        self._schedule()
        self._serve_bus()

    def _connect_seats_and_records(self) -> None:
        keeps_voices = self._setup.options.voice_recording
        recorder = AudioRecorder(self._setup.folder.audio_path, keeps_voices=keeps_voices)
        self._router.listen(self._seats.take)
        self._router.listen(recorder.take)
        self._router.observe(self._collector.take)

    def _make_advisory_delivery(self) -> AdvisoryDelivery:
        return AdvisoryDelivery(
            self._director,
            self._setup.actors,
            self._event,
            is_voiced=self._participants.does("tts"),
            speak_min_level=self._participants.speak_min_level,
            is_on_frequency=self._setup.options.advisory_channel == "frequency",
            seats=self._seats,
        )

    def _make_collector(self) -> Collector:
        setup, world = self._setup, self._world
        usual_rates_m_s = {
            callsign: actor.body.kind.speeds.climb_rate_fpm * FOOT_PER_MINUTE
            for callsign, actor in setup.actors.items()
            if isinstance(actor.body, Aircraft)
        }
        return Collector(
            setup.scenario,
            setup.site.ground_m,
            world.monitor,
            world.runways,
            Plans(setup.lines, setup.ends_ns, usual_rates_m_s),
            setup.options.advisory_channel == "frequency",
            [
                worker.description.name
                for worker in self._participants.workers
                if worker.description.modality == "decision"
            ],
            setup.options.given_modalities,
            setup.seats,
            self._director.pace.name,
        )

    def _connect_workers(self) -> WorkerPool:
        watch = _WorkerWatch(
            self._director,
            self._latency_log,
            self._collector,
            self._advisories,
            self._seats,
            self._modalities,
        )
        return WorkerPool(
            self._director,
            self._participants.workers,
            self._setup.latency,
            self._setup.options.seed,
            publish=self._router.publish,
            done=watch.done,
            lost=watch.lost,
        )

    def _connect_programs(self) -> ExternalPrograms:
        participants = self._participants
        return ExternalPrograms(
            self._director,
            self._router,
            self._event,
            self._modalities,
            self._observer,
            self._seats,
            workers=[worker.description.name for worker in participants.workers],
            has_decision=bool(participants.programs) or participants.does("decision"),
            keeps_voices=self._setup.options.voice_recording,
            is_strict=self._setup.options.strict,
        )

    def _make_questions(self) -> WorkloadQuestions:
        options = self._setup.options
        return WorkloadQuestions(
            self._director,
            self._seats,
            self._router,
            self._pace_control,
            isa_minutes=options.isa_minutes,
            has_tlx=options.nasa_tlx,
            is_replay=self._setup.recorded.is_replay,
        )

    def _wait_for_seats(self) -> None:
        """Let the run stand still at its start until its seats are taken, if that is wanted."""
        setup = self._setup
        if not setup.options.wait_for_seats:
            return
        self._pace_control.wait_for_seats()
        if not setup.recorded.is_replay and not isinstance(self._director.pace, Virtual):
            self._observer.notice(f"the run begins when this is taken: {', '.join(setup.seats)}")

    def _connect_notices(self) -> None:
        """Tell people at seats, and the user, what they would not see otherwise."""
        observer = None if self._setup.recorded.is_replay else self._observer
        self._router.observe(SeatNotices(self._seats, self._event, observer).take)
        self._connect_hints()

    def _connect_hints(self) -> None:
        """Tell of warnings on which nobody acts, and of a language model; not in a replay.

        AIRHILT's own engines have no author to tell: a traffic advisory of TCAS is only to look.
        """
        if self._setup.recorded.is_replay:
            return
        descriptions = [worker.description for worker in self._participants.workers]
        exempt = [each.name for each in descriptions if is_own_engine(each.engine)]
        hints = AdvisoryHints(self._setup.actors, exempt, self._observer.notice)
        self._router.attribute(hints.take)
        self._router.attribute(LanguageModelNotices(self._observer.notice).take)

    def _connect_radio(self) -> RunRadio:
        radio = RunRadio(
            self._director,
            self._setup,
            self._world,
            self._router,
            self._event,
            self._modalities,
            self._observer,
            self._advisory_channel(),
            self._stations,
            self._seats,
        )
        radio.start()
        return radio

    def _advisory_channel(self) -> AdvisoryChannel | None:
        """Return the use of the frequencies for advisories, None if they are heard in cockpits."""
        if self._setup.options.advisory_channel == "cockpit":
            return None
        participants = self._participants
        return AdvisoryChannel(
            participants.does("tts"),
            participants.speak_min_level,
            self._advisories,
        )

    def _mount_cameras(self) -> None:
        self._vision.mount(
            self._director,
            self._router,
            self._world,
            lost=partial(self._modalities.lose, "vision", "cameras_lost", "cameras"),
        )

    def _sensor_context(self) -> SensorContext:
        setup = self._setup
        return SensorContext(
            director=self._director,
            scenario=setup.scenario,
            site=setup.site,
            actors=setup.actors,
            latency=setup.latency,
            seed=setup.options.seed,
            state_at_ns=self._world.state_at_ns,
            publish=self._router.publish,
            step_done=self._latency_log.step,
            subscribed=self._participants.subscribed,
        )

    def _schedule(self) -> None:
        """Schedule the world, what is published regularly, and the end of the run."""
        director, every = self._director, self._director.every
        self._world.schedule()
        every(END_PERIOD_NS, self._end_if_due, Priority.OBSERVE)
        every(SECOND_NS, self._pace_control.publish_clock, Priority.OBSERVE)
        every(SECOND_NS, self._flush_logs, Priority.OBSERVE, first_ns=SECOND_NS)
        every(SNAPSHOT_PERIOD_NS, self._tell_observer, Priority.OBSERVE)
        duration_ns = seconds_to_ns(self._setup.scenario.duration_s)
        director.at(duration_ns, self._questions.end, Priority.OBSERVE)
        self._world.schedule_occurrences()
        self._schedule_recorded(self._setup.recorded)

    def _schedule_recorded(self, recorded: Recorded) -> None:
        """Let what came from other processes in an earlier run come at its time."""
        if recorded.end_ns is not None:
            self._director.at(recorded.end_ns + 1, self._director.stop, Priority.PHYSICS)
        for message in recorded.unregistered:
            take = partial(self._programs.take_recorded, message.key, message.data)
            self._director.at(message.t_ns, take, Priority.SCRIPT)
        for event in recorded.refused:
            refuse = partial(self._programs.take_refused, event.subject, event.text)
            self._director.at(event.t_ns, refuse, Priority.SCRIPT)
        for stall in recorded.stalls:
            self._director.at(stall.t_ns, self._pace_control.stall, Priority.SCRIPT)
        self._programs.count_dropped(recorded.dropped)
        for name, loss in recorded.losses.items():
            self._director.at(loss.t_ns, partial(self._gone, name), Priority.SETTLE)

    def _serve_bus(self) -> None:
        """Notice workers that end, and hear what other programs publish by themselves."""
        expected = set(self._participants.attached)

        def changed(name: str, alive: bool) -> None:
            if not alive and name in expected:
                expected.discard(name)
                self._director.post(partial(self._gone, name))

        self._bus.watch_workers(changed)
        self._programs.serve(self._bus)

    # --- the run ----------------------------------------------------------------------------

    def run(self, info: RunInfo) -> Result:
        """Run to the end, and finish the run folder whatever happens."""
        begun_wall, begun_cpu_s = time.perf_counter(), cpu_s()
        failures: list[BaseException] = []
        folder = self._setup.folder
        with _kept(failures):
            self._set_modalities()
            self._brief()
            self._sensors += start_sensors(self._setup.sensor_types, self._sensor_context())
            self._vision.start()
            self._wait_for_seats()
            self._director.run()
        if failures and isinstance(failures[0], KeyboardInterrupt):
            self._observer.notice(f"interrupted; {folder.path} is complete up to here")
        wall_s = time.perf_counter() - begun_wall
        used_s = cpu_s() - begun_cpu_s
        sensed = self._measurements_in_hand(failures)
        with _kept(failures):
            self._close_logs(_cause(failures), sensed)
        with _kept(failures):
            summary = self._summary(_cause(failures), wall_s, used_s)
            folder.write_summary(summary)
            for sentence in summary.too_slow:
                self._observer.notice(sentence)
        with _kept(failures):
            folder.write_info(self._final_info(info, _cause(failures)))
        self._clear()
        if failures:
            raise self._first(failures)
        return Result(summary, folder.path)

    def interrupt(self) -> None:
        """Stop after the event in hand."""
        self._director.interrupt()

    def _clear(self) -> None:
        """Let go of what refers back to its owner, so that the run leaves nothing in memory."""
        self._questions.close()
        self._director.clear()
        self._router.clear()
        self._world.clear()

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
            self._event(phase, "run", cause or "came to its end")
            self._programs.finish()
            self._pace_control.publish_clock(phase)
            self._radio.close()
            for step in (*self._pool.unfinished(), *sensed):
                self._latency_log.step(step)

    def _final_info(self, info: RunInfo, cause: str) -> RunInfo:
        """Return what ``run.json`` says of the run when it has ended."""
        return info.model_copy(
            update={
                "phase": "stopped" if cause else "finished",
                "cause": cause,
                "unregistered_programs": self._programs.heard,
                "files": self._setup.folder.manifest(),
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
                "seed": self._setup.options.seed,
                "assistant": self._participants.assistant,
                "outcome": f"stopped: {cause}" if cause else "finished",
                "latency_sources": {
                    ADSB: self._setup.latency.of(ADSB).own_text,
                    **self._pool.latency_sources(),
                },
                "too_slow": self._pool.too_slow(),
                "inputs_dropped": self._pool.inputs_dropped(),
                "messages_dropped": self._programs.dropped(),
                "real_time_factor": now_ns / SECOND_NS / max(wall_s, 1e-9),
                "cpu_s": used_s,
            },
            now_ns,
        )

    def _end_if_due(self) -> None:
        if self._world.has_ended():
            self._questions.end()

    # --- workers ----------------------------------------------------------------------------

    def _gone(self, name: str) -> None:
        """Give up a worker or a program of another process that has ended."""
        cause = f"worker {name!r} is gone: its process ended"
        if name in self._participants.programs:
            self._latency_log.lost(name, self._director.now_ns, cause)
            self._modalities.lose("decision", "worker_lost", name, cause, is_of_machine=True)
        else:
            self._pool.servers[name].lose(cause, is_of_machine=True)

    # --- what is told -----------------------------------------------------------------------

    def _brief(self) -> None:
        self._router.publish("briefing", briefing_of(self._setup.scenario, self._setup.site))
        has_voice = self._participants.does("tts")
        self._seats.open(
            has_sound=self._radio.has_sound,
            spoken_from=self._participants.speak_min_level if has_voice else None,
        )

    def _set_modalities(self) -> None:
        scenario, does = self._setup.scenario, self._participants.does
        given = self._setup.options.given_modalities
        is_equipped = any(
            not isinstance(spec, WildlifeSpec) and spec.transponder.has_adsb
            for spec in scenario.actors
        )
        self._modalities.set("adsb", "on" if is_equipped and "adsb" in given else "off")
        self._modalities.set("radio", "on" if scenario.radio.lines else "off")
        self._modalities.set("asr", "on" if does("asr") and "asr" in given else "off")
        self._modalities.set("tts", "on" if does("tts") else "off")
        self._modalities.set("vision", *self._vision.state)
        self._modalities.set("decision", "on" if self._programs.has_decision else "off")
        if does("enhancement"):
            self._modalities.set("enhancement", "on")
        if does("equipment"):
            self._modalities.set("equipment", "on")

    def _tell_observer(self) -> None:
        horizontal_m, vertical_m = self._world.distances_m() or (None, None)
        self._observer.snapshot(
            Snapshot(
                self._director.now_ns / SECOND_NS,
                self._setup.scenario.duration_s,
                horizontal_m,
                vertical_m,
                self._collector.last_advisory,
            )
        )


class _WorkerWatch:
    """Takes in what workers have done, and the loss of one."""

    def __init__(
        self,
        director: Director,
        log: LatencyLog,
        collector: Collector,
        advisories: AdvisoryDelivery,
        seats: Seats,
        modalities: Modalities,
    ) -> None:
        self._director = director
        self._log = log
        self._collector = collector
        self._advisories = advisories
        self._seats = seats
        self._modalities = modalities

    def done(self, record: StepRecord) -> None:
        """Log and count a finished step."""
        self._log.step(record)
        self._collector.step(record)

    def lost(self, worker: WorkerDescription, cause: str, is_of_machine: bool) -> None:
        """Go on without a worker."""
        if worker.modality == "tts":
            self._advisories.voice_lost()
            self._seats.change_all(spoken_from=None)
        cause = readable(cause)
        self._log.lost(worker.name, self._director.now_ns, cause)
        self._modalities.lose(worker.modality, "worker_lost", worker.name, cause, is_of_machine)


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
