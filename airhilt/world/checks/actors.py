"""Checks of actors: their types, where aircraft begin in the air, and the wind on the ground."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

from airhilt.errors import AirhiltError
from airhilt.scenario.models import Airborne, AircraftSpec, Scenario, VehicleSpec, WildlifeSpec
from airhilt.scenario.problems import Problem
from airhilt.units import FOOT, KNOT
from airhilt.world.checks.altitudes import not_above_ground
from airhilt.world.flight.aircraft_type import AircraftType, load_aircraft_type
from airhilt.world.flight.guidance import GuidanceModes
from airhilt.world.site import ScenarioSite
from airhilt.world.surface.kinds import load_kind

GREATEST_LATITUDE_DEG = 75.0
"""Highest latitude of a scene, in degrees; relative motion is exact enough up to there."""
GREATEST_SURFACE_WIND_KT = 40.0
"""Highest wind at an airport, in kt: above the demonstrated crosswind of every type here."""


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
        else:
            yield from _kind(path, actor)


def _kind(path: str, actor: VehicleSpec | WildlifeSpec) -> Iterator[Problem]:
    try:
        load_kind(actor.kind, actor.type)
    except AirhiltError as error:
        yield Problem(f"{path}/kind", str(error))


def _aircraft(
    path: str, actor: AircraftSpec, site: ScenarioSite, files: Mapping[str, Any]
) -> Iterator[Problem]:
    try:
        kind = load_aircraft_type(actor.aircraft, files)
    except AirhiltError as error:
        yield Problem(f"{path}/aircraft", str(error))
        return
    initial, ground_ft = actor.initial, site.ground_m / FOOT
    if not isinstance(initial, Airborne):
        return
    if initial.altitude_ft <= ground_ft:
        yield not_above_ground(f"{path}/initial/altitude_ft", initial.altitude_ft, site)
    if initial.track_deg is None and not actor.route:
        yield Problem(
            f"{path}/initial/track_deg", "missing; it is required where there is no route"
        )
    yield from _envelope(f"{path}/initial", initial.altitude_ft, initial.cas_kt, kind)


def _envelope(
    path: str, altitude_ft: float, cas_kt: float, kind: AircraftType
) -> Iterator[Problem]:
    speeds = kind.speeds
    if altitude_ft > speeds.service_ceiling_ft:
        yield Problem(
            f"{path}/altitude_ft",
            f"found {altitude_ft:g}; expected at most the service ceiling of a {kind.name}, "
            f"{speeds.service_ceiling_ft:g}",
        )
    flown_ft = min(altitude_ft, speeds.service_ceiling_ft)
    limits_m_s = GuidanceModes(kind).speed_limits_m_s(flown_ft * FOOT)
    slowest_kt, greatest_kt = (limit / KNOT for limit in limits_m_s)
    if not slowest_kt <= cas_kt <= greatest_kt:
        yield Problem(
            f"{path}/cas_kt",
            f"found {cas_kt:g}; expected {slowest_kt:.4g} to {greatest_kt:.4g}, what a "
            f"{kind.name} flies at {flown_ft:g} ft",
        )


def surface_wind(scenario: Scenario) -> Iterator[Problem]:
    """Yield a wind that is too strong for an airport."""
    speed_kt = scenario.weather.wind.speed_kt
    if speed_kt > GREATEST_SURFACE_WIND_KT:
        yield Problem(
            "weather/wind/speed_kt",
            f"found {speed_kt:g}; expected at most {GREATEST_SURFACE_WIND_KT:g} where aircraft "
            "take off, land or taxi",
        )
