"""The latency source that the options of a run ask for."""

from __future__ import annotations

from dataclasses import replace

from airhilt.cosim.differences import first_difference
from airhilt.cosim.engines_in_use import is_of_user
from airhilt.cosim.latency_presets import PRESETS
from airhilt.errors import AirhiltError
from airhilt.host.library import nearest
from airhilt.options import Options
from airhilt.record import open_run
from airhilt.record.damage import untold
from airhilt.scenario import Scenario
from airhilt.sim import LatencySpec, parse_latency
from airhilt.workers.pool import EQUIPMENT

STAGES = ("adsb", "enhancement", "asr", "vision", "decision", "tts", EQUIPMENT)
"""Stages that may have a latency of their own: ADS-B receivers, and modalities of workers."""


def requested_latency(text: str | None, scenario: Scenario, seed: int) -> LatencySpec:
    """Return the latency source of a text such as ``fixed,asr=lognormal:5.9`` or ``replay:RUN``.

    None stands for the default.

    Raises
    ------
    AirhiltError
        It is none, it names a stage that is not there, or the run that it names is of another
        scenario or seed.
    """
    spec = parse_latency(text, PRESETS)
    for stage in spec.stages:
        if stage not in STAGES:
            raise AirhiltError(
                f"latency {text}: there is no stage {stage!r}; expected some of "
                f"{', '.join(STAGES)}{nearest(stage, list(STAGES))}"
            )
    if spec.replay_of is None:
        # Equipment of the world is as late as it is, however late the assistant is.
        return replace(spec, stages={EQUIPMENT: LatencySpec("fixed"), **spec.stages})
    earlier = open_run(spec.replay_of, untold)
    info = earlier.info
    name = info.scenario.get("name")
    if (name, info.options.seed) != (scenario.name, seed):
        raise AirhiltError(
            f"latency {text}: that run is of {name!r} with seed {info.options.seed}; expected "
            f"the same scenario and seed as this one, {scenario.name!r} with {seed}"
        )
    document = scenario.model_dump(mode="json")
    if info.scenario != document:
        raise AirhiltError(
            f"latency {text}: the scenario {name!r} has changed since that run, at "
            f"{first_difference(info.scenario, document)}; expected the scenario of that run, "
            "which its run.json holds, or a new run to take latencies from"
        )
    recorded = earlier.latencies()
    return LatencySpec("replay", replay_of=spec.replay_of, recorded=recorded.latencies_ns)


def is_vision_measured(latency: LatencySpec, detector: str) -> bool:
    """Return whether the times of a detector, as the command line names it, are measured."""
    of_user = is_of_user(Options(detector=detector), "vision")
    return latency.of("vision", is_of_user=of_user).kind == "measured"
