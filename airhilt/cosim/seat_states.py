"""The seats of a run before anybody has come: what each is equipped with."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from airhilt.cosim.participants import Participants
from airhilt.cosim.setup import Setup
from airhilt.messages import CONTROLLER, SeatState
from airhilt.scenario.models import Scenario, WildlifeSpec
from airhilt.sensors.radio.stations import Stations


def seat_states(
    setup: Setup, participants: Participants, stations: Stations
) -> Iterator[SeatState]:
    """Yield the state of each seat that is left to a person."""
    radio, options = setup.scenario.radio, setup.options
    for seat in sorted(setup.seats):
        frequencies_khz = stations.selectable(seat)
        yield SeatState(
            seat=seat,
            **_equipment_of(seat, setup.scenario),
            frequencies_khz=frequencies_khz,
            tuned_khz=frequencies_khz,
            has_own_receiver=seat in radio.receivers,
            is_recognised=participants.does("asr"),
            voice_is_recorded=options.voice_recording,
            may_pause=options.pause,
            phraseology=radio.phraseology,
        )


def _equipment_of(seat: str, scenario: Scenario) -> dict[str, Any]:
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
