"""Creates the actors of a scenario where they begin."""

from __future__ import annotations

import math
from dataclasses import dataclass

from airhilt.errors import ScenarioError
from airhilt.scenario.models import (
    ActorSpec,
    Airborne,
    AircraftSpec,
    LinedUp,
    OnFinal,
    Scenario,
    VehicleSpec,
    Weather,
    WildlifeSpec,
)
from airhilt.sim.streams import stream
from airhilt.units import DEGREE, FOOT, KNOT
from airhilt.world.actors.actor import Actor, Unable
from airhilt.world.actors.crew import Crew
from airhilt.world.actors.driver import Driver
from airhilt.world.actors.reactions import ReactionModel
from airhilt.world.actors.starts import airborne, on_final, on_ground
from airhilt.world.actors.wildlife import Animal
from airhilt.world.flight.aircraft import Aircraft
from airhilt.world.flight.aircraft_type import load_aircraft_type
from airhilt.world.flight.model import ModelError
from airhilt.world.flight.state import Atmosphere, InitialCondition, OnGround
from airhilt.world.site import ScenarioSite
from airhilt.world.surface.kinds import load_kind


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

    Raises
    ------
    ScenarioError
        An actor cannot begin as the scenario says, or cannot carry out its first commands.
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
        condition: InitialCondition | OnGround
        match actor.initial:
            case Airborne() as initial:
                condition = airborne(initial, site, route)
            case OnFinal() as initial:
                condition = on_final(initial, site, kind.speeds.approach_kt * KNOT)
            case initial:
                place, heading = on_ground(initial, site, kind.dimensions.length_m)
                condition = OnGround(*place, heading, isinstance(initial, LinedUp))
        aircraft = Aircraft(
            kind,
            condition,
            seed=self._seed_of(f"turbulence/{actor.callsign}"),
            atmosphere=atmosphere_of(self.scenario.weather),
            terrain_elevation_m=site.ground_m,
            tick_s=self.tick_s,
        )
        crew = Crew(actor, aircraft, site, self.seed)
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
        place, heading = on_ground(actor.initial, self.site, kind.dimensions.length_m)
        body = kind.create(
            place, heading, ground_m=self.site.ground_m, tick_s=self.tick_s, seed=self.seed
        )
        reactions = ReactionModel(actor.callsign, actor.driver, self.seed)
        driver = Driver(actor, kind, body, self.site, reactions)
        for command in actor.commands:
            driver.command(command)
        return driver

    def _animal(self, actor: WildlifeSpec) -> Animal:
        place, heading = on_ground(actor.initial, self.site, 0.0)
        kind = load_kind(actor.kind, "wildlife")
        body = kind.create(
            place,
            heading,
            ground_m=self.site.ground_m,
            tick_s=self.tick_s,
            seed=self._seed_of(f"wildlife/{actor.callsign}"),
            height_m=actor.height_ft * FOOT,
        )
        return Animal(actor, kind, body, self.site, self.actors)
