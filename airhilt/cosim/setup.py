"""The setup of a run: everything that is known before workers connect to it."""

from __future__ import annotations

import os
from datetime import UTC, datetime
from pathlib import Path

from airhilt.cosim.option_checks import check_options, require_known_equipment
from airhilt.cosim.recorded import Recorded
from airhilt.cosim.requested import is_vision_measured, requested_latency, requested_scenario
from airhilt.errors import AirhiltError
from airhilt.host.caches import cache_folder, cache_limit_bytes, write_problem
from airhilt.options import Options
from airhilt.record import RunFolder
from airhilt.record.video import require_video
from airhilt.scenario import Scenario
from airhilt.scenario.failures import apply_failures
from airhilt.scenario.seats import seats_of
from airhilt.scenario.twin import twin_of
from airhilt.sensors.base import load_sensor_types
from airhilt.sensors.radio.backends import TextRadio
from airhilt.sensors.radio.backends.selection import select_backend
from airhilt.sensors.radio.script import planned_ends_ns
from airhilt.sim import LatencySpec, parse_pace
from airhilt.world.actors import build_actors
from airhilt.world.checks.radio import units_on_guard
from airhilt.world.loading import draw
from airhilt.world.site import ScenarioSite

TICK_S = 0.05
"""Control tick of the aircraft, in s."""


class Setup:
    """Everything that a run is made of before workers connect to it; nothing is written yet.

    Attributes
    ----------
    given
        The scenario as it was given.
    scenario
        The scenario with its perturbations drawn, and with what the options ask for.
    pace
        Pace of the run until its participants are known.
    notices
        Sentences for the user on what the run does without.
    seats
        Units and actors that are left to people.
    ends_ns
        Planned end of each line, by its id.

    Raises
    ------
    AirhiltError
        Something that was given is wrong.
    """

    def __init__(self, given: Scenario, options: Options, recorded: Recorded) -> None:
        if not recorded.is_replay:
            check_options(options, given)
        self.given, self.options, self.recorded = given, options, recorded
        drawn, self.draws = draw(twin_of(given) if options.twin else given, options.seed)
        self.scenario = scenario = requested_scenario(options, drawn)
        self.latency = recorded.latency or _requested_latency(given, options)
        self.pace = parse_pace(options.pace or "virtual")
        self.name = options.run_name or f"{given.name}-{options.seed}"
        self.folder = RunFolder(options.out or _default_folder(self.name))
        self.folder.require_free(options.overwrite)
        if options.video:
            _require_something_to_film(options, scenario)
        self.site = ScenarioSite.of(scenario)
        self.actors = build_actors(scenario, self.site, options.seed, TICK_S)
        tts = options.tts if options.speech else None
        self.sound = recorded.sound or select_backend(scenario.radio, options.seed, tts)
        self.lines = apply_failures(scenario)
        self.seats = seats_of(options.seat, scenario)
        self.sensor_types, problems = load_sensor_types(scenario.sensors)
        self.notices = [*problems, *_cache_problems(), *map(str, units_on_guard(scenario))]
        # For the summary alone; a record knows what was said, but not what was planned and was not.
        text = TextRadio(scenario.radio.words_per_minute)
        self.ends_ns = planned_ends_ns(self.lines, self.sound if recorded.sound is None else text)


def check_given(given: Scenario, options: Options) -> None:
    """Check what can be checked of a run before anything is begun, started or drawn.

    Raises
    ------
    AirhiltError
        Something that was given is wrong.
    """
    check_options(options, given)
    _requested_latency(given, options)
    parse_pace(options.pace or "virtual")
    if options.out is not None:
        RunFolder(options.out).require_free(options.overwrite)


def require_runnable(scenario: Scenario) -> None:
    """Check that a run of a loaded scenario can begin: put all its actors where they begin.

    Raises
    ------
    AirhiltError
        There is no such equipment, or an actor cannot be where it begins.
    """
    require_known_equipment(scenario.equipment)
    realised, _ = draw(scenario, 0)
    build_actors(realised, ScenarioSite.of(realised), 0, TICK_S)


def _cache_problems() -> list[str]:
    """Return a sentence if the cache cannot be written, for the use of later runs."""
    if cache_limit_bytes() and (problem := write_problem(cache_folder())):
        return [f"the cache cannot be written, so that later runs make everything anew: {problem}"]
    return []


def _require_something_to_film(options: Options, scenario: Scenario) -> None:
    require_video()
    if not (options.cameras and scenario.cameras):
        raise AirhiltError(
            f"--video: there are no cameras in this run of {scenario.name!r}; expected a "
            "scenario with cameras, and no --no-cameras"
        )


def _requested_latency(given: Scenario, options: Options) -> LatencySpec:
    latency = requested_latency(options.latency, given, options.seed, twin=options.twin)
    if options.share_pictures and is_vision_measured(latency, options.detector):
        raise AirhiltError(
            "--share-pictures: the latency of vision is measured, so a detection would be as late "
            "as a cache is fast; expected another one, such as --latency fixed"
        )
    return latency


def _default_folder(name: str) -> Path:
    stamp = f"{datetime.now(UTC):%Y%m%dT%H%M%S}-{os.getpid()}"
    path, count = Path("runs") / f"{name}-{stamp}", 1
    while path.exists():
        count += 1
        path = Path("runs") / f"{name}-{stamp}-{count}"
    return path
