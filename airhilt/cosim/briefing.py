"""Facts known before a run begins: the briefing of all, and the equipment of each seat."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Any, Literal

from airhilt.cosim.participants import Participants
from airhilt.cosim.setup import Setup
from airhilt.messages import (
    CONTROLLER,
    AirportBriefing,
    Briefing,
    RosterEntry,
    RunwayBriefing,
    SeatState,
)
from airhilt.scenario import Scenario
from airhilt.scenario.models import AircraftSpec, VehicleSpec, WildlifeSpec
from airhilt.sensors.radio.stations import Stations
from airhilt.units import DEGREE, FOOT
from airhilt.world.flight import load_aircraft_type
from airhilt.world.site import ScenarioSite
from airhilt.world.surface.kinds import animal_labels

if TYPE_CHECKING:
    from airhilt.geodesy.wgs84 import Place
    from airhilt.world.surface.layout import Layout


def briefing_of(
    scenario: Scenario,
    site: ScenarioSite,
    advisory_channel: Literal["cockpit", "frequency"] = "cockpit",
) -> Briefing:
    """Return the briefing for a scenario."""
    separation = scenario.separation
    return Briefing(
        controller=scenario.radio.controller,
        horizontal_separation_nm=separation.horizontal_nm,
        vertical_separation_ft=separation.vertical_ft,
        roster=_roster(scenario),
        airport=None if site.layout is None else _charted(site.layout),
        animals=animal_labels(
            actor.kind for actor in scenario.actors if isinstance(actor, WildlifeSpec)
        ),
        advisory_channel=advisory_channel,
    )


def _roster(scenario: Scenario) -> tuple[RosterEntry, ...]:
    """Return whom the controller knows: all that speak on the radio or are spoken to."""
    entries = []
    for actor in scenario.actors:
        match actor:
            case AircraftSpec(callsign=callsign, on_roster=True, aircraft=name):
                kind = load_aircraft_type(name, scenario.files)
                entries.append(
                    RosterEntry(
                        callsign=callsign,
                        category="aircraft",
                        type=kind.icao_designator,
                        ceiling_ft=kind.speeds.service_ceiling_ft,
                    )
                )
            case VehicleSpec(callsign=callsign, kind=vehicle):
                entries.append(RosterEntry(callsign=callsign, category="vehicle", type=vehicle))
    return tuple(entries)


def _charted(layout: Layout) -> AirportBriefing:
    def point(place: Place) -> tuple[float, float]:
        return place[0] / DEGREE, place[1] / DEGREE

    runways = []
    for strip in layout.strips.values():
        area = [
            layout.local_frame.to_place(*xy) for xy in strip.protected_area.exterior.coords[:-1]
        ]
        runways += [
            RunwayBriefing(
                ident=end.ident,
                threshold=point(end.threshold),
                end=point(end.end),
                elevation_ft=end.elevation_m / FOOT,
                width_m=end.width_m,
                protected_area=tuple(point(corner) for corner in area),
            )
            for end in strip.ends
        ]
    return AirportBriefing(
        icao=layout.airport.icao,
        elevation_ft=layout.elevation_m / FOOT,
        runways=tuple(runways),
    )


def seat_states(
    setup: Setup, participants: Participants, stations: Stations
) -> Iterator[SeatState]:
    """Yield the state of each seat that is left to a person."""
    radio, options = setup.scenario.radio, setup.options
    for seat in sorted(setup.seats):
        frequencies_khz = stations.selectable(seat)
        yield SeatState(
            seat=seat,
            **seat_equipment(seat, setup.scenario),
            frequencies_khz=frequencies_khz,
            tuned_khz=frequencies_khz,
            has_own_receiver=seat in radio.receivers,
            recogniser=participants.recogniser(options),
            voice_is_recorded=options.voice_recording,
            may_pause=options.pause,
            phraseology=radio.phraseology,
        )


def seat_equipment(seat: str, scenario: Scenario) -> dict[str, Any]:
    """Return the fields that say what a person at a seat is shown."""
    for spec in scenario.actors:
        if spec.callsign == seat and not isinstance(spec, WildlifeSpec):
            return {
                "category": spec.type,
                "icao24": spec.icao24,
                "has_adsb_in": spec.adsb_in,
                "recipients": (seat, spec.icao24),
            }
    is_controller = seat == scenario.radio.controller
    return {"recipients": (seat, CONTROLLER) if is_controller else (seat,)}
