"""Creates the actors of a scenario where they begin."""

from __future__ import annotations

import math
from dataclasses import dataclass

from airhilt.errors import ScenarioError
from airhilt.geodesy.positions import RunwayPosition
from airhilt.geodesy.wgs84 import Place, azimuth, onward
from airhilt.scenario.models import (
    ActorSpec,
    Airborne,
    AircraftSpec,
    GroundStart,
    HoldingShort,
    LinedUp,
    OnFinal,
    OnTrack,
    Scenario,
    Standing,
    VehicleSpec,
    Weather,
    WildlifeSpec,
)
from airhilt.sim.streams import stream
from airhilt.units import DEGREE, FOOT, KNOT, NAUTICAL_MILE
from airhilt.world.actors.actor import Actor, Unable
from airhilt.world.actors.crew import Crew
from airhilt.world.actors.reactions import ReactionModel, response_seed
from airhilt.world.actors.surface_actors import Animal, Driver
from airhilt.world.flight.aircraft import Aircraft
from airhilt.world.flight.aircraft_type import load_aircraft_type
from airhilt.world.flight.model import ModelError
from airhilt.world.flight.state import Atmosphere, InitialCondition, OnGround
from airhilt.world.flight.track import TrackPoint, points_of
from airhilt.world.site import ScenarioSite
from airhilt.world.surface.kinds import load_kind
from airhilt.world.surface.ways import NOSE_MARGIN_M

AIM_POINT_M = 300.0
"""Distance from the threshold to where the glide path meets the runway, in m (ICAO Annex 14
volume I, 5.2.5)."""
LINED_UP_M = 30.0
"""Distance from the beginning of the runway to the tail of a lined-up aircraft, in m."""


def atmosphere_of(weather: Weather) -> Atmosphere:
    """Return the atmosphere of a scenario's weather."""
    towards = weather.wind.from_deg * DEGREE + math.pi
    speed = weather.wind.speed_kt * KNOT
    return Atmosphere(
        wind_north_m_s=speed * math.cos(towards),
        wind_east_m_s=speed * math.sin(towards),
        turbulence_wind_at_20ft_m_s=weather.turbulence.wind_at_20ft_kt * KNOT,
        turbulence_severity=weather.turbulence.severity,
    )


def build_actors(
    scenario: Scenario, site: ScenarioSite, seed: int, tick_s: float
) -> dict[str, Actor]:
    """Return the actors of a scenario by callsign.

    A ScenarioError says which actor cannot begin so, or cannot carry out its first commands.
    """
    builder = _Builder(scenario, site, seed, tick_s, {})
    for actor in scenario.actors:
        try:
            builder.actors[actor.callsign] = builder.build(actor)
        except (ValueError, ModelError, Unable, ScenarioError) as error:
            raise ScenarioError(
                f"actors/{actor.callsign}: cannot begin like that: {error}"
            ) from None
    return builder.actors


