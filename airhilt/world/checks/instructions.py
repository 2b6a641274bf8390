"""Checks of what commands and conditions name: fixes, units and phases."""

from __future__ import annotations

import typing
from collections.abc import Collection, Iterator

from airhilt.commands import (
    ContactCommand,
    CrossFixCommand,
    DirectCommand,
    HoldAtCommand,
)
from airhilt.scenario.conversation import is_named_by, tunable_units
from airhilt.scenario.models import AircraftSpec, FixPassed, InPhase, Scenario, VehicleSpec
from airhilt.scenario.problems import Problem, unknown
from airhilt.world.checks.walk import models_of
from airhilt.world.flight.following import TrackPhase
from airhilt.world.flight.procedures import en_route, landing, takeoff, taxi, visual
from airhilt.world.site import ScenarioSite
from airhilt.world.surface.animal import AnimalPhase
from airhilt.world.surface.kind import VehiclePhase
from airhilt.world.surface.kinds import FAMILY

FLIGHT_PHASES = (
    *typing.get_args(taxi.Stand), *typing.get_args(taxi.Way),
    *(each.name for each in (
        takeoff.TakeoffRoll, takeoff.Rotate, takeoff.ClimbOut, takeoff.RejectedTakeoff,
        takeoff.GoAround, landing.Glide, landing.Flare, landing.Rollout,
        en_route.EnRoute, en_route.EmergencyDescent, en_route.DriftDown,
        visual.Approach, visual.Orbit, TrackPhase,
    )),
)  # fmt: skip
"""Phases of an aircraft."""


def unknown_fixes(scenario: Scenario, site: ScenarioSite) -> Iterator[Problem]:
    """Yield fixes of commands and conditions that the scenario does not have."""
    known = list(site.fixes)
    if site.layout is not None:
        known += [site.layout.airport.icao, "field"]
        known += [f"runway {end.ident}" for one in site.layout.strips.values() for end in one.ends]
    for path, model in models_of(scenario):
        match model:
            case FixPassed(fix=name) | HoldAtCommand(fix=name) | CrossFixCommand(fix=name):
                field = "fix"
            case DirectCommand(to=name):
                field = "to"
            case _:
                continue
        if site.fix(name) is None:
            yield unknown(f"{path}/{field}", "fix", name, known)


def unknown_units(scenario: Scenario) -> Iterator[Problem]:
    """Yield units that somebody is to contact, and whose frequency nobody knows."""
    units = tunable_units(scenario)
    for path, model in models_of(scenario):
        if not isinstance(model, ContactCommand) or model.frequency_khz is not None:
            continue
        if model.unit is None:
            yield Problem(path, "found neither unit nor frequency_khz; expected one of them")
        elif not any(is_named_by(model.unit, unit) for unit in units):
            hint = "; the frequency of a unit without radio lines is given in frequency_khz"
            yield unknown(f"{path}/unit", "unit", model.unit, units, hint)


def unknown_phases(scenario: Scenario) -> Iterator[Problem]:
    """Yield phases that an actor is never in; kinds of other packages have phases of their own."""
    phases: dict[str, Collection[str]] = {}
    for actor in scenario.actors:
        if isinstance(actor, AircraftSpec):
            phases[actor.callsign] = FLIGHT_PHASES
        elif FAMILY.is_own(actor.kind):
            is_vehicle = isinstance(actor, VehicleSpec)
            phases[actor.callsign] = typing.get_args(VehiclePhase if is_vehicle else AnimalPhase)
    for path, model in models_of(scenario):
        if isinstance(model, InPhase):
            known = phases.get(model.actor, model.phases)
            for index, name in enumerate(model.phases):
                if name not in known:
                    yield unknown(f"{path}/phases/{index}", "phase", name, known)
