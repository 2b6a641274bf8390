"""The aircraft and crews of a scenario."""

from __future__ import annotations

import math
from dataclasses import dataclass

from airhilt.actors.crew import Crew, ReactionTime
from airhilt.errors import ScenarioError
from airhilt.flight.aircraft import Aircraft
from airhilt.flight.aircraft_type import load_aircraft_type
from airhilt.flight.model import ModelError
from airhilt.flight.state import Atmosphere, InitialCondition
from airhilt.scenario.geometry import azimuth, resolve
from airhilt.scenario.models import AircraftActor, Scenario, Weather
from airhilt.sim.streams import stream
from airhilt.units import DEGREE, FOOT, KNOT


@dataclass(frozen=True)
class Flight:
    """One aircraft of the scenario, with its crew."""

    actor: AircraftActor
    aircraft: Aircraft
    crew: Crew


def atmosphere_of(weather: Weather) -> Atmosphere:
    """Return the air that a scenario's weather describes."""
    towards = weather.wind.from_deg * DEGREE + math.pi
    speed = weather.wind.speed_kt * KNOT
    return Atmosphere(
        wind_north_m_s=speed * math.cos(towards),
        wind_east_m_s=speed * math.sin(towards),
        turbulence_wind_at_20ft_m_s=weather.turbulence.wind_at_20ft_kt * KNOT,
        turbulence_severity=weather.turbulence.severity,
    )


def build_fleet(scenario: Scenario, seed: int, tick_s: float) -> dict[str, Flight]:
    """Return the flights of a scenario by callsign, in steady flight.

    Raises
    ------
    ScenarioError
        JSBSim cannot fly an aircraft as it begins.
    """
    return {actor.callsign: _build(actor, scenario, seed, tick_s) for actor in scenario.actors}


def _build(actor: AircraftActor, scenario: Scenario, seed: int, tick_s: float) -> Flight:
    centre = scenario.scene.centre
    start = resolve(actor.initial.position, centre)
    route = [resolve(position, centre) for position in actor.route]
    track_deg = actor.initial.track_deg
    track = azimuth(start, route[0]) if track_deg is None else track_deg * DEGREE
    initial = InitialCondition(
        *start,
        altitude_m=actor.initial.altitude_ft * FOOT,
        track_rad=track,
        calibrated_airspeed_m_s=actor.initial.cas_kt * KNOT,
    )
    pilot = actor.pilot
    reaction = ReactionTime(pilot.reaction_median_s, pilot.reaction_sigma, pilot.compliance)
    try:
        aircraft = Aircraft(
            load_aircraft_type(actor.aircraft),
            initial,
            seed=int(stream(seed, f"turbulence/{actor.callsign}").integers(2**31)),
            atmosphere=atmosphere_of(scenario.weather),
            terrain_elevation_m=scenario.scene.terrain_elevation_ft * FOOT,
            tick_s=tick_s,
        )
        crew = Crew(actor.callsign, aircraft, reaction, seed)
        if route:
            crew.fly_route(route)
    except (ValueError, ModelError) as error:
        raise ScenarioError(f"actors/{actor.callsign}: cannot begin like that: {error}") from None
    for command in actor.commands:
        crew.command(command)
    return Flight(actor, aircraft, crew)