@dataclass(frozen=True)
class _Builder:
    scenario: Scenario
    site: ScenarioSite
    seed: int
    tick_s: float
    actors: dict[str, Actor]

    def build(self, actor: ActorSpec) -> Actor:
        match actor:
            case AircraftSpec():
                return self._crew(actor)
            case VehicleSpec():
                return self._driver(actor)
            case WildlifeSpec():
                return self._animal(actor)

    def _seed_of(self, name: str) -> int:
        return int(stream(self.seed, name).integers(2**31))

    def _crew(self, actor: AircraftSpec) -> Crew:
        site = self.site
        kind = load_aircraft_type(actor.aircraft, self.scenario.files)
        route = [site.place(position) for position in actor.route]
        condition: InitialCondition | OnGround | tuple[TrackPoint, ...]
        match actor.initial:
            case Airborne() as initial:
                condition = _airborne(initial, site, route)
            case OnFinal() as initial:
                condition = _on_final(initial, site, kind.speeds.approach_kt * KNOT)
            case OnTrack() as initial:
                condition = points_of(initial)
            case initial:
                place, heading = _on_ground(initial, site, kind.dimensions.length_m)
                condition = OnGround(*place, heading, isinstance(initial, LinedUp))
        aircraft = Aircraft(
            kind,
            condition,
            seed=self._seed_of(f"turbulence/{actor.callsign}"),
            atmosphere=atmosphere_of(self.scenario.weather),
            terrain_elevation_m=site.ground_m,
            load=actor.load,
            tick_s=self.tick_s,
            may_land=site.layout is not None,
        )
        seed = response_seed(self.scenario, self.seed)
        responses = self.scenario.response_model.crews
        crew = Crew(actor, aircraft, site, seed, self.actors, responses)
        match actor.initial:
            case OnFinal(runway=runway):
                crew.runway_operations.begin_on_final(runway)
            case LinedUp(runway=runway):
                crew.runway_operations.bind(runway)
        if route:
            crew.fly_route(route)
        for command in actor.commands:
            crew.command(command)
        return crew

    def _driver(self, actor: VehicleSpec) -> Driver:
        kind = load_kind(actor.kind, "vehicle")
        place, heading = _on_ground(actor.initial, self.site, kind.dimensions.length_m)
        body = kind.create(
            place, heading, ground_m=self.site.ground_m, tick_s=self.tick_s, seed=self.seed
        )
        responses = self.scenario.response_model.drivers
        seed = response_seed(self.scenario, self.seed)
        reactions = ReactionModel(actor.callsign, responses, actor.driver, seed)
        driver = Driver(kind, body, self.site, actor, reactions, self.actors)
        for command in actor.commands:
            driver.command(command)
        return driver

    def _animal(self, actor: WildlifeSpec) -> Animal:
        place, heading = _on_ground(actor.initial, self.site, 0.0)
        kind = load_kind(actor.kind, "wildlife")
        body = kind.create(
            place,
            heading,
            ground_m=self.site.ground_m,
            tick_s=self.tick_s,
            seed=self._seed_of(f"wildlife/{actor.callsign}"),
            height_m=actor.height_ft * FOOT,
        )
        return Animal(kind, body, self.site, actor, self.actors)


def _airborne(initial: Airborne, site: ScenarioSite, route: list[Place]) -> InitialCondition:
    """Return the condition in which a flight begins in the air."""
    place = site.place(initial.position)
    track = azimuth(place, route[0]) if initial.track_deg is None else initial.track_deg * DEGREE
    return InitialCondition(
        *place,
        altitude_m=initial.altitude_ft * FOOT,
        track_rad=track,
        calibrated_airspeed_m_s=initial.cas_kt * KNOT,
    )


def _on_final(initial: OnFinal, site: ScenarioSite, speed_m_s: float) -> InitialCondition:
    """Return the condition in which a flight begins on the glide path, at approach speed."""
    runway = site.runway(initial.runway)
    distance_m = initial.distance_nm * NAUTICAL_MILE
    place = site.place(RunwayPosition(type="runway", runway=initial.runway, along_m=-distance_m))
    slope = math.tan(runway.glide_path_rad)
    return InitialCondition(
        *place,
        altitude_m=site.ground_m + (distance_m + AIM_POINT_M) * slope,
        track_rad=azimuth(place, runway.end),
        calibrated_airspeed_m_s=speed_m_s,
        vertical_rate_m_s=-speed_m_s * slope,
        on_approach=True,
    )


def _on_ground(initial: GroundStart, site: ScenarioSite, length_m: float) -> tuple[Place, float]:
    """Return the place of the centre of an actor of some length, and its heading."""
    match initial:
        case LinedUp(runway=ident):
            runway = site.runway(ident)
            return (
                onward(runway.start, runway.course_rad, LINED_UP_M + length_m / 2.0),
                runway.course_rad,
            )
        case HoldingShort(runway=ident, taxiway=taxiway, before_m=before_m):
            hold = site.airport.hold(ident, taxiway)
            back_m = length_m / 2.0 + NOSE_MARGIN_M + before_m
            return onward(hold.place, hold.heading_rad, -back_m), hold.heading_rad
        case Standing(position=position, heading_deg=heading_deg):
            return site.place(position), heading_deg * DEGREE
