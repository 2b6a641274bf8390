"""Checks of actors: types, starts, altitudes, commands, and the wind on the ground."""

from __future__ import annotations

import typing
from collections.abc import Iterator, Mapping
from typing import Any

from pydantic import BaseModel

from airhilt.commands import (
    AircraftCommand,
    AltitudeCommand,
    Command,
    EmergencyDescentCommand,
    GoAroundCommand,
    TakeOffCommand,
)
from airhilt.errors import AirhiltError, ScenarioError
from airhilt.scenario.models import (
    ActorSpec,
    Airborne,
    AircraftSpec,
    AltitudeReached,
    BoundForAltitude,
    OnTrack,
    Scenario,
    WildlifeSpec,
)
from airhilt.scenario.problems import Problem
from airhilt.units import FOOT, KNOT
from airhilt.world.checks.walk import commands_of, models_of
from airhilt.world.flight.aircraft_type import load_aircraft_type
from airhilt.world.flight.guidance import GuidanceModes
from airhilt.world.flight.track import points_of, track_problems
from airhilt.world.site import ScenarioSite
from airhilt.world.surface.kinds import load_kind

GREATEST_LATITUDE_DEG = 75.0
"""Highest latitude of a scene, in degrees; relative motion is exact enough up to there."""
GREATEST_SURFACE_WIND_KT = 40.0
"""Highest wind at an airport, in kt: above the demonstrated crosswind of every type here."""

FIELDS = {"time": 0, "position": 1, "altitude": 3}
"""Places in a point of a track of the fields that a problem is about."""


def unfit_actors(scenario: Scenario, site: ScenarioSite) -> Iterator[Problem]:
    """Yield actors of unknown types, and aircraft that begin where they cannot fly."""
    if abs(site.centre.lat_deg) > GREATEST_LATITUDE_DEG:
        yield Problem(
            "scene/centre/lat_deg",
            f"found {site.centre.lat_deg:g}; expected within +-"
            f"{GREATEST_LATITUDE_DEG:g}, where relative motion is exact enough",
        )
    for index, actor in enumerate(scenario.actors):
        path = f"actors/{index}"
        if isinstance(actor, AircraftSpec):
            yield from _aircraft(path, actor, site, scenario.files)
            continue
        try:
            load_kind(actor.kind, actor.type)
        except AirhiltError as error:
            yield Problem(f"{path}/kind", str(error))


def _aircraft(
    path: str, actor: AircraftSpec, site: ScenarioSite, files: Mapping[str, Any]
) -> Iterator[Problem]:
    try:
        kind = load_aircraft_type(actor.aircraft, files)
    except ScenarioError as error:
        yield from (Problem(f"{path}/aircraft", text) for text in error.problems)
        return
    initial, ground_ft = actor.initial, site.ground_m / FOOT
    if isinstance(initial, OnTrack):
        yield from _track(f"{path}/initial/points", initial, site)
    if not isinstance(initial, Airborne):
        return
    if initial.altitude_ft <= ground_ft:
        yield _not_above_ground(f"{path}/initial/altitude_ft", initial.altitude_ft, site)
    if initial.track_deg is None and not actor.route:
        yield Problem(
            f"{path}/initial/track_deg", "missing; it is required where there is no route"
        )
    speeds = kind.speeds
    if initial.altitude_ft > speeds.service_ceiling_ft:
        yield Problem(
            f"{path}/initial/altitude_ft",
            f"found {initial.altitude_ft:g}; expected at most the service ceiling of a "
            f"{kind.name}, {speeds.service_ceiling_ft:g}",
        )
    flown_ft = min(initial.altitude_ft, speeds.service_ceiling_ft)
    limits_m_s = GuidanceModes(kind).speed_limits_m_s(flown_ft * FOOT)
    slowest_kt, greatest_kt = (limit / KNOT for limit in limits_m_s)
    if not slowest_kt <= initial.cas_kt <= greatest_kt:
        yield Problem(
            f"{path}/initial/cas_kt",
            f"found {initial.cas_kt:g}; expected {slowest_kt:.4g} to {greatest_kt:.4g}, what a "
            f"{kind.name} flies at {flown_ft:g} ft",
        )


