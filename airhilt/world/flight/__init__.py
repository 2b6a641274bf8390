"""Flight: JSBSim aircraft under guidance.

Two names matter: `load_aircraft_type` reads one of the ``aircraft/*.json``, `Aircraft` flies it.
"""

from airhilt.world.flight.aircraft import Aircraft
from airhilt.world.flight.aircraft_type import AircraftType, load_aircraft_type
from airhilt.world.flight.guidance import AltitudeClearance
from airhilt.world.flight.model import ModelError
from airhilt.world.flight.state import AircraftState, Atmosphere, InitialCondition

__all__ = [
    "Aircraft",
    "AircraftState",
    "AircraftType",
    "AltitudeClearance",
    "Atmosphere",
    "InitialCondition",
    "ModelError",
    "load_aircraft_type",
]
