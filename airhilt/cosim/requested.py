"""Requests of the options of a run: changes of its scenario, and a latency source."""

from __future__ import annotations

import itertools
from collections.abc import Iterable
from dataclasses import replace
from typing import Any

from pydantic import ValidationError

from airhilt.cosim.differences import first_difference
from airhilt.cosim.engines_in_use import is_of_user
from airhilt.cosim.latency_presets import PRESETS
from airhilt.errors import AirhiltError, first_problem
from airhilt.geodesy.positions import RelativePosition
from airhilt.host.library import nearest
from airhilt.messages import RadarKind
from airhilt.options import Options
from airhilt.record import open_run
from airhilt.record.damage import untold
from airhilt.scenario import Scenario
from airhilt.scenario.models import (
    AircraftSpec,
    AirportScene,
    Radar,
    Radio,
    SurfaceSurveillance,
    VehicleSpec,
)
from airhilt.sim import LatencySpec, parse_latency
from airhilt.workers.pool import EQUIPMENT

AWAY_NM = 40.0
"""Distance of a requested radar west of the scene's centre, in NM, if it is not an airport's own.

At the centre, where the conflict usually is, aircraft at cruising level would be in the radar's
cone of silence, which reaches out to 10 NM at FL350.
"""
STAGES = ("adsb", "enhancement", "asr", "vision", "decision", "tts", EQUIPMENT)
"""Stages that may have a latency of their own: ADS-B receivers, and modalities of workers."""


def requested_scenario(options: Options, scenario: Scenario) -> Scenario:
    """Return a scenario with the radio, people, weather and equipment that the options ask for.

    Raises
    ------
    AirhiltError
        The scenario cannot have them.
    """
    changes: dict[str, Any] = {
        "radio": requested_radio(options, scenario),
        "equipment": tuple(dict.fromkeys((*scenario.equipment, *options.equipment))),
    }
    if options.crews is not None:
        changes["crews"] = options.crews
    if options.visibility_m is not None:
        visibility = {"visibility_m": options.visibility_m}
        changes["weather"] = scenario.weather.model_copy(update=visibility)
    if options.radar is not None:
        changes["radars"] = (*scenario.radars, *_radars(options.radar, scenario))
    if options.cockpit:
        changes["cockpits"] = tuple(
            actor.callsign
            for actor in scenario.actors
            if isinstance(actor, AircraftSpec | VehicleSpec)
        )
    if options.surface_surveillance:
        if not isinstance(scenario.scene, AirportScene):
            raise AirhiltError(
                f"--surface-surveillance: {scenario.name!r} is en route; expected a scenario at an "
                "airport"
            )
        changes["surface_surveillance"] = scenario.surface_surveillance or SurfaceSurveillance()
    return scenario.model_copy(update=changes)


def requested_radio(options: Options, scenario: Scenario) -> Radio:
    """Return the radio of a scenario with those settings that the options give.

    Raises
    ------
    AirhiltError
        The radio cannot have them.
    """
    given = {
        "snr_db": options.snr_db,
        "profile": options.radio_profile,
        "topology": options.topology,
    }
    changes = {name: value for name, value in given.items() if value is not None}
    if not changes:
        return scenario.radio
    try:
        return Radio.model_validate(scenario.radio.model_dump() | changes)
    except ValidationError as error:
        raise AirhiltError(f"radio: {first_problem(error)}") from None


def _radars(kind: RadarKind, scenario: Scenario) -> Iterable[Radar]:
    """Return the radar that is to be added; none if the scenario has it.

    Its name is its kind, unless a radar of another kind has that name. A terminal radar stands at
    the airport, if there is one.
    """
    declared = {each.name: each.kind for each in scenario.radars}
    if declared.get(kind) == kind:
        return ()
    is_own = kind == "terminal" and isinstance(scenario.scene, AirportScene)
    position = RelativePosition(
        type="from_centre", bearing_deg=270.0, distance_nm=0.0 if is_own else AWAY_NM
    )
    names = itertools.chain([str(kind)], (f"{kind}_{number}" for number in itertools.count(2)))
    name = next(each for each in names if each not in declared)
    return (Radar(name=name, kind=kind, position=position),)


def requested_latency(
    text: str | None, scenario: Scenario, seed: int, *, twin: bool = False
) -> LatencySpec:
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
    if info.options.twin != twin:
        raise AirhiltError(
            f"latency {text}: of that run and this one, one is of the nominal twin of {name!r} and "
            "one is not; expected both or none"
        )
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
    recorded = earlier.steps()
    return LatencySpec("replay", replay_of=spec.replay_of, recorded=recorded.latencies_ns)


def is_vision_measured(latency: LatencySpec, detector: str) -> bool:
    """Return whether the times of a detector, as the command line names it, are measured."""
    of_user = is_of_user(Options(detector=detector), "vision")
    return latency.of("vision", is_of_user=of_user).kind == "measured"