def _track(path: str, track: OnTrack, site: ScenarioSite) -> Iterator[Problem]:
    for index, point in enumerate(track.points):
        if point[3] is not None and point[3] * FOOT <= site.ground_m:
            yield _not_above_ground(f"{path}/{index}/3", point[3], site)
    for problem in track_problems(points_of(track)):
        yield Problem(f"{path}/{problem.number}/{FIELDS[problem.field]}", problem.text)


def surface_wind(scenario: Scenario) -> Iterator[Problem]:
    """Yield a wind that is too strong for an airport."""
    speed_kt = scenario.weather.wind.speed_kt
    if speed_kt > GREATEST_SURFACE_WIND_KT:
        yield Problem(
            "weather/wind/speed_kt",
            f"found {speed_kt:g}; expected at most {GREATEST_SURFACE_WIND_KT:g} where aircraft "
            "take off, land or taxi",
        )


def altitudes_below_ground(scenario: Scenario, site: ScenarioSite) -> Iterator[Problem]:
    """Yield altitudes of commands and conditions that are not above the ground."""
    ground_ft = site.ground_m / FOOT
    for path, model in models_of(scenario):
        match model:
            case (
                AltitudeCommand(altitude_ft=altitude_ft)
                | EmergencyDescentCommand(altitude_ft=altitude_ft)
                | BoundForAltitude(altitude_ft=altitude_ft)
                | AltitudeReached(altitude_ft=altitude_ft)
            ):
                field = "altitude_ft"
            case TakeOffCommand(climb_to_ft=altitude_ft) | GoAroundCommand(climb_to_ft=altitude_ft):
                field = "climb_to_ft"
            case _:
                continue
        if altitude_ft <= ground_ft:
            yield _not_above_ground(f"{path}/{field}", altitude_ft, site)


def _not_above_ground(path: str, altitude_ft: float, site: ScenarioSite) -> Problem:
    where = "the airport" if site.layout else "scene/terrain_elevation_ft"
    return Problem(
        path,
        f"found {altitude_ft:g}, which is not above the ground; expected more than {where}, "
        f"{site.ground_m / FOOT:g}",
    )


def misdirected_commands(scenario: Scenario) -> Iterator[Problem]:
    """Yield commands that actors of this sort do not carry out."""
    actors = {actor.callsign: actor for actor in scenario.actors}
    for path, callsign, command in commands_of(scenario):
        actor = actors.get(callsign)
        if isinstance(actor, WildlifeSpec):
            nothing = "nothing: nobody tells an animal what to do"
            yield _misdirected(path, command, "wildlife", nothing)
        elif actor is not None:
            yield from _not_understood(path, command, actor)
    for index, actor in enumerate(scenario.actors):
        for number, planned in enumerate(actor.plan if isinstance(actor, WildlifeSpec) else ()):
            path = f"actors/{index}/plan/{number}/command"
            yield from _not_understood(path, planned.command, actor)


def _not_understood(path: str, command: Command, actor: ActorSpec) -> Iterator[Problem]:
    understood: tuple[type[BaseModel], ...] = typing.get_args(AircraftCommand)
    if not isinstance(actor, AircraftSpec):
        try:
            understood = load_kind(actor.kind, actor.type).understands
        except AirhiltError:
            return  # Named elsewhere.
    if not isinstance(command, understood):
        known = ", ".join(
            str(typing.get_args(model.model_fields["action"].annotation)[0]) for model in understood
        )
        yield _misdirected(path, command, actor.type, known or "nothing")


def _misdirected(path: str, command: Command, sort: str, expected: str) -> Problem:
    return Problem(
        f"{path}/action", f"found {command.action!r}, which no {sort} does; expected {expected}"
    )
