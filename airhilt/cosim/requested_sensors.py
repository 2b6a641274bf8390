"""Sensors that the options of a run ask for, added to its scenario."""

from __future__ import annotations

from airhilt.geodesy.positions import RelativePosition
from airhilt.messages import RadarKind
from airhilt.scenario import Scenario
from airhilt.scenario.models import AircraftSpec, AirportScene, Radar

AWAY_NM = 40.0
"""Distance of a requested radar west of the scene's centre, in NM, if it is not an airport's own.

At the centre, where the conflict usually is, aircraft at cruising level would be in the radar's
cone of silence, which reaches out to 10 NM at FL350.
"""


def with_requested_sensors(scenario: Scenario, radar: RadarKind | None, cockpit: bool) -> Scenario:
    """Return a scenario with the sensors that the options ask for.

    Parameters
    ----------
    radar
        Kind of a radar, which is also its name; None for no radar but the scenario's own. At an
        airport, a terminal radar stands at the airport.
    cockpit
        Whether all aircraft publish their instruments.
    """
    changes: dict[str, object] = {}
    if radar is not None and radar not in {declared.name for declared in scenario.radars}:
        is_own = radar == "terminal" and isinstance(scenario.scene, AirportScene)
        position = RelativePosition(
            type="from_centre", bearing_deg=270.0, distance_nm=0.0 if is_own else AWAY_NM
        )
        changes["radars"] = (*scenario.radars, Radar(name=radar, kind=radar, position=position))
    if cockpit:
        changes["cockpits"] = tuple(
            actor.callsign for actor in scenario.actors if isinstance(actor, AircraftSpec)
        )
    return scenario.model_copy(update=changes)
