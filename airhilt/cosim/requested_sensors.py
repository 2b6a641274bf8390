"""Sensors that the options of a run ask for, added to its scenario."""

from __future__ import annotations

import itertools
from collections.abc import Iterator

from airhilt.errors import AirhiltError
from airhilt.geodesy.positions import RelativePosition
from airhilt.messages import RadarKind
from airhilt.scenario import Scenario
from airhilt.scenario.models import (
    AircraftSpec,
    AirportScene,
    Radar,
    SurfaceSurveillance,
    VehicleSpec,
)

AWAY_NM = 40.0
"""Distance of a requested radar west of the scene's centre, in NM, if it is not an airport's own.

At the centre, where the conflict usually is, aircraft at cruising level would be in the radar's
cone of silence, which reaches out to 10 NM at FL350.
"""


def with_requested_sensors(
    scenario: Scenario, radar: RadarKind | None, cockpit: bool, surface: bool = False
) -> Scenario:
    """Return a scenario with the sensors that the options ask for.

    Parameters
    ----------
    radar
        Kind of a radar, which is also its name, unless the scenario has a radar of another kind
        by that name; None for no radar but the scenario's own. At an airport, a terminal radar
        stands at the airport.
    cockpit
        True if all aircraft publish their instruments, and vehicles their positions.
    surface
        True if the airport has surface surveillance.

    Raises
    ------
    AirhiltError
        There is no airport to have surface surveillance.
    """
    changes: dict[str, object] = {}
    declared = {each.name: each.kind for each in scenario.radars}
    if radar is not None and declared.get(radar) != radar:
        is_own = radar == "terminal" and isinstance(scenario.scene, AirportScene)
        position = RelativePosition(
            type="from_centre", bearing_deg=270.0, distance_nm=0.0 if is_own else AWAY_NM
        )
        name = next(each for each in _names_for(radar) if each not in declared)
        changes["radars"] = (*scenario.radars, Radar(name=name, kind=radar, position=position))
    if cockpit:
        changes["cockpits"] = tuple(
            actor.callsign
            for actor in scenario.actors
            if isinstance(actor, (AircraftSpec, VehicleSpec))
        )
    if surface and not isinstance(scenario.scene, AirportScene):
        raise AirhiltError(
            f"--surface-surveillance: {scenario.name!r} is en route; expected a scenario at an "
            "airport"
        )
    if surface and scenario.surface_surveillance is None:
        changes["surface_surveillance"] = SurfaceSurveillance()
    return scenario.model_copy(update=changes)


def _names_for(radar: RadarKind) -> Iterator[str]:
    """Yield names for a radar, the kind itself first."""
    yield radar
    for number in itertools.count(2):
        yield f"{radar}_{number}"
